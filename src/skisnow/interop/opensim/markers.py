"""Markers of a motion capture, and their text files (.trc)."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from ..._support.arrays import FloatArray
from ..._support.display import Facts, Shown, amount
from ..._support.errors import ParameterError
from ..._support.staging import write_file
from ..._support.user_files import plain_text
from .table import MOST_BYTES, number_of, require_rising

METRES: Final = {"m": 1.0, "cm": 1e-2, "mm": 1e-3}
"""Size of a unit of length that a file may name."""
_HEAD: Final = 5  # lines before the first row: file, keys, values, names, axes


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Markers(Shown):
    """Places of markers over time.

    Attributes
    ----------
    time
        (n,), rising (s).
    names
        Names of the k markers.
    place
        (n, k, 3) in the laboratory's axes (m); not a number where a marker was not seen.
    rate
        Frames a second (Hz).
    omitted
        Names of points of the file that are not places, such as angles and forces.

    Raises
    ------
    ParameterError
        Shapes do not fit, times do not rise, or a name is there twice.
    """

    time: FloatArray
    names: tuple[str, ...]
    place: FloatArray
    rate: float
    omitted: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        require_rising("markers", self.time)
        if np.shape(self.place) != (len(self.time), len(self.names), 3):
            raise ParameterError(
                "markers: place has shape {shape}; it must be {needed}",
                code="wrong_shape",
                shape=str(np.shape(self.place)),
                needed=str((len(self.time), len(self.names), 3)),
            )
        if len(set(self.names)) < len(self.names):
            raise ParameterError("markers: a name is there twice; each marker needs a separate name", code="repeated")
        if not (np.isfinite(self.rate) and self.rate > 0.0):
            raise ParameterError(
                "markers: rate is {rate!r} Hz; it must be above 0", code="out_of_range", rate=self.rate
            )

    def _facts(self) -> Facts:
        omitted = f", {len(self.omitted)} other points omitted" if self.omitted else ""
        return Facts(f"{len(self.names)} markers, {len(self.time)} frames at {amount(self.rate, 'Hz')}{omitted}")

    def of(self, name: str) -> FloatArray:
        """Places of one marker, (n, 3) (m).

        Raises
        ------
        ParameterError
            Unknown name.
        """
        if name not in self.names:
            raise ParameterError(
                "there is no marker {name}; there are {names}", code="unknown_name", name=name, names=list(self.names)
            )
        return self.place[:, self.names.index(name)]


def read_trc(path: str | Path) -> Markers:
    """Read a .trc file; empty cells are markers that were not seen.

    Raises
    ------
    ParameterError
        The file cannot be read, its head is invalid, its unit is not m, cm or mm, or a cell holds no number; file,
        line, marker and value are named.
    """
    lines = plain_text(path, most_bytes=MOST_BYTES).splitlines()
    if len(lines) < _HEAD or not lines[0].startswith("PathFileType"):
        raise ParameterError(
            "{path} does not begin with PathFileType and a head of five lines, as a .trc file does",
            code="wrong_kind",
            path=path,
        )
    head = dict(zip(lines[1].split(), lines[2].split(), strict=False))
    unit = head.get("Units", "")
    if unit not in METRES:
        raise ParameterError(
            "{path}, line 3: Units is {unit!r}; it must be one of {metres}",
            code="wrong_kind",
            path=path,
            unit=unit,
            metres=list(METRES),
        )
    names = tuple(word.strip() for word in lines[3].split("\t")[2:] if word.strip())
    rows = [(i + 1, line) for i, line in enumerate(lines[_HEAD:], start=_HEAD) if line.strip()]
    numbers = [_row(path, number, line, names) for number, line in rows]
    try:
        rate = float(head.get("DataRate", "nan"))
        table = np.array(numbers).reshape(-1, 1 + 3 * len(names))
        return Markers(table[:, 0], names, METRES[unit] * table[:, 1:].reshape(-1, len(names), 3), rate)
    except ParameterError as error:
        raise error.at(path) from error
    except ValueError as error:
        raise ParameterError("{path}: {reason}", code="not_a_number", path=path, reason=error) from error


def _row(path: str | Path, number: int, line: str, names: tuple[str, ...]) -> list[float]:
    """Time, then three numbers for each marker; the frame's number is passed over."""
    cells = [cell.strip() for cell in line.split("\t")]
    wanted = 2 + 3 * len(names)
    cells += [""] * (wanted - len(cells))
    if any(cells[wanted:]):
        raise ParameterError(
            "{path}, line {number}: more cells than {n_names} markers have",
            code="wrong_number_of_cells",
            path=path,
            number=number,
            n_names=len(names),
        )
    values = []
    for place, cell in enumerate(cells[1:wanted]):
        what = "Time" if place == 0 else f"{names[(place - 1) // 3]} {'XYZ'[(place - 1) % 3]}"
        values.append(number_of(cell, f"{path}, line {number}, {what}") if cell or place == 0 else np.nan)
    return values


def write_trc(markers: Markers, path: str | Path) -> None:
    """Write a .trc file in metres, numbers with all their digits; cells of markers not seen are empty.

    Raises
    ------
    ParameterError
        The name ends otherwise.
    OutputError
        The place cannot be written.
    """
    path = Path(path)
    if path.suffix.lower() != ".trc":
        raise ParameterError("{path} does not end in .trc; name it so", code="wrong_ending", path=path)
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
