"""Page of a carved turn: sliders for edge angle, load and snow, and the ski in the snow; base of the page Design."""

from __future__ import annotations

import asyncio
import json
import threading
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from typing import Any, ClassVar, Final, NamedTuple

from nicegui import background_tasks, run, ui
from nicegui.events import GenericEventArguments

from ..._support.errors import ParameterError, SkisnowError
from ..._support.messages import Message, joined, outcome_words
from ..._support.spreadsheet_text import csv_text
from ...report.campaign.page import RESULTS
from ...report.formatting import significant
from ...report.summaries import ski_verdict
from ...ski.ski_file import Sources
from ..elements import Words, button, choice, link, named, page_frame
from ..lab_skis import NOTHING, LabSkis, menu_with_nothing
from ..scenario_fields import ChosenSnow, SnowChoice
from ..settings import Lab
from ..widgets import STYLES, ChartLine, LineChart, add_ski_table, save_buttons
from ..words import number_text, said

PATH: Final = "/carve"
TITLE: Final = Message("Carve")
ALONG: Final = Message("Along the ski (m), boot = 0")
ENDS: Final = (Message("tail"), Message("tip"))  # texts at the ends of the axis; stations count forward from the boot
PANELS: Final = {
    "edge_depth_mm": Message("Depth of the edge (mm)"),
    "force_per_length_N_per_m": Message("Normal force per length (N/m)"),
    "bending_mm": Message("Deflection (mm)"),
    "twist_deg": Message("Twist (°)"),
}
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
OF_SNOW: Final = ("H_V_N_per_mm3", "S_f_N_per_mm2")
NUMBERS: Final = ("the sliders", Message("the sliders"))
MOVED: Final = """(event) => {
  event.target.setAttribute('aria-valuetext', STOPS[event.target.value]);
  emit(event.target.value);
}"""
"""JavaScript handler: if the server drew the slider again, it would jump back during a quick movement."""
COMPUTING: Final = Message("Computing …")
PATIENCE_S: Final = 0.5  # time (s) after which the page shows that the results belong to older positions of the sliders
ABOVE_MM: Final = 3.0  # height above the snow that the chart of depths shows (mm)
HEADLINE: Final = "turn_radius_boot_m"  # key of the main result; the other results are in the table
DESIGNED: Final = Message("the designed ski")
"""Word for the ski of a question that gives keys of a ski file instead of a word."""


def add_page(lab: Lab) -> None:
    """Add the page that computes carved turns of one or two skis."""
    solver, skis = Solver(), LabSkis(lab.runs)

    @ui.page(PATH)
    async def carve(ski: str = "", other: str = "") -> None:
        with page_frame(Message("Carve"), here=PATH):
            _CarvePage(lab, solver, skis, (ski, other)).ask()  # answered while the browser builds the page


class CarveInputs(NamedTuple):
    """Questions for `skisnow carve`, one per ski (a name, or the keys of a ski file), and the chosen snow."""

    questions: list[dict[str, Any]]
    snow: ChosenSnow | None


