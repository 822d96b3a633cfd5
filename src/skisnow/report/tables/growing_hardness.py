"""Hardness that grows with depth: by site and by experiment."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..table import Column, Table

if TYPE_CHECKING:
    from ..report_data import ReportData

_GROWTH = Column("growth_percent", "growth γ", "estimate", "%")


def hardness_growth_sites_table(data: ReportData) -> Table:
    """A row for each site; with several sites a last row for all."""
    found = data.results["penetration"]["growing_hardness"]["sites"]
    rows = [
        (
            "all sites" if row["site"] is None else row["site"],
            row["n"],
            (row["growth_percent"], row["growth_interval_percent"]),
        )
        for row in found
        if row["site"] is not None or len(found) > 2
    ]
    return Table(
        "hardness_growth_sites",
        "A hardness that grows linearly with depth, F = H_0 (V + γ W/e₇): its growth γ from the surface to the depth "
        "of the largest load, by site, with 95 % intervals.",
        (Column("site", "Site", "text"), Column("n", "series", "count"), _GROWTH),
        rows,
        note="The mean is that of ln(1 + γ) over the used series; its interval comes from their scatter, over all "
        "sites from the scatter between sites. An interval that contains 0 agrees with even snow.",
    )


def hardness_growth_table(data: ReportData) -> Table:
    """Every experiment."""
    found = data.results["penetration"]["growing_hardness"]["experiments"]
    rows = [
        (
            own["experiment"],
            own["site"],
            own["used"],
            own["H_V_N_per_mm3"],
            row["H_0_N_per_mm3"],
            (row["growth_percent"], row["growth_interval_percent"]),
        )
        for own, row in zip(data.penetration, found, strict=True)
    ]
    columns = (
        Column("experiment", "Experiment", "text"),
        Column("site", "Site", "text"),
        Column("used", "used", "yes"),
        Column("H_V_N_per_mm3", "H_V", unit="N/mm³"),
        Column("H_0_N_per_mm3", "H_0", unit="N/mm³"),
    )
    return Table(
        "hardness_growth",
        "Hardness at the surface and its growth down to the depth of the largest load, of each penetration experiment.",
        (*columns, _GROWTH),
        rows,
        rows_in_html=0,
    )
