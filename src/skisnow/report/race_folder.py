"""What a race leaves: race.json, line.csv, evaluations.csv, figures, and what was compared."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

from .._support.staging import write_file
from ..racing import write_line
from ..track.course.gate_gaps import gaps_csv
from .figures.figure_file import write_figure
from .figures.gate_gaps import gate_gaps_figure
from .figures.race_lines import race_lines
from .figures.race_worth import race_worth
from .figures.run_course import run_course
from .race_summary import evaluations_csv, race_dict, worth_csv

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..racing import QuickestLine, Score, Worth
    from ..simulation.run import Run

SUMMARY = "race.json"


def write_race(
    found: QuickestLine,
    folder: str | Path,
    *,
    checked: Sequence[tuple[str, Score]] = (),
    worth: Sequence[Worth] = (),
    run: Run | None = None,
    against: Sequence[str] = (),
) -> Path:
    """Write it; race.json last, so that what it tells of is there.

    Parameters
    ----------
    found
        The line.
    folder
        Where to.
    checked
        The quickest line and where it began, raced again as the scenario says it.
    worth
        What was compared.
    run
        On the quickest line, drawn over the course.
    against
        Of what was compared the names whose time is told gate by gate.

    Returns
    -------
    Path
        Of race.json.

    Raises
    ------
    OutputError
        A file cannot be written.
    """
    folder = Path(folder)
    write_line(found.line, folder / "line.csv")
    write_file(folder / "evaluations.csv", evaluations_csv(found))
    write_figure(folder / "lines.png", lambda: race_lines(found))
    if worth:
        write_file(folder / "worth.csv", worth_csv(worth))
        write_figure(folder / "worth.png", lambda: race_worth(worth))
    if run is not None and len(run.time) > 1:
        write_figure(folder / "course.png", lambda: run_course(run))
    gates = [gate.name for gate in found.line.course.gates]
    for each in worth:
        if each.name in against and each.scores[0].gates and each.base[0].gates:
            _write_gaps(each, gates, folder, found.scenario.ski.name)
    contents = race_dict(found, checked, worth)
    text = json.dumps(contents, ensure_ascii=False, allow_nan=False, indent=1)
    write_file(folder / SUMMARY, f"{text}\n")
    return folder / SUMMARY


def _write_gaps(worth: Worth, gates: Sequence[str], folder: Path, own: str) -> None:
    """Time lost gate by gate to the scenario's own ski; the file is named after the other one."""
    name = Path(worth.name).stem
    gaps = worth.gaps(gates)
    write_file(folder / f"gaps_{name}.csv", gaps_csv(gaps))
    if any(each.gap is not None for each in gaps):
        write_figure(folder / f"gaps_{name}.png", lambda: gate_gaps_figure(gaps, (name, own)))
