"""Glide friction: against the sliding velocity, at any slip angle."""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np
import numpy.typing as npt
import pytest

from skisnow.contact import SnowContact, SnowField
from skisnow.contact.snow_field import STICK_DISPLACEMENT
from skisnow.forces.friction import LinearFriction
from skisnow.forces.friction.law import ActsOn
from skisnow.forces.shear import MachiningShear

from .conftest import straight
from .test_exact import LENGTH, WIDTH, H, S, placed, wrench

FloatArray = npt.NDArray[np.float64]
SLIPS: Final = [0.0, 20.0, 45.0, 70.0, 90.0, 135.0, -30.0]
MU, LOAD, FAST = 0.05, 400.0, 9.0
BOTH_LOADS: Final[tuple[ActsOn, ...]] = ("snow-normal", "base-normal")


def rubbed(edge: float, slip: float, **given: Any) -> FloatArray:
    """Force (3,) of friction alone on a straight ski under 400 N that slips by this angle (°) to its left."""
    angle, slipped = math.radians(edge), math.radians(slip)
    depth = math.sqrt(2.0 * LOAD * math.tan(abs(angle)) / (H * LENGTH)) if edge else LOAD / (H * LENGTH * WIDTH)
    sliding = np.array([[FAST * math.cos(slipped), FAST * math.sin(slipped), 0, 0, 0, 0]])
    found = []
    for friction in (MU, 0.0):
        contact = SnowContact(SnowField(H, S, 10.0, friction, **given), [straight()])
        found.append(wrench(contact, placed(angle, depth), sliding)[:3])
        power = contact.sections()
        assert np.all(power.rub * power.sliding + power.rub_aside * power.sliding_aside >= 0.0)
    assert found[1][2] == pytest.approx(LOAD, rel=1e-9)
    return np.asarray(found[0] - found[1])


@pytest.mark.parametrize("slip", SLIPS)
@pytest.mark.parametrize("edge", [0.0, 10.0, 30.0, -30.0])
def test_friction_acts_against_the_slip(edge: float, slip: float) -> None:
    """μ N in the surface, in parts cos and sin of the slip angle; or all of it along the ski."""
    slipped = math.radians(slip)
    direction = np.array([math.cos(slipped), math.sin(slipped), 0.0])
    assert rubbed(edge, slip) == pytest.approx(-MU * LOAD * direction, abs=1e-4)
    along = rubbed(edge, slip, friction_direction="along-ski")
    forwards = np.sign(round(direction[0], 9))
    assert along == pytest.approx([-MU * LOAD * forwards, 0.0, 0.0], abs=1e-9)


@pytest.mark.parametrize("slip", SLIPS)
@pytest.mark.parametrize("edge", [10.0, 30.0, -30.0])
def test_friction_on_the_base_acts_in_its_plane(edge: float, slip: float) -> None:
    """μ N cos ϑ against the part of the velocity that is in the base's plane; the snow is not sheared yet."""
    angle, slipped = math.radians(edge), math.radians(slip)
    off_base = np.array([0.0, math.sin(angle), math.cos(angle)])  # the left edge is down where the angle is above 0
    velocity = np.array([math.cos(slipped), math.sin(slipped), 0.0])
    in_base = velocity - (velocity @ off_base) * off_base
    expected = -MU * LOAD * math.cos(angle) * in_base / np.linalg.norm(in_base)
    assert rubbed(edge, slip, friction_acts_on="base-normal") == pytest.approx(expected, abs=1e-4)


@pytest.mark.parametrize("acts_on", BOTH_LOADS)
def test_a_machining_edge_rubs_across_by_its_own_law_alone(acts_on: ActsOn) -> None:
    """The law's β is the friction across the ski; of the vector the part along the ski is left."""
    for least in (0.1, 0.0):  # the law in the core, and in Python
        cut = MachiningShear(1e5, 0.2, least_shear_plane=least)
        for slip in SLIPS:
            along, across, load = math.cos(math.radians(slip)), math.sin(math.radians(slip)), LOAD
            if acts_on == "base-normal":
                upright = math.cos(math.radians(60))
                along, load = along / math.hypot(along, across * upright), LOAD * upright
            found = rubbed(60.0, slip, shear=cut, friction_acts_on=acts_on)
            assert found == pytest.approx([-MU * load * along, 0.0, 0.0], abs=1e-4)


def test_friction_never_drives_a_ski_that_turns_and_slips() -> None:
    rng = np.random.default_rng(5)
    for acts_on in BOTH_LOADS:
        snow = SnowField(H, S, 10.0, LinearFriction(0.08, -0.002), friction_acts_on=acts_on)
        for _ in range(20):
            contact = SnowContact(snow, [straight()])
            motion = rng.normal(size=(1, 6)) * [5, 5, 1, 3, 3, 3]
            contact.force(*placed(float(rng.uniform(-1.0, 1.0)), 2e-3), motion, 0.0)
            found = contact.sections()
            power = found.rub * found.sliding + found.rub_aside * found.sliding_aside
            assert np.all(power * found.friction_load >= 0.0)


def test_a_base_sticks_up_to_its_friction_and_then_slides() -> None:
    """Flat under 400 N at rest: a spring to μ N over the stick displacement, as far back as forth, then no more."""
    depth = LOAD / (H * LENGTH * WIDTH)
    contact = SnowContact(SnowField(H, 0.0, 10.0, MU), [straight()])
    contact.update(*placed(0.0, depth), 5e-4)

    def held(x: float, y: float = 0.0) -> FloatArray:
        return wrench(contact, placed(0.0, depth, x=x, y=y))[:2]

    for x, y in ((0.4, 0.0), (-0.9, 0.0), (0.3, -0.5), (0.0, 0.7)):
        way = np.array([x, y])
        assert held(*(STICK_DISPLACEMENT * way)) == pytest.approx(-MU * LOAD * way, rel=1e-6, abs=1e-6)
    assert held(3e-3, 4e-3) == pytest.approx([-0.6 * MU * LOAD, -0.8 * MU * LOAD], rel=1e-6)
    contact.update(*placed(0.0, depth, x=3e-3), 5e-4)
    assert held(3e-3) == pytest.approx([-MU * LOAD, 0.0], rel=1e-6, abs=1e-9)
    assert held(3e-3 - 0.75 * STICK_DISPLACEMENT) == pytest.approx([-0.25 * MU * LOAD, 0.0], rel=1e-6, abs=1e-9)
    assert held(3e-3 - 3.0 * STICK_DISPLACEMENT) == pytest.approx([MU * LOAD, 0.0], rel=1e-6, abs=1e-9)
