"""Poses of boots from a file: CSV, or a table of motion or storage of OpenSim (.mot, .sto)."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from ..errors import ParameterError
from ..geometry.boot_axes import axes_of
from ..given import plain_text
from ..given.motion_head import HEAD_END, head_of_motion, is_in_degrees, require_whole
from ..inputs import meant
from ..units import DEGREE
from .boots import Boots

SIDES: Final = ("left", "right")
ANGLES: Final = ("edge_angle_deg", "pitch_deg", "heading_deg")
OF_SLEDGE: Final = ("forward_m", "aside_m", "up_m")
OF_SLOPE: Final = ("x_m", "y_m", "z_m")
_RESULTS: Final = ("_N", "_N_m", "_vx", "_vy", "_vz", "_px", "_py", "_pz", "_mx", "_my", "_mz")
"""Ends of names of what a run's own boots hold besides: forces and moments, which are not read."""
_EDGE: Final = "_edge_angle_deg"
_ON_ITS_SIDE: Final = 90.0
"""Edge angle (°) of a ski that stands on its edge: beyond it the base looks up."""
_MOST_BYTES: Final = 1 << 28


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
    rows, first = _rows(path, plain_text(path, most_bytes=_MOST_BYTES))
    head = [name.strip() for name in rows[0]] if rows else []
    _require_columns(path, head)
    table = {name: _column(path, rows[1:], head, place, first) for place, name in enumerate(head) if _is_read(name)}
    clock = next(name for name in ("time_s", "time", "distance_m") if name in table)
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


def _rows(path: Path, text: str) -> tuple[list[list[str]], int]:
    """Rows of cells from the head on, and the file's line of the first."""
    if path.suffix.lower() not in (".mot", ".sto"):
        try:
            return [row for row in csv.reader(io.StringIO(text)) if any(row)], 2
        except csv.Error as error:
            raise ParameterError(f"{path} is no CSV text ({error})") from error
    lines = text.splitlines()
    ends = [i for i, line in enumerate(lines) if line.strip().lower() == HEAD_END]
    if not ends:
        raise ParameterError(f"{path} has no line {HEAD_END}, which ends the head of a .mot or .sto file; add it")
    rows = [line.split() for line in lines[ends[0] + 1 :] if line.strip()]
    said = head_of_motion(lines[: ends[0]])
    names = rows[0] if rows else []
    require_whole(path, said, rows=max(len(rows) - 1, 0), columns=len(names))
    if any(name.endswith(ANGLES) for name in names) and not is_in_degrees(said):
        raise ParameterError(
            f"{path}: the head says inDegrees=no, and angles of boots are in degrees; multiply them by 57.29578 and "
            "write inDegrees=yes"
        )
    return rows, ends[0] + 3


def _is_read(name: str) -> bool:
    return not name.endswith(_RESULTS)


def _known(head: list[str]) -> tuple[str, ...]:
    places = OF_SLOPE if "left_x_m" in head else OF_SLEDGE
    return ("time_s", "time", "distance_m", *(f"{side}_{name}" for side in SIDES for name in (*places, *ANGLES)))


def _require_columns(path: Path, head: list[str]) -> None:
    known = _known(head)
    for name in head:
        if _is_read(name) and name not in known:
            raise ParameterError(f"{path}: there is no column {name}. {meant(name, known)}There are {', '.join(known)}")
        if head.count(name) > 1:
            raise ParameterError(f"{path}: the column {name} is there twice; leave one out")
    clocks = [name for name in known[:3] if name in head]
    if len(clocks) != 1:
        raise ParameterError(f"{path}: it needs one of the columns time_s (time in .mot) and distance_m")
    needed = [f"{side}_{name}" for side in SIDES for name in (*OF_SLOPE, *ANGLES)] if "left_x_m" in head else []
    for name in needed:
        if name not in head:
            raise ParameterError(f"{path}: the column {name} is missing; boots in the slope's frame need every one")


def _column(path: Path, rows: list[list[str]], head: list[str], place: int, first: int) -> npt.NDArray[np.float64]:
    values = np.empty(len(rows))
    for i, row in enumerate(rows):
        if len(row) != len(head):
            raise ParameterError(f"{path}, row {i + first}: {len(row)} cells stand under {len(head)} names of columns")
        try:
            values[i] = float(row[place])
        except ValueError:
            values[i] = math.nan
        if not math.isfinite(values[i]):
            raise ParameterError(
                f"{path}, row {i + first}, column {head[place]}: {row[place].strip()!r} is no finite number; write one"
                f"{' with a decimal point' if ',' in row[place] else ''}"
            )
        if head[place].endswith(_EDGE) and abs(values[i]) > _ON_ITS_SIDE:
            raise ParameterError(
                f"{path}, row {i + first}, column {head[place]}: {values[i]:g} is beyond ±{_ON_ITS_SIDE:g}, a ski "
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
