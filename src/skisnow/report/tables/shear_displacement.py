"""The shear displacement u_y, by site and by experiment."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..table import Column, Table

if TYPE_CHECKING:
    from ..report_data import ReportData

_DISPLACEMENT = Column("shear_displacement_mm", "u_y", "estimate", "mm")


def displacement_sites_table(data: ReportData) -> Table:
    """A row for each site with turning angles; with several sites a last row for all."""
    found = data.results["shear"]["displacement"]
    rows = [
        (
            "all sites" if row["site"] is None else row["site"],
            row["n"],
            (row["shear_displacement_mm"], row["shear_displacement_interval_mm"]),
        )
        for row in found
        if row["site"] is not None or len(found) > 2
    ]
    return Table(
        "shear_displacement_sites",
        "Shear displacement by site: geometric means with 95 % intervals from the scatter between the tests.",
        (Column("site", "Site", "text"), Column("n", "tests", "count"), _DISPLACEMENT),
        rows,
    )


def displacement_table(data: ReportData) -> Table:
    """Every shear experiment with turning angles."""
    rows = [
        (
            row["experiment"],
            row["site"],
            row["edge_angle_deg"],
            row["n_turning"],
            row["used"],
            (row["shear_displacement_mm"], row["shear_displacement_interval_mm"]),
        )
        for row in data.shear
        if row["n_turning"]
    ]
    columns = (
        Column("experiment", "Experiment", "text"),
        Column("site", "Site", "text"),
        Column("edge_angle_deg", "ϑ", "angle", "°"),
        Column("n_turning", "rising readings", "count"),
        Column("used", "used", "yes"),
        _DISPLACEMENT,
    )
    return Table("shear_displacement", "Shear displacement u_y of each test, with 95 % intervals.", columns, rows)
