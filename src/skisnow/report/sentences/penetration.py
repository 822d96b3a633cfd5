"""What the nine candidate models, their tests, both procedures and the seating say."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from markupsafe import Markup

from ..number_formatting import counted, significant, whole
from ..report_data import numbers, pairs
from ..symbols import html, prose
from ..tables.seating import offsets_that_show

if TYPE_CHECKING:
    from ..report_data import ReportData


def readings_used(data: ReportData) -> Markup:
    """How many readings and series the nine candidate models rest on."""
    row = data.results["penetration"]["models"][0]
    return prose(
        "All nine candidate models are fitted to the same {n} of {m}. With b = 1 the last residual of a series is zero "
        "by definition, because its reading defines the hardness: the RMSE without the defining reading leaves these "
        "out and divides by n − m = {free}.",
        n=counted(row["n"], "reading"),
        m=counted(row["n_series"], "series", "series"),
        free=whole(row["n"] - row["n_series"]),
    )


def procedures_compared(data: ReportData) -> Markup:
    """How H_V of the used series differs between the two procedures."""
    own = numbers(data.penetration, "H_V_N_per_mm3")
    fitted = numbers(data.results["penetration"]["errors_in_depth"]["experiments"], "H_V_N_per_mm3")
    known = data.penetration_used & np.isfinite(own) & np.isfinite(fitted)
    if not known.any():
        return html("")
    ratio = np.percentile(fitted[known] / own[known], (5.0, 50.0, 95.0))
    return prose(
        "H_V from all readings over H_V from the largest load: median {middle}, 90 % of the series between {low} and "
        "{high}. Each experiment's two values stand in {file}.",
        low=significant(float(ratio[0])),
        middle=significant(float(ratio[1])),
        high=significant(float(ratio[2])),
        file=_file("hardness_by_procedure", data),
    )


def seating_found(data: ReportData) -> list[Markup]:
    """How large the offsets are and how many of them show."""
    rows = data.seating
    without = int(data.penetration_used.sum()) - len(rows)
    if not rows:
        return [html("No used series has the readings that an offset can be estimated from.")]
    half = np.diff(pairs(rows, "interval_mm"), axis=1) / 2.0
    found = [
        prose(
            "{shown} of {all} have an offset whose 95 % interval leaves out zero; the median half-width of the "
            "intervals is {half} mm. Every offset stands in {file}.",
            shown=whole(offsets_that_show(rows)),
            all=counted(len(rows), "used series", "used series"),
            half=significant(float(np.nanmedian(half))),
            file=_file("seating", data),
        )
    ]
    if without:
        found.append(prose("For {n} no offset could be estimated.", n=counted(without, "used series", "used series")))
    return found


def unloading_found(data: ReportData) -> list[Markup]:
    """How many series determine k_u / H_V, and their mean."""
    used = [row for row in data.unloaded if row["used"]]
    resolved = [row for row in used if row["unloading_ratio_interval"] is not None]
    found = [
        prose(
            "{resolved} of {all} give both ends of k_u / H_V; of the others only the lower end is known, the "
            "inverse of the upper end of H_V / k_u. Every series stands in {file}.",
            resolved=whole(len(resolved)),
            all=counted(len(used), "used series with unloading", "used series with unloading"),
            file=_file("unloading", data),
        )
    ]
    return found if used else [html("No used series was unloaded.")]


def _file(name: str, data: ReportData) -> Markup:
    return Markup("<code>tables/{}{}.csv</code>").format(name, "_synthetic" if data.synthetic else "")
