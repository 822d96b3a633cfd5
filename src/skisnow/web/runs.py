"""Queue of simulated runs, one after another, each in a separate process; their folders are the queue and the history.

A run is the folder ``NAME`` with ``job.json``: inputs and state. A run that was interrupted by the end of the server
starts again with the server.
"""

from __future__ import annotations

import asyncio
import contextlib
import json
import os
import re
import secrets
import sys
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from datetime import UTC, datetime
from itertools import count
from pathlib import Path
from typing import ClassVar, Final, Literal, TypeAlias

from .._support.errors import ParameterError
from .._support.messages import ENGLISH, LANGUAGE_OF_ERRORS, Message, in_language, joined, outcome_words, template
from .._support.staging import write_file
from .._support.user_files.json_text import read_record
from .._support.user_files.text_files import ContentError
from ..simulation.simulated_run import REMEDIES

NamedFile: TypeAlias = tuple[str, bytes]
State: TypeAlias = Literal["waiting", "running", "done", "failed", "cancelled"]

JOB: Final = "job.json"
LAST_WORDS: Final = 600
LONGEST_TITLE: Final = 80
COMMAND: tuple[str, ...] = (sys.executable, "-m", "skisnow")
_PAUSE_S: Final = 0.3


@dataclass(frozen=True, slots=True)
class Job:
    """A job of the queue: name of its folder, scenario, changed keys, time of the request (UTC), state.

    ``said``: sentence on its end. ``given``: inputs that were chosen by name, in words. ``language``: language of the
    report. ``title``: name that the user can change. ``points``: number of points of a study.
    """

    name: str
    scenario: str
    changes: Mapping[str, str]
    asked_at: str
    state: State = "waiting"
    said: str = ""
    given: str = ""
    language: str = ENGLISH
    title: str = ""
    points: int = 0

    @property
    def shown_name(self) -> str:
        """The title, or the name of the folder without one."""
        return self.title or self.name


_STATES: Final = (template("waiting"), template("running"), template("done"), template("failed"), template("cancelled"))
"""Words of the states, marked for translation."""
_PROGRESS: Final = (
    (
        re.compile(r"(?P<time>[\d.]+) s simulated, (?P<share>[\d.]+) %, (?P<rate>[\d.e+]+) times real time"),
        template("{time:.2f} s simulated, {share:.0f} %, {rate:.3g} times real time"),
    ),
    (
        re.compile(r"(?P<done>\d+) of (?P<total>\d+) points, about (?P<left>\d+) s left"),
        template("{done:.0f} of {total:.0f} points, about {left:.0f} s left"),
    ),
    (re.compile(r"(?P<done>\d+) of (?P<total>\d+) points"), template("{done:.0f} of {total:.0f} points")),
)
"""Lines of progress of the commands with their templates."""


def progress_words(line: str) -> str:
    """Message for a line of progress that a command printed; an unknown line is returned unchanged."""
    for pattern, text in _PROGRESS:
        if match := pattern.search(line):
            return Message(text, **{name: float(number) for name, number in match.groupdict().items()})
    return Message("starting") if line == "starting" else line


@dataclass(frozen=True, slots=True)
class FinishedRun:
    """Outcome of a finished run from its summary.json."""

    outcome: str
    run_length_m: float
    simulated_s: float
    remedy: str = ""

    @property
    def outcome_in_words(self) -> str:
        """Outcome of the run in words of the current language."""
        return outcome_words(self.outcome)

    @property
    def extent(self) -> str:
        """Message with length (m) and simulated time (s) of the run."""
        return Message(
            "{run_length_m:.1f} m in {simulated_s:.2f} s", run_length_m=self.run_length_m, simulated_s=self.simulated_s
        )


