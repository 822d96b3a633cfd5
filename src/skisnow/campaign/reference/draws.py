"""Random draws of the synthetic reference campaign: tables with errors, and their true values.

`skisnow.campaign.reference_campaign` describes the distributions.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..._support.arrays import FloatArray
from ..._support.units import DEGREE, MM
from ...snow.published.moessner_2013 import failure_shear_stress_from_angle, failure_shear_stress_from_density
from ..records import DensitySamples, DropConeTests, PenetrationTests, ShearTests, TurningReadings, UnloadingReadings
from . import design
from .design import ReferenceNoise

_ANGLE_DECIMALS = 4
"""Decimals of a turning angle in degrees: finer than 0.001 mm at the plate."""
_REDRAWS = 1000
"""Largest number of redraws of a series whose depth would shrink under a larger load: a tool does not rise under it."""


class DrawnPenetration(NamedTuple):
    """Drawn penetration tests, and per series their true seating offset (m), κ, largest depth (m) and k_u/H_V.

    k_u/H_V is NaN for a series without unloading. ``true_depth`` (m), one per reading, is that of the law.
    """

    tests: PenetrationTests
    seating_offset: FloatArray
    layering: FloatArray
    true_depth: FloatArray
    deepest: FloatArray
    unloading_ratio: FloatArray


def snow_hardness(generator: np.random.Generator, noise: ReferenceNoise) -> FloatArray:
    """Draw H_V (N/m³) of each penetration series."""
    sites = design.PENETRATION_SITES
    medians = np.repeat([site.snow_hardness for site in sites], [site.tests for site in sites])
    low, high = np.log(design.HARDNESS_RANGE).tolist()
    return np.exp(_normal_within(generator, np.log(medians), noise.hardness_log_sd, (low, high)))


def edge_angle(generator: np.random.Generator, snow_hardness: FloatArray) -> FloatArray:
    """Edge angle (rad) of each series: the planned one, or a random one if the flat tool would stay too shallow."""
    in_turn = [np.resize(design.EDGE_ANGLES_DEG, site.tests) for site in design.PENETRATION_SITES]
    planned = np.concatenate(in_turn) * DEGREE
    others = np.array([angle for angle in design.EDGE_ANGLES_DEG if angle > 0]) * DEGREE
    instead = others[generator.integers(len(others), size=planned.size)]
    return np.where((planned == 0) & (snow_hardness >= design.FLAT_LIMIT), instead, planned)


def penetration(
    generator: np.random.Generator, snow_hardness: FloatArray, edge_angle: FloatArray, noise: ReferenceNoise
) -> DrawnPenetration:
    """Draw the readings of all penetration series for their true H_V (N/m³) and edge angles (rad)."""
    shape = (snow_hardness.size, len(design.LOADS))
    nominal = np.array(design.LOADS)
    spread = np.exp(noise.layering_sd / 2.0 * generator.standard_normal(shape[0]))
    layering = 2.0 * ((1.0 + noise.layering_mean / 2.0) * spread - 1.0)
    seating_offset = noise.seating_sd * generator.standard_normal(shape[0])
    load = nominal + noise.load_sd * generator.standard_normal(shape)
    scatter = noise.depth_scatter * generator.standard_normal(shape)
    exponent = 1.0 / (1.0 + layering / 2.0)
    volume = (nominal[-1] / snow_hardness)[:, np.newaxis] * (load / nominal[-1]) ** exponent[:, np.newaxis]
    true_depth = design.SKI_PIECE.depth_at_volume(volume, edge_angle[:, np.newaxis])
    for _ in range(1 + _REDRAWS):
        depth = true_depth * (1.0 + scatter)
        reading = _round_to_gauge(np.maximum(depth + seating_offset[:, np.newaxis], 0.0), noise)
        shrinks = (np.diff(reading, axis=1) < 0).any(axis=1)
        if not (noise.depths_grow and noise.depth_scatter > 0 and shrinks.any()):
            break
        scatter[shrinks] = noise.depth_scatter * generator.standard_normal((int(shrinks.sum()), shape[1]))
    sites = [(site, index) for site in design.PENETRATION_SITES for index in range(site.tests)]
    unknown = np.full(shape[0], np.nan)
    tests = PenetrationTests(
        experiment=_numbered_names("P", shape[0]),
        site=tuple(site.name for site, _ in sites),
        tool=(design.TOOL,) * shape[0],
        spot=tuple(_spot_name(site, index) for site, index in sites),
        edge_angle=edge_angle,
        snow_density=unknown,
        drop_cone_depth=unknown,
        cancelled=("",) * shape[0],
        first=np.arange(0, reading.size + 1, shape[1], dtype=np.int64),
        load=np.tile(design.LOADS, shape[0]),
        penetration_depth=reading.ravel(),
        row=_row_numbers(reading.size),
    )
    return DrawnPenetration(tests, seating_offset, layering, true_depth.ravel(), depth[:, -1], unknown)


def add_unloading(generator: np.random.Generator, drawn: DrawnPenetration, noise: ReferenceNoise) -> DrawnPenetration:
    """Add readings during unloading to the series of the sites with unloading.

    The tool starts at its depth e_m under the largest load; at e_m - d it carries what it carried at e_m - κ d before.
    """
    tests, shape = drawn.tests, (len(drawn.tests), len(design.LOADS) - 1)
    ratio = design.UNLOADING_RATIO * np.exp(noise.unloading_log_sd * generator.standard_normal(shape[0]))
    load = np.array(design.LOADS[-2::-1]) + noise.load_sd * generator.standard_normal(shape)
    scatter = noise.rebound_scatter * generator.standard_normal(shape)
    angle, deepest = tests.edge_angle[:, np.newaxis], drawn.deepest[:, np.newaxis]
    volume = design.SKI_PIECE.displaced_volume(deepest, angle) * load / design.LOADS[-1]
    rebound = (deepest - design.SKI_PIECE.depth_at_volume(volume, angle)) / ratio[:, np.newaxis] * (1.0 + scatter)
    depth = np.maximum(deepest - rebound + drawn.seating_offset[:, np.newaxis], 0.0)
    there = np.isin(tests.site, design.UNLOADED_SITES)
    depth = _round_to_gauge(depth, noise)[there]
    up, (series, down) = len(design.LOADS), depth.shape
    readings = UnloadingReadings(
        first=np.concatenate(([0], np.cumsum(np.where(there, down, 0)))).astype(np.int64),
        load=np.tile(design.LOADS[-2::-1], series),
        penetration_depth=depth.ravel(),
        row=np.repeat(2 + (np.flatnonzero(there) + 1) * up, down) + np.arange(depth.size),  # after those of the loading
    )
    row = tests.row + readings.first[:-1][tests.series_of_reading]
    tests = replace(tests, unloading=readings, row=row)
    return drawn._replace(tests=tests, unloading_ratio=np.where(there, ratio, np.nan))


def shear(generator: np.random.Generator, noise: ReferenceNoise) -> tuple[ShearTests, FloatArray]:
    """Draw the shear tests, and the true S_f (N/m²) of each."""
    beside = [(site, index) for site in design.PENETRATION_SITES for index in range(site.spots)]
    alone = [site for site in design.FURTHER_SHEAR_SITES for _ in range(site.tests)]
    centre = np.array([site.snow_density for site in (*(site for site, _ in beside), *alone)])
    further = np.rint(_normal_within(generator, centre, design.SHEAR_DENSITY_SD, design.SHEAR_DENSITY_RANGE))
    count = design.HARD_TESTS + design.SOFT_TESTS + further.size
    place_in_range = generator.uniform(size=count)
    moment_error = noise.moment_sd * generator.standard_normal(count)
    lever_arm = design.LEVER_ARM + noise.lever_arm_sd * generator.standard_normal(count)
    angles = np.array(design.SHEAR_ANGLES_DEG)
    in_turn = [np.resize(angles, count) for count in (design.HARD_TESTS, design.SOFT_TESTS)]
    angle = np.concatenate([*in_turn, np.full(further.size, 90.0)]) * DEGREE
    stress = _shear_stress(generator, angle, further, noise)  # last: redrawing takes a varying count of numbers
    low, high = design.PLATE_DEPTHS
    reachable = design.MAXIMUM_MOMENT / (stress * design.PLATE_LENGTH * design.LEVER_ARM)
    depth = low + place_in_range * (np.minimum(high, reachable) - low)
    moment = np.maximum(stress * depth * design.PLATE_LENGTH * lever_arm + moment_error, 0.0)
    varied = [(design.HARD_SITE, "")] * design.HARD_TESTS + [(design.SOFT_SITE, "")] * design.SOFT_TESTS
    paired = [(site.name, _spot_name(site, index)) for site, index in beside]
    places = varied + paired + [(site.name, "") for site in alone]
    tests = ShearTests(
        experiment=_numbered_names("S", count),
        site=tuple(site for site, _ in places),
        plate=(design.PLATE,) * count,
        spot=tuple(spot for _, spot in places),
        edge_angle=angle,
        penetration_depth=_round_to_gauge(depth, noise),
        lever_arm=np.full(count, design.LEVER_ARM),
        moment=np.round(moment, 2).astype(np.float64),
        snow_density=np.concatenate([np.full(count - further.size, np.nan), further]),
        drop_cone_depth=np.full(count, np.nan),
        cancelled=("",) * count,
        row=_row_numbers(count),
    )
    return tests, stress


def add_creep(generator: np.random.Generator, tests: PenetrationTests, noise: ReferenceNoise) -> PenetrationTests:
    """Copy of the tests with depths that were read again under the same load, at the site with creeping snow."""
    growth = noise.creep_mean * generator.standard_exponential(len(tests.load))
    there = np.array(tests.site, dtype=object)[tests.series_of_reading] == design.CREEPING_SITE
    after = _round_to_gauge(tests.penetration_depth * (1.0 + growth), noise)
    return replace(tests, depth_after=np.where(there, after, np.nan))


def add_turning(
    generator: np.random.Generator, tests: ShearTests, noise: ReferenceNoise
) -> tuple[ShearTests, FloatArray]:
    """Add turning angles up to the largest moment, φ = (u_y/r) M/M_f; return also the true u_y (m) of each test."""
    shape, shares = (len(tests), len(design.TURNING_SHARES)), np.array(design.TURNING_SHARES)
    way = design.SHEAR_DISPLACEMENT * np.exp(noise.displacement_log_sd * generator.standard_normal(shape[0]))
    angle = (way / tests.lever_arm)[:, np.newaxis] * shares + noise.turning_sd * generator.standard_normal(shape)
    moment = np.round(tests.moment[:, np.newaxis] * shares, 2)
    readings = TurningReadings(
        first=np.arange(0, angle.size + 1, shape[1], dtype=np.int64),
        turning_angle=np.round(angle.ravel() / DEGREE, _ANGLE_DECIMALS) * DEGREE,
        moment=moment.ravel(),
    )
    row = 2 + shape[1] * np.arange(shape[0], dtype=np.int64) + np.argmax(moment, axis=1)
    return replace(tests, turning=readings, row=row), way


def density(generator: np.random.Generator) -> DensitySamples:
    """Density samples (kg/m³) of all sites with penetration tests, drawn about each site's density."""
    sites = [site for site in design.PENETRATION_SITES for _ in range(design.DENSITY_SAMPLES)]
    centre = np.array([site.snow_density for site in sites])
    value = _normal_within(generator, centre, design.DENSITY_SD, design.DENSITY_RANGE)
    return DensitySamples(
        sample=_numbered_names("D", len(sites)),
        site=tuple(site.name for site in sites),
        snow_density=np.rint(value),
        sample_depth=np.full(len(sites), np.nan),
        sample_thickness=np.full(len(sites), np.nan),
        cancelled=("",) * len(sites),
        row=_row_numbers(len(sites)),
    )


