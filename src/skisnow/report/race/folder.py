"""Files of a race: summary, tables and figures; and the comparison of two runs gate by gate."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any, Final

from markupsafe import Markup

from ..._support.messages import Message, local_number, outcome_words, template
from ..._support.spreadsheet_text import csv_text
from ..._support.staging import prepare_folder, staged, write_file
from ...racing import QuickestLine, Score, Worth, write_line
from ...simulation.run import Run
from ...track.course.gates_table import GateGap, gaps_csv
from ..figures.course import run_course
from ..figures.drawing import FORMS, Picture, write_figure, write_pictures
from ..formatting import aligned_rows, html, json_text, prose
from ..sheet import Section
from ..table import Column, record_table
from .figures import gap_drawings, gate_gaps_figure, last_words, race_lines, race_worth

SUMMARY = "race.json"


def write_race(
    result: QuickestLine,
    folder: str | Path,
    *,
    checked: Sequence[tuple[str, Score]] = (),
    worth: Sequence[Worth] = (),
    run: Run | None = None,
    against: Sequence[str] = (),
) -> Path:
    """Write the files of a race; race.json is last: a folder with it is complete.

    checked: scores of the quickest line and of the start of the search, simulated again with the scenario's own
        settings.
    worth: variants compared with the scenario.
    run: run on the quickest line, drawn over the course.
    against: names of the variants with a table of times at each gate.
    Returns: Path of race.json.
    Raises OutputError: a file cannot be written.
    """
    folder = Path(folder)
    prepare_folder(folder)
    with staged(folder, last=SUMMARY) as stage:
        out = stage.path
        write_line(result.line, out / "line.csv")
        write_figure(out / "lines.png", lambda: race_lines(result))
        if worth:
            write_file(out / "worth.csv", worth_csv(worth))
            write_figure(out / "worth.png", lambda: race_worth(worth))
        if run is not None and len(run.time) > 1:
            write_figure(out / "course.png", lambda: run_course(run))
        for variant in worth:  # the time lost gate by gate to the scenario's own ski
            if variant.name in against and variant.scores[0].gates and variant.base[0].gates:
                names = Path(variant.name).stem, result.scenario.ski.name
                gaps = variant.gaps([gate.name for gate in result.line.course.gates])
                write_file(out / f"gaps_{names[0]}.csv", gaps_csv(gaps))
                if _crossed_by_both(gaps):
                    write_figure(out / f"gaps_{names[0]}.png", partial(gate_gaps_figure, gaps, names))
        write_file(out / SUMMARY, f"{json_text(race_dict(result, checked, worth))}\n")
    return folder / SUMMARY


GAPS_CSV: Final = "gate_gaps.csv"
FILES: Final = (GAPS_CSV, *(f"gate_gaps.{form}" for form in FORMS))  # files that `write_gaps` can write
_TIMES: Final = ("time_s", "other_time_s", "gap_s", "lost_s")


def gaps_text(gaps: tuple[GateGap, ...], names: tuple[str, str]) -> str:
    """Table for a terminal with a line for each gate: both times, the gap, the time lost since the gate before."""
    rows: list[tuple[str, ...]] = [("gate", Message("time (s)"), "other (s)", "gap (s)", "lost (s)")]
    rows += [(gap.gate, *(text or "-" for text in _time_texts(gap).values())) for gap in gaps]
    heading = Message("Gates of {name} against {name_2}, behind +", name=names[0], name_2=names[1])
    return "\n".join([heading, *aligned_rows(rows), last_words(gaps, names)])


def write_gaps(gaps: tuple[GateGap, ...], names: tuple[str, str], folder: Path) -> list[Picture]:
    """Write gate_gaps.csv and the figure gate_gaps, whose picture is returned for the page.

    Raises OutputError: a file cannot be written.
    """
    pictures = write_pictures(gap_drawings(gaps, names), folder)
    write_file(folder / GAPS_CSV, gaps_csv(gaps))  # the whole table, instead of the points that the figure shows
    return pictures


def gaps_section(gaps: tuple[GateGap, ...], names: tuple[str, str], pictures: Sequence[Picture]) -> Section:
    """Section of a page with the time lost from gate to gate, to a hundredth of a second, in the current language."""
    headings = (Message("Gate"), Message("Outcome"), Message("Time"), Message("Outcome of the other"),
                Message("Its time"), Message("Gap"), Message("Lost"))  # fmt: skip
    columns = [
        Column(name, words, "text", unit="s" if name in _TIMES else "")
        for name, words in zip(GateGap._fields, headings, strict=True)
    ]
    records: list[dict[str, str | None]] = [
        {name: text and local_number(text) for name, text in _time_texts(gap).items()}
        | {"gate": gap.gate, "outcome": outcome_words(gap.outcome), "other_outcome": outcome_words(gap.other_outcome)}
        for gap in gaps
    ]
    note = Message("Times count from the start of each run. Gap and lost: above 0 the first run is behind or loses.")
    caption = Message("Gates of {run} against {other}.", run=names[0], other=names[1])
    table = record_table("gate_gaps", caption, tuple(columns), records, note=note)
    key = [html(last_words(gaps, names))]
    return Section("gates", Message("Gates"), key=key, pictures=pictures, tables=[table])


def gaps_headline(gaps: tuple[GateGap, ...]) -> Markup:
    """Sentence in HTML with the gap at the last gate that both crossed; empty without one."""
    crossed = _crossed_by_both(gaps)
    if not crossed:
        return Markup("")
    gap = crossed[-1].gap_s or 0.0
    value = Markup("<strong>{} s</strong>").format(local_number(f"{abs(gap):.2f}"))
    sentence = template("{value} ahead at gate {gate}; {number} of {all} gates were crossed by both.")
    if gap > 0.0:
        sentence = template("{value} behind at gate {gate}; {number} of {all} gates were crossed by both.")
    return prose(sentence, value=value, gate=crossed[-1].gate, number=len(crossed), all=len(gaps))


def _crossed_by_both(gaps: tuple[GateGap, ...]) -> list[GateGap]:
    """Gaps at gates that both tracks crossed."""
    return [gap for gap in gaps if gap.gap_s is not None]


def _time_texts(gap: GateGap) -> dict[str, str | None]:
    """Texts of the times of a gate to a hundredth of a second, gap and lost with their sign; None without one."""
    times, signs = gap._asdict(), {"gap_s": "+", "lost_s": "+"}
    return {name: None if times[name] is None else f"{times[name]:{signs.get(name, '')}.2f}" for name in _TIMES}


def race_summary(result: QuickestLine, checked: Sequence[tuple[str, Score]]) -> str:
    """Text for the terminal: times, time gained, scores `checked` by other methods, and the turns of the line."""
    gates = len(result.line.turns)
    gained = "" if result.gained is None else f", {result.gained:.3f} s less than where the search began"
    lines = [f"{gates} gates in {_time_text(result.score)}{gained}; {len(result.history)} evaluations"]
    lines += [f"{name}: {_time_text(score)}" for name, score in checked]
    lines.append(f"{'gate':>6} {'aside (m)':>10} {'along':>7} {'turning':>8} {'speed':>6}")
    for gate, turn in zip(result.line.course.gates, result.line.turns, strict=True):
        lines.append(f"{gate.name:>6} {turn.aside:10.2f} {turn.along:7.3f} {turn.turning:8.2f} {turn.speed:6.2f}")
    return "\n".join(lines)


def worth_summary(variants: Sequence[Worth]) -> str:
    """Table for a terminal with a line for each variant: its time less that of the scenario, on all snows."""
    width = max(len(variant.name) for variant in variants)
    lines = [
        f"{'time more than as it is (s)':{width}}  {'own snow':>9} {'mean':>8} {'± s.d.':>8} {'95 % of snows':>16}  "
        "faster on"
    ]
    for variant in variants:
        through = len(variant.differences)
        deviation = "-" if variant.deviation is None else f"{variant.deviation:.3f}"
        interval = ", ".join(map(_signed_text, variant.interval or ())) or "-"
        lines.append(
            f"{variant.name:{width}}  {_signed_text(variant.on_own_snow):>9} {_signed_text(variant.mean):>8} "
            f"{deviation:>8} {interval:>16}  {variant.faster} of {through} snows"
            + (f": {variant.verdict}" if variant.interval else "")
            + ("" if through == len(variant.scores) else f", {len(variant.scores) - through} not through all gates")
        )
    return "\n".join(lines)


def race_dict(
    result: QuickestLine, checked: Sequence[tuple[str, Score]], worth: Sequence[Worth] = ()
) -> dict[str, Any]:
    """Values of race.json: the quickest line with times and turns, checks by other methods, and worths."""
    return {
        "model": result.model,
        "seed": result.seed,
        "evaluations": len(result.history),
        "time_s": result.score.time,
        "began_from_s": result.start_score.time,
        "gained_s": result.gained,
        "outcome": result.score.words,
        "checked": {name: {"time_s": score.time, "outcome": score.words} for name, score in checked},
        "turns": [
            {
                "gate": gate.name,
                "aside_m": turn.aside,
                "along": turn.along,
                "turning": turn.turning,
                "speed": turn.speed,
            }
            for gate, turn in zip(result.line.course.gates, result.line.turns, strict=True)
        ],
        "worth": [
            {
                "name": variant.name,
                "on_own_snow_s": variant.on_own_snow,
                "mean_s": variant.mean,
                "deviation_s": variant.deviation,
                "interval_s": variant.interval,
                "verdict": variant.verdict,
                "faster_on": variant.faster,
                "snows": len(variant.scores),
                "compared": len(variant.differences),
            }
            for variant in worth
        ],
    }


def worth_csv(variants: Sequence[Worth]) -> str:
    """Contents of worth.csv: times of each variant and of the unchanged scenario on each snow."""
    head = ("variant", "snow", "time_s", "time_as_it_is_s", "outcome", "outcome_as_it_is")
    rows = [
        (variant.name, i, score.time, base.time, score.words, base.words)
        for variant in variants
        for i, (score, base) in enumerate(zip(variant.scores, variant.base, strict=True))
    ]
    return csv_text([head, *rows])


def _time_text(score: Score) -> str:
    """Time of a score (s), or its words if it has none."""
    return score.words if score.time is None else f"{score.time:.3f} s"


def _signed_text(value: float | None) -> str:
    """Number with sign and three decimals; "-" for None."""
    return "-" if value is None else f"{value:+.3f}"
