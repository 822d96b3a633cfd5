"""Simulations: a form made from the table of inputs, a snow, a ski, the queue with progress, the history."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from nicegui import app, background_tasks, run, ui

from ..._support.errors import ParameterError, SkisnowError
from ...replay.run_file import RUN_FILE
from ..elements import Words, button, choice, link, named
from ..error_pages import error_sentence
from ..job_list import JobList
from ..lab_courses import UPLOAD, LabCourses, add_course_uploads
from ..lab_skis import LabSkis
from ..language import language_of
from ..layout import framed, heading, sentence
from ..page_requests import redrawn_by
from ..replay.addresses import show_address
from ..runs import Job, Runs, duration_words, estimated_s
from ..scenario_fields import ScenarioField, called, in_labels
from ..snow_choice import SnowChoice, require_scenario, results_with, snow_words

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ..job_list import Act
    from ..settings import Lab
    from ..snow_choice import ChosenSnow

PATH: Final = "/simulate"
TITLE: Final = "Simulate"
GIVEN: Final = "as in the scenario"
NUMBERS: Final = "the numbers below"
GIVEN_BY_NAME: Final = ("ski.file", "course.file", "course.name", "snow.results", "snow.site", "snow.published")
_FOR_COURSE: Final = "slalom-20-gates"
"""The scenario that a course which was just uploaded is for, until another one is chosen."""
SNOW_FILE: Final = "snow.json"
OF_SNOW: Final = ("snow.H_V_N_per_mm3", "snow.S_f_N_per_mm2")
CHOSEN_ABOVE: Final = ("snow.results", "snow.site", "snow.published", "ski.name", "ski.file", "course.name")
"""Keys that the menus of snow, ski and course give."""
WITH_FILES: Final = ("slope.kind", "slope.profile_gap", "slope.smooth_m", "slope.origin_x_m", "slope.origin_y_m")
"""Keys that go with files of the machine that the lab runs on: those are for the command line."""
BASIC: Final = (
    *OF_SNOW,
    "snow.unloading_ratio",
    "slope.angle_deg",
    "sledge.edge_angle_deg",
    "sledge.mass_kg",
    "start.speed_m_per_s",
    "start.heading_deg",
    "friction.mu_0",
    "drag.drag_area_m2",
    "run.duration_s",
    "run.length_m",
)
"""What a first run is asked about; all else has a value that most runs keep."""
BASIC_OF_SKIER: Final = ("skier.steers", "skier.turn_time_s", "skier.turns", "skier.pole_clearance_m")
"""The same of a scenario with a skier."""
SECTION_WORDS: Final = {
    "slope": "Slope",
    "snow": "Snow",
    "friction": "Friction",
    "drag": "Air drag",
    "sledge": "Sledge",
    "ski": "Ski",
    "course": "Course",
    "skier": "Skier",
    "start": "Start",
    "run": "End and output",
    "shear": "Shear",
    "solver": "Solver",
}


def add_page(lab: Lab) -> None:
    """Add the page to the application, and begin to work through the queue with it."""
    runs = Runs(lab.runs)
    app.on_startup(lambda: background_tasks.create(runs.work(), name="runs"))
    app.on_shutdown(runs.end)
    add_course_uploads(app, LabCourses(lab.runs))

    @ui.page(PATH)
    def simulate(course: str = "") -> None:
        with framed("Simulate", here=PATH):
            _Form(lab, runs, course)
            _upload()
            JobList(runs, _Card, "Nothing was simulated yet.")


class _Form:
    """The inputs of a scenario; what differs from the scenario's own value is handed on."""

    def __init__(self, lab: Lab, runs: Runs, course: str) -> None:
        from ...scenario import scenario_names

        self._runs = runs
        self._skis, self._courses = LabSkis(lab.runs), LabCourses(lab.runs)
        self._fields: dict[str, ScenarioField] = {}
        names = list(scenario_names())
        with ui.element("div").classes("fields"):
            is_known = course in self._courses.names()
            self._scenario = choice("Scenario", names, _FOR_COURSE if is_known else names[0])
            self._course = choice("Course", [GIVEN, *self._courses.names()], course if is_known else GIVEN)
            self._ski = choice("Ski", [GIVEN, *self._skis.names()], GIVEN)
            self._snow = SnowChoice(lab, NUMBERS, self._other_snow)
        self._scenario.on_value_change(self._draw)
        with redrawn_by(self._scenario):
            self._basic = ui.element("div").classes("inputs")
        with ui.element("div").classes("acts"):
            button("Simulate", self.ask, "main", once=True)
            self._estimate = Words("").classes("quiet").props("role=status")
        self._status = Words("").classes("status").props("role=status")
        with ui.element("fieldset").classes("redrawn"):
            self._expert = ui.element("div")
        self._draw()

    def _draw(self) -> None:
        from ...scenario import scenario_file
        from ...scenario.keys import SCENARIO_KEYS, SECTIONS

        values = scenario_file(str(self._scenario.value)).values
        kept = self._typed()
        self._fields = {}
        self._basic.clear()
        self._expert.clear()

        def add(name: str) -> None:
            made = self._fields[name] = ScenarioField(SCENARIO_KEYS[name], values.get(name), kept.get(name))
            made.element.on_value_change(self._tell_estimate)

        with self._basic:
            for name in basic(values):
                add(name)
        with (
            self._expert,
            ui.element("details").classes("expert").props("open" if kept.keys() - set(basic(values)) else ""),
        ):
            with ui.element("summary"):
                Words("Expert inputs")
            for section in SECTIONS:
                names = [name for name in expert(values) if name.startswith(f"{section}.")]
                if names:
                    heading(SECTION_WORDS[section], 3)
                    with ui.element("div").classes("inputs"):
                        for name in names:
                            add(name)
        self._show_numbers()
        self._tell_estimate()

    def _typed(self) -> dict[str, str]:
        """What stands in place of the scenario's own values."""
        return {name: each.text for name, each in self._fields.items() if each.is_changed and each.place.visible}

    def _changed(self) -> dict[str, str]:
        """What is typed; one number of the snow goes with the other one that stands beside it."""
        typed = self._typed()
        if self._snow.is_numbers and not typed.keys().isdisjoint(OF_SNOW):
            typed = {name: self._fields[name].text for name in OF_SNOW if self._fields[name].text} | typed
        return typed

    async def _other_snow(self) -> None:
        self._show_numbers()

    def _show_numbers(self) -> None:
        for name, given in zip(OF_SNOW, (self._snow.gives_hardness, self._snow.gives_stress), strict=True):
            self._fields[name].place.set_visibility(not given)

    def _tell_estimate(self) -> None:
        from ...scenario import scenario_file

        values: dict[str, Any] = dict(scenario_file(str(self._scenario.value)).values)
        for name in ("run.duration_s", "run.length_m", "start.speed_m_per_s"):
            try:
                values[name] = float(self._fields[name].text or 0.0)
            except ValueError:
                values[name] = None
        values["solver.method"] = self._fields["solver.method"].text
        seconds = estimated_s(self._runs.folder, self._runs.jobs(), values)
        self._estimate.set_text("" if seconds is None else f"Will take about {duration_words(seconds)}.")

    async def ask(self) -> None:
        """Put the simulation into the queue, when its values can be read."""
        try:
            job = await self._asked(str(self._scenario.value), self._changed())
        except SkisnowError as error:
            self._refuse(error)
            return
        self._status.set_text(f"{job.name} is in the queue.")
        self._status.classes(remove="bad")

    def _refuse(self, error: SkisnowError) -> None:
        """Say what is wrong at the button and at the field that has it, and put the focus there."""
        wrong = error_sentence(error)
        faulty = next((each for name, each in self._fields.items() if name in wrong), None)
        told = in_labels(wrong, *(each.key for each in self._fields.values()))
        if faulty is not None:
            faulty.refuse(told)
            faulty.focus()
        self._status.set_text(f"Not begun: {told}")
        self._status.classes(add="bad")

    async def _asked(self, scenario: str, changes: dict[str, str]) -> Job:
        for each in self._fields.values():
            each.refuse("")
        for name in changes:
            self._fields[name].check()
        ski, snow, given = str(self._ski.value), self._snow.chosen(), list[str]()
        if ski != GIVEN:
            word = self._skis.word(ski)
            changes["ski.name" if word == ski else "ski.file"] = word
            given.append(f"ski: {ski}")
        if self._course.value != GIVEN:
            given.append(self._give_course(str(self._course.value), changes))
        files: dict[str, tuple[str, bytes]] = {}
        if snow is not None and snow.analysis is not None:
            results, words = await self._results(snow, scenario, changes)
            files = {"snow.results": (SNOW_FILE, results)}
            given.append(f"snow: {snow.words}, {words}")
        else:
            if snow is not None:
                changes["snow.published"] = snow.published
                given.append(f"snow: {snow.words}, {snow_words(snow.snow)}")
            await run.io_bound(require_scenario, scenario, changes)
        return self._runs.ask(
            scenario, changes, files=files, given="; ".join(given), language=language_of(self._ski.client)
        )

    def _give_course(self, course: str, changes: dict[str, str]) -> str:
        """Let the changes name a course; a skier goes through it unless something else was chosen. It in words."""
        key, word = self._courses.change(course)
        changes[key] = word
        if "skier.steers" in self._fields:
            changes.setdefault("skier.steers", "gates")
        return f"course: {course}"

    async def _results(self, snow: ChosenSnow, scenario: str, changes: dict[str, str]) -> tuple[bytes, str]:
        """Let the changes name site and stress of a campaign's snow; the file of its results, and it in words."""
        if snow.site:
            changes["snow.site"] = snow.site
        if not self._snow.gives_stress:
            changes[OF_SNOW[1]] = self._fields[OF_SNOW[1]].text
        assert snow.analysis is not None
        found = await run.io_bound(results_with, snow.analysis, scenario, changes)
        if found is None:
            raise ParameterError("the lab is about to end")
        return found