def drop_cone(generator: np.random.Generator) -> DropConeTests:
    """Draw the repeats of the drop-cone tests of the penetration sites, then of the sites of shear tests at 90°."""
    measured_sites = (*design.PENETRATION_SITES, *design.FURTHER_SHEAR_SITES)
    sites = [site for site in measured_sites for _ in range(design.DROP_CONE_TESTS)]
    repeats = design.DROP_CONE_REPEATS
    centre = np.repeat([site.drop_cone_depth for site in sites], repeats)
    depth = _normal_within(generator, centre, design.DROP_CONE_SD, design.DROP_CONE_RANGE)
    return DropConeTests(
        test=tuple(name for name in _numbered_names("C", len(sites)) for _ in range(repeats)),
        site=tuple(site.name for site in sites for _ in range(repeats)),
        repeat=tuple(str(repeat + 1) for _ in sites for repeat in range(repeats)),
        drop_cone_depth=np.round(depth / MM, 1) * MM,
        cancelled=("",) * centre.size,
        row=_row_numbers(centre.size),
    )


def _normal_within(
    generator: np.random.Generator, centre: FloatArray, sd: float, limits: tuple[float, float]
) -> FloatArray:
    """Draw from a normal distribution truncated to the limits, which contain the centres."""
    low, high = limits
    value: FloatArray = centre + sd * generator.standard_normal(centre.shape)
    while np.any(outside := (value < low) | (value > high)):
        value[outside] = centre[outside] + sd * generator.standard_normal(np.count_nonzero(outside))
    return value


