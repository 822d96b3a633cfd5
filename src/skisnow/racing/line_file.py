"""A line as a table: one row a gate, its turn's numbers."""

from __future__ import annotations

import csv
import io
from dataclasses import replace
from pathlib import Path
from typing import Final

from .._support.csv_rows import csv_rows
from .._support.errors import ParameterError
from .._support.staging import write_file
from ..track.course import Course
from .line import LineTurn, RacingLine

COLUMNS: Final = ("gate", "aside_m", "along", "turning", "apex_x_m", "apex_y_m", "edging_from_x_m", "edging_to_x_m")


def line_rows(line: RacingLine) -> list[list[str]]:
    """The table's rows, without its head."""
    rows = []
    breaks = line.breaks
    for i, (gate, turn) in enumerate(zip(line.course.gates, line.turns, strict=True)):
        x, y = line.apexes[i + 1]
        begins = breaks[3 * i + 2]
        ends = breaks[3 * i + 4] if 3 * i + 4 < len(breaks) else x
        numbers = (turn.aside, turn.along, turn.turning, x, y, begins, ends)
        rows.append([gate.name, *(f"{number:.6g}" if j > 2 else repr(number) for j, number in enumerate(numbers))])
    return rows


def write_line(line: RacingLine, path: Path) -> None:
    """Write a line as CSV.

    Raises
    ------
    OutputError
        The place cannot be written.
    """
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows([COLUMNS, *line_rows(line)])
    write_file(path, text.getvalue())


def read_line(path: Path, course: Course, start: tuple[float, float]) -> RacingLine:
    """Read a line that `write_line` wrote, for the first gates of a course.

    Parameters
    ----------
    path
        CSV with gate, aside_m, along, turning; other columns are not read.
    course
        Has these gates, in this order, and perhaps more behind them.
    start
        x, y (m).

    Raises
    ------
    ParameterError
        It cannot be read, a column is missing, a cell is no number, or its gates are not the course's.
    """
    rows = list(csv_rows(path, COLUMNS[:4], action="write the line with `skisnow race` again"))
    if not 0 < len(rows) <= len(course.gates):
        raise ParameterError(f"{path}: it has {len(rows)} rows. Allowed: 1 to {len(course.gates)}, a row for each gate")
    for row, gate in zip(rows, course.gates, strict=False):
        if row.cells["gate"] != gate.name:
            raise row.refused("gate", f"is not {gate.name!r}, the course's gate there")
    turns = tuple(
        LineTurn(aside=row.number("aside_m"), along=row.number("along"), turning=row.number("turning")) for row in rows
    )
    return RacingLine(replace(course, gates=course.gates[: len(turns)]), start, turns)
