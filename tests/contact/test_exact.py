"""A runner in snow, and its glide friction, against closed forms."""

import math
from typing import Any, Final

import numpy as np
import pytest

from skisnow._support.arrays import FloatArray
from skisnow.contact import Runner, SnowContact, SnowField
from skisnow.contact.snow_field import STICK_DISPLACEMENT
from skisnow.forces.friction import LinearFriction
from skisnow.forces.friction.law import ActsOn
from skisnow.forces.shear import MachiningShear
from skisnow.forces.shear.law import SHEAR_DISPLACEMENT

from .conftest import edged, straight

H, S, LENGTH, WIDTH = 2e8, 5e5, 1.6, 0.06
AT_REST = np.zeros((1, 6))


def placed(angle: float, depth: float, *, x: float = 0.0, y: float = 0.0) -> tuple[FloatArray, FloatArray]:
    """A straight runner whose deeper edge lies ``depth`` below the plane, its middle shifted by x and y."""
    height = 0.5 * WIDTH * abs(math.sin(angle)) - depth
    return np.array([[x, y, height]]), edged(angle)[None]


def pressed(snow: SnowField, *path: tuple[FloatArray, FloatArray]) -> SnowContact:
    contact = SnowContact(snow, [straight()])
    for pose in path:
        contact.update(*pose, 5e-4)
    return contact


def wrench(contact: SnowContact, pose: tuple[FloatArray, FloatArray], velocity: FloatArray = AT_REST) -> FloatArray:
    return contact.force(*pose, velocity, 5e-4).wrench[0]


def test_a_flat_base_bears_hardness_times_volume() -> None:
    contact = SnowContact(SnowField(H, S, 10.0), [straight()])
    assert wrench(contact, placed(0.0, 1e-3)) == pytest.approx([0, 0, H * LENGTH * WIDTH * 1e-3, 0, 0, 0], abs=1e-8)


@pytest.mark.parametrize("degrees", [30, -45, 60])
def test_an_edge_is_a_wedge(degrees: float) -> None:
    angle, e = math.radians(degrees), 2e-3
    found = wrench(SnowContact(SnowField(H, S, 10.0), [straight()]), placed(angle, e))
    assert found[2] == pytest.approx(H * LENGTH * e * e / (2.0 * math.tan(abs(angle))), rel=1e-12)
    assert found[[0, 1]] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("ratio", [2.0, 10.0, 50.0])
def test_unloading_of_a_wedge_is_a_square(ratio: float) -> None:
    angle, e = math.radians(45), 2e-3
    contact = pressed(SnowField(H, S, ratio), placed(angle, e))
    most = wrench(contact, placed(angle, e))[2]
    for share in (0.2, 0.5, 0.9):
        lifted = wrench(contact, placed(angle, e - share * e / ratio))[2]
        assert lifted == pytest.approx(most * (1.0 - share) ** 2, rel=1e-9)
    assert wrench(contact, placed(angle, e - 1.01 * e / ratio))[2] == pytest.approx(0.0, abs=1e-12)  # rounding


def test_elastic_snow_keeps_nothing_and_the_energy_of_a_cycle_is_that_of_the_groove() -> None:
    angle = math.radians(45)
    contact = pressed(SnowField(H, S, 1.0), placed(angle, 2e-3))
    fresh = SnowContact(SnowField(H, S, 1.0), [straight()])
    assert wrench(contact, placed(angle, 1e-3)) == pytest.approx(wrench(fresh, placed(angle, 1e-3)), rel=1e-12)
    # ½ H_V ε² (1 - H_V/k_u) over the wedge's width: H_V e³ L (1 - 1/κ)/(6 tan ϑ).
    angle, e, ratio = math.radians(40), 3e-3, 8.0
    contact = pressed(SnowField(H, S, ratio), placed(angle, e))
    lost = H * e**3 * LENGTH * (1.0 - 1.0 / ratio) / (6.0 * math.tan(angle))
    assert contact.groove_energy == pytest.approx(lost, rel=0.02)  # lines stand for half a spacing beyond both ends
    depths = np.linspace(e, e * (1.0 - 1.0 / ratio), 41)
    back = np.trapezoid([wrench(contact, placed(angle, float(d)))[2] for d in depths], -depths)
    done = H * e**3 * LENGTH / (6.0 * math.tan(angle))
    assert done - back == pytest.approx(lost, rel=1e-3)


def test_an_edge_holds_up_to_its_strength_and_then_slips() -> None:
    angle, e, reach = math.radians(45), 2e-3, 0.5e-3
    contact = pressed(SnowField(H, S, 10.0, shear_displacement=reach), placed(angle, e))
    for aside in (0.1e-3, 0.4e-3, -0.3e-3):
        assert wrench(contact, placed(angle, e, y=aside))[1] == pytest.approx(-S * LENGTH * e * aside / reach, rel=1e-9)
    for aside in (0.6e-3, 5e-3):
        assert wrench(contact, placed(angle, e, y=aside))[1] == pytest.approx(-S * LENGTH * e, rel=1e-9)
    contact.update(*placed(angle, e, y=5e-3), 5e-4)  # slipped: it holds anew from half a millimetre behind
    assert wrench(contact, placed(angle, e, y=5e-3))[1] == pytest.approx(-S * LENGTH * e, rel=1e-9)
    assert wrench(contact, placed(angle, e, y=4.5e-3))[1] == pytest.approx(0.0, abs=1e-6)


