"""Each regression in a sentence: how large the slope is, or how large it could still be."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from ..number_formatting import interval, p_equals, significant
from ..symbols import html, prose
from ..tables.regressions import QUANTITY
from .key_results import SIGNIFICANT

if TYPE_CHECKING:
    from markupsafe import Markup

    from ..report_data import Json, ReportData

_STEP: Final = {
    "edge_angle_rad": (math.pi / 2.0, "from 0° to 90°"),
    "snow_density_kg_per_m3": (100.0, "per 100 kg/m³"),
    "drop_cone_depth_mm": (10.0, "per 10 mm"),
    "smp_mean_force_N": (1.0, "per 1 N"),
    "smp_snow_density_kg_per_m3": (100.0, "per 100 kg/m³"),
    "H_V_N_per_mm3": (1.0, "per 1 N/mm³"),
}
"""A step of each predictor that a person can picture, in its unit."""
MOST_SENTENCES: Final = 40


def regression_sentences(data: ReportData) -> list[Markup]:
    """A sentence for each regression, those without data too."""
    rows = data.results["regressions"]
    found = [_sentence(row) for row in rows[:MOST_SENTENCES]]
    if len(rows) > MOST_SENTENCES:
        found.append(html(f"{len(rows) - MOST_SENTENCES} further regressions stand in the table alone."))
    return found


def _sentence(row: Json) -> Markup:
    head = prose(
        "{response} on {predictor}, {group} (n = {n}):",
        response=html(QUANTITY[row["response"]][0]),
        predictor=html(QUANTITY[row["terms"][1]][0]),
        group="all sites" if row["group"] == "all" else row["group"],
        n=row["n"],
    )
    if row["b"] is None:
        reason = " no data." if row["n"] == 0 else " no slope: too few experiments, or the predictor does not vary."
        return head + html(reason)
    if row["withheld"]:
        return head + _not_judged(row)
    if row["p"] is None:
        return head + html(" too few experiments for an interval or a test.")
    return head + (_significant(row) if row["p"] < SIGNIFICANT else _not_significant(row))


def _significant(row: Json) -> Markup:
    return prose(
        " significant ({p}); {response} changes by {change} {unit} {step}, 95 % interval {ends}.",
        p=p_equals(row["p"]),
        response=html(QUANTITY[row["response"]][0]),
        change=_change(row, row["b"][1]),
        unit=QUANTITY[row["response"]][1],
        step=_STEP[row["terms"][1]][1],
        ends=_changes(row, row["interval"][1]),
    ) + _by_site(row)


def _not_significant(row: Json) -> Markup:
    return prose(
        " not significant ({p}); yet {response} could still change by anything in {ends} {unit} {step} (95 % interval; "
        "estimate {change}).",
        p=p_equals(row["p"]),
        response=html(QUANTITY[row["response"]][0]),
        ends=_changes(row, row["interval"][1]),
        unit=QUANTITY[row["response"]][1],
        step=_STEP[row["terms"][1]][1],
        change=_change(row, row["b"][1]),
    ) + _by_site(row)


def _not_judged(row: Json) -> Markup:
    return prose(
        " not judged: {reason}; the slope over them is {change} {unit} {step}.",
        reason=row["withheld"],
        change=_change(row, row["b"][1]),
        unit=QUANTITY[row["response"]][1],
        step=_STEP[row["terms"][1]][1],
    )


def _change(row: Json, slope: float) -> str:
    return significant(slope * _STEP[row["terms"][1]][0])


def _changes(row: Json, slopes: list[float] | None) -> str:
    factor = _STEP[row["terms"][1]][0]
    return interval(None if slopes is None else [end * factor for end in slopes])


def _by_site(row: Json) -> Markup:
    if row["interval_by_site"] is None:
        return html("")
    ends = row["interval_by_site"][1]
    if ends is None:
        return html(" The sites do not tell an interval of their own.")
    zero = ends[0] <= 0.0 <= ends[1]
    sentence = prose(" With sites as clusters the interval is {ends}", ends=_changes(row, ends))
    if zero and row["p"] < SIGNIFICANT:
        return sentence + html(": it contains zero, so what looks significant may be a difference between a few sites.")
    if not zero and row["p"] >= SIGNIFICANT:
        return sentence + html(": it leaves out zero.")
    return sentence + html(".")
