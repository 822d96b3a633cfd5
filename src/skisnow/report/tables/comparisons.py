"""Sites against each other, and the campaign against what others published."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from ..table import Column, Table

if TYPE_CHECKING:
    from ..report_data import Json, ReportData

_QUANTITY: Final = {
    "H_V_N_per_mm3": "H_V in N/mm³",
    "S_f_N_per_mm2": "S_f in N/mm²",
    "b0": "b_0 of Eqn 11",
    "b1_per_rad": "b_1 of Eqn 11, per rad",
}


def site_comparison_table(data: ReportData) -> Table:
    """Every pair of sites."""
    rows = [
        (
            row["quantity"],
            row["site_a"],
            row["site_b"],
            (row["ratio"], row["interval"]),
            row["p"],
            row["n_for_10_percent"],
        )
        for row in data.results["site_comparisons"]
    ]
    return Table(
        "site_comparisons",
        "Is one site harder than another: ratio of the geometric means of site A over site B, with 95 % interval.",
        (
            Column("quantity", "Quantity", "words"),
            Column("site_a", "Site A", "text"),
            Column("site_b", "Site B", "text"),
            Column("ratio", "A / B", "estimate"),
            Column("p", "p", "p"),
            Column("n_for_10_percent", "tests per site to tell 10 %", "count"),
        ),
        rows,
        note="Welch's test on logarithms, each pair by itself: of twenty pairs of equal sites one is expected below "
        "p = 0.05. Last column: tests at each site that would find a difference of 10 % with a power of 80 %.",
    )


def published_table(data: ReportData) -> Table:
    """Each published value or range beside the campaign's own."""
    return Table(
        "comparisons",
        "Published values beside this campaign's own: mean (H_V: geometric) with 95 % interval, and range over the "
        "used experiments.",
        (
            Column("source", "Source", "text"),
            Column("quantity", "Quantity", "words"),
            Column("value", "published"),
            Column("range", "published range", "range"),
            Column("own", "this campaign", "estimate"),
            Column("own_range", "its range", "range"),
            Column("own_over_published", "own / published"),
        ),
        [_row(row) for row in data.results["comparisons"]],
    )


def _row(row: Json) -> tuple[Any, ...]:
    value, own = row.get("value"), row["own"]
    return (
        row["source"],
        _QUANTITY.get(row["quantity"], row["quantity"]),
        value,
        row.get("range"),
        (own, row["own_interval"]),
        row.get("own_range"),
        own / value if own is not None and value else None,
    )
