"""A race as text, tables and JSON."""

from __future__ import annotations

import csv
import io
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...racing import QuickestLine, Score, Worth


def race_summary(found: QuickestLine, checked: Sequence[tuple[str, Score]]) -> str:
    """Sentences for the terminal: times, what was gained, the turns of the line.

    Parameters
    ----------
    found
        The line.
    checked
        The quickest line and where it began, raced again as the scenario says it.
    """
    gates = len(found.line.turns)
    gained = "" if found.gained is None else f", {found.gained:.3f} s less than where the search began"
    lines = [f"{gates} gates in {_time(found.score)}{gained}; {len(found.history)} evaluations"]
    lines += [f"{name}: {_time(score)}" for name, score in checked]
    lines.append(f"{'gate':>6} {'aside (m)':>10} {'along':>7} {'turning':>8}")
    for gate, turn in zip(found.line.course.gates, found.line.turns, strict=True):
        lines.append(f"{gate.name:>6} {turn.aside:10.2f} {turn.along:7.3f} {turn.turning:8.2f}")
    return "\n".join(lines)


def worth_summary(found: Sequence[Worth]) -> str:
    """A table for the terminal."""
    width = max(len(each.name) for each in found)
    lines = [f"{'time more than as it is (s)':{width}}  {'own snow':>9} {'mean':>8} {'± s.d.':>8}  faster on"]
    for each in found:
        through = len(each.differences)
        lines.append(
            f"{each.name:{width}}  {_signed(each.on_own_snow):>9} {_signed(each.mean):>8} "
            f"{'-' if each.deviation is None else f'{each.deviation:.3f}':>8}  {each.faster} of {through} snows"
            + ("" if through == len(each.scores) else f", {len(each.scores) - through} not through all gates")
        )
    return "\n".join(lines)


def race_dict(found: QuickestLine, checked: Sequence[tuple[str, Score]], worth: Sequence[Worth] = ()) -> dict[str, Any]:
    """The contents of race.json."""
    return {
        "model": found.model,
        "seed": found.seed,
        "evaluations": len(found.history),
        "time_s": found.score.time,
        "began_from_s": found.start_score.time,
        "gained_s": found.gained,
        "outcome": found.score.words,
        "checked": {name: {"time_s": score.time, "outcome": score.words} for name, score in checked},
        "turns": [
            {"gate": gate.name, "aside_m": turn.aside, "along": turn.along, "turning": turn.turning}
            for gate, turn in zip(found.line.course.gates, found.line.turns, strict=True)
        ],
        "worth": [
            {
                "name": each.name,
                "on_own_snow_s": each.on_own_snow,
                "mean_s": each.mean,
                "deviation_s": each.deviation,
                "faster_on": each.faster,
                "snows": len(each.scores),
                "compared": len(each.differences),
            }
            for each in worth
        ],
    }


def evaluations_csv(found: QuickestLine) -> str:
    """evaluations.csv: one row each, with the numbers of its last turns left to race.json's line."""
    head = ("evaluation", "gates", "passed", "value", "time_s", "outcome")
    rows = [
        (each.number, len(each.row["turns"]), each.row["passed"], each.value, each.row["time"], each.row["words"])
        for each in found.history
    ]
    return _csv([head, *rows])


def worth_csv(found: Sequence[Worth]) -> str:
    """worth.csv: the time of each variant on each snow beside that of the scenario as it is."""
    head = ("variant", "snow", "time_s", "time_as_it_is_s", "outcome", "outcome_as_it_is")
    rows = [
        (each.name, i, score.time, base.time, score.words, base.words)
        for each in found
        for i, (score, base) in enumerate(zip(each.scores, each.base, strict=True))
    ]
    return _csv([head, *rows])


def _csv(rows: Sequence[Sequence[object]]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()


def _time(score: Score) -> str:
    return score.words if score.time is None else f"{score.time:.3f} s"


def _signed(value: float | None) -> str:
    return "-" if value is None else f"{value:+.3f}"
