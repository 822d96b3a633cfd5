"""Recordings of a SnowMicroPen as records of a campaign: settings, and the surface of the snow in a force profile."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated, Final, Literal, TypeAlias

import numpy as np

from .._support.arrays import FloatArray, IntArray
from .._support.units import MM, Facts, Shown, amount
from ..parameters import Allowed, Quantity, require_declared
from .snow_micro_pen import SnowMicroPenProfile, parse_snow_micro_pen

Relation: TypeAlias = Literal["proksch-2015", "calonne-2020", "king-2020a", "king-2020b"]


@dataclass(frozen=True, slots=True, kw_only=True)
class SnowMicroPenSettings:
    """The section ``[snow_micro_pen]`` of campaign.toml, in SI; every default is a modelling assumption."""

    from_depth: Annotated[
        float,
        Quantity(
            "from_depth_mm",
            "where the depth begins over which the force is averaged, from the snow surface; the instrument's cone of "
            "60° and 5 mm is 4.3 mm long",
        ),
        Allowed(0.0),
    ] = 5.0 * MM
    to_depth: Annotated[float, Quantity("to_depth_mm", "where it ends"), Allowed(0.0, above=True)] = 30.0 * MM
    surface_rise: Annotated[
        float,
        Quantity(
            "surface_rise_N", "the snow begins where the force rises by this above what it was in the air just before …"
        ),
        Allowed(0.0, above=True),
    ] = 0.01
    surface_hold: Annotated[float, Quantity("surface_hold_mm", "… and stays above over this length"), Allowed(0.0)] = (
        5.0 * MM
    )
    subtract_air_force: Annotated[
        bool, Quantity("subtract_air_force", "take the air's force off before anything else")
    ] = False
    relation: Annotated[
        Relation, Quantity("relation", "publication whose regression gives density and specific surface area")
    ] = "calonne-2020"

    def __post_init__(self) -> None:
        require_declared(self)


@dataclass(frozen=True, slots=True, repr=False)
class SnowMicroPenRecordings(Shown):
    """The m recordings that snow_micro_pen.csv names.

    recording, site, spot, file: names as written in the table; an absent spot is ``""``.
    surface: depth of the snow surface stated in the table, from the start of the recording (m); NaN if to be detected.
    cancelled: reason for cancelling the recording, or ``""``.
    row: line of the table.
    contents: bytes of each file.
    settings: settings of the evaluation.
    further: other columns as text.
    """

    recording: tuple[str, ...]
    site: tuple[str, ...]
    spot: tuple[str, ...]
    file: tuple[str, ...]
    surface: FloatArray
    cancelled: tuple[str, ...]
    row: IntArray
    contents: tuple[bytes, ...] = field(repr=False)
    settings: SnowMicroPenSettings = field(default_factory=SnowMicroPenSettings)
    further: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    def __len__(self) -> int:
        """Count the recordings."""
        return len(self.recording)

    def profile(self, index: int) -> SnowMicroPenProfile:
        """Force against depth of one recording, by its index."""
        return parse_snow_micro_pen(self.file[index], self.contents[index])

    def _repr_facts(self) -> Facts:
        depths = f"{amount(self.settings.from_depth / MM)} to {amount(self.settings.to_depth / MM, 'mm')}"
        return Facts(f"of {len(self)} recordings, forces from {depths}; {', '.join(dict.fromkeys(self.site))}")


BLOCK: Final = 0.5 * MM
"""Length over which the force is averaged, and accuracy of the surface (modelling assumption)."""
AIR: Final = 20.0 * MM
"""Length before a block over which the force in air is the median (modelling assumption)."""
LEAST_AIR: Final = 5.0 * MM
"""Shortest recorded length in air from which the force in air is known (modelling assumption)."""


@dataclass(frozen=True, slots=True)
class SnowSurface:
    """Surface of the snow: depth (m) from the start of the recording, and force in the air before it (N)."""

    depth: float
    air_force: float


def snow_surface(force: FloatArray, sample_distance: float, *, rise: float, hold: float) -> SnowSurface | None:
    """Find the surface: the first block from which the force stays ``rise`` above that in air over ``hold``.

    force: N, from the first sample on; rise in N, above 0; sample_distance and hold in m.
    Returns None if it is not found.

    Example: a spike at 12 mm, snow from 30 mm.

    >>> force = np.full(500, 0.05)
    >>> force[120:125], force[300:] = 0.4, 0.3
    >>> found = snow_surface(force, 1e-4, rise=0.01, hold=5e-3)
    >>> round(found.depth * 1e3, 3), round(found.air_force, 3)
    (30.0, 0.05)
    """
    size = max(round(BLOCK / sample_distance), 1)
    length = size * sample_distance
    blocks = force[: len(force) // size * size].reshape(-1, size).mean(axis=1)
    hold_blocks, air_blocks, least_blocks = (max(round(distance / length), 1) for distance in (hold, AIR, LEAST_AIR))
    for index in range(least_blocks, len(blocks) - hold_blocks):
        level = float(np.median(blocks[max(index - air_blocks, 0) : index]))
        if (blocks[index : index + hold_blocks + 1] >= level + rise).all():
            return SnowSurface(index * length, level)
    return None
