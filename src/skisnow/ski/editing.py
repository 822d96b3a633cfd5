"""A ski with changes: curves scaled or drawn through given values, or one parameter changed a little.

Parameters are keys of its file (`ski.…`) and factors of an edit (`edit.…`).
"""

from __future__ import annotations

import functools
import re
from collections.abc import Hashable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.units import MM
from ..parameters import suggest_and_list
from .assembling import ArcOutline, moved_stations, stiffness_table
from .file_keys import BASE, COLUMNS, LISTS, RIGID, SKI_KEYS, STIFFNESSES, TIP_END, WIDTHS, SkiFile
from .layout import Layout, layout_of_lengths
from .ski import Ski
from .ski_file import MADE_OF_KEYS, ski_of_keys
from .table_file import StationTable

EDITED_COLUMNS: Final = {name: COLUMNS[name].field for name in ("width_mm", "base_height_mm", *STIFFNESSES)}
"""Columns of a ski's table that can be edited, with their names in `Ski`."""
SIDECUT: Final = "sidecut_depth"
"""Factor of how much wider than the waist the ski is: the waist's own width stays."""
MASS: Final = "mass_per_length_kg_per_m"
"""Factor of the mass."""
_LARGEST_FACTOR: Final = 100.0
_END: Final = 0.005  # m between two stations at least (modelling assumption)


@dataclass(frozen=True, slots=True, eq=False)
class SkiEdit:
    """Changes of a ski: factors of whole curves, and values of curves at stations.

    station: places (m from the boot, falling) at which values may be given. Shape (k,).
    factors: by column of `EDITED_COLUMNS`, for ``mass_per_length_kg_per_m``, and for `SIDECUT`; default: 1.
    values: by column, in SI, shape (k,): the value wanted there; NaN: as it is but for the factor.
    """

    station: FloatArray
    factors: Mapping[str, float] = field(default_factory=dict)
    values: Mapping[str, FloatArray] = field(default_factory=dict)

    def __post_init__(self) -> None:
        factors = (*EDITED_COLUMNS, MASS, SIDECUT)
        for what, edits, columns in (("factors", self.factors, factors), ("values", self.values, (*EDITED_COLUMNS,))):
            for column in edits:
                if column not in columns:
                    raise ParameterError("SkiEdit: {field} has no {column!r}. {allowed}").tag(
                        "unknown_name", field=what, column=column, allowed=suggest_and_list(column, columns)
                    )


def edit_stations(ski: Ski, *, count: int = 9) -> FloatArray:
    """Places for an edit (m): tip and tail, and between them evenly over the sidecut length. Shape (count,).

    Where the sidecut reaches to tip or tail, as on a piece of ski, they are spread evenly over all of it.
    """
    half = ski.sidecut_length / 2.0
    if ski.sidecut_middle + half > ski.station[0] - _END or ski.sidecut_middle - half < ski.station[-1] + _END:
        return _plain(np.linspace(ski.station[0], ski.station[-1], count))
    inner = np.linspace(ski.sidecut_middle + half, ski.sidecut_middle - half, count - 2)
    return _plain(np.concatenate([ski.station[:1], inner, ski.station[-1:]]))


def _plain(station: FloatArray) -> FloatArray:
    """Stations rounded to a nanometre, so that the boot is at exactly 0."""
    return np.asarray(np.round(station, 9) + 0.0)


def edited_ski(ski: Ski, edit: SkiEdit, *, name: str, source: str) -> Ski:
    """Copy of a ski with an edit applied.

    ski: to begin with; it is not changed.
    edit: factors act on the whole of a curve. That of the sidecut's depth leaves the narrowest place as wide as it is;
        the radius of the side line is divided by it. Beyond the widest places tip and tail are widened like these.
        Where a value is given the curve passes through it: width and stiffness are multiplied by the ratio of new to
        old value, to the base's height the difference is added. Between stations ratio and difference follow a
        shape-preserving cubic (`StationTable`), so that where nothing is given at two neighbouring stations nothing
        changes between them. Mass changes only by its factor.

    >>> from skisnow.ski import ski_named
    >>> slalom = ski_named("slalom")
    >>> stiffer = edited_ski(slalom, SkiEdit(edit_stations(slalom), {"EI_N_m2": 1.2}), name="stiffer", source="1.2 EI")
    >>> round(float(stiffer.bending_stiffness.max() / slalom.bending_stiffness.max()), 9)
    1.2
    """
    for column, factor in edit.factors.items():
        if not 1.0 / _LARGEST_FACTOR <= factor <= _LARGEST_FACTOR:
            raise ParameterError(
                "the factor of {column} is {factor:g}; allowed is {lowest:g} to {highest:g}. Correct it"
            ).tag("out_of_range", column=column, factor=factor, lowest=1.0 / _LARGEST_FACTOR, highest=_LARGEST_FACTOR)
    for column, values in edit.values.items():
        for station, value in zip(edit.station, values, strict=True):
            if not np.isnan(value):  # NaN: no change
                replace(COLUMNS[column], name=f"station {station:.3f} m: {column}").require(value)
    changed: dict[str, Any] = {
        attribute: _edited_curve(ski, edit, column) for column, attribute in EDITED_COLUMNS.items()
    }
    height = changed["base_height"]
    changed["base_height"] = height - np.interp(0.0, ski.station[::-1], height[::-1])  # it counts from the boot
    mass = ski.mass_per_length * edit.factors.get(MASS, 1.0)
    base = ski.base if np.array_equal(changed["base_height"], ski.base_height) else None
    return replace(ski, name=name, source=source, keys=None, mass_per_length=mass, base=base, **changed)


