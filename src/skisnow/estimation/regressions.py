"""The used experiments as columns with the snow that they were made on, and the paper's regressions between them.

S_f and H_V on edge angle, density, drop-cone depth and on each other. A further regression is one more entry in
``PLANS``. Columns carry their unit in their name and are regressed in it, as the paper prints them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

import numpy as np

from .._support.arrays import BoolArray, FloatArray, index_names
from .._support.errors import FitError
from .._support.messages import Message
from .._support.units import MM, N_PER_MM2, N_PER_MM3, ShownFields
from ..campaign.records import Campaign, PenetrationTests, ShearTests
from ..statistics.linear import LinearFit, cluster_intervals, linear_fit
from .models import ModelFit
from .snow_micro_pen import SnowMicroPenAnalysis

HARDNESS_KEY = "H_V_N_per_mm3"
STRESS_KEY = "S_f_N_per_mm2"
ANGLE_KEY = "edge_angle_rad"
DENSITY_KEY = "snow_density_kg_per_m3"
DROP_CONE_KEY = "drop_cone_depth_mm"
PEN_FORCE_KEY = "smp_mean_force_N"
PEN_DENSITY_KEY = "smp_snow_density_kg_per_m3"


@dataclass(frozen=True, repr=False)
class Observations(ShownFields):
    """Columns of one kind of experiment (NaN: not known), the site and the spot (``""``: none) of each."""

    columns: Mapping[str, FloatArray]
    site: tuple[str, ...]
    spot: tuple[str, ...]

    def known(self, key: str) -> tuple[FloatArray, tuple[str, ...]]:
        """The known values of a column and their sites."""
        finite = np.isfinite(self.columns[key])
        return self.columns[key][finite], tuple(self.site[i] for i in np.flatnonzero(finite).tolist())


def penetration_observations(
    campaign: Campaign, hardness: FloatArray, used: BoolArray, pen: SnowMicroPenAnalysis | None = None
) -> Observations:
    """The used penetration experiments; ``hardness``: H_V of all of them in N/m³, ``pen``: results of recordings."""
    keys = (HARDNESS_KEY, ANGLE_KEY, DENSITY_KEY, DROP_CONE_KEY)
    tests = campaign.penetration
    if tests is None:
        return _no_observations(*keys, *((PEN_FORCE_KEY, PEN_DENSITY_KEY) if pen else ()))
    own = {HARDNESS_KEY: hardness / N_PER_MM3}
    if pen is not None:
        own[PEN_FORCE_KEY] = pen.at(tests.site, tests.spot, pen.mean_force)
        own[PEN_DENSITY_KEY] = pen.at(tests.site, tests.spot, pen.snow_density)
    return _observations_of_tests(campaign, tests, own, used)


def shear_observations(campaign: Campaign, stress: FloatArray, used: BoolArray) -> Observations:
    """The used shear experiments; ``stress`` is S_f of all of them in N/m²."""
    if campaign.shear is None:
        return _no_observations(STRESS_KEY, ANGLE_KEY, DENSITY_KEY, DROP_CONE_KEY)
    return _observations_of_tests(campaign, campaign.shear, {STRESS_KEY: stress / N_PER_MM2}, used)


def spot_observations(penetration: Observations, shear: Observations) -> Observations:
    """One point for each spot with both: geometric mean of H_V and mean of S_f over its used experiments."""
    hardness = _values_by_spot(penetration, np.log(penetration.columns[HARDNESS_KEY]))
    stress = _values_by_spot(shear, shear.columns[STRESS_KEY])
    both = [key for key in hardness if key in stress]
    return Observations(
        {
            HARDNESS_KEY: np.array([np.exp(hardness[key]) for key in both]),
            STRESS_KEY: np.array([stress[key] for key in both]),
        },
        tuple(site for site, _ in both),
        tuple(spot for _, spot in both),
    )


def _observations_of_tests(
    campaign: Campaign, tests: PenetrationTests | ShearTests, results: dict[str, FloatArray], used: BoolArray
) -> Observations:
    """Results, edge angle, density and drop-cone depth of the used tests; the site's mean replaces missing values."""
    density = campaign.density.site_means() if campaign.density else {}
    cone = campaign.drop_cone.site_means() if campaign.drop_cone else {}
    columns = results | {
        ANGLE_KEY: tests.edge_angle,
        DENSITY_KEY: _own_or_site(tests.snow_density, tests.site, density),
        DROP_CONE_KEY: _own_or_site(tests.drop_cone_depth, tests.site, cone) / MM,
    }
    chosen = np.flatnonzero(used).tolist()
    return Observations(
        {key: column[used] for key, column in columns.items()},
        tuple(tests.site[i] for i in chosen),
        tuple(tests.spot[i] for i in chosen),
    )


