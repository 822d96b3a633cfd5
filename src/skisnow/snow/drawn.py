"""Snows drawn at random from the uncertainty of a measured one, for ensembles."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
from scipy.special import ndtri

from .._support.constants import CONFIDENCE
from .._support.errors import ParameterError
from .properties import Interval, SnowProperties


def drawn_snows(snow: SnowProperties, shares: npt.NDArray[np.float64]) -> list[SnowProperties]:
    """Snows whose H_V and S_f are log-normal, each with the 95 % interval of a measured snow.

    Parameters
    ----------
    snow
        With both values and both intervals, as `snow_from_results` gives it for two experiments or more of each kind.
    shares
        Shape (count, 2), between 0 and 1 and independent: where in the distributions of H_V and S_f each snow lies.

    Raises
    ------
    ParameterError
        A value or an interval is not known, or the lower end of the interval of S_f is not above 0.

    Notes
    -----
    The middle of each distribution is that of the interval on logarithms. The intervals are those of means, so the
    snows show how well the mean is known, not how much the snow of a slope changes from place to place. H_V and S_f are
    drawn independently (modelling assumption).
    """
    hardness, stress = measured_intervals(snow)
    of_hardness, of_stress = _drawn(hardness, shares[:, 0]), _drawn(stress, shares[:, 1])
    source = f"drawn from the intervals of {snow.source}"
    return [SnowProperties(H_V, S_f, source=source) for H_V, S_f in zip(of_hardness, of_stress, strict=True)]


def measured_intervals(snow: SnowProperties) -> tuple[Interval, Interval]:
    """The intervals of H_V and S_f.

    Raises
    ------
    ParameterError
        One is not known, or that of S_f does not begin above 0.
    """
    hardness, stress = snow.snow_hardness_interval, snow.failure_shear_stress_interval
    if hardness is None or stress is None:
        raise ParameterError(
            f"the snow ({snow.source}) has no interval of {'H_V' if hardness is None else 'S_f'}; it takes two used "
            "experiments of each kind. Choose a site that has them"
        )
    if not stress[0] > 0.0:
        raise ParameterError(f"the interval of S_f begins at {stress[0]:g} N/m²; no snow above 0 can be drawn from it")
    return hardness, stress


def log_normal(value: float, interval: Interval, shares: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Quantiles at shares (n,) of a value that is known with a 95 % interval above 0: the median is the value.

    On logarithms each side of the value is half of a normal distribution of its own: the interval of a ratio that was
    turned over, or cut, does not lie evenly about it. Where it does, this is the log-normal distribution.

    >>> log_normal(9.0, (6.0, 16.0), np.array([0.025, 0.5, 0.975])).round(9).tolist()
    [6.0, 9.0, 16.0]
    """
    low, high = (math.log(end / value) for end in interval)
    place = ndtri(shares) / float(ndtri(0.5 + CONFIDENCE / 2.0))
    drawn: npt.NDArray[np.float64] = value * np.exp(place * np.where(place < 0.0, -low, high))
    return drawn


def _drawn(interval: Interval, shares: npt.NDArray[np.float64]) -> list[float]:
    """Quantiles of the log-normal distribution with this 95 % interval."""
    low, high = map(math.log, interval)
    half = float(ndtri(0.5 + CONFIDENCE / 2.0))
    drawn: list[float] = np.exp((low + high) / 2.0 + (high - low) / 2.0 / half * ndtri(shares)).tolist()
    return drawn