def values_at(ski: Ski, station: FloatArray) -> dict[str, FloatArray]:
    """Values of the columns of `EDITED_COLUMNS` at stations (m), in SI. Each of shape (k,)."""
    return {
        column: np.interp(station, ski.station[::-1], np.asarray(getattr(ski, attribute))[::-1])
        for column, attribute in EDITED_COLUMNS.items()
    }


def _edited_curve(ski: Ski, edit: SkiEdit, column: str) -> FloatArray:
    """Column of a ski after an edit: multiplied by a factor, then changed to given values at stations."""
    factor = edit.factors.get(column, 1.0)
    curve = factor * np.asarray(getattr(ski, EDITED_COLUMNS[column]))
    if column == "width_mm" and (deeper := edit.factors.get(SIDECUT, 1.0)) != 1.0:
        curve = curve * _with_deeper_sidecut(ski, deeper)
    if column not in edit.values:
        return curve
    before = np.interp(edit.station, ski.station[::-1], curve[::-1])
    wanted = np.where(np.isnan(edit.values[column]), before, edit.values[column])
    if column == "base_height_mm":
        return np.asarray(curve + StationTable(edit.station, wanted - before).at(ski.station))
    return np.asarray(curve * StationTable(edit.station, wanted / before).at(ski.station))


def _with_deeper_sidecut(ski: Ski, factor: float) -> FloatArray:
    """Factors of the widths that multiply their excess over the waist by ``factor``."""
    (front, rear), (at_front, _, at_rear) = ski.sidecut_ends, ski.sidecut_widths
    width = np.where(ski.station > front, at_front, np.where(ski.station < rear, at_rear, ski.width))
    waist = width.min()
    return np.asarray((waist + factor * (width - waist)) / width)


FACTORS: Final = tuple(f"edit.{column}" for column in (SIDECUT, *EDITED_COLUMNS))
"""Factors of whole curves, as in `SkiEdit`; the rest of the ski is held."""
LINEAR: Final = ("tip_width_mm", "waist_width_mm", "tail_width_mm", "camber_mm", "base_bevel_deg", "edge_width_mm")
"""Keys in which the ski's tables are linear."""
VALUES: Final = tuple(f"edit.{column}[{row}]" for column in EDITED_COLUMNS for row in range(1, 10))
"""Values of curves at the `edit_stations`, in the units of their names; other values and curves are held."""
_WITHOUT: Final = ("mass_kg",)  # no part in a carve
_NO_FALL: Final = ("base_bevel_deg", "edge_radius_mm")  # no derivative at 0
_TABLES: Final = ("station", "width", "base_height", "bending_stiffness", "torsional_stiffness")
_NUMBERS: Final = ("running_length", "base_bevel", "edge_width", "side_edge", "edge_radius")
_ROW: Final = re.compile(r"(?:edit\.)?(\w+)\[(\d+)\]")


@functools.lru_cache(maxsize=64)
def shape_parameters(ski: Ski) -> tuple[str, ...]:
    """Names of the parameters of a ski: numbers of its file, rows of its lists (`ski.EI_N_m2[2]`), factors."""
    numbers = []
    for key, value in (ski.keys or {}).items():
        if key in LISTS and isinstance(value, list | tuple):
            numbers += [f"ski.{key}[{row}]" for row in range(1, len(value) + 1)]
        elif isinstance(value, int | float) and not isinstance(value, bool) and key not in _WITHOUT:
            numbers += [] if key in _NO_FALL and value == 0 else [f"ski.{key}"]
    default = ["ski.boot_position_mm"] if ski.keys and "boot_position_mm" not in ski.keys else []
    return (*numbers, *default, *FACTORS)


