"""The whole estimation of a campaign: records in, snow parameters with uncertainty out."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from functools import cached_property
from pathlib import Path
from typing import Any, Final

import numpy as np

from .._support.errors import require_range
from .._support.units import Facts, Shown, amount, span
from ..campaign import read_campaign
from ..campaign.records import Campaign
from ..geometry import GeometryForm
from ..snow import SnowProperties
from .comparisons import CampaignMean, Comparison, compare_with_published, own_mean, site_values
from .errors_in_depth import fit_models_with_depth_errors, fitted_hardness, volume_factor
from .group_comparisons import DIFFERENCE, GroupComparison, compare_campaign
from .hardness import shear_displacement, shear_stress
from .layering import growing_hardness, site_growth
from .model_choice import bootstrap_intervals, compare_nested_rows
from .models import Model, fit_models, reason_without_choice, select_model
from .parts import (
    ModelTable,
    PenetrationAnalysis,
    ShearAnalysis,
    SiteMean,
    seating_change,
    site_means,
    site_snow,
    used_words,
)
from .readings import ReadingUncertainty, readings_of
from .regressions import (
    DENSITY_KEY,
    HARDNESS_KEY,
    STRESS_KEY,
    Observations,
    Regression,
    Source,
    fit_warnings,
    penetration_observations,
    regressions,
    shear_observations,
    spot_observations,
)
from .screening import reading_uncertainty, screened_penetration, screened_shear
from .snow_micro_pen import SnowMicroPenAnalysis, evaluate_recordings
from .spread_groups import noisier_series_warning
from .unloading import site_unloading
from .weather import WeatherAtTests, weather_at_tests

DEFAULT_RESAMPLES: Final = 2000
"""Bootstrap resamples; the ends of a 95 % interval then move by a few percent of its width between seeds."""
FEWEST_RESAMPLES: Final = 100
DEFAULT_SEED: Final = 1


@dataclass(frozen=True, repr=False)
class Analysis(Shown):
    """Result of `skisnow.analyse`: estimates of a campaign.

    Attributes
    ----------
    campaign
        The analysed campaign.
    geometry, seed, n_resamples
        Options of the analysis, as in `analyse`.
    penetration, shear
        Results of each kind of experiment, in SI; None if the campaign has no such data.
    difference
        Relative difference of two groups for which the comparisons state ``n_needed``.
    regressions, site_means, group_comparisons, comparisons
        Relations between the quantities, means of the sites, ratios of sites, tools, observers and days, published
        values next to the campaign's own.
    own_hardness, own_stress
        Means over all sites.
    observations
        The used experiments with the snow that they were made on.
    time
        Time of the analysis.
    snow_micro_pen
        Evaluation of the SnowMicroPen recordings; None if the campaign has no such data.
    weather
        Weather at each experiment, from a station; None if the campaign has no such data.

    See Also
    --------
    skisnow.analyse
    """

    campaign: Campaign
    geometry: GeometryForm
    seed: int
    n_resamples: int
    penetration: PenetrationAnalysis | None
    shear: ShearAnalysis | None
    regressions: tuple[Regression, ...]
    site_means: tuple[SiteMean, ...]
    group_comparisons: tuple[GroupComparison, ...]
    comparisons: tuple[Comparison, ...]
    own_hardness: CampaignMean
    own_stress: CampaignMean
    observations: Mapping[Source, Observations]
    time: datetime = field(default_factory=lambda: datetime.now(UTC))
    snow_micro_pen: SnowMicroPenAnalysis | None = None
    weather: WeatherAtTests | None = None
    difference: float = DIFFERENCE

    @cached_property
    def results(self) -> dict[str, Any]:
        """Contents of results.json: estimates as JSON values, in the units of their keys; do not change them."""
        from .results import results_dict

        return results_dict(self)

    def snow(self, site: str | None = None, *, unloading_ratio: float | None = None) -> SnowProperties:
        """The snow of a site: the geometric mean of H_V and the mean of S_f over the used experiments, with intervals.

        k_u/H_V is that of the site's unloading readings, where both ends of its interval are known; the shear
        displacement u_y the geometric mean of its shear tests with turning angles.

        The same numbers as `skisnow.read_snow` reads from results.json.

        site: As the campaign calls it; "C" is also its "site C". Default: all sites together.
        unloading_ratio: k_u/H_V instead of the measured one: 1 is snow that springs back, 10 or more snow that keeps
            its grooves. `Scenario.with_` takes either over.
        Raises ParameterError: no used penetration experiment is of that site; the message names the sites that have
            some.
        """
        return site_snow(self.campaign, self.penetration, self.shear, site, unloading_ratio)

    def plot(self, what: str = "force_depth") -> Any:
        """One figure of the report.

        what: Name of the figure, such as "force_depth", "residuals", "hardness_density" or "stress_angle".
        Returns: A new figure; no window is opened.
        Raises ParameterError: unknown figure (code ``unknown_figure``), or no data for it (``no_data``).
        """
        from ..report.campaign.summary import analysis_figure

        return analysis_figure(self, what)

    def report(self, folder: str | Path, *, language: str = "en") -> Path:
        """Write report.html with its figures, tables and results.json; see `skisnow.write_report`.

        Returns: Path of report.html.
        """
        from ..report.campaign.page import write_report

        return write_report(self, folder, language=language)

    def to_dataframe(self, kind: str = "penetration") -> Any:
        """Experiments with their results, units in the names of the columns; needs pandas (``skisnow[pandas]``).

        kind: "penetration" or "shear".
        Returns: One row per experiment; the ends of a 95 % interval are the columns with `low` and `high` in their
            names.
        """
        from ..report.campaign.summary import analysis_dataframe

        return analysis_dataframe(self, kind)

    def to_xarray(self) -> Any:
        """All experiments with their results, units as attributes; needs xarray (``skisnow[xarray]``).

        Returns: Over the dimensions ``penetration_experiment`` and ``shear_experiment``.
        """
        from ..report.campaign.summary import analysis_dataset

        return analysis_dataset(self)

    def _repr_facts(self) -> Facts:
        """Title with the campaign's name; rows with experiments, mean H_V and S_f, model, sites and relations."""
        selected = self.penetration.selected if self.penetration is not None else None
        rows = [
            ("penetration", "none" if self.penetration is None else used_words(self.penetration.screened)),
            ("shear", "none" if self.shear is None else used_words(self.shear.screened)),
            ("H_V", _mean_words(self.own_hardness, "N/mm³")),
            ("S_f", _mean_words(self.own_stress, "N/mm²")),
            ("model", "none" if selected is None else f"{selected.model.id}, rmse {amount(selected.rmse, 'N')}"),
            ("sites", ", ".join(dict.fromkeys(row.site for row in self.site_means)) or "none"),
            *(_relation_facts(row) for row in self.results.get("published_relations", ())),
        ]
        return Facts(f"of {self.campaign.name!r}", tuple(rows))


