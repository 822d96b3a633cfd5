"""Studies, one after another, each by the command in a process and a folder of its own; the folders are the queue.

A study is the folder ``NAME`` with ``study.toml`` and the files that it names, ``job.json``, and at last its table and
figure. What was computed is kept beside the table, so that a study goes on where it was ended.
"""

from __future__ import annotations

import asyncio
import contextlib
import re
import shutil
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from tempfile import mkdtemp
from typing import TYPE_CHECKING, Any, Final

from .._support.errors import ParameterError, SkisnowError
from .._support.language import ENGLISH
from .._support.processes.executors import LOCAL
from .._support.processes.kept_rows import KeptRows
from .._support.processes.pool import available_cores
from .._support.staging import write_file
from .runs import AROUND_S, JOB, LOOKED_AT, Job, Runs, duration_words, new_name, simulated_s, slowness
from .study_fields import CARVE, STUDY, TABLE, most_points_refused
from .uploads import files_below

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from ..studies import Study, StudyTable
    from .study_fields import StudyAsked

FOLDER: Final = "studies"
FIGURE: Final = "map.svg"
PARTIAL: Final = f"{TABLE}.partial"
_IN_USE: Final = "is being written by another run"
_POINTS: Final = re.compile(r"^\d+ of \d+ points")
_AGAIN_S: Final = 3.0
"""A process that outlived its server ends when it next tells how far it is (modelling assumption)."""


@dataclass(frozen=True, slots=True)
class StudyJob(Job):
    """A study: ``scenario`` is what it is of, ``changes`` what is fixed in words, ``given`` what varies.

    ``points`` is how many it has, ``workers`` how many processes computed it, 0 where a scheduler's did. ``method`` and
    ``unit_s`` are the solver and how long a point was estimated to take at unit slowness (s): see `study_estimate`.
    """

    points: int = 0
    workers: int = 0
    method: str = ""
    unit_s: float = 0.0


class Studies(Runs):
    """Queue and history of studies.

    Parameters
    ----------
    folder
        The lab's, in which they have one of their own.
    scheduler
        Who computes, as ``--scheduler`` of the command takes it; None: processes of this machine, of which one core
        stays free for the pages.
    """

    kind = StudyJob

    def __init__(self, folder: Path, scheduler: str | None = None) -> None:
        super().__init__(folder / FOLDER)
        self.scheduler = scheduler

    @property
    def elsewhere(self) -> str:
        """The scheduler whose workers compute; nothing where this machine does."""
        return "" if self.scheduler is None or self.scheduler in LOCAL else self.scheduler

    @property
    def workers(self) -> int:
        """Processes or threads of this machine that a study begins; 0: none."""
        return 0 if self.elsewhere else max(1, available_cores() - 1)

    def study_jobs(self) -> list[StudyJob]:
        """All studies, the newest first."""
        return [job for job in self.jobs() if isinstance(job, StudyJob)]

    def ask_for(self, asked: StudyAsked, language: str = ENGLISH) -> StudyJob:
        """Put a study at the end of the queue; it is on the disk when this returns. ``language`` is that of its map.

        Raises
        ------
        ParameterError
            It cannot be a study: what the command would say of its file.
        """
        from ..studies import read_study

        now = datetime.now(UTC)
        name = new_name(asked.of, now)
        self.folder.mkdir(parents=True, exist_ok=True)
        made = Path(mkdtemp(prefix=".partial-", dir=self.folder))
        try:
            for file, content in asked.files().items():
                write_file(made / file, content)
            try:
                points = len(read_study(made / STUDY).points)
                most_points_refused(points)
            except ParameterError as error:
                raise ParameterError(_without(made, str(error))) from error
            made.chmod(0o755)
            made.rename(self.folder / name)  # a study from the moment on that its job is there
        finally:
            shutil.rmtree(made, ignore_errors=True)
        job = StudyJob(
            name, asked.of, asked.fixed_words(), now.isoformat(), given=asked.varied_words(), points=points,
            workers=self.workers, method=asked.method, unit_s=asked.unit_s,
            language=language,
        )  # fmt: skip
        self._keep(job)
        return job

    def go_on(self, name: str) -> None:
        """Put a study that was cancelled or failed into the queue again; it goes on with what is finished.

        Raises
        ------
        ParameterError
            It is neither.
        """
        job = next((job for job in self.study_jobs() if job.name == name), None)
        if job is None or job.state not in ("cancelled", "failed"):
            raise ParameterError("this study waits, is computed or is done; there is nothing to go on with")
        self._keep(replace(job, state="waiting", said="", workers=self.workers))

    def file(self, name: str, file: str) -> Path:
        """A file of a study; names of other things are refused, wherever they would lead.

        Raises
        ------
        ParameterError
            There is no such study, or it has no such file yet.
        """
        names = {job.name for job in self.jobs()}
        if name not in names or file not in (STUDY, TABLE, FIGURE) or not (self.folder / name / file).is_file():
            raise ParameterError(f"there is no {file!r} of a study {name!r} here. Choose one from the list")
        return self.folder / name / file

    def files_of(self, folder: Path) -> list[tuple[str, bytes]]:
        """The files of a study with their names, as a person takes them elsewhere: all but the lab's own."""
        return [(f"study/{name}", content) for name, content in files_below(folder) if name != JOB]

    def table(self, name: str) -> tuple[Study, StudyTable]:
        """A study and its table.

        Raises
        ------
        ParameterError
            There is none yet.
        """
        from ..studies import read_study, read_table

        study = read_study(self.file(name, STUDY))
        return study, read_table(self.file(name, TABLE), study.subject.keys, varied=study.varied)

    def _command(self, job: Job) -> list[str]:
        folder = self.folder / job.name
        by = [] if self.scheduler is None else ["--scheduler", self.scheduler]
        here = ["--workers", str(self.workers)] if self.workers else []
        figure = ["--language", job.language, "--figure", str(folder / FIGURE)] if job.scenario == CARVE else []
        return ["study", str(folder / STUDY), *by, *here, *figure]

    async def _ended_as(self, job: Job, last: str, took_s: float, *, cancelled: bool) -> Job:
        folder, said = self.folder / job.name, _without(self.folder / job.name, last)
        job = replace(job, took_s=job.took_s + took_s)
        if (folder / TABLE).is_file():
            return replace(job, state="done", said=await asyncio.to_thread(self._counted, job.name))
        if _IN_USE in said and not cancelled:
            await asyncio.sleep(_AGAIN_S)
            return replace(job, state="waiting", said="")
        kept = await asyncio.to_thread(_finished, folder / PARTIAL)
        of = job.points if isinstance(job, StudyJob) else 0
        finished = f"{kept} of {of} points are finished and kept."
        return replace(
            job, state="cancelled" if cancelled else "failed", said=finished if cancelled else f"{said} {finished}"
        )

    def _told(self, line: str) -> str:
        return line if _POINTS.search(line) else self.progress

    def _counted(self, name: str) -> str:
        """The outcomes of a table, as the command tells them."""
        try:
            counts = self.table(name)[1].counts()
        except SkisnowError as error:
            return str(error)
        every = "; ".join(f"{outcome.replace('_', ' ')} {count}" for outcome, count in counts.items())
        return f"{sum(counts.values())} points: {every}."