def basic(values: Mapping[str, Any]) -> list[str]:
    """Keys that a first run of a scenario with these values is asked about: a skier sets the edge angle itself."""
    if not _has_skier(values):
        return list(BASIC)
    return [*BASIC_OF_SKIER, *(name for name in BASIC if name != "sledge.edge_angle_deg")]


def expert(values: Mapping[str, Any]) -> list[str]:
    """All other keys that the form has for such a scenario."""
    from ...scenario.keys import PATH_KEYS, SCENARIO_KEYS

    elsewhere = {*basic(values), *CHOSEN_ABOVE, *WITH_FILES, *PATH_KEYS}
    missing = ("sledge.edge_angle_deg",) if _has_skier(values) else ("skier.",)
    return [name for name in SCENARIO_KEYS if name not in elsewhere and not name.startswith(missing)]


def _has_skier(values: Mapping[str, Any]) -> bool:
    return values.get("skier.steers") is not None


def _upload() -> None:
    """A form that takes a course in: plain HTML, so that it works by keyboard everywhere."""
    with ui.element("details"):
        with ui.element("summary"):
            Words("Add a course")
        sentence(
            "CSV with the columns gate, x_m, y_m, side (left or right, where the pole is passed), in m down the fall "
            "line and to the left; or GPX with a waypoint for each gate, which needs the compass direction of x under "
            "Expert inputs. What was typed above is lost.",
            "quiet",
        )
        with ui.element("form").props(f'method=post action="{UPLOAD}" enctype="multipart/form-data"').classes("acts"):
            with ui.element("label").props("for=course-file"):
                Words("Course")
            ui.element("input").props("id=course-file name=file type=file required accept=.csv,.gpx")
            with ui.element("button").props("type=submit").classes("act"):
                Words("Add the course")


