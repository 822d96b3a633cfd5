"""Mean snow of several experiments with intervals, and snow drawn from the intervals."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np
from scipy.special import ndtri, stdtrit

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.units import CONFIDENCE, MM, N_PER_MM2, N_PER_MM3
from .properties import Interval, SnowProperties

_LARGEST = 1e9


def mean_snow(
    hardness_N_per_mm3: FloatArray, stress_N_per_mm2: FloatArray, *, source: str, where: str
) -> SnowProperties:
    """The snow of experiments: the geometric mean of H_V, one value or more, and the mean of S_f, which may be missing.

    With two experiments or more each mean has its 95 % interval by Student's t, both on logarithms: for the mean m of
    S_f with the half-width h, m exp(± h/m) (delta method), so that no end is below 0, as in `site_means`.

    hardness_N_per_mm3, stress_N_per_mm2: values of the used experiments, as results.json has them: both ways to a snow
        give the same bits.
    source: where the numbers come from, for `SnowProperties.source`.
    where: the same for messages.
    Raises ParameterError: a value cannot be that of a snow.
    """
    hardness, stress = hardness_N_per_mm3, stress_N_per_mm2
    if not (np.all(hardness > 0) and np.all(stress >= 0) and (stress.size == 0 or np.any(stress > 0))):
        raise ParameterError("{where}: H_V of a used experiment must be above 0, and S_f of one at least").tag(
            "out_of_range", where=where
        )
    if not (np.all(hardness >= 1.0 / _LARGEST) and np.all(hardness <= _LARGEST) and np.all(stress <= _LARGEST)):
        raise ParameterError("{where}: H_V and S_f of a used experiment must lie from 1e-9 to 1e9 N/mm³ and N/mm²").tag(
            "out_of_range", where=where
        )
    H_V, H_V_interval = _mean(np.log(hardness))
    S_f, S_f_interval = _mean(stress) if stress.size else (None, None)
    if S_f is not None and S_f_interval is not None:
        ratio = math.exp((S_f_interval[1] - S_f) / S_f)
        S_f_interval = (S_f / ratio, S_f * ratio)
    return SnowProperties(
        snow_hardness=math.exp(H_V) * N_PER_MM3,
        failure_shear_stress=None if S_f is None else S_f * N_PER_MM2,
        source=source,
        snow_hardness_interval=H_V_interval
        and (math.exp(H_V_interval[0]) * N_PER_MM3, math.exp(H_V_interval[1]) * N_PER_MM3),
        failure_shear_stress_interval=S_f_interval and (S_f_interval[0] * N_PER_MM2, S_f_interval[1] * N_PER_MM2),
    )


def with_measured_unloading(snow: SnowProperties, ratio: float, interval: Interval) -> SnowProperties:
    """The snow with its k_u/H_V and its 95 % interval, cut at 1: below, unloading would give energy away."""
    low, high = (max(1.0, end) for end in interval)
    return replace(snow, unloading_ratio=max(1.0, ratio), unloading_ratio_interval=(low, high))


def with_measured_displacement(snow: SnowProperties, displacement_mm: float, ends_mm: Interval) -> SnowProperties:
    """The snow with its shear displacement, and the 95 % interval of it where both ends are known."""
    interval = (ends_mm[0] * MM, ends_mm[1] * MM) if all(map(math.isfinite, ends_mm)) else None
    return replace(snow, shear_displacement=displacement_mm * MM, shear_displacement_interval=interval)


def site_named(site: str | None, sites: Iterable[str]) -> str | None:
    """The campaign's own name of a site: "C" also names its "site C" if it has no "C".

    >>> site_named("C", ["site A", "site C"]), site_named("site C", ["site C"]), site_named("Z", ["site C"])
    ('site C', 'site C', 'Z')
    """
    names = set(sites)
    if site is None or site in names:
        return site
    alike = [name for name in names if name.casefold() == f"site {site}".casefold()]
    return alike[0] if len(alike) == 1 else site


def site_in_words(site: str | None) -> str:
    """Name of a site after the word "site", which is not repeated; "all sites" for None.

    >>> site_in_words("C"), site_in_words("site C"), site_in_words(None)
    ('site C', 'site C', 'all sites')
    """
    if site is None:
        return "all sites"
    return site if site.casefold().startswith("site") else f"site {site}"


def no_used_experiment(source: object, site: str | None, sites: Sequence[str]) -> ParameterError:
    """Error for a campaign, or a site of one, without a used penetration experiment; ``sites`` have some."""
    if not sites:
        message = Message("{source} has no used penetration experiment at any site", source=source)
    elif site is None:
        message = Message("{source} has no used penetration experiment without a site", source=source)
    else:
        message = Message(
            "{source} has no used penetration experiment of site {site!r}; it has some of {sites}",
            source=source,
            site=site,
            sites=list(map(repr, sites)),
        )
    return ParameterError(message).tag("no_data")


def _mean(values: FloatArray) -> tuple[float, Interval | None]:
    """Mean and its 95 % interval by Student's t; the interval is None for a single value."""
    mean = math.fsum(values.tolist()) / values.size
    if values.size < 2:
        return mean, None
    quantile = float(stdtrit(values.size - 1, 0.5 + CONFIDENCE / 2.0))
    half = quantile * float(np.std(values, ddof=1)) / math.sqrt(values.size)
    return mean, (mean - half, mean + half)


