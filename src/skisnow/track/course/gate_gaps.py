"""Two ways through the same gates: the gap in time at each, and what was lost from gate to gate."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, get_args

from ..._support.messages import Message
from ..._support.spreadsheet_text import CsvRow, csv_rows
from .passages import GateOutcome

GATES_FILE: Final = "gates.csv"
APART: Final = 0.05
"""Distance (m) between turning poles of two gates that are the same."""
COLUMNS: Final = ("gate", "outcome", "time_s", "other_outcome", "other_time_s", "gap_s", "lost_s")


@dataclass(frozen=True, slots=True, kw_only=True)
class GateGap:
    """One gate of two runs.

    Attributes
    ----------
    gate
        Its name.
    outcome, other_outcome
        What became of it, as gates.csv has it.
    time, other_time
        (s) from the start of each; None: not crossed.
    gap
        Of the first run to the other one (s), positive: it is behind; None where one did not cross it.
    lost
        Gap less that at the gate before which both crossed, at first less 0 (s).
    """

    gate: str
    outcome: str
    other_outcome: str
    time: float | None
    other_time: float | None
    gap: float | None
    lost: float | None


def gate_gaps(folder: Path, other: Path) -> tuple[GateGap, ...] | None:
    """Gaps at the gates of two folders with a gates.csv; None where one has none, or the courses are not the same.

    Raises
    ------
    ParameterError
        A gates.csv cannot be read.
    """
    tables = [_rows(each / GATES_FILE) for each in (folder, other) if (each / GATES_FILE).is_file()]
    if len(tables) < 2 or not _same_course(*tables):
        return None
    return gaps_of(*tables)


def gaps_of(rows: Sequence[Mapping[str, Any]], other: Sequence[Mapping[str, Any]]) -> tuple[GateGap, ...]:
    """Gaps at the gates of two tables of the same gates, each row with gate, outcome and time_s or None."""
    found, before = [], 0.0
    for own, its in zip(rows, other, strict=True):
        time, other_time = own["time_s"], its["time_s"]
        gap = None if time is None or other_time is None else time - other_time
        found.append(
            GateGap(
                gate=own["gate"], outcome=own["outcome"], other_outcome=its["outcome"], time=time,
                other_time=other_time, gap=gap, lost=None if gap is None else gap - before,
            )
        )  # fmt: skip
        before = before if gap is None else gap
    return tuple(found)


def _same_course(one: list[dict[str, Any]], other: list[dict[str, Any]]) -> bool:
    def apart(own: dict[str, Any], its: dict[str, Any]) -> float:
        return math.hypot(own["x_m"] - its["x_m"], own["y_m"] - its["y_m"])

    return len(one) == len(other) and all(apart(own, its) <= APART for own, its in zip(one, other, strict=True))


def _rows(place: Path) -> list[dict[str, Any]]:
    rows = csv_rows(
        place, ("gate", "outcome", "time_s", "x_m", "y_m"), action=Message("Simulate the run again with --out.")
    )
    return [_row(row) for row in rows]


def _row(row: CsvRow) -> dict[str, Any]:
    if row.cells["outcome"] not in get_args(GateOutcome):
        raise row.refused(
            "outcome", Message("Must be one of {choices}.", choices=get_args(GateOutcome)), code="unknown_choice"
        )
    return {
        **row.cells,
        "time_s": row.number("time_s") if row.cells["time_s"] else None,
        "x_m": row.number("x_m"),
        "y_m": row.number("y_m"),
    }


def gaps_csv(gaps: Sequence[GateGap]) -> str:
    """A row for each gate under `COLUMNS`, nothing where there is no number."""
    stream = io.StringIO()
    writer = csv.DictWriter(stream, COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows(gap_rows(gaps))
    return stream.getvalue()


def gap_rows(gaps: Sequence[GateGap]) -> list[dict[str, Any]]:
    """The same as values."""
    return [
        {
            "gate": each.gate, "outcome": each.outcome, "time_s": each.time, "other_outcome": each.other_outcome,
            "other_time_s": each.other_time, "gap_s": each.gap, "lost_s": each.lost,
        }
        for each in gaps
    ]  # fmt: skip
