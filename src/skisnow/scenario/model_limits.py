"""Limits of the present model that change the result of a run without a trace in its numbers."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from .._support.units import DEGREE

if TYPE_CHECKING:
    from .scenario import Scenario

FLAT: Final = 3.0 * DEGREE
"""Edge angle (rad) from which the shear acts at one edge; below it the run ends at a wrong place."""


def model_limits(scenario: Scenario) -> dict[str, str]:
    """Warnings by code: `nearly_flat_ski`, `base_bevel_ignored`.

    Parameters
    ----------
    scenario
        Of a run.
    """
    limits = {}
    edge_angle, ski = scenario.sledge.edge_angle, scenario.ski
    if scenario.skier is None and scenario.boots is None and 0.0 < abs(edge_angle) < FLAT:
        limits["nearly_flat_ski"] = (
            f"sledge.edge_angle_deg is {math.degrees(edge_angle):.4g}: between 0 and 3 degrees the run ends at a wrong "
            "place. The model moves the shear from one edge across the base to the other, so that the ski can turn to "
            "the wrong side. Use 0 degrees, or 3 degrees and more"
        )
    if ski.base_bevel != 0.0:
        limits["base_bevel_ignored"] = (
            f"base_bevel_deg of ski {ski.name} is {ski.base_bevel / DEGREE:.3g}: runs ignore it; only skisnow carve "
            "computes with it"
        )
    return limits
