"""Poses of boots from a file: CSV, or a table of motion or storage of OpenSim (.mot, .sto)."""

from __future__ import annotations

import csv
import io
import math
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final, TypeAlias

import numpy as np
import numpy.typing as npt

from .._support.errors import ParameterError
from .._support.spreadsheet_text import column_names, decimal_mark, most_frequent_separator, with_decimal_point
from .._support.units import DEGREE
from .._support.user_files import plain_text
from .._support.user_files.motion_head import HEAD_END, degrees_stated, head_of_motion, require_whole
from ..geometry.boot_axes import axes_of
from ..parameters import meant
from .boots import FEWEST_POSES, LARGEST, SHORTEST_STEP, Boots

SIDES: Final = ("left", "right")
ANGLES: Final = ("edge_angle_deg", "pitch_deg", "heading_deg")
OF_SLEDGE: Final = ("forward_m", "aside_m", "up_m")
OF_SLOPE: Final = ("x_m", "y_m", "z_m")
CLOCKS: Final = ("time_s", "time", "distance_m")
_OF_A_BOOT: Final = (*OF_SLEDGE, *OF_SLOPE, *ANGLES)
_RESULTS: Final = ("_N", "_N_m", "_vx", "_vy", "_vz", "_px", "_py", "_pz", "_mx", "_my", "_mz")
"""Ends of names of what a run's own boots hold besides: forces and moments, which are not read."""
_EDGE: Final = "_edge_angle_deg"
_ON_ITS_SIDE: Final = 90.0
"""Edge angle (°) of a ski that stands on its edge: beyond it the base looks up."""
_MOST_BYTES: Final = 1 << 28
_HEAD: Final = 1 << 16
_OF_OPENSIM: Final = (".mot", ".sto")

Row: TypeAlias = tuple[int, list[str]]
"""Its line in the file, counted from 1, and its cells."""


def read_boots(path: str | Path, *, edge_angle: float = 0.0, stance_width: float = 0.0) -> Boots:
    """Read poses of both boots.

    Parameters
    ----------
    path
        A CSV file, or .mot or .sto of OpenSim. The page docs/files/boots.md names the columns.
    edge_angle, stance_width
        Of the sledge: what is not said (rad, m).

    Raises
    ------
    ParameterError
        The file cannot be read, a column is missing or unknown, a cell holds no finite number (file, row, column and
        value are named), or it is no table of boots.
    """
    path = Path(path)
    (_, names), *rows = _rows(path, plain_text(path, most_bytes=_MOST_BYTES))
    stripped = [name.strip() for name in names]
    head = column_names(stripped, (*CLOCKS, *(f"{side}_{name}" for side in SIDES for name in _OF_A_BOOT)))
    _require_columns(path, head)
    table = {name: _column(path, rows, head, place) for place, name in enumerate(head) if _is_read(name)}
    clock = next(name for name in CLOCKS if name in table)
    if len(rows) < FEWEST_POSES:
        raise ParameterError(f"{path}: {len(rows)} rows with poses; boots need {FEWEST_POSES} rows or more")
    _require_rising(path, clock, rows, table[clock])
    try:
        place, axes = _of_slope(table) if "left_x_m" in head else _of_sledge(table, edge_angle, stance_width)
        return Boots(
            table[clock],
            place,
            axes,
            frame="slope" if "left_x_m" in head else "sledge",
            over="distance" if clock == "distance_m" else "time",
            source=str(path),
        )
    except ParameterError as error:
        raise ParameterError(f"{path}: {error}") from error


def _rows(path: Path, text: str) -> list[Row]:
    """Rows that are not blank, from the one with the names of columns on."""
    lines = text.splitlines()
    if path.suffix.lower() in _OF_OPENSIM:
        rows, said = _behind_head(path, lines)
    elif path.suffix.lower() == ".csv":
        rows, said = _of_csv(path, text), {}
    else:
        raise ParameterError(f"{path}: boots are read from .csv, .mot and .sto; give the file the ending of what it is")
    if not rows:
        raise ParameterError(f"{path}: there is no row with the names of columns")
    names = rows[0][1]
    require_whole(path, said, rows=len(rows) - 1, columns=len(names))
    if degrees_stated(path, said) is False and any(name.endswith(ANGLES) for name in names):
        raise ParameterError(
            f"{path}: the head says inDegrees=no, and angles of boots are in degrees; multiply them by 57.29578 and "
            "write inDegrees=yes"
        )
    return rows


def _of_csv(path: Path, text: str) -> list[Row]:
    """Rows of a table with commas, semicolons or tabs; numbers with a decimal comma get a point."""
    separator = most_frequent_separator(text[:_HEAD])
    table = csv.reader(io.StringIO(text), delimiter=separator)
    try:
        rows = [(table.line_num, row) for row in table if any(cell.strip() for cell in row)]
    except csv.Error as error:
        raise ParameterError(f"{path} is no CSV text ({error})") from error
    cells = (cell for _, row in rows[1:] for cell in row)
    if separator == "," or decimal_mark([cells], separator=separator) == ".":
        return rows
    return [*rows[:1], *((line, [with_decimal_point(cell.strip()) for cell in row]) for line, row in rows[1:])]


