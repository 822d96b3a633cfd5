"""Simulations: a form made from the scenario's keys, snow from a campaign, the queue with progress, the history."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, Final

from nicegui import app, background_tasks, run, ui

from ...errors import ParameterError, SkisnowError
from ...field.store import Journals
from ...replay.of_file import RUN_FILE
from ..edit_session import EditSession
from ..error_pages import error_sentence
from ..fields import button, choice, field, link
from ..lab_skis import LabSkis
from ..layout import framed, heading, sentence
from ..replay.addresses import show_address
from ..runs import Job, Runs
from ..snow_of_campaign import require_scenario, snow_of_campaign

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..settings import Lab

PATH: Final = "/simulate"
TITLE: Final = "Simulate"
GIVEN: Final = "as in the scenario"
GIVEN_BY_NAME: Final = ("ski.file", "snow.results")
SNOW_FILE: Final = "snow.json"
EVERY_S: Final = 1.0
OF_SNOW: Final = ("snow.H_V_N_per_mm3", "snow.S_f_N_per_mm2", "snow.published")
_COMMA: Final = re.compile(r"[-+]?\d*,\d+")


def add_page(lab: Lab) -> None:
    """Add the page to the application, and begin to work through the queue with it."""
    runs = Runs(lab.runs)
    app.on_startup(lambda: background_tasks.create(runs.work(), name="runs"))
    app.on_shutdown(runs.end)

    @ui.page(PATH)
    def simulate() -> None:
        with framed("Simulate", here=PATH):
            status = ui.label("").classes("status").props("role=status")
            form = _Form(lab, runs, status)
            button("Simulate", form.ask, "main", once=True)
            history = _History(runs)
        ui.timer(EVERY_S, history.show)


class _Form:
    """The keys of a scenario by their sections; what differs from the scenario's own value is handed on."""

    def __init__(self, lab: Lab, runs: Runs, status: ui.label) -> None:
        from ...scenario import scenario_names

        self._lab, self._runs, self._status = lab, runs, status
        self._skis = LabSkis(lab.runs)
        names = list(scenario_names())
        with ui.element("div").classes("fields"):
            self._scenario = choice("Scenario", names, names[0])
            self._names = _snows(lab)
            self._snow = choice("Snow", {GIVEN: GIVEN, **self._names}, GIVEN)
            self._ski = choice("Ski", [GIVEN, *self._skis.names()], GIVEN)
        self._known = sentence("").props("role=status")
        self._place = ui.element("div")
        self._fields: dict[str, ui.input] = {}
        self._before: dict[str, str] = {}
        self._scenario.on_value_change(self._draw)
        self._snow.on_value_change(self._tell_snow)
        self._draw()

    def _draw(self) -> None:
        from ...scenario import scenario_file
        from ...scenario.keys import SCENARIO_KEYS, SECTIONS

        values = scenario_file(str(self._scenario.value)).values
        kept = self._changed()
        self._place.clear()
        self._fields, self._before = {}, {}
        with self._place:
            for section in SECTIONS:
                is_kept = any(name.startswith(f"{section}.") for name in kept)
                with ui.element("details").props("open" if is_kept else ""):
                    with ui.element("summary"):
                        ui.label(section.capitalize())
                    with ui.element("div").classes("keys"):
                        for name, key in SCENARIO_KEYS.items():
                            if name.startswith(f"{section}."):
                                self._key(name, values.get(name), f"{key.meaning}; {key.allowed}", kept.get(name))

    def _key(self, name: str, value: Any, words: str, kept: str | None) -> None:
        self._before[name] = before = _written(value)
        self._fields[name] = field(name.split(".", 1)[1], before if kept is None else kept)
        self._fields[name].props(f'aria-label="{name}"')
        sentence(words, "quiet")

    def _changed(self) -> dict[str, str]:
        """What was typed in place of the scenario's own values."""
        typed = {name: str(each.value or "").strip() for name, each in self._fields.items()}
        return {name: _with_point(text) for name, text in typed.items() if text != self._before[name]}

    async def ask(self) -> None:
        """Put the simulation into the queue, when its values can be read."""
        try:
            job = await self._asked(str(self._scenario.value), self._changed())
        except SkisnowError as error:
            self._status.set_text(f"Not begun: {error_sentence(error)}")
            self._status.classes(add="bad")
            return
        self._status.set_text(f"{job.name} is in the queue.")
        self._status.classes(remove="bad")

    async def _asked(self, scenario: str, changes: dict[str, str]) -> Job:
        ski, snow = str(self._ski.value), str(self._snow.value)
        given = []
        for name, text in changes.items():
            if not text:
                raise ParameterError(f"{name} is empty; the scenario has {self._before[name]}")
            if snow != GIVEN and name in OF_SNOW:
                raise ParameterError(
                    f"{name} was changed, and the snow is that of a campaign. Put {self._before[name] or 'nothing'} "
                    f"back, or choose Snow: {GIVEN}"
                )
        if ski != GIVEN:
            word = self._skis.word(ski)
            changes["ski.name" if word == ski else "ski.file"] = word
            given.append(f"ski: {ski}")
        if snow == GIVEN:
            await run.io_bound(require_scenario, scenario, changes)
            return self._runs.ask(scenario, changes, given="; ".join(given))
        found = await run.io_bound(snow_of_campaign, self._lab, snow, scenario, changes)
        if found is None:
            raise ParameterError("the lab is about to end")
        results, words = found
        given.append(f"snow: {self._names[snow]}, {words}")
        files = {"snow.results": (SNOW_FILE, results)}
        return self._runs.ask(scenario, changes, files=files, given="; ".join(given))

    async def _tell_snow(self) -> None:
        """Say at once what snow a campaign gives, and how well it is known."""
        self._known.set_text("")
        snow = str(self._snow.value)
        if snow == GIVEN:
            return
        try:
            found = await run.io_bound(snow_of_campaign, self._lab, snow, str(self._scenario.value), {})
        except SkisnowError as error:
            self._known.set_text(error_sentence(error))
            return
        if found is not None and snow == self._snow.value:
            self._known.set_text(f"Snow: {found[1]}")


