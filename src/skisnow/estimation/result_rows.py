"""Rows of results.json: experiments, candidate models, and F tests between the models."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, Final, TypeAlias

import numpy as np
import numpy.typing as npt

from .._support.arrays import FloatArray
from .._support.messages import Message
from .._support.units import MM, MM2, MM3, N_PER_MM2, N_PER_MM3
from ..campaign.records import Campaign, PenetrationTests, ShearTests
from ..geometry import GeometryForm
from .campaign_model import CampaignModel
from .hardness import (
    DEFINITIONS,
    ShearDisplacement,
    ShearStress,
    hardness_at_largest_load,
    shear_displacement,
    shear_stress,
)
from .model_choice import NestedRows
from .models import MODELS, ModelFit
from .parts import ModelTable, PenetrationAnalysis
from .readings import readings_of
from .screening import Screened, SeriesEstimates, screened_both
from .unloading import Unloading

Json: TypeAlias = dict[str, Any]
_SAME_PERCENT: Final = 0.005
"""Rmse that differ by less are reported as the same."""


def experiment_results(
    campaign: Campaign, *, geometry: GeometryForm = "extended", screened: tuple[Screened, Screened] | None = None
) -> Json:
    """The experiments of a campaign as results.json has them, without its model table and regressions.

    campaign: as it is now; it may be unfinished.
    screened: result of `screened_both`, if already computed.
    Returns: ``{"penetration": {"experiments": [...]}, "shear": {"experiments": [...]}}``.
    """
    penetration, shear = [], []
    pressed, cut = screened or screened_both(campaign, geometry=geometry)
    if (tests := campaign.penetration) is not None and pressed.estimates is not None:
        penetration = penetration_experiments(tests, pressed, pressed.estimates)
    if (sheared := campaign.shear) is not None:
        shear = shear_experiments(sheared, cut, shear_stress(campaign, sheared), shear_displacement(campaign, sheared))
    answer: Json = without_nan({"penetration": {"experiments": penetration}, "shear": {"experiments": shear}})
    return answer


def experiment_hardness(campaign: Campaign, *, geometry: GeometryForm = "extended") -> FloatArray:
    """H_V of each penetration experiment (N/m³), NaN if not determined; shape (m,)."""
    if campaign.penetration is None:
        return np.zeros(0)
    readings = readings_of(campaign.penetration, campaign.tools, geometry=geometry)
    return hardness_at_largest_load(readings, DEFINITIONS["H_V"])


def first_hardness(campaign: Campaign) -> tuple[str, float] | None:
    """Name and H_V (N/mm³) of the first series on an edge, as a check of a table's units; None without one."""
    if campaign.penetration is None:
        return None
    hardness = experiment_hardness(campaign) / N_PER_MM3
    usable = np.flatnonzero(np.isfinite(hardness) & (campaign.penetration.edge_angle > 0))
    return (campaign.penetration.experiment[usable[0]], float(hardness[usable[0]])) if len(usable) else None


def without_nan(value: Any) -> Any:
    """Replace every number that is not finite by None, and every interval that is not known at both ends as a whole."""
    if isinstance(value, Rows):
        return value
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {key: without_nan(item) for key, item in value.items()}
    if isinstance(value, list):
        cleaned = [without_nan(item) for item in value]
        pair = len(value) == 2 and all(isinstance(item, float) for item in value)
        return None if pair and None in cleaned else cleaned
    return value


class Rows(list[Json]):
    """Rows made from columns by `column_rows`; missing values are already None."""


Columns: TypeAlias = Mapping[str, Sequence[Any] | npt.NDArray[Any]]


def column_rows(columns: Columns) -> Rows:
    """One row for each entry of the columns: lists, numbers (m,) or intervals (m, 2); None if not finite."""
    keys, listed = tuple(columns), [_listed(values) for values in columns.values()]
    return Rows(dict(zip(keys, values, strict=True)) for values in zip(*listed, strict=True))


def _listed(values: Sequence[Any] | npt.NDArray[Any]) -> Sequence[Any]:
    """List of the values; None for a number or interval that is not finite."""
    if not isinstance(values, np.ndarray):
        return values
    listed: list[Any] = values.tolist()
    finite = np.isfinite(values).reshape(len(values), -1).all(axis=1)
    for index in np.flatnonzero(~finite).tolist():
        listed[index] = None
    return listed


