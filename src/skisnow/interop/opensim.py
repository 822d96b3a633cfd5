"""OpenSim's files: tables of motion and storage (.mot, .sto), markers (.trc, .c3d), and poses of boots from markers.

A table has a head up to ``endheader``, names of columns, and numbers.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import chain, count, takewhile
from pathlib import Path
from typing import Final, Literal

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError, require_choice, require_range
from .._support.spreadsheet_text import csv_text
from .._support.staging import require_ending, write_file
from .._support.units import DEGREE, Facts, Shown, amount
from .._support.user_files.motion_head import HEAD_END, head_of_motion, is_in_degrees, require_whole
from .._support.user_files.text_files import ContentError, plain_bytes, plain_text
from ..geometry.vectors import angles_of
from ..scenario.boots import ANGLES, LARGEST, OF_SLOPE, SIDES, Boots
from .c3d import Values, c3d_content

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
    name: first line of the file's header.
    head: other keys of the header with their values.
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
        """Title with the numbers of columns and rows, and the last time (s)."""
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
    parsed: list[list[float]] = []
    for number, cells in rows:
        if len(cells) != len(names):
            raise ParameterError("{path}, line {number}: {n_cells} cells for {n_names} names of columns").tag(
                "wrong_number_of_cells", path=path, number=number, n_cells=len(cells), n_names=len(names)
            )
        where = f"{path}, line {number}, column"
        parsed.append([number_of(cell, f"{where} {column}") for column, cell in zip(names, cells, strict=True)])
    numbers = np.array(parsed).reshape(-1, len(names))
    others = {key: value for key, value in head.items() if key.lower() not in _OWN_KEYS}
    in_degrees = is_in_degrees(path, head)
    try:
        columns = {name: numbers[:, place] for place, name in enumerate(names) if place}
        return MotionTable(numbers[:, 0], columns, in_degrees, name or Path(path).stem, others)
    except ParameterError as error:
        raise error.at(path) from error


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


METRES: Final = {"m": 1.0, "cm": 1e-2, "mm": 1e-3}
"""Size of a unit of length that a file may name."""
_HEAD: Final = 5  # lines before the first row: file, keys, values, names, axes


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Markers(Shown):
    """Places of markers over time.

    time: (n,), rising (s).
    names: names of the k markers.
    place: (n, k, 3) in the laboratory's axes (m); not a number where a marker was not seen.
    rate: frames a second (Hz).
    omitted: names of points of the file that are not places, such as angles and forces.
    Raises ParameterError: shapes do not fit, times do not rise, or a name is there twice.
    """

    time: FloatArray
    names: tuple[str, ...]
    place: FloatArray
    rate: float
    omitted: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        require_rising("markers", self.time)
        if np.shape(self.place) != (len(self.time), len(self.names), 3):
            raise ParameterError("markers: place has shape {shape}; it must be {needed}").tag(
                "wrong_shape", shape=str(np.shape(self.place)), needed=str((len(self.time), len(self.names), 3))
            )
        if len(set(self.names)) < len(self.names):
            name = next(name for name in self.names if self.names.count(name) > 1)
            raise ParameterError("markers: the name {name} is there twice; each marker needs a separate name").tag(
                "repeated", name=name
            )
        require_range("rate", self.rate, 0.0, np.inf, above=True, below=True)

    def _repr_facts(self) -> Facts:
        """Title with the numbers of markers, frames and omitted points, and the rate (Hz)."""
        omitted = f", {len(self.omitted)} other points omitted" if self.omitted else ""
        return Facts(f"{len(self.names)} markers, {len(self.time)} frames at {amount(self.rate, 'Hz')}{omitted}")

    def of(self, name: str) -> FloatArray:
        """Places of one marker, (n, 3) (m).

        Raises ParameterError: unknown name.
        """
        if name not in self.names:
            raise ParameterError("unknown marker {name}; the markers are {names}").tag(
                "unknown_name", name=name, names=list(self.names)
            )
        return self.place[:, self.names.index(name)]


def read_trc(path: str | Path) -> Markers:
    """Read a .trc file; empty cells are markers that were not seen.

    Raises ParameterError: the file cannot be read, its header is invalid, its unit is not m, cm or mm, or a cell is not
        a number; the message names file, line, marker and value.
    """
    lines = plain_text(path, most_bytes=MOST_BYTES).splitlines()
    if len(lines) < _HEAD or not lines[0].startswith("PathFileType"):
        raise ParameterError(
            "{path} does not begin with PathFileType and a head of five lines, as a .trc file does"
        ).tag("wrong_kind", path=path)
    head = dict(zip(lines[1].split(), lines[2].split(), strict=False))
    unit = head.get("Units", "")
    if unit not in METRES:
        raise ParameterError("{path}, line 3: Units is {unit!r}; it must be one of {metres}").tag(
            "wrong_kind", path=path, unit=unit, metres=list(METRES)
        )
    names = tuple(word.strip() for word in lines[3].split("\t")[2:] if word.strip())
    rows = [(i + 1, line) for i, line in enumerate(lines[_HEAD:], start=_HEAD) if line.strip()]
    require_whole(path, head, NumMarkers=len(names), NumFrames=len(rows))
    numbers = [_row(path, number, line, names) for number, line in rows]
    try:
        rate = float(head.get("DataRate", "nan"))
        table = np.array(numbers).reshape(-1, 1 + 3 * len(names))
        return Markers(table[:, 0], names, METRES[unit] * table[:, 1:].reshape(-1, len(names), 3), rate)
    except ParameterError as error:
        raise error.at(path) from error
    except ValueError as error:
        raise ParameterError("{path}: {reason}").tag("not_a_number", path=path, reason=error) from error


def _row(path: str | Path, number: int, line: str, names: tuple[str, ...]) -> list[float]:
    """Time and three coordinates of each marker in a line of a .trc file; NaN for an empty cell."""
    cells = [cell.strip() for cell in line.split("\t")]
    wanted = 2 + 3 * len(names)
    cells += [""] * (wanted - len(cells))
    if any(cells[wanted:]):
        raise ParameterError("{path}, line {number}: more cells than {n_names} markers have").tag(
            "wrong_number_of_cells", path=path, number=number, n_names=len(names)
        )
    values = []
    for place, cell in enumerate(cells[1:wanted]):
        what = "Time" if place == 0 else f"{names[(place - 1) // 3]} {'XYZ'[(place - 1) % 3]}"
        values.append(number_of(cell, f"{path}, line {number}, {what}") if cell or place == 0 else np.nan)
    return values


def write_trc(markers: Markers, path: str | Path) -> None:
    """Write a .trc file in metres, numbers with all their digits; cells of markers not seen are empty.

    Raises ParameterError: the name ends otherwise.
    Raises OutputError: the place cannot be written.
    """
    path = Path(path)
    require_ending(path, ".trc")
    n, k = len(markers.time), len(markers.names)
    rate = repr(float(markers.rate))
    lines = [
        f"PathFileType\t4\t(X/Y/Z)\t{path.name}",
        "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames",
        f"{rate}\t{rate}\t{n}\t{k}\tm\t{rate}\t1\t{n}",
        "Frame#\tTime\t" + "\t".join(f"{name}\t\t" for name in markers.names).rstrip("\t"),
        "\t\t" + "\t".join(f"{axis}{number}" for number in range(1, k + 1) for axis in "XYZ"),
        "",
    ]
    for number, (time, row) in enumerate(zip(markers.time.tolist(), markers.place, strict=True), start=1):
        cells = ("" if np.isnan(value) else repr(value) for value in row.ravel().tolist())
        lines.append("\t".join((str(number), repr(time), *cells)))
    write_file(path, "\n".join(lines) + "\n")


_GROUPS: Final = ("ANGLES", "FORCES", "MOMENTS", "POWERS", "REACTIONS", "SCALARS")
"""Lists of points that are not places, as gait programs write them."""
_JOINT: Final = "ankle|knee|hip|pelvis|trunk|spine|thorax|waist|neck|head|shoulder|elbow|wrist|foot|toe|progress(ion)?"
_QUANTITY: Final = re.compile(
    rf"(angles|({_JOINT})[ _]?angle|forces?|moments?|torques?|powers?|GRF|velocit(y|ies)|accelerations?)"
    r"([ _.]?([fm]?[xyz]|[lr]|left|right))?[ _]?\d*$",
    re.IGNORECASE,
)
"""Ends of the names that these programs give to such points, for files without the lists."""


def read_c3d(path: str | Path) -> Markers:
    """Read the markers of a .c3d file.

    Angles, forces, moments and powers that a program for gait stored among the points are listed in ``omitted``, and
    points without a name by their number.

    Raises ParameterError: the file cannot be read or is damaged, or it has no markers or no sound unit.
    """
    try:
        content = c3d_content(plain_bytes(path, most_bytes=MOST_BYTES))
    except ContentError:
        raise
    except ParameterError as error:
        raise ParameterError("{path} cannot be read as .c3d: {error}. Export it again").tag(
            "cannot_read", path=path, error=error
        ) from error
    about = {name: values for (group, name), values in content.parameters.items() if group == "POINT"}
    rate, first, points = content.rate, content.first_frame, content.points
    labels, units = _labels_and_units(about)
    quantities = {name for group in _GROUPS for name in _texts_of(about, group)}
    names = labels[: points.shape[1]]
    columns = [i for i, name in enumerate(names) if name and name not in quantities and not _QUANTITY.search(name)]
    if not columns:
        raise ParameterError("{path}: it has no markers. Allowed: at least one name in POINT:LABELS with a place.").tag(
            "out_of_range", path=path
        )
    unknown = next((i for i in columns if units[i] not in METRES), None)
    if unknown is not None:
        raise ParameterError(
            "{path}: marker {name} is in {unit!r}. Allowed: {metres}. Export the markers in one of these units."
        ).tag("out_of_range", path=path, name=names[unknown], unit=units[unknown], metres=list(METRES))
    if not (np.isfinite(rate) and rate > 0.0):
        raise ParameterError("{path}: its rate is {rate:g} Hz. Allowed: above 0. Export the file again.").tag(
            "out_of_range", path=path, rate=rate
        )
    sizes = np.array([METRES[units[i]] for i in columns])
    place = points[:, columns] * sizes[:, None]
    time = (first + np.arange(len(place))) / rate
    names += [""] * (points.shape[1] - len(names))
    omitted = tuple(name or f"point {i + 1}" for i, name in enumerate(names) if i not in columns)
    try:
        return Markers(time, tuple(names[i] for i in columns), np.ascontiguousarray(place), rate, omitted)
    except ParameterError as error:
        raise ParameterError("{path}: {problem}").tag("damaged", path=path, problem=error) from error


def _labels_and_units(about: Mapping[str, Values]) -> tuple[list[str], list[str]]:
    """Name and unit of each point; further blocks of 255 names are called LABELS2, LABELS3 and so on."""
    labels: list[str] = []
    units: list[str] = []
    blocks = (str(number) if number > 1 else "" for number in count(1))
    for block in takewhile(lambda block: f"LABELS{block}" in about, blocks):
        names, of_block = _texts_of(about, f"LABELS{block}"), _texts_of(about, f"UNITS{block}")
        labels += names
        one = next(iter(of_block or units), "")
        units += [unit.lower() for unit in (of_block if len(of_block) == len(names) else [one] * len(names))]
    return labels, units


def _texts_of(about: Mapping[str, Values], key: str) -> list[str]:
    """Texts of a parameter; empty if it is missing."""
    return [word for word in about.get(key, ()) if isinstance(word, str)]


FROM_OPENSIM: Final = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""From axes with y up and z to the right to those with y to the left and z up."""


