"""Files of a race, and the comparison of two lines gate by gate."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Final

from markupsafe import Markup

from ..._support.errors import ParameterError
from ..._support.language import ENGLISH
from ..._support.staging import write_file
from ...racing import write_line
from ...track.course.gate_gaps import COLUMNS, gap_rows, gaps_csv, gate_gaps
from ..figures.course import run_course
from ..figures.drawing import FORMS, pictured
from ..figures.figure_files import write_figure, write_pictures
from ..figures.style import journal_style
from ..figures.translated import translate_figure
from ..sheet import Header, Section, sheet
from ..symbols import prose
from ..tables.table import Column, Table
from .figures import gate_gaps_drawing, gate_gaps_figure, last_words, race_lines, race_worth
from .summary import evaluations_csv, race_dict, worth_csv

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from ...racing import QuickestLine, Score, Worth
    from ...simulation.run import Run
    from ...track.course.gate_gaps import GateGap
    from ..figures.drawing import Drawing, Picture

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


GAPS_CSV: Final = "gate_gaps.csv"
PAGE: Final = "report.html"
FILES: Final = (GAPS_CSV, PAGE, *(f"gate_gaps.{form}" for form in FORMS))
"""All that may be written."""
_TIMES: Final = ("time_s", "other_time_s", "gap_s", "lost_s")


def gaps_text(gaps: tuple[GateGap, ...], names: tuple[str, str]) -> str:
    """A line for each gate: both times, the gap and what was lost since the gate before."""
    rows: list[tuple[str, ...]] = [("gate", "time (s)", "other (s)", "gap (s)", "lost (s)")]
    for row in gap_rows(gaps):
        rows.append((str(row["gate"]), *(_hundredths(row[name], signed=name in _TIMES[2:]) or "-" for name in _TIMES)))
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    lines = ["  ".join(cell.rjust(width) for cell, width in zip(row, widths, strict=True)) for row in rows]
    return "\n".join([f"Gates of {names[0]} against {names[1]}, behind +", *lines, _result(gaps, names)])


def write_gaps(gaps: tuple[GateGap, ...], names: tuple[str, str], folder: Path, *, language: str = ENGLISH) -> None:
    """Write gate_gaps.csv, the figure gate_gaps and report.html, figure and page in a language.

    Raises
    ------
    OutputError
        A file cannot be written.
    """
    write_file(folder / GAPS_CSV, gaps_csv(gaps))
    pictures = write_pictures(_drawings(gaps, names), folder, every=(), language=language, names=frozenset(names))
    write_file(folder / PAGE, gaps_page(gaps, names, pictures, language=language))


def gaps_of_folders(folder: Path, other: Path, language: str = ENGLISH) -> str:
    """The page of two runs by their folders, in a language, without writing anything.

    Raises
    ------
    ParameterError
        They have no gates in common.
    """
    gaps, names = gate_gaps(folder, other), (folder.name, other.name)
    if gaps is None:
        raise ParameterError(
            f"{names[0]} and {names[1]} did not go through the same gates: choose two runs on one course"
        )
    with journal_style():
        drawn = list(_drawings(gaps, names))
        for each in drawn:
            translate_figure(each.figure, language, names=frozenset(names))
        pictures = [pictured(each) for each in drawn]
    return gaps_page(gaps, names, pictures, language=language)


def gaps_page(
    gaps: tuple[GateGap, ...], names: tuple[str, str], pictures: Sequence[Picture], *, language: str = ENGLISH
) -> str:
    """The HTML."""
    key, table = prose("{text}", text=_result(gaps, names)), gaps_table(gaps, names)
    header = Header(
        "Two runs through the same gates", f"Gates of {names[0]} against {names[1]}", [], headline=_headline(gaps)
    )
    section = Section("gates", "Gates", key=[key], pictures=pictures, tables=[table])
    return sheet(header, [section], language=language, names=frozenset(names))


def _drawings(gaps: tuple[GateGap, ...], names: tuple[str, str]) -> Iterator[Drawing]:
    if _known(gaps):
        yield gate_gaps_drawing(gaps, names)


def gaps_table(gaps: tuple[GateGap, ...], names: tuple[str, str]) -> Table:
    """A row for each gate, times to a hundredth of a second."""
    headings = ("Gate", "Outcome", "Time", "Outcome of the other", "Its time", "Gap", "Lost")
    columns = [
        Column(name, words, "text", unit="s" if name in _TIMES else "")
        for name, words in zip(COLUMNS, headings, strict=True)
    ]
    rows = [
        tuple(_hundredths(row[name], signed=name in _TIMES[2:]) if name in _TIMES else _words(row[name])
              for name in COLUMNS)
        for row in gap_rows(gaps)
    ]  # fmt: skip
    note = "Times count from the start of each run. Gap and lost: above 0 the first run is behind or loses."
    return Table("gate_gaps", f"Gates of {names[0]} against {names[1]}.", tuple(columns), rows, note=note)


def _headline(gaps: tuple[GateGap, ...]) -> Markup:
    known = _known(gaps)
    if not known:
        return Markup("")
    gap = known[-1].gap or 0.0
    return prose(
        "{value} at gate {gate}; {number} of {all} gates were crossed by both.",
        value=Markup("<strong>{:.2f} s {}</strong>").format(abs(gap), "behind" if gap > 0.0 else "ahead"),
        gate=known[-1].gate, number=str(len(known)), all=str(len(gaps)),
    )  # fmt: skip


def _result(gaps: tuple[GateGap, ...], names: tuple[str, str]) -> str:
    return last_words(gaps, names) if _known(gaps) else "No gate was crossed by both."


def _known(gaps: tuple[GateGap, ...]) -> list[GateGap]:
    return [each for each in gaps if each.gap is not None]


def _hundredths(value: float | None, *, signed: bool = False) -> str | None:
    if value is None:
        return None
    return f"{value:+.2f}" if signed else f"{value:.2f}"


def _words(cell: str) -> str:
    return cell.replace("_", " ")
