"""A ski changed by hand: whole curves scaled, and given values at some stations that the curves then pass through."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from ..parameters import nearest
from .file_keys import COLUMNS
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
    """What is changed of a ski.

    Attributes
    ----------
    station
        Places (m from the boot, falling) at which values may be given. Shape (k,).
    factors
        By column of `EDITED_COLUMNS`, for ``mass_per_length_kg_per_m``, and for `SIDECUT`; default: 1.
    values
        By column, in SI, shape (k,): the value wanted there; NaN: as it is but for the factor.
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

    Parameters
    ----------
    ski
        To begin with; it is not changed.
    edit
        Factors act on the whole of a curve. That of the sidecut's depth leaves the narrowest place as wide as it is;
        the radius of the side line is divided by it. Beyond the widest places tip and tail are widened like these.
        Where a value is given the curve passes through it: width and stiffness
        are multiplied by the ratio of new to old value, to the base's height the difference is added. Between
        stations ratio and difference follow a shape-preserving cubic (`StationTable`), so that where nothing is given
        at two neighbouring stations nothing changes between them. Mass changes only by its factor.
    name, source
        Name of the edited ski.

    Raises
    ------
    ParameterError
        A factor or value is not allowed, or the ski breaks a rule of `Ski`.

    Examples
    --------
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
    """By how much each width is to be multiplied, so that what it has over the waist is ``factor`` times as much."""
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
