"""The gates of a course, and what became of each."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...track.course.gates_table import COLUMNS, gate_rows
from ..table import Column, Table

if TYPE_CHECKING:
    from ...track.course import CourseResult


def gates_table(result: CourseResult) -> Table:
    """A row for each gate, times and poles to a hundredth."""
    rows = [tuple(_words(row[name]) for name in COLUMNS) for row in gate_rows(result)]
    fault = result.fault
    return Table(
        "gates",
        f"{result.passed} of {len(result.passages)} gates passed.",
        (
            Column("gate", "Gate", "text"),
            Column("side", "Side", "text"),
            Column("outcome", "Outcome", "text"),
            Column("time_s", "Time", "hundredths", unit="s"),
            Column("split_s", "From the gate before", "hundredths", unit="s"),
            Column("speed_m_per_s", "Speed", unit="m/s"),
            Column("clearance_m", "From the pole", unit="m"),
            Column("x_m", "Turning pole x", "hundredths", unit="m"),
            Column("y_m", "y", "hundredths", unit="m"),
        ),
        rows,
        note="" if fault is None else f"{fault.words[0].upper()}{fault.words[1:]}.",
    )


def _words(cell: object) -> object:
    return cell.replace("_", " ") if isinstance(cell, str) else cell
