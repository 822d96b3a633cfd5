"""Scores as a table in Markdown."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from .scoring import Score

EXACT: Final = 1e-8
"""A share that is rounding."""


def table(scores: Iterable[Score], starts: dict[str, float]) -> str:
    """A row for each program: error in per cent and cost in loops for each case; below, what was not done and why."""
    rows: dict[str, dict[str, Score]] = {}
    for each in scores:
        rows.setdefault(each.program, {})[each.case] = each
    cases = sorted({case for row in rows.values() for case in row})
    head = ["program", *cases, "spread over headings", "start"]
    lines = ["| " + " | ".join(head) + " |", "| --- |" + " ---: |" * (len(head) - 1)]
    for program, row in rows.items():
        cells = [cell(row[case]) for case in cases]
        spreads = [each.spread for each in row.values() if each.spread is not None]
        spread = percent(spreads[0]) if spreads else "–"
        lines.append("| " + " | ".join([program, *cells, spread, f"{starts.get(program, 0.0):.2g}"]) + " |")
    return "\n".join(lines) + "\n"


def cell(score: Score) -> str:
    """Error and cost; where the error is below the answer's own uncertainty, that."""
    if score.error is None:
        return score.outcome.partition(":")[0] if score.outcome != "done" else "–"
    told = f"≤ {percent(score.floor)}" if score.error <= score.floor and score.floor > EXACT else percent(score.error)
    return f"{told} / {score.cost:.2g}" if (score.cost or 0.0) < 10.0 else f"{told} / {score.cost:.0f}"


def percent(share: float) -> str:
    """Two digits that count; what is rounding is 0."""
    if share < EXACT:
        return "0 %"
    return f"{100.0 * share:.2g} %" if share < 1.0 else f"{100.0 * share:.0f} %"


def reasons(scores: Iterable[Score]) -> str:
    """What was not done, and why."""
    lines = [
        f"- {each.program}, {each.case}: {'; '.join(each.problems) or each.outcome}"
        for each in scores
        if each.outcome != "done"
    ]
    return "\n".join(lines) + ("\n" if lines else "")
