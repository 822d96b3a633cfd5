"""Synthetic reference campaign: the paper's design, known properties of the snow, stated measurement errors.

``design`` has the design and its origin, `ReferenceNoise` the errors. Both were fixed before results were computed.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import numpy as np

from ..._support.arrays import FloatArray
from ..._support.errors import ParameterError
from ..problems import QUALITY_FLAGS
from ..records import Campaign, DensitySamples, DropConeTests, PenetrationTests, ShearTests
from . import design, draws
from .design import ReferenceNoise

DEFAULT_NOISE: Final = ReferenceNoise()


@dataclass(frozen=True, slots=True)
class ReferenceCampaign:
    """A synthetic campaign and its true values.

    seed, noise: seed and errors of the random draws.
    penetration, shear, density, drop_cone: tables as read from the written files.
    snow_hardness: True H_V (N/m³), one per penetration series: F₇/V₇ at the nominal largest load and the true depth
        there.
    seating_offset: offset of the gauge in each series (m), positive if it reads too much.
    layering: κ of each series.
    penetration_depth: True depth of each penetration reading under its true load (m).
    unloading_ratio: True k_u/H_V of each series with unloading, NaN for the others.
    failure_shear_stress: True S_f (N/m²), one per shear test.
    shear_displacement: True u_y (m), one per shear test; NaN without turning angles.
    """

    seed: int
    noise: ReferenceNoise
    penetration: PenetrationTests = field(repr=False)
    shear: ShearTests = field(repr=False)
    density: DensitySamples = field(repr=False)
    drop_cone: DropConeTests = field(repr=False)
    snow_hardness: FloatArray = field(repr=False)
    seating_offset: FloatArray = field(repr=False)
    layering: FloatArray = field(repr=False)
    penetration_depth: FloatArray = field(repr=False)
    unloading_ratio: FloatArray = field(repr=False)
    failure_shear_stress: FloatArray = field(repr=False)
    shear_displacement: FloatArray = field(repr=False)

    @property
    def name(self) -> str:
        """Name of the campaign, which marks it as synthetic."""
        return f"synthetic reference campaign, seed {self.seed}"

    @property
    def place(self) -> str:
        """Place of the campaign, which marks it as synthetic."""
        return "nowhere: synthetic, drawn by a random number generator"

    def campaign(self) -> Campaign:
        """Campaign as read from files, for studies with many draws."""
        return Campaign(
            name=self.name,
            place=self.place,
            observers=("skisnow",),
            folder=Path(self.name),
            gauge_resolution=self.noise.gauge_resolution or None,
            load_uncertainty=self.noise.load_sd,
            moment_uncertainty=self.noise.moment_sd,
            lever_arm_uncertainty=self.noise.lever_arm_sd,
            load_steps=design.LOADS,
            tools={design.TOOL: design.SKI_PIECE},
            plates={design.PLATE: design.PLATE_LENGTH},
            excluding=frozenset(code for code, flag in QUALITY_FLAGS.items() if flag.excludes_by_default),
            penetration=self.penetration,
            shear=self.shear,
            density=self.density,
            drop_cone=self.drop_cone,
            problems=(),
            file_hashes={},
        )


def reference_campaign(
    seed: int, *, noise: ReferenceNoise = DEFAULT_NOISE, turning_angles: bool = False, creep: bool = False
) -> ReferenceCampaign:
    """Draw a synthetic campaign of the paper's design: 236 penetration series of seven loads, 108 shear tests.

    seed: seed of `numpy.random.default_rng`, the only source of randomness; an integer of at least 0.
    noise: errors (default: those of the reference campaign).
    turning_angles: True for shear tests with turning angles; all other values stay the same.
    creep: True for depths read again after waiting at a site with creeping snow; all other values stay the same.
    Returns: bit for bit the same for the same seed and noise.
    Raises ParameterError: the seed is not an integer of at least 0.

    Notes
    -----
    Penetration. ln H_V of a spot is normal about its site's, redrawn where H_V leaves 0.04-90 N/mm³. The series' snow
    obeys

        F = H_V V(e₇) (V(e) / V(e₇))^(1 + κ/2),    with V(e₇) = F₇ / H_V and F₇ = 492 N,

    so that it passes exactly through F₇ = H_V V₇ at the nominal largest load, whatever its layering exponent κ; with
    κ = 0 it is F = H_V V (Eqn 12). For the wedge F ~ e^(2 + κ): κ > 0 is snow that is harder below. The true load F is
    the nominal one plus an error; e solves the law for it. The gauge reads e (1 + scatter) + seating offset, rounded to
    its step; it does not read below its zero, so a negative reading is recorded as 0. The file states the nominal
    loads. The scatter of a series whose depth would shrink under a larger load is drawn again: a tool does not rise
    under it. The scatter and κ, with 2 ln(1 + κ/2) normal, were set so that the rmse of the rows of H_V are those that
    the paper prints; agreement there is no evidence.

    A flat series with a depth of at most 0.2 mm at the largest load is drawn at one of the other angles instead
    (modelling assumption: 0.0004 mm cannot be measured).

    Unloading. At three sites the discs are taken off again one by one, to the first load. The tool starts at the depth
    e_m at which the gauge read it, seating apart, and comes back by d = (e_m - ê(V(e_m) F/F_m))/κ with κ = k_u/H_V,
    which is normal in its logarithm about 10 from spot to spot; each rebound scatters by 2 %.

    Shear. S_f is 0.25 N/mm² at every angle on the hard snow, Eqn 13 on the soft snow, Eqn 14 of the spot's own density
    for the 58 tests at 90° (redrawn where S_f leaves 0.04-0.40 N/mm²), each plus its scatter. Depths are
    drawn evenly from 2 mm to 12 mm, or to the depth at which the moment S_f e L r is 60 N m where that is less. The
    moment is S_f e L times the true lever arm plus an error, 0 where negative, written to 0.01 N m.

    Turning angles, where asked for, are read at 20, 40, 60, 80 and 100 % of the moment: φ = (u_y/r) M/M_f plus an
    error, with u_y log-normal about 0.25 mm, written to 0.0001°. Depths after waiting, where asked for, are those of
    site B times 1 and an exponential growth of 3 % in the mean.

    Densities and drop-cone depths vary about the mean of their site, independently of H_V. Lengths in the files are
    written to 0.01 mm (drop cone 0.1 mm), densities to 1 kg/m³.

    Examples
    --------
    >>> drawn = reference_campaign(1)
    >>> len(drawn.penetration), len(drawn.penetration.load), len(drawn.shear)
    (236, 1652, 108)
    """
    # a caller without types may give anything
    if isinstance(seed, bool) or not isinstance(seed, int) or seed < 0:  # type: ignore[redundant-expr]
        raise ParameterError(f"reference_campaign: the seed is {seed!r}; it must be an integer of at least 0")
    # One stream per kind of draw, so that none depends on how many numbers another took.
    spots, spread, readings, shear, beside, back, turn, wait = np.random.default_rng(seed).spawn(8)
    snow_hardness = draws.snow_hardness(spread, noise)
    edge_angle = draws.edge_angle(spots, snow_hardness)
    pressed = draws.penetration(readings, snow_hardness, edge_angle, noise)
    penetration = draws.add_unloading(back, pressed, noise)
    shear_tests, stress = draws.shear(shear, noise)
    way = np.full(len(shear_tests), np.nan)
    if turning_angles:
        shear_tests, way = draws.add_turning(turn, shear_tests, noise)
    return ReferenceCampaign(
        seed=seed,
        noise=noise,
        penetration=draws.add_creep(wait, penetration.tests, noise) if creep else penetration.tests,
        shear=shear_tests,
        density=draws.density(beside),
        drop_cone=draws.drop_cone(beside),
        snow_hardness=snow_hardness,
        seating_offset=penetration.seating_offset,
        layering=penetration.layering,
        penetration_depth=penetration.true_depth,
        unloading_ratio=penetration.unloading_ratio,
        failure_shear_stress=stress,
        shear_displacement=way,
    )
