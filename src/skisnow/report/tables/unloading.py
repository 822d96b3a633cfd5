"""The way back: k_u / H_V and k_u by site and by experiment."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..table import Column, Table

if TYPE_CHECKING:
    from ..report_data import ReportData

_RATIO = Column("unloading_ratio", "k_u / H_V", "estimate")
_STIFFNESS = Column("k_u_N_per_mm3", "k_u", "estimate", "N/mm³")
_REBOUND = Column("rebound_ratio_interval", "H_V / k_u, 95 %", "interval")


def unloading_sites_table(data: ReportData) -> Table:
    """A row for each site with readings while discs were taken off; with several sites a last row for all."""
    found = data.results["penetration"]["unloading"]
    rows = [
        (
            "all sites" if row["site"] is None else row["site"],
            row["n"],
            (row["unloading_ratio"], row["unloading_ratio_interval"]),
            row["rebound_ratio_interval"],
            (row["k_u_N_per_mm3"], row["k_u_interval_N_per_mm3"]),
        )
        for row in found
        if row["site"] is not None or len(found) > 2
    ]
    columns = (Column("site", "Site", "text"), Column("n", "series", "count"), _RATIO, _REBOUND, _STIFFNESS)
    return Table(
        "unloading_sites",
        "Unloading by site: k_u / H_V and k_u with 95 % intervals.",
        columns,
        rows,
        note="k_u / H_V is the harmonic mean over the series, which keeps the mean rebound, with the scatter between "
        "the series and that within each in its interval; k_u is the geometric mean. Over all sites the series count "
        "as draws from one snow for the ratio, and k_u has an interval from four sites on.",
    )


def unloading_table(data: ReportData) -> Table:
    """Every experiment with readings while discs were taken off."""
    rows = [
        (
            row["experiment"],
            row["site"],
            row["edge_angle_deg"],
            row["n_unloading"],
            row["used"],
            (row["unloading_ratio"], row["unloading_ratio_interval"]),
            row["rebound_ratio_interval"],
            (row["k_u_N_per_mm3"], row["k_u_interval_N_per_mm3"]),
        )
        for row in data.unloaded
    ]
    columns = (
        Column("experiment", "Experiment", "text"),
        Column("site", "Site", "text"),
        Column("edge_angle_deg", "ϑ", "angle", "°"),
        Column("n_unloading", "readings", "count"),
        Column("used", "used", "yes"),
    )
    return Table(
        "unloading",
        "Unloading of each penetration experiment whose discs were taken off one by one, with 95 % intervals.",
        (*columns, _RATIO, _REBOUND, _STIFFNESS),
        rows,
        rows_in_html=0,
    )
