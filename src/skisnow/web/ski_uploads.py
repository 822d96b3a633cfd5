"""Import of a measured ski: forms on the page Skis, and the address that receives files."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final
from urllib.parse import quote

from fastapi import FastAPI
from nicegui import run, ui
from starlette.datastructures import FormData

from .._support.errors import SkisnowError
from .._support.messages import Message
from .elements import Outcome, button, field, folded
from .lab_skis import (
    LISTS,
    MEASURED,
    NAME,
    OPTIONAL,
    STIFFNESS,
    LabSkis,
    add_ski,
    check_ski_texts,
    measured_text,
    ski_of_uploads,
)
from .layout import error_sentence, heading, sentence
from .page_requests import add_upload, file_input, submit_button, text_input, upload_form, uploaded_files
from .settings import Lab
from .subprocesses import SKI_BOUNDS, confined
from .words import said

SKI_UPLOAD: Final = "/skis/add"
MOST_FILES: Final = 3


def add_ski_uploads(app: FastAPI, lab: Lab) -> None:
    """Add the address that receives skis."""

    def store(form: FormData) -> str:
        missing = Message("no file was chosen; choose the .toml file of a ski, or a design of MonkeyCAM")
        files = [(file.filename or "", file.file) for file in uploaded_files(form, "files", missing)]
        further = {key: str(form.get(key, "")) for key in STIFFNESS}
        texts = ski_of_uploads(files, further, lab.limits)
        name = add_ski(LabSkis(lab.runs), str(form.get(NAME, "")), texts)
        return f"/skis?ski={quote(name, safe='')}&added=1"

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
                button(Message("Add this ski"), self._add, "main", once=True)
            self._said = Outcome()

    async def _add(self) -> None:
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
    sentence(
        Message(
            "The .toml file of a ski and the table that it names; or the ski-def.json of MonkeyCAM, which has "
            "neither mass nor stiffness: type those next to it."
        ),
        "quiet",
    )
    with upload_form(SKI_UPLOAD):
        with ui.element("div").classes("acts"):
            file_input("files", Message("Files of the ski"), "ski-files", 'multiple accept=".toml,.csv,.json"')
        with ui.element("div").classes("acts"):
            text_input(NAME, Message("Another name for it"), f"ski-{NAME}")
        with folded(Message("With a file of MonkeyCAM")):
            for key, words in STIFFNESS.items():
                with ui.element("div").classes("acts"):
                    text_input(key, words, f"ski-{key}", "" if key in LISTS else "inputmode=decimal")
        submit_button(Message("Add the files"))
