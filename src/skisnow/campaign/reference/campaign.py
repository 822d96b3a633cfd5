"""Synthetic reference campaign: the paper's design, known properties of the snow, stated measurement errors; its files.

``design`` has the design and its origin, `ReferenceNoise` the errors. Both were fixed before results were computed.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import numpy as np

from ..._support.arrays import FloatArray
from ..._support.errors import OutputError, ParameterError
from ..._support.spreadsheet_text import csv_text
from ..._support.staging import prepare_folder, staged, write_file
from ..._support.units import DEGREE, MM, N_PER_MM2
from ..problems import QUALITY_FLAGS
from ..reading.table_forms import LOADING, UNLOADING
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
        raise ParameterError("reference_campaign: the seed is {seed!r}; it must be an integer of at least 0").tag(
            "out_of_range", seed=seed
        )
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


_CAMPAIGN_FILES = ("penetration.csv", "shear.csv", "density.csv", "drop_cone.csv", "corrections.csv", "campaign.toml")


def write_reference(folder: str | Path, *, seed: int, turning_angles: bool = False, creep: bool = False) -> None:
    """Write the reference campaign of a seed: campaign.toml, penetration, shear, density and drop_cone CSV.

    Parameters
    ----------
    folder
        Folder, created if necessary; other files in it are not changed.
    seed
        As for `skisnow.campaign.reference_campaign`. The same seed writes the same bytes.
    turning_angles, creep
        True for turning angles in shear.csv, and depths after waiting in penetration.csv; other cells stay the same.

    Returns
    -------
    None
        The files are written, or an error is raised.

    Raises
    ------
    OutputError
        The folder already contains a file of a campaign, or cannot be written; no partial file remains.
    ParameterError
        The seed is not an integer of at least 0.

    See Also
    --------
    skisnow.read_campaign : reads them.

    References
    ----------
    * Mössner, Innerhofer, Schindelwig, Kaps, Schretter and Nachbauer (2013), "Measurement of mechanical properties of
      snow for simulation of skiing", J. Glaciol.
    * The page docs/validation/reference-campaign.md.
    """
    drawn = reference_campaign(seed, turning_angles=turning_angles, creep=creep)
    folder = Path(folder)
    there = [name for name in _CAMPAIGN_FILES if (folder / name).exists()]
    if there:
        raise OutputError(
            "{folder} already holds a campaign ({files}); nothing was written. Choose a folder without one, or remove "
            "it first."
        ).tag("not_empty", folder=folder, files=there)
    density, cone = drawn.density, drawn.drop_cone
    files = {
        "penetration.csv": _penetration_csv(drawn),
        "shear.csv": _shear_csv(drawn),
        "density.csv": _csv(
            ("sample", "site", "snow_density_kg_per_m3"),
            (density.sample, density.site, _number_texts(density.snow_density, 1.0, 0)),
        ),
        "drop_cone.csv": _csv(
            ("test", "site", "repeat", "drop_cone_depth_mm"),
            (cone.test, cone.site, cone.repeat, _number_texts(cone.drop_cone_depth, MM, 1)),
        ),
        "campaign.toml": _campaign_toml(drawn),
    }
    prepare_folder(folder)
    with staged(folder, last="campaign.toml") as stage:  # without it the folder is not a campaign
        for name, text in files.items():
            write_file(stage.path / name, text)


def _csv(header: Sequence[str], columns: Iterable[Sequence[str]]) -> str:
    """Text of a CSV file from a header and columns of texts."""
    return csv_text([header, *zip(*columns, strict=True)])


def _number_texts(values: FloatArray, unit: float, decimals: int) -> list[str]:
    """Write numbers in a unit; NaN as an empty cell."""
    return ["" if np.isnan(value) else f"{value / unit:.{decimals}f}" for value in values.tolist()]


def _penetration_csv(drawn: ReferenceCampaign) -> str:
    """Text of penetration.csv with loading and unloading readings in the order of their rows."""
    tests, unloading = drawn.penetration, drawn.penetration.unloading
    header = ("experiment", "site", "spot", "tool", "edge_angle_deg", "load_N", "depth_mm", "branch")
    row, load, depth = tests.row, tests.load, tests.penetration_depth
    owner, branch = tests.series_of_reading, [LOADING] * len(row)
    if unloading is not None:
        row, load = np.append(row, unloading.row), np.append(load, unloading.load)
        depth = np.append(depth, unloading.penetration_depth)
        owner, branch = np.append(owner, unloading.series_of_reading), branch + [UNLOADING] * len(unloading.row)
    order = np.argsort(row, kind="stable")
    of_row = owner[order].tolist()
    names = [[column[index] for index in of_row] for column in (tests.experiment, tests.site, tests.spot, tests.tool)]
    angle = _number_texts(tests.edge_angle[of_row], DEGREE, 0)
    numbers = (_number_texts(load[order], 1.0, 0), _number_texts(depth[order], MM, 2))
    columns = [*names, angle, *numbers, [branch[index] for index in order.tolist()]]
    if tests.depth_after is None:
        return _csv(header, columns)
    after = np.concatenate([tests.depth_after, np.full(len(row) - len(tests.load), np.nan)])
    return _csv((*header, "depth_after_mm"), [*columns, _number_texts(after[order], MM, 2)])


def _shear_csv(drawn: ReferenceCampaign) -> str:
    """Text of shear.csv; with turning angles it has one row per angle instead of one per test."""
    tests = drawn.shear
    header: tuple[str, ...] = (
        "experiment", "site", "spot", "plate", "edge_angle_deg", "depth_mm", "lever_arm_mm", "moment_Nm",
        "snow_density_kg_per_m3",
    )  # fmt: skip
    numbers = [
        _number_texts(tests.edge_angle, DEGREE, 0),
        _number_texts(tests.penetration_depth, MM, 2),
        _number_texts(tests.lever_arm, MM, 0),
        _number_texts(tests.moment, 1.0, 2),
        _number_texts(tests.snow_density, 1.0, 0),
    ]
    columns = [tests.experiment, tests.site, tests.spot, tests.plate, *numbers]
    turning = tests.turning
    if turning is None:
        return _csv(header, columns)
    of_row = turning.series_of_reading.tolist()
    several = [[column[index] for index in of_row] for column in columns]
    several[header.index("moment_Nm")] = _number_texts(turning.moment, 1.0, 2)
    return _csv((*header, "turning_angle_deg"), [*several, _number_texts(turning.turning_angle, DEGREE, 4)])


def _campaign_toml(drawn: ReferenceCampaign) -> str:
    """Text of campaign.toml: a comment with seed and noise model, and the keys of the campaign."""
    noise = drawn.noise
    tool = design.SKI_PIECE
    hard, soft, about_density = (
        scatter / N_PER_MM2 for scatter in (design.HARD_SCATTER, design.SOFT_SCATTER, design.DENSITY_SCATTER)
    )
    further = ""
    if drawn.shear.turning is not None:
        further += (
            f"#   turning angles: u_y is {design.SHEAR_DISPLACEMENT / MM:g} mm, its logarithm varies by "
            f"{noise.displacement_log_sd:g} from test to test; each angle by {noise.turning_sd / DEGREE:g} degrees\n"
        )
    if drawn.penetration.depth_after is not None:
        further += (
            f"#   creep at {design.CREEPING_SITE}: after waiting each depth is larger by an exponential share of mean "
            f"{noise.creep_mean:g}\n"
        )
    return f"""\