class Solver:
    """Solver of carve questions, one at a time; it reads each ski once and imports slow modules at the first one."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._sources: Sources | None = None

    def answers(self, inputs: CarveInputs) -> list[dict[str, Any]] | str:
        """Results as in the JSON of `skisnow carve` for each question, or the message of an error."""
        from ...carving.answer import answer_dict, answer_question
        from ...carving.question import carve_question
        from ...ski.ski_file import Sources

        with self._lock:
            self._sources = self._sources or Sources()
            try:
                questions = with_sources(inputs, self._sources)
                return [
                    answer_dict(answer_question(carve_question(question), sources=self._sources))
                    for question in questions
                ]
            except SkisnowError as error:
                return error.message


def with_sources(inputs: CarveInputs, sources: Sources) -> list[dict[str, Any]]:
    """Add a chosen snow and edited skis to the sources; returns the questions, which name each ski by a word."""
    snow = inputs.snow
    if snow is not None and snow.analysis is not None:
        sources.take_snow(snow.snow, results=RESULTS, site=snow.keys.get("site"))
    questions = []
    for question in inputs.questions:
        if isinstance(keys := question["ski"], dict):
            sources.take_ski(DESIGNED, keys)
        questions.append(question | {"ski": DESIGNED if isinstance(keys, dict) else keys})
    return questions


class Slider:
    """Slider with its value above it; ``moved`` is called with each new value."""

    def __init__(self, words: str, stops: Sequence[str], start: str, moved: Callable[[], None]) -> None:
        self.value = start
        self._called, self._stops, self._moved = said(words), stops, moved
        with ui.element("div").classes("slider") as self.place:
            self._shown = Words("")
            # the browser's own slider supports arrow keys, touch and screen readers
            self._made = ui.element("input").props(f"type=range min=0 max={len(stops) - 1} step=1")
        named(self._made, words)
        self._made.props(f'aria-valuetext="{start}"')
        self._made.props["^value"] = str(stops.index(start))  # as an attribute, which a later update does not reset
        self._made.on("input", self._move, js_handler=MOVED.replace("STOPS", json.dumps(stops)))
        self._show(start)

    def _move(self, event: GenericEventArguments) -> None:
        """Show the value at a position sent by the browser, and announce the change."""
        self._show(self._stops[min(max(int(event.args), 0), len(self._stops) - 1)])
        self._moved()

    def _show(self, value: str, shown: str = "") -> None:
        """Set the value, and show it or the text `shown`."""
        self.value = value
        self._shown.set_text(f"{self._called}: {number_text(shown or value)}")

    def put(self, value: float, spec: str) -> None:
        """Set a value between the stops, shown in the format ``spec``, and move the slider to the nearest stop."""
        self._show(f"{value:.9g}", format(value, spec))
        nearest = min(range(len(self._stops)), key=lambda stop: abs(float(self._stops[stop]) - value))
        ui.run_javascript(f"getHtmlElement({self._made.id}).value = {nearest}")


class CarvedTurn:
    """Base of pages with sliders and results of a carved turn; while one is computed only the latest change waits.

    A page adds its inputs, calls `add_results` and `add_charts`, and implements `asked`.
    """

    facts: ClassVar[Mapping[str, tuple[Message, str]]] = FACTS
    panels: ClassVar[Sequence[str]] = tuple(PANELS)
    height: ClassVar[int] = 240
    snow: SnowChoice

    def __init__(self, solver: Solver) -> None:
        self._solver = solver
        self.sliders: dict[str, Slider] = {}
        self._waiting = False
        self._working = False
        self._verdict = Words("").classes("verdict")
        self._headline = named(ui.element("section").classes("headline above"), Message("Carved radius"))
        self._answers: list[dict[str, Any]] = []
        self._named: list[str] = []
        self._radii: list[Words] = []
        self._cells: dict[str, list[ui.label]] = {}

    def asked(self) -> CarveInputs:
        """Questions of the current inputs. Raises ParameterError: an input is not complete; the page shows it there."""
        raise NotImplementedError

    def add_sliders(self, sliders: Mapping[str, tuple[str, Sequence[str], str]]) -> None:
        """Add a slider for each input; the tuple has its label, allowed texts and start."""
        with ui.element("div").classes("sliders"):
            for key, (words, stops, start) in sliders.items():
                self.sliders[key] = Slider(words, stops, start, self.ask)

    def add_results(self) -> None:
        """Add the line that shows the outcome, at first that it is being computed, and the empty table of results."""
        self._status = Words(COMPUTING).classes("status").props("role=status")
        self._facts = ui.element("div").classes("table")

    def add_charts(self) -> None:
        """Add an empty chart along the ski for each panel."""
        titles = {key: (PANELS[key], Message("{title} along the ski", title=PANELS[key])) for key in self.panels}
        self._charts = {key: LineChart(ALONG, *title, height=self.height, ends=ENDS) for key, title in titles.items()}

    def add_download_buttons(self, name: str) -> None:
        """Add buttons that download the curves as CSV, PNG or SVG under this name."""
        with ui.element("div").classes("acts"):
            button(Message("Curves as CSV"), partial(self._download, f"{name}.csv"))
            save_buttons(name)

    def update_snow(self) -> None:
        """Show only the sliders of snow numbers that the chosen snow does not give, and compute again."""
        for key, is_given in self.snow.given(*OF_SNOW).items():
            self.sliders[key].place.set_visibility(not is_given)
        self.ask()

    def inputs(self, skis: Iterable[Any], unloading_ratio: float) -> CarveInputs:
        """Questions for skis, each a word or keys, by sliders and chosen snow; ParameterError if that gives no snow."""
        snow = self.snow.chosen()
        turn: dict[str, Any] = {key: float(self.sliders[key].value) for key in SLIDERS}
        turn["unloading_ratio"] = unloading_ratio
        if snow is not None:
            for key in OF_SNOW if self.snow.gives_stress else OF_SNOW[:1]:
                del turn[key]
            turn |= snow.keys
        return CarveInputs([{"ski": ski, **turn} for ski in skis], snow)

    def ask(self) -> None:
        """Start to compute and show the results for the current inputs, unless a computation will include them."""
        self._waiting = True
        if not self._working:
            self._working = True
            background_tasks.create(self._answer_requests(), name="carve", context=self._status.client)

    async def _answer_requests(self) -> None:
        """Solve the carve for the newest inputs and show it, until no request is waiting."""
        try:
            while self._waiting:
                self._waiting = False
                try:
                    inputs = self.asked()
                except ParameterError:  # shown at the input
                    continue
                answers = asyncio.ensure_future(run.io_bound(self._solver.answers, inputs))
                if not (await asyncio.wait((answers,), timeout=PATIENCE_S))[0]:
                    self._status.set_text(COMPUTING)
                result = await answers
                if isinstance(result, str):
                    self._status.set_text(result)
                elif result is not None and not self._status.is_deleted:  # the page may be closed meanwhile
                    self._show(result)
        finally:
            self._working = False

    def _download(self, file: str) -> None:
        """Let the browser download the shown curves as CSV, one row for each station of each ski."""
        rows: list[Sequence[Any]] = [["ski", "station_m", *PANELS]]
        for answer in self._answers:
            columns = [answer[key] or [None] * len(answer["station_m"]) for key in PANELS]
            rows += ([answer["ski"]["name"], *row] for row in zip(answer["station_m"], *columns, strict=True))
        ui.download(csv_text(rows).encode(), file)

    def _show(self, answers: list[dict[str, Any]]) -> None:
        """Show the answers, one or two: words, radii, table of facts and charts."""
        self._answers = answers
        self._status.set_text(joined([_in_words(answer) for answer in answers]))
        names = [answer["ski"]["name"] for answer in answers]
        self._verdict.set_text(ski_verdict(answers[0], answers[1], (names[0], names[1])) if len(answers) == 2 else "")
        if names != self._named:
            self._named = names
            self._facts.clear()
            with self._facts:
                self._cells = add_ski_table(names, {key: words for key, (words, _) in self.facts.items()})
            self._headline.clear()
            with self._headline:
                colours = [style["colour"] for style in STYLES[: len(names)]]
                self._radii = [Words("").classes("value").style(f"color: {colour}") for colour in colours]
        for words, answer in zip(self._radii, answers, strict=True):
            words.set_text(_radius(answer))
        for key, (_, unit) in self.facts.items():
            for cell, answer in zip(self._cells[key], answers, strict=True):
                value = self.fact(key, answer)
                cell.set_text("–" if value is None else f"{significant(value)} {unit}".rstrip())
        for key, chart in self._charts.items():
            lines = [
                ChartLine(a["station_m"], a[key], number, name=a["ski"]["name"])
                for number, a in enumerate(answers)
                if a[key] is not None
            ]
            chart.show(lines, range_=_range(key, answers))

    def fact(self, key: str, answer: dict[str, Any]) -> float | None:
        """Number of an answer for a row of the table; None if it does not exist."""
        return answer[key]


def _range(key: str, answers: list[dict[str, Any]]) -> tuple[float, float] | None:
    """Range of a chart's vertical axis: for edge depths, which grow downwards, otherwise None for the default."""
    depths = [depth for answer in answers for depth in (answer[key] or ()) if depth is not None]
    return (1.1 * max(depths), -ABOVE_MM) if key == "edge_depth_mm" and depths else None


