"""The answer to a question about a ski in snow, and its JSON values."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.metadata import version
from typing import Any, Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.messages import Message
from .._support.units import DEGREE, MM, N_PER_MM2, N_PER_MM3, without_unit
from .._support.user_files.json_text import json_number
from ..forces.parameter_checks import FAILURE_SHEAR_STRESS, PENETRATION_EDGE_ANGLE, SNOW_HARDNESS
from ..ski import Ski
from ..ski.ski_file import Sources
from ..snow import SnowProperties
from ..snow.from_results import snow_dict
from ..snow.measured_range import with_range_warnings
from ..snow.properties import require_stress
from .equilibrium import carve, rest
from .outputs import OUTPUTS
from .question import CARVE_KEYS, CarveQuestion, implausible_values, require_clamp
from .result import Equilibrium
from .solve import RIGID_PLASTIC


@dataclass(frozen=True, slots=True, eq=False)
class CarveAnswer:
    """A question, the files read for it, the equilibrium, and every warning as text."""

    question: CarveQuestion
    ski: Ski
    snow: SnowProperties
    equilibrium: Equilibrium
    warnings: tuple[str, ...]


def answer_question(question: CarveQuestion, *, sources: Sources | None = None) -> CarveAnswer:
    """Read ski and snow and find the equilibrium.

    question: Checked inputs.
    sources: Caches the files, for many questions.
    Raises ParameterError: ski or snow cannot be read, or an input does not go with the ski.
    """
    sources = sources or Sources()
    ski, warned = sources.ski(question.ski)
    ski = question.changed(ski)
    snow = asked_snow(question, sources)
    require_clamp(ski, question.clamp_length_m)
    arguments, edge_angle = question.arguments, question.edge_angle_deg * DEGREE
    if question.at_rest or question.unloading_ratio is None:
        for name in ("unloading_ratio", "side_force_bending", "side_force_spread", "groove", "moment_balance"):
            del arguments[name]
        equilibrium = rest(ski, snow, **arguments)
    else:
        equilibrium = carve(ski, snow, **arguments)
    _, outside = with_range_warnings(lambda: _warn_outside_ranges(snow, edge_angle, at_rest=question.at_rest))
    return CarveAnswer(
        question, ski, snow, equilibrium, (*warned, *implausible_values(question), *outside, *equilibrium.warnings)
    )


def asked_snow(question: CarveQuestion, sources: Sources) -> SnowProperties:
    """Snow of a question: of the campaign or publication that it names, or with its own numbers."""
    if question.H_V_N_per_mm3 is not None:
        stress = question.S_f_N_per_mm2
        return SnowProperties(
            question.H_V_N_per_mm3 * CARVE_KEYS["H_V_N_per_mm3"].factor,
            None if stress is None else stress * CARVE_KEYS["S_f_N_per_mm2"].factor,
            source=Message("given as numbers"),
        )
    snow = sources.named_snow(question.as_dict())
    return require_stress(snow, question.S_f_N_per_mm2, carves=not question.at_rest)


def _warn_outside_ranges(snow: SnowProperties, edge_angle: float, *, at_rest: bool) -> None:
    """Warn of hardness, edge angle (rad) and, unless the ski rests, stress outside the measured ranges."""
    SNOW_HARDNESS.warn_outside(snow.snow_hardness, "penetration")
    PENETRATION_EDGE_ANGLE.warn_outside(edge_angle, "penetration")
    if snow.failure_shear_stress is not None and not at_rest:
        FAILURE_SHEAR_STRESS.warn_outside(snow.failure_shear_stress, "shear")


SCHEMA_VERSION: Final = 1


def answer_dict(answer: CarveAnswer) -> dict[str, Any]:
    """The JSON of `skisnow carve` for one ski; its JSON Schema is that of ``skisnow schema carve``."""
    return {
        "schema_version": SCHEMA_VERSION,
        **equilibrium_dict(answer.equilibrium),
        "inputs": inputs_dict(answer),
        "snow": snow_dict(answer.snow),
        "ski": {
            "name": answer.ski.name,
            "source": answer.ski.source,
            "length_m": answer.ski.length,
            "mass_kg": answer.ski.mass,
            "sidecut_radius_of_three_widths_m": json_number(answer.ski.sidecut_radius_of_three_widths),
            "sidecut_radius_of_edge_line_m": json_number(answer.ski.sidecut_radius_of_edge_line),
        },
        **_half_intervals(answer),
        "warnings": list(answer.warnings),
        "provenance": {"skisnow": version("skisnow")},
    }


def _half_intervals(answer: CarveAnswer) -> dict[str, Any]:
    """Half the 95 % interval of each output by the snow's intervals; empty for a snow without intervals."""
    if answer.equilibrium.request is None or answer.snow.snow_hardness_interval is None:
        return {}
    exact, radius = answer.equilibrium.derivatives(), "turn_radius_boot_m"
    outputs = [name for name in OUTPUTS if exact.output(name) is not None]
    return {
        "half_intervals": {name: exact.half_interval(name, answer.snow) for name in outputs},
        "radius_changes_by_snow_m": exact.changes_by_snow(radius, answer.snow) if radius in outputs else [],
    }


