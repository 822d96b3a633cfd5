"""A ski with changes: curves scaled or drawn through given values, or one parameter changed a little.

Parameters are keys of its file (`ski.…`) and factors of an edit (`edit.…`).
"""

from __future__ import annotations

import functools
import re
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.units import MM
from ..parameters import nearest
from .assembling import stiffness_table
from .file_keys import COLUMNS, LISTS, SKI_KEYS, STIFFNESSES
from .layout import Layout
from .ski_file import MADE_OF_KEYS, ski_of_keys
from .table_file import StationTable

if TYPE_CHECKING:
    from collections.abc import Mapping

    from .ski import Ski


EDITED_COLUMNS: Final = {
    "width_mm": "width",
    "base_height_mm": "base_height",
    "EI_N_m2": "bending_stiffness",
    "GJ_N_m2": "torsional_stiffness",
}
"""Columns of a ski's table that can be edited, with their names in `Ski`."""
SIDECUT: Final = "sidecut_depth"
"""Factor of how much wider than the waist the ski is: the waist's own width stays."""
MASS: Final = "mass_per_length_kg_per_m"
"""Factor of the mass."""
_LARGEST_FACTOR: Final = 100.0
_END: Final = 0.005  # m between two stations at least (modelling assumption)


@dataclass(frozen=True, slots=True, eq=False)
class SkiEdit:
    """Changes of a ski.

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
                    raise ParameterError(
                        "SkiEdit: {field} has no {column!r}. {allowed}",
                        code="unknown_name",
                        field=what,
                        column=column,
                        allowed=nearest(column, columns),
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
    """Without digits below a nanometre, so that the boot is at 0 and not a little behind it."""
    return np.asarray(np.round(station, 9) + 0.0)


def edited_ski(ski: Ski, edit: SkiEdit, *, name: str, source: str) -> Ski:
    """The ski with an edit.

    ski: to begin with; it is not changed.
    edit: factors act on the whole of a curve. That of the sidecut's depth leaves the narrowest place as wide as it is;
        the radius of the side line is divided by it. Beyond the widest places tip and tail are widened like these.
        Where a value is given the curve passes through it: width and stiffness are multiplied by the ratio of new to
        old value, to the base's height the difference is added. Between stations ratio and difference follow a
        shape-preserving cubic (`StationTable`), so that where nothing is given at two neighbouring stations nothing
        changes between them. Mass changes only by its factor.
    name, source: name of the edited ski.
    Raises ParameterError: a factor or value is not allowed, or the ski breaks a rule of `Ski`.

    >>> from skisnow.ski import ski_named
    >>> slalom = ski_named("slalom")
    >>> stiffer = edited_ski(slalom, SkiEdit(edit_stations(slalom), {"EI_N_m2": 1.2}), name="stiffer", source="1.2 EI")
    >>> round(float(stiffer.bending_stiffness.max() / slalom.bending_stiffness.max()), 9)
    1.2
    """
    _require(edit)
    changed = {attribute: _curve(ski, edit, column) for column, attribute in EDITED_COLUMNS.items()}
    height = changed["base_height"]
    changed["base_height"] = height - np.interp(0.0, ski.station[::-1], height[::-1])  # it counts from the boot
    mass = ski.mass_per_length * edit.factors.get(MASS, 1.0)
    return replace(
        ski,
        name=name,
        source=source,
        keys=None,
        mass_per_length=mass,
        width=changed["width"],
        base_height=changed["base_height"],
        base=ski.base if np.array_equal(changed["base_height"], ski.base_height) else None,
        bending_stiffness=changed["bending_stiffness"],
        torsional_stiffness=changed["torsional_stiffness"],
    )


def values_at(ski: Ski, station: FloatArray) -> dict[str, FloatArray]:
    """Values of the columns of `EDITED_COLUMNS` at stations (m), in SI. Each of shape (k,)."""
    return {
        column: np.interp(station, ski.station[::-1], np.asarray(getattr(ski, attribute))[::-1])
        for column, attribute in EDITED_COLUMNS.items()
    }


def _curve(ski: Ski, edit: SkiEdit, column: str) -> FloatArray:
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
    half = ski.sidecut_length / 2.0
    place = np.clip(ski.station, ski.sidecut_middle - half, ski.sidecut_middle + half)
    width = np.interp(place, ski.station[::-1], ski.width[::-1])
    waist = width.min()
    return np.asarray((waist + factor * (width - waist)) / width)


def _require(edit: SkiEdit) -> None:
    for column, factor in edit.factors.items():
        if not 1.0 / _LARGEST_FACTOR <= factor <= _LARGEST_FACTOR:
            raise ParameterError(
                "the factor of {column} is {factor:g}; allowed is {lowest:g} to {highest:g}. Correct it",
                code="out_of_range",
                column=column,
                factor=factor,
                lowest=1.0 / _LARGEST_FACTOR,
                highest=_LARGEST_FACTOR,
            )
    for column, values in edit.values.items():
        for station, value in zip(edit.station, values, strict=True):
            if not np.isnan(value):
                replace(COLUMNS[column], name=f"station {station:.3f} m: {column}").require(value)


FACTORS: Final = tuple(f"edit.{column}" for column in (SIDECUT, *EDITED_COLUMNS))
"""Factors of whole curves, as in `SkiEdit`; the rest of the ski is held."""
LINEAR: Final = ("tip_width_mm", "waist_width_mm", "tail_width_mm", "camber_mm", "base_bevel_deg", "edge_width_mm")
"""Keys in which the ski's tables are linear."""
_WITHOUT: Final = ("mass_kg", "side_edge_deg", "edge_radius_mm")  # no part in a carve, or no derivative
_TABLES: Final = ("station", "width", "base_height", "bending_stiffness", "torsional_stiffness")
_NUMBERS: Final = ("running_length", "base_bevel", "edge_width")
_STEP: Final = 1e-5  # relative change of one row of a list: both errors of the difference are about 1e-10
_ROW: Final = re.compile(r"(\w+)\[(\d+)\]")


