"""Consistency of the parts of a question, and limits of plausible numbers, in units of users."""

from __future__ import annotations

from typing import Final

from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.units import MM, N_PER_MM3, in_degrees_if_radians
from ..ski import Ski
from ..snow.properties import GREATEST_LIKELY_HARDNESS
from .keys import CARVE_KEYS, CarveQuestion

USUAL_LOADS_N: Final = (20.0, 5000.0)
"""Loads beyond it look like another unit: 2 kg of ski, and six times the weight of a heavy skier (assumption)."""


def require_clamp(ski: Ski, clamp_length_m: float) -> None:
    """Refuse a clamp that the ski is too short for, and say what to write.

    Raises
    ------
    ParameterError
        Half of the clamp reaches beyond the tip or the tail.
    """
    most = 2.0 * min(float(ski.station[0]), -float(ski.station[-1]))
    if clamp_length_m < most:
        return
    fields = {"clamp_length": clamp_length_m, "name": ski.name, "most": most, "in_metres": clamp_length_m * MM}
    if clamp_length_m == CARVE_KEYS["clamp_length_m"].default:
        problem = Message(
            "clamp_length_m (--clamp-length-m) is {clamp_length:g} (the default); the ski {name} allows less than "
            "{most:.3g} m: write --clamp-length-m 0",
            **fields,
        )
    elif clamp_length_m >= 20.0 and clamp_length_m * MM < most:
        problem = Message(
            "clamp_length_m (--clamp-length-m) is {clamp_length:g}; the ski {name} allows less than {most:.3g} m: "
            "write --clamp-length-m 0, or {in_metres:g} if the number is in mm",
            **fields,
        )
    else:
        problem = Message(
            "clamp_length_m (--clamp-length-m) is {clamp_length:g}; the ski {name} allows less than {most:.3g} m: "
            "write --clamp-length-m 0",
            **fields,
        )
    raise ParameterError(problem, code="out_of_range")


def implausible_values(question: CarveQuestion) -> tuple[str, ...]:
    """Numbers that look like those of another unit, in words."""
    found = []
    degrees = in_degrees_if_radians(question.edge_angle_deg)
    if degrees is not None:
        given = question.edge_angle_deg
        found.append(f"edge_angle_deg is {given:g}: that looks like radians. If it is, write {degrees:.4g}")
    low, high = USUAL_LOADS_N
    if not low <= question.load_N <= high:
        found.append(f"load_N is {question.load_N:g}: is it in kg or kN? It is read as newtons (80 kg weigh 785 N)")
    hardness = question.H_V_N_per_mm3
    if hardness is not None and hardness > GREATEST_LIKELY_HARDNESS:
        found.append(f"H_V_N_per_mm3 is {hardness:g}: is it in N/m³? If it is, write {hardness / N_PER_MM3:.4g}")
    return tuple(found)