def _round_to_gauge(depth: FloatArray, noise: ReferenceNoise) -> FloatArray:
    """Depths (m) rounded to the steps of the gauge; unchanged for a resolution of 0."""
    if noise.gauge_resolution == 0:
        return depth
    steps = np.rint(depth / noise.gauge_resolution)
    # Rounded in mm, so that the number is the one that a file states, to the last bit.
    return np.round(steps * (noise.gauge_resolution / MM), 6) * MM


def _shear_stress(
    generator: np.random.Generator, angle: FloatArray, density: FloatArray, noise: ReferenceNoise
) -> FloatArray:
    """Drawn failure shear stress S_f (Pa) of the hard tests, the soft ones and those by density, in this order."""
    hard = np.full(design.HARD_TESTS, design.HARD_SHEAR_STRESS)
    soft = failure_shear_stress_from_angle(angle[design.HARD_TESTS :][: design.SOFT_TESTS])
    further = failure_shear_stress_from_density(density)
    low, high = design.SHEAR_STRESS_RANGE
    groups = (
        (hard, design.HARD_SCATTER, (low, high)),
        (soft, design.SOFT_SCATTER, (0.0, high)),  # Eqn 13 itself goes down to 0.034 N/mm²
        (further, design.DENSITY_SCATTER, (low, high)),
    )
    drawn = [_normal_within(generator, mean, noise.shear_scatter * sd, limits) for mean, sd, limits in groups]
    return np.concatenate(drawn)


def _numbered_names(letter: str, count: int) -> tuple[str, ...]:
    """Names such as P001, from 1 to `count`."""
    return tuple(f"{letter}{number:03d}" for number in range(1, count + 1))


def _row_numbers(count: int) -> np.ndarray[tuple[int], np.dtype[np.int64]]:
    """Line numbers of `count` rows in a file; the first is 2."""
    return np.arange(2, count + 2, dtype=np.int64)  # the header is line 1


def _spot_name(site: design.Site, index: int) -> str:
    """Name of a site's spot, such as C01; "" if the index is beyond its spots."""
    return f"{site.name[-1]}{index + 1:02d}" if index < site.spots else ""
