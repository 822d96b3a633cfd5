"""Snow that takes time against closed forms: a dashpot beside the spring, a Kelvin element in series with it."""

import math
from functools import cache

import numpy as np
import pytest

from skisnow._support.arrays import FloatArray
from skisnow.contact import SnowContact, SnowField

from .conftest import edged, straight

H, S, LENGTH, WIDTH = 2e8, 5e5, 1.6, 0.06
AREA = LENGTH * WIDTH
C, SHARE, TAU = 1e6, 0.5, 0.2
Placed = tuple[FloatArray, FloatArray]


def flat(depth: float, *, x: float = 0.0, lean: float = 0.0) -> Placed:
    return np.array([[x, 0.0, -depth]]), edged(0.0, lean)[None]


def moving(*velocity: float) -> FloatArray:
    return np.array([[*velocity, *(0.0 for _ in range(6 - len(velocity)))]])


def up(contact: SnowContact, pose: Placed, velocity: FloatArray | None = None, dt: float = 1e-3) -> float:
    """Force out of the snow (N)."""
    return float(contact.force(*pose, moving() if velocity is None else velocity, dt).wrench[0, 2])


def test_a_plate_pressed_at_constant_speed_bears_its_depth_and_its_speed() -> None:
    contact, speed, dt = SnowContact(SnowField(H, 0.0, 10.0, damping=C), [straight()]), 0.2, 1e-3
    for step in range(1, 11):
        depth = speed * dt * step
        assert up(contact, flat(depth), moving(0, 0, -speed), dt) == pytest.approx(AREA * (H * depth + C * speed))
        contact.update(*flat(depth), dt)


def test_a_plate_that_lands_meets_the_dashpot_at_once() -> None:
    contact = SnowContact(SnowField(H, 0.0, 10.0, damping=C), [straight()])
    assert up(contact, flat(1e-9), moving(0, 0, -0.3)) == pytest.approx(AREA * C * 0.3, rel=1e-5)
    assert up(contact, flat(-1e-9), moving(0, 0, -0.3)) == 0.0


def test_the_dashpot_never_pulls_and_is_gone_above_the_groove() -> None:
    contact = SnowContact(SnowField(H, 0.0, 10.0, damping=C), [straight()])
    contact.update(*flat(2e-3), 1e-3)
    assert up(contact, flat(2e-3), moving(0, 0, 1.0)) == pytest.approx(0.0, abs=1e-9)
    half = 0.5 * H * 2e-3 / C  # up at this speed c takes half of what the spring bears
    assert up(contact, flat(2e-3), moving(0, 0, half)) == pytest.approx(0.5 * AREA * H * 2e-3)
    assert up(contact, flat(1.7e-3), moving(0, 0, -1.0)) == 0.0  # the groove has sprung back to 1.8 mm


def test_a_base_that_leans_back_and_glides_presses() -> None:
    """By λ at v: at v tan λ."""
    contact, pose = SnowContact(SnowField(H, 0.0, 1.0, damping=C), [straight()]), flat(2e-2, lean=0.01)
    area = up(contact, pose) / (H * 2e-2)  # that the law itself has: the mean depth is that of the middle
    assert area == pytest.approx(AREA, rel=1e-3)
    assert up(contact, pose, moving(5.0)) == pytest.approx(area * (H * 2e-2 + C * 5.0 * math.tan(0.01)), rel=1e-7)


@pytest.mark.parametrize("across", [2.0, -2.0])
def test_an_edge_that_slips_across_meets_the_shear_strength_alone(across: float) -> None:
    contact = SnowContact(SnowField(H, S, 10.0, damping=C), [straight()])
    pose = (np.array([[0.0, 0.0, 0.0]]), edged(0.5)[None])
    assert up(contact, pose, moving(0.0, across)) == pytest.approx(up(contact, pose), rel=1e-12)


def test_a_roll_turns_the_base_into_the_snow() -> None:
    """Down to the left at ω: the moment of c ω y over the width, c ω L b³/12."""
    contact = SnowContact(SnowField(H, 0.0, 1.0, damping=C), [straight()])
    wrench = contact.force(*flat(1e-2), moving(0, 0, 0, -0.1), 1e-3).wrench[0]
    assert wrench[3] == pytest.approx(C * 0.1 * LENGTH * WIDTH**3 / 12.0, rel=1e-9)
    assert wrench[2] == pytest.approx(AREA * H * 1e-2)


def crept(contact: SnowContact, load: float, times: FloatArray) -> list[float]:
    """Depths of a plate under a load that stays, from where it stands at once."""
    depth = load / (H * AREA)
    contact.update(*flat(depth), 0.0)
    found = [depth]
    for dt in np.diff(times):
        for _ in range(40):  # secants are exact for a straight law
            residual = load - up(contact, flat(depth), dt=float(dt))
            depth += residual / (H * AREA)
        contact.update(*flat(depth), float(dt))
        found.append(depth)
    return found


