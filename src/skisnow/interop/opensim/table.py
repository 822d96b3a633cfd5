"""Tables of motion (.mot) and storage (.sto): a head up to ``endheader``, names of columns, numbers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import numpy as np

from ..._support.arrays import FloatArray
from ..._support.errors import ParameterError
from ..._support.staging import require_ending, write_file
from ..._support.units import Facts, Shown, amount
from ..._support.user_files import plain_text
from ..._support.user_files.motion_head import HEAD_END, head_of_motion, is_in_degrees, require_whole

ENDINGS: Final = (".mot", ".sto")
MOST_BYTES: Final = 1 << 28
_CLOCK: Final = "time"
_OWN_KEYS: Final = ("nrows", "ncolumns", "indegrees", "version")


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class MotionTable(Shown):
    """Columns of an OpenSim motion or storage file over time.

    time: (n,), rising (s).
    columns: columns by name, (n,) each; the name states the quantity.
    in_degrees: True if angles are in degrees (default: False, radians, as OpenSim reads a file without a statement).
    name: that the head begins with.
    head: other keys of the head, as they are there.
    Raises ParameterError: a column has not a number for each time, or times do not rise.
    """

    time: FloatArray
    columns: Mapping[str, FloatArray]
    in_degrees: bool = False
    name: str = "motion"
    head: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        require_rising("table", self.time)
        for name, values in self.columns.items():
            if np.shape(values) != np.shape(self.time):
                raise ParameterError("column {name} has shape {shape}, time {shape_2}").tag(
                    "wrong_shape", name=name, shape=str(np.shape(values)), shape_2=str(np.shape(self.time))
                )

    def _repr_facts(self) -> Facts:
        return Facts(f"{len(self.columns)} columns, {len(self.time)} rows to {amount(float(self.time[-1]), 's')}")


def require_rising(what: str, time: FloatArray) -> None:
    """ParameterError if the time is missing or does not rise."""
    if np.ndim(time) != 1 or not len(time):
        raise ParameterError("{field}: time has shape {shape}; there must be one row or more").tag(
            "wrong_shape", field=what, shape=str(np.shape(time))
        )
    if not np.all(np.isfinite(time)) or np.any(np.diff(time) <= 0.0):
        row = int(np.argmin(np.append(True, np.diff(time) > 0.0)))
        raise ParameterError("{field}: time of row {row} is {time:g} s; it must be finite and rise").tag(
            "not_a_number", field=what, row=row + 1, time=time[row]
        )


def read_motion(path: str | Path) -> MotionTable:
    """Read a .mot or .sto file.

    Raises ParameterError: the file cannot be read, has no head or no column ``time``, its head leaves open whether
        angles are in degrees, or a cell is not a number; file, row, column and value are named.
    """
    lines = plain_text(path, most_bytes=MOST_BYTES).splitlines()
    ends = next((i for i, line in enumerate(lines) if line.strip().lower() == HEAD_END), None)
    if ends is None or ends + 1 >= len(lines):
        raise ParameterError("{path} has no line {head_end} with a table behind it; a .mot or .sto file has one").tag(
            "no_data", path=path, head_end=HEAD_END
        )
    head = head_of_motion(lines[:ends])
    name = "" if "=" in lines[0] else lines[0].strip()
    names = lines[ends + 1].split()
    if not names or names[0].lower() != _CLOCK or len(set(names)) < len(names):
        raise ParameterError("{path}, line {line}: the columns must begin with {clock}, each name once").tag(
            "out_of_range", path=path, line=ends + 2, clock=_CLOCK
        )
    first = ends + 2
    rows = [(i + 1, line.split()) for i, line in enumerate(lines[first:], start=first) if line.strip()]
    require_whole(path, head, nRows=len(rows), nColumns=len(names))
    numbers = np.array([_parse_numbers(path, number, cells, names) for number, cells in rows]).reshape(-1, len(names))
    others = {key: value for key, value in head.items() if key.lower() not in _OWN_KEYS}
    in_degrees = is_in_degrees(path, head)
    try:
        columns = {name: numbers[:, place] for place, name in enumerate(names) if place}
        return MotionTable(numbers[:, 0], columns, in_degrees, name or Path(path).stem, others)
    except ParameterError as error:
        raise error.at(path) from error


def _parse_numbers(path: str | Path, number: int, cells: list[str], names: list[str]) -> list[float]:
    if len(cells) != len(names):
        raise ParameterError("{path}, line {number}: {n_cells} cells for {n_names} names of columns").tag(
            "wrong_number_of_cells", path=path, number=number, n_cells=len(cells), n_names=len(names)
        )
    return [number_of(cell, f"{path}, line {number}, column {name}") for name, cell in zip(names, cells, strict=True)]


def number_of(cell: str, where: str) -> float:
    """The number of a cell; ``where`` is its place, for the message."""
    try:
        return float(cell)
    except ValueError:
        raise ParameterError("{where}: {cell!r} is not a number; write one").tag(
            "not_a_number", where=where, cell=cell
        ) from None


def write_motion(table: MotionTable, path: str | Path) -> None:
    """Write a .mot or .sto file, numbers with all their digits.

    Raises ParameterError: the name ends otherwise.
    Raises OutputError: the place cannot be written.
    """
    require_ending(path, *ENDINGS)
    names = [_CLOCK, *table.columns]
    rows = np.column_stack([table.time, *table.columns.values()]).tolist()
    keys = {"version": "1", "nRows": str(len(rows)), "nColumns": str(len(names)), **table.head}
    keys["inDegrees"] = "yes" if table.in_degrees else "no"
    lines = [table.name, *(f"{key}={value}" for key, value in keys.items()), HEAD_END, "\t".join(names)]
    lines += ["\t".join(map(repr, row)) for row in rows]
    write_file(path, "\n".join(lines) + "\n")