@functools.lru_cache(maxsize=64)
def shape_parameters(ski: Ski) -> tuple[str, ...]:
    """Names of the parameters of a ski: numbers of its file, rows of its lists (`ski.EI_N_m2[2]`), factors."""
    numbers = []
    for key, value in (ski.keys or {}).items():
        if key in LISTS and isinstance(value, list | tuple):
            numbers += [f"ski.{key}[{row}]" for row in range(1, len(value) + 1)]
        elif isinstance(value, int | float) and not isinstance(value, bool) and key not in _WITHOUT:
            numbers += [] if key == "base_bevel_deg" and value == 0 else [f"ski.{key}"]  # it cannot fall
    default = ["ski.boot_position_mm"] if ski.keys and "boot_position_mm" not in ski.keys else []
    return (*numbers, *default, *FACTORS)


def shape_value(ski: Ski, name: str) -> float:
    """Value of a parameter, in the unit of the file; 1 of a factor.

    Raises ParameterError: the ski has no such parameter; the nearest is named.
    """
    allowed = shape_parameters(ski)
    if name not in allowed:
        if ski.keys is None and name.startswith("ski."):
            raise ParameterError(
                "{name}: the ski {ski} was not read from a file with keys only, or was changed since. Use one of "
                "{allowed}.",
                code="no_keys",
                name=name,
                ski=ski.name,
                allowed=list(FACTORS),
            )
        raise ParameterError(
            "the ski has no parameter {name}. {allowed}", code="unknown_name", name=name, allowed=nearest(name, allowed)
        )
    return 1.0 if name in FACTORS else _key_value(ski.keys or {}, name.removeprefix("ski."))


def _key_value(keys: Mapping[str, Any], place: str) -> float:
    row = _ROW.fullmatch(place)
    if row:
        return float(keys[row[1]][int(row[2]) - 1])
    return float(keys.get(place, SKI_KEYS[place].default or 0.0))


def changed_keys(keys: Mapping[str, Any], values: Mapping[str, float]) -> dict[str, Any]:
    """Keys of a ski file with other values; names as of `shape_parameters`, without their ``ski.``."""
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


def is_linear(keys: Mapping[str, Any], key: str) -> bool:
    """True if the tables of a ski are linear in a key; false for widths with a separate key for the tip's end."""
    return key in LINEAR and not (key.endswith("width_mm") and "tip_end_width_mm" in keys)


@dataclass(frozen=True, slots=True, eq=False)
class TableGrowth:
    """Growth of a ski with a parameter, SI per its unit, on rows that move with it.

    tables: of station, width, base height, EI and GJ, shape (5, rows).
    numbers: of running length, base bevel, edge width.
    """

    tables: FloatArray
    numbers: FloatArray


