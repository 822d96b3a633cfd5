"""Editor of a ski: factors for whole curves, values at positions, and the text of its file."""

from __future__ import annotations

import dataclasses
from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from nicegui import ui

from .._support.errors import ParameterError
from .._support.messages import Message
from ..ski import Ski
from ..ski.editing import EDITED_COLUMNS, SIDECUT, SkiEdit, edit_stations, edited_ski, values_at
from ..ski.file_keys import COLUMNS
from .elements import Words, add_head, button, field, folded, named
from .lab_skis import LabSkis, ski_of_texts
from .layout import heading, sentence
from .words import number_said, said, typed_number

POSITION: Final = Message("Position (m)")
ONE: Final = "1"


class SkiEditor:
    """Editor on the page; ``changed`` is awaited after each change."""

    def __init__(self, skis: LabSkis, name: str, changed: Callable[[], Awaitable[None]]) -> None:
        self._skis = skis
        self._changed = changed
        self._typed: dict[tuple[str, int], str] = {}
        self._cells: dict[tuple[str, int], ui.input] = {}
        self._shown: dict[tuple[str, int], str] = {}
        self._stations: tuple[float, ...] = ()
        text, table = skis.texts(name)
        heading(Message("Edit a ski"))
        self._begun = sentence("", "quiet")
        heading(Message("Whole curves"), 3)
        with ui.element("div").classes("factors"):
            self._factors = {key: self._factor(words) for key, words in FACTORS.items()}
        heading(Message("At positions along the ski"), 3)
        sentence(
            Message("What is typed here holds; between its neighbours the curve goes through it smoothly."), "quiet"
        )
        self._table = ui.element("div").classes("table")
        self._text, self._csv = self._file(text, table)
        self._base = self._typed_texts()
        self._show_origin(name)

    def _factor(self, words: str) -> ui.input:
        made = field(f"{words} ×", ONE, numeric=True)
        made.on("change", self._update)
        return made

    def _file(self, text: str, table: str) -> tuple[ui.textarea, ui.textarea]:
        with folded(Message("The file of the ski")):
            sentence(
                Message(
                    "With units in its keys. Draw the file takes it as it is written here; factors and "
                    "values at positions start again from it."
                ),
                "quiet",
            )
            written = (
                ui.textarea(said(Message("File of the edited ski")), value=text)
                .props("outlined autogrow")
                .classes("code")
            )
            with folded(Message("Its table, where it has one")):
                rows = (
                    ui.textarea(said(Message("Table of the edited ski")), value=table).props("outlined").classes("code")
                )
            button(Message("Draw the file"), self._take_file, "main")
        return written, rows

    def _typed_texts(self) -> tuple[str, str]:
        return str(self._text.value or ""), str(self._csv.value or "")

    def edit(self) -> SkiEditInput:
        """Current values of the fields."""
        factors = {key: str(factor.value or "") for key, factor in self._factors.items()}
        return SkiEditInput(*self._base, factors, dict(self._typed))

    def require_drawn(self) -> None:
        """Reject an edit while the text of the file differs from the drawn one."""
        if self._typed_texts() != self._base:
            raise ParameterError(
                "the file below was changed since it was drawn; press Draw the file first", code="file_changed"
            )

    async def begin(self, name: str) -> None:
        """Load a ski of the lab."""
        text, table = self._skis.texts(name)
        self._text.set_value(text)
        self._csv.set_value(table)
        self._show_origin(name)
        await self._take_file()

    async def _take_file(self) -> None:
        self._base = self._typed_texts()
        self._typed.clear()
        for factor in self._factors.values():
            factor.set_value(ONE)
        await self._changed()

    def _show_origin(self, name: str) -> None:
        self._begun.set_text(Message("Begun from {name}. Nothing is saved until you give it another name.", name=name))

    async def _update(self) -> None:
        await self._changed()

    def show(self, stations: tuple[float, ...], cells: Mapping[tuple[str, int], str]) -> None:
        """Show the values of the curves at the stations, except in cells with typed texts."""
        if stations != self._stations:
            self._stations = stations
            self._draw_table(cells)
        for place, cell in self._cells.items():
            if (cell.value or "") == self._shown[place]:
                self._shown[place] = number_said(cells[place], cell.client)
                cell.set_value(self._shown[place])

    def _draw_table(self, cells: Mapping[tuple[str, int], str]) -> None:
        self._table.clear()
        self._cells = {}
        self._shown = {place: number_said(text, self._table.client) for place, text in cells.items()}
        with self._table, ui.element("table").classes("cells"):
            add_head((POSITION, *CELLS.values()))
            with ui.element("tbody"):
                for i, station in enumerate(self._stations):
                    with ui.element("tr"):
                        with ui.element("th").props("scope=row"):
                            Words(number_said(f"{station:.3f}".replace("-", "−"), self._table.client))
                        for column in CELLS:
                            with ui.element("td"):
                                self._cell(column, i, station)

    def _cell(self, column: str, i: int, station: float) -> None:
        place = (column, i)
        made = ui.input(value=self._shown[place]).props("outlined dense inputmode=decimal autocomplete=off")
        named(made, Message("{cells} at {station:.3f} m", cells=CELLS[column], station=station))
        self._cells[place] = made

        async def typed() -> None:
            self._shown[place] = str(made.value or "")
            if text := str(made.value or "").strip():
                self._typed[place] = text
            else:  # an empty cell restores the value
                self._typed.pop(place, None)
            await self._changed()

        made.on("change", typed)


