"""Readers of heights: GeoTIFF (needs ``skisnow[geotiff]``), ESRI ASCII grid, table of x, y and value."""

from __future__ import annotations

import math
import re
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final, NoReturn

import numpy as np
import numpy.typing as npt

from .._support.arrays import FloatArray
from .._support.environment import import_extra
from .._support.errors import ParameterError
from .._support.messages import Message, template
from .._support.spreadsheet_text import CsvRow, csv_rows
from .._support.user_files.text_files import is_file, plain_text
from .map_system import LENGTHS, MapSystem, length_unit, map_system, raster_errors
from .raster import PlacedValues, Raster, number_within, placed_heights, require_places, require_size


def read_geotiff(path: str | Path, *, column: str) -> PlacedValues:
    """Read the only band: x is east, y is north, in the map's coordinates (m); places are the middles of the cells.

    Heights are the band's numbers times its scale, plus its offset, in the band's unit, else in the unit of the
    vertical system, else in m.
    """
    if not is_file(path):
        raise ParameterError("{path} cannot be read: the file does not exist. Check the path.").tag(
            "cannot_read", path=path
        )
    grid = Message("Or write the heights as an ESRI ASCII grid, such as by gdal_translate -of AAIGrid.")
    rasterio: Any = import_extra(
        "rasterio", extra="geotiff", what=Message("The GeoTIFF {path}", path=path), instead=grid
    )
    try:
        with warnings.catch_warnings(action="ignore"), rasterio.open(path) as source:  # without a place: rejected below
            require_size(path, source.width, source.height)
            _require_one_band(path, source)
            heights = _heights(source)
            transform, crs = source.transform, source.crs
            system = None if crs is None else map_system(crs.to_wkt())
            unit = _height_unit(path, source.units[0], system)
    except raster_errors() as error:
        raise ParameterError("{path} cannot be read as a GeoTIFF: {error}. Export it again.").tag(
            "cannot_read", path=path, error=error
        ) from error
    _require_north_up(path, transform, system)
    raster = Raster(
        path=path,
        values=heights,
        first=(transform.c + transform.a / 2.0, transform.f + transform.e / 2.0),
        step=(transform.a, transform.e),
        height_unit=unit,
        system=system,
        where=lambda row, at: Message("row {row}, column {column}", row=row + 1, column=at + 1),
    )
    return placed_heights(raster, column=column)


def _require_one_band(path: str | Path, source: Any) -> None:
    """Reject pictures and stacks; a band that only masks the first (alpha) may be there."""
    colours = [colour.name for colour in source.colorinterp]
    bands = [colour for colour in colours if colour != "alpha"]
    if len(bands) != 1 or bands[0] == "palette" or colours[0] == "alpha":
        raise ParameterError(
            "{path} has {n_colours} bands ({colours}). Allowed: one band of heights. Fix: write the band with only "
            "the heights, such as by gdal_translate -b 1."
        ).tag("out_of_range", path=path, n_colours=len(colours), colours=list(colours))


def _heights(source: Any) -> FloatArray:
    """Numbers of the first band of a GeoTIFF, with scale and offset, in its unit; NaN where masked."""
    band = source.read(1, masked=True)
    scale, offset = float(source.scales[0]), float(source.offsets[0])
    with np.errstate(over="ignore", invalid="ignore"):  # huge values are rejected as heights
        return np.asarray(np.ma.filled(band.astype(float), np.nan) * scale + offset)


def _height_unit(path: str | Path, name: str | None, system: MapSystem | None) -> float:
    """Length (m) of one unit of the heights.

    Raises ParameterError: an unknown unit, two units, or none where x and y are in another unit than m.
    """
    vertical = None if system is None else system.height_unit
    if not (name or "").strip():
        if vertical is None and system is not None and not system.in_degrees and system.unit != 1.0:
            raise ParameterError(
                "{path}: One unit of x and y is {unit:.7g} m, and the unit of the heights is missing. Fix: state it, "
                "such as by gdal_edit -units ft, or by a line Zunits METERS in a .prj file."
            ).tag("missing", path=path, unit=system.unit)
        return 1.0 if vertical is None else vertical
    unit = length_unit(str(name))
    if unit is None:
        raise ParameterError(
            "{path}: The unit of the first band is {name!r}. Allowed: {lengths}. Fix: gdal_edit -units m."
        ).tag("out_of_range", path=path, name=name, lengths=list(LENGTHS))
    if vertical is not None and abs(unit - vertical) > 1e-4 * vertical:
        raise ParameterError(
            "{path}: The first band is in {name}, but one unit of its vertical system is {vertical:g} m. Fix: state "
            "one unit, such as by gdal_edit -units or -a_srs."
        ).tag("contradiction", path=path, name=name, vertical=vertical)
    return unit