def _relation_facts(row: dict[str, Any]) -> tuple[str, str]:
    """Name and text of the hardness of a site without plate tests, by a published relation."""
    resistance, index = row["penetration_resistance_kPa"], row["hand_hardness_index"]
    measured = "" if resistance is None else f"{amount(resistance, 'kPa')}, "
    hand = "outside of the range" if index is None else f"{row['hand_hardness']} (index {index:.2g})"
    return f"hardness at {row['site']}", f"{measured}hand hardness {hand} by {row['hardness_relation']}; not H_V"


def _mean_words(mean: CampaignMean, unit: str) -> str:
    """Text of a mean over the campaign with its unit and its interval."""
    interval = "no interval" if math.isnan(mean.low) else span(mean.low, mean.high)
    return f"{amount(mean.value, unit)} ({interval})"


def analyse(
    campaign: Campaign | str | Path,
    *,
    geometry: GeometryForm = "extended",
    seed: int = DEFAULT_SEED,
    n_resamples: int = DEFAULT_RESAMPLES,
    difference: float = DIFFERENCE,
    progress: Callable[[str], None] | None = None,
) -> Analysis:
    """Estimate H_V, S_f, the model table, regressions and comparisons of a campaign.

    Parameters
    ----------
    campaign
        A campaign, or the path of its folder.
    geometry
        ``extended``: the ski piece with its trapezoid continuation; ``paper``: the plain wedge of Eqn 2.
    seed
        Seed of the bootstrap; the same seed gives the same numbers bit for bit on one machine.
    n_resamples
        Bootstrap resamples of whole experiments, ≥ 100.
    difference
        Relative difference of two sites, tools, observers or days that the campaign should detect, > 0; the result
        contains the number of experiments for it.
    progress
        Called with a line of text now and then.

    Returns
    -------
    Analysis
        With results, snow of a site, figures and tables.

    Raises
    ------
    FieldDataError
        The folder has errors; its ``problems`` list every one.
    ParameterError
        ``n_resamples`` is too small for a 95 % interval.

    See Also
    --------
    skisnow.read_campaign : the campaign to analyse.
    skisnow.write_report : the result as a page.
    skisnow.Analysis.snow : the snow of a site for a turn.

    References
    ----------
    * Mössner, Innerhofer, Schindelwig, Kaps, Schretter and Nachbauer (2013), "Measurement of mechanical properties of
      snow for simulation of skiing", J. Glaciol.
    * Efron (1979), "Bootstrap methods: another look at the jackknife", Ann. Stat. 7, 1-26, doi 10.1214/aos/1176344552.
    """
    require_range("n_resamples", n_resamples, FEWEST_RESAMPLES)
    require_range("difference", difference, 0.0, np.inf, above=True, below=True)
    if not isinstance(campaign, Campaign):
        campaign = read_campaign(campaign, progress=progress)
    progress = progress or (lambda _: None)
    rng = np.random.default_rng(seed)
    penetration = _analyse_penetration(campaign, geometry, rng, n_resamples, progress)
    shear = None
    if campaign.shear is not None:
        chosen, displacement = screened_shear(campaign), shear_displacement(campaign, campaign.shear)
        by_site = site_values(displacement.value, chosen.used, campaign.shear.site)
        shear = ShearAnalysis(chosen, shear_stress(campaign, campaign.shear), displacement, by_site)
    recordings = campaign.snow_micro_pen
    if recordings is not None:
        progress(f"{len(recordings)} recordings of the SnowMicroPen")
    pen = None if recordings is None else evaluate_recordings(recordings)
    observations = _observations_by_source(campaign, penetration, shear, pen)
    pressed, sheared = observations["penetration"].known(HARDNESS_KEY), observations["shear"].known(STRESS_KEY)
    own_hardness, own_stress = own_mean(*pressed, geometric=True), own_mean(*sheared, geometric=False)
    screened = (kind.screened if kind else None for kind in (penetration, shear))
    pairs = compare_campaign(campaign, *screened, difference=difference)
    of_sites = {name: [pair for pair in pairs if (pair.quantity, pair.by) == (name, "site")] for name in ("H_V", "S_f")}
    means = (
        *site_means(HARDNESS_KEY, *pressed, geometric=True, pairs=of_sites["H_V"]),
        *site_means(STRESS_KEY, *sheared, geometric=False, pairs=of_sites["S_f"]),
    )
    density = own_mean(*observations["shear"].known(DENSITY_KEY), geometric=False)
    return Analysis(
        campaign=campaign,
        geometry=geometry,
        seed=seed,
        n_resamples=n_resamples,
        penetration=penetration,
        shear=shear,
        regressions=regressions(observations),
        site_means=means,
        group_comparisons=pairs,
        comparisons=compare_with_published(own_hardness, own_stress, _angle_term(penetration), density),
        own_hardness=own_hardness,
        own_stress=own_stress,
        observations=observations,
        snow_micro_pen=pen,
        weather=weather_at_tests(campaign),
        difference=difference,
    )