def drawn_snows(snow: SnowProperties, shares: FloatArray) -> list[SnowProperties]:
    """Snows with log-normal H_V and S_f, each with the 95 % interval of a measured snow.

    snow: with both values and both intervals, as `snow_from_results` gives it for two experiments or more of each kind.
    shares: shape (count, 2), between 0 and 1 and independent: quantiles of H_V and S_f of each snow.
    Raises ParameterError: a value or an interval is not known, or the lower end of the interval of S_f is not above 0.

    The middle of each distribution is that of the interval on logarithms. The intervals are those of means, so the
    snows show how well the mean is known, not how much the snow of a slope changes from place to place. H_V and S_f are
    drawn independently (modelling assumption).
    """
    quantile = float(ndtri(0.5 + CONFIDENCE / 2.0))
    drawn: list[list[float]] = []
    for interval, column in zip(measured_intervals(snow), shares.T, strict=True):
        low, high = map(math.log, interval)
        drawn.append(np.exp((low + high) / 2.0 + (high - low) / 2.0 / quantile * ndtri(column)).tolist())
    source = f"drawn from the intervals of {snow.source}"
    return [SnowProperties(H_V, S_f, source=source) for H_V, S_f in zip(*drawn, strict=True)]


def measured_intervals(snow: SnowProperties) -> tuple[Interval, Interval]:
    """The intervals of H_V and S_f.

    Raises ParameterError: one is not known, or that of S_f does not begin above 0.
    """
    hardness, stress = snow.snow_hardness_interval, snow.failure_shear_stress_interval
    if hardness is None or stress is None:
        raise ParameterError(
            "the snow ({source}) has no interval of {quantity}, which needs two used experiments of each kind. "
            "Choose a site that has them"
        ).tag("no_data", source=snow.source, quantity="H_V" if hardness is None else "S_f")
    if not stress[0] > 0.0:
        raise ParameterError("the interval of S_f begins at {stress:g} N/m²; no snow above 0 can be drawn from it").tag(
            "out_of_range", stress=stress[0]
        )
    return hardness, stress


def log_normal(value: float, interval: Interval, shares: FloatArray) -> FloatArray:
    """Quantiles at shares (n,) of a value that is known with a 95 % interval above 0: the median is the value.

    On logarithms each side of the value is half of a separate normal distribution: the interval of a ratio that was
    turned over, or cut, does not lie evenly about it. Where it does, this is the log-normal distribution.

    >>> log_normal(9.0, (6.0, 16.0), np.array([0.025, 0.5, 0.975])).round(9).tolist()
    [6.0, 9.0, 16.0]
    """
    low, high = (math.log(end / value) for end in interval)
    place = ndtri(shares) / float(ndtri(0.5 + CONFIDENCE / 2.0))
    drawn: FloatArray = value * np.exp(place * np.where(place < 0.0, -low, high))
    return drawn
