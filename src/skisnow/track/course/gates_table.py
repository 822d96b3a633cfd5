"""gates.csv and its JSON with a row for each gate, and gaps in time between two runs through the same gates."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final, NamedTuple, get_args

from ..._support.messages import Message
from ..._support.spreadsheet_text import csv_rows, csv_text
from ..._support.user_files.json_text import json_number
from .passages import CourseResult, GateOutcome

COLUMNS: Final = ("gate", "side", "outcome", "time_s", "split_s", "speed_m_per_s", "clearance_m", "x_m", "y_m")
DOUBTFUL: Final = 0.005
"""Uncertainty (s) of a time at a gate above which a warning is given: hundredths of a second are then unknown."""


def gate_rows(result: CourseResult) -> list[dict[str, Any]]:
    """Rows of gates.csv by `COLUMNS`; times count from the track's first point; None for missing values."""
    rows, before = [], result.start_time
    for passage in result.passages:
        gate = passage.gate
        time = None if passage.time is None else passage.time - result.start_time
        split = None if passage.time is None else passage.time - before
        values = (gate.name, gate.side, passage.outcome, time, split, passage.speed, passage.clearance, *gate.turning)
        cells = [json_number(value) if isinstance(value, float) else value for value in values]
        rows.append(dict(zip(COLUMNS, cells, strict=True)))
        before = before if passage.time is None else passage.time
    return rows


def gates_csv(result: CourseResult) -> str:
    """gates.csv as text: numbers with all digits, empty cells for missing values."""
    return csv_text([COLUMNS, *(row.values() for row in gate_rows(result))])


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
    """Warning if points are too far apart for times accurate to a hundredth of a second."""
    doubts = (passage.doubt for passage in result.passages if passage.doubt is not None)
    worst = max(filter(math.isfinite, doubts), default=0.0)
    if worst <= DOUBTFUL:
        return ()
    return (
        f"times at gates depend by up to {worst:.2g} s on the way between the track's points; for a hundredth of a "
        "second the receiver must write more often",
    )


GATES_FILE: Final = "gates.csv"
APART: Final = 0.05
"""Distance (m) between turning poles of two gates that are the same."""


class GateGap(NamedTuple):
    """One gate of two runs; the fields are the columns of tables and JSON.

    gate: name of the gate.
    outcome, other_outcome: outcome of each run, as in gates.csv.
    time_s, other_time_s: time (s) from the start of each run; None if not crossed.
    gap_s: time (s) by which the first run is behind the other one; None if one did not cross the gate.
    lost_s: change (s) of the gap since the last gate that both crossed.
    """

    gate: str
    outcome: str
    time_s: float | None
    other_outcome: str
    other_time_s: float | None
    gap_s: float | None
    lost_s: float | None


def read_gate_gaps(folder: Path, other: Path) -> tuple[GateGap, ...] | None:
    """Gaps at the gates of two folders with a gates.csv; None if one is missing, or the courses differ.

    Raises ParameterError: a gates.csv cannot be read.
    """
    tables = [_gate_rows(run / GATES_FILE) for run in (folder, other) if (run / GATES_FILE).is_file()]
    if len(tables) < 2 or len(tables[0]) != len(tables[1]):
        return None
    pairs = zip(*tables, strict=True)
    are_same = all(math.hypot(own["x_m"] - its["x_m"], own["y_m"] - its["y_m"]) <= APART for own, its in pairs)
    return compare_gates(*tables) if are_same else None


def compare_gates(rows: Sequence[Mapping[str, Any]], other: Sequence[Mapping[str, Any]]) -> tuple[GateGap, ...]:
    """Differences of times at the gates of two tables of one course; rows have gate, outcome, time_s (or None)."""
    gaps, before = [], 0.0
    for row, other_row in zip(rows, other, strict=True):
        time, other_time = row["time_s"], other_row["time_s"]
        gap = None if time is None or other_time is None else time - other_time
        lost = None if gap is None else gap - before
        gaps.append(GateGap(row["gate"], row["outcome"], time, other_row["outcome"], other_time, gap, lost))
        before = before if gap is None else gap
    return tuple(gaps)


def _gate_rows(place: Path) -> list[dict[str, Any]]:
    """Rows of a run's table of gates: time (s; None if blank) and place (m); rejects an unknown outcome."""
    table = []
    columns = ("gate", "outcome", "time_s", "x_m", "y_m")
    for row in csv_rows(place, columns, action=Message("Simulate the run again with --out.")):
        if row.cells["outcome"] not in get_args(GateOutcome):
            allowed = Message("Must be one of {choices}.", choices=get_args(GateOutcome))
            raise row.refused("outcome", allowed, code="unknown_choice")
        numbers = {name: row.number(name) if row.cells[name] or name != "time_s" else None for name in columns[2:]}
        table.append({**row.cells, **numbers})
    return table


def gaps_csv(gaps: Sequence[GateGap]) -> str:
    """Table with a row for each gate as text; empty cells for missing values."""
    return csv_text([GateGap._fields, *gaps])