def _analyse_penetration(
    campaign: Campaign,
    geometry: GeometryForm,
    rng: np.random.Generator,
    n_resamples: int,
    progress: Callable[[str], None],
) -> PenetrationAnalysis | None:
    """Results of the penetration experiments; None without any, or if no hardness can be estimated."""
    if campaign.penetration is None:
        return None
    readings = readings_of(campaign.penetration, campaign.tools, geometry=geometry)
    uncertainty = reading_uncertainty(campaign)
    progress(f"hardness of {readings.n_series} penetration experiments")
    screened = screened_penetration(campaign, geometry=geometry)
    estimates = screened.estimates
    if estimates is None:
        return None
    hardnesses, model, sites = estimates.hardness, estimates.model, campaign.penetration.site
    growing = growing_hardness(readings, hardnesses["H_V"].value, uncertainty)
    fitted = fitted_hardness(readings, model)
    of_series = PenetrationAnalysis(
        screened=screened,
        readings=readings,
        model=model,
        hardness=hardnesses,
        seating_change=seating_change(readings, model.offset),
        fitted=fitted,
        growing=growing,
        site_growth=site_growth(growing, screened.used, sites),
        unloading=estimates.unloading,
        site_unloading=site_unloading(estimates.unloading, screened.used, sites),
        warnings=noisier_series_warning(model, campaign.penetration.experiment),
    )
    if not screened.used.any():
        return of_series
    return _with_models(of_series, uncertainty, rng, n_resamples, progress)


