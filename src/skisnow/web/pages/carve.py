"""Page of a carved turn: sliders for edge angle, load and snow, and the ski in the snow."""

from __future__ import annotations

import asyncio
import csv
import io
import json
import threading
from typing import TYPE_CHECKING, Any, Final

from nicegui import background_tasks, run, ui

from ..._support.errors import ParameterError, SkisnowError
from ..._support.messages import Message, joined
from ..._support.outcomes import outcome_words
from ...report.campaign.page import RESULTS
from ...report.formatting import significant
from ..elements import Words, button, choice, link, named
from ..lab_skis import NOTHING, LabSkis
from ..language import number_said, said
from ..layout import framed
from ..line_chart import STYLES, ChartLine, LineChart
from ..snow_choice import SnowChoice

if TYPE_CHECKING:
    from collections.abc import Sequence

    from nicegui.events import GenericEventArguments

    from ...ski.ski_file import Sources
    from ..settings import Lab
    from ..snow_choice import ChosenSnow

PATH: Final = "/carve"
TITLE: Final = Message("Carve")
SKIS: Final = "/skis"
ALONG: Final = Message("Along the ski (m), boot = 0")
ENDS: Final = (Message("tail"), Message("tip"))
"""Texts at the ends of the axis; stations count forward from the boot."""
PANELS: Final = {
    "edge_depth_mm": Message("Depth of the edge (mm)"),
    "force_per_length_N_per_m": Message("Normal force per length (N/m)"),
    "bending_mm": Message("Deflection (mm)"),
    "twist_deg": Message("Twist (°)"),
}
# Stops and first positions of the sliders: round numbers over the measured ranges.
ANGLES: Final = tuple(str(angle) for angle in range(0, 86))
LOADS: Final = tuple(str(load) for load in range(100, 3001, 50))
_SOFT: Final = (0.04, 0.05, 0.06, 0.08, 0.1, 0.12, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.8, 1, 1.2, 1.5, 2)
_HARD: Final = (2.5, 3, 4, 5, 6, 8, 10, 12, 15, 20, 25, 30, 40, 50, 60, 90)
HARDNESSES: Final = tuple(f"{hardness:g}" for hardness in (*_SOFT, *_HARD))
STRESSES: Final = tuple(f"{hundredths / 100:g}" for hundredths in range(4, 53, 2))
RATIOS: Final = {"1": Message("1 (elastic)"), "10": "10", "100": "100", "inf": Message("no spring back")}
SLIDERS: Final = {
    "edge_angle_deg": (Message("Edge angle (°)"), ANGLES, "45"),
    "load_N": (Message("Load on this ski (N)"), LOADS, "800"),
    "H_V_N_per_mm3": (Message("Snow hardness H_V (N/mm³)"), HARDNESSES, "0.2"),
    "S_f_N_per_mm2": (Message("Failure shear stress S_f (N/mm²)"), STRESSES, "0.5"),
}
MOVED: Final = """(event) => {
  event.target.setAttribute('aria-valuetext', STOPS[event.target.value]);
  emit(event.target.value);
}"""
"""JavaScript handler: if the server drew the slider again, it would jump back during a quick movement."""
COMPUTING: Final = Message("Computing …")
PATIENCE_S: Final = 0.5
"""Time (s) after which the page shows that the results belong to older positions of the sliders."""
ABOVE_MM: Final = 3.0
"""Height above the snow that the chart of depths shows (mm)."""
HEADLINE: Final = "turn_radius_boot_m"
"""Key of the main result; the other results are in the table below."""
OF_SNOW: Final = ("H_V_N_per_mm3", "S_f_N_per_mm2")
NUMBERS: Final = ("the sliders", Message("the sliders"))
FACTS: Final = {
    "forebody_load_N": (Message("Load on the forebody"), "N"),
    "afterbody_load_N": (Message("Load on the afterbody"), "N"),
    "contact_length_m": (Message("Contact length"), "m"),
    "side_force_N": (Message("Side force"), "N"),
    "side_force_limit_N": (Message("Shear capacity of the snow"), "N"),
    "grip_utilisation": (Message("Grip utilisation (1: side-slip)"), ""),
    "total_force_N": (Message("Total force of the snow"), "N"),
    "boot_pitch_moment_Nm": (Message("Moment at the boot about the cross axis"), "N\u00a0m"),
    "turn_radius_boot_other_spread_m": (Message("Radius if the side force follows the pressure on the base"), "m"),
    "turn_radius_chord_m": (Message("Radius through the ends of the contact"), "m"),
}


def add_page(lab: Lab) -> None:
    """Add the page to the application."""
    solver, skis = _Solver(), LabSkis(lab.runs)

    @ui.page(PATH)
    async def carve(ski: str = "", other: str = "") -> None:
        with framed(Message("Carve"), here=PATH):
            _Carve(lab, solver, skis, (ski, other)).ask()  # answered while the browser builds the page