def _own_or_site(own: FloatArray, site: tuple[str, ...], means: Mapping[str, float]) -> FloatArray:
    """Value of each experiment: the measured one, otherwise the mean of its site, otherwise NaN."""
    of_site = np.array([means.get(name, np.nan) for name in site])
    return np.where(np.isfinite(own), own, of_site)


def _values_by_spot(data: Observations, values: FloatArray) -> dict[tuple[str, str], float]:
    """Mean value of each spot, by site and spot; tests without a spot are left out."""
    collected: dict[tuple[str, str], list[float]] = {}
    for site, spot, value in zip(data.site, data.spot, values.tolist(), strict=True):
        if spot:
            collected.setdefault((site, spot), []).append(value)
    return {key: float(np.mean(items)) for key, items in collected.items()}


def _no_observations(*keys: str) -> Observations:
    """Columns without any observation."""
    return Observations({key: np.zeros(0) for key in keys}, (), ())


Source: TypeAlias = Literal["penetration", "shear", "spots"]

FEWEST_TESTS: Final = 5
FEWEST_ANGLES: Final = 3
FEWEST_VALUES: Final = 4
"""A predictor that takes fewer values does not show a relation: what differs between them may be anything (modelling
assumption)."""
POOR: Final = 0.5
"""A selected law whose rmse is above this share of the loads' rms leaves a quarter of their squares open (modelling
assumption)."""
_ACTION: Final = Message("Check for wrong units, depths or tools, and for snow that follows none of these laws.")


@dataclass(frozen=True, slots=True)
class RegressionPlan:
    """Response, predictor and observations of a regression; ``by_site`` adds a regression for each site."""

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
    """Regression with intercept on one predictor; ``fit`` is None if the data do not determine it.

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
        """Reason why the F test of the slope is withheld; None if it is given, or without a slope."""
        if self.fit is None or self.predictor_values >= FEWEST_VALUES:
            return None
        return Message(
            "the predictor takes {predictor_values} different values, fewer than {fewest_values}; other differences "
            "between them would have the same effect",
            predictor_values=self.predictor_values,
            fewest_values=FEWEST_VALUES,
        )


def regressions(observations: Mapping[Source, Observations]) -> tuple[Regression, ...]:
    """All planned regressions: sites first where planned, then all together."""
    rows: list[Regression] = []
    of_recordings = [plan for plan in RECORDING_PLANS if plan.predictor in observations[plan.source].columns]
    for plan in (*PLANS, *of_recordings):
        data = observations[plan.source]
        x, y = data.columns[plan.predictor], data.columns[plan.response]
        finite = np.isfinite(x) & np.isfinite(y)
        x, y = x[finite], y[finite]
        names, site_of = index_names([data.site[index] for index in np.flatnonzero(finite).tolist()])
        for index, name in enumerate(names if plan.by_site else []):
            mine = site_of == index
            n_values = len(np.unique(x[mine]))
            if mine.sum() >= FEWEST_TESTS and n_values >= FEWEST_ANGLES:
                rows.append(Regression(plan, name, int(mine.sum()), n_values, _fit_line(y[mine], x[mine]), None))
        fit = _fit_line(y, x)
        by_site = None
        if fit is not None and len(np.unique(site_of)) > 1:
            by_site = cluster_intervals(y, x, site_of).intervals
        rows.append(Regression(plan, "all", len(y), len(np.unique(x)), fit, by_site))
    return tuple(rows)


def _fit_line(response: FloatArray, predictor: FloatArray) -> LinearFit | None:
    """Regression line of a response; None for fewer than two values or a predictor that does not vary."""
    if len(response) < 2:
        return None
    try:
        return linear_fit(response, predictor)
    except FitError:  # the predictor does not vary: there is no slope, and the entry says so by its nulls
        return None


def fit_warnings(fits: tuple[ModelFit, ...], selected: ModelFit | None, load: FloatArray) -> tuple[str, ...]:
    """Sentence about a selected model that misses the loads (N), or about all models where none fits them."""
    size = float(np.sqrt(np.mean(load**2)))
    if fits and all(fit.rmse > size for fit in fits):
        best = min(fits, key=lambda fit: fit.rmse)
        message = Message(
            "All candidate models miss the loads by more than their root mean square, {size:.4g} N; the smallest rmse "
            "is {rmse:.5g} N, of {words}. No force at all would describe the readings better. {action}",
            size=size,
            rmse=best.rmse,
            words=best.model.words,
            action=_ACTION,
        )
        return (message,)
    if selected is None or selected.rmse <= POOR * size:
        return ()
    message = Message(
        "Even the selected law misses the loads by {value:.0f} % of their root mean square ({rmse:.4g} N of {size:.4g} "
        "N). {action}",
        value=100.0 * selected.rmse / size,
        rmse=selected.rmse,
        size=size,
        action=_ACTION,
    )
    return (message,)
