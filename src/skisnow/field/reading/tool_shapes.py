"""Shapes of tools as campaign.toml names them. A new shape is one entry in `SHAPES`."""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

from ...geometry import Disc, LyingCylinder, SkiPiece

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from ...geometry import Tool


@dataclass(frozen=True, slots=True)
class Shape:
    """A shape: its class, the class's argument for each key in mm, and whether it can be tilted by an edge angle."""

    tool: Callable[..., Tool]
    argument_of_key: Mapping[str, str]
    has_edge: bool


SHAPES: Final[Mapping[str, Shape]] = MappingProxyType(
    {
        "ski": Shape(SkiPiece, {"length_mm": "length", "width_mm": "width"}, has_edge=True),
        "disc": Shape(Disc, {"diameter_mm": "diameter"}, has_edge=False),
        "cylinder": Shape(LyingCylinder, {"radius_mm": "radius", "width_mm": "width"}, has_edge=False),
    }
)
"""Every shape by its name in campaign.toml."""
