"""The import of a measured ski: its form on *Skis* and the address that receives the upload."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final
from urllib.parse import quote

from nicegui import run, ui
from starlette.concurrency import run_in_threadpool
from starlette.datastructures import FormData, UploadFile
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response

from .._support.errors import ParameterError, SkisnowError
from .elements import Words, button, field
from .error_pages import error_sentence, plain_page
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
from .language import said
from .layout import heading, sentence
from .subprocesses import OF_A_SKI, confined

if TYPE_CHECKING:
    from collections.abc import Callable

    from fastapi import FastAPI

    from .settings import Lab

UPLOAD: Final = "/skis/add"
MOST_FILES: Final = 3


def add_ski_uploads(app: FastAPI, lab: Lab) -> None:
    """Let an application take skis in. Where a request may come from is held by the guard around it."""

    async def take_in(request: Request) -> Response:
        try:
            async with request.form(max_files=MOST_FILES, max_fields=10) as form:
                name = await run_in_threadpool(_added, lab, form)
        except (SkisnowError, OSError) as error:
            return plain_page("This was not taken in", f"Nothing was stored: {error_sentence(error)}", 400, request)
        except HTTPException:
            text = f"Nothing was stored: at most {MOST_FILES} files at once are taken in."
            return plain_page("This was not taken in", text, 400, request)
        return RedirectResponse(f"/skis?ski={quote(name, safe='')}&added=1", 303)

    app.add_api_route(UPLOAD, take_in, methods=["POST"], include_in_schema=False, response_model=None)


def _added(lab: Lab, form: FormData) -> str:
    uploads = [each for each in form.getlist("files") if isinstance(each, UploadFile) and each.filename]
    if not uploads:
        raise ParameterError("no file was chosen; choose the .toml file of a ski, or a design of MonkeyCAM")
    further = {key: str(form.get(key, "")) for key in STIFFNESS}
    texts = ski_of_uploads([(each.filename or "", each.file) for each in uploads], further, lab.limits)
    return add_ski(LabSkis(lab.runs), str(form.get(NAME, "")), texts)


CALLED: Final = "Name of the ski"


class SkiAdding:
    """Two forms, folded: files, and three widths; ``added`` is called with the name of a ski that was typed."""

    def __init__(self, skis: LabSkis, added: Callable[[str], None]) -> None:
        self._skis = skis
        self._added = added
        with ui.element("details").classes("adding"):
            with ui.element("summary"):
                Words("Add a measured ski")
            heading("From its files", 3)
            _file_form()
            heading("From three widths", 3)
            sentence(
                "Widths at the widest places in front and behind and at the waist between them; stiffnesses evenly "
                "spaced over the running length, with blanks between, or one for all of it.",
                "quiet",
            )
            with ui.element("div").classes("fields"):
                self._name = field(CALLED)
                self._fields = {
                    key: field(words, numeric=key not in LISTS, optional=key in OPTIONAL)
                    for key, words in MEASURED.items()
                }
            with ui.element("div").classes("acts"):
                button("Add this ski", self._add, "main", once=True)
            self._said = Words("").classes("status").props("role=status")

    async def _add(self) -> None:
        name = " ".join(str(self._name.value or "").split())
        for each in self._fields.values():
            each.error = None
        try:
            self._skis.require_new(name)
            text = measured_text(name, {key: str(each.value or "") for key, each in self._fields.items()})
            await run.io_bound(confined, OF_A_SKI, check_ski_texts, text, "")
            await run.io_bound(self._skis.save_texts, name, text, "")
        except SkisnowError as error:
            self._refuse(error_sentence(error))
            return
        self._said.set_text("")
        self._added(name)

    def _refuse(self, why: str) -> None:
        """Say it at the button, and where one field is at fault at that field, too, where the focus goes."""
        self._said.set_text(f"Not saved: {why}")
        self._said.classes(add="bad")
        for key, words in MEASURED.items():
            if why.startswith(f"{words}: "):
                self._fields[key].error = said("a number is needed here")
                self._fields[key].run_method("select")
                self._said.set_text(f"Not saved: {words}")


def _file_form() -> None:
    """Plain HTML, as every upload of the lab."""
    sentence(
        "The .toml file of a ski and the table that it names; or the ski-def.json of MonkeyCAM, which knows neither "
        "mass nor stiffness: type those beside it.",
        "quiet",
    )
    form = f'method=post action="{UPLOAD}" enctype="multipart/form-data"'
    with ui.element("form").props(form):
        with ui.element("div").classes("acts"):
            _input("files", "Files of the ski", 'type=file multiple required accept=".toml,.csv,.json"')
        with ui.element("div").classes("acts"):
            _input(NAME, "Another name for it", "")
        with ui.element("details"):
            with ui.element("summary"):
                Words("With a file of MonkeyCAM")
            for key, words in STIFFNESS.items():
                with ui.element("div").classes("acts"):
                    _input(key, words, "" if key in LISTS else "inputmode=decimal")
        with ui.element("button").props("type=submit").classes("act"):
            Words("Add the files")


def _input(key: str, text: str, further: str) -> None:
    with ui.element("label").props(f"for=ski-{key}"):
        Words(text)
    ui.element("input").props(f"id=ski-{key} name={key} {further}").classes("" if "file" in further else "act plain")
