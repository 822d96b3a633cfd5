"""Analysis of a campaign's files with a choice of included data, and the cache of shown analyses."""

from __future__ import annotations

import asyncio
import secrets
import shutil
import weakref
from collections import OrderedDict
from collections.abc import AsyncIterator
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from tempfile import mkdtemp
from typing import Any, Final

from nicegui import run

from .._support.errors import FieldDataError, SkisnowError, StoreError
from .._support.messages import Message, in_language, joined, languages
from ..campaign import QUALITY_FLAGS, campaign_of_files
from ..campaign.problems import ALWAYS_EXCLUDE, Problem
from ..campaign.reading.campaign_files import FilesInMemory
from ..campaign.records import Campaign
from ..campaign.store import Journals
from ..estimation import Analysis, analyse
from ..estimation.group_comparisons import DIFFERENCE
from ..report import write_report
from ..report.campaign.data import ReportData
from ..report.campaign.key_results import key_results
from ..report.campaign.page import DRAWERS, drawers_of, tables_html
from ..report.campaign.tables import campaign_tables
from ..report.campaign.verdicts import verdicts
from ..report.figures.drawing import Drawing, data_uri, drawing_svg
from ..report.figures.style import journal_style, local_axes, site_styles
from .settings import Lab
from .transfer import files_in_memory
from .uploads import Worker