def _require_north_up(path: str | Path, transform: Any, system: MapSystem | None) -> None:
    """Reject a raster that is turned, or that has neither a map system nor a position."""
    if transform.b != 0.0 or transform.d != 0.0:
        raise ParameterError(
            "{path}: its rows do not run east; warp it, such as by gdalwarp, to a grid that is not turned"
        ).tag("wrong_kind", path=path)
    if system is None and (transform.a, transform.c, transform.e, transform.f) == (1.0, 0.0, 1.0, 0.0):
        raise ParameterError("{path}: The position and the size of the cells are missing. Export it again.").tag(
            "missing", path=path
        )


ROUNDED: Final = 0.01
"""Share of the spacing by which a place may lie off its even place: it was written rounded."""
MOST_BYTES: Final = 1 << 28
_MOST_BYTES_OF_SYSTEM: Final = 1 << 20
_WORDS: Final = (
    "ncols", "nrows", "xllcorner", "xllcenter", "yllcorner", "yllcenter", "cellsize", "dx", "dy",
    "nodata_value", "nodata",
)  # fmt: skip
_SAME: Final = {"cellsize": ("dx", "dy"), "dx": ("cellsize",), "dy": ("cellsize",)}
"""Words that state what another one does."""
_ENTRY: Final = re.compile(r"\s*([A-Za-z_]+)[ \t]+(\S+)")


def read_esri_ascii(path: str | Path, *, column: str) -> PlacedValues:
    """Read a grid: x is east, y is north, in the file's coordinates (m); places are the middles of the cells.

    Line breaks between values do not matter. A ``.prj`` file of the same name gives the map system.
    """
    text = plain_text(path, most_bytes=MOST_BYTES)
    header, first = _header(path, text)
    for word in ("ncols", "nrows"):
        if word not in header:
            _refuse(path, Message("The header has no {word}. Is it an ESRI ASCII grid? Export it again", word=word))
    require_size(path, header["ncols"], header["nrows"])
    counts = int(header["ncols"]), int(header["nrows"])
    steps = _cell(path, header, "dx"), _cell(path, header, "dy")
    west, south = (_lower_left(path, header, axis, size) for axis, size in zip("xy", steps, strict=True))
    files = (Path(path).with_suffix(suffix) for suffix in (".prj", ".PRJ"))
    file = next(filter(is_file, files), None)
    system = None if file is None else map_system(plain_text(file, most_bytes=_MOST_BYTES_OF_SYSTEM))
    raster = Raster(
        path=path,
        values=_read_cells(path, text, first, counts, header.get("nodata_value", header.get("nodata"))),
        first=(west, south + (counts[1] - 1) * steps[1]),
        step=(steps[0], -steps[1]),
        height_unit=_height_unit(path, None, system),
        system=system,
        where=lambda row, at: _where(text, first, row * counts[0] + at),
    )
    return placed_heights(raster, column=column)


def _refuse(path: str | Path, what: Message) -> NoReturn:
    """Raise an error for a file that cannot be used; `what` is the reason."""
    raise ParameterError("{path}: {what}").tag("invalid", path=path, what=what)


