"""Skis: the catalogue and those of the lab, two compared, and an editor with the drawing beside it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final
from urllib.parse import quote

from nicegui import run, ui

from ..._support.errors import SkisnowError
from ...report.charts import SkiDrawing, ski_drawing
from ..elements import Words, button, choice, field, link, named, said_options
from ..error_pages import error_sentence
from ..lab_skis import EDITED, FILE, NOTHING, TABLE, LabSkis, check_ski_texts, texts_of_ski
from ..language import said
from ..layout import framed, heading, sentence
from ..line_chart import STYLES, ChartLine, LineChart
from ..page_addresses import carving
from ..settings import BUILD_S
from ..ski_editor import SkiAsked, SkiEditor, SkiFound, ski_found
from ..ski_uploads import SkiAdding
from ..subprocesses import OF_A_SKI, confined

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..settings import Lab

PATH: Final = "/skis"
TITLE: Final = "Skis"
ALONG: Final = "Position (m), boot = 0"
PANELS: Final = {
    "half_width_mm": "Edge (mm)",
    "base_height_mm": "Base (mm)",
    "EI_N_m2": "EI (N m²)",
    "GJ_N_m2": "GJ (N m²)",
}
STIFFNESSES: Final = ("EI_N_m2", "GJ_N_m2")


def add_page(lab: Lab) -> None:
    """Add the page to the application."""
    skis = LabSkis(lab.runs)

    @ui.page(PATH, response_timeout=BUILD_S)
    async def show_skis(ski: str = "", added: str = "") -> None:
        with framed("Skis", here=PATH):
            page = _Skis(skis, ski)
        if added and ski in skis.saved():
            page.tell_added(ski)
        await page.draw()


def _checked_apart(text: str, table: str) -> None:
    confined(OF_A_SKI, check_ski_texts, text, table)


class _Skis:
    """Two skis over each other; the second one may be the edited one, or none."""

    def __init__(self, skis: LabSkis, ski: str = "") -> None:
        self._skis = skis
        self._asked = 0
        names = skis.names()
        chosen = ski if ski in names else names[0]
        SkiAdding(skis, lambda name: ui.navigate.to(f"{PATH}?ski={quote(name, safe='')}&added=1"))
        self._told = ui.element("div")
        with ui.element("div").classes("fields"):
            self._first = choice("Ski", names, chosen)
            self._second = choice("Compared with", [NOTHING, EDITED, *names], NOTHING)
        self._status = Words("").classes("status").props("role=status")
        self._facts = ui.element("div").classes("table")
        with ui.element("div").classes("two"):
            with named(ui.element("section").classes("drawing"), "Drawing"):
                self._charts = {
                    key: LineChart(ALONG, title, f"{title} along the ski", height=190, ends=("tail", "tip"))
                    for key, title in PANELS.items()
                }
            with named(ui.element("section"), "Editor"):
                self._editor = SkiEditor(skis, chosen, self._follow)
                self._checked = skis.texts(chosen)
                self._saving()
        self._first.on_value_change(self.draw)
        self._second.on_value_change(self.draw)

    def _saving(self) -> None:
        with ui.element("div").classes("acts"):
            button("Begin again from the ski above", self._begin)
        heading("Save it", 3)
        with ui.element("div").classes("fields"):
            self._name = field("New name")
        with ui.element("div").classes("acts"):
            button("Save in the lab", self._save, "main", once=True)
            button("Download the file", self._download)
        self._saved = Words("").classes("status").props("role=status")
        self._next = ui.element("div").classes("acts")

    async def _begin(self) -> None:
        await self._editor.begin(str(self._first.value))

    async def _follow(self) -> None:
        """The editor's fields changed: show what they say."""
        if self._second.value == EDITED:
            await self.draw()
        else:
            self._second.set_value(EDITED)  # which draws

    async def draw(self) -> None:
        """Draw what is chosen; what is wrong with an edited ski is said. An older question's answer is dropped."""
        self._asked += 1
        number, asked = self._asked, self._editor.asked()
        words = [str(each) for each in (self._first.value, self._second.value) if each != NOTHING]
        try:
            await self._check(asked)
            found = await run.io_bound(self._found, words, asked)
        except SkisnowError as error:
            if number == self._asked:
                _show(self._status, error_sentence(error), bad=True)
            return
        if found is None or number != self._asked:  # the server ends, or something else is wanted by now
            return
        skis, edited = found
        _show(self._status, " ".join(each.warned for each in skis if each.warned), bad=False)
        self._editor.show(edited.station, edited.cells)
        self._show([ski_drawing(each.ski) for each in skis])

    async def _check(self, asked: SkiAsked) -> None:
        """Read a text that was not read before where it can do no harm."""
        texts = (asked.text, asked.table)
        if texts != self._checked:
            await run.io_bound(_checked_apart, *texts)
            self._checked = texts

    def _found(self, words: list[str], asked: SkiAsked) -> tuple[list[SkiFound], SkiFound]:
        edited = ski_found(asked)
        others = (edited if word == EDITED else ski_found(SkiAsked(*self._skis.texts(word))) for word in words)
        return list(others), edited

    def _show(self, drawn: list[SkiDrawing]) -> None:
        self._facts.clear()
        with self._facts:
            _table(drawn)
        for key, chart in self._charts.items():
            chart.show(list(_lines(key, drawn)), from_zero="y" if key in STIFFNESSES else "")

    async def _save(self) -> None:
        name, asked = " ".join(str(self._name.value or "").split()), self._editor.asked()
        try:
            self._editor.require_drawn()
            await run.io_bound(self._keep, name, asked)
        except SkisnowError as error:
            _show(self._saved, f"Not saved: {error_sentence(error)}", bad=True)
            return
        names = self._skis.names()
        self._first.set_options(names)
        self._second.set_options(said_options([NOTHING, EDITED, *names]))
        self._second.set_value(name)  # which draws it
        _show(self._saved, f"Saved: {name}. Carve and Simulate have it too.", bad=False)
        first = str(self._first.value)
        self._next.clear()
        with self._next:
            link("Carve both side by side", carving(first, name), "main")

    def tell_added(self, name: str) -> None:
        """Say that a measured ski was taken in, and what can be done with it."""
        with self._told:
            sentence(
                f"The ski {name} is added. Carve and Simulate have it too; below it can be changed.", "good"
            ).props("role=status")

    def _keep(self, name: str, asked: SkiAsked) -> None:
        self._skis.require_new(name)
        found = ski_found(asked, name=name)
        if asked.is_file:
            self._skis.save_texts(name, asked.text, asked.table)
        else:
            self._skis.save_ski(name, found.ski)

    async def _download(self) -> None:
        try:
            self._editor.require_drawn()
            files = await run.io_bound(_files, self._editor.asked())
        except SkisnowError as error:
            _show(self._saved, error_sentence(error), bad=True)
            return
        for name, text in (files or {}).items():
            ui.download(text.encode(), name)


