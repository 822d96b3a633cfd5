"""Loads that glide friction may act on, and its direction."""

from __future__ import annotations

from typing import Literal, TypeAlias

ActsOn: TypeAlias = Literal["snow-normal", "base-normal"]
"""The load along the snow's normal, or that square on the base, side force included: docs/methods/snow-options.md."""

Direction: TypeAlias = Literal["vector", "along-ski"]
"""Against the sliding velocity, or along the ski at any slip angle: docs/methods/snow-options.md."""