@pytest.mark.parametrize("ratio", [1.0, 10.0])
@pytest.mark.parametrize("steps", [4, 16])
def test_creep_under_a_load_that_stays(ratio: float, steps: int) -> None:
    """Exact for any step: the stress stays."""
    snow = SnowField(H, 0.0, ratio, delayed_share=SHARE, retardation_time=TAU)
    contact, times, load = SnowContact(snow, [straight()]), np.linspace(0.0, 3.0 * TAU, steps), 2e4
    known = load / AREA / H * (1.0 + SHARE * -np.expm1(-times / TAU))
    assert crept(contact, load, times) == pytest.approx(known, rel=1e-9)
    # its pressure did all of that work
    assert contact.delayed_energy == pytest.approx(
        load * (known[-1] - known[0]), rel=0.02
    )  # half a spacing at the ends


def test_a_load_on_a_dashpot_sinks_as_it_does() -> None:
    snow, load = SnowField(H, 0.0, 10.0, damping=C), 2e4
    contact, depth, times = SnowContact(snow, [straight()]), 1e-12, np.linspace(0.0, 3.0 * C / H, 301)
    dt = float(times[1])

    def speed(deep: float) -> float:
        """At which the plate goes down, for the force to be the load: it is straight in it."""
        rest = up(contact, flat(deep), dt=dt)
        return (load - rest) / (up(contact, flat(deep), moving(0, 0, -1.0), dt) - rest)

    for _ in times[1:]:  # Heun's method
        first = speed(depth)
        depth += 0.5 * dt * (first + speed(depth + dt * first))
        contact.update(*flat(depth), dt)
    assert depth == pytest.approx(-load / AREA / H * math.expm1(-H * times[-1] / C), rel=1e-5)


def relaxed(pose: Placed, steps: int, spacing: float = 1e-3) -> tuple[float, float]:
    """Force at once and after 2 τ on elastic snow, the pose held from some steps."""
    snow = SnowField(H, 0.0, 1.0, delayed_share=SHARE, retardation_time=TAU, delayed_spacing=spacing)
    contact = SnowContact(snow, [straight()])
    contact.update(*pose, 0.0)
    first = up(contact, pose, dt=0.0)
    for _ in range(steps):
        contact.update(*pose, 2.0 * TAU / steps)
    return first, up(contact, pose, dt=0.0)


LEFT = (1.0 + SHARE * math.exp(-2.0 * (1.0 + SHARE))) / (1.0 + SHARE)


def test_stress_relaxes_at_a_held_depth_to_the_second_order_and_a_wedge_relaxes_as_all_its_points() -> None:
    errors = []
    for steps in (4, 8, 16):
        first, then = relaxed(flat(2e-3), steps)
        assert first == pytest.approx(H * AREA * 2e-3)
        errors.append(abs(then / first - LEFT))
    assert errors[0] > 3.5 * errors[1] > 12.0 * errors[2] > 0.0
    # All but its ends, which lie between two places.
    # The delayed depth falls to 0 at the place beyond the edge: half of it is missing on at most one spacing, under the
    # highest pressure, which is twice the mean. That is the share spacing/width of the force that relaxes.
    depth = 3e-3
    pose = (np.array([[0.0, 0.0, 0.5 * WIDTH * math.sin(0.7) - depth]]), edged(0.7)[None])
    for spacing in (1e-3, 2.5e-4, 6.25e-5):
        first, then = relaxed(pose, 64, spacing)
        assert abs(then / first - LEFT) < spacing / (depth / math.tan(0.7)) * (1.0 - LEFT), spacing


def test_a_base_that_reaches_far_along_a_line_is_pressed_at_once() -> None:
    """Newton's method passes such poses. Pieces as long as the delayed depth's places would be 60 billion."""
    contact = SnowContact(SnowField(H, 0.0, 1.0, delayed_share=SHARE, retardation_time=TAU), [straight()])
    contact.update(*flat(2e-3), 1e-3)
    found = [turn * up(contact, (flat(2e-3)[0], edged(0.0, turn=0.5 * math.pi - turn)[None])) for turn in (1e-5, 1e-9)]
    assert found[1] == pytest.approx(found[0], rel=1e-3)


def test_turned_about_the_snows_normal_nothing_changes() -> None:
    snow = SnowField(H, 0.0, 5.0, damping=C, delayed_share=SHARE, retardation_time=TAU)
    found = []
    for turn in (0.0, 1.1):
        about = edged(0.0, turn=turn)
        contact = SnowContact(snow, [straight()])
        for step in range(5):
            place, motion = np.array([0.02 * step, 1e-3 * step, 0.012 - 1e-3 * step]), np.array([4.0, 0.2, -0.2])
            pose = ((about @ place)[None], (about @ edged(0.5))[None])
            velocity = np.concatenate([about @ motion, about @ [0.1, 0.0, 0.2]])[None]
            wrench = contact.force(*pose, velocity, 5e-3).wrench.reshape(2, 3)
            contact.update(*pose, 5e-3)
        found.append(wrench @ about)
    assert found[1] == pytest.approx(found[0], rel=1e-9, abs=1e-6)


