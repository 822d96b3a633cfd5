"""The queue and the history of jobs on a page. A card stays the same while its job goes on: no press on it is lost."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, Protocol

from nicegui import ui

from .._support.errors import ParameterError
from .error_pages import error_sentence
from .language import said
from .layout import heading, sentence

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import TypeAlias

    from .runs import Runs

    Act: TypeAlias = Callable[[Callable[[str], None], str], None]
    """Calls a function of the queue with a job's name."""

EVERY_S: Final = 1.0


class JobCard(Protocol):
    """One job of the list, and what can be done with it."""

    place: ui.element

    def show(self, job: Any) -> None:
        """Show how it stands now."""
        ...


class JobList:
    """Cards of all jobs, the newest first, brought up to date each second.

    Parameters
    ----------
    runs
        The queue.
    card
        Makes the card of a job, from the queue, the job and what does something with it: a function of `runs` is called
        with the job's name, and what it refuses is said.
    nothing
        What is said where there is no job yet.
    """

    def __init__(self, runs: Any, card: Callable[[Any, Any, Act], JobCard], nothing: str) -> None:
        self._runs: Runs = runs
        self._card = card
        self._cards: dict[str, JobCard] = {}
        heading("Queue and history")
        self._nothing = sentence(nothing, "quiet")
        self._place = ui.element("div")
        self.show()
        ui.timer(EVERY_S, self.show)

    def show(self) -> None:
        """Show what is so now."""
        jobs = self._runs.jobs()
        self._nothing.set_visibility(not jobs)
        for name in self._cards.keys() - {job.name for job in jobs}:
            self._cards.pop(name).place.delete()
        for index, job in enumerate(jobs):
            if job.name not in self._cards:
                with self._place:
                    self._cards[job.name] = card = self._card(self._runs, job, self._act)
                card.place.move(target_index=index)
            self._cards[job.name].show(job)

    def _act(self, act: Callable[[str], None], name: str) -> None:
        try:
            act(name)
        except ParameterError as error:
            ui.notify(said(error_sentence(error)))
        self.show()