def _behind_head(path: Path, lines: list[str]) -> tuple[list[Row], dict[str, str]]:
    """Rows of OpenSim's table, and what its head says."""
    ends = [i for i, line in enumerate(lines) if line.strip().lower() == HEAD_END]
    if not ends:
        raise ParameterError(f"{path} has no line {HEAD_END}, which ends the head of a .mot or .sto file; add it")
    begin = ends[0] + 1
    rows = [(number, line.split()) for number, line in enumerate(lines[begin:], begin + 1) if line.strip()]
    return rows, head_of_motion(lines[: ends[0]])


def _is_read(name: str) -> bool:
    return not name.endswith(_RESULTS)


def _known(head: list[str]) -> tuple[str, ...]:
    places = OF_SLOPE if "left_x_m" in head else OF_SLEDGE
    return (*CLOCKS, *(f"{side}_{name}" for side in SIDES for name in (*places, *ANGLES)))


def _require_columns(path: Path, head: list[str]) -> None:
    known, counts = _known(head), Counter(head)
    for name in head:
        if _is_read(name) and name not in known:
            raise ParameterError(f"{path}: there is no column {name}. {meant(name, known)}There are {', '.join(known)}")
        if counts[name] > 1:
            raise ParameterError(f"{path}: the column {name} is there twice; leave one out")
    clocks = [name for name in CLOCKS if name in head]
    if len(clocks) != 1:
        raise ParameterError(f"{path}: it needs one of the columns time_s (time in .mot) and distance_m")
    if not any(_is_read(name) and name not in clocks for name in head):
        raise ParameterError(f"{path}: no column is one of a boot. There are {', '.join(known[3:])}")
    needed = [f"{side}_{name}" for side in SIDES for name in (*OF_SLOPE, *ANGLES)] if "left_x_m" in head else []
    for name in needed:
        if name not in head:
            raise ParameterError(f"{path}: the column {name} is missing; boots in the slope's frame need every one")


def _require_rising(path: Path, clock: str, rows: list[Row], at: npt.NDArray[np.float64]) -> None:
    for (line, _), before, after in zip(rows[1:], at[:-1], at[1:], strict=True):
        if not after > before:
            raise ParameterError(
                f"{path}, row {line}, column {clock}: {after:g} after {before:g}; it must rise. Put the rows in order, "
                "or leave one of two with the same pose out"
            )
        if after - before < SHORTEST_STEP:
            raise ParameterError(
                f"{path}, row {line}, column {clock}: {after:g} after {before:g}. Allowed: steps of {SHORTEST_STEP:g} "
                "or more. Correct the number, or omit one of the rows."
            )


def _column(path: Path, rows: list[Row], head: list[str], place: int) -> npt.NDArray[np.float64]:
    values = np.empty(len(rows))
    for i, (line, row) in enumerate(rows):
        if len(row) != len(head):
            raise ParameterError(f"{path}, row {line}: {len(row)} cells stand under {len(head)} names of columns")
        try:
            values[i] = float(row[place])
        except ValueError:
            values[i] = math.nan
        if not math.isfinite(values[i]):
            raise ParameterError(
                f"{path}, row {line}, column {head[place]}: {row[place].strip()!r} is no finite number; write one"
                f"{' with a decimal point' if ',' in row[place] else ''}"
            )
        if abs(values[i]) > LARGEST:
            raise ParameterError(
                f"{path}, row {line}, column {head[place]}: {values[i]:g} is beyond ±{LARGEST:g}. Correct the number."
            )
        if head[place].endswith(_EDGE) and abs(values[i]) > _ON_ITS_SIDE:
            raise ParameterError(
                f"{path}, row {line}, column {head[place]}: {values[i]:g} is beyond ±{_ON_ITS_SIDE:g}, a ski "
                "on its side; put the row right or leave it out"
            )
    return values


def _axes(table: Mapping[str, Any], missing: Mapping[str, float]) -> npt.NDArray[np.float64]:
    n = len(next(iter(table.values())))
    angles = [[table.get(f"{side}_{name}", np.full(n, missing[name])) * DEGREE for name in ANGLES] for side in SIDES]
    return np.array([[axes_of(*(float(each[i]) for each in of_ski)) for of_ski in angles] for i in range(n)])


def _of_slope(table: Mapping[str, Any]) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    place = np.stack([np.stack([table[f"{side}_{name}"] for name in OF_SLOPE], axis=-1) for side in SIDES], axis=1)
    return place, _axes(table, dict.fromkeys(ANGLES, 0.0))


def _of_sledge(
    table: Mapping[str, Any], edge_angle: float, stance_width: float
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    n = len(next(iter(table.values())))
    place = np.zeros((n, 2, 3))
    for ski, (side, sense) in enumerate(zip(SIDES, (1.0, -1.0), strict=True)):
        for axis, name in enumerate(OF_SLEDGE):
            own = sense * stance_width / 2.0 if name == "aside_m" else 0.0
            place[:, ski, axis] = table.get(f"{side}_{name}", own)
    return place, _axes(table, {"edge_angle_deg": edge_angle / DEGREE, "pitch_deg": 0.0, "heading_deg": 0.0})
