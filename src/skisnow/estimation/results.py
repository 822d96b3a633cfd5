"""An analysis as the contents of results.json: the contract with users and other programs.

Each key names its unit. Every interval is ``[low, high]`` at 95 %. Missing values are None, never NaN. Numbers are not
rounded.
"""

from __future__ import annotations

import platform
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from importlib.metadata import version
from math import fsum, isfinite, isnan, nan
from typing import Any, TypeAlias

import orjson

from .._support.units import DEGREE, MM, N_PER_MM2, N_PER_MM3
from ..campaign.records import PenetrationTests
from ..snow.published import hand_hardness
from ..snow.published.moessner_2013 import SNOW_DENSITY_RANGE, failure_shear_stress_from_density
from .analysis import Analysis
from .parts import PenetrationAnalysis, campaign_notes
from .regressions import Regression
from .result_rows import (
    Columns,
    campaign_model_results,
    column_rows,
    model_rows,
    nested_row,
    penetration_experiments,
    selected_model,
    shear_experiments,
    without_nan,
)
from .snow_micro_pen import snow_micro_pen_results
from .weather import weather_results

Json: TypeAlias = dict[str, Any]

SCHEMA_VERSION = 1


def results_dict(analysis: Analysis) -> Json:
    """Give the analysis as plain dictionaries and lists, ready for JSON.

    Parameters
    ----------
    analysis
        Result of `analyse`.

    Returns
    -------
    dict
        The contents of results.json, in the units that its keys name.

    See Also
    --------
    skisnow.Analysis.results : the same, stored.
    skisnow.write_report : writes it, too.

    References
    ----------
    The page docs/files/results.md.
    """
    results = {
        "schema_version": SCHEMA_VERSION,
        "campaign": _campaign_json(analysis),
        "penetration": _penetration_json(analysis),
        "shear": _shear_json(analysis),
        "regressions": [_regression_json(regression) for regression in analysis.regressions],
        "site_means": [
            {
                "quantity": row.quantity,
                "site": row.site,
                "n": row.n,
                "mean": row.own.value,
                "interval": [row.own.low, row.own.high],
                "range": [row.own.minimum, row.own.maximum],
                "letters": row.letters,  # sites that share one are not shown to differ
            }
            for row in analysis.site_means
        ],
        "group_comparisons": [asdict(row) | {"interval": row.interval.tolist()} for row in analysis.group_comparisons],
        "comparisons": [row.as_dict() for row in analysis.comparisons],
        "provenance": _provenance_json(analysis),
    }
    if analysis.snow_micro_pen is not None:
        results["snow_micro_pen"] = snow_micro_pen_results(analysis.snow_micro_pen)
    if analysis.penetration is None and analysis.shear is None:
        results["published_relations"] = list(_published_relations(analysis))
    if analysis.weather is not None and analysis.campaign.weather is not None:
        results["weather"] = weather_results(analysis.campaign.weather, analysis.weather)
    cleaned: Json = without_nan(results)
    return cleaned


def _published_relations(analysis: Analysis) -> Iterator[Json]:
    """Density, hand hardness and S_f of each site by samples and by recordings; None outside of a relation's range."""
    samples, pen = analysis.campaign.density, analysis.snow_micro_pen
    densities: dict[tuple[str, str], list[float]] = {}
    resistances: dict[str, list[float]] = {}
    if samples is not None:
        for site, value, why in zip(samples.site, samples.snow_density.tolist(), samples.cancelled, strict=True):
            densities.setdefault((site, "density.csv"), []).extend([] if why else [value])
    if pen is not None:
        relation = pen.recordings.settings.relation
        for site, density, recording in zip(pen.recordings.site, pen.snow_density.tolist(), pen.evaluated, strict=True):
            if recording.is_used:
                resistances.setdefault(site, []).append(recording.resistance)
                densities.setdefault((site, relation), []).append(density)
    for (site, source), values in sorted(densities.items()):
        if values:
            resistance = _finite_mean(resistances.get(site, ())) if source != "density.csv" else nan
            yield {"site": site, "source": source, "n": len(values), **_by_relations(_finite_mean(values), resistance)}


def _finite_mean(values: Sequence[float]) -> float:
    """Mean of the finite values; NaN if there are none."""
    finite = [value for value in values if isfinite(value)]
    return fsum(finite) / len(finite) if finite else nan


