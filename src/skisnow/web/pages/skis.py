"""Page of the skis: comparison of two skis, and an editor with a drawing."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from nicegui import run, ui

from ..._support.errors import SkisnowError
from ..._support.messages import Message, current_language, translations
from ...report.charts import ski_columns, ski_facts
from ...ski import Ski
from ..elements import (
    Outcome,
    button,
    choice,
    error_sentence,
    field,
    folded,
    heading,
    link,
    named,
    option_texts,
    page_frame,
    sentence,
)
from ..lab_skis import EDITED, FILE, NOTHING, TABLE, LabSkis, check_ski_texts, texts_of_ski
from ..page_requests import address
from ..settings import BUILD_S, Lab
from ..ski_editor import SkiEditInput, SkiEditor, SkiImportForms, edit_ski_texts
from ..uploads import SKI_BOUNDS, confined
from ..widgets import ChartLine, LineChart, add_ski_table
from .carve import ENDS

PATH: Final = "/skis"
TITLE: Final = Message("Skis")
ALONG: Final = Message("Position (m), boot = 0")
PANELS: Final = {
    "half_width_mm": Message("Edge (mm)"),
    "base_height_mm": Message("Base (mm)"),
    "EI_N_m2": Message("EI (N m²)"),
    "GJ_N_m2": Message("GJ (N m²)"),
}
STIFFNESSES: Final = ("EI_N_m2", "GJ_N_m2")


def add_page(lab: Lab) -> None:
    """Add the page that shows, compares and edits skis."""
    skis = LabSkis(lab.runs)

    @ui.page(PATH, response_timeout=BUILD_S)
    async def show_skis(ski: str = "", added: str = "") -> None:
        with page_frame(Message("Skis"), here=PATH):
            page = _SkisPage(skis, ski)
        if added and ski in skis.saved():
            page.show_added(ski)
        await page.draw()


def _others(names: Sequence[str]) -> dict[str, str]:
    """Options of the menu of skis to compare with: nothing, the edited ski, and all names."""
    return {NOTHING: Message("nothing"), EDITED: Message("the edited ski"), **{name: name for name in names}}


class _SkisPage:
    """Content of the page Skis: comparison of a ski with another one, with the edited ski, or with nothing."""

    def __init__(self, skis: LabSkis, ski: str = "") -> None:
        self._skis = skis
        self._asked = 0
        names = skis.names()
        chosen = ski if ski in names else names[0]
        with ui.element("div").classes("carving skis"):
            with ui.element("div"):
                with ui.element("div").classes("fields"):
                    self._first = choice(Message("Ski"), names, chosen)
                    self._second = choice(Message("Compared with"), _others(names), NOTHING)
                SkiImportForms(skis, lambda name: ui.navigate.to(address(PATH, ski=name, added="1")))
                self._told = ui.element("div")
            with named(ui.element("section").classes("curves"), Message("Drawing")):
                self._status = Outcome()
                self._facts = ui.element("div").classes("table")
                titles = {key: (title, Message("{title} along the ski", title=title)) for key, title in PANELS.items()}
                self._charts = {key: LineChart(ALONG, *title, height=200, ends=ENDS) for key, title in titles.items()}
                with folded(Message("Source")):
                    self._sources = ui.element("div")
            with named(ui.element("section"), Message("Editor")):
                self._editor = SkiEditor(skis, chosen, self._follow)
                self._checked = skis.texts(chosen)
                self._add_saving()
        self._first.on_value_change(self.draw)
        self._second.on_value_change(self.draw)

    def _add_saving(self) -> None:
        """Add the name of the edited ski, and the buttons that begin again, save or download it."""
        with ui.element("div").classes("acts"):
            button(Message("Begin again from the ski above"), lambda: self._editor.begin(str(self._first.value)))
        heading(Message("Save it"), 3)
        with ui.element("div").classes("fields"):
            self._name = field(Message("New name"))
        with ui.element("div").classes("acts"):
            button(Message("Save in the lab"), self._save_ski, "main", once=True)
            button(Message("Download the file"), self._download)
        self._saved = Outcome()
        self._next = ui.element("div").classes("acts")

    async def _follow(self) -> None:
        """Show the edited ski after a change of the editor's fields."""
        if self._second.value == EDITED:
            await self.draw()
        else:
            self._second.set_value(EDITED)  # which draws

    async def draw(self) -> None:
        """Draw the chosen skis, or show an error of the edited ski; results of older requests are dropped."""
        self._asked += 1
        number, edit = self._asked, self._editor.edit()
        words = [str(item) for item in (self._first.value, self._second.value) if item != NOTHING]
        try:
            await self._check(edit)
            loaded = await run.io_bound(self._edited_skis, words, edit)
        except SkisnowError as error:
            if number == self._asked:
                self._status.say(error_sentence(error), bad=True)
            return
        if loaded is None or number != self._asked:  # the server ends, or a newer request exists
            return
        self._status.say(" ".join(warned for _, warned in loaded if warned))
        self._show_skis([ski for ski, _ in loaded])

    async def _check(self, edit: SkiEditInput) -> None:
        """Check a new text of a ski in a separate process with limits."""
        texts = (edit.text, edit.table)
        if texts != self._checked:
            await run.io_bound(confined, SKI_BOUNDS, check_ski_texts, edit.text, edit.table)
            self._checked = texts

    def _edited_skis(self, words: list[str], edit: SkiEditInput) -> list[tuple[Ski, str]]:
        """Skis of the words, the edited one for EDITED, each with its file text."""
        edited = edit_ski_texts(edit)
        return [edited if word == EDITED else edit_ski_texts(SkiEditInput(*self._skis.texts(word))) for word in words]

    def _show_skis(self, drawn: list[Ski]) -> None:
        """Show facts, sources and charts of the skis."""
        self._facts.clear()
        facts = [ski_facts(ski) for ski in drawn]
        with self._facts:
            cells = add_ski_table([ski.name for ski in drawn], {fact: fact for fact in facts[0]})
            for fact, labels in cells.items():
                for label, texts in zip(labels, facts, strict=True):
                    label.set_text(texts[fact])
        self._sources.clear()
        with self._sources:
            for ski in drawn:
                source = " ".join(ski.source.split())
                source = translations(current_language()).gettext(source) if source else ""
                sentence(f"{ski.name}: {source}", "quiet")
        for key, chart in self._charts.items():
            chart.show(list(_chart_lines(key, drawn)), from_zero="y" if key in STIFFNESSES else "")

    async def _save_ski(self) -> None:
        """Save the edited ski in the lab under the new name, and say so or why not."""
        name, edit = " ".join(str(self._name.value or "").split()), self._editor.edit()
        try:
            self._editor.require_drawn()
            await run.io_bound(self._save_edited, name, edit)
        except SkisnowError as error:
            self._saved.say(Message("Not saved: {error}", error=error_sentence(error)), bad=True)
            return
        names = self._skis.names()
        self._first.set_options(names)
        self._second.set_options(option_texts(_others(names)))
        self._second.set_value(name)  # which draws it
        self._saved.say(Message("Saved: {name}. Carve and Simulate have it too.", name=name))
        first = str(self._first.value)
        self._next.clear()
        with self._next:
            link(Message("Carve both side by side"), address("/carve", ski=first, other=name), "main")

    def show_added(self, name: str) -> None:
        """Tell the user that the ski `name` was added to the lab."""
        with self._told:
            sentence(
                Message("The ski {name} is added. Carve and Simulate have it too; below it can be changed.", name=name),
                "good",
            ).props("role=status")

    def _save_edited(self, name: str, edit: SkiEditInput) -> None:
        """Save the edited ski under a name; rejects a name that exists."""
        self._skis.require_new(name)
        self._skis.save_texts(name, *_edited_texts(edit, name))

    async def _download(self) -> None:
        """Download the file of the edited ski, and its table if it has one."""
        try:
            self._editor.require_drawn()
            texts = await run.io_bound(_edited_texts, self._editor.edit())
        except SkisnowError as error:
            self._saved.say(error_sentence(error), bad=True)
            return
        for file, text in zip((FILE, TABLE), texts or (), strict=False):
            if text:
                ui.download(text.encode(), file)


def _edited_texts(edit: SkiEditInput, name: str = "") -> tuple[str, str]:
    """Texts of the edited ski's file and table ("" without one)."""
    ski, _ = edit_ski_texts(edit, name=name)
    return (edit.text, edit.table) if edit.is_file else texts_of_ski(ski)


def _chart_lines(key: str, drawn: list[Ski]) -> Iterator[ChartLine]:
    """Chart lines of a key along each ski, in the units of its columns; a half width is drawn on both sides."""
    for number, ski in enumerate(drawn):
        columns = ski_columns(ski)
        station, values = columns["station_m"], columns[key]
        yield ChartLine(station, values, number, name=ski.name)
        if key == "half_width_mm":
            yield ChartLine(station, [-value for value in values], number)
