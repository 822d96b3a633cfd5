"""Keys of a ski file and columns of its table: each with range, usual range and synonyms."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Annotated, Final

from ..parameters import Allowed, Quantity, quantities
from .layout import TAIL_OVERHANG, BaseShape

RIGID: Final = 1e6
"""EI and GJ of a rigid ski (N m²). Modelling assumption: 200 mm of it, held in the middle, bend by 0.03 micrometre
under 500 N."""


def _width(of: str, meaning: str) -> Quantity:
    """Quantity of the width of tip, waist or tail, with its range (mm)."""
    return Quantity(f"{of}_width_mm", meaning, lowest=15, highest=500, usual=(40, 350), origin="needed, or a column")


@dataclass(frozen=True, slots=True, kw_only=True)
class SkiFile:
    """A ski file in SI; None for missing keys without a default. Lists go from tip to tail."""

    name: Annotated[str | None, Quantity("name", "name of the ski", origin="the file's name")] = None
    source: Annotated[str | None, Quantity("source", "where the numbers come from", origin="the file's name")] = None
    length: Annotated[
        float | None,
        Quantity("length_mm", "from tip to tail along the base; at least 2.5 times the tip width"),
        Allowed(20, 3000, usual=(180, 2300), origin="needed; with a table: its reach"),
    ] = None
    running_length: Annotated[
        float | None,
        Quantity("running_length_mm", "between the contact points of the base"),
        Allowed(20, 3000, usual=(180, 2300), origin="needed"),
    ] = None
    sidecut_length: Annotated[
        float | None,
        Quantity("sidecut_length_mm", "between the widest points in front and behind"),
        Allowed(20, 3000, usual=(180, 2300), origin="needed"),
    ] = None
    tip_width: Annotated[float | None, _width("tip", "width at the front end of the sidecut length")] = None
    waist_width: Annotated[float | None, _width("waist", "width at its middle, not above the other two")] = None
    tail_width: Annotated[float | None, _width("tail", "width at its rear end")] = None
    tip_end_width: Annotated[
        float | None,
        Quantity("tip_end_width_mm", "width at the very tip, not above the tip width"),
        Allowed(1, 500, usual=(5, 200), origin="20 % of the tip width (modelling assumption)"),
    ] = None
    tail_overhang: Annotated[
        float,
        Quantity("tail_overhang_mm", "length of ski behind the sidecut length; the rest is the tip"),
        Allowed(0, 500, usual=(1, 250), origin="20 (modelling assumption)"),
    ] = TAIL_OVERHANG
    boot_position: Annotated[
        float,
        Quantity("boot_position_mm", "boot in front of the middle of the running length, negative behind"),
        Allowed(-500, 500, usual=(-200, 200), origin="0 (modelling assumption)"),
    ] = 0.0
    mass: Annotated[
        float | None,
        Quantity("mass_kg", "mass of one ski without binding"),
        Allowed(0.01, 50, usual=(0.1, 10), origin="needed, or a column"),
    ] = None
    base: BaseShape = field(default_factory=BaseShape)
    base_bevel: Annotated[
        float,
        Quantity("base_bevel_deg", "angle by which the edge strip is ground up from the base"),
        Allowed(0, 5, usual=(0.1, 3), origin="0"),
    ] = 0.0
    edge_width: Annotated[
        float,
        Quantity("edge_width_mm", "width of that strip, below half the waist"),
        Allowed(0, 20, usual=(0.5, 5), origin="2 (modelling assumption: a usual steel edge)"),
    ] = 2e-3
    side_edge: Annotated[
        float,
        Quantity("side_edge_deg", "angle between base and side at the edge"),
        Allowed(80, 95, usual=(85, 90), origin="90"),
    ] = math.pi / 2.0
    edge_radius: Annotated[
        float,
        Quantity("edge_radius_mm", "radius of the corner between base and side, within the strip"),
        Allowed(0, 2, usual=(0.005, 0.5), origin="0"),
    ] = 0.0
    bending_stiffness: Annotated[
        tuple[float, ...] | None,
        Quantity("EI_N_m2", "bending stiffnesses, a list; one value holds everywhere"),
        Allowed(0.001, 100000000.0, usual=(5, 5000), origin="needed, a column, or `rigid`"),
    ] = None
    torsional_stiffness: Annotated[
        tuple[float, ...] | None,
        Quantity("GJ_N_m2", "torsional stiffnesses, a list"),
        Allowed(0.001, 100000000.0, usual=(2, 5000), origin="needed, a column, or `rigid`"),
    ] = None
    stiffness_station: Annotated[
        tuple[float, ...] | None,
        Quantity("stiffness_station_mm", "stations of both lists"),
        Allowed(-3000, 3000, usual=(-1500, 1500), origin="evenly over the running length (modelling assumption)"),
    ] = None
    rigid: Annotated[bool, Quantity("rigid", "`true`: EI and GJ are 10⁶ N m² everywhere", origin="`false`")] = False
    table: Annotated[
        str | None, Quantity("table", "CSV file with columns of the next section, a path from this file", origin="none")
    ] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class StationRow:
    """A row of a ski's table in SI; `origin` of a column: what replaces it if it is missing."""

    station: Annotated[
        float,
        Quantity("station_m", "from the boot, positive forward, falling; needed"),
        Allowed(-3, 3, usual=(-1.5, 2.0), origin="`length_mm`, `tail_overhang_mm`"),
    ]
    width: Annotated[
        float | None,
        Quantity("width_mm", "from edge to edge"),
        Allowed(1, 500, usual=(5, 350), origin="the three widths"),
    ] = None
    base_height: Annotated[
        float | None,
        Quantity(
            "base_height_mm",
            "of the unloaded base, away from the snow; from any level, the height at the boot is subtracted",
        ),
        Allowed(-300, 300, usual=(-150, 200), origin="camber, shovel, tail and rocker"),
    ] = None
    bending_stiffness: Annotated[
        float | None,
        Quantity("EI_N_m2", "bending stiffness"),
        Allowed(0.001, 100000000.0, usual=(5, 5000), origin="the list of that name"),
    ] = None
    torsional_stiffness: Annotated[
        float | None,
        Quantity("GJ_N_m2", "torsional stiffness"),
        Allowed(0.001, 100000000.0, usual=(2, 5000), origin="the list of that name"),
    ] = None
    mass_per_length: Annotated[
        float | None,
        Quantity("mass_per_length_kg_per_m", "mass per length"),
        Allowed(0.01, 50, usual=(0.1, 10), origin="`mass_kg`"),
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
