"""Checked keys of a ski file, and the parts of a ski from them and from its table; a quantity in both is an error."""

from __future__ import annotations

import functools
import warnings
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError, RangeWarning
from .._support.messages import Message, template
from .._support.user_files.text_files import read_toml, shown_value
from ..parameters import InputValue, build_declared, suggest_and_list
from .assembling import ArcOutline, assembled_ski, stiffness_table, width_of_table
from .file_keys import BASE, LISTS, RIGID, SKI_KEYS, STIFFNESSES, TIP_END, WIDTHS, SkiFile
from .file_values import checked, warn_of_unusual
from .layout import BaseShape, Layout, StationFunction, layout_of_lengths
from .ski import Ski
from .table_file import StationTable

_LEAST_LENGTH_IN_WIDTHS = 2.5  # 159.3 instead of 1593 beside a width of 116 is caught, the 200 × 62 of a tool passes
_LEAST_SHARE_OF_LENGTH = 0.3  # of running and sidecut length: a tenth is another unit, a half a ski with long rocker
_SAME_LENGTH = 1e-3  # m
_SAME_MASS = 0.01  # of the mass
_TABLE_TOO_SHORT: Final = template(
    "its table reaches over {reach:.1f} mm and is shorter than the ski, length_mm {length:.1f}. Give the table "
    "from tip to tail, or correct length_mm."
)
_TABLE_TOO_LONG: Final = template(
    "its table reaches over {reach:.1f} mm and is longer than the ski, length_mm {length:.1f}. Give the table "
    "from tip to tail, or correct length_mm."
)