@dataclass(frozen=True, slots=True)
class BootMarkers:
    """Three markers of a boot, and where its sole is from the one at the heel.

    heel, toe: names of markers one behind the other along the boot.
    left: name of a marker to the left of that line, at the height of the base of a flat ski.
    sole: middle of the sole at the level of the base, from the heel's marker: ahead, left, up in the boot's axes (m).
    """

    heel: str
    toe: str
    left: str
    sole: tuple[float, float, float] = (0.0, 0.0, 0.0)


def boots_of_markers(
    markers: Markers, left: BootMarkers, right: BootMarkers, *, up: Literal["y", "z"] = "y", slope_angle: float = 0.0
) -> Boots:
    """Poses of both boots in the slope's axes.

    markers: in axes with x horizontally down the slope and the second or third axis upwards.
    left, right: the markers of each boot.
    up: "y" as OpenSim has it (z to the right), or "z" (y to the left).
    slope_angle: angle of the slope (rad): the boots' poses are turned into its axes. 0 where the markers' axes are
        those of the slope.
    Raises ParameterError: a marker is missing, was not seen in a frame (the error gives name and time), or three lie on
        one line.
    """
    require_choice("up", up, ("y", "z"))
    c, s = np.cos(slope_angle), np.sin(slope_angle)
    turned = np.array([[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]]) @ (FROM_OPENSIM if up == "y" else np.eye(3))
    poses = [_pose(markers, boot, turned) for boot in (left, right)]
    place, axes = (np.stack(pose, axis=1) for pose in zip(*poses, strict=True))
    return Boots(markers.time, place, axes, frame="slope", source="markers")


