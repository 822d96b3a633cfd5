"""Results as text: verdicts on two skis and two runs; for a terminal skis in snow, identifications, runs, gates."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from operator import itemgetter
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeAlias

import numpy as np

from .._support.errors import SkisnowError, SkisnowWarning
from .._support.messages import Message
from .._support.units import DEGREE
from .._support.user_files.json_text import read_json
from .._support.user_files.text_files import is_file
from ..comparison.distances import arc_lengths
from ..simulation.run_summary import run_gates
from ..track.course.gates_table import gate_rows
from ..track.track import Track
from .formatting import aligned_rows, facts_lines, named_rows, plain

if TYPE_CHECKING:
    from ..identification.result import Identification
    from ..simulation.run import Run
    from ..track.course import CourseResult

Json: TypeAlias = Mapping[str, Any]


def answers_of(contents: Json) -> list[Json]:
    """Answers in the JSON of `skisnow carve`: those under ``skis``, or the only one."""
    answers: list[Json] = contents.get("skis", [contents])
    return answers


def ski_titles(answers: list[Json]) -> list[str]:
    """Title of each ski: its name, or the given word if the names are not unique."""
    words = [str(answer["inputs"]["ski"]) for answer in answers]
    names = [str(answer["ski"]["name"]) for answer in answers]
    return names if len(set(names)) == len(set(zip(words, names, strict=True))) else words


def carve_summary(contents: Json) -> str:
    """Text for a terminal: inputs, choices of the model, and a table with one column for each ski.

    contents: JSON of `skisnow.carving.answer.answers_dict`.
    """
    answers = answers_of(contents)
    inputs, titles = answers[0]["inputs"], ski_titles(answers)
    lines: list[str] = [ski_verdict(answers[0], answer, (titles[0], title))
                        for title, answer in zip(titles[1:], answers[1:], strict=True)]  # fmt: skip
    lines += [""] if len(answers) > 1 else []
    kind = "at rest" if inputs["at_rest"] else "carving"
    angle, load, moment = (plain(inputs[key]) for key in ("edge_angle_deg", "load_N", "moment_Nm"))
    lines.append(f"{kind}: edge angle {angle} degrees, load {load} N, boot moment {moment} N m")
    lines += [f"snow: {_snow_in_words(answers[0])}", f"model: {_model_in_words(inputs)}", "", *_carve_table(answers)]
    for title, answer in zip(titles, answers, strict=True):  # half the intervals that those of the snow give
        if halves := answer.get("half_intervals"):
            words = ", ".join(f"{output} ±{plain(half, 2)}" for output, half in halves.items())
            lines.append(f"95 % intervals by the snow, {title}: {words}")
    lines += map(str, rank_warnings(contents))
    for title, answer in zip(titles, answers, strict=True):
        if answer["remedy"]:
            lines += ["", f"{title}: {answer['outcome'].replace('_', ' ')}: {answer['remedy']}"]
    return "\n".join(lines)


def _snow_in_words(answer: Json) -> str:
    """Text of a snow's numbers with intervals and source; k_u/H_V is left out at rest."""
    inputs = answer["inputs"]
    words = [f"H_V {_with_interval(answer, 'H_V', 'N_per_mm3')} N/mm3"]
    if inputs["S_f_N_per_mm2"] is not None:
        words.append(f"S_f {_with_interval(answer, 'S_f', 'N_per_mm2')} N/mm2")
    if inputs["unloading_ratio"] is not None and not inputs["at_rest"]:
        words.append(f"k_u/H_V {plain(inputs['unloading_ratio'])}")
    return f"{', '.join(words)} ({answer['snow']['source']})"


def _with_interval(answer: Json, symbol: str, unit: str) -> str:
    """Value of an input with its interval, if it has one."""
    value = plain(answer["inputs"][f"{symbol}_{unit}"])
    ends = answer["snow"][f"{symbol}_interval_{unit}"]
    return value if ends is None else f"{value} [{', '.join(plain(end) for end in ends)}]"


