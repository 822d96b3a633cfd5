"""The chain from a campaign to a turn as JSON values: units stand in the keys, nothing is rounded, nothing is NaN."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from .._support.json_number import json_number
from .._support.units import MM, N_PER_MM2, N_PER_MM3
from ..scenario.plausibility import implausible_values
from ..simulation.run_summary import summary_dict
from ..snow.from_results import snow_dict
from .turn_inputs import band_inputs
from .turn_numbers import afterbody_depth_ratio, band_width, maximum_distance, middle_track, used_grip

if TYPE_CHECKING:
    from ..simulation.run import Run
    from ..snow import SnowProperties
    from .turn_chain import EnsembleRun, TurnChain

SCHEMA_VERSION: Final = 1


def turn_dict(chain: TurnChain) -> dict[str, Any]:
    """The JSON of `skisnow turn`, and the contents of turn.json; its JSON Schema is schemas/turn.schema.json."""
    across, along = band_width(middle_track(chain.nominal), [run.track for run in chain.ensemble])
    return {
        "schema_version": SCHEMA_VERSION,
        "campaign": chain.campaign,
        "site": chain.site,
        "synthetic": chain.synthetic,
        "snow": {
            **_numbers_dict(chain.snow),
            "unloading_ratio": json_number(chain.snow.unloading_ratio),
            "shear_displacement_mm": json_number(chain.nominal.scenario.contact.shear_displacement / MM),
            **snow_dict(chain.snow),
        },
        "runs": [_run_dict(name, run, chain.nominal) for name, run in chain.runs.items()],
        "ensemble": {
            "seed": chain.seed,
            "band_across_m": json_number(across),
            "band_along_m": json_number(along),
            "nominal_end_moves_m": json_number(chain.ensemble_error),
            "inputs": [
                {
                    "key": each.key,
                    "spread": each.spread,
                    "distribution": each.distribution,
                    "value": each.value,
                    "low": each.low,
                    "high": each.high,
                    "origin": each.origin,
                }
                for each in band_inputs(chain)
            ],
            "priors": [
                {"key": each.key, "low": each.low, "high": each.high, "times_own": each.about, "origin": each.origin}
                for each in chain.priors
            ],
            "runs": [_ensemble_dict(each) for each in chain.ensemble],
        },
        "sentences": chain.sentences,
        "warnings": list(chain.warnings),
    }


def _run_dict(contact: str, run: Run, nominal: Run) -> dict[str, Any]:
    grip, slips = used_grip(run)
    return {
        "contact": contact,
        "afterbody_depth_ratio": json_number(afterbody_depth_ratio(run)),
        "grip_utilisation": json_number(grip),
        "side_slip_share": json_number(slips),
        "distance_from_first_m": None if run is nominal else json_number(maximum_distance(run, nominal)),
        "summary": summary_dict(run, warnings=implausible_values(run.scenario)),
    }


def _ensemble_dict(run: EnsembleRun) -> dict[str, Any]:
    track = run.track
    ends = {"end_time_s": track.time, "end_x_m": track.x, "end_y_m": track.y}
    return {
        **_numbers_dict(run.snow),
        "values": {key: json_number(value) for key, value in run.values.items()},
        "outcome": run.outcome,
        "side_slip_share": json_number(run.slips),
        **{name: json_number(column[-1]) for name, column in ends.items()},
    }


def _numbers_dict(snow: SnowProperties) -> dict[str, float | None]:
    stress = snow.failure_shear_stress
    return {
        "H_V_N_per_mm3": snow.snow_hardness / N_PER_MM3,
        "S_f_N_per_mm2": None if stress is None else stress / N_PER_MM2,
    }