def _header(path: str | Path, text: str) -> tuple[dict[str, float], int]:
    """Header of an ESRI grid: numbers by lower-case word, and the index in the text at which the values begin."""
    header: dict[str, float] = {}
    at = 0
    while (entry := _ENTRY.match(text, at)) and entry[1].lower() in _WORDS:
        word = entry[1].lower()
        for other in sorted(header.keys() & {word, *_SAME.get(word, ())}):
            line = text.count("\n", 0, entry.start(1)) + 1
            raise ParameterError("{path}, line {line}: {key} and {other} state the same. Remove one of them.").tag(
                "repeated", path=path, line=line, key=word, other=other
            )
        try:
            header[word] = float(entry[2])
        except ValueError:
            line = text.count("\n", 0, entry.start(2)) + 1
            raise ParameterError(
                "{path}, line {line}: {key} is {value!r}. Allowed: a number with a decimal point."
            ).tag("out_of_range", path=path, line=line, key=entry[1], value=entry[2]) from None
        at = entry.end()
    return header, at


def _cell(path: str | Path, header: Mapping[str, float], word: str) -> float:
    """Width of the cells in x (dx) or y (dy), or cellsize; rejects a header without it, or a width of 0 or less."""
    size = header.get(word, header.get("cellsize"))
    if size is None:
        words = template("The header has no cellsize, and no {word}. Is it an ESRI ASCII grid? Export it again")
        _refuse(path, Message(words, word=word))
    if not size > 0.0:
        stated = word if word in header else "cellsize"
        _refuse(path, Message("{word} is {size:g}. Allowed: above 0, in m", word=stated, size=size))
    return size


def _lower_left(path: str | Path, header: Mapping[str, float], axis: str, size: float) -> float:
    """Coordinate (x or y) of the middle of the lower left cell."""
    by_corner = header.get(f"{axis}llcorner", math.nan) + size / 2.0
    middle = header.get(f"{axis}llcenter", by_corner)
    if abs(by_corner - middle) > ROUNDED * size:
        words = template("{axis}llcorner and {axis}llcenter contradict each other. Remove one of them")
        _refuse(path, Message(words, axis=axis))
    if not math.isfinite(middle):
        words = template("The header has no finite {axis}llcorner and no {axis}llcenter. Add the one in m")
        _refuse(path, Message(words, axis=axis))
    return middle


def _read_cells(path: str | Path, text: str, first: int, counts: tuple[int, int], no_data: float | None) -> FloatArray:
    """Values of the cells (rows, columns), the northern row first; NaN in a hole."""
    cells = counts[0] * counts[1]
    if len(text) - first < 2 * cells - 1:  # before memory is allocated
        _refuse_number(path, len(text[first:].split()), counts)
    values = np.empty(cells)
    count = 0
    for line, words in enumerate(map(str.split, text[first:].split("\n")), start=text.count("\n", 0, first) + 1):
        if count + len(words) > cells:
            _refuse_number(path, len(text[first:].split()), counts)
        for column, word in enumerate(words, start=1):
            try:
                values[count] = float(word)
            except ValueError:
                raise ParameterError(
                    "{path}, line {line}, column {column}: {word!r} is not a number. Use digits and a decimal point."
                ).tag("not_a_number", path=path, line=line, column=column, word=word) from None
            count += 1
    if count < cells:
        _refuse_number(path, count, counts)
    if no_data is not None:
        values[values == no_data] = np.nan
    return values.reshape(counts[1], counts[0])


def _refuse_number(path: str | Path, count: int, counts: tuple[int, int]) -> NoReturn:
    """Raise an error for a file that has `count` values instead of columns × rows."""
    words = template(
        "The file has {count} values. Allowed: ncols × nrows = {columns} × {rows} = {cells}. Export it again"
    )
    columns, rows = counts
    _refuse(path, Message(words, count=count, columns=columns, rows=rows, cells=columns * rows))


def _where(text: str, first: int, cell: int) -> Message:
    """Text "line …, column …" for the value with this index in the file, counted from 0."""
    for line, words in enumerate(map(str.split, text[first:].split("\n")), start=text.count("\n", 0, first) + 1):
        if cell < len(words):
            return Message("line {line}, column {column}", line=line, column=cell + 1)
        cell -= len(words)
    raise AssertionError(cell)


SPARSE: Final = 10
"""Places for each row beyond which rows lie on no grid at all."""


