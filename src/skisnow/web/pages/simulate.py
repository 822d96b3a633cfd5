"""Simulations: a form made from the table of inputs, a snow, a ski, the queue with progress, the history."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from nicegui import app, background_tasks, run, ui

from ...errors import ParameterError, SkisnowError
from ...replay.of_file import RUN_FILE
from ..answering import redrawn_by
from ..error_pages import error_sentence
from ..fields import button, choice, link
from ..lab_skis import LabSkis
from ..language import said
from ..layout import framed, heading, sentence
from ..replay.addresses import show_address
from ..run_estimate import estimated_s
from ..runs import Job, Runs
from ..scenario_fields import ScenarioField, called, in_labels
from ..snow_choice import SnowChoice
from ..snow_of_campaign import require_scenario, results_with
from ..worded import Words, named

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..settings import Lab
    from ..snow_choice import ChosenSnow

PATH: Final = "/simulate"
TITLE: Final = "Simulate"
GIVEN: Final = "as in the scenario"
NUMBERS: Final = "the numbers below"
GIVEN_BY_NAME: Final = ("ski.file", "snow.results")
SNOW_FILE: Final = "snow.json"
EVERY_S: Final = 1.0
OF_SNOW: Final = ("snow.H_V_N_per_mm3", "snow.S_f_N_per_mm2")
CHOSEN_ABOVE: Final = ("snow.results", "snow.site", "snow.published", "ski.name", "ski.file")
"""Keys that the menus of snow and ski give."""
IN_FILES_ALONE: Final = ("course.", "skier.")
"""Keys of a course and of a skier: files and the command line give them."""
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
SECTION_WORDS: Final = {
    "slope": "Slope",
    "snow": "Snow",
    "friction": "Friction",
    "drag": "Air drag",
    "sledge": "Sledge",
    "ski": "Ski",
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

    @ui.page(PATH)
    def simulate() -> None:
        with framed("Simulate", here=PATH):
            _Form(lab, runs)
            history = _History(runs)
        ui.timer(EVERY_S, history.show)


class _Form:
    """The inputs of a scenario; what differs from the scenario's own value is handed on."""

    def __init__(self, lab: Lab, runs: Runs) -> None:
        from ...scenario import scenario_names

        self._runs = runs
        self._skis = LabSkis(lab.runs)
        self._fields: dict[str, ScenarioField] = {}
        names = list(scenario_names())
        with ui.element("div").classes("fields"):
            self._scenario = choice("Scenario", names, names[0])
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
            for name in BASIC:
                add(name)
        with self._expert, ui.element("details").classes("expert").props("open" if kept.keys() - set(BASIC) else ""):
            with ui.element("summary"):
                Words("Expert inputs")
            for section in SECTIONS:
                names = [name for name in SCENARIO_KEYS if name.startswith(f"{section}.") and name in _expert()]
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
        self._estimate.set_text("" if seconds is None else f"Will take about {_duration(seconds)}.")

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
        files: dict[str, tuple[str, bytes]] = {}
        if snow is not None and snow.analysis is not None:
            results, words = await self._results(snow, scenario, changes)
            files = {"snow.results": (SNOW_FILE, results)}
            given.append(f"snow: {snow.words}, {words}")
        else:
            if snow is not None:
                changes["snow.published"] = snow.published
            await run.io_bound(require_scenario, scenario, changes)
        return self._runs.ask(scenario, changes, files=files, given="; ".join(given))

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


def _expert() -> list[str]:
    from ...scenario.given import PATH_KEYS
    from ...scenario.keys import SCENARIO_KEYS

    elsewhere = (*BASIC, *CHOSEN_ABOVE, *WITH_FILES, *PATH_KEYS)
    return [name for name in SCENARIO_KEYS if name not in elsewhere and not name.startswith(IN_FILES_ALONE)]


def _duration(seconds: float) -> str:
    """In words, as exact as it is known."""
    if seconds < 90.0:
        return f"{max(5, 5 * round(seconds / 5))} s"
    return f"{round(seconds / 60)} min"


def _in_labels(changes: dict[str, str]) -> str:
    from ...scenario.keys import SCENARIO_KEYS

    return ", ".join(f"{called(SCENARIO_KEYS[key])}: {value}" for key, value in changes.items())


class _History:
    """The queue and what was simulated. A card stays the same while its run goes on: a press on it is never lost."""

    def __init__(self, runs: Runs) -> None:
        self._runs = runs
        self._cards: dict[str, _Card] = {}
        heading("Queue and history")
        self._nothing = sentence("Nothing was simulated yet.", "quiet")
        self._place = ui.element("div")
        self.show()

    def show(self) -> None:
        """Show what is so now."""
        jobs = self._runs.jobs()
        self._nothing.set_visibility(not jobs)
        for name in self._cards.keys() - {job.name for job in jobs}:
            self._cards.pop(name).place.delete()
        for index, job in enumerate(jobs):
            if job.name not in self._cards:
                with self._place:
                    self._cards[job.name] = card = _Card(self._runs, job, self._cancel)
                card.place.move(target_index=index)
            self._cards[job.name].show(job)

    def _cancel(self, name: str) -> None:
        try:
            self._runs.cancel(name)
        except ParameterError as error:
            ui.notify(said(error_sentence(error)))
        self.show()


class _Card:
    """One run of the list, and what can be done with it."""

    def __init__(self, runs: Runs, job: Job, cancel: Callable[[str], None]) -> None:
        self._runs = runs
        with ui.element("section").classes("card") as self.place:
            heading(job.name, 3)
            self._words = sentence("", "quiet").props("aria-live=polite")
            self._progress = sentence("", "quiet progress")  # a number that rises each second is not read aloud
            with ui.element("div").classes("acts"):
                self._cancel = named(button("Cancel", lambda: cancel(job.name)), f"Cancel {job.name}")
                self._watch = named(link("Watch", show_address(job.name), "main"), f"Watch {job.name}")

    def show(self, job: Job) -> None:
        changed = _in_labels({key: value for key, value in job.changes.items() if key not in GIVEN_BY_NAME})
        self._words.set_text(" · ".join(filter(None, (job.scenario, changed, job.given, job.state, job.said))))
        self._progress.set_text(self._runs.progress if job.state == "running" else "")
        self._progress.set_visibility(bool(self._progress.text))
        self._cancel.set_visibility(job.state in ("waiting", "running"))
        self._watch.set_visibility((self._runs.folder / job.name / RUN_FILE).is_file())
