"""The answer to a question about a ski in snow: ski and snow are read, the equilibrium found, warnings collected."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from .._support.messages import Message
from ..forces.measured_ranges import FAILURE_SHEAR_STRESS, PENETRATION_EDGE_ANGLE, SNOW_HARDNESS
from ..ski import Ski
from ..ski.sources import Sources
from ..snow import SnowProperties
from ..snow.measured_range import with_range_warnings
from ..snow.properties import require_stress, with_stress
from .equilibrium import carve, rest
from .keys import CARVE_KEYS, CarveQuestion
from .limits import implausible_values, require_clamp
from .result import Equilibrium


@dataclass(frozen=True, slots=True, eq=False)
class CarveAnswer:
    """A question, what was read for it, the equilibrium, and every warning in words."""

    question: CarveQuestion
    ski: Ski
    snow: SnowProperties
    equilibrium: Equilibrium
    warnings: tuple[str, ...]


def answered(question: CarveQuestion, *, sources: Sources | None = None) -> CarveAnswer:
    """Read ski and snow and find the equilibrium.

    Parameters
    ----------
    question
        Checked inputs.
    sources
        Keeps what was read, for many questions.

    Raises
    ------
    ParameterError
        Ski or snow cannot be read, or an input does not go with the ski.
    """
    sources = sources or Sources()
    ski, warned = sources.ski(question.ski)
    snow = asked_snow(question, sources)
    require_clamp(ski, question.clamp_length_m)
    edge_angle = question.edge_angle_deg * CARVE_KEYS["edge_angle_deg"].factor
    equilibrium = _equilibrium(question, ski, snow, edge_angle)
    _, outside = with_range_warnings(lambda: _warn_outside_ranges(snow, edge_angle, at_rest=question.at_rest))
    return CarveAnswer(
        question, ski, snow, equilibrium, (*warned, *implausible_values(question), *outside, *equilibrium.warnings)
    )


def asked_snow(question: CarveQuestion, sources: Sources) -> SnowProperties:
    """The snow of a question."""
    if question.H_V_N_per_mm3 is not None:
        stress = question.S_f_N_per_mm2
        return SnowProperties(
            question.H_V_N_per_mm3 * CARVE_KEYS["H_V_N_per_mm3"].factor,
            None if stress is None else stress * CARVE_KEYS["S_f_N_per_mm2"].factor,
            source=Message("given as numbers"),
        )
    snow = sources.named_snow(question.as_dict())
    require_stress(snow, question.S_f_N_per_mm2, carves=not question.at_rest)
    return with_stress(snow, question.S_f_N_per_mm2)


def _equilibrium(question: CarveQuestion, ski: Ski, snow: SnowProperties, edge_angle: float) -> Equilibrium:
    stiffness = question.footprint_stiffness_N_per_mm2
    footprint = None if stiffness is None else stiffness * CARVE_KEYS["footprint_stiffness_N_per_mm2"].factor
    shared: dict[str, Any] = {"edge_angle": edge_angle, "load": question.load_N, "moment": question.moment_Nm}
    if question.at_rest or question.unloading_ratio is None:
        return rest(
            ski,
            snow,
            **shared,
            clamp_length=question.clamp_length_m,
            footprint_stiffness=footprint,
            twist=question.twist,
            elements=question.elements,
        )
    return carve(
        ski,
        snow,
        **shared,
        unloading_ratio=question.unloading_ratio,
        clamp_length=question.clamp_length_m,
        footprint_stiffness=footprint,
        side_force_bending=question.side_force_bending,
        side_force_spread=question.side_force_spread,
        groove=question.groove,
        moment_balance=question.moment_balance,
        twist=question.twist,
        elements=question.elements,
    )


def _warn_outside_ranges(snow: SnowProperties, edge_angle: float, *, at_rest: bool) -> None:
    SNOW_HARDNESS.warn_outside(snow.snow_hardness, "penetration")
    PENETRATION_EDGE_ANGLE.warn_outside(edge_angle, "penetration")
    if snow.failure_shear_stress is not None and not at_rest:
        FAILURE_SHEAR_STRESS.warn_outside(snow.failure_shear_stress, "shear")
