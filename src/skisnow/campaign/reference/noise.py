"""How far the readings of the reference campaign are from its truth."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from ..._support.errors import ParameterError
from ..._support.units import DEGREE, MM


@dataclass(frozen=True, slots=True, kw_only=True)
class ReferenceNoise:
    """How far the readings of the reference campaign are from the law F = H_V V, and its spots from one another.

    Most are standard deviations of independent normal draws; each is 0 to switch it off, which leaves the draws of all
    others as they are.

    Attributes
    ----------
    gauge_resolution
        Step to which depths are rounded (m).
    load_sd
        True load less the nominal one that the file states (N), each reading by itself.
    seating_sd
        Offset of the depth zero (m), one per series: what the gauge reads too much.
    depth_scatter
        Relative scatter of depth from reading to reading.
    hardness_log_sd
        Spread of ln H_V between the spots of one site.
    layering_mean, layering_sd
        Mean and spread of the layering exponent κ over the series, see `reference_campaign`; each at most 0.4.
    shear_scatter
        Multiplies the scatter of S_f between spots (0.03 N/mm² hard, 0.006 soft, 0.059 about Eqn 14).
    moment_sd
        Error of the moment (N m).
    lever_arm_sd
        True lever arm less the stated one (m).
    unloading_log_sd
        Spread of ln(k_u/H_V) between the spots of one site.
    rebound_scatter
        Relative scatter of the rebound from reading to reading, while discs are taken off.
    displacement_log_sd
        Spread of ln u_y from shear test to shear test, where turning angles are asked for.
    turning_sd
        Error of a turning angle (rad), each reading by itself: of 0.01 mm on a dial gauge at the plate.
    creep_mean
        Mean of the exponential distribution of the relative growth of a depth under a constant load where snow creeps.
    """

    gauge_resolution: float = 0.01 * MM
    load_sd: float = 0.5
    seating_sd: float = 0.02 * MM
    depth_scatter: float = 0.02
    hardness_log_sd: float = 0.3
    layering_mean: float = 0.0
    layering_sd: float = 0.15
    shear_scatter: float = 1.0
    moment_sd: float = 0.2
    lever_arm_sd: float = 1.0 * MM
    unloading_log_sd: float = 0.15
    rebound_scatter: float = 0.02
    displacement_log_sd: float = 0.2
    turning_sd: float = 0.002 * DEGREE
    creep_mean: float = 0.03

    def __post_init__(self) -> None:
        for name in (entry.name for entry in fields(self)):
            value = getattr(self, name)
            if not (np.isfinite(value) and (value >= 0 or name == "layering_mean")):
                raise ParameterError(f"ReferenceNoise: {name} is {value!r}; it must be a finite number, 0 or above")
        for name in ("layering_mean", "layering_sd"):
            if abs(getattr(self, name)) > 0.4:
                raise ParameterError(
                    f"ReferenceNoise: {name} is {getattr(self, name)!r}; it must be at most 0.4 in size, "
                    "or the force falls with depth in some series"
                )