def _by_relations(density: float, resistance: float) -> Json:
    """JSON values by published relations: hand hardness from resistance (Pa), else density (kg/m³), and S_f."""
    low, high = SNOW_DENSITY_RANGE
    stress = float(failure_shear_stress_from_density(density)) / N_PER_MM2 if low <= density <= high else nan
    source, index = hand_hardness.RESISTANCE_SOURCE, hand_hardness.index_from_resistance(resistance)
    if isnan(resistance):
        source, index = hand_hardness.DENSITY_SOURCE, hand_hardness.index_from_density(density)
    return {
        "snow_density_kg_per_m3": density,
        "penetration_resistance_kPa": resistance / 1e3,
        "hardness_relation": source,
        "hand_hardness_index": index,
        "hand_hardness": None if isnan(index) else hand_hardness.code_of(index),
        "S_f_N_per_mm2": stress,
    }


def _campaign_json(analysis: Analysis) -> Json:
    """JSON of the campaign: names, uncertainties, excluded flags, warnings, corrections and remarks."""
    campaign = analysis.campaign
    return {
        "name": campaign.name,
        "place": campaign.place,
        "observers": list(campaign.observers),
        "gauge_resolution_mm": None if campaign.gauge_resolution is None else campaign.gauge_resolution / MM,
        "load_uncertainty_N": campaign.load_uncertainty,
        "moment_uncertainty_Nm": campaign.moment_uncertainty,
        "lever_arm_uncertainty_mm": None
        if campaign.lever_arm_uncertainty is None
        else campaign.lever_arm_uncertainty / MM,
        "pole_stiffness_Nm_per_deg": None if campaign.pole_stiffness is None else campaign.pole_stiffness * DEGREE,
        "excluding": sorted(campaign.excluding),
        "warnings": [problem.as_dict() for problem in campaign.problems],
        "corrections": [asdict(correction) for correction in campaign.corrections],
        "remarks": list(campaign_notes(campaign)),
    }


def _penetration_json(analysis: Analysis) -> Json:
    """JSON of the penetration experiments, their models and site means; empty lists without experiments."""
    estimates, tests = analysis.penetration, analysis.campaign.penetration
    if estimates is None or tests is None:
        return {
            "experiments": [],
            "models": model_rows(None),
            "tests": [],
            "selected": None,
            "warnings": [],
            "volume_factor": None,
            "campaign_model": None,
            "seating": [],
            "errors_in_depth": {"models": model_rows(None), "experiments": []},
            "unloading": [],
            "growing_hardness": {"experiments": [], "sites": []},
        }
    model, fitted, factor = estimates.model, estimates.fitted, estimates.volume_factor
    seating: Columns = {
        "experiment": tests.experiment,
        "depth_offset_mm": model.offset / MM,
        "interval_mm": model.offset_interval / MM,
        "H_V_change_percent": 100.0 * estimates.seating_change,
    }
    hardness: Columns = {
        "experiment": tests.experiment,
        "H_V_N_per_mm3": fitted.value["H_V"] / N_PER_MM3,
        "H_V_interval_N_per_mm3": model.hardness_interval / N_PER_MM3,
        "relative_scatter": fitted.scatter,
    }
    return {
        "experiments": penetration_experiments(tests, estimates.screened, estimates),
        "models": model_rows(estimates.table),
        "tests": [nested_row(row) for row in estimates.nested],
        "selected": selected_model(estimates),
        "warnings": list(estimates.warnings),
        "volume_factor": None
        if factor is None
        else {
            "n_series": factor.n,
            "b_raw": factor.raw,
            "b_raw_expected": factor.expected_raw,
            "b": factor.value,
            "b_interval": [factor.low, factor.high],
        },
        "campaign_model": campaign_model_results(model, estimates.unloading),
        "seating": column_rows(seating),
        "errors_in_depth": {"models": model_rows(estimates.errors_in_depth), "experiments": column_rows(hardness)},
        "unloading": _unloading_of_sites(estimates),
        "growing_hardness": _growing_hardness(tests, estimates),
    }


def _unloading_of_sites(estimates: PenetrationAnalysis) -> list[Json]:
    """JSON of each site's unloading ratio k_u/H_V and k_u (N/mm³) with intervals."""
    return [
        {
            "site": row.site,
            "n": row.n,
            "unloading_ratio": row.ratio,
            "unloading_ratio_interval": [row.low, row.high],
            "rebound_ratio_interval": [row.low_rebound, row.high_rebound],
            "k_u_N_per_mm3": row.stiffness / N_PER_MM3,
            "k_u_interval_N_per_mm3": [row.stiffness_low / N_PER_MM3, row.stiffness_high / N_PER_MM3],
        }
        for row in estimates.site_unloading
    ]