@dataclass(frozen=True, slots=True)
class FileValues:
    """The keys and values of one ski file.

    values: as parsed.
    said: the same values, checked, in SI.
    table: columns of its table by name; empty without one.
    """

    file: Path
    values: dict[str, Any]
    said: SkiFile
    table: dict[str, StationTable] = field(default_factory=dict)

    @property
    def table_file(self) -> Path | None:
        """Path of the table, counted from this file's folder; None without one."""
        return self.file.parent / self.said.table if self.said.table else None

    def needed(self, key: str) -> float:
        """The number in SI of a key that the file must have; ParameterError without it."""
        number: float | None = getattr(self.said, SKI_KEYS[key].field)
        if number is None:
            raise ParameterError("the key {key} is missing. Add it, in the unit that it names.").tag("missing", key=key)
        return number

    def numbers(self, key: str) -> FloatArray:
        """The list of numbers in SI of a key that the file must have; ParameterError without it."""
        numbers = getattr(self.said, SKI_KEYS[key].field)
        if numbers is None:
            raise ParameterError("the key {key} is missing. Add a list such as {key} = [100, 440, 100].").tag(
                "missing", key=key
            )
        return np.array(numbers)

    def refuse_together(self, keys: Iterable[str], other: str | Message) -> None:
        """Raise an error if one of the keys occurs together with another for the same quantity."""
        for key in keys:
            if key in self.values:
                raise ParameterError(
                    "{key} = {value} is stated together with {other} for the same quantity. Remove one of them."
                ).tag("contradiction", key=key, value=self.shown(key), other=other)

    def shown(self, key: str) -> str:
        """Text of the key's value, as in the file."""
        return shown_value(self.values[key])

    def ski(self, *, like: Ski | None = None) -> Ski:
        """Build the ski from the keys and the table of the file.

        like: a ski of nearly the same lengths, whose stations are stretched to this ski; None: own stations.
        """
        if self.table.keys() >= set(STIFFNESSES):
            self.refuse_together(["stiffness_station_mm"], Message("a table with both stiffnesses"))
        said = self.said
        layout = self._layout_from_table() if self.table else self._layout_from_keys()
        mass_per_length = self.table.get("mass_per_length_kg_per_m")
        ski = assembled_ski(
            layout,
            name=said.name or self.file.stem,
            source=said.source or f"file {self.file.name}",
            width=self._width(layout),
            base=self._base(),
            bending_stiffness=self._stiffness("EI_N_m2", layout),
            torsional_stiffness=self._stiffness("GJ_N_m2", layout),
            mass_per_length=mass_per_length.at if mass_per_length else None,
            mass=0.0 if mass_per_length else self.needed("mass_kg"),
            base_bevel=said.base_bevel,
            edge_width=said.edge_width,
            side_edge=said.side_edge,
            edge_radius=said.edge_radius,
            stations=self.table["station_m"].station if self.table else None,
            keys=None if self.table else dict(self.values),
            like=like,
        )
        # a stated mass must be the integral of the mass per length
        mass = said.mass
        if mass_per_length and mass is not None and abs(ski.mass - mass) > _SAME_MASS * mass:
            raise ParameterError(
                "mass_kg is {value}; allowed is {mass:.4g}, which the column mass_per_length_kg_per_m integrates to. "
                "Correct one of them or remove mass_kg."
            ).tag("out_of_range", value=self.shown("mass_kg"), mass=ski.mass)
        self._warn_of_lengths(ski)
        return ski

    def _width(self, layout: Layout) -> StationFunction:
        """Width along the ski: from the ski file's table, otherwise from its keys."""
        if "width_mm" in self.table:
            column = Message("the column {column}", column="width_mm")
            self.refuse_together((*WIDTHS, TIP_END), column)
            return width_of_table(self.table["width_mm"], layout)
        tip, waist, tail = (self.needed(key) for key in WIDTHS)
        for key, width in (("tip_width_mm", tip), ("tail_width_mm", tail)):
            if waist > width:
                raise ParameterError(
                    "waist_width_mm is {value}; allowed is at most {key}, {width:g}: the waist is the narrowest of the "
                    "three. Correct it or {key}."
                ).tag("out_of_range", value=self.shown("waist_width_mm"), key=key, width=width * 1e3)
        end = self.said.tip_end_width
        if end is not None and end > tip:
            raise ParameterError(
                "tip_end_width_mm is {value}; allowed is at most tip_width_mm, {width:g}. Correct one of them."
            ).tag("out_of_range", value=self.shown(TIP_END), width=tip * 1e3)
        return ArcOutline(layout=layout, tip_width=tip, waist_width=waist, tail_width=tail, end_width=end).width_at

    def _layout_from_keys(self) -> Layout:
        """Stations and lengths of the ski from the file's length keys; rejects less than 2.5 tip widths."""
        length = self.needed("length_mm")
        least = _LEAST_LENGTH_IN_WIDTHS * (self.said.tip_width or 0.0)
        if length < least:
            raise ParameterError(
                "length_mm is {value}; allowed is at least {least:.0f}, {factor:g} times the tip width. Is it in "
                "centimetres? Write it in mm."
            ).tag("out_of_range", value=self.shown("length_mm"), least=least * 1e3, factor=_LEAST_LENGTH_IN_WIDTHS)
        return layout_of_lengths(
            length=length,
            running_length=self.needed("running_length_mm"),
            sidecut_length=self.needed("sidecut_length_mm"),
            tail_overhang=self.said.tail_overhang,
            boot_position=self.said.boot_position,
        )

    def _layout_from_table(self) -> Layout:
        """Stations and lengths of the ski from its table; rejects another length in length_mm, and a tail overhang."""
        self.refuse_together(["tail_overhang_mm"], Message("a table, which reaches from tip to tail"))
        station = self.table["station_m"].station
        length, reach = self.said.length, float(station[0] - station[-1])
        if length is not None and abs(length - reach) > _SAME_LENGTH:
            problem = _TABLE_TOO_SHORT if reach < length else _TABLE_TOO_LONG
            raise ParameterError(problem).tag("contradiction", reach=reach * 1e3, length=length * 1e3)
        return Layout(
            tip=float(station[0]),
            tail=float(station[-1]),
            middle=-self.said.boot_position,
            running_length=self.needed("running_length_mm"),
            sidecut_length=self.needed("sidecut_length_mm"),
        )

    def _base(self) -> BaseShape | StationFunction:
        """Base height over the station: the table's column, or the keys' shape; rejects both together."""
        if "base_height_mm" in self.table:
            self.refuse_together(BASE, Message("the column {column}", column="base_height_mm"))
            return self.table["base_height_mm"].at
        return self.said.base

    def _stiffness(self, key: str, layout: Layout) -> StationFunction:
        """Stiffness over the station from rigid, a column or a list; rejects two of them."""
        if self.said.rigid:
            self.refuse_together(LISTS, "rigid")
            if key in self.table:
                raise ParameterError("the column {key} contradicts rigid = true. Remove one of them.").tag(
                    "contradiction", key=key
                )
            return lambda station: np.full(np.shape(station), RIGID)
        if key in self.table:
            self.refuse_together([key], Message("the column {column}", column=key))
            return self.table[key].at
        stiffness = self.numbers(key)
        station = self.numbers("stiffness_station_mm") if "stiffness_station_mm" in self.values else None
        try:
            return stiffness_table(stiffness, station, layout).at
        except ParameterError as error:
            raise ParameterError("{key} and stiffness_station_mm: {problem}").tag(
                error.code, key=key, problem=error
            ) from error

    def _warn_of_lengths(self, ski: Ski) -> None:
        """Warn if running or sidecut length is much shorter than the ski."""
        for key, length in (("running_length_mm", ski.running_length), ("sidecut_length_mm", ski.sidecut_length)):
            if length < _LEAST_SHARE_OF_LENGTH * ski.length:
                warnings.warn(
                    RangeWarning(
                        "{file}: {key} is {value:g}, the ski {length:g} mm long; usual are 0.7 to 0.95 of it. Is it "
                        "in mm?"
                    ).tag("unusual", file=self.file, key=key, value=length * 1e3, length=ski.length * 1e3),
                    stacklevel=2,
                )


def file_values(path: Path) -> FileValues:
    """Parse a ski file and check its keys."""
    return values_of_keys(read_toml(path), path)


def values_of_keys(values: dict[str, Any], path: Path) -> FileValues:
    """Check the keys of a ski file that were parsed already; `path`: the file that errors name."""
    for key in values:
        if key not in SKI_KEYS:
            raise ParameterError("{path}: the key {key} is not known. {allowed}").tag(
                "unknown_name", path=path, key=key, allowed=suggest_and_list(key, SKI_KEYS)
            )
    checked_values = {key: checked(path, value, SKI_KEYS[key]) for key, value in values.items()}
    for key, value in checked_values.items():
        if isinstance(value, tuple):
            warn_of_unusual(path, {f"{key}[{n}]": element for n, element in enumerate(value, start=1)}, SKI_KEYS[key])
        elif isinstance(value, float):
            warn_of_unusual(path, {key: value}, SKI_KEYS[key])
    of_base = tuple((key, value) for key, value in checked_values.items() if key in BASE)
    own = {SKI_KEYS[key].field: SKI_KEYS[key].in_si(value) for key, value in checked_values.items() if key not in BASE}
    return FileValues(path, values, SkiFile(**own, base=_build_base(of_base)))


@functools.lru_cache(maxsize=32)
def _build_base(values: tuple[tuple[str, InputValue], ...]) -> BaseShape:
    """Base shape from its keys and values."""
    return build_declared(BaseShape, dict(values))
