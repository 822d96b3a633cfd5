"""Verdicts of a campaign: sentences that compare sites, tools, observers and days, for the top of each output."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from typing import Any, Final

from ..._support.messages import Message, template
from ...campaign.records import Campaign
from ...estimation.group_comparisons import DIFFERENCE, LEVEL, compare_campaign
from ...estimation.screening import screened_both

Json = dict[str, Any]

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
    """One sentence for each pair of sites, of many sites a survey and the uncertain pairs; then tools and the like.

    results: contents of `skisnow.results_dict`.
    """
    return _row_verdicts(results["group_comparisons"], results["provenance"]["options"]["difference_percent"])


def quick_verdicts(campaign: Campaign, quantity: str) -> list[Message]:
    """The verdicts on H_V or S_f of a campaign that is still being entered, without the other results."""
    penetration, shear = screened_both(campaign, geometry="extended")
    pairs = compare_campaign(campaign, penetration, shear)
    return _row_verdicts([asdict(pair) for pair in pairs if pair.quantity == quantity], 100.0 * DIFFERENCE)


def _row_verdicts(rows: list[Json], difference: float) -> list[Message]:
    kinds: dict[tuple[str, str], list[Json]] = {}
    for row in rows:
        kinds.setdefault((row["quantity"], row["by"]), []).append(row)
    return [
        sentence
        for (quantity, by), mine in kinds.items()
        for sentence in _kind_verdicts(mine, quantity, by, difference)
    ]


def _kind_verdicts(rows: list[Json], quantity: str, by: str, difference: float) -> Iterator[Message]:
    if len(rows) > MOST_PAIRS:
        uncertain = [row for row in rows if not _is_certain(row)]
        if by == "site":
            yield _survey_sentence(rows, quantity, len(rows) - len(uncertain))
        rows = sorted(uncertain, key=lambda row: row["p"] if _is_number(row["p"]) else 2.0)[:MOST_PAIRS]
    yield from (verdict(row, difference) for row in rows)


def _survey_sentence(rows: list[Json], quantity: str, certain: int) -> Message:
    won = Counter(row["group_a"] if row["ratio"] > 1.0 else row["group_b"] for row in rows)
    lost = Counter(row["group_b"] if row["ratio"] > 1.0 else row["group_a"] for row in rows)
    largest, smallest = won.most_common(1)[0][0], lost.most_common(1)[0][0]
    corrected = Message(_SURVEY[quantity], certain=certain, pairs=len(rows), a=largest, b=smallest)
    return Message("{survey} (corrected for the number of pairs).", survey=corrected)


def _is_number(value: float | None) -> bool:
    return value is not None and math.isfinite(value)


def _is_certain(row: Json) -> bool:
    return _is_number(row["p_holm"]) and bool(row["p_holm"] < LEVEL)


def verdict(row: Json, difference_percent: float) -> Message:
    """Sentence about one pair: which is larger, by how much, whether that is certain, and how many tests it takes.

    row: an entry of ``group_comparisons`` in the results.
    difference_percent: the difference that ``n_needed`` of the row is for.
    """
    comparison, ends = _comparison(row)
    limit = 1.0 + difference_percent / 100.0
    if _is_certain(row) and row["n_pairs"] > 1:
        return Message(
            "{comparison}: certain ({p}, corrected for {pairs} pairs).",
            comparison=comparison, p=_p_text(row["p_holm"]), pairs=row["n_pairs"],
        )  # fmt: skip
    if _is_certain(row):
        return Message("{comparison}: certain ({p}).", comparison=comparison, p=_p_text(row["p"]))
    if ends is None or row["n_needed"] is None:
        return Message(
            "{comparison}: not certain. Repeat the test in one of the groups: the scatter is unknown.",
            comparison=comparison,
        )
    if 1.0 / limit < ends[0] and ends[1] < limit:
        return Message(
            "{comparison}: the difference is below {difference:.3g} %.",
            comparison=comparison, difference=difference_percent,
        )  # fmt: skip
    more = sum(max(row["n_needed"] - n, 0) for n in (row["n_a"], row["n_b"]))
    uncertain = Message("{comparison}: not certain", comparison=comparison)
    if row["n_pairs"] > 1:
        uncertain = Message(
            "{comparison}: not certain ({p}, corrected for {pairs} pairs)",
            comparison=comparison, p=_p_text(row["p_holm"]), pairs=row["n_pairs"],
        )  # fmt: skip
    if more == 0:
        return Message(
            "{uncertain}. The tests suffice to find a difference of {difference:.3g} % in four of five cases.",
            uncertain=uncertain, difference=difference_percent,
        )  # fmt: skip
    return Message(
        "{uncertain}. About {more} more tests with this scatter, {needed} in each group, would find a difference of "
        "{difference:.3g} % in four of five cases.",
        uncertain=uncertain, more=more, needed=row["n_needed"], difference=difference_percent,
    )  # fmt: skip


def _p_text(p: float) -> Message:
    return Message("p < 0.001") if p < 0.001 else Message("p = {p:.2g}", p=p)


def _comparison(row: Json) -> tuple[Message, tuple[float, float] | None]:
    """The larger group first; also the interval of that ratio."""
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
