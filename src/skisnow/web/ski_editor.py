"""Editor of a ski, and the import of a measured one."""

from __future__ import annotations

import dataclasses
from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass
from typing import Final

from fastapi import FastAPI
from nicegui import run, ui
from starlette.datastructures import FormData

from .._support.errors import ParameterError, SkisnowError
from .._support.messages import Message
from ..ski import Ski
from ..ski.editing import SIDECUT, SkiEdit, edit_stations, edited_ski
from .elements import Outcome, button, error_sentence, field, folded, heading, sentence
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
from .words import said, typed_number

ONE: Final = "1"


class SkiEditor:
    """Editor of a ski on a page; ``changed`` is awaited after each change."""

    def __init__(self, skis: LabSkis, name: str, changed: Callable[[], Awaitable[None]]) -> None:
        self._skis = skis
        self._changed = changed
        text, table = skis.texts(name)
        heading(Message("Edit a ski"))
        self._begun = sentence("", "quiet")
        heading(Message("Whole curves"), 3)
        with ui.element("div").classes("factors"):
            self._factors = {key: field(f"{words} ×", ONE, numeric=True) for key, words in FACTORS.items()}
        for factor in self._factors.values():
            factor.on("change", changed)
        self._text, self._csv = self._add_file_fields(text, table)
        self._base = self._file_and_table_text()
        self._show_origin(name)

    def _add_file_fields(self, text: str, table: str) -> tuple[ui.textarea, ui.textarea]:
        """Add text areas for the ski's file and table, and the button that draws them."""
        with folded(Message("The file of the ski")):
            sentence(
                Message(
                    "With units in its keys. Draw the file takes it as it is written here; factors start again from it."
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
        """Texts of the file and the table as typed."""
        return str(self._text.value or ""), str(self._csv.value or "")

    def edit(self) -> SkiEditInput:
        """File and table from which the edited ski begins, with the typed factors by key."""
        factors = {key: str(factor.value or "") for key, factor in self._factors.items()}
        return SkiEditInput(*self._base, factors)

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
        """Start again from the typed file, with all factors at 1."""
        self._base = self._file_and_table_text()
        for factor in self._factors.values():
            factor.set_value(ONE)
        await self._changed()

    def _show_origin(self, name: str) -> None:
        """Show the name of the ski from which the edited one began."""
        self._begun.set_text(Message("Begun from {name}. Nothing is saved until you give it another name.", name=name))


FACTORS: Final = {
    SIDECUT: Message("Sidecut depth"),
    "width_mm": Message("Width"),
    "base_height_mm": Message("Base height"),
    "EI_N_m2": Message("EI"),
    "GJ_N_m2": Message("GJ"),
    "mass_per_length_kg_per_m": Message("Mass"),
}
"""Labels of the curves with factors."""


@dataclass(frozen=True, slots=True)
class SkiEditInput:
    """Typed texts of an edit: file, table, and factors by column."""

    text: str
    table: str = ""
    factors: Mapping[str, str] = dataclasses.field(default_factory=dict)

    @property
    def is_file(self) -> bool:
        """True without factors other than 1."""
        return all(typed_number(FACTORS[key], text) == 1.0 for key, text in self.factors.items())


def edit_ski_texts(edit: SkiEditInput, *, name: str = "") -> tuple[Ski, str]:
    """Ski of an edit's texts and factors, renamed by `name`, and the reader's warnings; ParameterError if not valid."""
    ski, warned = ski_of_texts(edit.text, edit.table)
    factors = {
        key: typed_number(Message("the factor of {factors}", factors=FACTORS[key]), text)
        for key, text in edit.factors.items()
    }
    words = "; ".join(f"{FACTORS[key].text()} × {edit.factors[key]}" for key, value in factors.items() if value != 1.0)
    source = f"edited in the lab ({words}) from: {ski.source}" if words else ski.source
    own = f"{ski.name}, edited" if words else ski.name
    return edited_ski(ski, SkiEdit(edit_stations(ski), factors), name=name or own, source=source), warned


SKI_UPLOAD: Final = "/skis/add"
MOST_FILES: Final = 3


def add_ski_uploads(app: FastAPI, lab: Lab) -> None:
    """Add the address that stores uploaded ski files in the lab."""

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
            sentence(Message("The .toml file of a ski and the table that it names."), "quiet")
            with upload_form(SKI_UPLOAD):
                with ui.element("div").classes("acts"):
                    file_input("files", Message("Files of the ski"), "ski-files", 'multiple accept=".toml,.csv"')
                with ui.element("div").classes("acts"):
                    text_input(NAME, Message("Another name for it"), f"ski-{NAME}")
                submit_button(Message("Add the files"))
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
        """Save a ski of measured numbers in the lab; shows the fault if it is not valid."""
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
