"""A table of a ski by stations from tip to tail: its CSV file, its columns."""

from __future__ import annotations

import csv
import functools
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.spreadsheet_text import (
    SEPARATOR_NAMES,
    NoTextError,
    column_names,
    decimal_mark,
    decoded,
    named_separator,
    with_decimal_point,
)
from .._support.user_files.text_files import plain_bytes, shown_value
from ..parameters import suggest_and_list
from .file_keys import COLUMNS
from .file_values import checked, warn_of_unusual

MOST_BYTES: Final = 1 << 20
"""Most rows of a table: a row for each 2.5 mm of a ski takes 200 kB at most."""


def read_table(path: Path) -> dict[str, StationTable]:
    """Read the columns of a table, in SI, by their names; ``station_m`` is the station of each.

    The first line names the columns: ``station_m`` and any of ``width_mm``, ``base_height_mm``, ``EI_N_m2``,
    ``GJ_N_m2``, ``mass_per_length_kg_per_m``. Separators are commas, semicolons or tabs, decimals have a point or a
    comma, one of them in a file; lines beginning with # are remarks.
    """
    separator, lines = _lines(path)
    first, cells = lines[0]
    header = column_names(cells, COLUMNS)
    for place, name in enumerate(header):
        if name not in COLUMNS:
            raise ParameterError("{path}, line {line}: the column {name!r} is not known. {allowed}").tag(
                "unknown_name", path=path, line=first, name=name, allowed=suggest_and_list(name, COLUMNS)
            )
        if name in header[:place]:
            raise ParameterError("{path}, line {line}: the column {name} occurs twice. Remove one.").tag(
                "repeated", path=path, line=first, name=name
            )
    if "station_m" not in header or len(header) < 2:
        raise ParameterError(
            "{path}, line {line}: needed are the column station_m and one or more others. Add it."
        ).tag("missing", path=path, line=first)
    mark = decimal_mark([(cell for _, cells in lines[1:] for cell in cells)], separator=separator)
    rows = [_parse_row(path, line, header, cells, mark) for line, cells in lines[1:]]
    columns = dict(zip(header, np.array(rows).T, strict=True))
    numbers = [line for line, _ in lines[1:]]
    station = columns["station_m"]  # in m, as it is
    rising = np.flatnonzero(np.diff(station) >= 0)
    if rising.size:
        before, value = station[rising[0] : rising[0] + 2]
        raise ParameterError(
            "{path}: line {line}, station_m is {value}; allowed is less than the {before:g} before it. List the rows "
            "from tip to tail, positive in front of the boot."
        ).tag("out_of_range", path=path, line=numbers[rising[0] + 1], value=shown_value(float(value)), before=before)
    for name, column in columns.items():
        places = {f"line {line}, {name}": float(value) for line, value in zip(numbers, column, strict=True)}
        warn_of_unusual(path, places, COLUMNS[name])
    return {name: StationTable(station, column * COLUMNS[name].factor) for name, column in columns.items()}


def _lines(path: Path) -> tuple[str, list[tuple[int, list[str]]]]:
    """The separator, and the lines with their cells, without remarks."""
    try:
        text = decoded(plain_bytes(path, most_bytes=MOST_BYTES)).text
    except NoTextError as error:
        raise ParameterError("{path} is not text ({place} is not {encoding}). Save it as UTF-8.").tag(
            "not_text", path=path, place=error.place, encoding=error.encoding
        ) from error
    named = named_separator(text)
    first = 2 if named in SEPARATOR_NAMES else 1
    separator = named if named is not None and first == 2 else next((mark for mark in ";\t" if mark in text), ",")
    rows = enumerate(csv.reader(text.splitlines()[first - 1 :], delimiter=separator), start=first)
    try:
        lines = [(line, [cell.strip() for cell in row]) for line, row in rows if any(map(str.strip, row))]
    except csv.Error as error:
        raise ParameterError("{path} is not a table of cells ({error}). Check for a quote that is never closed.").tag(
            "not_csv", path=path, error=error
        ) from error
    lines = [(line, cells) for line, cells in lines if not cells[0].startswith("#")]
    if len(lines) < 3:
        raise ParameterError("{path}: a table needs a line of column names and two rows or more. Complete it.").tag(
            "missing", path=path
        )
    return separator, lines


