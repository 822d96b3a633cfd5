"""Loads that glide friction may act on."""

from __future__ import annotations

from typing import Literal, TypeAlias

ActsOn: TypeAlias = Literal["snow-normal", "base-normal"]
"""The load along the snow's normal, or that square on the base, side force included: docs/methods/glide-friction.md."""
