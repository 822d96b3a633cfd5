"""Parts of pages that are updated in place: charts of lines, and lists of jobs.

A large chart library takes half a second to load and 20 ms for each change of a chart on a laptop.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, Literal, TypeAlias

from nicegui import ui
from nicegui.element import Element

from .._support.errors import ParameterError
from .._support.messages import Message, decimal_sign, joined
from ..report.formatting import significant
from .elements import Words, button, error_sentence, heading, named, sentence
from .runs import Runs, progress_words
from .words import language_of, said

Act: TypeAlias = Callable[[Callable[[], None]], None]
"""Function that calls a function of the queue, and shows its errors."""

DIGITS: Final = 5
STYLES: Final = (
    {"colour": "#0b4f8a", "dash": "", "width": 2.5, "point": 11, "read": True},
    {"colour": "#b3450b", "dash": "7 5", "width": 2.5, "point": 11, "read": True},
    {"colour": "#48525c", "dash": "2 4", "width": 2.5, "point": 11, "read": True},
    {"colour": "#8b96a1", "dash": "", "width": 1, "point": 6, "read": False},
)
"""Colour, dashes, width of a line and of a point in pixels, and whether values are shown at the pointer."""
BEHIND: Final = 3  # style of lines in the background


@dataclass(frozen=True, slots=True)
class ChartLine:
    """A line of a chart with values x and y; None breaks the line.

    ``style``: 0, 1 or 2, or `BEHIND`. ``points``: True for points instead of a line. ``name``: text of the legend
    (default: no entry).
    """

    x: Sequence[float | None]
    y: Sequence[float | None]
    style: int = 0
    points: bool = False
    name: str = ""


class LineChart(Element, component="line_chart.js"):
    """Chart of lines with axis labels, a description for screen readers, a height (px) and texts at the ends of x."""

    def __init__(self, x: str, y: str, words: str, *, height: int = 240, ends: tuple[str, str] = ("", "")) -> None:
        super().__init__()
        self._titles = {
            "x": said(x),
            "y": said(y),
            "ends": [said(end) for end in ends],
            "mark": decimal_sign(language_of()),
        }
        self._words = words
        self._drawn: list[tuple[ChartLine, dict[str, Any]]] = []
        self._props["height"] = height
        self._props["styles"] = STYLES
        self.show([])

    def show(
        self,
        lines: Sequence[ChartLine],
        *,
        range_: tuple[float, float] | None = None,
        from_zero: Literal["", "y", "xy"] = "",
    ) -> None:
        """Draw lines, the first one at the bottom.

        ``range_``: values at the lower and upper ends of the vertical axis (default: all values). ``from_zero``: axes
        that include zero.
        """
        self._drawn = [(line, self._plain(line)) for line in lines]
        self._props["panel"] = {
            **self._titles,
            "label": self._chart_label(lines),
            "range": range_,
            "from_zero": from_zero,
            "lines": [plain for _, plain in self._drawn],
        }
        self.update()

    def _plain(self, line: ChartLine) -> dict[str, Any]:
        """Line with rounded values for the browser; unchanged lines are not rounded again."""
        for drawn, plain in self._drawn:
            if drawn == line:
                return plain
        plain = {
            "x": _round_to_pixels(line.x),
            "y": _round_to_pixels(line.y),
            "style": line.style,
            "points": line.points,
        }
        return plain | {"name": said(line.name, self.client)}

    def _chart_label(self, lines: Sequence[ChartLine]) -> str:
        """Text for screen readers: the chart's title, range of values and names of lines."""
        values = [value for line in lines for value in line.y if value is not None and math.isfinite(value)]
        names = [line.name for line in lines if line.name]
        if not values:
            return said(Message("{chart}: nothing yet", chart=self._words), self.client)
        extent = Message("{low} to {high}", low=significant(min(values)), high=significant(max(values)))
        if names:
            return said(
                Message("{chart}: {extent} ({names})", chart=self._words, extent=extent, names=names), self.client
            )
        return said(Message("{chart}: {extent}", chart=self._words, extent=extent), self.client)


def save_buttons(name: str) -> None:
    """Add buttons that download all charts of the page as one PNG or SVG of this name."""
    for kind, words in (("png", Message("Curves as PNG")), ("svg", Message("Curves as SVG"))):
        button(words, None).on("click", js_handler=f"() => saveCharts('{name}.{kind}')")