def _parse_row(path: Path, line: int, header: list[str], cells: list[str], mark: str) -> list[float]:
    """Numbers of a row, with the decimal mark `mark`; rejects a wrong number of cells, text and wrong numbers."""
    if len(cells) != len(header):
        raise ParameterError("{path}, line {line}: {n_cells} cells for {n_header} columns. Correct it.").tag(
            "wrong_number_of_cells", path=path, line=line, n_cells=len(cells), n_header=len(header)
        )
    numbers = []
    for name, cell in zip(header, cells, strict=True):
        try:
            value: object = float(cell if mark == "." else with_decimal_point(cell))
        except ValueError:
            value = cell
        number = checked(path, value, replace(COLUMNS[name], name=f"line {line}, {name}"))
        assert isinstance(number, float)
        numbers.append(number)
    return numbers


@dataclass(frozen=True, slots=True, eq=False)
class StationTable:
    """Values at stations (m), listed from tip to tail.

    Between the stations a shape-preserving cubic interpolates (Fritsch and Butland 1984, as SciPy's PCHIP): it stays in
    the range of its neighbours, so a positive table stays positive. Beyond the first and the last station their values
    continue. A single value applies everywhere.

    >>> table = StationTable(np.array([0.7, 0.0, -0.7]), np.array([100.0, 440.0, 100.0]))
    >>> [round(float(value), 6) for value in table.at(np.array([0.9, 0.7, 0.0, -0.8]))]
    [100.0, 100.0, 440.0, 100.0]
    """

    station: FloatArray
    value: FloatArray

    def __post_init__(self) -> None:
        if self.station.shape != self.value.shape or self.station.ndim != 1 or not self.station.size:
            raise ParameterError("{size} values for {size_2} stations. Give one value for each station.").tag(
                "wrong_shape", size=self.value.size, size_2=self.station.size
            )
        if np.any(np.diff(self.station) >= 0):
            raise ParameterError(
                "the stations do not fall. List them from tip to tail, positive in front of the boot."
            ).tag("not_falling")

    def at(self, station: FloatArray) -> FloatArray:
        """Values at stations (m). Shape of ``station``."""
        if self.station.size == 1:
            return np.full(np.shape(station), self.value[0])
        places = np.asarray(station, float)
        return _tabulated(self.station.tobytes(), self.value.tobytes(), places.tobytes()).reshape(places.shape).copy()

    def growths(self, station: FloatArray) -> FloatArray:
        """Derivatives of the values at stations (m) by the value of each row, shape (rows, n)."""
        if self.station.size == 1:
            return np.ones((1, *np.shape(station)))
        x, y = self.station[::-1], self.value[::-1]
        by_value, by_slope = _hermite(x.tobytes(), station.tobytes())
        return np.asarray(by_value + _slope_growths(x, y) @ by_slope)[::-1]


@functools.lru_cache(maxsize=32)
def _tabulated(rows: bytes, values: bytes, station: bytes) -> FloatArray:
    """Values of a table at stations (m); cached, because a design often changes only one table."""
    x, y = np.frombuffer(rows)[::-1], np.frombuffer(values)[::-1]
    return _cubic(x, y, _slopes(x, y), np.frombuffer(station))


def _cubic(x: FloatArray, y: FloatArray, slope: FloatArray, station: FloatArray) -> FloatArray:
    """Values at stations (m) of cubics through points (…, k) with these slopes; constant beyond the ends."""
    within = np.clip(station, x[0], x[-1])
    at = np.clip(np.searchsorted(x, within, side="right") - 1, 0, x.size - 2)
    width = np.diff(x)[at]
    t, rise = (within - x[at]) / width, np.diff(y)[..., at]
    first, last = width * slope[..., at], width * slope[..., at + 1]
    return np.asarray(
        y[..., at] + t * (first + t * (3.0 * rise - 2.0 * first - last + t * (first + last - 2.0 * rise)))
    )