def read_grid_table(path: str | Path, columns: Sequence[str], *, action: Message) -> PlacedValues:
    """Read columns over ``x_m, y_m``: rows in any order, one for each place of a grid."""
    names, rows, cells = ("x_m", "y_m", *columns), [], []
    for row in csv_rows(path, names, action=action):
        rows.append(row)
        cells.append([number_within(row, name) for name in names])
    numbers = dict(zip(names, np.array(cells, dtype=float).reshape(-1, len(names)).T, strict=True))
    x, i = _even(path, numbers["x_m"], rows, "x_m")
    y, j = _even(path, numbers["y_m"], rows, "y_m")
    _require_each_once(path, rows, (x, i), (y, j), action)
    steps = float(x[1] - x[0]), float(y[1] - y[0])
    require_places(path, (float(x[0]), float(y[0])), steps, (len(x), len(y)))
    filled = {}
    for name in columns:
        values = np.empty((len(x), len(y)))
        values[i, j] = numbers[name]
        filled[name] = values
    return PlacedValues(x, y, filled)


def _even(
    path: str | Path, places: FloatArray, rows: Sequence[CsvRow], column: str
) -> tuple[FloatArray, npt.NDArray[np.intp]]:
    """Evenly spaced places (m) of a column, and for each row the index of its place; ParameterError if uneven."""
    different = np.unique(places)
    if len(different) < 2:
        raise ParameterError("{path}, column {column}: there is only {places}; a grid needs two or more").tag(
            "out_of_range",
            path=path,
            column=column,
            places=", ".join(f"{value:g} m" for value in different) or "nothing",
        )
    step = float(np.min(np.diff(different)))
    close = np.diff(different) > ROUNDED * (different[-1] - different[0]) / len(different)
    distinct = different[np.append(True, close)]  # places that differ by rounding are one
    step = float(distinct[-1] - distinct[0]) / (len(distinct) - 1)
    number = np.rint((places - distinct[0]) / step).astype(np.intp)
    off = np.abs(places - distinct[0] - number * step)
    worst = int(np.argmax(off))
    if off[worst] > ROUNDED * step:
        raise rows[worst].refused(
            column,
            Message(
                "This is off the even places from {first:g} to {last:g} m, which are {step:.6g} m apart on average.",
                first=distinct[0],
                last=distinct[-1],
                step=step,
            ),
            code="uneven_places",
            action=Message("Interpolate onto evenly spaced places, or add the missing ones."),
        )
    return distinct[0] + step * np.arange(len(distinct)), number


def _require_each_once(
    path: str | Path,
    rows: Sequence[CsvRow],
    of_x: tuple[FloatArray, npt.NDArray[np.intp]],
    of_y: tuple[FloatArray, npt.NDArray[np.intp]],
    action: Message,
) -> None:
    """Reject a table of a grid in which a place is missing or occurs twice, or whose rows are on no grid."""
    (x, i), (y, j) = of_x, of_y
    if len(x) * len(y) > SPARSE * len(rows):
        raise ParameterError(
            "{path}: {n_rows} rows have {n_x} different x_m and {n_y} different y_m, so that they lie on no grid; "
            "interpolate onto one. {action}"
        ).tag("not_a_grid", path=path, n_rows=len(rows), n_x=len(x), n_y=len(y), action=action)
    place = i * len(y) + j
    count = np.bincount(place, minlength=len(x) * len(y))
    if np.any(count > 1):
        twice = np.flatnonzero(place == int(np.argmax(count > 1)))[:2]
        first, again = (rows[int(index)] for index in twice)
        raise ParameterError(
            "{path}, row {row}: x_m = {x_m}, y_m = {y_m} are in row {first}, too; keep one of them"
        ).tag("repeated", path=path, row=again.row, x_m=again.cells["x_m"], y_m=again.cells["y_m"], first=first.row)
    if np.any(count == 0):
        gap = int(np.argmin(count))
        raise ParameterError(
            "{path}: no row has x_m = {x:g} and y_m = {y:g}, of {n_x} places in x and {n_y} in y. {action}"
        ).tag("missing", path=path, x=x[gap // len(y)], y=y[gap % len(y)], n_x=len(x), n_y=len(y), action=action)
