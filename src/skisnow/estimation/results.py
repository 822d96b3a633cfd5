"""An analysis as the contents of results.json: the contract with users and other programs.

Units stand in the keys; every interval is ``[low, high]`` at 95 %; what does not exist is None, never NaN; numbers are
not rounded.
"""

from __future__ import annotations

import math
import platform
from dataclasses import asdict
from importlib.metadata import version
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import numpy.typing as npt

from .._support.units import DEGREE, MM, N_PER_MM2, N_PER_MM3
from .campaign_notes import campaign_notes
from .hardness import DEFINITIONS
from .model_rows import model_rows, nested_row, selected_model
from .snow_micro_pen_results import snow_micro_pen_results
from .weather_results import weather_results

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ..campaign.records import PenetrationTests, ShearTests
    from .analysis import Analysis
    from .hardness import Hardness
    from .parts import PenetrationAnalysis, ShearAnalysis
    from .regressions import Regression
    from .screening import Screened
    from .shear_displacement import ShearDisplacement
    from .shear_stress import ShearStress
    from .sites import SiteMean
    from .unloading import SiteUnloading, Unloading

FloatArray = npt.NDArray[np.float64]
Json: TypeAlias = dict[str, Any]

SCHEMA_VERSION = 1


def results_dict(analysis: Analysis) -> Json:
    """Give the analysis as plain dictionaries and lists, ready for JSON.

    Parameters
    ----------
    analysis
        What `analyse` gave.

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
        "campaign": _campaign(analysis),
        "penetration": _penetration(analysis),
        "shear": _shear(analysis),
        "regressions": [_regression(regression) for regression in analysis.regressions],
        "site_means": [_site_mean(row) for row in analysis.site_means],
        "site_comparisons": [
            {
                "quantity": row.quantity,
                "site_a": row.site_a,
                "site_b": row.site_b,
                "ratio": row.ratio,
                "interval": row.interval.tolist(),
                "p": row.p,
                "n_for_10_percent": row.n_for_10_percent,
            }
            for row in analysis.site_comparisons
        ],
        "comparisons": [row.as_dict() for row in analysis.comparisons],
        "provenance": _provenance(analysis),
    }
    if analysis.snow_micro_pen is not None:
        results["snow_micro_pen"] = snow_micro_pen_results(analysis.snow_micro_pen)
    if analysis.weather is not None and analysis.campaign.weather is not None:
        results["weather"] = weather_results(analysis.campaign.weather, analysis.weather)
    cleaned: Json = without_nan(results)
    return cleaned


def without_nan(value: Any) -> Any:
    """Replace every number that is not finite by None, and every interval that is not known at both ends as a whole."""
    if isinstance(value, _Rows):
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


class _Rows(list[Json]):
    """Rows made from columns by `_rows`, in which what does not exist already is None."""


def _rows(columns: dict[str, list[Any]]) -> _Rows:
    keys = tuple(columns)
    return _Rows(dict(zip(keys, values, strict=True)) for values in zip(*columns.values(), strict=True))


def _numbers(values: FloatArray) -> list[Any]:
    """A column of numbers (m,) or intervals (m, 2) with None for what is not finite."""
    listed: list[Any] = values.tolist()
    finite = np.isfinite(values).reshape(len(values), -1).all(axis=1)
    for index in np.flatnonzero(~finite).tolist():
        listed[index] = None
    return listed


def _campaign(analysis: Analysis) -> Json:
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


def _penetration(analysis: Analysis) -> Json:
    found, tests = analysis.penetration, analysis.campaign.penetration
    if found is None or tests is None:
        return {
            "experiments": [],
            "models": model_rows(None),
            "tests": [],
            "selected": None,
            "warnings": [],
            "seating": [],
            "errors_in_depth": {"models": model_rows(None), "experiments": []},
            "unloading": [],
            "growing_hardness": {"experiments": [], "sites": []},
        }
    return {
        "experiments": penetration_experiments(tests, found.screened, found.hardness, found.unloading),
        "models": model_rows(found.table),
        "tests": [nested_row(row) for row in found.nested],
        "selected": selected_model(found),
        "warnings": list(found.warnings),
        "seating": _seating(tests.experiment, found),
        "errors_in_depth": {
            "models": model_rows(found.errors_in_depth),
            "experiments": _fitted_hardness(tests.experiment, found),
        },
        "unloading": [_site_unloading(row) for row in found.site_unloading],
        "growing_hardness": {
            "experiments": _rows(
                {
                    "experiment": list(tests.experiment),
                    "H_0_N_per_mm3": _numbers(found.growing.surface_hardness / N_PER_MM3),
                    "growth_percent": _numbers(100.0 * found.growing.growth),
                    "growth_interval_percent": _numbers(100.0 * found.growing.growth_interval),
                }
            ),
            "sites": [
                {
                    "site": row.site,
                    "n": row.n,
                    "growth_percent": 100.0 * row.growth,
                    "growth_interval_percent": [100.0 * row.low, 100.0 * row.high],
                }
                for row in found.site_growth
            ],
        },
    }


def penetration_experiments(
    tests: PenetrationTests, screened: Screened, hardness: Mapping[str, Hardness], unloading: Unloading
) -> list[Json]:
    """The rows ``penetration.experiments``: of each series what it was, its flags, its hardness, its unloading."""
    columns: dict[str, list[Any]] = {
        "experiment": list(tests.experiment),
        "site": list(tests.site),
        "tool": list(tests.tool),
        "edge_angle_deg": _degrees(tests.edge_angle),
        "n_loads": np.diff(tests.first).tolist(),
        "used": screened.used.tolist(),
        "flags": screened.codes(),
    }
    for symbol, definition in DEFINITIONS.items():
        columns[definition.key] = _numbers(hardness[symbol].value / definition.si)
    for symbol, definition in DEFINITIONS.items():
        columns[f"{symbol}_interval_{definition.unit_key}"] = _numbers(hardness[symbol].interval / definition.si)
    return _rows(columns | _unloading(unloading))


def _unloading(found: Unloading) -> dict[str, list[Any]]:
    return {
        "n_unloading": found.n_readings.tolist(),
        "unloading_ratio": _numbers(found.unloading_ratio),
        "unloading_ratio_interval": _numbers(found.unloading_ratio_interval),
        "rebound_ratio": _numbers(found.rebound_ratio),
        "rebound_ratio_interval": _numbers(found.rebound_ratio_interval),
        "k_u_N_per_mm3": _numbers(found.unloading_stiffness / N_PER_MM3),
        "k_u_interval_N_per_mm3": _numbers(found.unloading_stiffness_interval / N_PER_MM3),
    }


def _site_unloading(row: SiteUnloading) -> Json:
    return {
        "site": row.site,
        "n": row.n,
        "unloading_ratio": row.ratio,
        "unloading_ratio_interval": [row.low, row.high],
        "rebound_ratio_interval": [row.low_rebound, row.high_rebound],
        "k_u_N_per_mm3": row.stiffness / N_PER_MM3,
        "k_u_interval_N_per_mm3": [row.stiffness_low / N_PER_MM3, row.stiffness_high / N_PER_MM3],
    }


def _degrees(angle: FloatArray) -> list[float]:
    """Degrees as a person wrote them: the last bits that the conversion to radians costs are taken off."""
    degrees: list[float] = np.round(np.degrees(angle), 11).tolist()
    return degrees


def _seating(experiment: tuple[str, ...], found: PenetrationAnalysis) -> list[Json]:
    return _rows(
        {
            "experiment": list(experiment),
            "depth_offset_mm": _numbers(found.seating.offset / MM),
            "interval_mm": _numbers(found.seating.interval / MM),
            "H_V_change_percent": _numbers(100.0 * found.seating.hardness_change),
        }
    )


def _fitted_hardness(experiment: tuple[str, ...], found: PenetrationAnalysis) -> list[Json]:
    fitted = found.fitted
    return _rows(
        {
            "experiment": list(experiment),
            "H_V_N_per_mm3": _numbers(fitted.value["H_V"] / N_PER_MM3),
            "H_V_interval_N_per_mm3": _numbers(fitted.interval / N_PER_MM3),
            "relative_scatter": _numbers(fitted.scatter),
        }
    )


def _shear(analysis: Analysis) -> Json:
    found: ShearAnalysis | None = analysis.shear
    tests = analysis.campaign.shear
    if found is None or tests is None:
        return {"experiments": [], "displacement": []}
    return {
        "experiments": shear_experiments(tests, found.screened, found.stress, found.displacement),
        "displacement": [
            {
                "site": row.site,
                "n": row.n,
                "shear_displacement_mm": row.value / MM,
                "shear_displacement_interval_mm": [row.low / MM, row.high / MM],
            }
            for row in found.site_displacement
        ],
    }


def shear_experiments(
    tests: ShearTests, screened: Screened, stress: ShearStress, displacement: ShearDisplacement
) -> list[Json]:
    """The rows ``shear.experiments``: of each test what it was, its flags, its force and stress."""
    return _rows(
        {
            "experiment": list(tests.experiment),
            "site": list(tests.site),
            "plate": list(tests.plate),
            "edge_angle_deg": _degrees(tests.edge_angle),
            "F_t_N": _numbers(stress.force),
            "S_f_N_per_mm2": _numbers(stress.value / N_PER_MM2),
            "S_f_interval_N_per_mm2": _numbers(stress.interval / N_PER_MM2),
            "used": screened.used.tolist(),
            "flags": screened.codes(),
            "n_turning": displacement.n_readings.tolist(),
            "shear_displacement_mm": _numbers(displacement.value / MM),
            "shear_displacement_interval_mm": _numbers(displacement.interval / MM),
        }
    )


def _regression(regression: Regression) -> Json:
    fit = regression.fit
    numbers: Json = dict.fromkeys(("b", "interval", "rmse", "rmse_dof", "r2", "F", "p"))
    if fit is not None:
        numbers = {
            "b": fit.coefficients.tolist(),
            "interval": [list(pair) for pair in fit.intervals.tolist()],
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
        "interval_by_site": None if by_site is None else [list(pair) for pair in by_site.tolist()],
    }


def _site_mean(row: SiteMean) -> Json:
    own = row.own
    return {
        "quantity": row.quantity,
        "site": row.site,
        "n": row.n,
        "mean": own.value,
        "interval": [own.low, own.high],
        "range": [own.minimum, own.maximum],
    }


def _provenance(analysis: Analysis) -> Json:
    packages = ("skisnow", "numpy", "scipy")
    return {
        "files": dict(sorted(analysis.campaign.file_hashes.items())),
        "versions": {"python": platform.python_version()} | {name: version(name) for name in packages},
        "seed": analysis.seed,
        "options": {"geometry": analysis.geometry, "n_resamples": analysis.n_resamples},
        "time": analysis.time.isoformat(timespec="seconds"),
    }