def test_an_edge_that_leaves_its_base_rests_on_what_it_cut() -> None:
    """On the flat ground that the edge leaves, a base carries H_V/k_u of what it carries on virgin snow."""
    angle, e, ratio = math.radians(45), 2e-3, 10.0
    contact = pressed(SnowField(H, S, ratio), placed(angle, e))
    virgin = wrench(contact, placed(angle, e))[2]
    # the left edge is down and the base lies to its right: to the left it cuts
    steps = [placed(angle, e, y=float(y)) for y in np.linspace(0.0, 6e-3, 61)]
    for pose in steps[1:]:
        contact.update(*pose, 5e-4)
    assert wrench(contact, steps[-1])[2] == pytest.approx(virgin / ratio, rel=1e-9)
    # all at once, within the step: the same
    at_once = pressed(SnowField(H, S, ratio), placed(angle, e))
    assert wrench(at_once, steps[-1])[2] == pytest.approx(virgin / ratio, rel=1e-9)


@pytest.mark.parametrize("degrees", [30, -60])
def test_friction_acts_on_what_presses_on_the_base(degrees: float) -> None:
    """N cos ϑ + Z sin ϑ, which is N/cos ϑ in the balance of a carve, Z = N tan ϑ; or N."""
    angle, e, mu = math.radians(degrees), 2e-3, 0.05
    normal = H * LENGTH * e * e / (2.0 * math.tan(abs(angle)))
    strength = 1.25 * normal * math.tan(abs(angle)) / (LENGTH * e)  # at 80 % of the grip in balance
    gliding = np.array([[8.0, 0, 0, 0, 0, 0]])
    aside = -math.copysign(0.8 * 0.5e-3, angle)  # the snow then pushes to the side of the edge that is down
    loads: dict[ActsOn, float] = {"base-normal": normal / math.cos(angle), "snow-normal": normal}
    for acts_on, load in loads.items():
        snow = SnowField(H, strength, 1.0, mu, acts_on, "along-ski", shear_displacement=0.5e-3)
        contact = pressed(snow, placed(angle, e))
        found = wrench(contact, placed(angle, e, x=8.0 * 5e-4, y=aside), gliding)
        assert found[1] == pytest.approx(normal * math.tan(angle), rel=1e-9)
        assert found[0] == pytest.approx(-mu * load, rel=1e-5)
        assert contact.sections().friction_load.sum() == pytest.approx(load, rel=1e-9)
    unloaded = SnowContact(SnowField(H, strength, 1.0, mu, friction_acts_on="base-normal"), [straight()])
    assert wrench(unloaded, placed(angle, e), gliding)[0] == pytest.approx(-mu * normal * math.cos(angle), rel=1e-5)


def test_cutting_pushes_the_edge_out() -> None:
    """Machining at 60°, β = 0: 2 S cot 30° across, S (cot² 30° - 1) = 2 S off the snow, for each e L."""
    angle, e, cut = math.radians(60), 2e-3, 1e5
    snow = SnowField(H, S, 1.0, shear=MachiningShear(cut, 0.0, least_shear_plane=0.05))
    contact = pressed(snow, placed(angle, e))
    at_rest = wrench(contact, placed(angle, e))[2]
    found = wrench(contact, placed(angle, e, y=1e-3))
    assert found[1] == pytest.approx(-2.0 * cut * math.sqrt(3.0) * LENGTH * e, rel=1e-9)
    assert found[2] - at_rest == pytest.approx(2.0 * cut * LENGTH * e, rel=1e-9)


def test_strength_falls_with_slip() -> None:
    """From S_f to r S_f over the slip d, in proportion: after d/2 half of what can be lost."""
    angle, e, reach, ratio, over = math.radians(45), 2e-3, 0.02e-3, 0.4, 2e-3
    snow = SnowField(H, S, 1.0, shear_displacement=reach, residual_ratio=ratio, slip_weakening=over)
    contact = pressed(snow, placed(angle, e))
    for slip, left in ((0.0, 1.0), (0.5 * over, 0.7), (over, ratio), (3.0 * over, ratio)):
        pose = placed(angle, e, y=reach + slip)
        contact.update(*pose, 5e-4)
        assert wrench(contact, pose)[1] == pytest.approx(-left * S * LENGTH * e, rel=1e-9)


