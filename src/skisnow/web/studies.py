"""Queue of studies, one after another, each in a separate process; their folders are the queue.

A study is the folder ``NAME`` with ``study.toml`` and its files, ``job.json``, and finally its table and figure.
Computed points are kept, so that an interrupted study continues.
"""

from __future__ import annotations

import asyncio
import contextlib
import re
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Final

from .._support.errors import ParameterError, SkisnowError
from .._support.messages import ENGLISH, Message, in_language, joined, outcome_words
from .._support.processes.batch import available_cores
from .._support.processes.kept_rows import KeptRows
from .._support.staging import write_file
from ..studies import Study, StudyTable
from .page_requests import hidden_folder
from .runs import JOB, Job, Runs, new_name
from .scenario_fields import typed_form
from .study_fields import CARVE, MOST_POINTS, STUDY, TABLE, StudyQuestion, study_keys
from .uploads import files_below
from .words import replaced

FOLDER: Final = "studies"
FIGURE: Final = "map.svg"
PARTIAL: Final = f"{TABLE}.partial"
_IN_USE: Final = "is being written by another run"
_AGAIN_S: Final = 3.0  # time (s) before a new attempt: a process of an earlier server ends at its next progress message


class Studies(Runs):
    """Queue and history of studies in a subfolder; a job has the fixed inputs as changes, the varied as given."""

    progress_lines = re.compile(r"^\d+ of \d+ points")

    def __init__(self, folder: Path) -> None:
        super().__init__(folder / FOLDER)

    def ask_for(self, question: StudyQuestion, language: str = ENGLISH) -> Job:
        """Store a study, whose map has a language, at the end of the queue; ParameterError if it is not valid."""
        from ..studies import read_study

        asked_at = datetime.now(UTC)
        name = new_name(question.of, asked_at)
        with hidden_folder(self.folder) as made:
            for file, content in question.files().items():
                write_file(made / file, content)
            try:
                points = len(read_study(made / STUDY).points)
                if points > MOST_POINTS:
                    raise ParameterError(
                        "the study has {points} points; the lab accepts at most {most}. Use fewer values, or the "
                        "command skisnow study, which accepts 100,000"
                    ).tag("too_many_points", points=points, most=MOST_POINTS)
            except ParameterError as error:
                raise ParameterError(_without_folder(made, error.message)).tag(error.code) from error
            made.chmod(0o755)
            made.rename(self.folder / name)  # it becomes a study with its job.json
        with in_language(language):
            given = question.varied_words()
        keys = study_keys(question.of)
        fixed = {name: typed_form(value) for name, value in question.fixed.items() if name in keys}
        job = Job(name, question.of, fixed, asked_at.isoformat(), given=given, points=points, language=language)
        self._keep(job)
        return job

    def go_on(self, name: str) -> None:
        """Add a cancelled or failed study to the queue again, with its finished points; ParameterError for others."""
        job = self._find_job(name)
        if job is None or job.state not in ("cancelled", "failed"):
            raise ParameterError("this study waits, is running or is done; it cannot be continued").tag("not_stopped")
        self._keep(replace(job, state="waiting", said=""))

    def file(self, name: str, file: str) -> Path:
        """Path of a file of a study; ParameterError if there is no such study or it does not have the file yet."""
        names = {job.name for job in self.jobs()}
        if name not in names or file not in (STUDY, TABLE, FIGURE) or not (self.folder / name / file).is_file():
            raise ParameterError("there is no {file!r} of a study {study!r} here. Choose one from the list").tag(
                "unknown_file", file=file, study=name
            )
        return self.folder / name / file

    def files_of(self, folder: Path) -> list[tuple[str, bytes]]:
        """Names and contents of a study's files for a zip, without job.json."""
        return [(f"study/{name}", content) for name, content in files_below(folder) if name != JOB]

    def table(self, name: str) -> tuple[Study, StudyTable]:
        """A study and its table. Raises ParameterError: the study has no table yet."""
        from ..studies import read_study, read_table

        study = read_study(self.file(name, STUDY))
        return study, read_table(self.file(name, TABLE), study.subject.keys, varied=study.varied)

    def _command(self, job: Job) -> list[str]:
        """Arguments of skisnow for a study's job; a core stays free for the pages."""
        folder = self.folder / job.name
        workers = str(max(1, available_cores() - 1))  # a core stays free for the pages
        figure = ["--language", job.language, "--figure", str(folder / FIGURE)] if job.scenario == CARVE else []
        return ["study", str(folder / STUDY), "--workers", workers, *figure]

    async def _ended_as(self, job: Job, last: str, *, cancelled: bool) -> Job:
        """Job after its process ended: done with counts, waiting again, cancelled, or failed with its last words."""
        folder, said = self.folder / job.name, _without_folder(self.folder / job.name, last)
        if (folder / TABLE).is_file():
            counts = await asyncio.to_thread(self._outcome_counts, job.name, job.language)
            return replace(job, state="done", said=counts)
        if _IN_USE in said and not cancelled:
            await asyncio.sleep(_AGAIN_S)
            return replace(job, state="waiting", said="")
        n_finished = await asyncio.to_thread(_finished, folder / PARTIAL)
        kept = Message("{done} of {all} points are finished and kept.", done=n_finished, all=job.points)
        finished = kept.text(job.language)
        if cancelled:
            return replace(job, state="cancelled", said=finished)
        return replace(job, state="failed", said=f"{said} {finished}")

    def _outcome_counts(self, name: str, language: str) -> str:
        """Text such as "15 points: finished 12; fell 3."; the message of the error if the table cannot be read."""
        try:
            counts = self.table(name)[1].counts()
        except SkisnowError as error:
            return error.text(language)
        words = {outcome_words(outcome): count for outcome, count in counts.items()}
        every = [Message("{outcome} {count}", outcome=outcome, count=count) for outcome, count in words.items()]
        points = Message("{points} points: {outcomes}.", points=sum(counts.values()), outcomes=joined(every, "; "))
        return points.text(language)


def _finished(partial: Path) -> int:
    """Number of computed points in the file of an unfinished study; 0 if the file is missing or damaged."""
    with contextlib.suppress(SkisnowError), contextlib.closing(KeptRows.read(partial)) as rows:
        return len(rows)
    return 0


def _without_folder(folder: Path, message: str) -> str:
    """A message without the path of the study's folder and file."""
    if not isinstance(message, Message):
        return message.replace(f"{folder / STUDY}: ", "").replace(f"{folder}/", "").removeprefix("skisnow: ")
    return replaced(message, {str(folder / STUDY): STUDY, f"{folder}/": ""})
