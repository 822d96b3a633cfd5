"""The choice of a snow on a page: a published one, one site of an own campaign, or numbers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from nicegui import run

from .._support.errors import ParameterError, SkisnowError
from .._support.units import MM, N_PER_MM2, N_PER_MM3
from ..campaign.store import Journals
from ..estimation.results import results_json
from ..report.campaign.page import RESULTS
from ..snow import published_names, published_snow
from .campaign_analysis import Choice, Refusal, numbers_of
from .edit_session import EditSession
from .elements import Words, choice, said_options
from .error_pages import error_sentence
from .transfer import entry_files, kept_files
from .words import estimate_words

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Iterator, Mapping

    from ..estimation import Analysis
    from ..scenario.reading import ScenarioFile
    from ..ski.sources import Sources
    from ..snow import SnowProperties
    from .settings import Lab

PUBLISHED: Final = "published-"
ALL_SITES: Final = ""


@dataclass(frozen=True, slots=True)
class ChosenSnow:
    """A snow that is given by a name.

    Attributes
    ----------
    snow
        With its intervals, as far as they are known.
    words
        What it is called.
    published
        Name of a published one.
    analysis, site
        Where it was measured: a campaign, and the site or nothing for all of them.
    """

    snow: SnowProperties
    words: str
    published: str = ""
    analysis: Analysis | None = None
    site: str = ALL_SITES


class SnowChoice:
    """A menu of snows; ``changed`` is awaited when another one is chosen.

    ``numbers`` is what the entry is called under which the page's own numbers hold.
    """

    def __init__(self, lab: Lab, numbers: str, changed: Callable[[], Awaitable[None]]) -> None:
        self._lab, self._numbers, self._changed = lab, numbers, changed
        self._campaigns = _campaigns(lab)
        named = {f"{PUBLISHED}{name}": f"published: {name}" for name in published_names()}
        self._menu = choice("Snow", {numbers: numbers, **named, **self._campaigns}, numbers)
        self._site = choice("Site", {ALL_SITES: "all sites"}, ALL_SITES)
        self._site.set_visibility(False)
        self.words = Words("").classes("sentence snow").props("role=status")
        self._found: ChosenSnow | None = None
        self._refused = ""
        self._analysis: tuple[str, Analysis] | None = None
        self._menu.on_value_change(self._another)
        self._site.on_value_change(self._choose)

    @property
    def is_numbers(self) -> bool:
        """Whether the page's own numbers hold."""
        return bool(self._menu.value == self._numbers)

    @property
    def gives_hardness(self) -> bool:
        """Whether H_V is that of a chosen snow."""
        return not self.is_numbers

    @property
    def gives_stress(self) -> bool:
        """Whether S_f is: a campaign without shear tests has none."""
        return self.gives_hardness and (self._found is None or self._found.snow.failure_shear_stress is not None)

    def chosen(self) -> ChosenSnow | None:
        """The snow, None for the page's own numbers.

        Raises
        ------
        ParameterError
            What is chosen gives no snow.
        """
        if self.is_numbers:
            return None
        if self._found is None:
            raise ParameterError(self._refused or "the campaign is being analysed; wait a moment")
        return self._found

    async def _another(self) -> None:
        key = str(self._menu.value)
        of_campaign = key in self._campaigns
        self._site.set_visibility(False)
        if of_campaign and not await self._analyse(key):
            return
        if of_campaign and self._analysis is not None:
            sites = sites_of(self._analysis[1])
            self._site.set_options(said_options({ALL_SITES: "all sites"}) | {site: site for site in sites})
            self._site.set_visibility(len(sites) > 1)
            if self._site.value != ALL_SITES:
                self._site.set_value(ALL_SITES)  # which chooses
                return
        await self._choose()

    async def _analyse(self, key: str) -> bool:
        self._found, self._refused = None, ""
        self.words.set_text("The campaign is being analysed …")
        if self._analysis is None or self._analysis[0] != key:
            try:
                analysis = await run.io_bound(campaign_snow, self._lab, key)
            except SkisnowError as error:
                self._refuse(error)
                return False
            if analysis is None or key != self._menu.value:
                return False
            self._analysis = key, analysis
        return True

    async def _choose(self) -> None:
        self._found, self._refused = None, ""
        key = str(self._menu.value)
        try:
            self._found = self._snow_of(key)
        except SkisnowError as error:
            self._refuse(error)
            return
        self.words.set_text("" if self._found is None else f"Snow: {snow_words(self._found.snow)}")
        await self._changed()

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

    def _refuse(self, error: SkisnowError) -> None:
        self._refused = error_sentence(error)
        self.words.set_text(self._refused)


