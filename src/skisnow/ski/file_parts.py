"""The parts of a ski from the keys of its file and from its table; a quantity in both is an error."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Final

import numpy as np

from .._support.errors import ParameterError, RangeWarning
from .._support.messages import Message, template
from .assembling import ArcOutline, SkiParts, stiffness_table, width_of_table
from .file_keys import BASE, LISTS, RIGID, STIFFNESSES, TIP_END, WIDTHS
from .file_values import FileValues
from .layout import BaseShape, Layout, StationFunction, layout_of_lengths
from .monkeycam import monkeycam_shape
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
class FileParts:
    """Parts of a ski, read from its parsed file.

    table: the columns of its table by name, empty without one.
    """

    values: FileValues
    table: dict[str, StationTable]

    def ski(self, *, like: Ski | None = None) -> Ski:
        """Put the ski together.

        like: a ski of nearly the same lengths, whose stations are stretched to this ski; None: own stations.
        """
        values = self.values
        if self.table.keys() >= set(STIFFNESSES):
            values.refuse_together(
                ["stiffness_station_mm"], Message("a table with both stiffnesses"), Message("Remove it.")
            )
        layout, width, name = self._outline_from_shape_file() if "shape" in values else self._outline_from_ski_file()
        said = values.said
        mass_per_length = self.table.get("mass_per_length_kg_per_m")
        ski = SkiParts(
            name=said.name or name,
            source=said.source or f"file {values.file.name}",
            layout=layout,
            width=width,
            base=self._base(),
            bending_stiffness=self._stiffness("EI_N_m2", layout),
            torsional_stiffness=self._stiffness("GJ_N_m2", layout),
            mass_per_length=mass_per_length.at if mass_per_length else None,
            mass=0.0 if mass_per_length else values.needed("mass_kg"),
            base_bevel=said.base_bevel,
            edge_width=said.edge_width,
            side_edge=said.side_edge,
            edge_radius=said.edge_radius,
            stations=self.table["station_m"].station if self.table else None,
            keys=None if self.table or "shape" in values else dict(values.values),
        ).assembled(like=like)
        # a stated mass must be the integral of the mass per length
        mass = self.values.said.mass
        if mass_per_length and mass is not None and abs(ski.mass - mass) > _SAME_MASS * mass:
            allowed = Message("{mass:.4g}, which the column mass_per_length_kg_per_m integrates to", mass=ski.mass)
            self.values.refuse("mass_kg", mass, allowed, Message("Correct one of them or remove mass_kg."))
        self._warn_of_lengths(ski)
        return ski

    def _outline_from_shape_file(self) -> tuple[Layout, StationFunction, str]:
        """Tip, tail and lengths, width along the ski, and name: from a shape file of MonkeyCAM."""
        values = self.values
        outlined = ("table", "length_mm", "sidecut_length_mm", *WIDTHS, TIP_END, "tail_overhang_mm", "boot_position_mm")
        values.refuse_together(outlined, "shape", Message("Remove one of them."))
        file = values.beside("shape") or values.file
        name, outline = monkeycam_shape(file, running_length=values.said.running_length)
        return outline.layout, outline.width_at, name

    def _outline_from_ski_file(self) -> tuple[Layout, StationFunction, str]:
        """Tip, tail and lengths, width along the ski, and name: from the ski file's table, otherwise from its keys."""
        values = self.values
        layout = self._lengths_from_table() if self.table else self._lengths_from_keys()
        if "width_mm" in self.table:
            column = Message("the column {column}", column="width_mm")
            values.refuse_together((*WIDTHS, TIP_END), column, Message("Remove one of them."))
            return layout, width_of_table(self.table["width_mm"], layout), values.file.stem
        tip, waist, tail = (values.needed(key) for key in WIDTHS)
        for key, width in (("tip_width_mm", tip), ("tail_width_mm", tail)):
            if waist > width:
                allowed = Message(
                    "at most {key}, {width:g}: the waist is the narrowest of the three", key=key, width=width * 1e3
                )
                action = Message("Correct it or {key}.", key=key)
                values.refuse("waist_width_mm", values.values["waist_width_mm"], allowed, action)
        end = values.said.tip_end_width
        if end is not None and end > tip:
            allowed = Message("at most tip_width_mm, {width:g}", width=tip * 1e3)
            values.refuse(TIP_END, values.values[TIP_END], allowed, Message("Correct one of them."))
        outline = ArcOutline(layout=layout, tip_width=tip, waist_width=waist, tail_width=tail, end_width=end)
        return layout, outline.width_at, values.file.stem

    def _lengths_from_keys(self) -> Layout:
        values = self.values
        length = values.needed("length_mm")
        least = _LEAST_LENGTH_IN_WIDTHS * (values.said.tip_width or 0.0)
        if length < least:
            allowed = Message(
                "at least {least:.0f}, {factor:g} times the tip width",
                least=least * 1e3,
                factor=_LEAST_LENGTH_IN_WIDTHS,
            )
            action = Message("Is it in centimetres? Write it in mm.")
            values.refuse("length_mm", values.values["length_mm"], allowed, action)
        return layout_of_lengths(
            length=length,
            running_length=values.needed("running_length_mm"),
            sidecut_length=values.needed("sidecut_length_mm"),
            tail_overhang=values.said.tail_overhang,
            boot_position=values.said.boot_position,
        )

    def _lengths_from_table(self) -> Layout:
        values = self.values
        values.refuse_together(
            ["tail_overhang_mm"], Message("a table, which reaches from tip to tail"), Message("Remove it.")
        )
        station = self.table["station_m"].station
        length, reach = values.said.length, float(station[0] - station[-1])
        if length is not None and abs(length - reach) > _SAME_LENGTH:
            problem = _TABLE_TOO_SHORT if reach < length else _TABLE_TOO_LONG
            raise ParameterError(problem).tag("contradiction", reach=reach * 1e3, length=length * 1e3)
        return Layout(
            tip=float(station[0]),
            tail=float(station[-1]),
            middle=-values.said.boot_position,
            running_length=values.needed("running_length_mm"),
            sidecut_length=values.needed("sidecut_length_mm"),
        )

    def _base(self) -> BaseShape | StationFunction:
        values = self.values
        if "base_height_mm" in self.table:
            values.refuse_together(
                BASE, Message("the column {column}", column="base_height_mm"), Message("Remove one of them.")
            )
            return self.table["base_height_mm"].at
        return values.said.base

    def _stiffness(self, key: str, layout: Layout) -> StationFunction:
        values = self.values
        if values.said.rigid:
            values.refuse_together(LISTS, "rigid", Message("Remove one of them."))
            if key in self.table:
                raise ParameterError("the column {key} contradicts rigid = true. Remove one of them.").tag(
                    "contradiction", key=key
                )
            return lambda station: np.full(np.shape(station), RIGID)
        if key in self.table:
            values.refuse_together([key], Message("the column {column}", column=key), Message("Remove one of them."))
            return self.table[key].at
        stiffness = values.numbers(key)
        station = values.numbers("stiffness_station_mm") if "stiffness_station_mm" in values else None
        try:
            return stiffness_table(stiffness, station, layout).at
        except ParameterError as error:
            raise ParameterError("{key} and stiffness_station_mm: {problem}").tag(
                error.code, key=key, problem=error
            ) from error

    def _warn_of_lengths(self, ski: Ski) -> None:
        for key, length in (("running_length_mm", ski.running_length), ("sidecut_length_mm", ski.sidecut_length)):
            if length < _LEAST_SHARE_OF_LENGTH * ski.length:
                warnings.warn(
                    RangeWarning(
                        "{file}: {key} is {value:g}, the ski {length:g} mm long; usual are 0.7 to 0.95 of it. Is it "
                        "in mm?"
                    ).tag("unusual", file=self.values.file, key=key, value=length * 1e3, length=ski.length * 1e3),
                    stacklevel=2,
                )
