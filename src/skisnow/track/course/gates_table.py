"""gates.csv, and the same as JSON values: a row for each gate."""

from __future__ import annotations

import csv
import io
import math
from typing import Any, Final

from ..._support.user_files.json_text import json_number
from .passages import CourseResult, Passage

COLUMNS: Final = (
    "gate",
    "side",
    "outcome",
    "time_s",
    "split_s",
    "speed_m_per_s",
    "clearance_m",
    "x_m",
    "y_m",
)
DOUBTFUL: Final = 0.005
"""Doubt (s) of a time beyond which it is not good to a hundredth of a second."""


def gate_rows(result: CourseResult) -> list[dict[str, Any]]:
    """Rows under `COLUMNS`; times count from the track's first point, what does not exist is None."""
    rows, before = [], result.start_time
    for passage in result.passages:
        rows.append(_row(passage, result.start_time, before))
        before = before if passage.time is None else passage.time
    return rows


def _row(passage: Passage, start: float, before: float) -> dict[str, Any]:
    time, gate = passage.time, passage.gate
    values = (
        gate.name,
        gate.side,
        passage.outcome,
        None if time is None else time - start,
        None if time is None else time - before,
        passage.speed,
        passage.clearance,
        *gate.turning,
    )
    known = [json_number(value) if isinstance(value, float) else value for value in values]
    return dict(zip(COLUMNS, known, strict=True))


def gates_csv(result: CourseResult) -> str:
    """The table as text: numbers with all their digits, nothing where there is none."""
    stream = io.StringIO()
    writer = csv.DictWriter(stream, COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows(gate_rows(result))
    return stream.getvalue()


def gates_dict(result: CourseResult) -> dict[str, Any]:
    """``gates_passed``, ``gates_missed``, ``gate_times_s``, and all rows under ``gates``."""
    rows = gate_rows(result)
    return {
        "gates_passed": result.passed,
        "gates_missed": list(result.missed),
        "gate_times_s": [row["time_s"] for row in rows],
        "gates": rows,
    }


def time_warnings(result: CourseResult) -> tuple[str, ...]:
    """Where points are so far apart that times are not good to a hundredth of a second, in words."""
    doubts = [each.doubt for each in result.passages if each.doubt is not None and math.isfinite(each.doubt)]
    worst = max(doubts, default=0.0)
    if worst <= DOUBTFUL:
        return ()
    return (
        f"times at gates depend by up to {worst:.2g} s on the way between the track's points; for a hundredth of a "
        "second the receiver must write more often",
    )