def shape_value(ski: Ski, name: str) -> float:
    """Value of a parameter, in the unit of the file; 1 of a factor."""
    if name in VALUES:
        column, row = _column_and_row(name)
        return float(values_at(ski, edit_stations(ski))[column][row]) / COLUMNS[column].factor
    allowed = shape_parameters(ski)
    if name not in allowed:
        if ski.keys is None and name.startswith("ski."):
            raise ParameterError(
                "{name}: the ski {ski} was not read from a file with keys only, or was changed since. Use one of "
                "{allowed}."
            ).tag("no_keys", name=name, ski=ski.name, allowed=list(FACTORS))
        raise ParameterError("the ski has no parameter {name}. {allowed}").tag(
            "unknown_name", name=name, allowed=suggest_and_list(name, allowed)
        )
    return 1.0 if name in FACTORS else key_value(ski.keys or {}, name.removeprefix("ski."))


def _column_and_row(name: str) -> tuple[str, int]:
    """Column and row, from 0, of a name of `VALUES`."""
    row = _ROW.fullmatch(name)
    assert row is not None
    return row[1], int(row[2]) - 1


def key_value(keys: Mapping[str, Any], place: str) -> float:
    """Number of a key of a ski file, or of a row of a list; a missing key has its default."""
    row = _ROW.fullmatch(place)
    if row:
        return float(keys[row[1]][int(row[2]) - 1])
    return float(keys.get(place, SKI_KEYS[place].default or 0.0))


def changed_keys(keys: Mapping[str, Any], values: Mapping[str, float]) -> dict[str, Any]:
    """Copy of a ski file's keys with other values; a name such as ``EI_N_m2[3]`` is an entry of a list."""
    out = dict(keys)
    for place, value in values.items():
        row = _ROW.fullmatch(place)
        if row:
            rows = list(out[row[1]])
            rows[int(row[2]) - 1] = value
            out[row[1]] = rows
        else:
            out[place] = value
    return out


@dataclass(frozen=True, slots=True, eq=False)
class TableGrowth:
    """Derivatives of a ski by a parameter, SI per its unit, on rows that move with it.

    tables: of station, width, base height, EI and GJ, shape (5, rows).
    numbers: of running length, base bevel, edge width, angle of the side, radius of the edge.
    """

    tables: FloatArray
    numbers: FloatArray


_PARTS: Final = ("width", "base_height", *STIFFNESSES)
_LENGTHS: Final = ("length_mm", "running_length_mm", "sidecut_length_mm", "tail_overhang_mm", "boot_position_mm")
_OF_NUMBERS: Final = ("running_length_mm", "base_bevel_deg", "edge_width_mm", "side_edge_deg", "edge_radius_mm")
"""Keys of `_NUMBERS`."""
_LENGTH_STEP: Final = 1e-3  # mm; of other keys a ten thousandth


@functools.lru_cache(maxsize=256)
def table_growth(ski: Ski, name: str) -> TableGrowth:
    """Derivatives of a ski by a parameter of `shape_parameters`, of lengths and heights by central differences."""
    if name in (*FACTORS, *VALUES):
        return _of_edit(ski, name.removeprefix("edit."))
    memos, table = _growth_caches(ski), _table_of(name)
    memo = memos.get(table, {})
    if name in memo:
        return memo[name]
    value, key, parsed = shape_value(ski, name), name.removeprefix("ski."), parsed_keys(ski)
    step = _LENGTH_STEP if key.endswith("_mm") else 1e-4 * abs(value) or _LENGTH_STEP
    if table in STIFFNESSES:
        rows = _stiffness_table(parsed, table, _layout_of(parsed)).growths(ski.station)
        memo |= {
            f"ski.{table}[{row}]": _growth_of_table(EDITED_COLUMNS[table], of) for row, of in enumerate(rows, start=1)
        }
    elif table == "base_height":
        memo[name] = _growth_of_table(table, _part_growth(parsed, key, step, table, ski.station)[1])
    elif table == "width" and parsed.tip_end_width is None:
        units = MM * _unit_widths(parsed, _layout_of(parsed), ski.station)
        memo |= {f"ski.{width}": _growth_of_table(table, unit) for width, unit in zip(WIDTHS, units, strict=True)}
    elif table == "width":
        sides = (_with_changed_key(parsed, key, side * step * MM) for side in (1.0, -1.0))
        ends = [_outline_of(side, _layout_of(side)).width_at(ski.station) for side in sides]
        return _growth_of_table(table, (ends[0] - ends[1]) / (2.0 * step))
    else:
        return _of_several(ski, name, step)
    return memo[name]


