"""Offsets of the depth zero: their distribution, the largest effects, and all of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from ..report_data import numbers, pairs
from ..table import Column, Table

if TYPE_CHECKING:
    from ..report_data import FloatArray, Json, ReportData

QUANTILES: Final = (0.0, 5.0, 25.0, 50.0, 75.0, 95.0, 100.0)
LARGEST: Final = 12
_OFFSET = Column("depth_offset_mm", "offset δ", "estimate", "mm")
_CHANGE = Column("H_V_change_percent", "H_V would change by", unit="%")


def offsets_that_show(rows: list[Json]) -> int:
    """How many offsets have an interval without zero."""
    ends = pairs(rows, "interval_mm")
    return int(np.sum((ends[:, 0] > 0) | (ends[:, 1] < 0)))


def seating_quantiles_table(data: ReportData) -> Table:
    """Quantiles over the used series."""
    found = data.seating
    offset, change = numbers(found, "depth_offset_mm"), numbers(found, "H_V_change_percent")
    rows = [(_quantile_name(share), _quantile(offset, share), _quantile(change, share)) for share in QUANTILES]
    return Table(
        "seating_distribution",
        "Offsets of the depth zero over the used series, and what taking them off would do to H_V: quantiles, each "
        "column by itself.",
        (
            Column("quantile", "Quantile", "words"),
            Column("depth_offset_mm", "offset δ", unit="mm"),
            Column("H_V_change_percent", "H_V would change by", unit="%"),
        ),
        rows if found else [],
    )


def _quantile_name(share: float) -> str:
    names = {0.0: "minimum", 50.0: "median", 100.0: "maximum"}
    return names.get(share, f"{share:g} %")


def _quantile(values: FloatArray, share: float) -> float | None:
    known = values[np.isfinite(values)]
    return float(np.percentile(known, share)) if known.size else None


def seating_largest_table(data: ReportData) -> Table:
    """The series whose hardness would move most."""
    change = numbers(data.seating, "H_V_change_percent")
    by_factor = np.abs(np.log(np.maximum(1.0 + change / 100.0, 1e-6)))
    order = np.argsort(-by_factor, kind="stable")[: min(LARGEST, int(np.isfinite(by_factor).sum()))]
    found = [data.seating[index] for index in order.tolist()]
    rows = [
        (
            row["experiment"],
            row["site"],
            row["edge_angle_deg"],
            row["H_V_N_per_mm3"],
            (row["depth_offset_mm"], row["interval_mm"]),
            row["H_V_change_percent"],
        )
        for row in found
    ]
    return Table(
        "seating_largest",
        f"The {LARGEST} used series whose H_V would change most, by factor, if their offset were taken off."
        if len(rows) == LARGEST
        else "The used series in the order of how much H_V would change, by factor, if their offset were taken off.",
        (
            Column("experiment", "Experiment", "text"),
            Column("site", "Site", "text"),
            Column("edge_angle_deg", "ϑ", "angle", "°"),
            Column("H_V_N_per_mm3", "H_V", unit="N/mm³"),
            _OFFSET,
            _CHANGE,
        ),
        rows,
    )


def seating_table(data: ReportData) -> Table:
    """Every experiment."""
    rows = [
        (own["experiment"], own["site"], own["used"], (row["depth_offset_mm"], row["interval_mm"]), row[_CHANGE.key])
        for own, row in zip(data.penetration, data.results["penetration"]["seating"], strict=True)
    ]
    return Table(
        "seating",
        "Offset of the depth zero of each penetration experiment, with 95 % interval.",
        (
            Column("experiment", "Experiment", "text"),
            Column("site", "Site", "text"),
            Column("used", "used", "yes"),
            _OFFSET,
            _CHANGE,
        ),
        rows,
        rows_in_html=0,
    )
