"""Page for simulations: form of a scenario with snow, ski and course, queue and history."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any, Final

from nicegui import app, background_tasks, run, ui
from starlette.datastructures import FormData

from ..._support.errors import ParameterError, SkisnowError
from ..._support.messages import Message
from ...estimation import Analysis
from ...replay.run_file import RUN_FILE
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
    page_frame,
    sentence,
)
from ..lab_skis import LabSkis
from ..lab_tracks import LabCourses
from ..page_requests import add_upload, address, file_input, redrawn_by, submit_button, upload_form, uploaded_files
from ..replay_addresses import show_address
from ..runs import Job, Runs
from ..scenario_fields import (
    ScenarioField,
    SnowChoice,
    field_label,
    in_labels,
    require_scenario,
    results_and_snow_words,
    snow_words,
)
from ..settings import Lab
from ..widgets import Act, JobCard, JobList
from ..words import language_of, number_text

PATH: Final = "/simulate"
TITLE: Final = Message("Simulate")
COURSE_UPLOAD: Final = f"{PATH}/course"
GIVEN: Final = "as in the scenario"
NUMBERS: Final = ("the numbers below", Message("the numbers below"))
GIVEN_BY_NAME: Final = ("ski.file", "course.file", "course.name", "snow.results", "snow.site", "snow.published")
_FOR_COURSE: Final = "slalom-20-gates"  # first scenario after the upload of a course
SNOW_FILE: Final = "snow.json"
OF_SNOW: Final = ("snow.H_V_N_per_mm3", "snow.S_f_N_per_mm2")
CHOSEN_ABOVE: Final = ("snow.results", "snow.site", "snow.published", "ski.name", "ski.file", "course.name")
"""Keys that are set by the menus of snow, ski and course."""
WITH_FILES: Final = ("slope.kind", "slope.profile_gap", "slope.smooth_m", "slope.origin_x_m", "slope.origin_y_m")
"""Keys that need files on the server; they are only available on the command line."""
_ID: Final = re.compile(r" \([0-9a-f]{12}\)")  # id of a campaign in the words of its snow
MASS: Final = "sledge.mass_kg"
MASS_OF_SKIER: Final = Message("mass of the skier")
BASIC: Final = (
    *OF_SNOW,
    "snow.unloading_ratio",
    "slope.angle_deg",
    "sledge.edge_angle_deg",
    MASS,
    "start.speed_m_per_s",
    "start.heading_deg",
    "friction.mu_0",
    "drag.drag_area_m2",
    "run.duration_s",
    "run.length_m",
)
"""Keys of the basic form; the values of the others fit most runs."""
BASIC_OF_SKIER: Final = ("skier.steers", "skier.turn_time_s", "skier.turns", "skier.pole_clearance_m")
"""Further keys of the basic form of a scenario with a skier."""
SECTION_WORDS: Final = {
    "slope": Message("Slope"),
    "snow": Message("Snow"),
    "friction": Message("Friction"),
    "drag": Message("Air drag"),
    "sledge": Message("Sledge"),
    "ski": Message("Ski"),
    "course": Message("Course"),
    "skier": Message("Skier"),
    "start": Message("Start"),
    "run": Message("End and output"),
    "shear": Message("Shear"),
    "solver": Message("Solver"),
}


def add_page(lab: Lab) -> None:
    """Add the page that simulates runs, and start the queue of its jobs."""
    runs = Runs(lab.runs)
    app.on_startup(lambda: background_tasks.create(runs.work(), name="runs"))
    app.on_shutdown(runs.end)

    def keep_course(form: FormData) -> str:
        upload = uploaded_files(form, "file", Message("no file was chosen; choose the file of a course"))[0]
        return address(PATH, course=LabCourses(lab.runs).keep((upload.filename or "")[:200], upload.file))

    add_upload(app, COURSE_UPLOAD, keep_course, max_fields=2)

    @ui.page(PATH)
    def simulate(course: str = "") -> None:
        with page_frame(Message("Simulate"), here=PATH), ui.element("div").classes("two wide-form"):
            with ui.element("section"):
                _Form(lab, runs, course)
                _course_form()
            with ui.element("section"):
                JobList(runs, _Card, Message("Nothing has been simulated yet."))


class _Form:
    """Form of a scenario; values that differ from it become changes."""

    def __init__(self, lab: Lab, runs: Runs, course: str) -> None:
        from ...scenario import scenario_names

        self._runs = runs
        self._skis, self._courses = LabSkis(lab.runs), LabCourses(lab.runs)
        self._fields: dict[str, ScenarioField] = {}
        names = list(scenario_names())
        with ui.element("div").classes("fields"):
            is_known = course in self._courses.names()
            self._scenario = choice(Message("Scenario"), names, _FOR_COURSE if is_known else names[0])
            courses = menu_with_default(self._courses.names())
            self._course = choice(Message("Course"), courses, course if is_known else GIVEN)
            self._ski = choice(Message("Ski"), menu_with_default(self._skis.names()), GIVEN)
            self._snow = SnowChoice(lab, NUMBERS, self._show_numbers)
        self._scenario.on_value_change(self._draw_fields)
        with redrawn_by(self._scenario):
            self._basic = ui.element("div").classes("inputs")
        with ui.element("div").classes("acts"):
            button(Message("Simulate"), self.ask, "main", once=True)
        self._status = Outcome()
        with ui.element("fieldset").classes("redrawn"):
            self._expert = ui.element("div")
        self._draw_fields()

    def _draw_fields(self) -> None:
        """Draw the fields of the chosen scenario's keys, with the texts that were typed before."""
        from ...scenario import scenario_file
        from ...scenario.keys import SCENARIO_KEYS, SECTIONS

        values = scenario_file(str(self._scenario.value)).values
        typed = self._typed()
        self._fields = {}
        self._basic.clear()
        self._expert.clear()

        def add(name: str) -> None:
            key = SCENARIO_KEYS[name]
            if name == MASS and _has_skier(values):
                key = replace(key, label=MASS_OF_SKIER)
            self._fields[name] = ScenarioField(key, values.get(name), typed.get(name))

        with self._basic:
            for name in basic(values):
                add(name)
        with self._expert:
            add_expert_fields(values, SECTIONS, add, is_open=bool(typed.keys() - set(basic(values))))
        self._show_numbers()

    def _typed(self) -> dict[str, str]:
        """Texts of the visible fields that differ from the scenario, by key."""
        return {name: field.text for name, field in self._fields.items() if field.is_changed and field.place.visible}

    def _changed(self) -> dict[str, str]:
        """Changed values by key; if one number of the snow is changed, both H_V and S_f are included."""
        typed = self._typed()
        if self._snow.is_numbers and not typed.keys().isdisjoint(OF_SNOW):
            typed = {name: self._fields[name].text for name in OF_SNOW if self._fields[name].text} | typed
        return typed

    def _show_numbers(self) -> None:
        """Show the fields of the snow's numbers only as far as the chosen snow does not give them."""
        for name, is_given in self._snow.given(*OF_SNOW).items():
            self._fields[name].place.set_visibility(not is_given)

    async def ask(self) -> None:
        """Add the simulation to the queue if its values are valid."""
        try:
            job = await self._add_job(str(self._scenario.value), self._changed())
        except SkisnowError as error:
            self._refuse(error)
            return
        self._status.say(Message("{shown_name} is in the queue.", shown_name=job.shown_name))

    def _refuse(self, error: SkisnowError) -> None:
        """Show an error at the button and at its field, and put the focus on the field."""
        wrong = error_sentence(error)
        faulty = next((field for name, field in self._fields.items() if name in wrong), None)
        words = in_labels(wrong, *(field.key for field in self._fields.values()))
        if faulty is not None:
            faulty.refuse(words)
            faulty.focus()
        self._status.say(Message("Not begun: {words}", words=words), bad=True)

    async def _add_job(self, scenario: str, changes: dict[str, str]) -> Job:
        """Job of a run with changes and the chosen ski, course and snow; rejects what is not valid."""
        for made in self._fields.values():
            made.refuse("")
        for name in changes:
            self._fields[name].check()
        ski, snow, chosen = str(self._ski.value), self._snow.chosen(), list[str]()
        if ski != GIVEN:
            word = self._skis.word(ski)
            changes["ski.name" if word == ski else "ski.file"] = word
            chosen.append(Message("ski: {ski}", ski=ski))
        if self._course.value != GIVEN:
            chosen.append(self._add_course(str(self._course.value), changes))
        files: dict[str, tuple[str, bytes]] = {}
        words = ""
        if snow is not None:
            changes |= {f"snow.{key}": text for key, text in snow.keys.items()}
            words = snow_words(snow.snow)
        if snow is not None and snow.analysis is not None:
            results, words = await self._results(snow.analysis, scenario, changes)
            files = {"snow.results": (SNOW_FILE, results)}
        else:
            await run.io_bound(require_scenario, scenario, changes)
        if snow is not None:
            chosen.append(Message("snow: {name}, {values}", name=snow.words, values=words))
        parts = [scenario.replace("-", " "), ski if ski != GIVEN else "", _ID.sub("", snow.words) if snow else ""]
        return self._runs.ask(
            scenario,
            changes,
            files=files,
            given="; ".join(map(str, chosen)),
            language=language_of(self._ski.client),
            title=" ".join(filter(None, parts)),
        )

    def _add_course(self, course: str, changes: dict[str, str]) -> str:
        """Add a chosen course to the changes, with a skier who steers by its gates; returns its name in words."""
        key, word = self._courses.change(course)
        changes[key] = word
        if "skier.steers" in self._fields:
            changes.setdefault("skier.steers", "gates")
        return f"course: {course}"

    async def _results(self, analysis: Analysis, scenario: str, changes: dict[str, str]) -> tuple[bytes, str]:
        """Bytes of a campaign's results.json, and its snow in words; adds a typed S_f to the changes if it has none."""
        if not self._snow.gives_stress:
            changes[OF_SNOW[1]] = self._fields[OF_SNOW[1]].text
        results = await run.io_bound(results_and_snow_words, analysis, scenario, changes)
        if results is None:
            raise ParameterError("the lab is about to end").tag("lab_ends")
        return results