def _with_models(
    of_series: PenetrationAnalysis,
    uncertainty: ReadingUncertainty,
    rng: np.random.Generator,
    n_resamples: int,
    progress: Callable[[str], None],
) -> PenetrationAnalysis:
    """Add the results over all used readings: model tables, the selected model, the factor b."""
    included, model, hardnesses = of_series.screened.used, of_series.model, of_series.hardness
    used = of_series.readings.of(included)
    progress(f"model table over {used.n} readings")
    by_last = {symbol: H.value[included] for symbol, H in hardnesses.items()}
    fits = fit_models(used, by_last)
    intervals = bootstrap_intervals(used, by_last, rng, n_resamples=n_resamples, progress=progress)
    depth_fits = fit_models_with_depth_errors(of_series.fitted.of(included), uncertainty)
    no_choice = reason_without_choice(used)
    selected = None if no_choice else select_model(fits)
    return replace(
        of_series,
        table=ModelTable(fits, intervals),
        nested=compare_nested_rows(fits),
        selected=selected,
        errors_in_depth=ModelTable(depth_fits, {}),  # no intervals: a bootstrap covers b in 7 to 90 % of campaigns
        volume_factor=volume_factor(used, by_last["H_V"], model.of(included)),
        warnings=(*of_series.warnings, *filter(None, (no_choice,)), *fit_warnings(fits, selected, used.load)),
    )


def _observations_by_source(
    campaign: Campaign,
    penetration: PenetrationAnalysis | None,
    shear: ShearAnalysis | None,
    pen: SnowMicroPenAnalysis | None,
) -> dict[Source, Observations]:
    """Values for regressions, from penetration experiments, shear experiments, and spots with both."""
    nothing = np.zeros(0), np.zeros(0, dtype=bool)
    hardness, used = (penetration.hardness["H_V"].value, penetration.screened.used) if penetration else nothing
    sheared = (shear.stress.value, shear.screened.used) if shear else nothing
    first = penetration_observations(campaign, hardness, used, pen)
    second = shear_observations(campaign, *sheared)
    return {"penetration": first, "shear": second, "spots": spot_observations(first, second)}


def _angle_term(penetration: PenetrationAnalysis | None) -> tuple[CampaignMean, CampaignMean]:
    """Coefficients b0 and b1 of the model of Eqn 11 (b linear in the edge angle), with their bootstrap intervals."""
    if penetration is None or penetration.table is None:
        return CampaignMean(), CampaignMean()
    model = Model("H_V", "none", "linear")
    fit = next(fit for fit in penetration.table.fits if fit.model == model)
    (low0, high0), (low1, high1) = penetration.table.intervals[model][2:].tolist()
    return CampaignMean(fit.b0, low0, high0), CampaignMean(fit.b1, low1, high1)
