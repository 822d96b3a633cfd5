"""Simulated runs, one after another, each in a process and a folder of its own. The folders are queue and history.

A run is the folder ``NAME`` with ``job.json``: what was asked, and how it stands. What was running when the server
ended is begun again when it starts; what was waiting goes on waiting.
"""

from __future__ import annotations

import asyncio
import contextlib
import json
import os
import re
import secrets
import sys
import time
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any, Final, Literal, NamedTuple, TypeAlias

from .._support.errors import ParameterError
from .._support.language import ENGLISH
from .._support.staging import write_file
from .._support.user_files import GivenError, read_json, read_record

if TYPE_CHECKING:
    from pathlib import Path

Beside: TypeAlias = tuple[str, bytes]
State: TypeAlias = Literal["waiting", "running", "done", "failed", "cancelled"]

JOB: Final = "job.json"
LAST_WORDS: Final = 600
COMMAND: tuple[str, ...] = (sys.executable, "-m", "skisnow")
_PAUSE_S: Final = 0.3


@dataclass(frozen=True, slots=True)
class Job:
    """One simulation: its folder's name, the scenario, changed keys, when it was asked for (UTC), how it stands.

    ``given`` is what was given with it by name, in words; its paths say nothing to a reader. ``took_s`` is how long it
    took from start to report, once it is done; ``language`` is that of the report.
    """

    name: str
    scenario: str
    changes: Mapping[str, str]
    asked_at: str
    state: State = "waiting"
    said: str = ""
    given: str = ""
    took_s: float = 0.0
    language: str = ENGLISH


@dataclass(frozen=True, slots=True)
class FinishedRun:
    """What the lab reports of a finished run, out of its summary.json."""

    outcome: str
    run_length_m: float
    simulated_s: float
    remedy: str = ""

    @property
    def outcome_in_words(self) -> str:
        """The outcome without underscores."""
        return self.outcome.replace("_", " ")

    @property
    def extent(self) -> str:
        """Length and time."""
        return f"{self.run_length_m:.1f} m in {self.simulated_s:.2f} s"


class Runs:
    """The queue and the history.

    Attributes
    ----------
    folder
        Where the folders of the jobs are.
    progress
        What the running job said last.
    kind
        Of the jobs.
    """

    kind: type[Job] = Job

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.progress = ""
        self._process: asyncio.subprocess.Process | None = None
        self._running = ""
        self._cancelling = ""
        self._ended = False

    def jobs(self) -> list[Job]:
        """All jobs, the newest first."""
        found = []
        for place in self.folder.glob(f"*/{JOB}"):
            with contextlib.suppress(GivenError):  # its folder is being taken away, or it is damaged
                found.append(read_record(place, self.kind))
        return sorted(found, key=lambda job: job.asked_at, reverse=True)

    def ask(
        self,
        scenario: str,
        changes: Mapping[str, str],
        *,
        files: Mapping[str, Beside] | None = None,
        given: str = "",
        language: str = ENGLISH,
    ) -> Job:
        """Put a simulation at the end of the queue; it is on the disk when this returns.

        Parameters
        ----------
        scenario
            Its name.
        changes
            Texts by key, as the command line takes them.
        files
            By key: name and content of a file that the key is to name. It is kept with the run, so that what comes
            later changes nothing of what was asked.
        given
            See `Job`.
        language
            Of the run's report.
        """
        now = datetime.now(UTC)
        name = new_name(scenario, now)
        every = dict(changes)
        for key, (file, content) in (files or {}).items():
            write_file(self.folder / name / file, content)
            every[key] = str((self.folder / name / file).absolute())
        job = Job(name, scenario, every, now.isoformat(), given=given, language=language)
        self._keep(job)
        return job

    def cancel(self, name: str) -> None:
        """Take a waiting job out of the queue, or end the running one; what it has computed is kept.

        Raises
        ------
        ParameterError
            It neither waits nor runs.
        """
        job = next((job for job in self.jobs() if job.name == name), None)
        if job is not None and job.state == "waiting":
            self._keep(replace(job, state="cancelled", said="It had not begun."))
        elif job is not None and name == self._running:
            self._cancelling, self.progress = name, "being cancelled; what was computed is written"
            if self._process is not None:
                self._process.terminate()
        else:
            raise ParameterError("this run is over already; there is nothing to cancel")

    async def work(self) -> None:
        """Work through the queue until `end`."""
        for job in self.jobs():
            if job.state == "running":  # the server ended meanwhile
                self._keep(replace(job, state="waiting"))
        while not self._ended:
            waiting = [job for job in self.jobs() if job.state == "waiting"]
            if waiting:
                await self._run(waiting[-1])
            else:
                await asyncio.sleep(_PAUSE_S)

    def end(self) -> None:
        """End the running process with the server; its job is begun again next time."""
        self._ended = True
        if self._process is not None and self._process.returncode is None:
            self._process.kill()

    async def _run(self, job: Job) -> None:
        self._keep(replace(job, state="running"))
        self._running, self.progress = job.name, "starting"
        begun = time.monotonic()
        self._process = await asyncio.create_subprocess_exec(
            *COMMAND,
            *self._command(job),
            stdout=asyncio.subprocess.DEVNULL,
            stderr=asyncio.subprocess.PIPE,
            env={**os.environ, "SKISNOW_PROGRESS_LINES": "1"},
        )
        if self._cancelling:  # in the moment before
            self._process.terminate()
        last = await self._listen(self._process)
        await self._process.wait()
        cancelled = self._cancelling == job.name
        self._process, self._running, self._cancelling, self.progress = None, "", "", ""
        if not self._ended:
            self._keep(await self._ended_as(job, last, time.monotonic() - begun, cancelled=cancelled))

    def _command(self, job: Job) -> list[str]:
        """What is computed, in words of the command line."""
        changes = [word for key, value in job.changes.items() for word in ("--set", f"{key}={value}")]
        return ["simulate", job.scenario, *changes, "--language", job.language, "--out", str(self.folder / job.name)]

    async def _ended_as(self, job: Job, last: str, took_s: float, *, cancelled: bool) -> Job:
        """How a job stands whose process has ended with these last words."""
        over = self._over(job, last, cancelled=cancelled)
        return replace(over, took_s=took_s if over.state == "done" else 0.0)

    async def _listen(self, process: asyncio.subprocess.Process) -> str:
        last = ""
        assert process.stderr is not None
        while line := await process.stderr.readline():
            last = line.decode("utf-8", "replace").strip()
            if not self._cancelling:
                self.progress = self._told(last)
        return last[-LAST_WORDS:]

    def _told(self, line: str) -> str:
        """What is shown of a line that the running job has said."""
        return line

    def _over(self, job: Job, last: str, *, cancelled: bool) -> Job:
        summary = self.folder / job.name / "summary.json"
        if not summary.is_file():
            said = "Nothing was computed yet." if cancelled else last
            return replace(job, state="cancelled" if cancelled else "failed", said=said)
        try:
            found = read_record(summary, FinishedRun, only_known=False)
        except GivenError as error:
            return replace(job, state="failed", said=str(error))
        words = f"{found.outcome_in_words}: {found.extent}"
        if found.outcome == "interrupted":  # cancelled a moment after the end it is finished all the same
            return replace(job, state="cancelled", said=f"{words}. What was computed until then is kept.")
        return replace(job, state="done", said=f"{words}. {found.remedy}".strip())

    def _keep(self, job: Job) -> None:
        """Write down how a job stands."""
        write_file(self.folder / job.name / JOB, json.dumps(asdict(job), ensure_ascii=False, indent=1))


