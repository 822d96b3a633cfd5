"""Tables with one row for each experiment: hardness, shear stress, seating, unloading, displacement."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from ..._support.messages import Message
from ..._support.units import MM
from ..table import Column, Table, record_table
from .data import Json, ReportData, pairs

EXPERIMENT: Final = Column("experiment", Message("Experiment"), "text")
SITE: Final = Column("site", Message("Site"), "text")
ANGLE: Final = Column("edge_angle_deg", "ϑ", "angle", "°")
USED: Final = Column("used", Message("used"), "yes")
FLAGS: Final = Column("flags", Message("flags"), "codes")
HARDNESS: Final = Column("H_V_N_per_mm3", "H_V", unit="N/mm³")

_OFFSET: Final = Column("depth_offset_mm", Message("offset δ"), "estimate", "mm", interval="interval_mm")
_CHANGE: Final = Column("H_V_change_percent", Message("H_V would change by"), unit="%")
_GROWTH: Final = Column("growth_percent", Message("growth γ"), "estimate", "%", interval="growth_interval_percent")
_UNLOADING: Final = (
    Column("unloading_ratio", "k_u / H_V", "estimate", interval="unloading_ratio_interval"),
    Column("rebound_ratio_interval", "H_V / k_u, 95 %", "interval"),
    Column("k_u_N_per_mm3", "k_u", "estimate", "N/mm³", interval="k_u_interval_N_per_mm3"),
)
_DISPLACEMENT: Final = Column(
    "shear_displacement_mm", "u_y", "estimate", "mm", interval="shear_displacement_interval_mm"
)


def penetration_table(data: ReportData) -> Table:
    """Table with one row per penetration experiment: H_e, H_A and H_V with intervals, and its flags."""
    columns = (
        EXPERIMENT,
        SITE,
        Column("tool", Message("Tool"), "text"),
        ANGLE,
        Column("n_loads", Message("loads"), "count"),
        USED,
        FLAGS,
        Column("H_e_N_per_mm", "H_e", "estimate", "N/mm", interval="H_e_interval_N_per_mm"),
        Column("H_A_N_per_mm2", "H_A", "estimate", "N/mm²", interval="H_A_interval_N_per_mm2"),
        Column("H_V_N_per_mm3", "H_V", "estimate", "N/mm³", interval="H_V_interval_N_per_mm3"),
    )
    caption = Message("Penetration experiments: hardness from the largest load (Eqn 1) with 95 % interval.")
    return record_table("penetration_experiments", caption, columns, data.penetration)


def shear_table(data: ReportData) -> Table:
    """Every shear experiment with its force and failure shear stress."""
    tests = data.campaign.shear
    depths = [] if tests is None else (tests.penetration_depth / MM).tolist()
    records = [row | {"depth_mm": depth} for row, depth in zip(data.shear, depths, strict=True)]
    columns = (
        EXPERIMENT,
        SITE,
        Column("plate", Message("Plate"), "text"),
        ANGLE,
        Column("depth_mm", "e", unit="mm"),
        Column("F_t_N", "F_t", unit="N"),
        Column("S_f_N_per_mm2", "S_f", "estimate", "N/mm²", interval="S_f_interval_N_per_mm2"),
        USED,
        FLAGS,
    )
    caption = Message(
        "Shear experiments: force and failure shear stress (Eqns 7 to 9) with the 95 % interval that the instruments "
        "allow."
    )
    return record_table("shear_experiments", caption, columns, records)


def count_resolved_offsets(rows: list[Json]) -> int:
    """Number of offsets whose interval excludes zero."""
    ends = pairs(rows, "interval_mm")
    return int(np.sum((ends[:, 0] > 0) | (ends[:, 1] < 0)))


def seating_table(data: ReportData) -> Table:
    """Offset of the depth zero of every penetration experiment."""
    records = _with_details(data, data.results["penetration"]["seating"])
    caption = "Offset of the depth zero of each penetration experiment, with 95 % interval."
    return record_table("seating", caption, (EXPERIMENT, SITE, USED, _OFFSET, _CHANGE), records, rows_in_html=0)


def growth_table(data: ReportData) -> Table:
    """Hardness at the surface and its growth with depth, by experiment."""
    records = _with_details(data, data.results["penetration"]["growing_hardness"]["experiments"])
    caption = (
        "Hardness at the surface and its growth down to the depth of the largest load, of each penetration experiment."
    )
    columns = (EXPERIMENT, SITE, USED, HARDNESS, Column("H_0_N_per_mm3", "H_0", unit="N/mm³"), _GROWTH)
    return record_table("hardness_growth", caption, columns, records, rows_in_html=0)


def growth_sites_table(data: ReportData) -> Table:
    """Table with one row per site: number of series and growth γ of the hardness with its 95 % interval."""
    return _sites_table(
        "hardness_growth_sites",
        Message(
            "A hardness that grows linearly with depth, F = H_0 (V + γ W/e₇): its growth γ from the surface to the "
            "depth of the largest load, by site, with 95 % intervals."
        ),
        (SITE, Column("n", Message("series"), "count"), _GROWTH),
        data.results["penetration"]["growing_hardness"]["sites"],
        note=Message(
            "The mean is that of ln(1 + γ) over the used series; its interval comes from their scatter, over all sites "
            "from the scatter between sites. An interval that contains 0 agrees with even snow."
        ),
    )


def unloading_table(data: ReportData) -> Table:
    """Every penetration experiment with readings during unloading."""
    columns = (EXPERIMENT, SITE, ANGLE, Column("n_unloading", "readings", "count"), USED, *_UNLOADING)
    caption = "Unloading of each penetration experiment whose discs were taken off one by one, with 95 % intervals."
    return record_table("unloading", caption, columns, data.unloaded, rows_in_html=0)


def unloading_sites_table(data: ReportData) -> Table:
    """k_u / H_V and k_u, by site."""
    return _sites_table(
        "unloading_sites",
        Message("Unloading by site: k_u / H_V and k_u with 95 % intervals."),
        (SITE, Column("n", Message("series"), "count"), *_UNLOADING),
        data.results["penetration"]["unloading"],
        note=Message(
            "k_u / H_V is the harmonic mean over the series, which keeps the mean rebound, with the scatter between "
            "the series and that within each in its interval; k_u is the geometric mean. Over all sites the series "
            "count as draws from one snow for the ratio, and k_u has an interval from four sites on."
        ),
    )


def displacement_table(data: ReportData) -> Table:
    """Every shear experiment with turning angles."""
    records = [row for row in data.shear if row["n_turning"]]
    columns = (EXPERIMENT, SITE, ANGLE, Column("n_turning", Message("rising readings"), "count"), USED, _DISPLACEMENT)
    caption = Message("Shear displacement u_y of each test, with 95 % intervals.")
    return record_table("shear_displacement", caption, columns, records)


def displacement_sites_table(data: ReportData) -> Table:
    """Table with the mean shear displacement u_y of each site and its 95 % interval."""
    return _sites_table(
        "shear_displacement_sites",
        Message("Shear displacement by site: geometric means with 95 % intervals from the scatter between the tests."),
        (SITE, Column("n", Message("tests"), "count"), _DISPLACEMENT),
        data.results["shear"]["displacement"],
    )


def _with_details(data: ReportData, details: list[Json]) -> list[Json]:
    """Rows of the penetration experiments, each with its row of another part of the results."""
    return [row | detail for row, detail in zip(data.penetration, details, strict=True)]


def _sites_table(name: str, caption: str, columns: tuple[Column, ...], rows: list[Json], note: str = "") -> Table:
    """One row for each site, and one for all sites if there are several."""
    records: list[dict[str, Any]] = [
        row | {"site": Message("all sites") if row["site"] is None else row["site"]}
        for row in rows
        if row["site"] is not None or len(rows) > 2
    ]
    return record_table(name, caption, columns, records, note=note)
