"""The regressions: coefficients, intervals, F tests."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from ..table import Column, Table

if TYPE_CHECKING:
    from ..report_data import Json, ReportData

QUANTITY: Final = {
    "S_f_N_per_mm2": ("S_f", "N/mm²"),
    "H_V_N_per_mm3": ("H_V", "N/mm³"),
    "edge_angle_rad": ("edge angle ϑ", "rad"),
    "snow_density_kg_per_m3": ("snow density ρ", "kg/m³"),
    "drop_cone_depth_mm": ("drop-cone depth H_p", "mm"),
    "smp_mean_force_N": ("SnowMicroPen mean force", "N"),
    "smp_snow_density_kg_per_m3": ("SnowMicroPen density", "kg/m³"),
}
"""Symbol and unit of each key that a regression knows."""


def regressions_table(data: ReportData) -> Table:
    """A row for each regression, those without data too."""
    return Table(
        "regressions",
        "Linear regressions with intercept: coefficients with 95 % intervals, goodness of fit and F test of the slope.",
        (
            Column("response", "Response", "words"),
            Column("predictor", "on", "words"),
            Column("group", "group", "text"),
            Column("n", "n", "count"),
            Column("intercept", "intercept", "estimate"),
            Column("slope", "slope", "estimate"),
            Column("slope_by_site", "sites as clusters", "interval"),
            Column("rmse", "RMSE with 1/n"),
            Column("rmse_dof", "RMSE with 1/(n − 2)"),
            Column("r2", "R²"),
            Column("F", "F"),
            Column("p", "p", "p"),
        ),
        [_row(row) for row in data.results["regressions"]],
        note="Intercept and rmse are in the unit of the response, slopes in that per unit of the predictor. Sites as "
        "clusters: the interval of the slope that knows that experiments of one site belong together; it is absent for "
        "a single site and where the sites do not tell. F and p are withheld where the predictor takes fewer than four "
        "different values: whatever else differs between them would show as well.",
    )


def _in_unit(key: str) -> str:
    name, unit = QUANTITY[key]
    return f"{name} ({unit})"


def _row(row: Json) -> tuple[Any, ...]:
    b, ends = row["b"] or (None, None), row["interval"] or (None, None)
    by_site = row["interval_by_site"]
    return (
        _in_unit(row["response"]),
        _in_unit(row["terms"][1]),
        row["group"],
        row["n"],
        (b[0], ends[0]),
        (b[1], ends[1]),
        by_site[1] if by_site else None,
        row["rmse"],
        row["rmse_dof"],
        row["r2"],
        row["F"],
        row["p"],
    )