@functools.lru_cache(maxsize=32)
def _hermite(x: bytes, station: bytes) -> tuple[FloatArray, FloatArray]:
    """Weights of the value and of the slope at each point in the cubics at stations, each (points, stations)."""
    points, at = np.frombuffer(x), np.frombuffer(station)
    ones, zeros = np.eye(points.size), np.zeros((points.size, points.size))
    return _cubic(points, ones, zeros, at), _cubic(points, zeros, ones, at)


def _slopes(x: FloatArray, y: FloatArray) -> FloatArray:
    """Slopes at points (…, k): weighted harmonic means of the neighbouring ones, 0 at a peak; parabolas at both ends.

    Not SciPy's PCHIP, which makes the same: it takes 0.2 s to load, a fifth of the start of a run.
    """
    width = np.diff(x)
    rise = np.diff(y) / width
    if width.size == 1:
        return np.repeat(rise, 2, axis=-1)
    after, before = rise[..., 1:], rise[..., :-1]
    same = after * before > 0.0
    near, far = 2.0 * width[1:] + width[:-1], width[1:] + 2.0 * width[:-1]
    means = (near + far) / (near / np.where(same, before, 1.0) + far / np.where(same, after, 1.0))
    out = np.zeros(y.shape)
    out[..., 1:-1] = np.where(same, means, 0.0)
    # parabolas through the outer three points, limited so that they do not overshoot
    first, second, outer, inner = width[[0, -1]], width[[1, -2]], rise[..., [0, -1]], rise[..., [1, -2]]
    slope = ((2.0 * first + second) * outer - first * inner) / (first + second)
    overshoots = (outer * inner <= 0.0) & (np.abs(slope) > 3.0 * np.abs(outer))
    out[..., [0, -1]] = np.where(slope * outer <= 0.0, 0.0, np.where(overshoots, 3.0 * outer, slope))
    return out


def _slope_growths(x: FloatArray, y: FloatArray) -> FloatArray:
    """Derivatives of the slopes by each value (values, points); their mean where left and right ones differ."""
    width, last = np.diff(x), len(x) - 1
    rise = np.diff(y) / width
    by_rise = np.zeros((len(x), last))
    if last == 1:
        by_rise[:] = 1.0
    else:
        after, before, inner = rise[1:], rise[:-1], np.arange(last - 1)
        near, far = 2.0 * width[1:] + width[:-1], width[1:] + 2.0 * width[:-1]
        sums = near * after + far * before
        # [(n + f) / (n/b + f/a)]: by b it grows with n/(n + f) (s/b)², by a with f/(n + f) (s/a)²
        mean = (near + far) / np.where(sums == 0.0, 1.0, sums)
        share = np.where(after * before > 0.0, 1.0, 0.5 * (after * before == 0.0)) / (near + far)
        by_rise[inner + 1, inner] = share * near * (after * mean) ** 2
        by_rise[inner + 1, inner + 1] = share * far * (before * mean) ** 2
        for point, one, two in ((0, 0, 1), (last, last - 1, last - 2)):
            total = width[one] + width[two]
            slope = ((total + width[one]) * rise[one] - width[one] * rise[two]) / total
            if rise[one] == 0.0:
                by_rise[point, one] = 1.5 * (rise[two] != 0.0)
            elif slope * rise[one] <= 0.0:
                continue
            elif rise[one] * rise[two] <= 0.0 and abs(slope) > 3.0 * abs(rise[one]):
                by_rise[point, one] = 3.0
            else:
                by_rise[point, one], by_rise[point, two] = 1.0 + width[one] / total, -width[one] / total
    by_rise /= width
    out = np.zeros((len(x), len(x)))
    out[1:] += by_rise.T
    out[:-1] -= by_rise.T
    return out


def evenly_spread(values: npt.ArrayLike, front: float, rear: float) -> StationTable:
    """Table of values at even spacing from a front to a rear station (m)."""
    return _evenly_spread(np.asarray(values, dtype=float).tobytes(), front, rear)


@functools.lru_cache(maxsize=32)
def _evenly_spread(values: bytes, front: float, rear: float) -> StationTable:
    """Table of values (the bytes of an array) at equal distances from `front` to `rear` (m)."""
    listed = np.frombuffer(values)
    return StationTable(np.linspace(front, rear, listed.size), listed)