def _campaigns(lab: Lab) -> dict[str, str]:
    """Campaigns that can give the snow, by kind and id."""
    entered = {
        f"entry-{head.id}": EditSession(lab, head.id).described.name or head.id for head in Journals(lab.store).list()
    }
    return entered | {f"kept-{stored.id}": f"{stored.name} ({stored.id})" for stored in lab.store.list()}


def require_scenario(scenario: str, changes: Mapping[str, str], sources: Sources | None = None) -> ScenarioFile:
    """Read a scenario with changes as the command line would.

    Parameters
    ----------
    scenario, changes
        As on the command line.
    sources
        Of skis and snows that are at hand.

    Raises
    ------
    ParameterError
        A value cannot be read or is not allowed.
    """
    from ..scenario.keys import parse_change
    from ..scenario.reading import build_input, load_input

    given = load_input(scenario).changed(dict(parse_change(f"{name}={text}") for name, text in changes.items()))
    return build_input(given, sources=sources)


def campaign_snow(lab: Lab, key: str) -> Analysis:
    """The analysis of a campaign of the lab.

    Parameters
    ----------
    lab
        Whose store has the campaign.
    key
        entry or kept, and the id, with - between.

    Raises
    ------
    ParameterError
        The campaign gives no snow.
    """
    kind, id_ = key.split("-", 1)
    found = numbers_of((kept_files if kind == "kept" else entry_files)(lab, id_), Choice())
    if isinstance(found, Refusal):
        raise ParameterError(f"this campaign gives no snow yet. {found.said}")
    return found.analysis


def sites_of(analysis: Analysis) -> list[str]:
    """Sites that H_V was measured at."""
    return list(dict.fromkeys(row.site for row in analysis.site_means if row.quantity.startswith("H_V")))


def results_with(analysis: Analysis, scenario: str, changes: Mapping[str, str]) -> tuple[bytes, str]:
    """The text of results.json of a campaign, and in words the snow that the run then has.

    Parameters
    ----------
    analysis
        Of the campaign.
    scenario, changes
        What is to be simulated on its snow; ``snow.site`` names the site.

    Raises
    ------
    ParameterError
        A value cannot be read or is not allowed.
    """
    from ..ski.sources import Sources

    sources, site = Sources(), changes.get("snow.site") or None
    sources.take_snow(analysis.snow(site), results=RESULTS, site=site)
    asked = require_scenario(scenario, {**changes, "snow.results": RESULTS}, sources).scenario
    return results_json(analysis.results), snow_words(asked.contact.snow)


def snow_words(snow: SnowProperties) -> str:
    """H_V, S_f, k_u/H_V and u_y of a snow in words, with their intervals where these are known."""
    return "; ".join(_in_words(snow))


def _in_words(snow: SnowProperties) -> Iterator[str]:
    known = (
        ("H_V", snow.snow_hardness, snow.snow_hardness_interval, N_PER_MM3, "N/mm³"),
        ("S_f", snow.failure_shear_stress, snow.failure_shear_stress_interval, N_PER_MM2, "N/mm²"),
        ("k_u/H_V", snow.unloading_ratio, snow.unloading_ratio_interval, 1.0, ""),
        ("u_y", snow.shear_displacement, snow.shear_displacement_interval, MM, "mm"),
    )
    for name, value, ends, unit, word in known:
        if value is not None:
            yield f"{name} = {estimate_words(value / unit, ends and [end / unit for end in ends], word)}"