def _pose(markers: Markers, of: BootMarkers, turned: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Places (n, 3) (m) and axes (n, 3, 3) of a boot: rows ahead, left and off the base, from its three markers."""
    heel, toe, left = (_complete_places(markers, name) @ turned.T for name in (of.heel, of.toe, of.left))
    ahead = _unit_vectors(toe - heel, of)
    off = _unit_vectors(np.cross(ahead, left - heel), of)
    axes = np.stack([ahead, np.cross(off, ahead), off], axis=1)
    return heel + np.einsum("c,nca->na", np.asarray(of.sole), axes), axes


def _complete_places(markers: Markers, name: str) -> FloatArray:
    """Places (m) of a marker in every frame; rejects gaps and places out of range."""
    place = markers.of(name)
    unseen = ~np.isfinite(place).all(axis=1)
    if unseen.any():
        first = float(markers.time[int(np.argmax(unseen))])
        raise ParameterError(
            "marker {name} was not seen in {count} frames, first at {first:g} s; fill the gaps before"
        ).tag("gap", name=name, count=int(unseen.sum()), first=first)
    far = ~(np.abs(place) <= LARGEST).all(axis=1)
    if far.any():
        first = float(markers.time[int(np.argmax(far))])
        raise ParameterError(
            "marker {name} is beyond ±{largest:g} m in {count} frames, first at {first:g} s. Correct the numbers, or "
            "the unit of the file."
        ).tag("out_of_range", name=name, largest=LARGEST, count=int(far.sum()), first=first)
    return place


def _unit_vectors(vectors: FloatArray, of: BootMarkers) -> FloatArray:
    """Vectors divided by their lengths; rejects one without a length: the markers of the boot lie on one line."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    if not np.all(length > 1e-9):
        raise ParameterError(
            "markers {heel}, {toe} and {left} lie on one line; three that span a plane are needed"
        ).tag("out_of_range", heel=of.heel, toe=of.toe, left=of.left)
    return np.asarray(vectors / length)


def boots_text(boots: Boots, *, edge_angles_only: bool = False) -> str:
    """CSV text for ``boots.file`` of poses in the slope's frame.

    boots: as `boots_of_markers` gives them.
    edge_angles_only: only edge angles; the boots then move with the scenario's sledge.
    """
    angles = angles_of(boots.axes) / DEGREE
    columns: dict[str, Sequence[float]] = {"time_s": boots.at.tolist()}
    for k, side in enumerate(SIDES):
        if not edge_angles_only:
            columns |= {f"{side}_{name}": boots.place[:, k, i].tolist() for i, name in enumerate(OF_SLOPE)}
        names = ANGLES[:1] if edge_angles_only else ANGLES
        columns |= {f"{side}_{name}": angles[:, k, i].tolist() for i, name in enumerate(names)}
    return csv_text(chain([columns], (map(repr, row) for row in zip(*columns.values(), strict=True))))