@functools.lru_cache(maxsize=64)
def table_growths(ski: Ski, names: tuple[str, ...]) -> tuple[FloatArray, FloatArray]:
    """Derivatives of the tables (n, 5, rows) and of the numbers (n, 5) of a ski by n parameters."""
    growths = [table_growth(ski, name) for name in names]
    return np.array([growth.tables for growth in growths]), np.array([growth.numbers for growth in growths])


def _of_edit(ski: Ski, name: str) -> TableGrowth:
    """Derivatives of a ski's tables by a factor, or by the value of a curve at one of the `edit_stations`."""
    if name == SIDECUT:
        return _growth_of_table("width", ski.width * (_with_deeper_sidecut(ski, 2.0) - 1.0))
    if name in EDITED_COLUMNS:
        return _growth_of_table(EDITED_COLUMNS[name], np.asarray(getattr(ski, EDITED_COLUMNS[name])))
    column, row = _column_and_row(name)
    stations, unit = edit_stations(ski), COLUMNS[column].factor
    share, table = StationTable(stations, np.eye(len(stations))[row]).at(ski.station), EDITED_COLUMNS[column]
    if column == "base_height_mm":
        return _growth_of_table(table, unit * (share - np.interp(0.0, ski.station[::-1], share[::-1])))
    return _growth_of_table(
        table, unit * share * np.asarray(getattr(ski, table)) / values_at(ski, stations)[column][row]
    )


def _of_several(ski: Ski, name: str, step: float) -> TableGrowth:
    """Derivatives of a ski by a key that changes several tables, or numbers; `step` of the differences."""
    parsed, memos, key = parsed_keys(ski), _growth_caches(ski), name.removeprefix("ski.")
    tables, numbers = np.zeros((len(_TABLES), len(ski.station))), np.zeros(len(_NUMBERS))
    if key in _OF_NUMBERS:
        numbers[_OF_NUMBERS.index(key)] = SKI_KEYS[key].factor
    parts = _PARTS if key in _LENGTHS else STIFFNESSES if _ROW.fullmatch(key) else ()
    for part in parts:
        memo = memos[part]
        if name not in memo:
            memo[name] = _part_growth(parsed, key, step, part, ski.station)
        grown = memo[name]
        tables[0] = grown[0]
        widths = parsed.tip_width, parsed.waist_width, parsed.tail_width
        tables[1 + _PARTS.index(part)] = np.array(widths, float) @ grown[1:] if part == "width" else grown[1]
    return TableGrowth(tables, numbers)


@functools.lru_cache(maxsize=256)
def _table_of(name: str) -> str:
    """Name of the only table that a parameter changes; empty if it changes several tables, or numbers."""
    key, _, row = name.removeprefix("ski.").partition("[")
    if row:
        return key if key in STIFFNESSES else ""
    return "base_height" if key in BASE else "width" if key in (*WIDTHS, TIP_END) else ""


@functools.lru_cache(maxsize=64)
def _growth_caches(ski: Ski) -> dict[str, dict[str, Any]]:
    """Caches of derivatives by table, shared by all skis with the same keys and stations of that table."""
    if ski.keys is None:
        return {}
    keys = parsed_keys(ski)
    place = (ski.station.tobytes(), *(getattr(keys, SKI_KEYS[key].field) for key in _LENGTHS))
    return {
        "width": _growth_cache(*place, _tip_end_ratio(keys)),
        "base_height": _growth_cache(*place, keys.base),
        "EI_N_m2": _growth_cache(*place, keys.stiffness_station, keys.bending_stiffness, "EI"),
        "GJ_N_m2": _growth_cache(*place, keys.stiffness_station, keys.torsional_stiffness, "GJ"),
    }


@functools.lru_cache(maxsize=64)
def _growth_cache(*_keys: Hashable) -> dict[str, Any]:
    """An empty cache, the same one for equal keys."""
    return {}


def _tip_end_ratio(keys: SkiFile) -> float | None:
    """Width at the front end of the ski over the width of the tip."""
    return None if keys.tip_end_width is None else keys.tip_end_width / (keys.tip_width or 1.0)


def _growth_of_table(table: str, growth: FloatArray) -> TableGrowth:
    """Derivatives of a ski of which a parameter changes only one table."""
    tables = np.zeros((len(_TABLES), len(growth)))
    tables[_TABLES.index(table)] = growth
    return TableGrowth(tables, np.zeros(len(_NUMBERS)))


