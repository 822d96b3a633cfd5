"""Layering: whether the hardness of a series changes with depth, and how far that leaves its H_V open.

A series whose snow grows harder or softer below follows, near enough, F = H_V V₇ (V/V₇)^(1 + κ/2), with V₇ = F₇/H_V at
the largest load and κ = 0 for F = H_V V. κ is fitted together with H_V and the offset δ of the depth zero (`seating`).
Both bend the curve, so seven readings leave much of κ open: that belongs into the interval of H_V. The whole module is
our modelling assumption.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from .._support.units import CONFIDENCE, MM
from ..statistics.combined_uncertainty import expanded_factor

if TYPE_CHECKING:
    from .hardness import ReadingUncertainty
    from .readings import Readings

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]

SEATING_SD: Final = 0.1 * MM
"""Offsets of the depth zero that are put down to seating when layering is looked for; more bends the curve too far."""
SHOWS: Final = 0.99
"""Layering is flagged where this interval of g leaves out 1: one series in a hundred of even snow."""
FEWEST_READINGS: Final = 5
"""With fewer, nothing is flagged: three numbers are fitted."""
_ITERATIONS: Final = 40
_MINIMUM_DETERMINANT: Final = 1e-14


@dataclass(frozen=True, slots=True)
class Layering:
    """Estimates of m series with layering allowed; NaN where the fit found no solution.

    Attributes
    ----------
    load_exponent, load_exponent_error
        g of V ~ F^g, 1 for even snow, and its standard error; κ = 2/g - 2.
    hardness_interval
        95 % interval (m, 2) of H_V (N/m³).
    degrees_of_freedom
        Of both.
    """

    load_exponent: FloatArray
    load_exponent_error: FloatArray
    hardness_interval: FloatArray
    degrees_of_freedom: FloatArray


def layered(readings: Readings, hardness: FloatArray, uncertainty: ReadingUncertainty) -> BoolArray:
    """Mask of the series that show layering, with offsets of the depth zero of some `SEATING_SD` allowed."""
    enough = readings.sums(np.ones(readings.n)) >= FEWEST_READINGS
    known = enough & np.isfinite(hardness) & (hardness > 0)
    found = np.zeros(readings.n_series, dtype=np.bool_)
    if not known.any():
        return found
    fit = layering(readings.of(known), hardness[known], np.zeros(int(known.sum())), uncertainty, offset_sd=SEATING_SD)
    with np.errstate(invalid="ignore"):
        far = expanded_factor(fit.degrees_of_freedom, SHOWS) * fit.load_exponent_error
        found[known] = np.abs(fit.load_exponent - 1.0) > far
    return found


def layering(
    readings: Readings,
    hardness: FloatArray,
    offset: FloatArray,
    uncertainty: ReadingUncertainty,
    *,
    offset_sd: float = np.inf,
) -> Layering:
    """Fit e = ê(V) + δ, ln V = ln V₇ + g ln(F/F₇), g = 1/(1 + κ/2), to each series by weighted Gauss-Newton.

    From ``hardness`` (N/m³), g = 1 and ``offset`` (m). Error model and weights are those of `seating`. A finite
    ``offset_sd`` (m) is the prior of δ about 0.
    """
    fit = _Fit(readings, uncertainty, offset_sd)
    b = np.stack((np.log(hardness), np.ones(readings.n_series), np.where(np.isfinite(offset), offset, 0.0)))
    scatter2 = np.full(readings.n_series, 1e-4)
    step = np.full_like(b, np.inf)
    with np.errstate(all="ignore"):  # series without a solution run through as NaN and are separated at the end
        for _ in range(_ITERATIONS):
            step, _ = fit.step(b, scatter2)
            b = b + np.clip(step, [[-0.5], [-0.3], [-np.inf]], [[0.5], [0.3], [np.inf]])
            b[1] = np.clip(b[1], 0.1, 5.0)
            previous, scatter2 = scatter2, fit.scatter_step(b, scatter2)
            drift = np.abs(scatter2 - previous) / (scatter2 + 1e-12)
            if np.nanmax(np.maximum(np.abs(step[:2]).max(axis=0), drift), initial=0.0) < 1e-6:
                break
        _, variance = fit.step(b, scatter2)
        error = np.where(np.abs(step[:2]).max(axis=0) < 1e-4, np.sqrt(variance), np.nan)
        dof = np.where(fit.dof >= 1.0, fit.dof, np.nan)
        half = expanded_factor(dof, CONFIDENCE) * error[0]
        return Layering(
            load_exponent=b[1],
            load_exponent_error=error[1],
            hardness_interval=np.exp(np.stack((b[0] - half, b[0] + half), axis=-1)),
            degrees_of_freedom=dof,
        )


class _Fit:
    """The linearised fit of (ln H_V, g, δ), all series at once."""

    def __init__(self, readings: Readings, uncertainty: ReadingUncertainty, offset_sd: float) -> None:
        self._readings, self._uncertainty = readings, uncertainty
        self._largest = np.log(readings.load[readings.largest])
        self._log_share = np.log(readings.load) - self._largest[readings.series]
        self._prior = offset_sd**-2
        self.dof = readings.sums(np.ones(readings.n)) - (2.0 if np.isfinite(offset_sd) else 3.0)

    def _line(self, b: FloatArray, scatter2: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Residual, dê/d ln V and weight of each reading."""
        readings, series = self._readings, self._readings.series
        volume = np.exp(self._largest[series] - b[0][series] + b[1][series] * self._log_share)
        depth = readings.depth_at_volume(volume)
        slope = volume / readings.area_at_depth(depth)
        load2 = (b[1][series] * self._uncertainty.load / readings.load) ** 2
        variance = self._uncertainty.depth**2 + slope**2 * (load2 + scatter2[series])
        weight = np.divide(1.0, variance, out=np.zeros_like(variance), where=variance > 0)
        return readings.penetration_depth - depth - b[2][series], slope, weight

    def step(self, b: FloatArray, scatter2: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Gauss-Newton steps (3, m) and the variances (3, m) of the three."""
        residual, slope, weight = self._line(b, scatter2)
        J = (-slope, slope * self._log_share, np.ones_like(slope))
        sums = self._readings.sums
        normal = np.array([[sums(weight * J[i] * J[k]) for k in range(3)] for i in range(3)])
        gain = np.array([sums(weight * J[i] * residual) for i in range(3)])
        normal[2, 2] += self._prior
        gain[2] -= self._prior * b[2]
        inverse = inverse_of_each(np.moveaxis(normal, 2, 0))
        return np.einsum("mik,km->im", inverse, gain), np.einsum("mii->im", inverse)

    def scatter_step(self, b: FloatArray, scatter2: FloatArray) -> FloatArray:
        """One Newton step on 1/Q towards Q = Σ r²/σ² = degrees of freedom, as in `seating`."""
        residual, slope, weight = self._line(b, scatter2)
        Q = self._readings.sums(weight * residual**2) + self._prior * b[2] ** 2
        fall = self._readings.sums((weight * residual * slope) ** 2)
        moved = scatter2 + (Q / self.dof - 1.0) * Q / fall
        return np.clip(np.where(fall > 0, moved, 0.0), 1e-12, 10.0)


def inverse_of_each(normal: FloatArray) -> FloatArray:
    """Inverse of each (3, 3), scaled to a unit diagonal in between; NaN where it is singular."""
    root = np.sqrt(np.einsum("mii->mi", normal))
    scale = root[:, :, None] * root[:, None, :]
    scaled = np.where(scale > 0, normal / scale, np.nan)
    regular = np.isfinite(scaled).all(axis=(1, 2))
    scaled[~regular] = np.eye(3)
    regular &= np.linalg.det(scaled) > _MINIMUM_DETERMINANT
    scaled[~regular] = np.eye(3)
    inverse = np.linalg.inv(scaled) / scale
    inverse[~regular] = np.nan
    return np.asarray(inverse, dtype=float)