def basic(values: Mapping[str, Any]) -> list[str]:
    """Keys of the basic form of a scenario; without the edge angle for a skier, who sets it."""
    if not _has_skier(values):
        return list(BASIC)
    return [*BASIC_OF_SKIER, *(name for name in BASIC if name != "sledge.edge_angle_deg")]


def expert(values: Mapping[str, Any]) -> list[str]:
    """Keys of a scenario that the page offers under Expert inputs."""
    from ...scenario.keys import PATH_KEYS, SCENARIO_KEYS

    elsewhere = {*basic(values), *CHOSEN_ABOVE, *WITH_FILES, *PATH_KEYS}
    missing = ("sledge.edge_angle_deg",) if _has_skier(values) else ("skier.",)
    return [name for name in SCENARIO_KEYS if name not in elsewhere and not name.startswith(missing)]


def add_expert_fields(
    values: Mapping[str, Any], sections: Iterable[str], add: Callable[[str], object], *, is_open: bool = False
) -> None:
    """Add the folded expert form of a scenario by sections; ``add`` adds the field of a key."""
    with folded(Message("Expert inputs"), is_open=is_open).classes("expert"):
        for section in sections:
            if names := [name for name in expert(values) if name.startswith(f"{section}.")]:
                heading(SECTION_WORDS[section], 3)
                with ui.element("div").classes("inputs"):
                    for name in names:
                        add(name)