class Runs:
    """Queue and history of runs.

    folder: folder with the folders of the jobs.
    progress: last progress message of the running job.
    progress_lines: form of the lines of a running job that are progress messages.
    """

    progress_lines: ClassVar[re.Pattern[str]] = re.compile("")

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.progress = ""
        self._process: asyncio.subprocess.Process | None = None
        self._running = ""
        self._cancelling = ""
        self._ended = False

    def jobs(self) -> list[Job]:
        """All jobs, the newest first."""
        jobs = []
        for place in self.folder.glob(f"*/{JOB}"):
            with contextlib.suppress(ContentError):  # the folder is being removed or damaged
                jobs.append(read_record(place, Job))
        return sorted(jobs, key=lambda job: job.asked_at, reverse=True)

    def ask(
        self,
        scenario: str,
        changes: Mapping[str, str],
        *,
        files: Mapping[str, NamedFile] | None = None,
        given: str = "",
        language: str = ENGLISH,
        title: str = "",
    ) -> Job:
        """Store a simulation at the end of the queue.

        changes: values by key as on the command line.
        files: names and contents of files by the key that gets their path; they are stored with the run.
        title: words for the title, which get a number.
        """
        asked_at = datetime.now(UTC)
        name = new_name(scenario, asked_at)
        every = dict(changes)
        for key, (file, content) in (files or {}).items():
            write_file(self.folder / name / file, content)
            every[key] = str((self.folder / name / file).absolute())
        if title:
            titles = {job.title for job in self.jobs()}
            title = next(numbered for number in count(1) if (numbered := f"{title}, {number}") not in titles)
        job = Job(name, scenario, every, asked_at.isoformat(), given=given, language=language, title=title)
        self._keep(job)
        return job

    def rename(self, name: str, title: str) -> None:
        """Change a job's title; ParameterError for a blank title, one of more than 80 characters, or an unknown job."""
        title = " ".join(title.split())
        job = self._find_job(name)
        if not 0 < len(title) <= LONGEST_TITLE:
            raise ParameterError("Give the run a name of 1 to {most} characters.").tag("bad_title", most=LONGEST_TITLE)
        if job is None:
            raise ParameterError("There is no run {name}.").tag("unknown_run", name=name)
        self._keep(replace(job, title=title))

    def _find_job(self, name: str) -> Job | None:
        """Job by its name; None without one."""
        return next((job for job in self.jobs() if job.name == name), None)

    def cancel(self, name: str) -> None:
        """Remove a waiting job, or end the running one and keep its results; ParameterError if it is neither."""
        job = self._find_job(name)
        if job is not None and job.state == "waiting":
            self._keep(replace(job, state="cancelled", said="It had not begun."))
        elif job is not None and name == self._running:
            self._cancelling, self.progress = name, Message("being cancelled; the results so far are written")
            if self._process is not None:
                self._process.terminate()
        else:
            raise ParameterError("this run is over already; it cannot be cancelled").tag("run_is_over")

    async def work(self) -> None:
        """Run the jobs of the queue until `end`."""
        for job in self.jobs():
            if job.state == "running":  # the server ended meanwhile
                self._keep(replace(job, state="waiting"))
        while not self._ended:
            waiting = [job for job in self.jobs() if job.state == "waiting"]
            if waiting:
                await self._run_job(waiting[-1])
            else:
                await asyncio.sleep(_PAUSE_S)

    def end(self) -> None:
        """Stop the queue and kill the running process as the server ends; the next server starts its job again."""
        self._ended = True
        if self._process is not None and self._process.returncode is None:
            self._process.kill()

    async def _run_job(self, job: Job) -> None:
        """Run a job's command in a process to its end, and store its state."""
        self._keep(replace(job, state="running"))
        self._running, self.progress = job.name, "starting"
        self._process = await asyncio.create_subprocess_exec(
            *COMMAND,
            *self._command(job),
            stdout=asyncio.subprocess.DEVNULL,
            stderr=asyncio.subprocess.PIPE,
            env={**os.environ, "SKISNOW_PROGRESS_LINES": "1", LANGUAGE_OF_ERRORS: job.language},
        )
        if self._cancelling:  # in the moment before
            self._process.terminate()
        last = await self._follow_progress(self._process)
        await self._process.wait()
        cancelled = self._cancelling == job.name
        self._process, self._running, self._cancelling, self.progress = None, "", "", ""
        if not self._ended:
            ended = await self._ended_as(job, last, cancelled=cancelled)
            renamed = self._find_job(job.name)
            self._keep(ended if renamed is None else replace(ended, title=renamed.title))

    def _command(self, job: Job) -> list[str]:
        """Arguments of ``skisnow simulate`` for a job."""
        changes = [word for key, value in job.changes.items() for word in ("--set", f"{key}={value}")]
        return ["simulate", job.scenario, *changes, "--language", job.language, "--out", str(self.folder / job.name)]

    async def _follow_progress(self, process: asyncio.subprocess.Process) -> str:
        """Store progress lines of a process as they come; returns the end of its last line."""
        last = ""
        assert process.stderr is not None
        while line := await process.stderr.readline():
            last = line.decode("utf-8", "replace").strip()
            if not self._cancelling and self.progress_lines.search(last):
                self.progress = last
        return last[-LAST_WORDS:]

    async def _ended_as(self, job: Job, last: str, *, cancelled: bool) -> Job:
        """Copy of a job after the end of its process, with its state and a sentence about it in the job's language."""
        summary = self.folder / job.name / "summary.json"
        with in_language(job.language):
            if not summary.is_file():
                said = str(Message("Nothing has been computed yet.")) if cancelled else last
                return replace(job, state="cancelled" if cancelled else "failed", said=said)
            try:
                finished = read_record(summary, FinishedRun)
            except ContentError as error:
                return replace(job, state="failed", said=str(error.message))
            remedy = next((text for code, text in REMEDIES.items() if code == finished.outcome), finished.remedy)
            fields = {"outcome": finished.outcome_in_words, "extent": finished.extent}
            if finished.outcome == "interrupted":  # a job that was cancelled after its end counts as finished
                words = Message("{outcome}: {extent}. The results so far are kept.", **fields)
                return replace(job, state="cancelled", said=str(words))
            sentence = joined([Message("{outcome}: {extent}.", **fields), remedy])
            return replace(job, state="done", said=str(sentence).strip())

    def _keep(self, job: Job) -> None:
        """Write a job to job.json in its folder."""
        write_file(self.folder / job.name / JOB, json.dumps(asdict(job), ensure_ascii=False, indent=1))


def new_name(what: str, time_utc: datetime) -> str:
    """Unique name of a folder: time (UTC), subject, random digits."""
    return f"{time_utc:%Y-%m-%d-%H%M%S}-{re.sub(r'[^A-Za-z0-9-]', '-', what)}-{secrets.token_hex(2)}"
