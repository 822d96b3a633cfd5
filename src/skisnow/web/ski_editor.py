"""Editor of a ski, and the import of a measured one."""

from __future__ import annotations

import dataclasses
from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from fastapi import FastAPI
from nicegui import run, ui
from starlette.datastructures import FormData

from .._support.errors import ParameterError, SkisnowError
from .._support.messages import Message
from ..ski import Ski
from ..ski.editing import EDITED_COLUMNS, SIDECUT, SkiEdit, edit_stations, edited_ski, values_at
from ..ski.file_keys import COLUMNS
from .elements import Outcome, Words, add_head, button, error_sentence, field, folded, heading, named, sentence
from .lab_skis import (
    LISTS,
    MEASURED,
    NAME,
    OPTIONAL,
    LabSkis,
    check_ski_texts,
    measured_text,
    ski_of_texts,
    ski_of_uploads,
)
from .page_requests import add_upload, address, file_input, submit_button, text_input, upload_form, uploaded_files
from .settings import Lab
from .uploads import SKI_BOUNDS, confined
from .words import number_text, said, typed_number

POSITION: Final = Message("Position (m)")
ONE: Final = "1"


class SkiEditor:
    """Editor of a ski on a page; ``changed`` is awaited after each change."""

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
            self._factors = {key: self._add_factor_field(words) for key, words in FACTORS.items()}
        heading(Message("At positions along the ski"), 3)
        sentence(
            Message("What is typed here holds; between its neighbours the curve goes through it smoothly."), "quiet"
        )
        self._table = ui.element("div").classes("table")
        self._text, self._csv = self._add_file_fields(text, table)
        self._base = self._file_and_table_text()
        self._show_origin(name)

    def _add_factor_field(self, words: str) -> ui.input:
        made = field(f"{words} ×", ONE, numeric=True)
        made.on("change", self._changed)
        return made

    def _add_file_fields(self, text: str, table: str) -> tuple[ui.textarea, ui.textarea]:
        with folded(Message("The file of the ski")):
            sentence(
                Message(
                    "With units in its keys. Draw the file takes it as it is written here; factors and "
                    "values at positions start again from it."
                ),
                "quiet",
            )
            written = ui.textarea(said(Message("File of the edited ski")), value=text).props("outlined autogrow")
            with folded(Message("Its table, where it has one")):
                rows = ui.textarea(said(Message("Table of the edited ski")), value=table).props("outlined")
            for area in (written, rows):
                area.classes("code")
            button(Message("Draw the file"), self._take_file, "main")
        return written, rows

    def _file_and_table_text(self) -> tuple[str, str]:
        return str(self._text.value or ""), str(self._csv.value or "")

    def edit(self) -> SkiEditInput:
        """Current values of the fields."""
        factors = {key: str(factor.value or "") for key, factor in self._factors.items()}
        return SkiEditInput(*self._base, factors, dict(self._typed))

    def require_drawn(self) -> None:
        """Raise a ParameterError if the text of the file was changed since it was last drawn."""
        if self._file_and_table_text() != self._base:
            raise ParameterError("the file below was changed since it was drawn; press Draw the file first").tag(
                "file_changed"
            )

    async def begin(self, name: str) -> None:
        """Load a ski of the lab, by its name, into the editor."""
        text, table = self._skis.texts(name)
        self._text.set_value(text)
        self._csv.set_value(table)
        self._show_origin(name)
        await self._take_file()

    async def _take_file(self) -> None:
        self._base = self._file_and_table_text()
        self._typed.clear()
        for factor in self._factors.values():
            factor.set_value(ONE)
        await self._changed()

    def _show_origin(self, name: str) -> None:
        self._begun.set_text(Message("Begun from {name}. Nothing is saved until you give it another name.", name=name))

    def show(self, stations: tuple[float, ...], cells: Mapping[tuple[str, int], str]) -> None:
        """Show the values of the curves at the stations, except in cells with typed texts."""
        if stations != self._stations:
            self._stations = stations
            self._draw_table(cells)
        for place, cell in self._cells.items():
            if (cell.value or "") == self._shown[place]:
                self._shown[place] = number_text(cells[place], cell.client)
                cell.set_value(self._shown[place])

    def _draw_table(self, cells: Mapping[tuple[str, int], str]) -> None:
        self._table.clear()
        self._cells = {}
        self._shown = {place: number_text(text, self._table.client) for place, text in cells.items()}
        with self._table, ui.element("table").classes("cells"):
            add_head((POSITION, *CELLS.values()))
            with ui.element("tbody"):
                for i, station in enumerate(self._stations):
                    with ui.element("tr"):
                        with ui.element("th").props("scope=row"):
                            Words(number_text(f"{station:.3f}", self._table.client))
                        for column in CELLS:
                            with ui.element("td"):
                                self._add_cell(column, i, station)

    def _add_cell(self, column: str, i: int, station: float) -> None:
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
    source = ski.source if edit.is_file else f"edited in the lab ({_edit_in_words(edit, station)}) from: {ski.source}"
    own = ski.name if edit.is_file else f"{ski.name}, edited"
    edited = edited_ski(ski, SkiEdit(station, factors, wanted), name=name or own, source=source)
    shown = values_at(edited, station)
    cells = {
        (column, i): f"{round(values[i] / COLUMNS[column].factor, 6) + 0.0:.4g}"
        for column, values in shown.items()
        for i in range(station.size)
    }
    return EditedSki(edited, warned, tuple(station.tolist()), {**cells, **edit.cells})


