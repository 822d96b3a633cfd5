"""Page for studies of carved turns or scenarios over ranges of one or two inputs; queue and history."""

from __future__ import annotations

from typing import Any, Final

from nicegui import app, background_tasks, run, ui

from ..._support.errors import ParameterError, SkisnowError
from ..._support.messages import Message
from ...estimation.results import results_json
from ...report.campaign.page import RESULTS
from ..elements import (
    Outcome,
    Words,
    button,
    choice,
    error_sentence,
    heading,
    link,
    named,
    option_texts,
    page_frame,
)
from ..lab_skis import FILE, TABLE, LabSkis
from ..page_requests import redrawn_by
from ..runs import Job
from ..scenario_fields import ScenarioField, SnowChoice, field_label, in_labels
from ..settings import Lab
from ..studies import Studies
from ..study_fields import CARVE, AxisFields, StudyQuestion, study_keys
from ..widgets import Act, JobCard, JobList
from ..words import language_of, said, typed_number
from .carve import OF_SNOW as CARVE_SNOW
from .carve import SLIDERS
from .simulate import GIVEN, NUMBERS, SECTION_WORDS, add_expert_fields, basic, expert, menu_with_default
from .simulate import OF_SNOW as SCENARIO_SNOW
from .study_table import table_address

PATH: Final = "/study"
TITLE: Final = Message("Study")
CARVED: Final = Message("carved turns")
OTHER: Final = ""
FIRST: Final = {
    CARVE: ("edge_angle_deg", "13"),
    OTHER: ("start.speed_m_per_s", "7"),
}
"""First varied input with its number of values."""
UNLOADING: Final = "unloading_ratio"


def add_page(lab: Lab) -> None:
    """Add the page that computes studies, and start the queue of their jobs."""
    studies = Studies(lab.runs)
    app.on_startup(lambda: background_tasks.create(studies.work(), name="studies"))
    app.on_shutdown(studies.end)

    @ui.page(PATH)
    def study() -> None:
        with page_frame(Message("Study"), here=PATH):
            _Form(lab, studies)
            JobList(studies, _Card, Message("Nothing has been studied yet."))


class _CarveField(ScenarioField):
    """Field for a number of a carved turn."""

    where = Message("a turn usually")

    def typed_value(self) -> object:
        """Number of the field, also infinity for "inf"."""
        return float("inf") if self.text == "inf" else typed_number(field_label(self.key), self.text)


