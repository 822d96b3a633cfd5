"""A run as JSON values, and the gates of its course: SI numbers become the units that the keys name.

Nothing is rounded, nothing is NaN.
"""

from __future__ import annotations

import hashlib
import platform
from collections.abc import Iterable, Mapping, Sequence
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any, Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.units import DEGREE
from .._support.user_files.json_text import json_number
from ..scenario.keys import in_sections, scenario_values
from ..scenario.scenario import course_on_slope
from ..snow.from_results import snow_dict
from ..track.course import Course, CourseResult, MovingPoint, passages
from ..track.course.gates_table import gates_dict
from ..track.course.passages import track_point
from ..track.track import Track
from .run import GIVEN, LEAST_OPEN, LOST, OPEN_SHARE, STORED, Run

SCHEMA_VERSION: Final = 1


def summary_dict(
    run: Run,
    values: Mapping[str, Any] | None = None,
    *,
    files: Iterable[Path] = (),
    warnings: Sequence[str] = (),
    verification: Mapping[str, Any] | None = None,
) -> dict[str, Any]:
    """The contents of summary.json; its JSON Schema is that of ``skisnow schema summary``.

    values: every key of the scenario as `ScenarioFile.values` has it; default: taken from the run's scenario.
    files: files of the scenario, for their SHA-256.
    verification: result of `verification_dict`, if the run was repeated.
    """
    checked = {} if verification is None else {"verification": dict(verification)}
    gates, finite = run_gates(run), run.speed[np.isfinite(run.speed)]
    return {
        "schema_version": SCHEMA_VERSION,
        "outcome": run.outcome,
        "remedy": run.remedy,
        "run_length_m": json_number(run.run_length),
        "simulated_s": json_number(run.simulated_s),
        "wall_s": json_number(run.wall_s),
        "steps": int(run.steps),
        "rejected_steps": int(run.rejected_steps),
        "end": end_dict(run),
        "greatest_speed_m_per_s": float(finite.max()) if finite.size else None,
        "least_turn_radius_m": least_turn_radius(run),
        **radii_dict(run),
        **({"gates_passed": None, "gates_missed": [], "gate_times_s": []} if gates is None else gates_dict(gates)),
        "energies": energies_dict(run),
        "energy_balance_error": json_number(run.energy_balance_error),
        "numbers": {name: json_number(value) for name, value in run.numbers.items()},
        "laws": run.given_laws,
        "scenario": in_sections(scenario_values(run.scenario) if values is None else values),
        "snow": snow_dict(run.scenario.contact.snow),
        "ski": {"name": run.scenario.ski.name, "source": run.scenario.ski.source},
        **checked,
        "warnings": [*warnings, *run_warnings(run)],
        "provenance": _provenance_json(files),
    }


def energies_dict(run: Run) -> dict[str, float | None]:
    """Energies (J) at the end and at the start, the losses between, and the energy from moving boots and pushes."""
    stored = {f"{name}_J": json_number(run.energies[name][-1]) for name in STORED}
    start = {f"{name}_start_J": json_number(run.energies[name][0]) for name in STORED}
    energies_given = {f"given_{name}_J": json_number(run.energies[name][-1]) for name in GIVEN if name in run.energies}
    return stored | start | {f"lost_{name}_J": json_number(run.energies[name][-1]) for name in LOST} | energies_given


def end_dict(run: Run) -> dict[str, float | None]:
    """Position, speed and heading of the middle between the boots at the end."""
    x, y, z = run.place[-1]
    return {
        "time_s": json_number(run.simulated_s),
        "x_m": json_number(x),
        "y_m": json_number(y),
        "z_m": json_number(z),
        "speed_m_per_s": json_number(run.speed[-1]),
        "heading_deg": json_number(run.heading[-1] / DEGREE),
    }


def least_turn_radius(run: Run) -> float | None:
    """The tightest turn radius (m), positive left; None of a straight run."""
    finite = run.turn_radius[np.isfinite(run.turn_radius)]
    return float(finite[np.argmin(np.abs(finite))]) if finite.size else None


def radii_dict(run: Run) -> dict[str, float | None]:
    """Median and 5 % quantile of the turn radius (m), without its sign and once the start is over; None if straight."""
    return {"turn_radius_median_m": run.turn_radius_quantile(0.5), "turn_radius_p5_m": run.turn_radius_quantile(0.05)}