def _layout_of(keys: SkiFile) -> Layout:
    """Stations and lengths (m) from a ski's keys; a missing length counts as 0."""
    return layout_of_lengths(
        length=keys.length or 0.0,
        running_length=keys.running_length or 0.0,
        sidecut_length=keys.sidecut_length or 0.0,
        tail_overhang=keys.tail_overhang,
        boot_position=keys.boot_position,
    )


def _outline_of(keys: SkiFile, layout: Layout) -> ArcOutline:
    """Outline through tip, waist and tail width (m) of a ski's keys."""
    tip, waist, tail = (width or 0.0 for width in (keys.tip_width, keys.waist_width, keys.tail_width))
    return ArcOutline(layout=layout, tip_width=tip, waist_width=waist, tail_width=tail, end_width=keys.tip_end_width)


def _unit_widths(keys: SkiFile, layout: Layout, station: FloatArray) -> FloatArray:
    """Factors (3, n) of the widths of tip, waist and tail, whose sum is the width at stations (m)."""
    pairs = ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0))
    relative = replace(keys, tip_width=1.0, tip_end_width=_tip_end_ratio(keys))
    skis = [replace(relative, waist_width=waist, tail_width=tail) for waist, tail in pairs]
    tip, *others = (_outline_of(ski, layout).width_at(station) for ski in skis)
    return np.array([tip, *(other - tip for other in others)])


def _stiffness_table(keys: SkiFile, part: str, layout: Layout) -> StationTable:
    """Stiffness along the ski from the keys; rigid if they list none."""
    listed = getattr(keys, SKI_KEYS[part].field)
    return stiffness_table(RIGID if listed is None else listed, keys.stiffness_station, layout)


def _with_changed_key(keys: SkiFile, key: str, change: float) -> SkiFile:
    """Copy of the keys with one value changed by ``change`` (SI)."""
    row, owner = _ROW.fullmatch(key), keys.base if key in BASE else keys
    name = SKI_KEYS[row[1] if row else key].field
    value: Any = getattr(owner, name)
    if row:
        changed: Any = tuple(place + change * (n == int(row[2])) for n, place in enumerate(value, start=1))
    else:
        changed = value + change
    return (
        replace(keys, base=replace(keys.base, **{name: changed})) if key in BASE else replace(keys, **{name: changed})
    )


def _part_growth(keys: SkiFile, key: str, step: float, part: str, station: FloatArray) -> FloatArray:
    """Derivatives of stations and table `part` (or the three unit widths) by a key, by central differences."""
    home, ends = _layout_of(keys), []
    for change in (step, -step):
        side = _with_changed_key(keys, key, change * SKI_KEYS[key.partition("[")[0]].factor)
        layout = _layout_of(side)
        at = moved_stations(station, home, layout)
        if part == "width":
            ends.append(np.vstack([at, _unit_widths(side, layout, at)]))
        elif part == "base_height":
            ends.append(np.vstack([at, side.base.height_at(at, layout)]))
        else:
            ends.append(np.vstack([at, _stiffness_table(side, part, layout).at(at)]))
    return np.asarray((ends[0] - ends[1]) / (2.0 * step))


def varied_ski(ski: Ski, name: str, change: float) -> Ski:
    """The ski with a parameter of `shape_parameters` changed, on stations that move with it; the others are held."""
    value = shape_value(ski, name) + change
    if name in FACTORS:
        column = name.removeprefix("edit.")
        edit = SkiEdit(edit_stations(ski), {column: value})
        return edited_ski(ski, edit, name=ski.name, source=ski.source)
    if name in VALUES:
        (column, row), stations = _column_and_row(name), edit_stations(ski)
        values = np.full(len(stations), np.nan)
        values[row] = value * COLUMNS[column].factor
        return edited_ski(ski, SkiEdit(stations, values={column: values}), name=ski.name, source=ski.source)
    parsed_keys(ski)
    return ski_of_keys(changed_keys(ski.keys or {}, {name.removeprefix("ski."): value}), like=ski)


@functools.lru_cache(maxsize=64)
def parsed_keys(ski: Ski) -> SkiFile:
    """Keys of a ski in SI; rejects a ski without keys, or with tables that differ from its keys."""
    if ski in MADE_OF_KEYS:
        return MADE_OF_KEYS[ski]
    own = ski_of_keys(ski.keys or {}, like=ski)
    for table in ("width", "base_height", "bending_stiffness", "torsional_stiffness"):
        if not np.allclose(getattr(own, table), getattr(ski, table), rtol=1e-9, atol=1e-12):
            raise ParameterError("the tables of the ski {ski} are not those of its keys.").tag("no_keys", ski=ski.name)
    return MADE_OF_KEYS[own]
