"""Write the synthetic reference campaign as a campaign folder."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from ..._support.arrays import FloatArray
from ..._support.errors import OutputError
from ..._support.spreadsheet_text import csv_text
from ..._support.staging import prepare_folder, staged, write_file
from ..._support.units import DEGREE, MM, N_PER_MM2
from ..reading.table_forms import LOADING, UNLOADING
from . import design
from .campaign import ReferenceCampaign, reference_campaign

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
            f"{folder} already holds a campaign ({', '.join(there)}); nothing was written. "
            "Choose a folder without one, or remove it first."
        )
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
    return csv_text([header, *zip(*columns, strict=True)])


def _number_texts(values: FloatArray, unit: float, decimals: int) -> list[str]:
    """Write numbers in a unit; NaN as an empty cell."""
    return ["" if np.isnan(value) else f"{value / unit:.{decimals}f}" for value in values.tolist()]


def _penetration_csv(drawn: ReferenceCampaign) -> str:
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
    noise = drawn.noise
    tool = design.SKI_PIECE
    hard, soft, about_density = (
        scatter / N_PER_MM2 for scatter in (design.HARD_SCATTER, design.SOFT_SCATTER, design.DENSITY_SCATTER)
    )
    further = _further_noise(drawn)
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


def _further_noise(drawn: ReferenceCampaign) -> str:
    """Comment lines on the errors of turning angles and creep."""
    noise, said = drawn.noise, ""
    if drawn.shear.turning is not None:
        said += (
            f"#   turning angles: u_y is {design.SHEAR_DISPLACEMENT / MM:g} mm, its logarithm varies by "
            f"{noise.displacement_log_sd:g} from test to test; each angle by {noise.turning_sd / DEGREE:g} degrees\n"
        )
    if drawn.penetration.depth_after is not None:
        said += (
            f"#   creep at {design.CREEPING_SITE}: after waiting each depth is larger by an exponential share of mean "
            f"{noise.creep_mean:g}\n"
        )
    return said