class _Solver:
    """Solver of carve questions, one at a time; it reads each ski once, and its slow imports are late."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._sources: Sources | None = None

    def answers(self, questions: Sequence[dict[str, object]], snow: ChosenSnow | None) -> list[dict[str, Any]] | str:
        """JSON of `skisnow carve` for each question, or the message of an error.

        ``snow``: snow of a campaign if the questions name its results.
        """
        from ...carving.answer import answer_dict, answered
        from ...carving.question import carve_question
        from ...ski.ski_file import Sources

        with self._lock:
            self._sources = self._sources or Sources()
            if snow is not None and snow.analysis is not None:
                self._sources.take_snow(snow.snow, results=RESULTS, site=snow.site or None)
            try:
                return [
                    answer_dict(answered(carve_question(question), sources=self._sources)) for question in questions
                ]
            except SkisnowError as error:
                return error.message


class _Carve:
    """Sliders and results; only the latest question waits while an answer is computed."""

    def __init__(self, lab: Lab, solver: _Solver, skis: LabSkis, names_in_address: tuple[str, str]) -> None:
        self._solver = solver
        self._skis = skis
        self._values: dict[str, str] = {key: start for key, (_, _, start) in SLIDERS.items()}
        self._waiting = False
        self._working = False
        names = skis.names()
        first, other = (
            name if name in names else otherwise
            for name, otherwise in zip(names_in_address, (names[0], NOTHING), strict=True)
        )
        self._headline = named(ui.element("section").classes("headline above"), Message("Carved radius"))
        self._of_snow: dict[str, ui.element] = {}
        with ui.element("div").classes("carving"):
            with ui.element("section"):
                with ui.element("div").classes("fields large"):
                    self._ski = choice(Message("Ski"), names, first)
                    self._other = choice(
                        Message("Compared with"), {NOTHING: Message("nothing"), **{name: name for name in names}}, other
                    )
                    self._ratio = choice(Message("Unloading ratio k_u/H_V"), RATIOS, "10")
                    self._snow = SnowChoice(lab, NUMBERS, self._update_snow)
                link(Message("Add or change a ski"), SKIS)
                with ui.element("div").classes("sliders"):
                    for key in SLIDERS:
                        self._slider(key)
            with ui.element("section"):
                self._status = Words(COMPUTING).classes("status")
                self._status.props("role=status")
                self._facts = ui.element("div").classes("table")
                button(Message("Curves as CSV"), self._download)
            with ui.element("section").classes("curves"):
                self._charts = {
                    key: LineChart(ALONG, title, Message("{title} along the ski", title=title), ends=ENDS)
                    for key, title in PANELS.items()
                }
        self._answers: list[dict[str, Any]] = []
        self._named: list[str] = []
        self._radii: list[Words] = []
        self._cells: dict[str, list[ui.label]] = {}
        for menu in (self._ski, self._other, self._ratio):
            menu.on_value_change(self.ask)

    def _slider(self, key: str) -> None:
        words, stops, start = SLIDERS[key]
        with ui.element("div").classes("slider") as place:
            if key in OF_SNOW:
                self._of_snow[key] = place
            called = said(words)
            shown = Words(f"{called}: {number_said(start)}")

            def moved(event: GenericEventArguments) -> None:
                self._values[key] = stops[min(max(int(event.args), 0), len(stops) - 1)]
                shown.set_text(f"{called}: {number_said(self._values[key])}")
                self.ask()

            # the browser's own slider supports arrow keys, touch and screen readers
            made = ui.element("input").props(f"type=range min=0 max={len(stops) - 1} step=1")
            named(made, words)
            made.props(f'aria-valuetext="{start}"')
            made.props["^value"] = str(stops.index(start))  # as an attribute, which a later update does not reset
            made.on("input", moved, js_handler=MOVED.replace("STOPS", json.dumps(stops)))

    async def _update_snow(self) -> None:
        for key, is_given in zip(OF_SNOW, (self._snow.gives_hardness, self._snow.gives_stress), strict=True):
            self._of_snow[key].set_visibility(not is_given)
        self.ask()

    def ask(self) -> None:
        """Request the answer for the current positions of the sliders."""
        self._waiting = True
        if not self._working:
            self._working = True
            background_tasks.create(self._work(), name="carve", context=self._status.client)

    async def _work(self) -> None:
        try:
            while self._waiting:
                self._waiting = False
                try:
                    snow = self._snow.chosen()
                except ParameterError:  # shown at the menu
                    continue
                questions = self._questions(snow)
                answers = asyncio.ensure_future(run.io_bound(self._solver.answers, questions, snow))
                if not (await asyncio.wait((answers,), timeout=PATIENCE_S))[0]:
                    self._status.set_text(COMPUTING)
                result = await answers
                if isinstance(result, str):
                    self._status.set_text(result)
                elif result is not None and not self._status.is_deleted:  # the page may be closed meanwhile
                    self._show(result)
        finally:
            self._working = False

    def _questions(self, snow: ChosenSnow | None) -> list[dict[str, object]]:
        numbers: dict[str, object] = {key: float(value) for key, value in self._values.items()}
        if snow is not None:
            site = {"site": snow.site} if snow.site else {}
            where = {"published": snow.published} if snow.published else {"results": RESULTS, **site}
            replaced = OF_SNOW if self._snow.gives_stress else OF_SNOW[:1]
            numbers = {key: value for key, value in numbers.items() if key not in replaced} | where
        skis = [str(name) for name in (self._ski.value, self._other.value) if name != NOTHING]
        return [
            {"ski": self._skis.word(name), **numbers, "unloading_ratio": float(str(self._ratio.value))} for name in skis
        ]

    def _download(self) -> None:
        """Hand the browser the curves of the answer that is shown, one row for each station of each ski."""
        table = io.StringIO()
        rows = csv.writer(table, lineterminator="\n")
        rows.writerow(["ski", "station_m", *PANELS])
        for answer in self._answers:
            columns = [answer[key] or [None] * len(answer["station_m"]) for key in PANELS]
            rows.writerows([answer["ski"]["name"], *row] for row in zip(answer["station_m"], *columns, strict=True))
        ui.download(table.getvalue().encode(), "carve.csv")

    def _show(self, answers: list[dict[str, Any]]) -> None:
        self._answers = answers
        self._status.set_text(joined([_in_words(answer) for answer in answers]))
        names = [answer["ski"]["name"] for answer in answers]
        if names != self._named:
            self._named = names
            self._facts.clear()
            with self._facts:
                self._cells = _add_table(names)
            self._headline.clear()
            with self._headline:
                self._radii = [_headline(number) for number in range(len(names))]
        for words, answer in zip(self._radii, answers, strict=True):
            words.set_text(_radius(answer))
        for key, (_, unit) in FACTS.items():
            for cell, answer in zip(self._cells[key], answers, strict=True):
                cell.set_text("–" if answer[key] is None else f"{significant(answer[key])} {unit}".rstrip())
        for key, chart in self._charts.items():
            lines = [
                ChartLine(a["station_m"], a[key], number, name=a["ski"]["name"])
                for number, a in enumerate(answers)
                if a[key] is not None
            ]
            chart.show(lines, range_=_range(key, answers))


def _range(key: str, answers: list[dict[str, Any]]) -> tuple[float, float] | None:
    """Range of the chart of depths, which grow downwards; the height above the snow is limited."""
    depths = [depth for answer in answers for depth in (answer[key] or ()) if depth is not None]
    return (1.1 * max(depths), -ABOVE_MM) if key == "edge_depth_mm" and depths else None


def _headline(number: int) -> Words:
    return Words("").classes("value").style(f"color: {STYLES[number]['colour']}")


def _radius(answer: dict[str, Any]) -> str:
    """Line with the ski, its radius, and whether the snow holds it."""
    name, radius = answer["ski"]["name"], answer[HEADLINE]
    if radius is None:
        return Message("{name}: no carved radius", name=name)
    fields = {"name": name, "radius": significant(radius)}
    if answer["holds"]:
        return Message("{name}: carved radius {radius} m", **fields)
    return Message("{name}: carved radius {radius} m, were the snow to hold it", **fields)


def _in_words(answer: dict[str, Any]) -> Message:
    name, outcome = answer["ski"]["name"], outcome_words(str(answer["outcome"]))
    words = Message("{name}: {outcome}.", name=name, outcome=outcome)
    if answer["remedy"]:
        words = Message("{name}: {outcome}, {remedy}.", name=name, outcome=outcome, remedy=answer["remedy"])
    return joined([words, *(Message("Warning: {warning}.", warning=text) for text in answer["warnings"])])


def _add_table(names: list[str]) -> dict[str, list[ui.label]]:
    """Add a table with a row for each fact and a column for each ski; returns the labels of its cells."""
    cells: dict[str, list[ui.label]] = {}
    with ui.element("table"):
        with ui.element("thead"), ui.element("tr"):
            ui.element("td")
            for number, text in enumerate(names):
                with ui.element("th").props("scope=col").style(f"color: {STYLES[number]['colour']}"):
                    Words(text)
        with ui.element("tbody"):
            for key, (words, _) in FACTS.items():
                with ui.element("tr"):
                    with ui.element("th").props("scope=row"):
                        Words(words)
                    cells[key] = []
                    for number in range(len(names)):
                        with ui.element("td").classes("n").style(f"color: {STYLES[number]['colour']}"):
                            cells[key].append(Words(""))
    return cells
