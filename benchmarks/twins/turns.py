"""One twin of a turn: its truth, its track, what is identified from it, and how far that is from the truth."""

from dataclasses import replace
from typing import Final

import numpy as np
from scipy.interpolate import CubicSpline
from tests.present import present

from skisnow import Run
from skisnow.comparison import compare_tracks
from skisnow.identification import Identification, identify
from skisnow.track.track import Track

from .kept import Row, interval_row, number
from .truth import FREE, Truth, track_of, true_run, truth_of

ELASTIC: Final = ", elastic"
"""Behind a scenario's name: the same truth, identified with snow that springs back."""


NOISELESS: Final = ", without noise"
"""Behind a scenario's name: what the finer numbers of the truth alone do to the answer."""


def one_turn(scenario: str, seed: int) -> list[tuple[str, Row]]:
    """Rows by case: the scenario, and for seeds without model error the same identified with elastic snow."""
    truth = truth_of(scenario, seed)
    run = true_run(scenario, truth)
    track = track_of(run, truth, seed)
    rows = [(scenario, identified(scenario, track, run, truth, {}))]
    if not truth.error:
        rows.append((scenario + ELASTIC, identified(scenario, track, run, truth, {"snow.penetration": "elastic"})))
    return rows


def one_noiseless(case: str, seed: int) -> list[tuple[str, Row]]:
    """The truth of an even seed with the stated accuracy, but without noise."""
    scenario = case.removesuffix(NOISELESS)
    truth = truth_of(scenario, seed)
    run = true_run(scenario, truth)
    return [(case, identified(scenario, track_of(run, truth, seed, noise=0.0), run, truth, {}))]


def identified(scenario: str, track: Track, run: Run, truth: Truth, changes: dict[str, object]) -> Row:
    """Result beside the truth."""
    found = identify(scenario, track, FREE, changes=changes, workers=1)
    if found.outcome == "interrupted":
        raise KeyboardInterrupt  # half a twin does not count
    nearest, at_time = largest_deviations(found, run)
    row = {
        "error": truth.error,
        "outcome": found.outcome,
        "run_length_m": number(run.run_length),
        "largest_nearest_m": number(nearest),
        "largest_at_time_m": number(at_time),
        "rms_residual": number(float(np.sqrt(np.mean((found.fits[0].residual / found.fits[0].sd)[:, :2] ** 2)))),
        "simulations": str(found.effort.simulations),
        "wall_s": f"{found.effort.wall_s:.0f}",
    }
    for key in FREE:
        row |= interval_row(found[key], truth.values[key])
    return row


def largest_deviations(found: Identification, run: Run) -> tuple[float, float]:
    """Between the identified run and the true one, without noise: at the nearest place, and at equal time (m).

    The identified places, 10 Hz, are joined by a spline: within 1 mm of a run that turns with R = 14 m.
    """
    fit = found.fits[0]
    within = run.time <= fit.along[-1]
    time = run.time[within]
    true = track_as(time, run.place[within])
    computed = CubicSpline(fit.along, fit.fitted[:, :2])(time)
    simulated = track_as(time, np.column_stack([computed, np.full(len(time), np.nan)]))
    held = compare_tracks(simulated, true, from_above=True)
    return present(held.nearest.numbers).max, present(held.time.numbers).max


def track_as(time: np.ndarray, place: np.ndarray) -> Track:
    """Places without noise."""
    unknown = np.full(len(time), np.nan)
    plain = Track(name="run", time=time, place=place, speed=unknown, time_scale="local", frame="slope")
    return replace(plain, axes="slope")