def new_name(what: str, now: datetime) -> str:
    """Of a folder that nobody else has: when (UTC), and what for."""
    return f"{now:%Y-%m-%d-%H%M%S}-{re.sub(r'[^A-Za-z0-9-]', '-', what)}-{secrets.token_hex(2)}"


SLOWNESS: Final = 1.0
"""Computing time over simulated time where no run has told it yet (modelling assumption: a laptop of 2025)."""
AROUND_S: Final = 8.0
"""Start, files and report of a run, where none has told it yet (modelling assumption)."""
LOOKED_AT: Final = 5
_NEVER_S: Final = 1e9
"""Thirty years: whatever is typed of such an end, no time is told for it."""


def estimated_s(folder: Path, jobs: list[Job], values: Mapping[str, Any]) -> float | None:
    """How long a run takes (s); None where its end does not say how far it goes.

    Parameters
    ----------
    folder
        Where the runs are.
    jobs
        The newest first.
    values
        Of the scenario, by key.
    """
    simulated = simulated_s(values)
    if simulated is None:
        return None
    told = _last(folder, jobs)
    around = sum(each.took - each.wall for each in told) / len(told) if told else AROUND_S
    return slowness(folder, jobs, values.get("solver.method")) * simulated + around


def slowness(folder: Path, jobs: list[Job], method: object) -> float:
    """Computing time over simulated time of the last runs with this method."""
    alike = [each for each in _last(folder, jobs) if each.method == method]
    return sum(each.wall for each in alike) / sum(each.simulated for each in alike) if alike else SLOWNESS


def duration_words(seconds: float) -> str:
    """In words, as exact as it is known.

    >>> duration_words(42.0), duration_words(600.0), duration_words(20_000.0)
    ('40 s', '10 min', '6 h')
    """
    if seconds < 90.0:
        return f"{max(5, 5 * round(seconds / 5))} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 120 else f"{round(minutes / 60)} h"


def _last(folder: Path, jobs: list[Job]) -> list[_Told]:
    return [found for job in jobs if (found := _told(folder, job)) is not None][:LOOKED_AT]


def simulated_s(values: Mapping[str, Any]) -> float | None:
    """How long the run goes on (s): its duration, or its length at the speed of the start, the shorter one."""
    duration, length, speed = (values.get(key) for key in ("run.duration_s", "run.length_m", "start.speed_m_per_s"))
    ends = [float(duration)] if duration else []
    if length and speed:
        ends.append(float(length) / float(speed))
    return min((end for end in ends if 0.0 < end < _NEVER_S), default=None)  # what is typed may be "inf" or "nan"


class _Told(NamedTuple):
    """A finished run: how long its process took, how long of that was computing, how much was simulated (s)."""

    took: float
    wall: float
    simulated: float
    method: str


def _told(folder: Path, job: Job) -> _Told | None:
    if not job.took_s:
        return None
    try:
        summary = read_json(folder / job.name / "summary.json")
        method = str(summary["scenario"]["solver"]["method"])
        return _Told(job.took_s, float(summary["wall_s"]), float(summary["simulated_s"]), method)
    except (GivenError, KeyError, TypeError, ValueError):
        return None