def penetration_experiments(
    tests: PenetrationTests, screened: Screened, estimates: SeriesEstimates | PenetrationAnalysis
) -> list[Json]:
    """The rows ``penetration.experiments``: description of each series, its flags, its hardness, its unloading."""
    hardness, unloading = estimates.hardness, estimates.unloading
    columns: Columns = {
        "experiment": tests.experiment,
        "site": tests.site,
        "tool": tests.tool,
        "edge_angle_deg": whole_degrees(tests.edge_angle),
        "n_loads": np.diff(tests.first),
        "n_zero": estimates.model.n_zero,
        "used": screened.used,
        "flags": screened.codes(),
        **{kind.key: hardness[symbol].value / kind.si for symbol, kind in DEFINITIONS.items()},
        **{
            f"{symbol}_interval_{kind.unit_key}": hardness[symbol].interval / kind.si
            for symbol, kind in DEFINITIONS.items()
        },
        "n_unloading": unloading.n_readings,
        "unloading_ratio": unloading.unloading_ratio,
        "unloading_ratio_interval": unloading.unloading_ratio_interval,
        "rebound_ratio": unloading.rebound_ratio,
        "rebound_ratio_interval": unloading.rebound_ratio_interval,
        "k_u_N_per_mm3": unloading.unloading_stiffness / N_PER_MM3,
        "k_u_interval_N_per_mm3": unloading.unloading_stiffness_interval / N_PER_MM3,
    }
    return column_rows(columns)


def campaign_model_results(model: CampaignModel, unloading: Unloading) -> Json:
    """``penetration.campaign_model``: spreads with degrees of freedom by group, priors, and omitted readings."""
    spreads, freedom, priors = model.spreads, model.freedom, model.priors
    columns: Columns = {
        "group": model.group_names,
        "n_series": np.bincount(model.group[model.counts], minlength=len(model.group_names)),
        "seating_mm": np.sqrt(spreads.seating2) / MM,
        "seating_degrees_of_freedom": freedom.seating,
        "mean_exponent": spreads.mean_exponent,
        "layering": np.sqrt(spreads.layering2),
        "layering_degrees_of_freedom": freedom.layering,
        "relative_scatter": np.sqrt(spreads.scatter2),
        "scatter_degrees_of_freedom": freedom.scatter,
        "rebound_scatter": unloading.rebound_scatter,
        "rebound_degrees_of_freedom": unloading.rebound_freedom,
    }
    return {
        "grouped_by": model.grouped_by,
        "groups": column_rows(columns),
        "n_zero": int(model.n_zero.sum()),
        "priors": {
            "seating_mm": priors.seating / MM,
            "seating_series": priors.seating_series,
            "layering": priors.layering,
            "layering_series": priors.layering_series,
            "mean_exponent": 1.0,
            "mean_exponent_sd": priors.mean_layering,
            "relative_scatter": priors.scatter,
            "rebound_scatter": priors.rebound,
            "scatter_readings": priors.readings,
        },
    }


def whole_degrees(angle: FloatArray) -> list[float]:
    """Angles in degrees, rounded to 11 decimals: without the rounding error of the conversion to radians."""
    degrees: list[float] = np.round(np.degrees(angle), 11).tolist()
    return degrees


def shear_experiments(
    tests: ShearTests, screened: Screened, stress: ShearStress, displacement: ShearDisplacement
) -> list[Json]:
    """The rows ``shear.experiments``: description of each test, its flags, its force and stress."""
    return column_rows(
        {
            "experiment": tests.experiment,
            "site": tests.site,
            "plate": tests.plate,
            "edge_angle_deg": whole_degrees(tests.edge_angle),
            "F_t_N": stress.force,
            "S_f_N_per_mm2": stress.value / N_PER_MM2,
            "S_f_interval_N_per_mm2": stress.interval / N_PER_MM2,
            "used": screened.used,
            "flags": screened.codes(),
            "n_turning": displacement.n_readings,
            "shear_displacement_mm": displacement.value / MM,
            "shear_displacement_interval_mm": displacement.interval / MM,
        }
    )