def _snows(lab: Lab) -> dict[str, str]:
    """Campaigns that can give the snow, by kind and id."""
    entered = {
        f"entry-{head.id}": EditSession(lab, head.id).described.name or head.id for head in Journals(lab.store).list()
    }
    return entered | {f"kept-{stored.id}": f"{stored.name} ({stored.id})" for stored in lab.store.list()}


def _with_point(text: str) -> str:
    """A number with a decimal comma as the command line takes it; anything else as it is."""
    return text.replace(",", ".") if _COMMA.fullmatch(text) else text


def _written(value: Any) -> str:
    """A value as the command line takes it."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, tuple | list):
        return f"[{', '.join(_written(each) for each in value)}]"
    return f"{value:.12g}" if isinstance(value, float) else str(value)


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
            ui.notify(str(error))
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
                self._cancel = button("Cancel", lambda: cancel(job.name)).props(f'aria-label="Cancel {job.name}"')
                self._watch = link("Watch", show_address(job.name), "main").props(f'aria-label="Watch {job.name}"')

    def show(self, job: Job) -> None:
        changed = ", ".join(f"{key} = {value}" for key, value in job.changes.items() if key not in GIVEN_BY_NAME)
        self._words.set_text(" · ".join(filter(None, (job.scenario, changed, job.given, job.state, job.said))))
        self._progress.set_text(self._runs.progress if job.state == "running" else "")
        self._progress.set_visibility(bool(self._progress.text))
        self._cancel.set_visibility(job.state in ("waiting", "running"))
        self._watch.set_visibility((self._runs.folder / job.name / RUN_FILE).is_file())
