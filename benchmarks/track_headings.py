"""Coverage of the 95 % interval of a fitted heading over simulated tracks: ``python -m benchmarks.track_headings``.

Prints a Markdown table with a row for each kind. The interval was designed with the seeds 0 to 119; the documentation
prints the seeds from 1000.
"""

from __future__ import annotations

import argparse
import math
from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt

from skisnow.comparison.alignment import Motion, fit_motion
from skisnow.comparison.distances import Polyline, polyline

FloatArray = npt.NDArray[np.float64]

KINDS: Final = {
    "linked turns": ("turns", 0.0),
    "one turn whose radius falls": ("carved", 0.0),
    "linked turns, correlated errors": ("turns", 0.8),
    "arc of one radius": ("arc", 0.0),
}
"""Shape of the track, and correlation of the errors of neighbouring points."""


class FittedTrack(NamedTuple):
    """The answer of a fit, and its error (rad)."""

    motion: Motion
    error: float

    @property
    def covers(self) -> bool | None:
        """True if the interval contains the truth; None without an interval."""
        half = self.motion.turned_error
        return None if half is None else abs(self.error) <= half


def fitted_track(shape: str, correlation: float, seed: int) -> FittedTrack:
    """Fit a track of 25 to 80 m to 20 to 150 measured points of it, or of 40 to 100 % of it.

    The errors of a coordinate are 0.01 to 0.5 m.
    """
    rng = np.random.default_rng([seed, 31])
    path = _path(shape, rng)
    count = len(path)
    first, last = (0, count) if rng.random() < 0.5 else (rng.uniform(0.0, 0.3) * count, rng.uniform(0.7, 1.0) * count)
    turned, points = rng.uniform(-math.pi, math.pi), int(rng.uniform(20.0, 150.0))
    at, size = np.linspace(int(first), int(last) - 1, points), 10.0 ** rng.uniform(-2.0, -0.3)
    place = np.column_stack([np.interp(at, np.arange(count), axis) for axis in path.T])
    error = rng.normal(size=place.shape)
    for point in range(1, points):
        error[point] = correlation * error[point - 1] + math.sqrt(1.0 - correlation**2) * error[point]
    cosine, sine = math.cos(turned), math.sin(turned)
    place = (place - path[0]) @ np.array([[cosine, sine], [-sine, cosine]]) + path[0] + rng.normal(size=2) * 20.0
    motion = fit_motion(_timed(path), _timed(place + size * error), start=True, heading=True)
    return FittedTrack(motion, math.remainder(motion.turned - turned, math.tau))


def _path(shape: str, rng: np.random.Generator) -> FloatArray:
    """Places (n, 2) (m) every few centimetres."""
    length, count = rng.uniform(25.0, 80.0), 600
    at = np.linspace(0.0, length, count)
    if shape == "turns":
        wave, swing = rng.uniform(12.0, 35.0), rng.uniform(0.4, 1.1)
        heading = swing * np.cos(2.0 * np.pi * (at / wave + rng.random()))
        heading += 0.2 * np.sin(2.0 * np.pi * at / (2.7 * wave) + rng.random())
        longest = math.inf
    elif shape == "carved":
        largest = rng.uniform(12.0, 30.0)
        curvature = 1.0 / largest + (1.0 / rng.uniform(6.0, largest) - 1.0 / largest) * at / length
        heading = np.cumsum(curvature) * (length / count) * rng.choice([-1, 1])
        longest = 3.0
    else:
        heading, longest = at / rng.uniform(8.0, 25.0), 2.5
    heading = heading[np.abs(heading) < longest]
    steps = length / (count - 1) * np.column_stack([np.cos(heading), np.sin(heading)])
    return np.asarray(np.cumsum(steps, axis=0))


def _timed(place: FloatArray) -> Polyline:
    return polyline(place, np.linspace(0.0, 5.0, len(place)))


def row(name: str, tracks: list[FittedTrack]) -> str:
    """A row of the table."""
    covers = [track.covers for track in tracks if track.covers is not None]
    halves = [track.motion.turned_error for track in tracks if track.motion.turned_error is not None]
    share = f"{100.0 * np.mean(covers):.1f} %" if covers else ""
    half = f"{np.degrees(np.median(halves)):.2f}°" if halves else ""
    error = np.degrees(np.median([abs(track.error) for track in tracks]))
    return f"| {name} | {len(tracks)} | {len(tracks) - len(covers)} | {share} | {half} | {error:.2f}° |"


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.track_headings")
    parser.add_argument("--tracks", type=int, default=200, help="of each kind (default: 200)")
    parser.add_argument("--first", type=int, default=1000, help="first seed (default: 1000)")
    parser.add_argument("--kind", choices=list(KINDS), help="this kind only (default: all)")
    options = parser.parse_args()
    print("| tracks | number | without an interval | coverage | median half width | median error |")
    print("| --- | --- | --- | --- | --- | --- |")
    for name in [options.kind] if options.kind else KINDS:
        seeds = range(options.first, options.first + options.tracks)
        print(row(name, [fitted_track(*KINDS[name], seed) for seed in seeds]), flush=True)


if __name__ == "__main__":
    main()