def run_warnings(run: Run) -> tuple[str, ...]:
    """Warnings about the numbers of a run, in words: an energy residual that is too large."""
    error = run.energy_balance_error
    if not (run.has_residual_above(OPEN_SHARE) or (error is None and run.energy_residual > LEAST_OPEN)):
        return ()
    share = "" if error is None else f"{100.0 * error:.2g} % of the energy exchanged, "
    return (
        f"the energy residual is {share}{run.energy_residual:.3g} J: where and how fast the run ends is less "
        "certain than its digits say. Take smaller steps or a smaller tolerance, and see how far the end moves",
    )


def _provenance_json(files: Iterable[Path]) -> dict[str, Any]:
    """JSON of a run's inputs: hashes of files, versions and the present time."""
    packages = ("skisnow", "numpy", "scipy")
    return {
        "files": {str(path): hashlib.sha256(path.read_bytes()).hexdigest() for path in files},
        "versions": {"python": platform.python_version()} | {name: version(name) for name in packages},
        "time": datetime.now(UTC).isoformat(timespec="seconds"),
    }


def time_gates(course: Course, moving: Run | Track) -> CourseResult:
    """Determine which gates of a course were passed, and when.

    Parameters
    ----------
    course
        In the metres of the run or track. A course in degrees is laid on a run's slope by its
        `fall_line_azimuth_deg`; a track in degrees is compared with it from the course's origin.
    moving
        A run, of which both feet and both ski tips must cross a gate's line; or a track, a single point, for which a
        straddled pole cannot be detected.

    Returns
    -------
    CourseResult
        For each gate passed, straddled, missed, backwards or not reached, with time, speed and distance from the pole.

    Raises
    ------
    ParameterError
        There are fewer than two places, only one of track and course is in degrees, or the direction of x of the run is
        missing.

    See Also
    --------
    skisnow.read_course
    skisnow.read_track

    Notes
    -----
    The time at a gate is that at which the middle between the boots, or the track's point, crosses the line through its
    poles, on a cubic through the stored points with their velocities.

    References
    ----------
    The page docs/files/scenario.md.
    """
    if isinstance(moving, Track):
        return passages(course, track_point(moving, course), {})
    course = course_on_slope(course, moving.scenario.slope)
    middle = MovingPoint(moving.time, moving.place[:, :2], moving.velocity[:, :2])
    return passages(course, middle, racer_parts(moving))


def racer_parts(run: Run) -> dict[str, MovingPoint]:
    """Both feet and both ski tips, from above."""
    side, tip = run.scenario.sledge.stance_width / 2.0, float(run.scenario.ski.station[0])
    if run.boots is not None:
        return feet_and_tips(run.time, run.boots.place, run.boots.place + tip * run.boots.axes[:, :, 0])
    beside = np.array([[0.0, side, 0.0], [0.0, -side, 0.0]])
    feet, tips = (run.place[:, None] + np.einsum("nab,kb->nka", run.attitude, offsets)
                  for offsets in (beside, beside + np.array([tip, 0.0, 0.0])))  # fmt: skip
    return feet_and_tips(run.time, feet, tips)


def feet_and_tips(time: FloatArray, feet: FloatArray, tips: FloatArray) -> dict[str, MovingPoint]:
    """Points that must cross the line of a gate, from the places (n, 2, 3) of feet and tips (m) at times (n,) (s)."""
    return {
        f"{name} {part}": MovingPoint(time, place[:, ski, :2])
        for part, place in (("foot", feet), ("tip", tips))
        for ski, name in enumerate(("left", "right"))
    }


def run_gates(run: Run) -> CourseResult | None:
    """Result at the gates of the scenario's course; None without a course, or if the run has a single moment."""
    course = run.scenario.course
    return None if course is None or len(run.time) < 2 else time_gates(course, run)


class GatesAhead:
    """The gates of a course that a run has not passed yet."""

    def __init__(self, course: Course | None) -> None:
        self._lines = () if course is None else course.lines
        self._next = 0

    def is_over(self, place: FloatArray, clear: float) -> bool:
        """True if a racer at a place (m) is past the last gate by more than `clear` (m)."""
        while self._next < len(self._lines):
            line = self._lines[self._next]
            if float((place[:2] - line.pole) @ line.along) <= clear:
                return False
            self._next += 1
        return bool(self._lines)