def model_rows(table: ModelTable | None) -> list[Json]:
    """The rows ``penetration.models``: the nine candidate models, without numbers if the campaign has no data."""
    if table is None:
        nan = math.nan
        fits = (ModelFit(row, nan, nan, nan, nan, 0, 0, row.n_parameters, nan, nan, nan, (), nan) for row in MODELS)
        return [_model(fit, None) for fit in fits]
    return [_model(fit, table.intervals.get(fit.model)) for fit in table.fits]


def _model(fit: ModelFit, intervals: FloatArray | None) -> Json:
    """JSON row of a fitted model: A in mm², V in mm³, H in N/mm, N/mm² or N/mm³."""
    si = DEFINITIONS[fit.model.hardness].si
    factor_a, factor_b = si * MM2, si * MM3
    factors = {"a0": factor_a, "a1": factor_a, "b0": factor_b, "b1": factor_b}
    forms = {"a0": ("constant", "linear"), "a1": ("linear",), "b0": ("constant", "linear"), "b1": ("linear",)}
    pairs: dict[str, list[float] | None] = dict.fromkeys(factors)
    for index, (name, factor) in enumerate(factors.items()):
        if intervals is not None and getattr(fit.model, name[0]) in forms[name]:
            pairs[name] = (intervals[index] * factor).tolist()
    return {
        "id": fit.model.id,
        "hardness": fit.model.hardness,
        "a": fit.model.a,
        "b": fit.model.b,
        **{name: getattr(fit, name) * factor for name, factor in factors.items()},
        "n": fit.n,
        "n_series": fit.n_series,
        "n_parameters": fit.n_parameters,
        "rmse_N": fit.rmse,
        "rmse_dof_N": fit.rmse_dof,
        "rmse_free_N": fit.rmse_free,
        "at_bound": list(fit.at_bound),
        "intervals": pairs,
    }


def nested_row(row: NestedRows) -> Json:
    """A row of ``penetration.tests``: the F test of a model against one that it contains."""
    return {
        "full": row.full.id,
        "reduced": row.reduced.id,
        "F": row.F,
        "df": [row.df1, row.df2],
        "p": row.p,
        "rmse_change_percent": row.rmse_change_percent,
        "valid_classically": row.valid_classically,
    }


def selected_model(penetration: PenetrationAnalysis) -> Json | None:
    """``penetration.selected``: the id of the chosen model, and why it was chosen."""
    if penetration.selected is None or penetration.table is None:
        return None
    best = min(penetration.table.fits, key=lambda fit: fit.rmse)
    chosen = penetration.selected
    return {"id": chosen.model.id, "reason": _reason_for_choice(chosen, best)}


def _reason_for_choice(chosen: ModelFit, best: ModelFit) -> Message:
    """Sentence with the reason for the chosen model: its rmse (N), parameters, and those of the best model."""
    if chosen.model == best.model:
        return Message(
            "The smallest rmse of the nine candidate models, {rmse:.4g} N; no model with fewer fitted parameters "
            "({parameters} here) comes within 5 % of it.",
            rmse=chosen.rmse, parameters=chosen.n_parameters,
        )  # fmt: skip
    more = 100.0 * (chosen.rmse / best.rmse - 1.0) if best.rmse > 0 else 0.0
    fields = {"rmse": chosen.rmse, "parameters": chosen.n_parameters, "best_rmse": best.rmse, "best": best.model.id,
              "best_parameters": best.n_parameters}  # fmt: skip
    if more < _SAME_PERCENT:
        return Message(
            "The simplest of the nine candidate models whose rmse is within 5 % of the best: {rmse:.4g} N with fitted "
            "parameters: {parameters}, against {best_rmse:.4g} N of {best} with {best_parameters}, which is the same.",
            **fields,
        )
    return Message(
        "The simplest of the nine candidate models whose rmse is within 5 % of the best: {rmse:.4g} N with fitted "
        "parameters: {parameters}, against {best_rmse:.4g} N of {best} with {best_parameters}, {more:.2g} % more.",
        more=more, **fields,
    )  # fmt: skip
