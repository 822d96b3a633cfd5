"""How far apart two tracks are along one of them: offsets between places, and their largest, mean and rms length."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from .._support.display import ShownFields

FloatArray = npt.NDArray[np.float64]

_SMOOTH: Final = 0.05
"""Below this change of the offset, in parts of its length, three Gauss points are exact to rounding."""
_GAUSS_AT: Final = 0.5 + np.sqrt(0.15) * np.array([-1.0, 0.0, 1.0])
_GAUSS_WEIGHT: Final = np.array([5.0, 8.0, 5.0]) / 18.0


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Apart(ShownFields):
    """Offsets at places along the measured track; between two of them the offset changes linearly.

    Attributes
    ----------
    arc_length : (k,) m
        Length of the measured track up to the place, not falling.
    offset : (k, d) m
        From the measured to the simulated track; NaN where there is none.
    """

    arc_length: FloatArray
    offset: FloatArray

    @property
    def distance(self) -> FloatArray:
        """Length of the offsets, (k,) (m); NaN where there is none."""
        return np.linalg.norm(self.offset, axis=1)


@dataclass(frozen=True, slots=True)
class Numbers:
    """Of distances along a track: the largest, where it is (arc length), mean and rms, over what arc length (m)."""

    max: float
    max_at: float
    mean: float
    rms: float
    compared: float


def numbers_of(apart: Apart) -> Numbers | None:
    """Largest, mean and rms distance; the means are integrals over the arc length.

    They are exact for offsets that change linearly:     ∫|δ| ds and ∫|δ|² ds, piece by piece, divided by the arc
    length. None where nothing was compared.
    """
    distance = apart.distance
    whole = np.isfinite(distance[:-1]) & np.isfinite(distance[1:])
    weight = np.where(whole, np.diff(apart.arc_length), 0.0)
    compared = float(weight.sum())
    if not compared > 0.0:
        return None
    first, last, weight = apart.offset[:-1][whole], apart.offset[1:][whole], weight[whole]
    square = ((first**2).sum(axis=1) + (first * last).sum(axis=1) + (last**2).sum(axis=1)) / 3.0
    largest = int(np.nanargmax(distance))
    return Numbers(
        max=float(distance[largest]),
        max_at=float(apart.arc_length[largest]),
        mean=float(weight @ mean_lengths(first, last)) / compared,
        rms=float(np.sqrt(weight @ square / compared)),
        compared=compared,
    )


def mean_lengths(first: FloatArray, last: FloatArray) -> FloatArray:
    """Mean length (n,) of vectors that change linearly from the first (n, d) to the last (n, d).

    With w the change, x = δ·w/|w| and h the part of δ across w: ∫ √(x² + h²) dx / |w| in closed form.

    >>> mean_lengths(np.array([[0.0, 0.0], [-1.0, 0.0]]), np.array([[3.0, 4.0], [1.0, 0.0]]))
    array([2.5, 0.5])
    """
    change = last - first
    size = np.linalg.norm(change, axis=1)
    longest = np.maximum(np.linalg.norm(first, axis=1), np.linalg.norm(last, axis=1))
    between = first[:, None, :] + _GAUSS_AT[:, None] * change[:, None, :]
    mean = np.linalg.norm(between, axis=2) @ _GAUSS_WEIGHT
    rough = size > _SMOOTH * longest
    mean[rough] = _closed_form(first[rough], change[rough] / size[rough, None], size[rough])
    return mean


def _closed_form(first: FloatArray, direction: FloatArray, size: FloatArray) -> FloatArray:
    begins = (first * direction).sum(axis=1)
    across = np.linalg.norm(first - begins[:, None] * direction, axis=1)
    return (_area(begins + size, across) - _area(begins, across)) / size


def _area(x: FloatArray, h: FloatArray) -> FloatArray:
    """∫ √(x² + h²) dx from 0."""
    safe = np.where(h > 0.0, h, 1.0)
    return 0.5 * (x * np.hypot(x, h) + np.where(h > 0.0, h**2 * np.arcsinh(x / safe), 0.0))
