"""What stands in the fields of the ski editor, and the ski that comes of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

import numpy as np

from ..ski.editing import EDITED_COLUMNS, SIDECUT, SkiEdit, edit_stations, edited_ski, values_at
from ..ski.file_keys import COLUMNS
from .lab_skis import ski_of_texts
from .typed import typed_number

if TYPE_CHECKING:
    from ..ski import Ski

FACTORS: Final = {
    SIDECUT: "Sidecut depth",
    "width_mm": "Width",
    "base_height_mm": "Base height",
    "EI_N_m2": "EI",
    "GJ_N_m2": "GJ",
    "mass_per_length_kg_per_m": "Mass",
}
"""Curves that can be scaled, in words."""
CELLS: Final = {
    "width_mm": "Width (mm)",
    "base_height_mm": "Base height (mm)",
    "EI_N_m2": "EI (N m²)",
    "GJ_N_m2": "GJ (N m²)",
}
"""Curves that can be given at stations, in words with their units."""


@dataclass(frozen=True, slots=True)
class SkiAsked:
    """The file and its table as texts, factors by column, values by column and number of the station, all as typed."""

    text: str
    table: str = ""
    factors: Mapping[str, str] = field(default_factory=dict)
    cells: Mapping[tuple[str, int], str] = field(default_factory=dict)

    @property
    def is_file(self) -> bool:
        """Whether nothing but the file says what the ski is."""
        return not self.cells and all(typed_number(FACTORS[key], text) == 1.0 for key, text in self.factors.items())


@dataclass(frozen=True, slots=True)
class SkiFound:
    """The ski, what its reader warned of, where it can be edited (m), and what its columns are there, as texts."""

    ski: Ski
    warned: str
    station: tuple[float, ...]
    cells: Mapping[tuple[str, int], str]


def ski_found(asked: SkiAsked, *, name: str = "") -> SkiFound:
    """The edited ski; a name where it is to have another one.

    Raises
    ------
    ParameterError
        A field holds no number or one that is not allowed, or the file is none.
    """
    ski, warned = ski_of_texts(asked.text, asked.table)
    station = edit_stations(ski)
    factors = {key: typed_number(f"the factor of {FACTORS[key]}", text) for key, text in asked.factors.items()}
    wanted = {column: np.full(station.size, np.nan) for column in EDITED_COLUMNS}
    for (column, i), text in asked.cells.items():
        wanted[column][i] = typed_number(f"{CELLS[column]} at {station[i]:.3f} m", text) * COLUMNS[column].factor
    source = ski.source if asked.is_file else f"edited in the lab ({_in_words(asked, station)}) from: {ski.source}"
    own = ski.name if asked.is_file else f"{ski.name}, edited"
    edited = edited_ski(ski, SkiEdit(station, factors, wanted), name=name or own, source=source)
    shown = values_at(edited, station)
    cells = {
        (column, i): f"{round(values[i] / COLUMNS[column].factor, 6) + 0.0:.4g}"
        for column, values in shown.items()
        for i in range(station.size)
    }
    return SkiFound(edited, warned, tuple(station.tolist()), {**cells, **asked.cells})


def _in_words(asked: SkiAsked, station: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> str:
    scaled = [f"{FACTORS[key]} × {text}" for key, text in asked.factors.items() if typed_number(key, text) != 1.0]
    given = [f"{CELLS[column]} {text} at {station[i]:.3f} m" for (column, i), text in asked.cells.items()]
    return "; ".join([*scaled, *given])