# SYNTHETIC DATA: no snow was measured. Drawn by skisnow's reference campaign with seed {drawn.seed}.
# Design, ranges and group sizes after Mössner and others (2013), J. Glaciol.; what that paper does not print is chosen.
# Noise model, standard deviations of independent normal draws:
#   gauge: depths rounded to {noise.gauge_resolution / MM:g} mm, none below 0
#   load: the true load is the stated one plus {noise.load_sd:g} N
#   placement: the depth zero of a series is off by {noise.seating_sd / MM:g} mm;
#     each depth scatters by {noise.depth_scatter:.0%}
#   unloading at {", ".join(design.UNLOADED_SITES)}: k_u/H_V is {design.UNLOADING_RATIO:g}, its logarithm varies by
#     {noise.unloading_log_sd:g} from spot to spot; each rebound scatters by {noise.rebound_scatter:.0%}
#   snow: ln H_V varies by {noise.hardness_log_sd:g} within a site, redrawn outside 0.04-90 N/mm3; layering of a series:
#     F = H_V V(e7) (V(e)/V(e7))^(1 + kappa/2), 2 ln(1 + kappa/2) with {noise.layering_sd:g}
#   shear: S_f scatters by {hard:g} N/mm2 (hard), {soft:g} (soft, about Eqn 13), {about_density:g} (about Eqn 14),
#     hard and Eqn 14 redrawn outside 0.04-0.40;
#     moment {noise.moment_sd:g} N m; the true lever arm is the stated one plus {noise.lever_arm_sd / MM:g} mm
{further}name = "{drawn.name}"
place = "{drawn.place}"
observers = ["skisnow"]
gauge_resolution_mm = {noise.gauge_resolution / MM:g}
load_uncertainty_N = {noise.load_sd:g}
moment_uncertainty_Nm = {noise.moment_sd:g}
lever_arm_uncertainty_mm = {noise.lever_arm_sd / MM:g}
load_steps_N = [{", ".join(f"{load:g}" for load in design.LOADS)}]

[[tool]]
name = "{design.TOOL}"
shape = "ski"
length_mm = {tool.length / MM:g}
width_mm = {tool.width / MM:g}

[[plate]]
name = "{design.PLATE}"
length_mm = {design.PLATE_LENGTH / MM:g}
"""
