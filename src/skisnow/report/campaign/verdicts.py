"""Sentences of a campaign: verdicts that compare sites and the like, caveats, models, seating, unloading."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from typing import Any, Final

import numpy as np
from markupsafe import Markup

from ..._support.messages import Message, template
from ...campaign.records import Campaign
from ...estimation.group_comparisons import DIFFERENCE, LEVEL, compare_campaign
from ...estimation.screening import screened_both
from ..formatting import html, prose, significant, whole
from .data import Json, ReportData, numbers, pairs
from .series_tables import count_resolved_offsets

MOST_PAIRS: Final = 3
"""Pairs that each have a sentence; of more pairs, only those that are not certain have one, up to this number."""
PERCENT_TO: Final = 3.0  # ratio from which a difference is given as a multiple instead of in percent
_SITES: Final = {
    "H_V": (
        template("{a} is harder than {b} by {percent:.0f} %{interval}"),
        template("{a} is {ratio:.3g} times as hard as {b}{interval}"),
    ),
    "S_f": (
        template("{a} has a larger shear strength than {b}, by {percent:.0f} %{interval}"),
        template("{a} has {ratio:.3g} times the shear strength of {b}{interval}"),
    ),
}
_OTHERS: Final = {
    "H_V": (
        template("The hardness is larger for {a} than for {b}, at the same sites, by {percent:.0f} %{interval}"),
        template("The hardness for {a} is {ratio:.3g} times that for {b}, at the same sites{interval}"),
    ),
    "S_f": (
        template("The shear strength is larger for {a} than for {b}, at the same sites, by {percent:.0f} %{interval}"),
        template("The shear strength for {a} is {ratio:.3g} times that for {b}, at the same sites{interval}"),
    ),
}
_SURVEY: Final = {
    "H_V": template(
        "{certain} of {pairs} pairs of sites differ in hardness; {a} is the hardest site and {b} the softest"
    ),
    "S_f": template(
        "{certain} of {pairs} pairs of sites differ in shear strength; it is largest at {a}, smallest at {b}"
    ),
}


def verdicts(results: Mapping[str, Any]) -> list[Message]:
    """Sentences that compare pairs of sites (of many, a survey and uncertain pairs), then tools, observers and days.

    results: contents of `skisnow.results_dict`.
    """
    return _row_verdicts(results["group_comparisons"], results["provenance"]["options"]["difference_percent"])


def quick_verdicts(campaign: Campaign, quantity: str) -> list[Message]:
    """The verdicts on H_V or S_f of a campaign that is still being entered, without the other results."""
    penetration, shear = screened_both(campaign, geometry="extended")
    pairs = compare_campaign(campaign, penetration, shear)
    return _row_verdicts([asdict(pair) for pair in pairs if pair.quantity == quantity], 100.0 * DIFFERENCE)


def _row_verdicts(rows: list[Json], difference: float) -> list[Message]:
    """Sentences that compare groups; of many pairs a summary and the most certain of the others."""
    kinds: dict[tuple[str, str], list[Json]] = {}
    for row in rows:
        kinds.setdefault((row["quantity"], row["by"]), []).append(row)
    sentences = []
    for (quantity, by), of_kind in kinds.items():
        shown = of_kind
        if len(of_kind) > MOST_PAIRS:
            uncertain = [row for row in of_kind if not _is_certain(row)]
            shown = sorted(uncertain, key=lambda row: row["p"] if _is_number(row["p"]) else 2.0)[:MOST_PAIRS]
            if by == "site":
                won = Counter(row["group_a"] if row["ratio"] > 1.0 else row["group_b"] for row in of_kind)
                lost = Counter(row["group_b"] if row["ratio"] > 1.0 else row["group_a"] for row in of_kind)
                names = {"a": won.most_common(1)[0][0], "b": lost.most_common(1)[0][0]}
                certain = len(of_kind) - len(uncertain)
                survey = Message(_SURVEY[quantity], certain=certain, pairs=len(of_kind), **names)
                sentences.append(Message("{survey} (corrected for the number of pairs).", survey=survey))
        sentences += [verdict(row, difference) for row in shown]
    return sentences


def _is_number(value: float | None) -> bool:
    """True for a finite number; False for None."""
    return value is not None and math.isfinite(value)


def _is_certain(row: Json) -> bool:
    """True if the p value, corrected for the number of pairs, is below the level."""
    return _is_number(row["p_holm"]) and bool(row["p_holm"] < LEVEL)


def verdict(row: Json, difference_percent: float) -> Message:
    """Sentence about one pair: which is larger, by how much, whether that is certain, and how many tests it takes.

    row: an entry of ``group_comparisons`` in the results.
    difference_percent: the difference that ``n_needed`` of the row is for.
    """
    comparison, ends = _comparison(row)
    limit, needed, several = 1.0 + difference_percent / 100.0, row["n_needed"], row["n_pairs"] > 1
    p, p_text = row["p_holm"] if several else row["p"], ""
    if _is_number(p):
        p_text = Message("p < 0.001") if p < 0.001 else Message("p = {p:.2g}", p=p)
    fields = {"comparison": comparison, "p": p_text, "pairs": row["n_pairs"]}
    if _is_certain(row):
        if several:
            return Message("{comparison}: certain ({p}, corrected for {pairs} pairs).", **fields)
        return Message("{comparison}: certain ({p}).", **fields)
    if ends is None or needed is None:
        return Message(
            "{comparison}: not certain. Repeat the test in one of the groups: the scatter is unknown.", **fields
        )
    if 1.0 / limit < ends[0] and ends[1] < limit:
        words = template("{comparison}: the difference is below {difference:.3g} %.")
        return Message(words, difference=difference_percent, **fields)
    uncertain = Message("{comparison}: not certain", **fields)
    if several:
        uncertain = Message("{comparison}: not certain ({p}, corrected for {pairs} pairs)", **fields)
    words = template(
        "{uncertain}. About {more} more tests with this scatter, {needed} in each group, would find a difference of "
        "{difference:.3g} % in four of five cases."
    )
    more = sum(max(needed - n, 0) for n in (row["n_a"], row["n_b"]))
    if more == 0:
        words = template(
            "{uncertain}. The tests suffice to find a difference of {difference:.3g} % in four of five cases."
        )
    return Message(words, uncertain=uncertain, more=more, needed=needed, difference=difference_percent)


def _comparison(row: Json) -> tuple[Message, tuple[float, float] | None]:
    """Comparison of a pair in words, the larger group first, and the interval of their ratio; None without one."""
    larger, smaller, ratio = row["group_a"], row["group_b"], row["ratio"]
    has_interval = row["interval"] is not None and all(map(_is_number, row["interval"]))
    ends = tuple(row["interval"]) if has_interval else None
    if ratio < 1.0:
        larger, smaller, ratio = smaller, larger, 1.0 / ratio
        ends = None if ends is None else (1.0 / ends[1], 1.0 / ends[0])
    in_percent, as_multiple = (_SITES if row["by"] == "site" else _OTHERS)[row["quantity"]]
    if ratio < PERCENT_TO:
        percents = None if ends is None else [100.0 * (end - 1.0) for end in ends]
        interval = "" if percents is None else Message(" [{low:+.0f}, {high:+.0f}]", low=percents[0], high=percents[1])
        return Message(in_percent, a=larger, b=smaller, percent=100.0 * (ratio - 1.0), interval=interval), ends
    interval = "" if ends is None else Message(" {ends}", ends=tuple(float(f"{end:.3g}") for end in ends))
    return Message(as_multiple, a=larger, b=smaller, ratio=ratio, interval=interval), ends


def caveats(data: ReportData) -> list[Markup]:
    """Sentences with warnings, missing uncertainties, remarks and missing data of a campaign."""
    remarks = data.results["campaign"]["remarks"]
    warnings = data.results["penetration"]["warnings"]
    return [html(sentence) for sentence in (*warnings, *_missing_uncertainties(data), *remarks, *_missing_data(data))]


def _missing_uncertainties(data: ReportData) -> Iterator[Message]:
    """Sentences about uncertainties that are not stated, and what this means for the intervals."""
    campaign = data.results["campaign"]
    if campaign["gauge_resolution_mm"] is None and data.has_tests:
        yield Message(
            "The gauge's resolution is not stated: no interval carries a depth uncertainty, and no experiment could be "
            "flagged as below the resolution. Where depths are small the intervals are then too narrow."
        )
    if campaign["load_uncertainty_N"] is None and data.penetration:
        yield Message("The uncertainty of the loads is not stated; it counts as 0.")
    if campaign["moment_uncertainty_Nm"] is None and data.shear:
        yield Message("The uncertainty of the moments is not stated; it counts as 0.")
    if campaign["lever_arm_uncertainty_mm"] is None and data.shear:
        yield Message("The uncertainty of the lever arms is not stated; it counts as 0.")
    if data.shear and all(row["S_f_interval_N_per_mm2"] is None for row in data.shear):
        yield Message("No uncertainty that bears on a shear test is stated, so S_f has no intervals for single tests.")


def _missing_data(data: ReportData) -> Iterator[Message]:
    """Sentences about tests and columns that the campaign does not have, and about a chosen plain wedge."""
    if not data.penetration:
        yield Message("The campaign has no penetration experiments: there is no H_V and no choice between laws.")
    if not data.shear:
        yield Message("The campaign has no shear experiments: there is no S_f.")
    if not np.isfinite([*data.pressed.density, *data.sheared.density]).any():
        yield Message("No snow density is given at a used experiment: the regressions on density have no data.")
    tests = data.campaign.penetration
    if data.campaign.drop_cone is None and (tests is None or not np.isfinite(tests.drop_cone_depth).any()):
        yield Message("No drop-cone test is given: the regression of H_V on drop-cone depth has no data.")
    if data.results["provenance"]["options"]["geometry"] == "paper":
        yield Message(
            "The paper's plain wedge was chosen: an edged tool counts as a wedge at every depth, also where its base "
            "is under the surface (flagged beyond_tool)."
        )


def readings_used(data: ReportData) -> Markup:
    """Sentences with the numbers of readings and series to which the nine candidate models are fitted."""
    row = data.results["penetration"]["models"][0]
    return prose(
        "All nine candidate models are fitted to the same {n} readings of {m} series. With b = 1 the last residual of "
        "a series is zero by definition, because its reading defines the hardness: the RMSE without the defining "
        "reading leaves these out and divides by n − m = {free}.",
        n=whole(row["n"]),
        m=whole(row["n_series"]),
        free=whole(row["n"] - row["n_series"]),
    )


def procedure_comparison(data: ReportData) -> Markup:
    """Sentence with the ratio of H_V by the two procedures over the used series; empty without one."""
    largest_load = numbers(data.penetration, "H_V_N_per_mm3")
    fitted = numbers(data.results["penetration"]["errors_in_depth"]["experiments"], "H_V_N_per_mm3")
    comparable = data.pressed.used & np.isfinite(largest_load) & np.isfinite(fitted)
    if not comparable.any():
        return html("")
    low, median, high = np.percentile(fitted[comparable] / largest_load[comparable], (5.0, 50.0, 95.0)).tolist()
    return prose(
        "H_V from all readings over H_V from the largest load: median {middle}, 90 % of the series between {low} and "
        "{high}. {file} lists both values of each experiment.",
        low=significant(low),
        middle=significant(median),
        high=significant(high),
        file=_table_file("hardness_by_procedure", data),
    )


def seating_findings(data: ReportData) -> Iterator[Markup]:
    """Sentences with the number of depth offsets that differ from zero, and the width of their intervals."""
    rows = data.seating
    if not rows:
        yield prose("No used series has the readings that an offset can be estimated from.")
        return
    half_widths = np.diff(pairs(rows, "interval_mm"), axis=1) / 2.0
    yield prose(
        "{shown} of {all} used series have an offset whose 95 % interval excludes zero; the median half-width of the "
        "intervals is {half} mm. {file} lists every offset.",
        shown=whole(count_resolved_offsets(rows)),
        all=whole(len(rows)),
        half=significant(float(np.nanmedian(half_widths))),
        file=_table_file("seating", data),
    )
    if without := int(data.pressed.used.sum()) - len(rows):
        yield prose("For {n} used series no offset could be estimated.", n=whole(without))


def unloading_finding(data: ReportData) -> Markup:
    """Sentence with the number of used series whose k_u / H_V has an upper end."""
    used = [row for row in data.unloaded if row["used"]]
    if not used:
        return prose("No used series was unloaded.")
    return prose(
        "{resolved} of {all} used series with unloading give both ends of k_u / H_V; of the others only the lower end "
        "is known, the inverse of the upper end of H_V / k_u. {file} lists every series.",
        resolved=whole(sum(row["unloading_ratio_interval"] is not None for row in used)),
        all=whole(len(used)),
        file=_table_file("unloading", data),
    )


def _table_file(name: str, data: ReportData) -> Markup:
    """File name of a table in the report, with "_synthetic" for synthetic data."""
    return Markup("<code>tables/{}{}.csv</code>").format(name, "_synthetic" if data.synthetic else "")