def _growing_hardness(tests: PenetrationTests, estimates: PenetrationAnalysis) -> Json:
    """JSON of the hardness at the surface and its growth with depth, of each experiment and of the sites' means."""
    growing = estimates.growing
    growth: Columns = {
        "experiment": tests.experiment,
        "H_0_N_per_mm3": growing.surface_hardness / N_PER_MM3,
        "growth_percent": 100.0 * growing.growth,
        "growth_interval_percent": 100.0 * growing.growth_interval,
    }
    sites = [
        {
            "site": row.site,
            "n": row.n,
            "growth_percent": 100.0 * row.value,
            "growth_interval_percent": [100.0 * row.low, 100.0 * row.high],
        }
        for row in estimates.site_growth
    ]
    return {"experiments": column_rows(growth), "sites": sites}


def _shear_json(analysis: Analysis) -> Json:
    """JSON of the shear experiments and of each site's shear displacement (mm)."""
    shear, tests = analysis.shear, analysis.campaign.shear
    if shear is None or tests is None:
        return {"experiments": [], "displacement": []}
    return {
        "experiments": shear_experiments(tests, shear.screened, shear.stress, shear.displacement),
        "displacement": [
            {
                "site": row.site,
                "n": row.n,
                "shear_displacement_mm": row.value / MM,
                "shear_displacement_interval_mm": [row.low / MM, row.high / MM],
            }
            for row in shear.site_displacement
        ],
    }


def _regression_json(regression: Regression) -> Json:
    """JSON of a regression; all numbers are None if it was not fitted, F and p also if they are withheld."""
    fit = regression.fit
    numbers: Json = dict.fromkeys(("b", "interval", "rmse", "rmse_dof", "r2", "F", "p"))
    if fit is not None:
        numbers = {
            "b": fit.coefficients.tolist(),
            "interval": fit.intervals.tolist(),
            "rmse": float(fit.rmse),
            "rmse_dof": float(fit.rmse_dof),
            "r2": float(fit.r2),
            "F": None if regression.withheld else float(fit.F),
            "p": None if regression.withheld else float(fit.p),
        }
    by_site = regression.interval_by_site
    return {
        "response": regression.plan.response,
        "terms": ["intercept", regression.plan.predictor],
        "group": regression.group,
        "n": regression.n,
        "predictor_values": regression.predictor_values,
        **numbers,
        "withheld": regression.withheld,
        "interval_by_site": None if by_site is None else by_site.tolist(),
    }


def _provenance_json(analysis: Analysis) -> Json:
    """JSON of the analysis's inputs: hashes of files, versions, seed, options and time."""
    packages = ("skisnow", "numpy", "scipy")
    return {
        "files": dict(sorted(analysis.campaign.file_hashes.items())),
        "versions": {"python": platform.python_version()} | {name: version(name) for name in packages},
        "seed": analysis.seed,
        "options": {
            "geometry": analysis.geometry,
            "n_resamples": analysis.n_resamples,
            "difference_percent": 100.0 * analysis.difference,
        },
        "time": analysis.time.isoformat(timespec="seconds"),
    }


def results_json(results: dict[str, Any]) -> bytes:
    """The UTF-8 text of results.json: one entry of a list to a line, so that people can search it."""
    return b"".join(results_pieces(results))


def results_pieces(results: dict[str, Any]) -> Iterator[bytes]:
    """Pieces of results.json, for a file that is written without the whole text in memory."""
    yield from _json_pieces(results, 0)
    yield b"\n"


def _json_pieces(value: Any, depth: int) -> Iterator[bytes]:
    """Pieces of the JSON text of a value, with line breaks down to the third level and between rows."""
    pad = b"\n" + b" " * (depth + 1)
    if isinstance(value, dict) and value and depth < 3:
        for index, (key, item) in enumerate(value.items()):
            yield (b"," if index else b"{") + pad + orjson.dumps(key) + b": "
            yield from _json_pieces(item, depth + 1)
        yield b"\n" + b" " * depth + b"}"
    elif isinstance(value, list) and value and isinstance(value[0], dict):
        text = orjson.dumps(value)
        # at once is five times faster than row by row; split it only where no name contains what parts the rows
        if text.count(b"},{") == len(value) - 1:
            yield b"[" + pad
            yield text[1:-1].replace(b"},{", b"}," + pad + b"{")
            text = b"\n" + b" " * depth + b"]"
        yield text
    else:
        yield orjson.dumps(value)
