"""Comparison of the campaign with published values."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from .._support.arrays import BoolArray, FloatArray, IntArray, index_names
from .._support.errors import FitError
from .._support.messages import Message
from .._support.units import CONFIDENCE, N_PER_MM2, N_PER_MM3
from ..snow.published import domine_2011, federolf_2006, moessner_2013
from ..statistics.combined_uncertainty import expanded_factor
from ..statistics.linear import cluster_intervals

FEWEST_SITES: Final = 4
"""Fewer sites do not show how sites scatter (two leave one degree of freedom): no interval over them (assumption)."""


@dataclass(frozen=True, slots=True)
class CampaignMean:
    """Mean over the campaign: value and 95 % interval, NaN if unknown or withheld; minimum and maximum.

    With several sites the interval takes them as clusters; under four sites it is withheld.
    """

    value: float = math.nan
    low: float = math.nan
    high: float = math.nan
    minimum: float = math.nan
    maximum: float = math.nan


@dataclass(frozen=True, slots=True)
class Comparison:
    """One published value or range next to the campaign's own; the name of the quantity contains the unit."""

    source: str
    quantity: str
    published: float | tuple[float, float]
    own: CampaignMean

    def as_dict(self) -> dict[str, Any]:
        """Entry of results.json: source, quantity, own and published values."""
        own = self.own
        published: dict[str, Any] = (
            {"range": list(self.published)} if isinstance(self.published, tuple) else {"value": self.published}
        )
        return {
            "source": self.source,
            "quantity": self.quantity,
            **published,
            "own": own.value,
            "own_interval": [own.low, own.high],
            "own_range": [own.minimum, own.maximum],
        }


def own_mean(values: FloatArray, sites: Sequence[str], *, geometric: bool) -> CampaignMean:
    """Mean of this campaign's used experiments with its 95 % interval; geometric for hardness, which spans decades.

    The interval is one of the logarithm of the mean, so that no bound of a positive quantity is negative: for a plain
    mean m with half-width h, m exp(± h/m) (delta method).

    >>> own = own_mean(np.array([1.0, 3.0]), ["A", "A"], geometric=False)  # h = t₁ · 1 = 12.706
    >>> round(own.value, 9), round(float(np.log(own.high / 2.0)), 3), own.low > 0
    (2.0, 6.353, True)
    """
    if values.size == 0 or (geometric and np.any(values <= 0)):
        return CampaignMean()
    data = np.log(values) if geometric else values
    mean, half = float(data.mean()), _half_width(data, index_names(sites)[1])
    if geometric:
        mean = float(np.exp(mean))
    else:
        half = half / mean if mean > 0 else float("nan")
    low, high = (mean * np.exp([-half, half])).tolist()
    return CampaignMean(mean, low, high, float(values.min()), float(values.max()))


@dataclass(frozen=True, slots=True)
class SiteValue:
    """Geometric mean over n used experiments of a site (None: of all), and its 95 % interval, NaN for n = 1."""

    site: str | None
    n: int
    value: float
    low: float
    high: float


def site_values(values: FloatArray, used: BoolArray, site: Sequence[str]) -> tuple[SiteValue, ...]:
    """Mean of each site in alphabetical order, then of all together; empty without a used and finite value.

    ``values`` (m,) are above 0, ``used`` is a mask over the m experiments, ``site`` the name of the site of each.
    """
    counted = used & np.isfinite(values)
    names = np.array(site, dtype=object)
    if not counted.any():
        return ()
    rows = []
    for name in (*sorted(set(names[counted].tolist())), None):
        mask = counted if name is None else counted & (names == name)
        own = own_mean(values[mask], names[mask].tolist(), geometric=True)
        rows.append(SiteValue(name, int(mask.sum()), own.value, own.low, own.high))
    return tuple(rows)


def _half_width(data: FloatArray, sites: IntArray) -> float:
    """Half of the 95 % interval of the mean; NaN for one value, and for more than one site but fewer than four."""
    n_sites = len(np.unique(sites))
    if n_sites >= FEWEST_SITES:
        try:
            low, high = cluster_intervals(data, np.empty((len(data), 0)), sites).intervals[0]
        except FitError:
            return float("nan")
        return float(high - low) / 2.0
    if n_sites > 1 or len(data) < 2:
        return float("nan")
    return float(expanded_factor(len(data) - 1.0, CONFIDENCE)) * float(data.std(ddof=1)) / float(np.sqrt(len(data)))


def compare_with_published(
    hardness: CampaignMean,
    stress: CampaignMean,
    angle_term: tuple[CampaignMean, CampaignMean],
    shear_density: CampaignMean,
) -> tuple[Comparison, ...]:
    """Compare means with published values; `shear_density`: snow density (kg/m³) at which laws of S_f are taken."""
    H_V, S_f = "H_V_N_per_mm3", "S_f_N_per_mm2"
    paper, paper_range = moessner_2013.SOURCE, Message("{source}, range", source=moessner_2013.SOURCE)
    rows = [
        Comparison(paper_range, H_V, moessner_2013.SNOW_HARDNESS_RANGE_N_PER_MM3, hardness),
        Comparison(paper_range, S_f, moessner_2013.FAILURE_SHEAR_STRESS_RANGE_N_PER_MM2, stress),
    ]
    for snow in federolf_2006.named_snows().values():
        rows.append(Comparison(snow.source, H_V, snow.snow_hardness / N_PER_MM3, hardness))
        if snow.failure_shear_stress is not None:
            rows.append(Comparison(snow.source, S_f, snow.failure_shear_stress / N_PER_MM2, stress))
    rows += [
        Comparison(Message("{source}, Eqn 11", source=paper), quantity, value, own)
        for quantity, value, own in zip(("b0", "b1_per_rad"), moessner_2013.ANGLE_TERM, angle_term, strict=True)
    ]
    if np.isfinite(shear_density.value):
        for law_source, law in (
            (Message("{source}, Eqn 14", source=paper), moessner_2013.failure_shear_stress_from_density),
            (domine_2011.SOURCE, domine_2011.failure_shear_stress_from_density),
        ):
            source = Message(
                "{source} at this campaign's mean {density:.0f} kg/m³", source=law_source, density=shear_density.value
            )
            rows.append(Comparison(source, S_f, float(law(shear_density.value)) / N_PER_MM2, stress))
    return tuple(rows)
