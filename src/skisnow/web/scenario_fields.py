"""Fields of a scenario's inputs from their declarations, and the choice of a snow or of its numbers."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final, TypeAlias

from nicegui import run, ui

from .._support.errors import ParameterError, SkisnowError
from .._support.messages import Message
from .._support.units import MM, N_PER_MM2, N_PER_MM3
from ..campaign.store import Journals
from ..estimation import Analysis
from ..estimation.results import results_json
from ..parameters import InputValue, Quantity
from ..report.campaign.page import RESULTS
from ..scenario.reading import ScenarioFile, build_input, load_input
from ..ski.ski_file import Sources
from ..snow import SnowProperties, published_names, published_snow
from .campaign_analysis import Choice, Refusal, analyse_files
from .edit_session import EditSession
from .elements import Words, choice, error_sentence, field, named, option_texts, sentence
from .settings import Lab
from .transfer import files_in_memory
from .words import estimate_words, number_text, plain_number, replaced, said

InputField: TypeAlias = ui.input | ui.select | ui.switch

ON: Final = "true"
OFF: Final = "false"
_OF_FILES: Final = re.compile(r'"|\b[a-z]+_[a-z]+\b|omit |default: ')
"""Clauses of a meaning about keys of a file, which do not apply to a form."""
_NUMBER: Final = re.compile(r"[-+−]?\d*[.,]?\d*(e[-+−]?\d+)?")
_DIGITS: Final = 6  # significant digits of a value in a field


def field_label(key: Quantity) -> str:
    """Label of the field of an input: name, symbol and unit.

    >>> from skisnow.scenario.keys import SCENARIO_KEYS
    >>> field_label(SCENARIO_KEYS["slope.angle_deg"]), field_label(SCENARIO_KEYS["snow.H_V_N_per_mm3"])
    ('Slope angle α (°)', 'Snow hardness H_V (N/mm³)')
    """
    label = str(key.label or key.name)
    words = f"{label[0].upper()}{label[1:]} {key.symbol.replace('$', '')}".rstrip()
    return f"{words} ({key.unit})" if key.unit else words


def range_words(key: Quantity) -> str:
    """Meaning of an input, unless its name states it, and allowed values.

    >>> from skisnow.scenario.keys import SCENARIO_KEYS
    >>> range_words(SCENARIO_KEYS["slope.angle_deg"]), range_words(SCENARIO_KEYS["snow.S_f_N_per_mm2"])
    ('Inclination of the plane. Allowed: from 0 to 75.', 'Allowed: above 0.')
    """
    english, shown = key.meaning.split("; "), str(Message(key.meaning)).split("; ")
    clauses = [text for clause, text in zip(english, shown, strict=True) if not _OF_FILES.search(clause)]
    is_named = not clauses or not key.meaning or key.meaning.startswith(key.label)
    words = []
    if not is_named:
        text = "; ".join(clauses)
        begins_with_word = text[:2].isalpha() and text[:2].isascii()  # a symbol keeps its case
        words = [f"{text[0].upper()}{text[1:]}." if begins_with_word else f"{text}."]
    if not (key.choices or key.kind == "switch"):
        words.append(str(Message("Allowed: {allowed}.", allowed=key.allowed)))
    return " ".join(words)


def typed_form(value: Any) -> str:
    """Text of a value as it is typed on the command line, with numbers rounded for a field.

    >>> typed_form([6.0, 8.0]), typed_form(True), typed_form(0.20669325758298024)
    ('[6, 8]', 'true', '0.206693')
    """
    if value is None:
        return ""
    if isinstance(value, bool):
        return ON if value else OFF
    if isinstance(value, tuple | list):
        return f"[{', '.join(typed_form(item) for item in value)}]"
    return f"{value:.{_DIGITS}g}" if isinstance(value, float) else str(value)


def with_point(text: str) -> str:
    """Text of a typed number with a decimal point and a hyphen, as on the command line; other texts unchanged."""
    return plain_number(text) if _NUMBER.fullmatch(text) else text


class ScenarioField:
    """Field, menu or switch of an input, with its range."""

    def __init__(self, key: Quantity, value: Any, typed: str | None) -> None:
        self.key = key
        self.before = typed_form(value)
        with ui.element("div").classes("input") as self.place:
            self.element = self._create_element(self.before if typed is None else typed)
            named(self.element, field_label(key))
            self._range = sentence(range_words(key), "quiet range")

    def _create_element(self, text: str) -> InputField:
        """Switch, menu or field for the kind of the key, with a text as its value."""
        if self.key.kind == "switch":
            return ui.switch(said(field_label(self.key)), value=text == ON).classes("field")
        if self.key.choices:
            return choice(field_label(self.key), list(self.key.choices), text or None)
        if self.key.kind in ("number", "whole number"):
            return field(field_label(self.key), number_text(text), numeric=True)
        return field(field_label(self.key), text)

    @property
    def text(self) -> str:
        """Current value as text, as on the command line."""
        value = self.element.value
        if isinstance(value, bool):
            return ON if value else OFF
        return with_point(str(value or "").strip())

    @property
    def is_changed(self) -> bool:
        """True if the value differs from that of the scenario."""
        return self.text != self.before

    def check(self) -> InputValue:
        """Checked value; if it is not valid, the field shows why and a ParameterError is raised."""
        self.refuse("")
        try:
            if not self.text:
                raise ParameterError("{key} is empty; {file} has {before}").tag(
                    "empty", key=self.key.name, file=self.where, before=self.before
                )
            return self.key.in_range(self.typed_value())
        except ParameterError as error:
            self.refuse(in_labels(error.message, self.key))
            raise

    where = Message("the scenario")
    """Origin of the first value, for messages."""

    def typed_value(self) -> object:
        """Current value, converted from its text as in a file, unchecked."""
        from ..scenario.keys import parse_change

        return parse_change(f"{self.key.name}={self.text}")[1]

    def refuse(self, fault: str) -> None:
        """Show an error at the field; "" removes it."""
        if isinstance(self.element, ui.input):
            self.element.error = said(fault, self.element.client) if fault else None
        else:
            self._range.set_text(fault or range_words(self.key))
            self._range.classes(add="bad" if fault else "", remove="" if fault else "bad")

    def focus(self) -> None:
        """Put the focus on the field and select its text."""
        client, id_ = self.element.client, self.element.id
        client.run_javascript(f"lab.goTo({id_})")


def in_labels(message: str, *keys: Quantity) -> str:
    """A message of the library with the names of fields instead of keys.

    >>> from skisnow.scenario.keys import SCENARIO_KEYS
    >>> in_labels("sledge.mass_kg is -5.0; allowed is above 0 to 1000 kg", SCENARIO_KEYS["sledge.mass_kg"])
    'Mass of the sledge m (kg) is -5.0; allowed is above 0 to 1000 kg'
    """
    longest_first = sorted(keys, key=lambda key: -len(key.name))
    return replaced(message, {key.name: field_label(key) for key in longest_first})


PUBLISHED: Final = "published-"
ALL_SITES: Final = ""


@dataclass(frozen=True, slots=True)
class ChosenSnow:
    """A snow that was chosen by name: its properties, its name in words, and the inputs that select it.

    keys: inputs of a carved turn that select it; those of a scenario begin with "snow.".
    analysis: analysis of the campaign, None for a published snow.
    """

    snow: SnowProperties
    words: str
    keys: Mapping[str, str]
    analysis: Analysis | None = None


class SnowChoice:
    """Menu of snows; ``changed`` is called after a choice. ``numbers``: its entry for the numbers typed on the page."""

    def __init__(self, lab: Lab, numbers: tuple[str, str], changed: Callable[[], None]) -> None:
        self._lab, self._numbers, self._changed = lab, numbers[0], changed
        self._campaigns = _campaigns(lab)
        named = {f"{PUBLISHED}{name}": Message("published: {name}", name=name) for name in published_names()}
        self._menu = choice(Message("Snow"), dict([numbers]) | named | self._campaigns, numbers[0])
        self._site = choice(Message("Site"), {ALL_SITES: Message("all sites")}, ALL_SITES)
        self._site.set_visibility(False)
        self.words = Words("").classes("sentence snow").props("role=status")
        self._found: ChosenSnow | None = None
        self._refused = ""
        self._analysis: tuple[str, Analysis] | None = None
        self._menu.on_value_change(self._choose_campaign_or_snow)
        self._site.on_value_change(self._use_choice)

    @property
    def is_numbers(self) -> bool:
        """True if the snow is that of the numbers typed on the page."""
        return bool(self._menu.value == self._numbers)

    @property
    def gives_stress(self) -> bool:
        """True if the chosen snow gives S_f; a campaign without shear tests does not."""
        return not self.is_numbers and (self._found is None or self._found.snow.failure_shear_stress is not None)

    def given(self, hardness: str, stress: str) -> dict[str, bool]:
        """For the inputs H_V and S_f, by their keys: True if the chosen snow gives it, so that it needs no field."""
        return {hardness: not self.is_numbers, stress: self.gives_stress}

    def chosen(self) -> ChosenSnow | None:
        """The chosen snow; None for the numbers on the page. ParameterError: the campaign gives no snow."""
        if self.is_numbers:
            return None
        if self._found is None:
            waiting = Message("the campaign is being analysed; wait a moment")
            raise ParameterError(self._refused or waiting).tag("no_snow")
        return self._found

    async def _choose_campaign_or_snow(self) -> None:
        """Use the chosen snow; for a campaign analyse it first, and show its sites."""
        key = str(self._menu.value)
        of_campaign = key in self._campaigns
        self._site.set_visibility(False)
        if of_campaign and not await self._analyse_campaign(key):
            return
        if of_campaign and self._analysis is not None:
            means = self._analysis[1].site_means
            sites = list(dict.fromkeys(row.site for row in means if row.quantity.startswith("H_V")))
            self._site.set_options(option_texts({ALL_SITES: Message("all sites")}) | {site: site for site in sites})
            self._site.set_visibility(len(sites) > 1)
            if self._site.value != ALL_SITES:
                self._site.set_value(ALL_SITES)  # which chooses
                return
        self._use_choice()

    async def _analyse_campaign(self, key: str) -> bool:
        """Analyse a campaign if necessary; False if it failed or another choice was made meanwhile."""
        self._found, self._refused = None, ""
        self.words.set_text(Message("The campaign is being analysed …"))
        if self._analysis is None or self._analysis[0] != key:
            try:
                analysis = await run.io_bound(campaign_snow, self._lab, key)
            except SkisnowError as error:
                self._show_error(error)
                return False
            if analysis is None or key != self._menu.value:
                return False
            self._analysis = key, analysis
        return True

    def _use_choice(self) -> None:
        """Set and show the chosen snow or its error, and announce the change."""
        self._found, self._refused = None, ""
        key = str(self._menu.value)
        try:
            self._found = self._snow_of(key)
        except SkisnowError as error:
            self._show_error(error)
            return
        found = self._found
        self.words.set_text("" if found is None else Message("Snow: {snow_words}", snow_words=snow_words(found.snow)))
        self._changed()

    def _snow_of(self, key: str) -> ChosenSnow | None:
        """Snow of a choice, published or of the analysed campaign's site; None for numbers below."""
        if key == self._numbers:
            return None
        if key.startswith(PUBLISHED):
            name = key.removeprefix(PUBLISHED)
            return ChosenSnow(published_snow(name), name, {"published": name})
        assert self._analysis is not None
        site, analysis = str(self._site.value or ALL_SITES), self._analysis[1]
        words = self._campaigns[key] + (f", {site}" if site else "")
        keys = {"results": RESULTS} | ({"site": site} if site else {})
        return ChosenSnow(analysis.snow(site or None), words, keys, analysis)

    def _show_error(self, error: SkisnowError) -> None:
        """Store and show why the choice was rejected."""
        self._refused = error_sentence(error)
        self.words.set_text(self._refused)