def _model_in_words(inputs: Json) -> str:
    """Text of the model's choices; those of the side force are left out at rest."""
    words = [f"clamp length {plain(inputs['clamp_length_m'])} m"]
    if inputs["footprint_stiffness_N_per_mm2"] is not None:
        words.append(f"footprint stiffness {plain(inputs['footprint_stiffness_N_per_mm2'])} N/mm²")
    if not inputs["at_rest"]:
        words.append(f"side force bends the ski: {_yes_or_no(inputs['side_force_bending'])}")
        words.append(f"side force spread: {inputs['side_force_spread']}")
        words.append(f"groove follows the {inputs['groove']}")
        words.append(f"moment balance: {inputs['moment_balance']}")
    return ", ".join([*words, f"twist: {_yes_or_no(inputs['twist'])}", f"elements {inputs['elements']}"])


def _yes_or_no(value: bool) -> str:
    """English word, "yes" or "no", for True or False."""
    return "yes" if value else "no"


def _maximum_of_key(key: str, *, by: Callable[[float], float] = float) -> Callable[[Json], float | None]:
    """Function that returns the maximum of an answer's list `key`, compared by `by`; None without values."""
    return lambda answer: max((value for value in answer[key] or () if value is not None), key=by, default=None)


_SAME: Final = 1e-6  # %, of rounding
_NOTHING: Final = 1e-6  # limit below which an imbalance of force or moment is rounding
_ROWS: Final[tuple[tuple[str, Callable[[Json], str | float | None]], ...]] = (
    ("outcome", lambda answer: answer["outcome"].replace("_", " ")),
    ("grip holds", lambda answer: "-" if answer["holds"] is None else _yes_or_no(answer["holds"])),
    ("side force (N)", itemgetter("side_force_N")),
    ("shear capacity of the snow (N)", itemgetter("side_force_limit_N")),
    ("grip utilisation (1: side-slip)", itemgetter("grip_utilisation")),
    ("total force of the snow (N)", itemgetter("total_force_N")),
    ("turn radius, boot and 0.4 m to each side (m)", itemgetter("turn_radius_boot_m")),
    ("the same, side force spread the other way (m)", itemgetter("turn_radius_boot_other_spread_m")),
    ("turn radius, boot and ends of contact (m)", itemgetter("turn_radius_chord_m")),
    ("turn radius, median over the contact (m)", itemgetter("turn_radius_median_m")),
    ("sidecut radius of three widths (m)", lambda answer: answer["ski"]["sidecut_radius_of_three_widths_m"]),
    ("sidecut radius of the whole edge line (m)", lambda answer: answer["ski"]["sidecut_radius_of_edge_line_m"]),
    ("contact length (m)", itemgetter("contact_length_m")),
    ("loaded contact length (m)", itemgetter("bearing_length_m")),
    ("edge depth, afterbody / forebody", itemgetter("afterbody_depth_ratio")),
    ("edge depth, maximum (mm)", _maximum_of_key("edge_depth_mm")),
    ("normal force per length, maximum (N/m)", _maximum_of_key("force_per_length_N_per_m")),
    ("deflection, maximum (mm)", _maximum_of_key("bending_mm", by=abs)),
    ("twist, maximum (degrees)", _maximum_of_key("twist_deg", by=abs)),
    ("boot moment about the ski's cross axis (N m)", itemgetter("boot_pitch_moment_Nm")),
    ("force out of balance (N)", itemgetter("residual_force_N")),
    ("moment out of balance (N m)", itemgetter("residual_moment_Nm")),
)


def _carve_table(answers: list[Json]) -> Iterator[str]:
    """Lines of the table of answers; differences to the first ski in percent, titles for two skis or more."""
    titles = ski_titles(answers)
    cells = [["", *titles, *(f"{title}/%" for title in titles[1:])]]
    for name, of in _ROWS:
        values = [of(answer) for answer in answers]
        texts = (value if isinstance(value, str) else plain(value) for value in values)
        cells.append([name, *texts, *(_difference(values[0], value) for value in values[1:])])
    lines = [line.rstrip() for line in aligned_rows(cells, left=1)]
    yield from lines if len(answers) > 1 else lines[1:]


def _difference(first: str | float | None, other: str | float | None) -> str:
    """Text of the difference of a value from the first ski in %; "" if one is missing or the first near 0."""
    if not isinstance(first, float) or not isinstance(other, float) or abs(first) < _NOTHING:
        return ""
    percent = 100.0 * (other / first - 1.0)
    return "0" if abs(percent) < _SAME else f"{percent:+.2g}"