_LINEAR_GROWTHS: Final[dict[tuple[object, ...], TableGrowth]] = {}
_MOST_KEPT: Final = 256
_WITHOUT_EFFECT: Final = ("name", "source", "mass_kg", "EI_N_m2", "GJ_N_m2", *LINEAR)  # on growths with `LINEAR`
_LENGTH_STEP: Final = 1e-3  # mm; of other parameters a ten thousandth


@functools.lru_cache(maxsize=256)
def table_growth(ski: Ski, name: str) -> TableGrowth:
    """Growth of a ski with a parameter of `shape_parameters`, in closed form, otherwise by central differences."""
    value, key = shape_value(ski, name), name.removeprefix("ski.")
    row = _ROW.fullmatch(key)
    if name in FACTORS:
        column = name.removeprefix("edit.")
        if column == SIDECUT:
            return _of_table("width", ski.width * (_with_deeper_sidecut(ski, 2.0) - 1.0))
        return _of_table(EDITED_COLUMNS[column], np.asarray(getattr(ski, EDITED_COLUMNS[column])))
    require_own_tables(ski)
    if row and row[1] in STIFFNESSES:
        return _of_table(EDITED_COLUMNS[row[1]], _growth_with_row(ski, row[1], int(row[2]) - 1))

    def central(h: float) -> TableGrowth:
        skis = [varied_ski(ski, name, side * h) for side in (1.0, -1.0)]
        ends = [[np.array([getattr(each, field) for field in names]) for names in (_TABLES, _NUMBERS)] for each in skis]
        return TableGrowth(*((upper - lower) / (2.0 * h) for upper, lower in zip(*ends, strict=True)))

    if not is_linear(ski.keys or {}, key):
        return central(_LENGTH_STEP if name.endswith("_mm") else 1e-4 * abs(value) or _LENGTH_STEP)
    # the growth is the same for all skis of these lengths
    same = (key, *((k, str(v)) for k, v in (ski.keys or {}).items() if k not in _WITHOUT_EFFECT))
    if same not in _LINEAR_GROWTHS:
        if len(_LINEAR_GROWTHS) >= _MOST_KEPT:
            _LINEAR_GROWTHS.clear()
        _LINEAR_GROWTHS[same] = central(1e-2 * abs(value) or _LENGTH_STEP)
    return _LINEAR_GROWTHS[same]


def _of_table(table: str, growth: FloatArray) -> TableGrowth:
    tables = np.zeros((len(_TABLES), len(growth)))
    tables[_TABLES.index(table)] = growth
    return TableGrowth(tables, np.zeros(len(_NUMBERS)))


def _growth_with_row(ski: Ski, column: str, row: int) -> FloatArray:
    """Growth of a stiffness at the stations with a row of its list."""
    keys = ski.keys or {}
    listed, stations = np.array(keys[column], float), keys.get("stiffness_station_mm")
    layout = Layout(
        tip=float(ski.station[0]),
        tail=float(ski.station[-1]),
        middle=ski.sidecut_middle,
        running_length=ski.running_length,
        sidecut_length=ski.sidecut_length,
    )
    table = stiffness_table(listed, None if stations is None else np.array(stations) * MM, layout)
    # the slope of the curve changes its form where two neighbours are equal
    apart = np.abs(np.delete(listed, row)[max(0, row - 1) : row + 1] - listed[row])
    return table.growth(row, min([_STEP * listed[row], *(0.1 * apart[apart > 0.0])]), ski.station)


def varied_ski(ski: Ski, name: str, change: float) -> Ski:
    """The ski with a parameter of `shape_parameters` changed, on stations that move with it; the others are held."""
    value = shape_value(ski, name) + change
    if name in FACTORS:
        column = name.removeprefix("edit.")
        edit = SkiEdit(edit_stations(ski), {column: value})
        return edited_ski(ski, edit, name=ski.name, source=ski.source)
    require_own_tables(ski)
    return ski_of_keys(changed_keys(ski.keys or {}, {name.removeprefix("ski."): value}), like=ski)


@functools.lru_cache(maxsize=64)
def require_own_tables(ski: Ski) -> None:
    """Reject a ski whose tables were changed after it was read."""
    if ski in MADE_OF_KEYS:
        return
    own = ski_of_keys(ski.keys or {}, like=ski)
    for table in ("width", "base_height", "bending_stiffness", "torsional_stiffness"):
        if not np.allclose(getattr(own, table), getattr(ski, table), rtol=1e-9, atol=1e-12):
            raise ParameterError("the tables of the ski {ski} are not those of its keys.", code="no_keys", ski=ski.name)
