"""Queue and history of jobs on a page; cards are updated in place, so that no click is lost."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, Protocol

from nicegui import ui

from .._support.errors import ParameterError
from .._support.messages import Message
from .language import said
from .layout import error_sentence, heading, sentence

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import TypeAlias

    from .runs import Runs

    Act: TypeAlias = Callable[[Callable[[str], None], str], None]
    """Function that calls a function of the queue with a job's name, and shows its errors."""

EVERY_S: Final = 1.0


class JobCard(Protocol):
    """Card of a job with its buttons."""

    place: ui.element

    def show(self, job: Any) -> None:
        """Show the state of the job."""
        ...


class JobList:
    """Cards of all jobs, the newest first, updated every second.

    Parameters
    ----------
    runs
        The queue.
    card
        Factory of the card of a job, from the queue, the job and an `Act`.
    nothing
        Sentence without a job.
    """

    def __init__(self, runs: Any, card: Callable[[Any, Any, Act], JobCard], nothing: str) -> None:
        self._runs: Runs = runs
        self._card = card
        self._cards: dict[str, JobCard] = {}
        heading(Message("Queue and history"))
        self._nothing = sentence(nothing, "quiet")
        self._place = ui.element("div")
        self.show()
        ui.timer(EVERY_S, self.show)

    def show(self) -> None:
        """Update the cards."""
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
