"""Folder of a simulated run, and the link from its report to a replay."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Final

from ..._support.errors import OutputError, require_language
from ..._support.messages import ENGLISH, in_language, languages
from ..._support.staging import prepare_folder, staged, write_file
from ..._support.user_files import ContentError, plain_text
from ...scenario.plausibility import implausible_values
from ...simulation.run import Run
from ...simulation.run_summary import run_gates, summary_dict
from ...simulation.run_tables import write_track
from ...track.course.gates_table import gates_csv
from ..figures.figure_files import Progress, picture_files, silent, write_pictures
from ..formatting import json_text
from .drawings import run_drawings
from .file import write_run_file
from .page import FIGURES, FURTHER, REPLAY, replay_fact, run_page

SUMMARY, GATES, PAGE = "summary.json", "gates.csv", "report.html"
_STALE: Final = (*picture_files((*FIGURES, *FURTHER)), GATES, REPLAY, "replay.glb")
_MOMENTS: Final = "replay-*s.glb"


def write_run(
    run: Run,
    folder: str | Path,
    *,
    summary: Mapping[str, Any] | None = None,
    write_more: Callable[[Path], None] | None = None,
    language: str = ENGLISH,
    progress: Progress = silent,
) -> Path:
    """Write all files of a run to a temporary folder and move them into place together.

    folder: output folder, created if necessary. Figures of an earlier run are replaced or removed; other files stay.
    summary: contents of summary.json (default: those of `summary_dict`).
    write_more: function that writes further files of the run into the temporary folder.
    language: language of the page and the figures (en, de).
    progress: callback for progress messages.
    Returns: Path of report.html.
    Raises OutputError: a file cannot be written.
    Raises ParameterError: the language is unknown.
    """
    require_language(language)
    folder = Path(folder)
    for sentence in prepare_folder(folder):
        progress(sentence)
    contents = summary_dict(run, warnings=implausible_values(run.scenario)) if summary is None else summary
    with staged(folder, last=SUMMARY) as stage:
        stage.stale += [*_STALE, *(path.name for path in folder.glob(_MOMENTS))]
        write_file(stage.path / SUMMARY, f"{json_text(contents)}\n")
        write_track(run, stage.path / "track.csv")
        result = run_gates(run)
        if result is not None:
            write_file(stage.path / GATES, gates_csv(result))
        if write_more is not None:
            write_more(stage.path)
        progress("run.nc")
        write_run_file(run, contents["scenario"], stage.path / "run.nc", provenance=contents["provenance"])
        has_replay = (stage.path / REPLAY).is_file()
        with in_language(language):
            pictures = write_pictures(run_drawings(run), stage.path / "figures", progress=progress)
            progress(PAGE)
            write_file(stage.path / PAGE, run_page(run, contents, pictures, has_replay=has_replay))
    return folder / PAGE


MOST_BYTES: Final = 1 << 26

_FACTS: Final = re.compile(r'(<dl class="facts">\n(?:<dt>.*</dd>\n)*)(</dl>)')
_LANGUAGE: Final = re.compile(r'<html lang="([a-z]+)">')


def link_replay(folder: str | Path) -> Path | None:
    """Add the link to replay.html to the facts in the report of a run.

    Returns: Path of the changed page; None if the folder has no report of a run, or the page has the link already.
    Raises OutputError: the page cannot be read or written.
    """
    path = Path(folder) / PAGE
    if not path.is_file():
        return None
    try:
        page = plain_text(path, most_bytes=MOST_BYTES)
    except ContentError as error:
        raise OutputError("{path} cannot be read: {error}. The replay is written; the report has no link").tag(
            "cannot_read", path=path, error=error
        ) from error
    linked = with_link(page)
    if linked == page:
        return None
    write_file(path, linked)
    return path


def with_link(page: str) -> str:
    r"""The page with the link in its language; unchanged if it has the link or is not the report of a run.

    >>> page = '<html lang="de">\n<p>skisnow</p><dl class="facts">\n<dt>Schnee</dt><dd>S</dd>\n</dl>\n'
    >>> print(with_link(page + '<h2 id="scenario">1</h2>'))
    <html lang="de">
    <p>skisnow</p><dl class="facts">
    <dt>Schnee</dt><dd>S</dd>
    <dt>Replay</dt><dd><a href="replay.html">der Lauf in drei Dimensionen</a></dd>
    </dl>
    <h2 id="scenario">1</h2>
    """
    declared = _LANGUAGE.search(page)
    language = declared[1] if declared and declared[1] in languages() else ENGLISH
    if f'href="{REPLAY}"' in page or "skisnow" not in page or 'id="scenario"' not in page:
        return page
    with in_language(language):
        fact = replay_fact()
    return _FACTS.sub(lambda match: f"{match[1]}{fact}\n{match[2]}", page, count=1)