def rank_warnings(contents: Json) -> Iterator[SkisnowWarning]:
    """Yield a warning for each pair of skis, in the JSON of carve, that definitions of the radius rank differently."""
    answers = answers_of(contents)
    for (one, first), (two, second) in itertools.combinations(zip(ski_titles(answers), answers, strict=True), 2):
        radii = [(name, of(first), of(second)) for name, of in _ROWS if "radius" in name]
        finite = [(name, a, b) for name, a, b in radii if isinstance(a, float) and isinstance(b, float)]
        tighter, wider = ([(n, a, b) for n, a, b in finite if (b - a) * side > 0.0] for side in (1.0, -1.0))
        if tighter and wider:
            (name, a, b), (other, c, d) = tighter[0], wider[0]
            yield SkisnowWarning(
                "Definitions of the radius rank {one} and {two} differently: {name} {a} and {b}, {other} {c} and {d}."
            ).tag(
                "ranks_differ", one=one, two=two, name=name, a=plain(a), b=plain(b), other=other, c=plain(c), d=plain(d)
            )


def identify_summary(result: Identification) -> str:
    """Text for a terminal on an identification: outcome, values with intervals, and effort of the search."""
    lines = [*facts_lines(result), result.reason, *(f"{name}: {kind}" for name, kind in result.data)]
    lines += [f"degrees of freedom {result.degrees_of_freedom}", *result.methods]
    effort = result.effort
    earlier = f", {effort.kept_simulations} kept from before" if effort.kept_simulations else ""
    lines.append(f"{effort.simulations} simulated runs{earlier}, {plain(effort.wall_s)} s")
    return "\n".join(lines)


def simulate_summary(run: Run, *, title: str, verification: Mapping[str, Json] | None = None) -> str:
    """Text for a terminal on a run: outcome with remedy, numbers, gates and verification."""
    lines = [f"{title}: {run.outcome.replace('_', ' ')}", *filter(None, [run.remedy]), ""]
    lines += named_rows(run._repr_facts().rows)
    if (result := run_gates(run)) is not None:
        times = [time for time in result.times if time is not None]
        between = f", {times[-1] - times[0]:.2f} s between the first and the last that was reached" if times[1:] else ""
        lines.append(f"{result.passed} of {len(result.times)} gates passed{between}")
    if verification:
        lines += ["", "computed again, finer or with another input, one at a time:"]
        rows = []
        for key, row in verification.items():
            outcome = "" if row["outcome"] == "finished" else f" ({row['outcome'].replace('_', ' ')})"
            change = f"{plain(row['was'])} to {plain(row['now'])}"
            rows.append((key, f"{change}: the end moves by {plain(row['end_moves_cm'])} cm{outcome}"))
        lines += [f"  {line}" for line in named_rows(rows)]
    return "\n".join(lines)


def gates_text(result: CourseResult) -> str:
    """Table with a line for each gate: name, outcome, times to a hundredth of a second, speed, distance."""
    rows = [("gate", "outcome", "time (s)", "split (s)", "speed (m/s)", "from the pole (m)")]
    for row in gate_rows(result):
        time, split = (f"{row[name]:.2f}" if row[name] is not None else "-" for name in ("time_s", "split_s"))
        speed, clearance = (plain(row[name], 3) for name in ("speed_m_per_s", "clearance_m"))
        rows.append((row["gate"], row["outcome"].replace("_", " "), time, split, speed, clearance))
    end = [] if result.fault is None else [str(result.fault.words)]
    return "\n".join([f"{result.passed} of {len(result.passages)} gates passed", *aligned_rows(rows), *end])


RADII: Final = ("turn_radius_boot_m", "turn_radius_boot_other_spread_m", "turn_radius_chord_m", "turn_radius_median_m")
"""Definitions of the radius of a carved turn, that of the verdict first."""
_SAME_RADIUS: Final = 5e-4  # relative difference below which two numbers count as equal: they are computed no better
_SAME_TIME: Final = 5e-3  # difference (s) of two runs below which they count as equally fast


