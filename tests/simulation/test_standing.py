"""How far to the sides skis carry, worked out for a ski with straight sides."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from skisnow.scenario import Plane, Profile
from skisnow.simulation.run_setup import laid_out
from skisnow.simulation.static_start import _carried_across, no_start, weight_meets_base

from .runs.sledges import rigid_ski, scenario

TAN_20 = math.tan(math.radians(20.0))


def stood(hardness: float, edge_angle_deg: float) -> Any:
    """Skis 1.7 m long and 70 mm wide, 0.5 m apart, under 425 N."""
    scenario = SimpleNamespace(
        ski=SimpleNamespace(
            width=np.array([0.06, 0.07]), station=np.array([0.9, 0.0, -0.8]), contact_points=(0.8, -0.7)
        ),
        sledge=SimpleNamespace(edge_angle=math.radians(edge_angle_deg), stance_width=0.5, centre_of_mass=(0.0, 0.5)),
        contact=SimpleNamespace(hardness_at=lambda x, y: hardness + x + y),
        start=SimpleNamespace(x=0.0, y=0.0),
    )
    return SimpleNamespace(scenario=scenario, numbers={"load_N": 425.0}, drive=object())


def carried(hardness: float, edge_angle_deg: float) -> tuple[float, float]:
    """To the right and to the left (m)."""
    return _carried_across(stood(hardness, edge_angle_deg))


def test_edged_skis_carry_from_their_edge_to_the_waterline() -> None:
    """4 · 425 N/(12.5 MN/m³ · 0.8 · 1.7 m) = (10 mm)²: 20 mm of the base are wet, on the side of the edge."""
    inner, outer = 0.25 + 0.02 - 0.035, 0.25 + 0.035
    assert carried(12.5e6, 45.0) == pytest.approx((inner, outer))
    assert carried(12.5e6, -45.0) == pytest.approx((outer, inner))
    # where the tangent is a quarter it is half as deep and twice as wide
    assert carried(12.5e6, math.degrees(math.atan(0.25))) == pytest.approx((inner + 0.02, outer))


def test_in_soft_snow_and_flat_the_whole_base_carries() -> None:
    for angle in (45.0, -45.0, 0.0):
        assert carried(1e5, angle) == pytest.approx((0.285, 0.285))


@pytest.mark.parametrize(
    ("ahead", "left", "told"),
    [
        (0.0, 0.29, "0.285 m"),
        (0.0, -0.24, "0.235 m"),
        (0.81, 0.28, "0.8 m there"),
        (-0.71, -0.23, "0.7 m there"),
        (0.79, 0.28, "at rest"),
    ],
)
def test_where_the_weight_passes_is_told(ahead: float, left: float, told: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("skisnow.simulation.static_start.weight_meets_base", lambda _: (ahead, left))
    assert told in str(no_start(stood(12.5e6, 45.0)))


@pytest.mark.parametrize(
    "slope",
    [Plane(math.radians(20.0)), Profile(np.arange(-5.0, 6.0), -TAN_20 * np.arange(-5.0, 6.0))],
    ids=["plane", "profile"],
)
@pytest.mark.parametrize("heading_deg", [0.0, 30.0, -90.0])
def test_gravity_passes_through_the_centre_of_mass(slope: Plane | Profile, heading_deg: float) -> None:
    """From a height h over a slope of angle α: h tan α down the fall line, from which the sledge heads to the left."""
    given = scenario(ski=rigid_ski(), slope=slope, centre_height=0.4, heading_deg=heading_deg)
    setup, heading = laid_out(given), math.radians(heading_deg)
    forward, left, height = setup.dynamics.body.first_moment / setup.dynamics.body.mass
    assert height == pytest.approx(0.4 * 80.0 / (80.0 + 2.0 * given.ski.mass), rel=1e-2)  # the skis lie at the base
    down = height * TAN_20
    expected = (forward + down * math.cos(heading), left - down * math.sin(heading))
    assert weight_meets_base(setup) == pytest.approx(expected, abs=1e-12)