def answers_dict(answers: Sequence[CarveAnswer]) -> dict[str, Any]:
    """The JSON of `skisnow carve`: one answer as it is, several under `skis`."""
    dicts = [answer_dict(answer) for answer in answers]
    return dicts[0] if len(dicts) == 1 else {"skis": dicts}


def sensitivities_dict(equilibrium: Equilibrium, parameters: Sequence[str] = ()) -> list[dict[str, Any]]:
    """Derivatives of all outputs that exist by parameters (default: `everyday_parameters`), as JSON values."""
    exact = equilibrium.derivatives()
    names = parameters or exact.everyday_parameters
    return [
        {
            "output": derivative.output,
            "parameter": derivative.parameter,
            "value": derivative.output_value,
            "derivative": derivative.derivative,
            "percent_per_percent": derivative.relative,
            "relative_distance_to_kink": json_number(derivative.kink),
            "one_sided": None if derivative.one_sided is None else list(derivative.one_sided),
        }
        for output in OUTPUTS
        if exact.output(output) is not None
        for derivative in exact.sensitivity(output, names)
    ]


def equilibrium_dict(equilibrium: Equilibrium) -> dict[str, Any]:
    """An equilibrium under the keys of the contract; None where a number does not exist."""
    return {
        **scalars_dict(equilibrium),
        "station_m": _json_numbers(equilibrium.station, 1.0),
        "edge_depth_mm": _json_numbers(equilibrium.edge_depth, MM),
        "force_per_length_N_per_m": _json_numbers(equilibrium.force_per_length, 1.0),
        "bending_mm": _json_numbers(equilibrium.bending, MM),
        "twist_deg": _json_numbers(equilibrium.twist, DEGREE),
        "edge_line_mm": _json_numbers(equilibrium.edge_line, MM),
    }


SCALARS: Final = (
    "side_force_N", "side_force_limit_N", "total_force_N", "grip_utilisation", "turn_radius_boot_m",
    "turn_radius_boot_other_spread_m", "turn_radius_chord_m", "turn_radius_median_m", "contact_length_m",
    "bearing_length_m", "afterbody_depth_ratio", "forebody_load_N", "afterbody_load_N", "boot_pitch_moment_Nm",
    "residual_force_N", "residual_moment_Nm",
)  # fmt: skip
"""Numbers of an `Equilibrium`, which has them under these names without the unit."""


def scalars_dict(equilibrium: Equilibrium) -> dict[str, Any]:
    """Outcome and single numbers under the keys of the contract."""
    return {
        "outcome": equilibrium.outcome,
        "remedy": equilibrium.remedy,
        "holds": None if equilibrium.holds is None else bool(equilibrium.holds),
        **{name: json_number(getattr(equilibrium, without_unit(name))) for name in SCALARS},
        "iterations": int(equilibrium.iterations),
    }


def inputs_dict(answer: CarveAnswer) -> dict[str, Any]:
    """Every input of the question with its value in use, also of a named snow; inf as the ratio that was computed."""
    inputs = answer.question.as_dict()
    ratio, stress = inputs["unloading_ratio"], answer.snow.failure_shear_stress
    return inputs | {
        "H_V_N_per_mm3": _in_unit(inputs["H_V_N_per_mm3"], answer.snow.snow_hardness, N_PER_MM3),
        "S_f_N_per_mm2": _in_unit(inputs["S_f_N_per_mm2"], stress, N_PER_MM2),
        "unloading_ratio": RIGID_PLASTIC if ratio is not None and math.isinf(ratio) else ratio,
    }


def _in_unit(stated: float | None, value: float | None, unit: float) -> float | None:
    """The number as stated, else the SI value in this unit; a conversion there and back could change the last digit."""
    return stated if stated is not None or value is None else value / unit


def _json_numbers(values: FloatArray | None, unit: float) -> list[float | None] | None:
    """Numbers for JSON in a unit, None for those that are not finite; None without an array."""
    if values is None:
        return None
    numbers: list[float | None] = (values / unit).tolist()
    return numbers if np.isfinite(values).all() else [None if n is None else json_number(n) for n in numbers]
