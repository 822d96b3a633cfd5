"""Boots that move: a table of where each of them is over time, or over the distance run."""

from __future__ import annotations

import csv
import io
import math
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Literal, TypeAlias, get_args

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError, require_choice
from .._support.messages import Message
from .._support.spreadsheet_text import column_names, decimal_mark, most_frequent_separator, with_decimal_point
from .._support.units import DEGREE, Facts, Shown, ends
from .._support.user_files.motion_head import HEAD_END, degrees_stated, head_of_motion, require_whole
from .._support.user_files.text_files import plain_text
from ..geometry.vectors import axes_of
from ..parameters import suggest_and_list

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline
    from scipy.spatial.transform import RotationSpline

Frame: TypeAlias = Literal["sledge", "slope"]
Over: TypeAlias = Literal["time", "distance"]

LARGEST: Final = 1e7
"""Largest time (s), distance and coordinate (m) of a pose (coordinates of a map are below it)."""
SHORTEST_STEP: Final = 1e-6
"""Shortest step from row to row (s, m), so that a spline through the rows is finite."""
FURTHEST_TURN: Final = 1e3
"""Largest rotation that the spline between two rows may make (rad): it makes about the half turn that rows can show."""
FEWEST_POSES: Final = 4
"""Rows of a table of boots at least: a cubic goes through them."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Boots(Shown):
    """Poses of both boots over time or distance. The arrays are read-only.

    Attributes
    ----------
    at
        Time (s) or distance run (m), strictly rising, (n,), n ≥ 4. Before the first and after the last the boots rest
        where they are then.
    place
        (n, 2, 3) of the left and the right boot (m).
    axes
        (n, 2, 3, 3) of their skis: ahead, left across the base, off the base, as rows.
    frame
        "sledge": of the sledge, which the snow moves; "slope": of the slope, so that the boots follow the table
        and nothing else moves them.
    over
        Quantity of ``at``: "time" or "distance"; "distance" needs the frame of the sledge.
    source
        Origin of the poses, in words.

    Raises
    ------
    ParameterError
        Fewer than four rows, shapes that do not match, a number that is not finite, rows that do not rise, or invalid
        axes.

    See Also
    --------
    skisnow.Scenario

    Notes
    -----
    Places are joined by a cubic spline, axes by a spline of rotations with continuous angular acceleration.
    """

    at: FloatArray
    place: FloatArray
    axes: FloatArray
    frame: Frame = "sledge"
    over: Over = "time"
    source: str = Message("given as numbers")
    _place: CubicSpline = field(init=False, repr=False)
    _axes_over_time: tuple[RotationSpline, ...] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        from scipy.interpolate import CubicSpline

        for name in ("at", "place", "axes"):
            table = np.array(getattr(self, name), dtype=float)
            table.flags.writeable = False
            object.__setattr__(self, name, table)
        self._require_sound()
        object.__setattr__(self, "_place", CubicSpline(self.at, self.place))
        object.__setattr__(self, "_axes_over_time", self._join_axes())

    def _join_axes(self) -> tuple[RotationSpline, ...]:
        """Spline of rotations of each boot; SciPy's iteration diverges where axes turn far within a short step."""
        from scipy.spatial.transform import Rotation, RotationSpline

        turned = np.swapaxes(self.axes, -1, -2)
        powers = np.diff(self.at)[None, :, None] ** np.arange(3, -1, -1)[:, None, None]
        cause: Exception | None = None
        try:
            with np.errstate(over="raise", divide="raise", invalid="raise"):
                rotations = (Rotation.from_matrix(turned[:, ski].copy()) for ski in range(2))
                splines = tuple(RotationSpline(self.at, rotation) for rotation in rotations)
                furthest = max(float((np.abs(spline.interpolator.c) * powers).sum(axis=0).max()) for spline in splines)
        except (ValueError, FloatingPointError, np.linalg.LinAlgError) as error:
            furthest, cause = math.inf, error
        if furthest > FURTHEST_TURN:
            raise ParameterError(
                "boots: no spline joins these axes: they turn too far within too short a step. Correct the rows, or "
                "space them more evenly."
            ).tag("not_joined") from cause
        return splines

    def _require_sound(self) -> None:
        """Reject wrong shapes, numbers, axes and choices, rows that do not rise, and the slope frame over distance."""
        n = len(self.at) if self.at.ndim == 1 else 0
        if n < FEWEST_POSES or self.place.shape != (n, 2, 3) or self.axes.shape != (n, 2, 3, 3):
            raise ParameterError(
                "boots need {fewest_poses} rows or more, each with a place (2, 3) and axes (2, 3, 3); there are "
                "{shape}, {shape_2} and {shape_3}"
            ).tag(
                "wrong_shape",
                fewest_poses=FEWEST_POSES,
                shape=str(self.at.shape),
                shape_2=str(self.place.shape),
                shape_3=str(self.axes.shape),
            )
        for name in ("at", "place", "axes"):
            if not np.isfinite(getattr(self, name)).all():
                raise ParameterError("boots: {name} contains a number that is not finite").tag(
                    "not_a_number", name=name
                )
            if np.abs(getattr(self, name)).max() > LARGEST:
                raise ParameterError("boots: {name} has a number beyond ±{largest:g}. Correct it.").tag(
                    "out_of_range", name=name, largest=LARGEST
                )
        _require_rising(self.at, lambda row: Message("boots: {over} of row {row}", over=self.over, row=row + 1))
        off = np.abs(self.axes @ np.swapaxes(self.axes, -1, -2) - np.eye(3)).max()
        if off > 1e-9 or np.any(np.linalg.det(self.axes) < 0.0):
            raise ParameterError("boots: axes are off by {off:.1e} from right-handed orthonormal ones").tag(
                "not_a_rotation", off=off
            )
        require_choice("boots: frame", self.frame, get_args(Frame))
        require_choice("boots: over", self.over, get_args(Over))
        if self.frame == "slope" and self.over == "distance":
            raise ParameterError(
                "boots in the slope's frame are given over time: the distance follows from their motion"
            ).tag("contradiction")

    def _repr_facts(self) -> Facts:
        """Title with the number of poses, their range in time or distance, the frame and the source."""
        unit = "s" if self.over == "time" else "m"
        return Facts(f"{len(self.at)} poses of each, {ends(self.at, unit)}, in the {self.frame}'s frame; {self.source}")

    def poses(self, at: float) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Places (2, 3), axes (2, 3, 3), velocities and angular velocities (2, 3), in the frame, per unit of ``at``."""
        within = float(np.clip(at, self.at[0], self.at[-1]))
        rest = 0.0 if at != within else 1.0
        axes = np.array([np.swapaxes(ax(within).as_matrix(), -1, -2) for ax in self._axes_over_time])
        turning = np.array([own.T @ ax(within, 1) for own, ax in zip(axes, self._axes_over_time, strict=True)])
        return self._place(within), axes, rest * self._place(within, 1), rest * turning


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
"""Edge angle (°) of a ski that is on its edge: beyond it the base looks up."""
_MOST_BYTES: Final = 1 << 28
_HEAD: Final = 1 << 16
_OF_OPENSIM: Final = (".mot", ".sto")

Row: TypeAlias = tuple[int, list[str]]
"""Its line in the file, counted from 1, and its cells."""


def read_boots(path: str | Path, *, edge_angle: float = 0.0, stance_width: float = 0.0) -> Boots:
    """Read poses of both boots.

    path: a CSV file, or .mot or .sto of OpenSim. The page docs/files/scenario.md names the columns.
    edge_angle, stance_width: values of the sledge for angles and places that the file does not give (rad, m).
    """
    path = Path(path)
    (_, names), *rows = _rows(path, plain_text(path, most_bytes=_MOST_BYTES))
    stripped = [name.strip() for name in names]
    head = column_names(stripped, (*CLOCKS, *(f"{side}_{name}" for side in SIDES for name in _OF_A_BOOT)))
    _require_columns(path, head)
    table = {
        name: _read_column(path, rows, head, place) for place, name in enumerate(head) if not name.endswith(_RESULTS)
    }
    clock = next(name for name in CLOCKS if name in table)
    if len(rows) < FEWEST_POSES:
        raise ParameterError("{path}: {n_rows} rows with poses; boots need {fewest_poses} rows or more").tag(
            "out_of_range", path=path, n_rows=len(rows), fewest_poses=FEWEST_POSES
        )
    at = table[clock]
    _require_rising(
        at, lambda row: Message("{path}, row {line}, column {clock}", path=path, line=rows[row][0], clock=clock)
    )
    try:
        if "left_x_m" in head:
            places = [np.stack([table[f"{side}_{name}"] for name in OF_SLOPE], axis=-1) for side in SIDES]
            place, axes = np.stack(places, axis=1), _axes_of_table(table, dict.fromkeys(ANGLES, 0.0))
        else:
            place, axes = _boots_on_sledge(table, edge_angle, stance_width)
        return Boots(
            at,
            place,
            axes,
            frame="slope" if "left_x_m" in head else "sledge",
            over="distance" if clock == "distance_m" else "time",
            source=str(path),
        )
    except ParameterError as error:
        raise error.at(path) from error


def _rows(path: Path, text: str) -> list[Row]:
    """Rows that are not blank, from the one with the names of columns on."""
    lines = text.splitlines()
    if path.suffix.lower() in _OF_OPENSIM:
        rows, said = _behind_head(path, lines)
    elif path.suffix.lower() == ".csv":
        rows, said = _of_csv(path, text), {}
    else:
        raise ParameterError(
            "{path}: boots are read from .csv, .mot and .sto; give the file the ending of its format"
        ).tag("wrong_ending", path=path)
    if not rows:
        raise ParameterError("{path}: the row with the names of columns is missing").tag("unknown_name", path=path)
    names = rows[0][1]
    require_whole(path, said, nRows=len(rows) - 1, nColumns=len(names))
    if degrees_stated(path, said) is False and any(name.endswith(ANGLES) for name in names):
        raise ParameterError(
            "{path}: the header states inDegrees=no, but angles of boots are in degrees; multiply them by 57.29578 "
            "and write inDegrees=yes"
        ).tag("in_degrees", path=path)
    return rows


def _of_csv(path: Path, text: str) -> list[Row]:
    """Rows of a table with commas, semicolons or tabs; numbers with a decimal comma get a point."""
    separator = most_frequent_separator(text[:_HEAD])
    table = csv.reader(io.StringIO(text), delimiter=separator)
    try:
        rows = [(table.line_num, row) for row in table if any(cell.strip() for cell in row)]
    except csv.Error as error:
        raise ParameterError("{path} is not CSV text ({error})").tag("wrong_kind", path=path, error=error) from error
    cells = (cell for _, row in rows[1:] for cell in row)
    if separator == "," or decimal_mark([cells], separator=separator) == ".":
        return rows
    return [*rows[:1], *((line, [with_decimal_point(cell.strip()) for cell in row]) for line, row in rows[1:])]


def _behind_head(path: Path, lines: list[str]) -> tuple[list[Row], dict[str, str]]:
    """Rows of the table below the header of an OpenSim file, and the statements of the header."""
    ends = [i for i, line in enumerate(lines) if line.strip().lower() == HEAD_END]
    if not ends:
        raise ParameterError("{path} has no line {head_end}, which ends the head of a .mot or .sto file; add it").tag(
            "no_data", path=path, head_end=HEAD_END
        )
    begin = ends[0] + 1
    rows = [(number, line.split()) for number, line in enumerate(lines[begin:], begin + 1) if line.strip()]
    return rows, head_of_motion(lines[: ends[0]])


def _require_columns(path: Path, head: list[str]) -> None:
    """Reject unknown, repeated and missing columns; time or distance, and a column of a boot are needed."""
    places = OF_SLOPE if "left_x_m" in head else OF_SLEDGE
    motion_columns = (*CLOCKS, *(f"{side}_{name}" for side in SIDES for name in (*places, *ANGLES)))
    counts = Counter(head)
    for name in head:
        if not name.endswith(_RESULTS) and name not in motion_columns:
            raise ParameterError("{path}: unknown column {name}. {allowed}").tag(
                "missing", path=path, name=name, allowed=suggest_and_list(name, motion_columns)
            )
        if counts[name] > 1:
            raise ParameterError("{path}: the column {name} occurs twice; remove one").tag(
                "repeated", path=path, name=name
            )
    clocks = [name for name in CLOCKS if name in head]
    if len(clocks) != 1:
        raise ParameterError("{path}: it needs one of the columns time_s (time in .mot) and distance_m").tag(
            "missing", path=path
        )
    if not any(name in motion_columns and name not in clocks for name in head):
        raise ParameterError("{path}: no column is one of a boot. There are {known}").tag(
            "missing", path=path, known=list(motion_columns[3:])
        )
    needed = [f"{side}_{name}" for side in SIDES for name in (*OF_SLOPE, *ANGLES)] if "left_x_m" in head else []
    for name in needed:
        if name not in head:
            raise ParameterError("{path}: the column {name} is missing; boots in the slope's frame need every one").tag(
                "missing", path=path, name=name
            )


def _require_rising(at: FloatArray, place: Callable[[int], Message]) -> None:
    """Reject rows that do not rise by enough for a finite spline; `place` names a row, 0 or more, in the error."""
    steps = np.diff(at)
    if not np.all(steps >= SHORTEST_STEP):
        row = int(np.argmin(steps > 0.0 if (steps <= 0.0).any() else steps >= SHORTEST_STEP))
        fields = {"place": place(row + 1), "after": at[row + 1], "before": at[row]}
        if steps[row] <= 0.0:
            raise ParameterError(
                "{place}: {after:g} after {before:g}; it must rise. Put the rows in order, or leave one of two with "
                "the same pose out"
            ).tag("not_rising", **fields)
        raise ParameterError(
            "{place}: {after:g} after {before:g}. Allowed: steps of {shortest_step:g} or more. Correct the number, or "
            "omit one of the rows."
        ).tag("out_of_range", shortest_step=SHORTEST_STEP, **fields)


def _read_column(path: Path, rows: list[Row], head: list[str], place: int) -> FloatArray:
    """Numbers of one column; rejects a row with a wrong number of cells, or a cell that is no number."""
    values = np.empty(len(rows))
    for i, (line, row) in enumerate(rows):
        if len(row) != len(head):
            raise ParameterError("{path}, row {line}: {n_row} cells for {n_head} names of columns").tag(
                "wrong_number_of_cells", path=path, line=line, n_row=len(row), n_head=len(head)
            )
        values[i] = _cell(path, line, head[place], row[place])
    return values


def _cell(path: Path, line: int, column: str, text: str) -> float:
    """Number of a cell within the limits of its column."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    cell = {"path": path, "line": line, "head": column}
    if not math.isfinite(value):
        raise ParameterError("{path}, row {line}, column {head}: {value!r} is not a finite number; write one").tag(
            "not_a_number", value=text.strip(), **cell
        )
    if abs(value) > LARGEST:
        raise ParameterError(
            "{path}, row {line}, column {head}: {value:g} is beyond ±{largest:g}. Correct the number."
        ).tag("out_of_range", value=value, largest=LARGEST, **cell)
    if column.endswith(_EDGE) and abs(value) > _ON_ITS_SIDE:
        raise ParameterError(
            "{path}, row {line}, column {head}: {value:g} is beyond ±{on_its_side:g}, a ski on its side; correct or "
            "remove the row"
        ).tag("out_of_range", value=value, on_its_side=_ON_ITS_SIDE, **cell)
    return value


