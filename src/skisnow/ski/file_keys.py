"""Keys of a ski file and columns of its table: each with range, usual range and synonyms."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Annotated, Final

from ..parameters import Quantity, quantities
from .layout import TAIL_OVERHANG, BaseShape, ski_quantity

RIGID: Final = 1e6
"""EI and GJ of a rigid ski (N m²). Modelling assumption: 200 mm of it, held in the middle, bend by 0.03 micrometre
under 500 N."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SkiFile:
    """A ski file in SI; None for missing keys without a default. Lists go from tip to tail."""

    name: Annotated[str | None, Quantity("name", "what it is called", origin="the file's name")] = None
    source: Annotated[str | None, Quantity("source", "where the numbers come from", origin="the file's name")] = None
    length: Annotated[
        float | None,
        ski_quantity(
            "length_mm",
            "from tip to tail along the base; at least 2.5 times the tip width",
            (20, 3000),
            (180, 2300),
            "needed; with a table: its reach",
        ),
    ] = None
    running_length: Annotated[
        float | None,
        ski_quantity("running_length_mm", "between the contact points of the base", (20, 3000), (180, 2300), "needed"),
    ] = None
    sidecut_length: Annotated[
        float | None,
        ski_quantity(
            "sidecut_length_mm", "between the widest points in front and behind", (20, 3000), (180, 2300), "needed"
        ),
    ] = None
    tip_width: Annotated[
        float | None,
        ski_quantity(
            "tip_width_mm", "width at the front end of the sidecut length", (15, 500), (40, 350), "needed, or a column"
        ),
    ] = None
    waist_width: Annotated[
        float | None,
        ski_quantity(
            "waist_width_mm",
            "width at its middle, not above the other two",
            (15, 500),
            (40, 350),
            "needed, or a column",
        ),
    ] = None
    tail_width: Annotated[
        float | None,
        ski_quantity("tail_width_mm", "width at its rear end", (15, 500), (40, 350), "needed, or a column"),
    ] = None
    tip_end_width: Annotated[
        float | None,
        ski_quantity(
            "tip_end_width_mm",
            "width at the very tip, not above the tip width",
            (1, 500),
            (5, 200),
            "20 % of the tip width (modelling assumption)",
        ),
    ] = None
    tail_overhang: Annotated[
        float,
        ski_quantity(
            "tail_overhang_mm",
            "length of ski behind the sidecut length; the rest is the tip",
            (0, 500),
            (1, 250),
            "20 (modelling assumption)",
        ),
    ] = TAIL_OVERHANG
    boot_position: Annotated[
        float,
        ski_quantity(
            "boot_position_mm",
            "boot in front of the middle of the running length, negative behind",
            (-500, 500),
            (-200, 200),
            "0 (modelling assumption)",
        ),
    ] = 0.0
    mass: Annotated[
        float | None,
        ski_quantity("mass_kg", "mass of one ski without binding", (0.01, 50), (0.1, 10), "needed, or a column"),
    ] = None
    base: BaseShape = field(default_factory=BaseShape)
    base_bevel: Annotated[
        float,
        ski_quantity(
            "base_bevel_deg", "angle by which the edge strip is ground up from the base", (0, 5), (0.1, 3), "0"
        ),
    ] = 0.0
    edge_width: Annotated[
        float,
        ski_quantity(
            "edge_width_mm",
            "width of that strip, below half the waist",
            (0, 20),
            (0.5, 5),
            "2 (modelling assumption: a usual steel edge)",
        ),
    ] = 2e-3
    side_edge: Annotated[
        float,
        ski_quantity("side_edge_deg", "angle between base and side at the edge", (80, 95), (85, 90), "90"),
    ] = math.pi / 2.0
    edge_radius: Annotated[
        float,
        ski_quantity(
            "edge_radius_mm", "radius of the corner between base and side, within the strip", (0, 2), (0.005, 0.5), "0"
        ),
    ] = 0.0
    bending_stiffness: Annotated[
        tuple[float, ...] | None,
        ski_quantity(
            "EI_N_m2",
            "bending stiffnesses, a list; one value holds everywhere",
            (0.001, 100000000.0),
            (5, 5000),
            "needed, a column, or `rigid`",
        ),
    ] = None
    torsional_stiffness: Annotated[
        tuple[float, ...] | None,
        ski_quantity(
            "GJ_N_m2", "torsional stiffnesses, a list", (0.001, 100000000.0), (2, 5000), "needed, a column, or `rigid`"
        ),
    ] = None
    stiffness_station: Annotated[
        tuple[float, ...] | None,
        ski_quantity(
            "stiffness_station_mm",
            "stations of both lists",
            (-3000, 3000),
            (-1500, 1500),
            "evenly over the running length (modelling assumption)",
        ),
    ] = None
    rigid: Annotated[bool, Quantity("rigid", "`true`: EI and GJ are 10⁶ N m² everywhere", origin="`false`")] = False
    table: Annotated[
        str | None, Quantity("table", "CSV file with columns of the next section, a path from this file", origin="none")
    ] = None
    shape: Annotated[
        str | None, Quantity("shape", "design file of MonkeyCAM, see below, a path from this file", origin="none")
    ] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class StationRow:
    """A row of a ski's table in SI; its origin is the meaning of the column."""

    station: Annotated[
        float,
        ski_quantity(
            "station_m",
            "from the boot, positive forward, falling; needed",
            (-3, 3),
            (-1.5, 2.0),
            "`length_mm`, `tail_overhang_mm`",
        ),
    ]
    width: Annotated[
        float | None, ski_quantity("width_mm", "from edge to edge", (1, 500), (5, 350), "the three widths")
    ] = None
    base_height: Annotated[
        float | None,
        ski_quantity(
            "base_height_mm",
            "of the unloaded base, away from the snow; from any level, the height at the boot is subtracted",
            (-300, 300),
            (-150, 200),
            "camber, shovel, tail and rocker",
        ),
    ] = None
    bending_stiffness: Annotated[
        float | None,
        ski_quantity("EI_N_m2", "bending stiffness", (0.001, 100000000.0), (5, 5000), "the list of that name"),
    ] = None
    torsional_stiffness: Annotated[
        float | None,
        ski_quantity("GJ_N_m2", "torsional stiffness", (0.001, 100000000.0), (2, 5000), "the list of that name"),
    ] = None
    mass_per_length: Annotated[
        float | None, ski_quantity("mass_per_length_kg_per_m", "mass per length", (0.01, 50), (0.1, 10), "`mass_kg`")
    ] = None


SKI_KEYS: Final = {key.name: key for key in quantities(SkiFile)}
"""Every key of a ski file."""
COLUMNS: Final = {column.name: column for column in quantities(StationRow)}
"""Columns of a table, a row for each station from tip to tail."""

WIDTHS: Final = ("tip_width_mm", "waist_width_mm", "tail_width_mm")
TIP_END: Final = "tip_end_width_mm"
BASE: Final = tuple(key.name for key in quantities(BaseShape))
STIFFNESSES: Final = ("EI_N_m2", "GJ_N_m2")
LISTS: Final = (*STIFFNESSES, "stiffness_station_mm")
