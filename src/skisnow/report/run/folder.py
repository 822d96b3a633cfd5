"""Folder of a simulated run, and the link from its page to a replay that is written later."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from ..._support.errors import OutputError
from ..._support.language import ENGLISH, codes, require_language
from ..._support.staging import staged, tidied, write_file
from ..._support.user_files import GivenError, plain_text
from ...scenario.plausibility import implausible_values
from ...simulation.run_gates import run_gates
from ...simulation.run_summary import summary_dict
from ...simulation.run_tables import write_track
from ...track.course.gates_table import gates_csv
from ..figures.figure_files import picture_files
from ..translated import translated_html
from .page import FIGURES, FURTHER, REPLAY, REPLAY_FACT, write_run_report

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from ...simulation.run import Run

SUMMARY, GATES = "summary.json", "gates.csv"
_STALE: Final = (*picture_files((*FIGURES, *FURTHER)), GATES, REPLAY, "replay.glb")
_MOMENTS: Final = "replay-*s.glb"


def write_run(
    run: Run,
    folder: str | Path,
    *,
    summary: Mapping[str, Any] | None = None,
    beside: Callable[[Path], None] | None = None,
    language: str = ENGLISH,
    progress: Callable[[str], None] | None = None,
) -> Path:
    """Write all files beside the folder's own and move them into place: never those of two runs together.

    Parameters
    ----------
    run
        What came out.
    folder
        Made where it is missing. Other files in it stay.
    summary
        The contents of summary.json; left out: made from the run.
    beside
        Is given the folder in which all is made, for what else belongs to the run.
    language
        Of the page and the figures: en, or a language that there is a catalogue of (de).
    progress
        Called with a line of text now and then.

    Returns
    -------
    Path
        Of report.html.

    Raises
    ------
    OutputError
        A file cannot be written.
    ParameterError
        There are no texts of the language.
    """
    require_language(language)
    folder, report = Path(folder), progress or _silent
    for sentence in tidied(folder):
        report(sentence)
    contents = summary_dict(run, warnings=implausible_values(run.scenario)) if summary is None else summary
    with staged(folder, last=SUMMARY) as stage:
        stage.stale += [*_STALE, *(each.name for each in folder.glob(_MOMENTS))]
        text = json.dumps(contents, ensure_ascii=False, allow_nan=False, indent=1)
        write_file(stage.path / SUMMARY, f"{text}\n")
        write_track(run, stage.path / "track.csv")
        _write_gates(run, stage.path)
        if beside is not None:
            beside(stage.path)
        page = write_run_report(run, contents, stage.path, language=language, progress=report)
    return folder / page.name


def _write_gates(run: Run, folder: Path) -> None:
    result = run_gates(run)
    if result is not None:
        write_file(folder / GATES, gates_csv(result))


def _silent(_text: str) -> None:
    return


MOST_BYTES: Final = 1 << 26

PAGE: Final = "report.html"
_FACTS: Final = re.compile(r'(<dl class="facts">\n(?:<dt>.*</dd>\n)*)(</dl>)')
_LANGUAGE: Final = re.compile(r'<html lang="([a-z]+)">')


def link_replay(folder: str | Path) -> Path | None:
    """Put the link to replay.html among the facts of a run's report that lies beside it.

    The page is replaced in one piece; all else in it stays as it is, and one that has the link already is not touched.

    Parameters
    ----------
    folder
        Of the run.

    Returns
    -------
    Path or None
        Of the page that was changed; None where there is no report, or none that a run left, or the link is there.

    Raises
    ------
    OutputError
        The page cannot be read or written.
    """
    path = Path(folder) / PAGE
    if not path.is_file():
        return None
    try:
        page = plain_text(path, most_bytes=MOST_BYTES)
    except GivenError as error:
        raise OutputError(f"{path} cannot be read: {error}. The replay is written; the report has no link") from error
    linked = with_link(page)
    if linked == page:
        return None
    write_file(path, linked)
    return path


def with_link(page: str) -> str:
    r"""The page with the link, in its own language; the same page where that is no report of a run, or has the link.

    Examples
    --------
    >>> page = '<html lang="de">\n<p>skisnow</p><dl class="facts">\n<dt>Schnee</dt><dd>S</dd>\n</dl>\n'
    >>> print(with_link(page + '<h2 id="scenario">1</h2>'))
    <html lang="de">
    <p>skisnow</p><dl class="facts">
    <dt>Schnee</dt><dd>S</dd>
    <dt>Replay</dt><dd><a href="replay.html">der Lauf in drei Dimensionen</a></dd>
    </dl>
    <h2 id="scenario">1</h2>
    """
    said = _LANGUAGE.search(page)
    language = said[1] if said and said[1] in codes() else ENGLISH
    if f'href="{REPLAY}"' in page or "skisnow" not in page or 'id="scenario"' not in page:
        return page
    fact = translated_html(REPLAY_FACT, language)
    return _FACTS.sub(lambda found: f"{found[1]}{fact}\n{found[2]}", page, count=1)