def test_a_state_holds_what_is_delayed() -> None:
    snow = SnowField(H, 0.0, 5.0, delayed_share=SHARE, retardation_time=TAU)
    contact = SnowContact(snow, [straight()])
    contact.update(*flat(2e-3), 1e-3)
    contact.update(*flat(2e-3), 0.05)
    state = contact.state()
    found = []
    for _ in range(2):
        contact.update(*flat(2.2e-3, x=0.3), 0.05)
        contact.update(*flat(2.2e-3, x=0.6), 0.05)
        found.append((up(contact, flat(2.1e-3, x=0.6)), contact.delayed_energy))
        contact.restore(state)
    assert found[0] == found[1]


@pytest.mark.parametrize("waits", [0.1, 0.5])
def test_an_older_track_springs_back_while_nobody_is_there(waits: float) -> None:
    """Elastic snow, pressed for long: ε₂ is half of the depth, and e^(-t/τ) of it is left when somebody comes back."""
    snow = SnowField(H, 0.0, 1.0, delayed_share=SHARE, retardation_time=TAU)
    contact = SnowContact(snow, [straight()])
    contact.update(*flat(2e-3), 0.0)
    for _ in range(100):
        contact.update(*flat(2e-3), 0.05)
    delayed = SHARE / (1.0 + SHARE) * 2e-3
    contact.update(*flat(-0.1), 0.0)
    contact.update(*flat(-0.1, x=10.0), 0.0)  # the lines are left
    contact.update(*flat(-0.1, x=10.0), waits)
    back = SnowContact(snow, [straight()])
    missing = H * AREA * 2e-3 - up(back, flat(2e-3), dt=0.0)
    assert missing == pytest.approx(
        H * AREA * delayed * math.exp(-waits / TAU), rel=0.02
    )  # between two lines at the ends


def test_snow_without_it_has_the_same_bits() -> None:
    plain, off = SnowField(H, S, 10.0), SnowField(H, S, 10.0, retardation_time=7.0, delayed_spacing=3e-3)
    found = []
    for snow in (plain, off):
        contact = SnowContact(snow, [straight()])
        contact.update(*flat(2e-3), 1e-3)
        found.append(contact.force(*flat(1.9e-3, lean=0.01), moving(3.0, 0.1, -0.2), 1e-3).wrench)
    assert np.array_equal(found[0], found[1])


RADIUS, SPEED = 12.0, 10.0
ANGLE, DEPTH = math.radians(30.0), 8e-3
WAY = 2.4
"""(m) more than the length of the runner, so that no line knows of the start."""


def pose(s: float) -> tuple[FloatArray, FloatArray]:
    """After a way along a circle, left edge down, the ski along its tangent."""
    turn = s / RADIUS
    ahead = np.array([math.cos(turn), math.sin(turn), 0.0])
    left = np.array([-math.sin(turn), math.cos(turn), 0.0])
    up = np.array([0.0, 0.0, 1.0])
    across = math.cos(ANGLE) * left - math.sin(ANGLE) * up
    height = 0.03 * math.sin(ANGLE) - DEPTH
    place = np.array([RADIUS * math.sin(turn), RADIUS * (1.0 - math.cos(turn)), height])
    return place[None], np.column_stack([ahead, across, np.cross(ahead, across)])[None]


@cache
def wrench(step: float) -> FloatArray:
    """In the ski's axes at the end of the way, gone in steps of a length (m)."""
    snow = SnowField(2e8, 3e5, 10.0, shear_displacement=2e-5, part_along=2e-3)
    contact = SnowContact(snow, [straight()])
    places = np.linspace(0.0, WAY, round(WAY / step) + 1)
    for place in places[:-1]:
        contact.update(*pose(float(place)), step / SPEED)
    position, rotation = pose(float(places[-1]))
    found = contact.force(position, rotation, np.zeros((1, 6)), step / SPEED).wrench[0]
    return np.concatenate([rotation[0].T @ found[:3], rotation[0].T @ found[3:]])


@pytest.mark.parametrize("step", [0.06, 0.03])
def test_long_steps_leave_what_short_ones_do(step: float) -> None:
    """A chord of 6 cm lies 37 µm beside the circle: more than the edge's displacement to full strength."""

    fine = wrench(2e-3)
    assert wrench(step) == pytest.approx(fine, abs=0.02 * float(np.abs(fine).max()))
