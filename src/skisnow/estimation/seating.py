"""Seating: how far off the depth zero of a series was, and what that does to its hardness.

If the tool touches the snow at a gauge reading δ instead of 0, all depths of the series are δ too large: at H_V =
10 N/mm³ and 45° a seating of 0.1 mm on 0.7 mm of depth already moves H_V by a third. Often the largest systematic
error.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from .._support.display import ShownFields
from .._support.units import CONFIDENCE
from ..statistics.combined_uncertainty import expanded_factor

if TYPE_CHECKING:
    from .hardness import ReadingUncertainty
    from .readings import Readings

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True, repr=False)
class Seating(ShownFields):
    """Depth zero of m series: the tool touched at gauge reading ``offset``; true depth = reading - offset.

    Attributes
    ----------
    offset, interval
        δ (m) and its 95 % interval (m, 2); NaN with fewer than three readings or where the fit found no answer.
    hardness, hardness_interval
        H_V (N/m³) fitted together with δ, and its 95 % interval (m, 2); NaN as above.
    hardness_change
        Relative change of the largest-load H_V when δ is taken off its depth; NaN where nothing of the depth is left.
    """

    offset: FloatArray
    interval: FloatArray
    hardness: FloatArray
    hardness_interval: FloatArray
    hardness_change: FloatArray


def seating(
    readings: Readings, hardness: FloatArray, uncertainty: ReadingUncertainty, *, n_iterations: int = 60
) -> Seating:
    """Fit e = ê(F/H_V) + δ to each series by weighted Gauss-Newton in (ln H_V, δ), from ``hardness`` (N/m³) and δ = 0.

    Residuals are in depth; a reading's variance is u_e² + (ê/k)² (s² + (u_F/F)²), k = d ln V/d ln e, the error model of
    `hardness`, with s from the residuals of the series itself (n - 2 degrees of freedom).
    """
    n = readings.sums(np.ones(readings.n))
    log_H, offset, scatter2 = np.log(hardness), np.zeros(readings.n_series), np.full(readings.n_series, 1e-4)
    step = np.full(readings.n_series, np.inf)
    with np.errstate(all="ignore"):  # series without a solution run through as NaN and are separated at the end
        for _ in range(n_iterations):
            line = _linearise(readings, log_H, offset, scatter2, uncertainty)
            step, shift, _, _ = _solve(readings, line)
            step = np.clip(step, -0.5, 0.5)
            log_H, offset = log_H + step, offset + shift
            previous, scatter2 = scatter2, _scatter_step(readings, log_H, offset, scatter2, uncertainty, n)
            drift = np.abs(scatter2 - previous) / (scatter2 + 1e-12)
            if np.nanmax(np.maximum(np.abs(step), drift), initial=0.0) < 1e-7:
                break
        line = _linearise(readings, log_H, offset, scatter2, uncertainty)
        _, _, variance_H, variance_offset = _solve(readings, line)
        factor = expanded_factor(np.where(n > 2, n - 2.0, np.nan), CONFIDENCE)
        half_H, half = factor * np.sqrt(variance_H), factor * np.sqrt(variance_offset)
    lost = (n < 3) | ~np.isfinite(half) | ~(np.abs(step) < 1e-5)
    offset, log_H = np.where(lost, np.nan, offset), np.where(lost, np.nan, log_H)
    return Seating(
        offset=offset,
        interval=np.stack((offset - half, offset + half), axis=-1),
        hardness=np.exp(log_H),
        hardness_interval=np.exp(np.stack((log_H - half_H, log_H + half_H), axis=-1)),
        hardness_change=_hardness_change(readings, offset),
    )


@dataclass(frozen=True, slots=True)
class _Line:
    """The fit linearised: residual, d residual/d ln H and weight of each reading."""

    residual: FloatArray
    slope: FloatArray
    weight: FloatArray


def _linearise(
    readings: Readings, log_H: FloatArray, offset: FloatArray, scatter2: FloatArray, uncertainty: ReadingUncertainty
) -> _Line:
    series = readings.series
    volume = readings.load / np.exp(log_H)[series]
    depth = readings.depth_at_volume(volume)
    # dê/d ln F = ê/k = V/A
    per_log_force = volume / readings.area_at_depth(depth)
    known = uncertainty.depth**2 + (per_log_force * uncertainty.load / readings.load) ** 2
    variance = known + per_log_force**2 * scatter2[series]
    weight = np.where(variance > 0, 1.0 / variance, 0.0)
    residual = readings.penetration_depth - depth - offset[series]
    return _Line(residual, per_log_force, weight)


def _solve(readings: Readings, line: _Line) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Steps in ln H and in δ, variances of ln H and of δ."""
    w, J = line.weight, -line.slope  # d(prediction)/d ln H; d(prediction)/dδ = 1
    S_w, S_J, S_JJ = readings.sums(w), readings.sums(w * J), readings.sums(w * J * J)
    S_r, S_Jr = readings.sums(w * line.residual), readings.sums(w * J * line.residual)
    determinant = S_w * S_JJ - S_J**2
    step = (S_w * S_Jr - S_J * S_r) / determinant
    shift = (S_JJ * S_r - S_J * S_Jr) / determinant
    return step, shift, S_w / determinant, S_JJ / determinant


def _scatter_step(
    readings: Readings,
    log_H: FloatArray,
    offset: FloatArray,
    scatter2: FloatArray,
    uncertainty: ReadingUncertainty,
    n: FloatArray,
) -> FloatArray:
    """One Newton step on 1/Q towards Q = Σ r²/σ² = n - 2 (Paule and Mandel 1982), kept non-negative.

    At zero it stays above 1e-12, so that a series without any other uncertainty keeps finite weights.
    """
    line = _linearise(readings, log_H, offset, scatter2, uncertainty)
    squares = line.residual**2
    Q = readings.sums(line.weight * squares)
    slope = readings.sums(line.weight**2 * squares * line.slope**2)
    moved = scatter2 + (Q / (n - 2.0) - 1.0) * Q / slope
    return np.clip(np.where(slope > 0, moved, 0.0), 1e-12, 10.0)


def _hardness_change(readings: Readings, offset: FloatArray) -> FloatArray:
    """V(e₇)/V(e₇ - δ) - 1: how the hardness of Eqn 1 moves when δ is taken off the depth."""
    depth = readings.penetration_depth[readings.largest]
    left = depth - offset
    corrected = readings.volume_of_series(np.where(left > 0, left, 0.0))
    volume = readings.displaced_volume[readings.largest]
    return np.divide(volume, corrected, out=np.full(volume.shape, np.nan), where=(left > 0) & (corrected > 0)) - 1.0