def _in_labels(changes: dict[str, str]) -> str:
    from ...scenario.keys import SCENARIO_KEYS

    return ", ".join(f"{called(SCENARIO_KEYS[key])}: {value}" for key, value in changes.items())


class _Card:
    """One run of the list, and what can be done with it."""

    def __init__(self, runs: Runs, job: Job, act: Act) -> None:
        self._runs = runs
        with ui.element("section").classes("card") as self.place:
            heading(job.name, 3)
            self._words = sentence("", "quiet").props("aria-live=polite")
            self._progress = sentence("", "quiet progress")  # a number that rises each second is not read aloud
            with ui.element("div").classes("acts"):
                self._cancel = named(button("Cancel", lambda: act(runs.cancel, job.name)), f"Cancel {job.name}")
                self._watch = named(link("Watch", show_address(job.name), "main"), f"Watch {job.name}")

    def show(self, job: Job) -> None:
        changed = _in_labels({key: value for key, value in job.changes.items() if key not in GIVEN_BY_NAME})
        self._words.set_text(" · ".join(filter(None, (job.scenario, changed, job.given, job.state, job.said))))
        self._progress.set_text(self._runs.progress if job.state == "running" else "")
        self._progress.set_visibility(bool(self._progress.text))
        self._cancel.set_visibility(job.state in ("waiting", "running"))
        self._watch.set_visibility((self._runs.folder / job.name / RUN_FILE).is_file())
