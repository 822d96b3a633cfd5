"""The gates of a course as lines for a terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..track.course.gates_table import gate_rows
from .number_formatting import significant

if TYPE_CHECKING:
    from ..track.course import CourseResult


def gates_text(result: CourseResult) -> str:
    """A line for each gate: name, outcome, time to a hundredth of a second, speed, distance from the pole."""
    rows = [("gate", "outcome", "time (s)", "split (s)", "speed (m/s)", "from the pole (m)")]
    for row in gate_rows(result):
        time, split = (f"{row[name]:.2f}" if row[name] is not None else "-" for name in ("time_s", "split_s"))
        speed, clearance = (significant(row[name], 3, style="plain") for name in ("speed_m_per_s", "clearance_m"))
        rows.append((row["gate"], row["outcome"].replace("_", " "), time, split, speed, clearance))
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    lines = ["  ".join(cell.rjust(width) for cell, width in zip(row, widths, strict=True)) for row in rows]
    fault = result.fault
    end = [] if fault is None else [f"{fault.words[0].upper()}{fault.words[1:]}."]
    return "\n".join([f"{result.passed} of {len(result.passages)} gates passed", *lines, *end])