FACTORS: Final = {
    SIDECUT: Message("Sidecut depth"),
    "width_mm": Message("Width"),
    "base_height_mm": Message("Base height"),
    "EI_N_m2": Message("EI"),
    "GJ_N_m2": Message("GJ"),
    "mass_per_length_kg_per_m": Message("Mass"),
}
"""Labels of the curves with factors."""
CELLS: Final = {
    "width_mm": Message("Width (mm)"),
    "base_height_mm": Message("Base height (mm)"),
    "EI_N_m2": Message("EI (N m²)"),
    "GJ_N_m2": Message("GJ (N m²)"),
}
"""Labels with units of the curves with values at stations."""


@dataclass(frozen=True, slots=True)
class SkiEditInput:
    """Typed texts of an edit: file, table, factors by column, values by column and number of the station."""

    text: str
    table: str = ""
    factors: Mapping[str, str] = dataclasses.field(default_factory=dict)
    cells: Mapping[tuple[str, int], str] = dataclasses.field(default_factory=dict)

    @property
    def is_file(self) -> bool:
        """True without factors and values at stations."""
        return not self.cells and all(typed_number(FACTORS[key], text) == 1.0 for key, text in self.factors.items())


@dataclass(frozen=True, slots=True)
class EditedSki:
    """An edited ski, warnings of the reader, stations of the editor (m), and texts of the values there."""

    ski: Ski
    warned: str
    station: tuple[float, ...]
    cells: Mapping[tuple[str, int], str]


def edit_ski_texts(edit: SkiEditInput, *, name: str = "") -> EditedSki:
    """Ski of an edit, with another name if one is given.

    Raises ParameterError: a field is not an allowed number, or the file is not valid.
    """
    ski, warned = ski_of_texts(edit.text, edit.table)
    station = edit_stations(ski)
    factors = {
        key: typed_number(Message("the factor of {factors}", factors=FACTORS[key]), text)
        for key, text in edit.factors.items()
    }
    wanted = {column: np.full(station.size, np.nan) for column in EDITED_COLUMNS}
    for (column, i), text in edit.cells.items():
        wanted[column][i] = (
            typed_number(Message("{cells} at {station:.3f} m", cells=CELLS[column], station=station[i]), text)
            * COLUMNS[column].factor
        )
    source = ski.source if edit.is_file else f"edited in the lab ({_in_words(edit, station)}) from: {ski.source}"
    own = ski.name if edit.is_file else f"{ski.name}, edited"
    edited = edited_ski(ski, SkiEdit(station, factors, wanted), name=name or own, source=source)
    shown = values_at(edited, station)
    cells = {
        (column, i): f"{round(values[i] / COLUMNS[column].factor, 6) + 0.0:.4g}"
        for column, values in shown.items()
        for i in range(station.size)
    }
    return EditedSki(edited, warned, tuple(station.tolist()), {**cells, **edit.cells})


def _in_words(edit: SkiEditInput, station: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> str:
    scaled = [f"{FACTORS[key].text()} × {text}" for key, text in edit.factors.items() if typed_number(key, text) != 1.0]
    values = [f"{CELLS[column].text()} {text} at {station[i]:.3f} m" for (column, i), text in edit.cells.items()]
    return "; ".join([*scaled, *values])