def _finished(partial: Path) -> int:
    """How many points are kept in a file that no process has any more."""
    if not partial.is_file():
        return 0
    with contextlib.suppress(SkisnowError):
        kept = KeptRows.read(partial)
        try:
            return len(kept)
        finally:
            kept.close()
    return 0


def _without(folder: Path, said: str) -> str:
    """Words without a folder, which says nothing to a reader, and without the name of the file that the lab wrote."""
    return said.replace(f"{folder / STUDY}: ", "").replace(f"{folder}/", "").removeprefix("skisnow: ")


CARVE_S: Final = 0.03
"""Of a carved turn where no study has told it yet (modelling assumption: a laptop of 2025)."""


def unit_s(of: str, values: Mapping[str, Any]) -> float:
    """How long a point takes at slowness 1 (s): one carved turn, or the time that a run simulates; 0: unknown.

    Parameters
    ----------
    of
        `CARVE` or a scenario.
    values
        Of the scenario, by key.
    """
    return CARVE_S if of == CARVE else simulated_s(values) or 0.0


def estimate_words(studies: Studies, runs: Path, jobs: list[Job], *, points: int, method: str, unit: float) -> str:
    """How many points there are and about how long they take, in words.

    Parameters
    ----------
    studies
        What the lab has studied, and who computes.
    runs, jobs
        What the lab has simulated.
    points
        How many.
    method
        Of the solver; nothing for a carved turn.
    unit
        See `unit_s`.
    """
    if not unit:
        return f"{points} points."
    found = learned(studies.study_jobs(), method)
    if found is None:
        found = slowness(runs, jobs, method) if method else 1.0
    seconds = points * unit * found
    if studies.elsewhere:
        took = duration_words(seconds)
        return f"{points} points, about {took} of one core, shared by the workers of {studies.elsewhere}."
    return f"{points} points. Will take about {duration_words(seconds / studies.workers + AROUND_S)}."


def learned(jobs: Sequence[StudyJob], method: str) -> float | None:
    """Computing time over that of slowness 1, of the last studies of this kind; None where there is none."""
    alike = [job for job in jobs if job.state == "done" and job.method == method and job.workers and job.unit_s]
    told = [job for job in alike if job.took_s > AROUND_S][:LOOKED_AT]
    work = sum(job.points * job.unit_s for job in told)
    return sum((job.took_s - AROUND_S) * job.workers for job in told) / work if work else None