def _show(label: ui.label, text: str, *, bad: bool) -> None:
    label.set_text(text)
    label.classes(add="bad" if bad else "good", remove="good" if bad else "bad")


def _files(asked: SkiAsked) -> dict[str, str]:
    """The file of the edited ski, and its table where it has one."""
    found = ski_found(asked)
    text, table = (asked.text, asked.table) if asked.is_file else texts_of_ski(found.ski)
    return {FILE: text, **({TABLE: table} if table else {})}


def _lines(key: str, drawn: list[SkiDrawing]) -> Iterator[ChartLine]:
    for number, each in enumerate(drawn):
        values = getattr(each, key)
        yield ChartLine(each.station_m, values, number, name=each.name)
        if key == "half_width_mm":
            yield ChartLine(each.station_m, [-value for value in values], number)


def _table(drawn: list[SkiDrawing]) -> None:
    with ui.element("table"):
        with ui.element("thead"), ui.element("tr"):
            ui.element("td")
            for number, each in enumerate(drawn):
                with ui.element("th").props("scope=col").style(f"color: {STYLES[number]['colour']}"):
                    Words(each.name)
        with ui.element("tbody"):
            for key in drawn[0].facts:
                with ui.element("tr"):
                    with ui.element("th").props("scope=row"):
                        Words(key)
                    for number, each in enumerate(drawn):
                        with ui.element("td").style(f"color: {STYLES[number]['colour']}"):
                            Words(each.facts[key])
    for each in drawn:
        sentence(f"{each.name}: {said(each.source)}", "quiet")