def _axes_of_table(table: Mapping[str, Any], missing: Mapping[str, float]) -> FloatArray:
    """Axes (n, 2, 3, 3) from the columns of angles (°); `missing` has the angles of absent columns."""
    n = len(next(iter(table.values())))
    angles = [[table.get(f"{side}_{name}", np.full(n, missing[name])) * DEGREE for name in ANGLES] for side in SIDES]
    return np.array([[axes_of(*(float(row[i]) for row in of_ski)) for of_ski in angles] for i in range(n)])


def _boots_on_sledge(table: Mapping[str, Any], edge_angle: float, stance_width: float) -> tuple[FloatArray, FloatArray]:
    """Places (n, 2, 3) (m) and axes (n, 2, 3, 3) of both boots in the sledge's frame, from a table's columns."""
    n = len(next(iter(table.values())))
    place = np.zeros((n, 2, 3))
    for ski, (side, sense) in enumerate(zip(SIDES, (1.0, -1.0), strict=True)):
        for axis, name in enumerate(OF_SLEDGE):
            own = sense * stance_width / 2.0 if name == "aside_m" else 0.0
            place[:, ski, axis] = table.get(f"{side}_{name}", own)
    return place, _axes_of_table(table, {"edge_angle_deg": edge_angle / DEGREE, "pitch_deg": 0.0, "heading_deg": 0.0})