def _campaigns(lab: Lab) -> dict[str, str]:
    """Names of the campaigns of the lab, by kind (entry or kept) and id, joined by "-"."""
    entered = {
        f"entry-{head.id}": EditSession(lab, head.id).described.name or head.id for head in Journals(lab.store).list()
    }
    return entered | {f"kept-{stored.id}": f"{stored.name} ({stored.id})" for stored in lab.store.list()}


def require_scenario(scenario: str, changes: Mapping[str, str], sources: Sources | None = None) -> ScenarioFile:
    """Read a scenario with changes as on the command line and skis in `sources`; ParameterError if one is not valid."""
    from ..scenario.keys import parse_change

    parsed = dict(parse_change(f"{name}={text}") for name, text in changes.items())
    return build_input(load_input(scenario).changed(parsed), sources=sources)


def campaign_snow(lab: Lab, key: str) -> Analysis:
    """Analysis of a campaign, whose key is its kind (entry or kept), "-" and its id; ParameterError without a snow."""
    numbers = analyse_files(files_in_memory(lab, *key.split("-", 1)), Choice())
    if isinstance(numbers, Refusal):
        raise ParameterError("this campaign gives no snow yet. {said}").tag("no_snow", said=numbers.said)
    return numbers.analysis


def results_and_snow_words(analysis: Analysis, scenario: str, changes: Mapping[str, str]) -> tuple[bytes, str]:
    """Bytes of results.json, and in words the snow of the site in the changes; ParameterError if not valid."""
    sources, site = Sources(), changes.get("snow.site") or None
    sources.take_snow(analysis.snow(site), results=RESULTS, site=site)
    resolved = require_scenario(scenario, {**changes, "snow.results": RESULTS}, sources).scenario
    return results_json(analysis.results), snow_words(resolved.contact.snow)


def snow_words(snow: SnowProperties) -> str:
    """H_V, S_f, k_u/H_V and u_y of a snow in words, with known intervals."""
    return "; ".join(map(str, _in_words(snow)))


def _in_words(snow: SnowProperties) -> Iterator[str]:
    """Each known quantity of a snow with value, interval and unit."""
    quantities = (
        ("H_V", snow.snow_hardness, snow.snow_hardness_interval, N_PER_MM3, "N/mm³"),
        ("S_f", snow.failure_shear_stress, snow.failure_shear_stress_interval, N_PER_MM2, "N/mm²"),
        ("k_u/H_V", snow.unloading_ratio, snow.unloading_ratio_interval, 1.0, ""),
        ("u_y", snow.shear_displacement, snow.shear_displacement_interval, MM, "mm"),
    )
    for name, value, ends, unit, word in quantities:
        if value is not None:
            yield f"{name} = {estimate_words(value / unit, ends and [end / unit for end in ends], word)}"
