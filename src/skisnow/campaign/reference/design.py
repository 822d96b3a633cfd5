"""Design of the synthetic reference campaign: sites, tools, angles, loads, group sizes.

The paper (Mössner and others 2013) gives the totals, the ranges and the regressions; what it does not print is ours and
is called a modelling assumption here. Nothing in this file was adjusted to what an analysis of the campaign gives.

From the paper: 236 penetration series of seven loads between 12 and 492 N at edge angles of 0-60° with a piece of ski
of 200 mm x 62 mm; H_V of 0.04-90 N/mm³; densities of 420-620 kg/m³ (mean 556) and drop-cone depths of 7.4-21.2 mm
(mean 13.6) at the penetration tests, neither related to H_V; 108 shear tests, of which 20 on hard and 30 on soft snow
at varied angle, the others at 90°, there with densities of 420-740 kg/m³ and S_f of 0.04-0.40 N/mm²; 35 pairs of shear
and penetration tests at two sites; Eqns 13 and 14 with their rmse.

Modelling assumption: all else, namely the sites and how many tests each has, evenly spaced loads, which angles, the
hard snow's 0.25 N/mm² and its scatter, plate length, lever arm, depths and the largest moment of a person, densities
and drop-cone depths of each site and their scatter, and that the pairs are among the tests at 90°.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Final

import numpy as np

from ..._support.errors import ParameterError
from ..._support.units import DEGREE, MM, N_PER_MM2, N_PER_MM3
from ...geometry import SkiPiece
from ...snow.published import moessner_2013


@dataclass(frozen=True, slots=True)
class Site:
    """A site: number of tests, mean ρ (kg/m³) and H_p (m), median H_V (N/m³), and number of spots with paired tests.

    The tests are penetration series, or shear tests at 90° at a site without penetration tests.
    """

    name: str
    tests: int
    snow_density: float
    drop_cone_depth: float
    snow_hardness: float = math.nan
    spots: int = 0


TOOL: Final = "ski piece"
SKI_PIECE: Final = SkiPiece(length=moessner_2013.TOOL_LENGTH_MM * MM, width=moessner_2013.TOOL_WIDTH_MM * MM)
LOADS: Final = (12.0, 92.0, 172.0, 252.0, 332.0, 412.0, 492.0)
EDGE_ANGLES_DEG: Final = (0.0, 15.0, 30.0, 45.0, 60.0)
SHALLOWEST_FLAT_DEPTH: Final = 0.2 * MM
"""Modelling assumption: 20 steps of the gauge. Where the flat tool would not go deeper at the largest load, it is set
on edge."""

HARDNESS_RANGE: Final = tuple(limit * N_PER_MM3 for limit in moessner_2013.SNOW_HARDNESS_RANGE_N_PER_MM3)
DENSITY_RANGE: Final = (420.0, 620.0)
DENSITY_SD: Final = 10.0
DENSITY_SAMPLES: Final = 5
DROP_CONE_RANGE: Final = (7.4 * MM, 21.2 * MM)
DROP_CONE_SD: Final = 0.8 * MM
DROP_CONE_TESTS: Final = 3
DROP_CONE_REPEATS: Final = 3

# Modelling assumption: eight sites, their medians evenly spaced in ln H_V so that the spread within the first and the
# last reaches the ends of the paper's range. As the paper found no relation, mean ρ and H_p of the sites are arranged
# to have none with the medians (correlations of 0.01): eight sites drawn at random would often show one by chance.
# The two sites with pairs have nearly the same density, so that S_f has no relation with H_V between them either.
PENETRATION_SITES: Final = tuple(
    Site(f"site {letter}", series, density, cone * MM, hardness * N_PER_MM3, spots)
    for letter, series, hardness, density, cone, spots in zip(
        "ABCDEFGH",
        (30, 30, 30, 30, 29, 29, 29, 29),
        np.geomspace(0.06, 60.0, 8).tolist(),
        (600.0, 552.0, 612.0, 436.0, 604.0, 496.0, 600.0, 548.0),
        (20.2, 9.0, 16.0, 11.0, 8.5, 18.0, 12.5, 13.6),
        (0, 0, 18, 0, 17, 0, 0, 0),
        strict=True,
    )
)

UNLOADED_SITES: Final = ("site B", "site D", "site F")
"""Sites at which the discs are taken off again one by one: soft, middle and hard snow."""
UNLOADING_RATIO: Final = 10.0
"""Median k_u/H_V everywhere: of the order that the published runs of a sledge are simulated with."""

SHEAR_DISPLACEMENT: Final = 0.25 * MM
"""Median u_y with turning angles: between the default of a scenario and half a millimetre."""
TURNING_SHARES: Final = (0.2, 0.4, 0.6, 0.8, 1.0)
"""Shares of the largest moment at which the turning angle is read: four on the rising part, and the largest."""
CREEPING_SITE: Final = "site B"
"""Site with creeping snow, if depths are read again after waiting."""

PLATE: Final = "plate 100 mm"
PLATE_LENGTH: Final = 100.0 * MM
LEVER_ARM: Final = 250.0 * MM
PLATE_DEPTHS: Final = (2.0 * MM, 12.0 * MM)
MAXIMUM_MOMENT: Final = 60.0

SHEAR_ANGLES_DEG: Final = (30.0, 45.0, 60.0, 75.0, 90.0)
HARD_SITE: Final = "site I"
HARD_TESTS: Final = 20
HARD_SHEAR_STRESS: Final = 0.25 * N_PER_MM2
HARD_SCATTER: Final = 0.03 * N_PER_MM2
SOFT_SITE: Final = "site J"
SOFT_TESTS: Final = 30
SOFT_SCATTER: Final = 0.006 * N_PER_MM2

FURTHER_SHEAR_SITES: Final = (
    Site("site K", 8, 440.0, 11.9 * MM),
    Site("site L", 8, 440.0, 13.5 * MM),
    Site("site M", 7, 600.0, 13.0 * MM),
)
"""Their drop-cone depths are chosen so that ρ and H_p have no relation over the tests at 90°."""
SHEAR_DENSITY_RANGE: Final = moessner_2013.SNOW_DENSITY_RANGE
SHEAR_DENSITY_SD: Final = 40.0
SHEAR_STRESS_RANGE: Final = tuple(limit * N_PER_MM2 for limit in moessner_2013.FAILURE_SHEAR_STRESS_RANGE_N_PER_MM2)
DENSITY_SCATTER: Final = 0.059 * N_PER_MM2

FLAT_LIMIT: Final = LOADS[-1] / (SKI_PIECE.length * SKI_PIECE.width * SHALLOWEST_FLAT_DEPTH)
"""Smallest H_V (N/m³) at which the flat tool stays shallower than `SHALLOWEST_FLAT_DEPTH`."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ReferenceNoise:
    """Scatter of the readings of the reference campaign about the law F = H_V V, and of its spots about their site.

    Most are standard deviations of independent normal draws; each is 0 to switch it off, which leaves the draws of all
    others as they are.

    gauge_resolution: step to which depths are rounded (m).
    load_sd: error of each true load against the nominal one in the file (N).
    seating_sd: offset of the depth zero (m), one per series, positive if the gauge reads too much.
    depth_scatter: relative scatter of depth from reading to reading.
    depths_grow: True if the scatter of a series is drawn again when its depth would shrink under a larger load.
    hardness_log_sd: spread of ln H_V between the spots of one site.
    layering_mean: mean of the layering exponent κ, see `reference_campaign`; at most 0.4 in size.
    layering_sd: spread of 2 ln(1 + κ/2) over the series, which is that of κ where it is small.
    shear_scatter: multiplies the scatter of S_f between spots (0.03 N/mm² hard, 0.006 soft, 0.059 about Eqn 14).
    moment_sd: error of the moment (N m).
    lever_arm_sd: True lever arm less the stated one (m).
    unloading_log_sd: spread of ln(k_u/H_V) between the spots of one site.
    rebound_scatter: relative scatter of the rebound from reading to reading, while discs are taken off.
    displacement_log_sd: spread of ln u_y between shear tests with turning angles.
    turning_sd: error of each turning angle (rad): 0.01 mm on a dial gauge at the plate.
    creep_mean: mean of the exponential distribution of the relative growth of a depth under a constant load where snow
        creeps.
    """

    gauge_resolution: float = 0.01 * MM
    load_sd: float = 0.5
    seating_sd: float = 0.02 * MM
    depth_scatter: float = 0.03
    depths_grow: bool = True
    hardness_log_sd: float = 0.3
    layering_mean: float = 0.0
    layering_sd: float = 0.8
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
                raise ParameterError("ReferenceNoise: {name} is {value!r}; it must be a finite number, 0 or above").tag(
                    "out_of_range", name=name, value=value
                )
        if abs(self.layering_mean) > 0.4:
            raise ParameterError(
                "ReferenceNoise: layering_mean is {mean!r}; it must be at most 0.4 in size, or the force falls with "
                "depth in some series"
            ).tag("out_of_range", mean=self.layering_mean)
