"""The catalogue of skis: drawings, numbers, two compared, and an editor of a ski's file with the drawing beside it."""

from __future__ import annotations

import warnings
from importlib.resources import files
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Final

from nicegui import run, ui

from ...errors import RangeWarning, SkisnowError
from ...report.ski_drawing import SkiDrawing, ski_drawing
from ...ski import read_ski, ski_names
from ..charts import COLOURS
from ..fields import button, choice
from ..layout import framed, heading, sentence
from ..line_chart import ChartLine, LineChart

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..settings import Lab

PATH: Final = "/skis"
TITLE: Final = "Skis"
ALONG: Final = "Station from the boot (m)"
PANELS: Final = {
    "half_width_mm": "Edge (mm)",
    "base_height_mm": "Base (mm)",
    "EI_N_m2": "EI (N m²)",
    "GJ_N_m2": "GJ (N m²)",
}
STIFFNESSES: Final = ("EI_N_m2", "GJ_N_m2")
EDITED: Final = "edited below"


def add_page(_: Lab) -> None:
    """Add the page to the application."""

    @ui.page(PATH)
    async def skis() -> None:
        with framed("Skis", here=PATH):
            page = _Skis()
        await page.draw()


class _Skis:
    """Two skis side by side; the second one may be the edited one, or none."""

    def __init__(self) -> None:
        names = list(ski_names())
        with ui.element("div").classes("fields"):
            self._first = choice("Ski", names, names[0])
            self._second = choice("Compared with", ["nothing", *names, EDITED], "nothing")
        self._status = ui.label("").classes("status").props("role=status")
        self._facts = ui.element("div").classes("table")
        with ui.element("div").classes("two"):
            self._charts = {key: LineChart(ALONG, title, f"{title} along the ski") for key, title in PANELS.items()}
        self._editor()
        self._first.on_value_change(self.draw)
        self._second.on_value_change(self.draw)

    def _editor(self) -> None:
        heading("Edit a ski")
        sentence("The file of the ski, with units in its keys. Draw shows it beside the other one.", "quiet")
        self._text = ui.textarea("File of the edited ski", value=_file(self._first.value)).props("outlined autogrow")
        self._text.classes("code")
        with ui.element("div").classes("acts"):
            button("Draw", self._draw_edited, "main")
            button("Begin again from the ski above", lambda: self._text.set_value(_file(self._first.value)))
            button("Download the file", lambda: ui.download(str(self._text.value or "").encode(), "ski.toml"))

    async def _draw_edited(self) -> None:
        if self._second.value == EDITED:
            await self.draw()
        else:
            self._second.set_value(EDITED)

    async def draw(self) -> None:
        """Draw what is chosen; what is wrong with an edited file is said."""
        words = [name for name in (self._first.value, self._second.value) if name != "nothing"]
        try:
            drawn = await run.io_bound(_drawings, words, str(self._text.value or ""))
        except SkisnowError as error:
            self._status.set_text(str(error))
            self._status.classes(add="bad")
            return
        if drawn is None:  # the server ends
            return
        self._status.set_text(" ".join(told for _, told in drawn))
        self._status.classes(remove="bad")
        self._show([drawing for drawing, _ in drawn])

    def _show(self, drawn: list[SkiDrawing]) -> None:
        self._facts.clear()
        with self._facts:
            _table(drawn)
        for key, chart in self._charts.items():
            chart.show(list(_lines(key, drawn)), from_zero=key in STIFFNESSES)


def _lines(key: str, drawn: list[SkiDrawing]) -> Iterator[ChartLine]:
    for number, each in enumerate(drawn):
        values = getattr(each, key)
        yield ChartLine(each.station_m, values, number)
        if key == "half_width_mm":
            yield ChartLine(each.station_m, [-value for value in values], number)


def _table(drawn: list[SkiDrawing]) -> None:
    with ui.element("table"):
        with ui.element("thead"), ui.element("tr"):
            for text in ("", *(each.name for each in drawn)):
                with ui.element("th").props("scope=col"):
                    ui.label(text)
        with ui.element("tbody"):
            for key in drawn[0].facts:
                with ui.element("tr"):
                    with ui.element("th").props("scope=row"):
                        ui.label(key)
                    for number, each in enumerate(drawn):
                        with ui.element("td").style(f"color: {COLOURS[number]}"):
                            ui.label(each.facts[key])
    for each in drawn:
        sentence(f"{each.name}: {each.source}", "quiet")


def _drawings(names: list[str], text: str) -> list[tuple[SkiDrawing, str]]:
    return [_drawing(name, text) for name in names]


def _drawing(name: str, text: str) -> tuple[SkiDrawing, str]:
    """The drawing, and what the reader warned of."""
    with warnings.catch_warnings(record=True) as caught, TemporaryDirectory(prefix="skisnow-ski-") as folder:
        warnings.simplefilter("always", RangeWarning)
        place: str | Path = name
        if name == EDITED:
            place = Path(folder) / "edited.toml"
            place.write_text(text, encoding="utf-8", newline="")
        drawn = ski_drawing(read_ski(place))
    return drawn, " ".join(str(each.message) for each in caught)


def _file(name: str | None) -> str:
    """The text of a catalogue ski's file."""
    return (files("skisnow.ski") / "catalogue" / f"{name}.toml").read_text(encoding="utf-8")
