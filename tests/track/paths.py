"""Paths whose heading and curvature are known exactly, as tracks."""

import numpy as np

from skisnow._support.arrays import FloatArray
from skisnow.track.track import Track

NOISE = 0.02
"""m: a good receiver's, point by point."""


def track(
    place: FloatArray, *, interval: float = 0.1, noise: float = 0.0, seed: int = 0, speed: FloatArray | None = None
) -> Track:
    """Points (n, 2 or 3) at even times as a track, with white noise on both coordinates."""
    place = np.column_stack([place, np.full((len(place), 3 - place.shape[1]), np.nan)])
    place[:, :2] += noise * np.random.default_rng(seed).standard_normal((len(place), 2))
    time: FloatArray = interval * np.arange(float(len(place)))
    unknown = np.full(len(place), np.nan)
    return Track("made", time, place, unknown if speed is None else speed, "local", "made up")


def circle(radius: float, speed: float, *, duration: float = 8.0, interval: float = 0.1) -> FloatArray:
    """A circle to the left, from the origin along x; radius below 0: to the right."""
    angle = speed * np.arange(round(duration / interval) + 1) * interval / radius
    return np.stack([radius * np.sin(angle), radius * (1.0 - np.cos(angle))], axis=1)


def along(curvature: FloatArray, step: float) -> FloatArray:
    """Path whose curvature (1/m) is given at ways ``step`` (m) apart, by the midpoint rule."""
    heading = np.concatenate([[0.0], np.cumsum(step * (curvature[1:] + curvature[:-1]) / 2.0)])
    middle = (heading[1:] + heading[:-1]) / 2.0
    steps = step * np.stack([np.cos(middle), np.sin(middle)], axis=1)
    return np.concatenate([[[0.0, 0.0]], np.cumsum(steps, axis=0)])