LEFT_OUT: Final = Message("excluded by choice in the lab")
N_FIGURES: Final = len(DRAWERS) + 2  # maximum number of figures: also those of recordings
SHOWN_TABLES: Final = (
    "sites", "published_relations", "snow_micro_pen", "models", "model_tests", "regressions",
    "penetration_experiments", "shear_experiments",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Choice:
    """The user's choice of the quality flags and tests that an analysis excludes.

    excluding: codes of the quality flags that exclude an experiment (default: those of the campaign).
    left_out: further excluded experiments by file and name.
    difference: relative difference of two groups for which the number of needed tests is computed.
    """

    excluding: frozenset[str] | None = None
    left_out: frozenset[tuple[str, str]] = frozenset()
    difference: float = DIFFERENCE


@dataclass(frozen=True, slots=True)
class FigureImage:
    """A drawn figure for a page: alternative text, caption as HTML, address of its image; a ``wide`` one scrolls."""

    name: str
    alt: str
    caption: str
    image: str
    wide: bool


@dataclass(frozen=True, slots=True, eq=False)
class Numbers:
    """Results of a campaign for one choice: analysis, verdicts, and the report's key results and tables as HTML.

    key_results, tables: by language, the tables also by name.
    figures: images by language, as many as are drawn so far; None for a figure without data.
    drawing: lock that is held while a figure is drawn.
    key: unique name of the folder of its reports.
    """

    analysis: Analysis
    verdicts: tuple[Message, ...]
    key_results: dict[str, tuple[str, ...]] = field(default_factory=dict)
    tables: dict[str, dict[str, str]] = field(default_factory=dict)
    figures: dict[str, list[FigureImage | None]] = field(default_factory=dict)
    drawing: asyncio.Lock = field(default_factory=asyncio.Lock)
    key: str = field(default_factory=lambda: secrets.token_hex(8))


@dataclass(frozen=True, slots=True)
class Refusal:
    """Reason why a campaign cannot be analysed, with a line for each error in its files."""

    said: str
    errors: tuple[str, ...] = ()


def analyse_files(files: FilesInMemory, choice: Choice) -> Numbers | Refusal:
    """Analyse a campaign in memory with a choice; returns its results, or the reason why there are none."""
    try:
        campaign = _select_data(campaign_of_files(files.contents, others=files.others), choice)
        analysis = analyse(campaign, difference=choice.difference)
    except FieldDataError as error:
        errors = [problem for problem in error.problems if isinstance(problem, Problem) and problem.severity == "error"]
        return Refusal(joined(error.sentences), tuple(FieldDataError(errors).sentences))
    except SkisnowError as error:
        return Refusal(error.message)
    data = ReportData(analysis)
    numbers = Numbers(analysis, tuple(verdicts(analysis.results)))
    for language in languages():
        with in_language(language):
            html = tables_html({name: table for name, table in campaign_tables(data).items() if table.rows})
            numbers.tables[language] = {name: str(html[name]) for name in SHOWN_TABLES if name in html}
            numbers.key_results[language] = tuple(map(str, key_results(data)))
    return numbers


def figure(analysis: Analysis, number: int, language: str) -> FigureImage | None:
    """Image of one of the report's figures, counted from 0; None if the campaign has no data for it."""
    data = ReportData(analysis)
    with journal_style(), in_language(language):
        drawers = drawers_of(analysis.campaign)
        drawn = drawers[number](data, site_styles(data)) if number < len(drawers) else None
        if not isinstance(drawn, Drawing):
            return None
        local_axes(drawn.figure)
        return FigureImage(
            drawn.name, str(drawn.alt), str(drawn.whole_caption), data_uri(drawing_svg(drawn)), drawn.wide
        )


def load_drawing() -> None:
    """Import this module, and with it Matplotlib, in the worker process that calls this function."""


def write_whole_report(analysis: Analysis, out: str, language: str) -> None:
    """Write the report with tables, figures and results.json to a folder."""
    write_report(analysis, Path(out), language=language)


def choosable_flags() -> dict[str, str]:
    """Sentences of the quality flags that users can include or exclude, by code."""
    return {code: flag.sentence for code, flag in QUALITY_FLAGS.items() if code not in ALWAYS_EXCLUDE}


def _select_data(campaign: Campaign, choice: Choice) -> Campaign:
    """Campaign with the flags of a choice; its excluded experiments are cancelled, so that tables still list them."""
    excluding = campaign.excluding if choice.excluding is None else choice.excluding | ALWAYS_EXCLUDE
    changes: dict[str, Any] = {"excluding": excluding}
    for kind in ("penetration", "shear"):
        tests = getattr(campaign, kind)
        if tests is not None:
            left_out = [(f"{kind}.csv", name) in choice.left_out for name in tests.experiment]
            reasons = zip(tests.cancelled, left_out, strict=True)
            changes[kind] = replace(tests, cancelled=tuple(why or (LEFT_OUT if out else "") for why, out in reasons))
    return replace(campaign, **changes)


MOST_CAMPAIGNS: Final = 6
MOST_CHOICES: Final = 4
"""Maximum numbers of campaigns, and of choices for each, in memory: those of a day's work."""


class CampaignSource:
    """One state of a campaign in memory with its analyses; its reports are in a folder that is deleted with it."""

    def __init__(self, lab: Lab, kind: str, id_: str) -> None:
        self._lab, self._kind, self._id = lab, kind, id_
        self.files = files_in_memory(lab, kind, id_)
        self._computed = OrderedDict[Choice, Numbers]()
        self._computing = asyncio.Lock()

    @cached_property
    def place(self) -> Path:
        """Temporary folder for reports, removed together with this object."""
        place = mkdtemp(prefix="skisnow-analysis-")
        weakref.finalize(self, shutil.rmtree, place, ignore_errors=True)
        return Path(place)

    def write_campaign(self, folder: Path) -> None:
        """Write all files of this state of the campaign into a new folder."""
        if self._kind == "kept":
            self._lab.store.export(self._id, folder)
        folder.mkdir(exist_ok=True)
        for name, content in self.files.contents.items():
            (folder / name).write_bytes(content)

    def cached(self, choice: Choice) -> Numbers | None:
        """Analysis of a choice if it was computed before."""
        return self._computed.get(choice)

    async def analysed(self, choice: Choice) -> Numbers | Refusal:
        """Numbers of an analysis with a choice, from the cache or computed now; a Refusal if there are none."""
        async with self._computing:
            if (cached := self.cached(choice)) is not None:
                return cached
            outcome = await run.io_bound(analyse_files, self.files, choice)
            if not isinstance(outcome, Numbers):
                return outcome or Refusal(Message("The lab is about to end."))
            self._computed[choice] = outcome
            while len(self._computed) > MOST_CHOICES:
                self._computed.popitem(last=False)
            return outcome


class AnalysisCache:
    """Cache of the campaigns that were opened last, each in its last state."""

    def __init__(self, lab: Lab, worker: Worker) -> None:
        self._lab = lab
        self._worker = worker
        self._subjects = OrderedDict[tuple[str, str], tuple[int, CampaignSource]]()
        self._opening = asyncio.Lock()

    def cached(self, kind: str, id_: str) -> CampaignSource | None:
        """Cached state of a campaign (kind: entry or kept); None if it has changed since or was never read."""
        entry, state = self._subjects.get((kind, id_)), self._state(kind, id_)
        return entry[1] if entry is not None and entry[0] == state else None

    async def subject(self, kind: str, id_: str) -> CampaignSource:
        """Current state of a campaign, from the cache or read now; StoreError if the store does not have it."""
        async with self._opening:
            if (cached := self.cached(kind, id_)) is not None:
                self._subjects.move_to_end((kind, id_))
                return cached
            state = self._state(kind, id_)  # before reading: a later entry makes the cached state old
            source = await run.io_bound(CampaignSource, self._lab, kind, id_)
            if source is None:
                raise StoreError("The lab is about to end.").tag("lab_ends")
            self._subjects[(kind, id_)] = (state, source)
            self._subjects.move_to_end((kind, id_))
            while len(self._subjects) > MOST_CAMPAIGNS:
                self._subjects.popitem(last=False)
            return source

    def _state(self, kind: str, id_: str) -> int:
        """Number that grows with each change: entries of an entered campaign, corrections of an imported one."""
        if kind != "entry":
            stored = self._lab.store.show(id_)
            return len(Journals(self._lab.store).corrections(stored.id))
        counts = {head.id: head.n_entries for head in Journals(self._lab.store).list()}
        if id_ not in counts:
            raise StoreError("The store has no campaign with the id {id!r}; the list of campaigns names all.").tag(
                "unknown_campaign", id=id_
            )
        return counts[id_]

    async def figures(self, numbers: Numbers, language: str) -> AsyncIterator[FigureImage]:
        """Yield the figures in order, each as soon as it is drawn; those that another page drew are reused."""
        drawn = numbers.figures.setdefault(language, [])
        for number in range(N_FIGURES):
            async with numbers.drawing:
                if number == len(drawn):
                    drawn.append(await self._worker.do(figure, numbers.analysis, number, language))
            shown = drawn[number]
            if shown is not None:
                yield shown
