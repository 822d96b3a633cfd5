"""The paper's regressions: S_f and H_V on edge angle, density, drop-cone depth and on each other.

A further regression is one more entry in ``PLANS``. Variables carry their unit in their name and are regressed in it,
as the paper prints them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from .._support.content import index_names
from .._support.display import ShownFields
from .._support.errors import FitError
from .._support.messages import Message
from ..statistics.clusters import cluster_intervals
from ..statistics.linear import LinearFit, linear_fit
from .observations import (
    ANGLE_KEY,
    DENSITY_KEY,
    DROP_CONE_KEY,
    HARDNESS_KEY,
    PEN_DENSITY_KEY,
    PEN_FORCE_KEY,
    STRESS_KEY,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from .models import ModelFit
    from .observations import Observations

FloatArray = npt.NDArray[np.float64]
Source: TypeAlias = Literal["penetration", "shear", "spots"]

FEWEST_TESTS: Final = 5
FEWEST_ANGLES: Final = 3
FEWEST_VALUES: Final = 4
"""A predictor that takes fewer values does not show a relation: what differs between them may be anything (modelling
assumption)."""
POOR: Final = 0.5
"""A selected law whose rmse is above this share of the loads' rms leaves a quarter of their squares open (modelling
assumption)."""
_ACTION: Final = Message("Look for wrong units, depths or tools, and for snow that follows none of these laws.")


@dataclass(frozen=True, slots=True)
class RegressionPlan:
    """Which response on which predictor, over which observations; ``by_site`` adds a regression for each site."""

    source: Source
    response: str
    predictor: str
    by_site: bool = False


PLANS: Final = (
    RegressionPlan("shear", STRESS_KEY, ANGLE_KEY, by_site=True),
    RegressionPlan("shear", STRESS_KEY, DENSITY_KEY),
    RegressionPlan("shear", STRESS_KEY, DROP_CONE_KEY),
    RegressionPlan("penetration", HARDNESS_KEY, DENSITY_KEY),
    RegressionPlan("penetration", HARDNESS_KEY, DROP_CONE_KEY),
    RegressionPlan("spots", STRESS_KEY, HARDNESS_KEY),
)
RECORDING_PLANS: Final = (
    RegressionPlan("penetration", HARDNESS_KEY, PEN_FORCE_KEY),
    RegressionPlan("penetration", HARDNESS_KEY, PEN_DENSITY_KEY),
)
"""Planned where the campaign has recordings of a SnowMicroPen."""


@dataclass(frozen=True, repr=False)
class Regression(ShownFields):
    """A regression with intercept on one predictor; ``fit`` is None where the data do not determine it.

    ``predictor_values`` counts the different values that the predictor takes. ``interval_by_site`` (2, 2) treats sites
    as clusters; None for a single site, NaN where the sites leave it open.
    """

    plan: RegressionPlan
    group: str
    n: int
    predictor_values: int
    fit: LinearFit | None
    interval_by_site: FloatArray | None

    @property
    def withheld(self) -> str | None:
        """Why the F test of a slope is not given; None where it is, or where there is no slope."""
        if self.fit is None or self.predictor_values >= FEWEST_VALUES:
            return None
        return Message(
            "the predictor takes {predictor_values} different values, fewer than {fewest_values}, and whatever else "
            "differs between them would show as well",
            predictor_values=self.predictor_values,
            fewest_values=FEWEST_VALUES,
        )


def regressions(observations: Mapping[Source, Observations]) -> tuple[Regression, ...]:
    """All planned regressions: sites first where planned, then all together."""
    found: list[Regression] = []
    of_recordings = [plan for plan in RECORDING_PLANS if plan.predictor in observations[plan.source].columns]
    for plan in (*PLANS, *of_recordings):
        data = observations[plan.source]
        x, y = data.columns[plan.predictor], data.columns[plan.response]
        known = np.isfinite(x) & np.isfinite(y)
        x, y = x[known], y[known]
        names, site_of = index_names([data.site[index] for index in np.flatnonzero(known).tolist()])
        for index, name in enumerate(names if plan.by_site else []):
            mine = site_of == index
            n_values = len(np.unique(x[mine]))
            if mine.sum() >= FEWEST_TESTS and n_values >= FEWEST_ANGLES:
                found.append(Regression(plan, name, int(mine.sum()), n_values, _fit(y[mine], x[mine]), None))
        found.append(_pooled(plan, x, y, site_of))
    return tuple(found)


def _pooled(plan: RegressionPlan, x: FloatArray, y: FloatArray, sites: npt.NDArray[np.int64]) -> Regression:
    fit = _fit(y, x)
    by_site = None
    if fit is not None and len(np.unique(sites)) > 1:
        by_site = cluster_intervals(y, x, sites).intervals
    return Regression(plan, "all", len(y), len(np.unique(x)), fit, by_site)


def _fit(response: FloatArray, predictor: FloatArray) -> LinearFit | None:
    if len(response) < 2:
        return None
    try:
        return linear_fit(response, predictor)
    except FitError:  # the predictor does not vary: there is no slope, and the entry says so by its nulls
        return None


def fit_warnings(
    fits: tuple[ModelFit, ...], selected: ModelFit | None, load: npt.NDArray[np.float64]
) -> tuple[str, ...]:
    """Sentence about a selected model that misses the loads (N), or about all models where none fits them."""
    size = float(np.sqrt(np.mean(load**2)))
    if fits and all(fit.rmse > size for fit in fits):
        return tuple(_all_fail(fits, size))
    return tuple(_poor(selected, size))


def _poor(selected: ModelFit | None, size: float) -> Iterator[str]:
    if selected is not None and selected.rmse > POOR * size:
        yield (
            Message(
                "Even the selected law misses the loads by {value:.0f} % of their root mean square ({rmse:.4g} N of "
                "{size:.4g} N). {action}",
                value=100.0 * selected.rmse / size,
                rmse=selected.rmse,
                size=size,
                action=_ACTION,
            )
        )


def _all_fail(fits: tuple[ModelFit, ...], size: float) -> Iterator[str]:
    best = min(fits, key=lambda fit: fit.rmse)
    yield (
        Message(
            "All candidate models miss the loads by more than their root mean square, {size:.4g} N; the smallest rmse "
            "is {rmse:.5g} N, of {words}. No force at all would describe the readings better. {action}",
            size=size,
            rmse=best.rmse,
            words=best.model.words,
            action=_ACTION,
        )
    )
