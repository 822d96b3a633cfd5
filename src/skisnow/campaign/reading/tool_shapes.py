"""Shapes of tools as campaign.toml names them. A new shape is one entry in `SHAPES`."""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

from ...geometry import Disc, LyingCylinder, SkiPiece
from ...parameters import Quantity, own_quantities

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ...geometry import Tool


@dataclass(frozen=True, slots=True)
class Shape:
    """A shape: its class, and whether it can be tilted by an edge angle."""

    tool: type[Tool]
    has_edge: bool

    @property
    def lengths(self) -> tuple[Quantity, ...]:
        """The lengths that campaign.toml says of it."""
        return own_quantities(self.tool)

    @property
    def argument_of_key(self) -> Mapping[str, str]:
        """The class's argument for each key."""
        return {each.name: each.field for each in self.lengths}


SHAPES: Final[Mapping[str, Shape]] = MappingProxyType(
    {
        "ski": Shape(SkiPiece, has_edge=True),
        "disc": Shape(Disc, has_edge=False),
        "cylinder": Shape(LyingCylinder, has_edge=False),
    }
)
"""Every shape by its name in campaign.toml."""