class _Form:
    """Form of a study: subject, varied inputs and fixed inputs."""

    def __init__(self, lab: Lab, studies: Studies) -> None:
        from ...scenario import scenario_names

        self._studies = studies
        self._skis = LabSkis(lab.runs)
        self._fields: dict[str, ScenarioField] = {}
        self._axes: list[AxisFields] = []
        with ui.element("div").classes("fields"):
            self._of = choice(
                Message("What is studied"), {CARVE: CARVED, **{name: name for name in scenario_names()}}, CARVE
            )
            self._ski = choice(Message("Ski"), self._skis.names(), self._skis.names()[0])
            self._further = choice(Message("Further skis"), self._skis.names(), []).props("use-chips")
            self._snow = SnowChoice(lab, NUMBERS, self._follow)
        self._of.on_value_change(self._draw_fields)
        self._further.on_value_change(self._follow)
        with redrawn_by(self._of):
            heading(Message("What varies"), 2)
            self._varied = ui.element("div")
            heading(Message("What is fixed"), 2)
            self._inputs = ui.element("div")
        with ui.element("div").classes("acts"):
            button(Message("Start the study"), self.ask, "main", once=True)
            self._points = Words("").classes("quiet").props("role=status")
        self._status = Outcome()
        self._draw_fields()

    @property
    def _is_carve(self) -> bool:
        """True if the study is of carve, not of a scenario."""
        return self._of.value == CARVE

    def _draw_fields(self) -> None:
        """Draw the menus and fields for the chosen subject."""
        of = str(self._of.value)
        skis = self._skis.names()
        names = {name: name for name in skis} if self._is_carve else menu_with_default(skis)
        self._ski.set_options(option_texts(names), value=next(iter(names)))
        self._further.set_visibility(self._is_carve)
        for place in (self._varied, self._inputs):
            place.clear()
        keys = study_keys(of)
        if not self._is_carve:
            values = self._field_values()
            keys = {name: key for name, key in keys.items() if name in (*basic(values), *expert(values))}
        with self._varied:
            first = FIRST.get(of, FIRST[OTHER])
            self._axes = [
                AxisFields(Message("First input"), keys, first, self._follow),
                AxisFields(Message("Second input"), keys, None, self._follow),
            ]
        self._fields = {}
        with self._inputs:
            (self._draw_carve if self._is_carve else self._draw_scenario)()
        self._follow()

    def _draw_carve(self) -> None:
        """Draw the fields of carve's inputs."""
        with ui.element("div").classes("inputs"):
            starts = {**{name: start for name, (_, _, start) in SLIDERS.items()}, UNLOADING: "10"}
            for name, start in starts.items():
                self._add_field(_CarveField(study_keys(CARVE)[name], float(start), None))

    def _draw_scenario(self) -> None:
        """Draw the fields of the scenario's keys."""
        from ...scenario.keys import SCENARIO_KEYS

        values = self._field_values()

        def add(name: str) -> None:
            self._add_field(ScenarioField(SCENARIO_KEYS[name], values.get(name), None))

        with ui.element("div").classes("inputs"):
            for name in basic(values):
                add(name)
        add_expert_fields(values, SECTION_WORDS, add)

    def _add_field(self, made: ScenarioField) -> None:
        """Register a field and follow its changes."""
        self._fields[made.key.name] = made
        made.element.on_value_change(self._follow)

    def _field_values(self) -> dict[str, Any]:
        """Values of the scenario by key; empty for carve."""
        from ...scenario import scenario_file

        return {} if self._is_carve else dict(scenario_file(str(self._of.value)).values)

    def _given_by_snow(self) -> dict[str, bool]:
        """For each number of the snow by key: True if the chosen snow gives it, so that it needs no field."""
        return self._snow.given(*(CARVE_SNOW if self._is_carve else SCENARIO_SNOW))

    def _follow(self) -> None:
        """Show the fields that apply to the chosen inputs, and the number of points."""
        varied, from_snow = {axis.name for axis in self._axes}, self._given_by_snow()
        for name, field in self._fields.items():
            field.place.set_visibility(name not in varied and not from_snow.get(name))
        try:
            points = self._axes[0].count() * self._axes[1].count() * len(self._chosen_names())
        except ParameterError:
            self._points.set_text("")
            return
        self._points.set_text(Message("{points} points.", points=points))

    async def ask(self) -> None:
        """Add the study to the queue if it is valid."""
        try:
            question = self._build_question()
            job = await run.io_bound(self._studies.ask_for, question, language_of())
        except SkisnowError as error:
            keys = [field.key for field in self._fields.values()]
            wrong = in_labels(error_sentence(error), *keys)
            self._status.say(said(Message("Not begun: {error}", error=wrong)), bad=True)
            return
        if job is not None:
            self._status.say(Message("{name} is in the queue.", name=job.name))

    def _build_question(self) -> StudyQuestion:
        """Question of the study from the form; rejects equal inputs, and a varied one that the snow fixes."""
        axes = [axis for axis in self._axes if axis.name]
        if len({axis.name for axis in axes}) < len(axes):
            raise ParameterError("the first and the second input are the same; choose another one").tag("same_input")
        varied = {axis.name: axis.range() for axis in axes}
        from_snow = self._given_by_snow()
        for name in varied:
            if from_snow.get(name):
                raise ParameterError(
                    "{input} varies, but the chosen snow fixes it; choose the numbers below as the snow"
                ).tag("given_by_snow", input=field_label(study_keys(str(self._of.value))[name]))
        fixed = {name: field.check() for name, field in self._fields.items() if self._counts(name, field)}
        files, named_words = dict[str, bytes](), list[str]()
        for values, further_files, words in (self._chosen_skis(), self._chosen_snow()):
            fixed |= values
            files |= further_files
            named_words += words
        return StudyQuestion(str(self._of.value), varied, fixed, files, tuple(named_words))

    def _counts(self, name: str, field: ScenarioField) -> bool:
        """True if a field fixes its input: a changed field of a scenario, or both snow numbers if one is changed."""
        if not field.place.visible:
            return False
        if self._is_carve or field.is_changed:
            return True
        pair = [self._fields[other] for other in SCENARIO_SNOW]
        varied = {axis.name for axis in self._axes} & set(SCENARIO_SNOW)
        return name in SCENARIO_SNOW and bool(field.text) and (bool(varied) or any(other.is_changed for other in pair))

    def _chosen_names(self) -> list[str]:
        """Names of the chosen ski and, for carved turns, of further skis."""
        further = [str(name) for name in self._further.value or ()] if self._is_carve else []
        return list(dict.fromkeys([str(self._ski.value), *further]))

    def _chosen_skis(self) -> tuple[dict[str, Any], dict[str, bytes], list[str]]:
        """Fixed inputs by name, files of edited skis by path, and the choice in words."""
        names = self._chosen_names()
        if names == [GIVEN]:
            return {}, {}, []
        words, texts = list[str](), dict[str, bytes]()
        for ski in names:
            if self._skis.word(ski) == ski:
                words.append(ski)
                continue
            folder = "ski" if len(names) == 1 else f"ski/{ski}"
            text, table = self._skis.texts(ski)
            texts |= {f"{folder}/{FILE}": text.encode("utf-8")}
            texts |= {f"{folder}/{TABLE}": table.encode("utf-8")} if table else {}
            words.append(f"{folder}/{FILE}")
        key = "ski" if self._is_carve else "ski.file" if texts else "ski.name"
        ski_words = Message("ski: {ski}", ski=names[0]) if len(names) == 1 else Message("skis: {skis}", skis=names)
        return {key: words[0] if len(words) == 1 else words}, texts, [ski_words]

    def _chosen_snow(self) -> tuple[dict[str, Any], dict[str, bytes], list[str]]:
        """Fixed inputs by name, the file of an analysis by path, and the choice in words."""
        snow, lead = self._snow.chosen(), "" if self._is_carve else "snow."
        if snow is None:
            return {}, {}, []
        files = {} if snow.analysis is None else {RESULTS: results_json(snow.analysis.results)}
        return (
            {f"{lead}{key}": text for key, text in snow.keys.items()},
            files,
            [Message("snow: {snow}", snow=snow.words)],
        )


class _Card(JobCard):
    """Card of a study."""

    def add_buttons(self, job: Job, act: Act) -> None:
        """Add Go on, and the link to the table."""
        go_on = button(Message("Go on"), lambda: act(lambda: self.runs.go_on(job.name)))
        self._go_on = named(go_on, Message("Go on with {name}", name=job.name))
        table = link(Message("Table and figure"), table_address(job.name), "main")
        self._table = named(table, Message("Table and figure of {name}", name=job.name))

    def inputs(self, job: Job) -> tuple[str, ...]:
        """Subject and varied inputs of a study, each in words."""
        return CARVED if job.scenario == CARVE else job.scenario, job.given

    def show(self, job: Job) -> None:
        """Show the job's state on its card: Go on if it was cancelled or failed, the table's link if it is done."""
        super().show(job)
        self._go_on.set_visibility(job.state in ("cancelled", "failed"))
        self._table.set_visibility(job.state == "done")
