"""A ski with one of its parameters changed a little: keys of its file (`ski.…`) and factors of an edit (`edit.…`)."""

from __future__ import annotations

import functools
import re
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.units import MM
from ..parameters import nearest
from .assembling import stiffness_table
from .editing import EDITED_COLUMNS, SIDECUT, SkiEdit, edit_stations, edited_ski
from .file_keys import LISTS, SKI_KEYS, STIFFNESSES
from .layout import Layout
from .ski_file import ski_of_keys

if TYPE_CHECKING:
    from collections.abc import Mapping

    from .ski import Ski


FACTORS: Final = tuple(f"edit.{column}" for column in (SIDECUT, *EDITED_COLUMNS))
"""Factors of whole curves, as in `SkiEdit`; the rest of the ski is held."""
LINEAR: Final = ("tip_width_mm", "waist_width_mm", "tail_width_mm", "camber_mm", "base_bevel_deg", "edge_width_mm")
"""Keys in which the ski's tables are linear."""
_WITHOUT: Final = ("mass_kg", "side_edge_deg", "edge_radius_mm")  # no part in a carve, or no derivative
_STEP: Final = 1e-3  # relative change of one row of a list
_ROW: Final = re.compile(r"(\w+)\[(\d+)\]")


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

    Raises
    ------
    ParameterError
        The ski has no such parameter; the nearest is named.
    """
    known = shape_parameters(ski)
    if name not in known:
        if ski.keys is None and name.startswith("ski."):
            raise ParameterError(
                "{name}: the ski {ski} was not read from a file of keys alone, or was changed since. Take one of "
                "{allowed}.",
                code="no_keys",
                name=name,
                ski=ski.name,
                allowed=list(FACTORS),
            )
        raise ParameterError(
            "the ski has no parameter {name}. {allowed}", code="unknown_name", name=name, allowed=nearest(name, known)
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
    """Whether the tables of a ski are linear in a key: not in the widths where the tip's end has its own."""
    return key in LINEAR and not (key.endswith("width_mm") and "tip_end_width_mm" in keys)


def stiffness_growth(ski: Ski, name: str) -> tuple[str, FloatArray] | None:
    """Growth of EI or GJ (name in `Ski`) at the stations with a parameter; None of one that changes more than that."""
    row = _ROW.fullmatch(name.removeprefix("ski."))
    column = row[1] if row else name.removeprefix("edit.")
    if column not in STIFFNESSES or not (row or name in FACTORS):
        return None
    if row is None:
        return EDITED_COLUMNS[column], np.asarray(getattr(ski, EDITED_COLUMNS[column]))
    require_own_tables(ski)
    keys, place = ski.keys or {}, int(row[2]) - 1
    listed = np.array(keys[column], float)
    stations = keys.get("stiffness_station_mm")
    where = None if stations is None else np.array(stations) * MM
    layout = Layout(
        tip=float(ski.station[0]),
        tail=float(ski.station[-1]),
        middle=ski.sidecut_middle,
        running_length=ski.running_length,
        sidecut_length=ski.sidecut_length,
    )

    def central(h: float) -> FloatArray:
        ends = [stiffness_table(listed + side * h * np.eye(len(listed))[place], where, layout) for side in (1.0, -1.0)]
        return np.asarray((ends[0].at(ski.station) - ends[1].at(ski.station)) / (2.0 * h))

    h = _STEP * listed[place]
    return EDITED_COLUMNS[column], (4.0 * central(h / 2.0) - central(h)) / 3.0


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
    own = ski_of_keys(ski.keys or {}, like=ski)
    for table in ("width", "base_height", "bending_stiffness", "torsional_stiffness"):
        if not np.allclose(getattr(own, table), getattr(ski, table), rtol=1e-9, atol=1e-12):
            raise ParameterError("the tables of the ski {ski} are not those of its keys.", code="no_keys", ski=ski.name)
