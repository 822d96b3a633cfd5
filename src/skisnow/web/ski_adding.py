"""The part of *Skis* by which a measured ski comes in."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from nicegui import run, ui

from .._support.errors import SkisnowError
from .confined import OF_A_SKI, confined
from .error_pages import error_sentence
from .fields import button, field
from .lab_skis import check_ski_texts
from .language import said
from .layout import heading, sentence
from .measured_ski import LISTS, MEASURED, NAME, OPTIONAL, STIFFNESS, measured_text
from .ski_uploads import UPLOAD
from .worded import Words

if TYPE_CHECKING:
    from collections.abc import Callable

    from .lab_skis import LabSkis

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