def ski_verdict(first: Mapping[str, Any], other: Mapping[str, Any], names: tuple[str, str]) -> Message:
    """Which of two skis carves the tighter turn in the same snow.

    Both skis are in one snow: its errors change both radii, so the interval of their ratio comes from the difference
    of the relative changes. It is certain if the interval excludes 0 and all definitions of the radius agree.

    first, other: answers in the JSON of `skisnow carve`.
    """
    radii = [(first[key], other[key]) for key in RADII if first[key] is not None and other[key] is not None]
    if not radii or first[RADII[0]] is None or other[RADII[0]] is None:
        return Message("{a} and {b} cannot be compared: not both have a carved turn.", a=names[0], b=names[1])
    (one, two), *_ = radii
    if abs(two / one - 1.0) < _SAME_RADIUS:
        return Message("{a} and {b} carve the same radius, {radius:.3g} m.", a=names[0], b=names[1], radius=one)
    tight, wide, by_name = (other, first, names[::-1]) if two < one else (first, other, names)
    interval, half = _difference_interval(tight, wide)
    percent = 100.0 * (wide[RADII[0]] / tight[RADII[0]] - 1.0)
    comparison = Message(
        "{a} turns tighter than {b}: the radius of {b} is larger by {percent:.2g} %{interval}",
        a=by_name[0], b=by_name[1], percent=percent, interval=interval,
    )  # fmt: skip
    if any((b - a) * (two - one) < 0.0 for a, b in radii):
        return Message(
            "{comparison}: not certain, as another definition of the radius says the opposite.", comparison=comparison
        )
    if half is None:
        return Message("{comparison}; the snow has no interval, so this difference has none.", comparison=comparison)
    if half < percent:
        return Message("{comparison}: certain, as far as the snow decides.", comparison=comparison)
    return Message("{comparison}: not certain, as the snow is not known better.", comparison=comparison)


def _difference_interval(tight: Mapping[str, Any], wide: Mapping[str, Any]) -> tuple[str, float | None]:
    """Ends of the 95 % interval of the difference (%) in brackets, and half of it; "" and None without one."""
    changes = [side.get("radius_changes_by_snow_m") or [] for side in (tight, wide)]
    if not changes[0] or len(changes[0]) != len(changes[1]):
        return "", None
    ratio = wide[RADII[0]] / tight[RADII[0]]
    relative = [b / wide[RADII[0]] - a / tight[RADII[0]] for a, b in zip(*changes, strict=True)]
    percent, half = 100.0 * (ratio - 1.0), 100.0 * ratio * math.hypot(*relative)
    return Message(" [{low:+.2g}, {high:+.2g}]", low=percent - half, high=percent + half), half


def run_verdict(first: Track, other: Track) -> Message | None:
    """Which of two computed runs is faster over the length that both ran; None without such a length."""
    ways = [arc_lengths(run.place) for run in (first, other)]
    length = min(way[-1] for way in ways)
    if not np.isfinite(length) or length <= 0.0:
        return None
    runs = zip(ways, (first, other), strict=True)
    one, two = (float(np.interp(length, way, run.time - run.time[0])) for way, run in runs)
    if abs(one - two) < _SAME_TIME:
        return Message(
            "{a} and {b} are equally fast over the {length:.4g} m that both ran, within {limit:g} s.",
            a=first.name, b=other.name, length=length, limit=_SAME_TIME,
        )  # fmt: skip
    fast, slow = (first, other) if one < two else (other, first)
    return Message(
        "{a} is faster than {b} by {seconds:.2f} s over the {length:.4g} m that both ran. Computed runs have no "
        "scatter, so there is no interval; simulate --verify shows how exact each run is.",
        a=fast.name, b=slow.name, seconds=abs(one - two), length=length,
    )  # fmt: skip


def read_compared(path: Path) -> Track:
    """Read the track of a file, or of a run's folder with the angle of its slope, named by the path of the user."""
    from ..track.read import read_track

    file = path / "track.csv" if path.is_dir() else path
    track = read_track(file)
    return replace(track, name=str(path), slope_angle=_slope_angle_from_summary(file) if track.axes == "file" else None)


def _slope_angle_from_summary(file: Path) -> float | None:
    """Slope angle (rad) of the run that wrote a track.csv, 0 unless its slope is a plane; None for any other file."""
    summary = file.with_name("summary.json")
    if file.name != "track.csv" or not is_file(summary):
        return None
    try:
        slope = read_json(summary)["scenario"]["slope"]
        return float(slope["angle_deg"]) * DEGREE if slope["kind"] == "plane" else 0.0
    except (SkisnowError, KeyError, TypeError, ValueError):  # another program's summary, or a damaged one
        return None


def time_verdict(first: Track, other: Track) -> Message | None:
    """Which of two computed runs is faster; None if one of the tracks was measured."""
    return None if None in (first.slope_angle, other.slope_angle) else run_verdict(first, other)
