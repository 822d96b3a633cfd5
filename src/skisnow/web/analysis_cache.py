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
from ..campaign.store import Journals
from .campaign_analysis import N_FIGURES, Choice, Numbers, Refusal, figure, numbers_of
from .transfer import entry_files, kept_files

if TYPE_CHECKING:
    from collections.abc import AsyncIterator

    from .campaign_analysis import Shown
    from .settings import Lab
    from .subprocesses import Worker

MOST_CAMPAIGNS: Final = 6
MOST_CHOICES: Final = 4
"""How many are kept in memory (modelling assumption): those of a day's work, not of a season's."""


@dataclass(eq=False)
class Analysed:
    """Numbers of one choice under a key of their own, figures by language as far as drawn; None: there are no data."""

    key: str
    numbers: Numbers
    figures: dict[str, list[Shown | None]] = field(default_factory=dict)
    drawing: asyncio.Lock = field(default_factory=asyncio.Lock)


class CampaignSource:
    """A campaign as it stands, in memory, and what was computed of it.

    Reports that were asked for lie in a folder, which goes when nobody holds the subject any more.
    """

    def __init__(self, lab: Lab, kind: str, id_: str) -> None:
        self._lab, self._kind, self._id = lab, kind, id_
        self.files = (kept_files if kind == "kept" else entry_files)(lab, id_)
        self._computed = OrderedDict[Choice, Analysed]()
        self._computing = asyncio.Lock()

    @cached_property
    def place(self) -> Path:
        """The folder of its reports."""
        place = mkdtemp(prefix="skisnow-analysis-")
        weakref.finalize(self, shutil.rmtree, place, ignore_errors=True)
        return Path(place)

    def write_campaign(self, folder: Path) -> None:
        """Write all files of the campaign into a new folder, as they were when it was looked at."""
        if self._kind == "kept":
            self._lab.store.export(self._id, folder)
        folder.mkdir(exist_ok=True)
        for name, content in self.files.contents.items():
            (folder / name).write_bytes(content)

    def known(self, choice: Choice) -> Analysed | None:
        """What was computed of a choice before."""
        return self._computed.get(choice)

    async def analysed(self, choice: Choice) -> Analysed | Refusal:
        """The numbers of a choice, computed where they are not known."""
        async with self._computing:
            if (known := self.known(choice)) is not None:
                return known
            found = await run.io_bound(numbers_of, self.files, choice)
            if not isinstance(found, Numbers):
                return found or Refusal("The lab is about to end.")
            self._computed[choice] = made = Analysed(secrets.token_hex(8), found)
            while len(self._computed) > MOST_CHOICES:
                self._computed.popitem(last=False)
            return made


class Analyses:
    """The campaigns that were looked at last, each in its last state."""

    def __init__(self, lab: Lab, worker: Worker) -> None:
        self._lab = lab
        self._worker = worker
        self._subjects = OrderedDict[tuple[str, str], tuple[int, CampaignSource]]()
        self._opening = asyncio.Lock()

    def known(self, kind: str, id_: str) -> CampaignSource | None:
        """The campaign, where it was looked at before and nothing was entered since; None otherwise.

        Raises
        ------
        StoreError
            The store has no such campaign.
        """
        found, state = self._subjects.get((kind, id_)), self._state(kind, id_)
        return found[1] if found is not None and found[0] == state else None

    async def subject(self, kind: str, id_: str) -> CampaignSource:
        """The campaign in the state that the store has it in.

        Raises
        ------
        StoreError
            The store has no such campaign.
        """
        async with self._opening:
            if (known := self.known(kind, id_)) is not None:
                self._subjects.move_to_end((kind, id_))
                return known
            state = self._state(kind, id_)  # before it is read: what comes meanwhile is looked at again
            made = await run.io_bound(CampaignSource, self._lab, kind, id_)
            if made is None:
                raise StoreError("The lab is about to end.")
            self._subjects[(kind, id_)] = (state, made)
            self._subjects.move_to_end((kind, id_))
            while len(self._subjects) > MOST_CAMPAIGNS:
                self._subjects.popitem(last=False)
            return made

    def _state(self, kind: str, id_: str) -> int:
        """A number that rises with each entry; the files of a kept campaign stay, but it can be corrected."""
        if kind != "entry":
            stored = self._lab.store.show(id_)
            return len(Journals(self._lab.store).corrections(stored.id))
        counts = {head.id: head.n_entries for head in Journals(self._lab.store).list()}
        if id_ not in counts:
            raise StoreError(f"The store has no campaign with the id {id_!r}; the list of campaigns names all.")
        return counts[id_]

    async def figures(self, analysed: Analysed, language: str) -> AsyncIterator[Shown]:
        """The figures one after another, each as soon as it is drawn, whoever had it drawn."""
        numbers, drawn = analysed.numbers, analysed.figures.setdefault(language, [])
        for number in range(N_FIGURES):
            async with analysed.drawing:
                if number == len(drawn):
                    drawn.append(await self._worker.do(figure, numbers.analysis, number, language))
            shown = drawn[number]
            if shown is not None:
                yield shown