def _radius(answer: dict[str, Any]) -> str:
    """Line with the ski, its radius, and whether the snow holds it."""
    name, radius = answer["ski"]["name"], answer[HEADLINE]
    if radius is None:
        return Message("{name}: no carved radius", name=name)
    fields = {"name": name, "radius": significant(radius)}
    if answer["holds"]:
        return Message("{name}: carved radius {radius} m", **fields)
    return Message("{name}: carved radius {radius} m, if the snow held it", **fields)


def _in_words(answer: dict[str, Any]) -> Message:
    """Message about an answer: ski, outcome with remedy, and warnings."""
    name, outcome = answer["ski"]["name"], outcome_words(str(answer["outcome"]))
    words = Message("{name}: {outcome}.", name=name, outcome=outcome)
    if answer["remedy"]:
        words = Message("{name}: {outcome}, {remedy}.", name=name, outcome=outcome, remedy=answer["remedy"])
    return joined([words, *(Message("Warning: {warning}.", warning=text) for text in answer["warnings"])])


class _CarvePage(CarvedTurn):
    """Content of the page Carve: menus of skis and snow next to the sliders of `CarvedTurn`."""

    def __init__(self, lab: Lab, solver: Solver, skis: LabSkis, names_in_address: tuple[str, str]) -> None:
        super().__init__(solver)
        self._skis = skis
        names = skis.names()
        first, other = names_in_address
        with ui.element("div").classes("carving"):
            with ui.element("section"):
                with ui.element("div").classes("fields large"):
                    self._ski = choice(Message("Ski"), names, first if first in names else names[0])
                    others = menu_with_nothing(names)
                    self._other = choice(Message("Compared with"), others, other if other in others else NOTHING)
                    self._ratio = choice(Message("Unloading ratio k_u/H_V"), RATIOS, "10")
                    self.snow = SnowChoice(lab, NUMBERS, self.update_snow)
                link(Message("Add or change a ski"), "/skis")
                self.add_sliders(SLIDERS)
            with ui.element("section"):
                self.add_results()
                self.add_download_buttons("carve")
            with ui.element("section").classes("curves"):
                self.add_charts()
        for menu in (self._ski, self._other, self._ratio):
            menu.on_value_change(self.ask)

    def asked(self) -> CarveInputs:
        """Inputs of carve for each chosen ski, one or two, with the snow's k_u/H_V."""
        names = [str(name) for name in (self._ski.value, self._other.value) if name != NOTHING]
        return self.inputs(map(self._skis.word, names), float(str(self._ratio.value)))