def _has_skier(values: Mapping[str, Any]) -> bool:
    """True if a scenario has a skier."""
    return values.get("skier.steers") is not None


def _course_form() -> None:
    """Add the folded form that uploads a course as CSV or GPX."""
    with folded(Message("Add a course")):
        sentence(
            Message(
                "CSV with the columns gate, x_m, y_m, side (left or right, where the pole is passed), in "
                "m down the fall line and to the left; or GPX with a waypoint for each gate, which needs "
                "the compass direction of x under Expert inputs. What was typed above is lost."
            ),
            "quiet",
        )
        with upload_form(COURSE_UPLOAD).classes("acts"):
            file_input("file", Message("Course"), "course-file", "accept=.csv,.gpx")
            submit_button(Message("Add the course"))


def menu_with_default(names: Sequence[str]) -> dict[str, str]:
    """Options of a menu of names; the first further one leaves the scenario unchanged."""
    return {GIVEN: Message("as in the scenario"), **{name: name for name in names}}


class _Card(JobCard):
    """Card of a run."""

    def __init__(self, runs: Runs, job: Job, act: Act) -> None:
        super().__init__(runs, job, act)
        with self.place, folded(Message("Rename")):
            title = field(Message("Name of the run"), job.shown_name)
            button(Message("Use this name"), lambda: act(lambda: runs.rename(job.name, str(title.value))))

    def add_buttons(self, job: Job, act: Act) -> None:  # noqa: ARG002
        """Add the link to the replay of the run."""
        watch = link(Message("Watch"), show_address(job.name), "main")
        self._watch = named(watch, Message("Watch {name}", name=job.name))

    def inputs(self, job: Job) -> tuple[str, ...]:
        """Scenario, its changes, and inputs that were chosen by name."""
        from ...scenario.keys import SCENARIO_KEYS

        changed = {SCENARIO_KEYS[key]: text for key, text in job.changes.items() if key not in GIVEN_BY_NAME}
        words = ", ".join(f"{field_label(key)}: {number_text(text)}" for key, text in changed.items())
        return job.scenario, words, job.given

    def show(self, job: Job) -> None:
        """Show the job's state on its card, and the link to the replay if the run was written."""
        super().show(job)
        self._watch.set_visibility((self.runs.folder / job.name / RUN_FILE).is_file())
