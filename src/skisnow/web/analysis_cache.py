"""Cache of the analyses shown on pages, valid until the campaign changes."""

from __future__ import annotations

import asyncio
import secrets
import shutil
import weakref
from collections import OrderedDict
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from tempfile import mkdtemp
from typing import TYPE_CHECKING, Final

from nicegui import run

from .._support.errors import StoreError
from .._support.messages import Message
from ..campaign.store import Journals
from .campaign_analysis import N_FIGURES, Choice, Numbers, Refusal, analyse_files, figure
from .transfer import entry_files, kept_files

if TYPE_CHECKING:
    from collections.abc import AsyncIterator

    from .campaign_analysis import FigureImage
    from .settings import Lab
    from .subprocesses import Worker

MOST_CAMPAIGNS: Final = 6
MOST_CHOICES: Final = 4
"""Maximum numbers of campaigns, and of choices for each, in memory: those of a day's work."""


@dataclass(eq=False)
class CachedAnalysis:
    """Numbers of one choice with a unique key, and its figures by language as far as drawn; None for missing data."""

    key: str
    numbers: Numbers
    figures: dict[str, list[FigureImage | None]] = field(default_factory=dict)
    drawing: asyncio.Lock = field(default_factory=asyncio.Lock)


class CampaignSource:
    """One state of a campaign in memory with its analyses; its reports are in a folder that is deleted with it."""

    def __init__(self, lab: Lab, kind: str, id_: str) -> None:
        self._lab, self._kind, self._id = lab, kind, id_
        self.files = (kept_files if kind == "kept" else entry_files)(lab, id_)
        self._computed = OrderedDict[Choice, CachedAnalysis]()
        self._computing = asyncio.Lock()

    @cached_property
    def place(self) -> Path:
        """Temporary folder of the reports."""
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

    def cached(self, choice: Choice) -> CachedAnalysis | None:
        """Analysis of a choice if it was computed before."""
        return self._computed.get(choice)

    async def analysed(self, choice: Choice) -> CachedAnalysis | Refusal:
        """Analysis of a choice, from the cache or computed now."""
        async with self._computing:
            if (cached := self.cached(choice)) is not None:
                return cached
            outcome = await run.io_bound(analyse_files, self.files, choice)
            if not isinstance(outcome, Numbers):
                return outcome or Refusal(Message("The lab is about to end."))
            self._computed[choice] = result = CachedAnalysis(secrets.token_hex(8), outcome)
            while len(self._computed) > MOST_CHOICES:
                self._computed.popitem(last=False)
            return result


class AnalysisCache:
    """Cache of the campaigns that were opened last, each in its last state."""

    def __init__(self, lab: Lab, worker: Worker) -> None:
        self._lab = lab
        self._worker = worker
        self._subjects = OrderedDict[tuple[str, str], tuple[int, CampaignSource]]()
        self._opening = asyncio.Lock()

    def cached(self, kind: str, id_: str) -> CampaignSource | None:
        """The campaign if it is in the cache and nothing was entered since.

        Raises
        ------
        StoreError
            The store has no such campaign.
        """
        entry, state = self._subjects.get((kind, id_)), self._state(kind, id_)
        return entry[1] if entry is not None and entry[0] == state else None

    async def subject(self, kind: str, id_: str) -> CampaignSource:
        """The campaign in its current state.

        Raises
        ------
        StoreError
            The store has no such campaign.
        """
        async with self._opening:
            if (cached := self.cached(kind, id_)) is not None:
                self._subjects.move_to_end((kind, id_))
                return cached
            state = self._state(kind, id_)  # before reading: a later entry makes the cached state old
            source = await run.io_bound(CampaignSource, self._lab, kind, id_)
            if source is None:
                raise StoreError("The lab is about to end.", code="lab_ends")
            self._subjects[(kind, id_)] = (state, source)
            self._subjects.move_to_end((kind, id_))
            while len(self._subjects) > MOST_CAMPAIGNS:
                self._subjects.popitem(last=False)
            return source

    def _state(self, kind: str, id_: str) -> int:
        """Number of entries, or of corrections of an imported campaign, whose files do not change."""
        if kind != "entry":
            stored = self._lab.store.show(id_)
            return len(Journals(self._lab.store).corrections(stored.id))
        counts = {head.id: head.n_entries for head in Journals(self._lab.store).list()}
        if id_ not in counts:
            raise StoreError(
                "The store has no campaign with the id {id!r}; the list of campaigns names all.",
                code="unknown_campaign",
                id=id_,
            )
        return counts[id_]

    async def figures(self, analysed: CachedAnalysis, language: str) -> AsyncIterator[FigureImage]:
        """Figures in order, each as soon as it is drawn, also by another page."""
        numbers, drawn = analysed.numbers, analysed.figures.setdefault(language, [])
        for number in range(N_FIGURES):
            async with analysed.drawing:
                if number == len(drawn):
                    drawn.append(await self._worker.do(figure, numbers.analysis, number, language))
            shown = drawn[number]
            if shown is not None:
                yield shown
