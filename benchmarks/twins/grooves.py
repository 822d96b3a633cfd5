"""One twin of marks: depth, width and radius that a carving or sliding ski leaves, and H_V and S_f only from them."""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from tests.present import present

from skisnow import SnowProperties, carve
from skisnow._support.units import MM, N_PER_MM2, N_PER_MM3
from skisnow.identification import MeasuredGrooves, identify
from skisnow.scenario import scenario_file

from .kept import Row, interval_row, number

SCENARIO: Final = "carved-46m"
CASES: Final = ("marks",)
PLACES: Final = 10
SPREAD: Final = 0.05
"""Standard deviation of depth and width over their value."""
DEPTH_SD: Final = 0.1 * MM
"""Beside that, of a gauge."""
WIDTH_SD: Final = 0.5 * MM
RADIUS_SPREAD: Final = 0.02
ELEMENTS: Final = 320
"""Of the true ski: twice those of the identification."""


@dataclass(frozen=True, slots=True)
class TrueGroove:
    """Depth that stays, width, radius (m), whether the edge slid, S_f that the turn would have needed (N/m²)."""

    depth: float
    width: float
    turn_radius: float
    slid: bool
    needed: float


def true_snow(seed: int) -> tuple[float, float]:
    """H_V (N/mm³) and S_f (N/mm²), even in their logarithms over what was measured on slopes."""
    hardness, strength = np.random.default_rng([seed, 13]).uniform(np.log([0.04, 0.04]), np.log([90.0, 0.52]))
    return float(np.exp(hardness)), float(np.exp(strength))


def known(seed: int) -> dict[str, object]:
    """Heading down the fall line, and a speed from 3 to 10 m/s: at low speed an edge holds, at high speed it slides."""
    return {
        "start.heading_deg": 0.0,
        "start.speed_m_per_s": float(np.random.default_rng([seed, 19]).uniform(3.0, 10.0)),
    }


def true_groove(hardness: float, strength: float, changes: dict[str, object]) -> TrueGroove:
    """Written apart from the identification: e (1 - H_V/k_u), e/tan ϑ, m v²/R = 2 S_f ∫ e ds; twice the elements."""
    scenario = scenario_file(SCENARIO, changes=changes).scenario
    mass = scenario.sledge.mass + 2.0 * scenario.ski.mass
    load = 0.5 * mass * scenario.gravity * math.cos(scenario.slope.angle)  # type: ignore[union-attr]
    ratio, angle = scenario.contact.unloading_ratio, scenario.sledge.edge_angle
    snow = SnowProperties(hardness * N_PER_MM3, strength * N_PER_MM2, source="the twin's")
    found = carve(
        scenario.ski, snow, edge_angle=angle, load=load, unloading_ratio=ratio, clamp_length=scenario.clamp_length,
        elements=ELEMENTS,
    )  # fmt: skip
    assert found.turn_radius_chord is not None
    deepest = int(np.argmax(present(found.edge_depth)))
    depth, local = float(present(found.edge_depth)[deepest]), angle + float(present(found.twist)[deepest])
    holds = mass * scenario.start.speed**2 / (2.0 * present(found.side_force_limit))
    slid = holds > found.turn_radius_chord
    needed = snow.failure_shear_stress * holds / found.turn_radius_chord  # type: ignore[operator]
    radius = holds if slid else found.turn_radius_chord
    return TrueGroove(depth * (1.0 - 1.0 / ratio), depth / math.tan(local), radius, slid, needed)


def marks_of(groove: TrueGroove, rng: np.random.Generator) -> MeasuredGrooves:
    """Ten places; a sliding ski sweeps three times its width, which tells nothing."""
    width = groove.width * (3.0 if groove.slid else 1.0)
    sds = (
        math.hypot(DEPTH_SD, SPREAD * groove.depth),
        math.hypot(WIDTH_SD, SPREAD * width),
        RADIUS_SPREAD * groove.turn_radius,
    )
    true = (groove.depth, width, groove.turn_radius)
    depth, across, radius = (above_zero(value, sd, rng) for value, sd in zip(true, sds, strict=True))
    depth_sd, width_sd, radius_sd = (np.full(PLACES, sd) for sd in sds)
    return MeasuredGrooves("twin", depth, across, radius, depth_sd, width_sd, radius_sd)


def above_zero(value: float, sd: float, rng: np.random.Generator) -> np.ndarray:
    """Normal; what is not above 0 would not be written down, and is measured again."""
    drawn = value + sd * rng.standard_normal(PLACES)
    while (drawn <= 0.0).any():
        drawn = np.where(drawn <= 0.0, value + sd * rng.standard_normal(PLACES), drawn)
    return drawn


def one_groove(case: str, seed: int) -> list[tuple[str, Row]]:
    """H_V and S_f looked for, from the scenario's 0.2 N/mm³ and 0.5 N/mm²; load, speed and edge angle known."""
    hardness, strength = true_snow(seed)
    changes = known(seed)
    groove = true_groove(hardness, strength, changes)
    marks = marks_of(groove, np.random.default_rng([seed, 17]))
    found = identify(SCENARIO, marks, "H_V,S_f", changes=changes)
    row = {
        "outcome": found.outcome,
        "slid": str(int(groove.slid)),
        "said to have slid": str(int(found["S_f"].value is not None)),
        "depth_mm": number(groove.depth / MM),
        "needed_N_per_mm2": number(groove.needed / N_PER_MM2),
        **interval_row(found["H_V"], hardness),
        **interval_row(found["S_f"], strength),
    }
    return [(case, row)]