def _round_to_pixels(values: Sequence[float | None]) -> list[float | None]:
    """Values rounded to a hundredth of a pixel, and None for NaN and infinity, to send fewer characters."""
    sizes = [abs(value) for value in values if value is not None and math.isfinite(value)]
    if not sizes or max(sizes) == 0.0:
        return [None if value is None or not math.isfinite(value) else value for value in values]
    digits = DIGITS - 1 - math.floor(math.log10(max(sizes)))
    return [None if value is None or not math.isfinite(value) else round(value, digits) for value in values]


EVERY_S: Final = 1.0


class JobCard:
    """Card of a job of a queue: title, state in words, progress, and buttons; a page adds its own buttons."""

    def __init__(self, runs: Any, job: Any, act: Act) -> None:
        self.runs = runs
        with ui.element("section").classes("card") as self.place:
            with ui.element("h3"):
                self._title = Words("")
            self._words = sentence("", "quiet").props("aria-live=polite")
            self._progress = sentence("", "quiet progress")  # not announced, as it changes each second
            with ui.element("div").classes("acts"):
                cancel = button(Message("Cancel"), lambda: act(lambda: runs.cancel(job.name)))
                self._cancel = named(cancel, Message("Cancel {name}", name=job.name))
                self.add_buttons(job, act)

    def add_buttons(self, job: Any, act: Act) -> None:
        """Add the buttons and links of the kind of job; each subclass must define it."""
        raise NotImplementedError

    def inputs(self, job: Any) -> tuple[str, ...]:
        """Subject and inputs of a job in words; each subclass must define it."""
        raise NotImplementedError

    def show(self, job: Any) -> None:
        """Show name, inputs, state and message of the job, its progress while it runs, and the button to cancel."""
        self._title.set_text(job.shown_name)
        parts = (*self.inputs(job), Message(job.state), job.said)
        self._words.set_text(joined([part for part in parts if part], " · "))
        self._progress.set_text(progress_words(self.runs.progress) if job.state == "running" else "")
        self._progress.set_visibility(bool(self._progress.text))
        self._cancel.set_visibility(job.state in ("waiting", "running"))


class JobList:
    """Cards of all jobs of a queue, newest first, updated every second; `card` makes one from queue, job and `Act`."""

    def __init__(self, runs: Any, card: Callable[[Any, Any, Act], JobCard], nothing: str) -> None:
        self._runs: Runs = runs
        self._card = card
        self._cards: dict[str, JobCard] = {}
        heading(Message("Queue and history"))
        self._nothing = sentence(nothing, "quiet")
        self._place = ui.element("div")
        self.show()
        ui.timer(EVERY_S, self.show)

    def show(self) -> None:
        """Add cards of new jobs, remove those of removed jobs, and show the state of all."""
        jobs = self._runs.jobs()
        self._nothing.set_visibility(not jobs)
        for name in self._cards.keys() - {job.name for job in jobs}:
            self._cards.pop(name).place.delete()
        for index, job in enumerate(jobs):
            if job.name not in self._cards:
                with self._place:
                    self._cards[job.name] = card = self._card(self._runs, job, self._act_and_show)
                card.place.move(target_index=index)
            self._cards[job.name].show(job)

    def _act_and_show(self, act: Callable[[], None]) -> None:
        """Do an action, notify the user if it is rejected, and show the list again."""
        try:
            act()
        except ParameterError as error:
            ui.notify(said(error_sentence(error)))
        self.show()


def add_ski_table(names: Sequence[str], facts: Mapping[str, str]) -> dict[str, list[ui.label]]:
    """Add a table with a row for each fact and a column for each ski; returns the labels of its cells."""
    cells: dict[str, list[ui.label]] = {}
    with ui.element("table"):
        with ui.element("thead"), ui.element("tr"):
            ui.element("td")
            for number, text in enumerate(names):
                with ui.element("th").props("scope=col").style(f"color: {STYLES[number]['colour']}"):
                    Words(text)
        with ui.element("tbody"):
            for key, words in facts.items():
                with ui.element("tr"):
                    with ui.element("th").props("scope=row"):
                        Words(words)
                    cells[key] = []
                    for number in range(len(names)):
                        with ui.element("td").classes("n").style(f"color: {STYLES[number]['colour']}"):
                            cells[key].append(Words(""))
    return cells
