"""Snows drawn at random from the uncertainty of a measured one, for ensembles."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
from scipy.special import ndtri

from ..constants import CONFIDENCE
from ..errors import ParameterError
from .properties import Interval, SnowProperties


def drawn_snows(snow: SnowProperties, count: int, generator: np.random.Generator) -> list[SnowProperties]:
    """Snows whose H_V and S_f are log-normal, each with the 95 % interval of a measured snow.

    Parameters
    ----------
    snow
        With both values and both intervals, as `snow_from_results` gives it for two experiments or more of each kind.
    count
        How many, 0 or more.
    generator
        Of random numbers; the snows follow from its state.

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
    hardness, stress = snow.snow_hardness_interval, snow.failure_shear_stress_interval
    if hardness is None or stress is None:
        raise ParameterError(
            f"the snow ({snow.source}) has no interval of {'H_V' if hardness is None else 'S_f'}; it takes two used "
            "experiments of each kind. Choose a site that has them"
        )
    if not stress[0] > 0.0:
        raise ParameterError(f"the interval of S_f begins at {stress[0]:g} N/m²; no snow above 0 can be drawn from it")
    of_hardness = _drawn(hardness, generator.standard_normal(count))
    of_stress = _drawn(stress, ndtri(1.0 - generator.random(count)))
    source = f"drawn from the intervals of {snow.source}"
    return [SnowProperties(H_V, S_f, source=source) for H_V, S_f in zip(of_hardness, of_stress, strict=True)]


def _drawn(interval: Interval, standard: npt.NDArray[np.float64]) -> list[float]:
    """Log-normal values with this 95 % interval from standard normal ones."""
    low, high = map(math.log, interval)
    half = float(ndtri(0.5 + CONFIDENCE / 2.0))
    drawn: list[float] = np.exp((low + high) / 2.0 + (high - low) / 2.0 / half * standard).tolist()
    return drawn
