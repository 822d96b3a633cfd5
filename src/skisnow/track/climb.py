"""Vertical speed of a track from its heights, with samples: a linear model with the noise that the heights support."""

from __future__ import annotations

import itertools
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy.linalg import LinAlgError, cho_solve_banded, cholesky_banded, lapack

from .._support.arrays import FloatArray, IntArray
from .path_model import Chain, speed_chain

FloatSamples = npt.NDArray[np.float32]

CORRELATION_TIME: Final = 4.0
"""Correlation time (s) of the vertical speed (modelling assumption)."""
NOISES: Final = np.geomspace(0.003, 10.0, 9)
"""Standard deviations (m) of a height that are tried."""
RATES: Final = np.geomspace(0.02, 10.0, 7)
"""Standard deviations (m/s) of the vertical speed that are tried."""
LEAST_SHARE: Final = 0.1
"""Share of points with a height from which heights count (modelling assumption)."""
_EXCERPT: Final = 400


def climb_samples(
    time: FloatArray, height: FloatArray, part: IntArray, nodes: FloatArray, count: int, rng: np.random.Generator
) -> FloatSamples | None:
    """Samples (count, m) of the vertical speed (m/s) at nodes; None if fewer than 10 % of the points have a height.

    Parameters
    ----------
    time : (n,) s
    height : (n,) m
        NaN if unknown.
    part : (n,)
        Number of the part without a gap of each point.
    nodes : (m,) s
    """
    has_height = np.isfinite(height)
    if np.count_nonzero(has_height) < max(2.0, LEAST_SHARE * len(time)):
        return None
    rates = np.zeros((count, len(nodes)), dtype=np.float32)
    parts = [np.flatnonzero(has_height & (part == number)) for number in np.unique(part)]
    longest = max(parts, key=len)[:_EXCERPT]
    scale = _scale(time[longest], height[longest])
    for points in parts:
        inside = (nodes >= time[points[0]]) & (nodes <= time[points[-1]]) if len(points) else np.zeros(len(nodes), bool)
        if len(points) < 2 or not inside.any():
            continue
        model = _HeightModel(time[points], height[points])
        fit = model.fit(*scale)
        if fit is None:
            continue
        state, factor = fit
        place = np.interp(nodes[inside], time[points], np.arange(float(len(points))))
        before = np.minimum(place.astype(np.int64), len(points) - 2)
        share = place - before
        most = max(1, int(2e6 / len(points)))
        for begin in range(0, count, most):
            rows = slice(begin, min(begin + most, count))
            noise = rng.standard_normal((2 * len(points), rows.stop - begin))
            solved, _ = lapack.dtbtrs(factor, noise, uplo="L", trans="T")
            samples = state[:, 1] + solved.reshape(len(points), 2, -1)[:, 1].T
            rates[rows, inside] = samples[:, before] * (1.0 - share) + samples[:, before + 1] * share
    return rates


def _scale(time: FloatArray, height: FloatArray) -> tuple[float, float]:
    """Noise (m) and vertical speed (m/s) of the highest evidence."""
    model = _HeightModel(time, height)
    return max(itertools.product(NOISES.tolist(), RATES.tolist()), key=lambda pair: model.log_evidence(*pair))


class _HeightModel:
    """Height and vertical speed, an Ornstein-Uhlenbeck process, at the times of the points."""

    def __init__(self, time: FloatArray, height: FloatArray) -> None:
        self.height = height - height[0]
        self.chain: Chain = speed_chain(CORRELATION_TIME, np.maximum(np.diff(time), 1e-3))

    def fit(self, noise: float, rate: float) -> tuple[FloatArray, FloatArray] | None:
        """Height and vertical speed (n, 2), and the factor of their precision."""
        band, right = self._equations(noise, rate)
        try:
            factor = cholesky_banded(band, lower=True, check_finite=False)
        except LinAlgError:
            return None
        return cho_solve_banded((factor, True), right.ravel(), check_finite=False).reshape(-1, 2), factor

    def log_evidence(self, noise: float, rate: float) -> float:
        """Logarithm of the evidence of the noise and the vertical speed, up to a constant."""
        fit = self.fit(noise, rate)
        if fit is None:
            return -np.inf
        state, factor = fit
        explained = float(np.sum(state[:, 0] * self.height)) / noise**2
        misfit = 0.5 * (float(np.sum(self.height**2)) / noise**2 - explained)
        steps = len(self.chain.transition)
        scale = -(2 * steps + 1) * np.log(rate) - len(self.height) * np.log(noise)
        return float(scale - misfit - np.sum(np.log(factor[0])))

    def _equations(self, noise: float, rate: float) -> tuple[FloatArray, FloatArray]:
        """Lower banded matrix (4, 2 n) and right side (n, 2)."""
        count = len(self.height)
        weight = self.chain.precision / rate**2
        before = -self.chain.transition
        diagonal = np.zeros((count, 2, 2))
        diagonal[:-1] += before.transpose(0, 2, 1) @ weight @ before
        diagonal[1:] += weight
        diagonal[:, 0, 0] += noise**-2
        diagonal[0, 1, 1] += rate**-2
        below = weight @ before
        band = np.zeros((4, 2 * count))
        band[0, 0::2], band[0, 1::2], band[1, 0::2] = diagonal[:, 0, 0], diagonal[:, 1, 1], diagonal[:, 1, 0]
        band[2, 0:-2:2], band[3, 0:-2:2] = below[:, 0, 0], below[:, 1, 0]
        band[1, 1:-2:2], band[2, 1:-2:2] = below[:, 0, 1], below[:, 1, 1]
        right = np.zeros((count, 2))
        right[:, 0] = self.height / noise**2
        return band, right
