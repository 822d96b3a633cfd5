"""The folder of a simulated run: summary.json, track.csv, run.nc, figures and report.html, all of one run."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from .._support.language import ENGLISH, require_language
from .._support.staging import staged, tidied, write_file
from ..scenario.plausibility import implausible_values
from ..simulation.run_gates import run_gates
from ..simulation.run_summary import summary_dict
from ..simulation.track_table import write_track
from ..track.course.gates_table import gates_csv
from .pictures import picture_files
from .run_report import FIGURES, FURTHER, REPLAY, write_run_report

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from ..simulation.run import Run

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
