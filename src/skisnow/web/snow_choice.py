"""Choice of a snow on a page: a published snow, a site of a campaign, or numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Final

from nicegui import run

from .._support.errors import ParameterError, SkisnowError
from .._support.messages import Message
from .._support.units import MM, N_PER_MM2, N_PER_MM3
from ..campaign.store import Journals
from ..estimation import Analysis
from ..estimation.results import results_json
from ..report.campaign.page import RESULTS
from ..scenario.reading import ScenarioFile, build_input, load_input
from ..ski.ski_file import Sources
from ..snow import SnowProperties, published_names, published_snow
from .campaign_analysis import Choice, Refusal, analyse_files
from .edit_session import EditSession
from .elements import Words, choice, error_sentence, option_texts
from .settings import Lab
from .transfer import files_in_memory
from .words import estimate_words

PUBLISHED: Final = "published-"
ALL_SITES: Final = ""


@dataclass(frozen=True, slots=True)
class ChosenSnow:
    """A snow that was chosen by name.

    analysis, site: analysis of the campaign, and the site ("" for all sites).
    """

    snow: SnowProperties
    words: str
    published: str = ""
    analysis: Analysis | None = None
    site: str = ALL_SITES


class SnowChoice:
    """Menu of snows; ``changed`` is called after a choice. ``numbers``: entry for the page's numbers."""

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
        """True if the numbers on the page apply."""
        return bool(self._menu.value == self._numbers)

    @property
    def gives_hardness(self) -> bool:
        """True if the chosen snow gives H_V."""
        return not self.is_numbers

    @property
    def gives_stress(self) -> bool:
        """True if the chosen snow gives S_f; a campaign without shear tests does not."""
        return self.gives_hardness and (self._found is None or self._found.snow.failure_shear_stress is not None)

    def chosen(self) -> ChosenSnow | None:
        """The chosen snow; None for the numbers on the page.

        Raises ParameterError: the chosen campaign gives no snow.
        """
        if self.is_numbers:
            return None
        if self._found is None:
            waiting = Message("the campaign is being analysed; wait a moment")
            raise ParameterError(self._refused or waiting).tag("no_snow")
        return self._found

    async def _choose_campaign_or_snow(self) -> None:
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
        if key == self._numbers:
            return None
        if key.startswith(PUBLISHED):
            name = key.removeprefix(PUBLISHED)
            return ChosenSnow(published_snow(name), name, published=name)
        assert self._analysis is not None
        site, analysis = str(self._site.value or ALL_SITES), self._analysis[1]
        words = self._campaigns[key] + (f", {site}" if site else "")
        return ChosenSnow(analysis.snow(site or None), words, analysis=analysis, site=site)

    def _show_error(self, error: SkisnowError) -> None:
        self._refused = error_sentence(error)
        self.words.set_text(self._refused)


def _campaigns(lab: Lab) -> dict[str, str]:
    """Names of the campaigns of the lab by kind and id."""
    entered = {
        f"entry-{head.id}": EditSession(lab, head.id).described.name or head.id for head in Journals(lab.store).list()
    }
    return entered | {f"kept-{stored.id}": f"{stored.name} ({stored.id})" for stored in lab.store.list()}


def require_scenario(scenario: str, changes: Mapping[str, str], sources: Sources | None = None) -> ScenarioFile:
    """Read a scenario with changes as on the command line; ``sources``: skis and snows in memory.

    Raises ParameterError: a value is not valid.
    """
    from ..scenario.keys import parse_change

    parsed = dict(parse_change(f"{name}={text}") for name, text in changes.items())
    return build_input(load_input(scenario).changed(parsed), sources=sources)


def campaign_snow(lab: Lab, key: str) -> Analysis:
    """Analysis of a campaign of the lab; ``key``: its kind (entry or kept) and id, joined by "-".

    Raises ParameterError: the campaign gives no snow.
    """
    numbers = analyse_files(files_in_memory(lab, *key.split("-", 1)), Choice())
    if isinstance(numbers, Refusal):
        raise ParameterError("this campaign gives no snow yet. {said}").tag("no_snow", said=numbers.said)
    return numbers.analysis


def results_and_snow_words(analysis: Analysis, scenario: str, changes: Mapping[str, str]) -> tuple[bytes, str]:
    """Text of results.json of a campaign, and in words the snow of a scenario whose changes can name the site.

    Raises ParameterError: a value is not valid.
    """
    sources, site = Sources(), changes.get("snow.site") or None
    sources.take_snow(analysis.snow(site), results=RESULTS, site=site)
    resolved = require_scenario(scenario, {**changes, "snow.results": RESULTS}, sources).scenario
    return results_json(analysis.results), snow_words(resolved.contact.snow)


def snow_words(snow: SnowProperties) -> str:
    """H_V, S_f, k_u/H_V and u_y of a snow in words, with known intervals."""
    return "; ".join(map(str, _in_words(snow)))


def _in_words(snow: SnowProperties) -> Iterator[str]:
    quantities = (
        ("H_V", snow.snow_hardness, snow.snow_hardness_interval, N_PER_MM3, "N/mm³"),
        ("S_f", snow.failure_shear_stress, snow.failure_shear_stress_interval, N_PER_MM2, "N/mm²"),
        ("k_u/H_V", snow.unloading_ratio, snow.unloading_ratio_interval, 1.0, ""),
        ("u_y", snow.shear_displacement, snow.shear_displacement_interval, MM, "mm"),
    )
    for name, value, ends, unit, word in quantities:
        if value is not None:
            yield f"{name} = {estimate_words(value / unit, ends and [end / unit for end in ends], word)}"
