"""A simulated run and its gates as lines for a terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...simulation.run import OPEN_SHARE
from ...track.course.gates_table import gate_rows
from ..formatting import significant

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from ...track.course import CourseResult

Json = dict[str, Any]


def simulate_summary(summary: Mapping[str, Any], *, title: str) -> str:
    """What came out of a run.

    Parameters
    ----------
    summary
        What `skisnow.simulation.run_summary.summary_dict` gives.
    title
        What the scenario is called.
    """
    lines = [f"{title}: {summary['outcome'].replace('_', ' ')}"]
    if summary["remedy"]:
        lines.append(summary["remedy"])
    width = max(len(name) for name, _ in _rows(summary))
    lines += ["", *(f"{name.ljust(width)}  {text}" for name, text in _rows(summary))]
    if "verification" in summary:
        lines += ["", *_verification(summary["verification"])]
    return "\n".join(lines)


def _plain(value: float | None, digits: int = 3) -> str:
    return significant(value, digits, style="plain")


def _rows(summary: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    end = summary["end"]
    yield "run length", f"{_plain(summary['run_length_m'], 4)} m in {_plain(summary['simulated_s'], 4)} s"
    yield "end point", f"x {_plain(end['x_m'], 4)} m, y {_plain(end['y_m'], 4)} m, z {_plain(end['z_m'], 4)} m"
    yield "heading at the end", f"{_plain(end['heading_deg'])} degrees from the fall line, positive left"
    yield (
        "speed",
        (f"{_plain(end['speed_m_per_s'])} m/s at the end, maximum {_plain(summary['greatest_speed_m_per_s'])} m/s"),
    )
    yield "turn radius", _radius(summary)
    if summary.get("gates_passed") is not None:
        yield "gates", _gates(summary)
    yield "energy residual", _residual(summary["energy_balance_error"])
    yield "steps", f"{summary['steps']}, {summary['rejected_steps']} rejected"
    yield "computed in", _computed(summary)


def _gates(summary: Mapping[str, Any]) -> str:
    """How many were passed, and the time from the first to the last."""
    times = [time for time in summary["gate_times_s"] if time is not None]
    passed = f"{summary['gates_passed']} of {len(summary['gate_times_s'])} passed"
    if len(times) < 2:
        return passed
    return f"{passed}, {times[-1] - times[0]:.2f} s between the first and the last that was reached"


def _radius(summary: Mapping[str, Any]) -> str:
    median, minimum = summary["turn_radius_median_m"], summary["turn_radius_p5_m"]
    if median is None:
        return "none, the run is straight or was over within half a second"
    return f"median {_plain(median)} m, 5 % of the time below {_plain(minimum)} m"


def _residual(error: float | None) -> str:
    if error is None:
        return "no energy was exchanged"
    return f"{_plain(100.0 * error, 2)} % of the energy exchanged{'' if error <= OPEN_SHARE else ', too large'}"


def _computed(summary: Mapping[str, Any]) -> str:
    wall, simulated = summary["wall_s"], summary["simulated_s"]
    rate = f", {_plain(simulated / wall)} times real time" if wall and simulated else ""
    return f"{_plain(wall)} s{rate}"


def _verification(verification: Mapping[str, Json]) -> Iterator[str]:
    yield "computed again, finer or with another input, one at a time:"
    width = max((len(key) for key in verification), default=0)
    for key, found in verification.items():
        other = "" if found["outcome"] == "finished" else f" ({found['outcome'].replace('_', ' ')})"
        change = f"{_plain(found['was'])} to {_plain(found['now'])}"
        yield f"  {key.ljust(width)}  {change}: the end moves by {_plain(found['end_moves_cm'])} cm{other}"


def gates_text(result: CourseResult) -> str:
    """A line for each gate: name, outcome, time to a hundredth of a second, speed, distance from the pole."""
    rows = [("gate", "outcome", "time (s)", "split (s)", "speed (m/s)", "from the pole (m)")]
    for row in gate_rows(result):
        time, split = (f"{row[name]:.2f}" if row[name] is not None else "-" for name in ("time_s", "split_s"))
        speed, clearance = (significant(row[name], 3, style="plain") for name in ("speed_m_per_s", "clearance_m"))
        rows.append((row["gate"], row["outcome"].replace("_", " "), time, split, speed, clearance))
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    lines = ["  ".join(cell.rjust(width) for cell, width in zip(row, widths, strict=True)) for row in rows]
    fault = result.fault
    end = [] if fault is None else [f"{fault.words[0].upper()}{fault.words[1:]}."]
    return "\n".join([f"{result.passed} of {len(result.passages)} gates passed", *lines, *end])
