"""How far an edge goes across before the snow holds it with all its strength."""

from __future__ import annotations

from typing import Final

SHEAR_DISPLACEMENT: Final = 0.5e-3
"""u_y (m) (modelling assumption: not measured; the law of the paper, all of S_f or nothing, is its limit 0)."""