def test_stiffness_of_a_wedge() -> None:
    """∂F/∂e = H_V L e/tan ϑ, and S_f e L over the displacement to full strength across."""
    angle, e = math.radians(45), 2e-3
    contact = pressed(SnowField(H, S, 1.0), placed(angle, e))
    stiffness, damping = contact.tangent(*placed(angle, e), AT_REST, 5e-4)
    assert stiffness[0, 2, 2] == pytest.approx(H * LENGTH * e / math.tan(angle), rel=1e-6)
    assert stiffness[0, 1, 1] == pytest.approx(S * LENGTH * e / SHEAR_DISPLACEMENT, rel=1e-6)
    assert damping[0] == pytest.approx(np.zeros((6, 6)), abs=1e-6)


@pytest.mark.parametrize("ratio", [2.0, 10.0])
def test_a_runner_in_the_groove_of_another_lies_deeper(ratio: float) -> None:
    """Side-slip by the stance: the second edge runs where the first has cut, and both carry the same."""
    angle, e = math.radians(45), 2e-3
    snow = SnowField(H, S, ratio)
    ahead = SnowContact(snow, [straight()])
    for x in np.arange(0.0, 4.2, 0.02):
        ahead.update(*placed(angle, e, x=float(x)), 5e-4)
    behind = SnowContact(snow, [straight()])
    virgin = wrench(SnowContact(SnowField(H, S, ratio), [straight()]), placed(angle, e))[2]
    assert wrench(behind, placed(angle, e, x=1.5))[2] == pytest.approx(virgin, rel=1e-6)
    lifted = placed(angle, e * (1.0 - 0.5 / ratio), x=1.5)
    assert wrench(behind, lifted)[2] == pytest.approx(virgin * 0.25, rel=1e-3)


def groove_of_rocker(degrees: float, way: float, *, turn: float = 0.0) -> float:
    """Energy of a metre of groove (J) behind a base that is bent by 200 m and 1 mm deep in the middle, in steps of
    ``way`` (m), rolling by ``turn`` (rad) for each metre."""
    station = np.linspace(0.8, -0.8, 1601)
    rocker = Runner(station, np.full_like(station, 0.5 * WIDTH), station**2 / 400.0)
    contact = SnowContact(SnowField(H, S, 10.0, knot_area=1e-12, part_along=1.0, part_across=1.0), [rocker])
    angle, energy = math.radians(degrees), []
    for x in np.arange(round(1.8 / way) + 1) * way:
        position, _ = placed(angle, 1e-3, x=x)
        contact.update(position, edged(angle + turn * (x - 1.35))[None], 1e-3)
        energy.append(contact.groove_energy)
    passed = round(0.9 / way)
    return (energy[-1] - energy[-1 - passed]) / (passed * way)


def test_a_groove_is_as_deep_as_the_deepest_place_of_the_base() -> None:
    """Steps of 18 mm pass lines 20 mm apart at nine phases. Their ends alone miss 6.7e-8 m of 1 mm in the mean."""
    assert groove_of_rocker(0.0, 0.018) == pytest.approx(0.5 * H * (1.0 - 1.0 / 10.0) * WIDTH * 1e-6, rel=1e-12)


def test_a_base_that_rolls_is_deepest_elsewhere_at_each_place() -> None:
    """Ends alone miss 1.8e-4 of the energy. The depth is straight between five places across: it gains 2.3e-5."""
    fine = groove_of_rocker(1.0, 0.0005, turn=0.002)
    assert groove_of_rocker(1.0, 0.018, turn=0.002) == pytest.approx(fine, rel=3e-5)


def test_the_shear_of_a_waist_turns_where_the_edge_does() -> None:
    """An edge with a sidecut of 15 m passes over snow, 18 mm in a step: y = x²/(2 R cos ϑ) of its place turns back.

    Behind the waist S_f e turns from one side to the other within x₀ = √(4 R cos ϑ u_y): 4/3 x₀ are left over.
    Ends of steps alone leave 5 % more.
    """
    station, angle, depth, radius = np.linspace(0.8, -0.8, 1601), math.radians(45), 2e-3, 15.0
    wider = station**2 / (2.0 * radius)
    runner = Runner(station, 0.5 * WIDTH + wider, wider * math.tan(angle))
    contact = SnowContact(SnowField(H, S, 10.0, part_along=1.0, part_across=1.0), [runner])
    sheared = []
    for x in 0.018 * np.arange(100):
        pose = placed(angle, depth, x=x)
        contact.update(*pose, 1e-3)
        contact.force(*pose, AT_REST, 1e-3)
        sections = contact.sections()
        sheared.append(np.sum(sections.shear[np.abs(sections.position_along_ski) < 0.2005]))
    expected = 4.0 / 3.0 * math.sqrt(4.0 * radius * math.cos(angle) * SHEAR_DISPLACEMENT)
    assert np.mean(sheared[-10:]) / (S * depth) == pytest.approx(expected, rel=1e-3)


# Glide friction: against the sliding velocity, at any slip angle


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
