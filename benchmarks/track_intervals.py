"""Coverage of the 95 % intervals of highest speed and length over simulated tracks without recorded speeds.

``python -m benchmarks.track_intervals`` prints a Markdown table with a row for each kind of track; the table of the
documentation is its output for the seeds from 5000. The model was designed with the seeds 0 to 199 and 1000 to 1199.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Final, Literal, NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.integrate import cumulative_trapezoid

from skisnow.track.path_estimate import Interval, estimate_path

FloatArray = npt.NDArray[np.float64]

FINE_STEP: Final = 2e-3
"""Step (s) of the true path."""


@dataclass(frozen=True)
class Kind:
    """A kind of track: linked turns with speeds from 5 to 20 m/s.

    Attributes
    ----------
    speed
        Constant, or with a slow swing of 15 % and 5 % in each turn.
    noise
        Standard deviation of a coordinate (m).
    correlation_time
        Correlation time of the noise (s); 0: from point to point.
    rate
        Points a second.
    turn_factor
        Periods of left and right turn are this times 3 to 12 s.
    """

    speed: Literal["constant", "varied"] = "constant"
    noise: float = 0.5
    correlation_time: float = 0.0
    rate: float = 1.0
    turn_factor: float = 1.0
    duration: float = 60.0


KINDS: Final = {
    "constant speed, noise 0.05 m": Kind(noise=0.05),
    "constant speed, noise 0.5 m": Kind(),
    "constant speed, noise 1 m": Kind(noise=1.0),
    "single turns of 3 to 12 s, noise 1 m": Kind(noise=1.0, turn_factor=2.0),
    "varied speed, noise 0.5 m": Kind("varied"),
    "varied speed, noise 1.5 m over 20 s": Kind("varied", noise=1.5, correlation_time=20.0),
    "varied speed, noise 0.3 m, 5 Hz": Kind("varied", noise=0.3, rate=5.0, duration=30.0),
}


class SimulatedTrack(NamedTuple):
    """Times (s), places (n, 3) (m, without heights), and the true highest speed (m/s) and length (m)."""

    time: FloatArray
    place: FloatArray
    max_speed: float
    length: float


def simulated_track(kind: Kind, seed: int) -> SimulatedTrack:
    """A track of this kind."""
    rng = np.random.default_rng([seed, 20261128])
    fine = np.arange(0.0, kind.duration + FINE_STEP / 2.0, FINE_STEP)
    period, speed = kind.turn_factor * rng.uniform(3.0, 12.0), rng.uniform(5.0, 20.0)
    if kind.speed == "constant":
        heading = np.radians(rng.uniform(30.0, 75.0)) * np.cos(2.0 * np.pi * (fine / period + rng.random()))
        speeds = np.full(len(fine), speed)
    else:
        heading = _uneven_turns(fine, period, rng)
        slow = 0.15 * np.sin(2.0 * np.pi * (fine / rng.uniform(20.0, 60.0) + rng.random()))
        speeds = speed * (1.0 + slow + 0.05 * np.cos(2.0 * heading))
    true = [cumulative_trapezoid(speeds * part, fine, initial=0) for part in (np.sin(heading), np.cos(heading))]
    time = np.arange(0.0, kind.duration + 1e-9, 1.0 / kind.rate)
    place = np.column_stack([*(np.interp(time, fine, axis) for axis in true), np.full(len(time), np.nan)])
    place[:, :2] += _noise(kind, len(time), rng)
    return SimulatedTrack(time, place, float(speeds.max()), float(np.trapezoid(speeds, fine)))


def _uneven_turns(time: FloatArray, period: float, rng: np.random.Generator) -> FloatArray:
    """Heading (rad) of turns whose durations differ by up to 30 %, with the turn rate of a raised cosine."""
    rate, begin, side = np.zeros(len(time)), 0.0, 1.0
    while begin < time[-1]:
        duration, angle = period / 2.0 * rng.uniform(0.7, 1.3), np.radians(rng.uniform(60.0, 140.0))
        inside = (time >= begin) & (time < begin + duration)
        rate[inside] = side * angle / duration * (1.0 - np.cos(2.0 * np.pi * (time[inside] - begin) / duration))
        begin, side = begin + duration, -side
    heading = cumulative_trapezoid(rate, time, initial=0)
    return np.asarray(heading - heading.mean())


def _noise(kind: Kind, count: int, rng: np.random.Generator) -> FloatArray:
    noise = kind.noise * rng.standard_normal((count, 2))
    if kind.correlation_time:
        kept = np.exp(-1.0 / kind.rate / kind.correlation_time)
        for point in range(1, count):
            noise[point] = kept * noise[point - 1] + np.sqrt(1.0 - kept**2) * noise[point]
    return noise


class Found(NamedTuple):
    """Estimates and truths of one track."""

    track: SimulatedTrack
    max_speed: Interval
    length: Interval


def estimates(kind: Kind, seeds: range) -> list[Found]:
    """Estimates of simulated tracks."""
    found = []
    for seed in seeds:
        track = simulated_track(kind, seed)
        one = np.zeros(len(track.time), dtype=np.int64)
        path = estimate_path(track.time, track.place, one, one)
        speed = None if path is None else path.max_speed()
        if path is not None and speed is not None:
            found.append(Found(track, speed, path.length()))
    return found


def row(name: str, found: list[Found]) -> str:
    """A row of the table: coverage, median width and root mean square error of both."""
    cells = [name, str(len(found))]
    for truths, intervals in (
        ([each.track.max_speed for each in found], [each.max_speed for each in found]),
        ([each.track.length for each in found], [each.length for each in found]),
    ):
        truth, (value, low, high) = np.array(truths), np.array(intervals).T
        inside = np.mean((low <= truth) & (truth <= high))
        cells += [f"{100.0 * inside:.1f} %", f"{100.0 * np.median((high - low) / truth):.1f} %"]
        cells += [f"{100.0 * np.sqrt(np.mean((value / truth - 1.0) ** 2)):.1f} %"]
    return f"| {' | '.join(cells)} |"


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.track_intervals")
    parser.add_argument("--tracks", type=int, default=200, help="of each kind")
    parser.add_argument("--first", type=int, default=5000, help="first seed (default: 5000)")
    parser.add_argument("--kind", choices=list(KINDS), help="this kind only (default: all)")
    options = parser.parse_args()
    print("| tracks | number | speed: coverage | width | error | length: coverage | width | error |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for name in [options.kind] if options.kind else KINDS:
        print(row(name, estimates(KINDS[name], range(options.first, options.first + options.tracks))), flush=True)


if __name__ == "__main__":
    main()
