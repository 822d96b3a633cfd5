"""Shear displacement: how far an edge moves across until the snow resists with its full strength."""

from __future__ import annotations

from typing import Final

SHEAR_DISPLACEMENT: Final = 0.02e-3
"""u_y (m) (modelling assumption: not measured). The law of the paper, all of S_f or nothing, is its limit 0.

With this one a circle at 80 % of the grip is half a percent wide, and a smaller one gains nothing:
docs/methods/side-force.md.
"""