def _edit_in_words(edit: SkiEditInput, station: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> str:
    """List of the edits for the source of the ski: factors other than 1, typed values with stations (m)."""
    scaled = [f"{FACTORS[key].text()} × {text}" for key, text in edit.factors.items() if typed_number(key, text) != 1.0]
    values = [f"{CELLS[column].text()} {text} at {station[i]:.3f} m" for (column, i), text in edit.cells.items()]
    return "; ".join([*scaled, *values])


SKI_UPLOAD: Final = "/skis/add"
MOST_FILES: Final = 3


def add_ski_uploads(app: FastAPI, lab: Lab) -> None:
    """Add the address that receives skis."""

    def store(form: FormData) -> str:
        missing = Message("no file was chosen; choose the .toml file of a ski")
        files = [(file.filename or "", file.file) for file in uploaded_files(form, "files", missing)]
        texts = ski_of_uploads(files, lab.limits)
        name = " ".join((str(form.get(NAME, "")) or texts.name).split())
        LabSkis(lab.runs).save_texts(name, texts.text, texts.table)
        return address("/skis", ski=name, added="1")

    too_many = Message("Nothing was stored: at most {most_files} files at once can be imported.", most_files=MOST_FILES)
    add_upload(app, SKI_UPLOAD, store, max_files=MOST_FILES, too_many=too_many)


CALLED: Final = Message("Name of the ski")


class SkiImportForms:
    """Folded forms for files of a ski and for three widths; ``added`` is called with the name of a typed ski."""

    def __init__(self, skis: LabSkis, added: Callable[[str], None]) -> None:
        self._skis = skis
        self._added = added
        with folded(Message("Add a measured ski")).classes("adding"):
            heading(Message("From its files"), 3)
            _file_form()
            heading(Message("From three widths"), 3)
            sentence(
                Message(
                    "Widths at the widest places in front and behind and at the waist between them; "
                    "stiffnesses evenly spaced over the running length, with blanks between, or one for all "
                    "of it."
                ),
                "quiet",
            )
            with ui.element("div").classes("fields"):
                self._name = field(CALLED)
                self._fields = {
                    key: field(words, numeric=key not in LISTS, optional=key in OPTIONAL)
                    for key, words in MEASURED.items()
                }
            with ui.element("div").classes("acts"):
                button(Message("Add this ski"), self._add_measured_ski, "main", once=True)
            self._said = Outcome()

    async def _add_measured_ski(self) -> None:
        name = " ".join(str(self._name.value or "").split())
        for field_ in self._fields.values():
            field_.error = None
        try:
            self._skis.require_new(name)
            text = measured_text(name, {key: str(field_.value or "") for key, field_ in self._fields.items()})
            await run.io_bound(confined, SKI_BOUNDS, check_ski_texts, text, "")
            await run.io_bound(self._skis.save_texts, name, text, "")
        except SkisnowError as error:
            self._refuse(error_sentence(error))
            return
        self._said.set_text("")
        self._added(name)

    def _refuse(self, why: str) -> None:
        """Show an error at the button and at its field, and put the focus on the field."""
        self._said.say(Message("Not saved: {why}", why=why), bad=True)
        for key, words in MEASURED.items():
            if why.startswith(f"{words}: "):
                self._fields[key].error = said(Message("a number is needed here"))
                self._fields[key].run_method("select")
                self._said.set_text(Message("Not saved: {words}", words=words))


def _file_form() -> None:
    """Form for the files of a ski."""
    sentence(Message("The .toml file of a ski and the table that it names."), "quiet")
    with upload_form(SKI_UPLOAD):
        with ui.element("div").classes("acts"):
            file_input("files", Message("Files of the ski"), "ski-files", 'multiple accept=".toml,.csv"')
        with ui.element("div").classes("acts"):
            text_input(NAME, Message("Another name for it"), f"ski-{NAME}")
        submit_button(Message("Add the files"))
