"""What a contact promises whatever the numbers: runners, states, surfaces, laws, bits, older tracks."""

import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
import pytest

from skisnow import read_ski
from skisnow._support.arrays import FloatArray
from skisnow._support.errors import ParameterError
from skisnow.compiled import core
from skisnow.contact import Runner, SnowContact, SnowField
from skisnow.forces.friction import ConstantFriction, FrictionLaw, LinearFriction, QuadraticFriction, WaterFilmFriction
from skisnow.forces.shear import AngleShear, MachiningShear, ShearLaw
from skisnow.geometry.surfaces import Grid
from tests.coded import raises

from .conftest import edged, straight

H, S = 2e8, 5e5
SKI = Runner.of(read_ski("giant-slalom"))
SPEED = np.array([[8.0, 0.1, -0.01, 0.0, 0.0, 0.3]])


def carving(step: int, *, y: float = 0.0, angle: float = 0.6) -> tuple[FloatArray, FloatArray]:
    """A ski that runs along a circle of 12 m, 4 mm a step, going up and down by a tenth of a millimetre."""
    turn = 0.004 * step / 12.0
    centre = np.array([12.0 * math.sin(turn), y + 12.0 * (1.0 - math.cos(turn)), 0.016 + 1e-4 * math.sin(0.3 * step)])
    return centre[None], edged(angle, turn=turn)[None]


def history(contact: SnowContact, steps: range) -> FloatArray:
    out = []
    for step in steps:
        out.append(contact.force(*carving(step), SPEED, 5e-4).wrench[0])
        contact.update(*carving(step), 5e-4)
    return np.array(out)


def test_forces_of_several_runners_are_those_of_each() -> None:
    poses = [carving(0, angle=a, y=y) for a, y in ((0.6, 0.25), (0.8, -0.25), (-0.3, 3.0))]
    position, rotation = (np.concatenate(parts) for parts in zip(*poses, strict=True))
    together = SnowContact(SnowField(H, S, 10.0), [SKI] * 3).force(position, rotation, np.repeat(SPEED, 3, 0), 0.0)
    for wrench, pose in zip(together.wrench, poses, strict=True):
        assert np.array_equal(wrench, SnowContact(SnowField(H, S, 10.0), [SKI]).force(*pose, SPEED, 0.0).wrench[0])


def test_a_look_leaves_the_snow_as_it_is() -> None:
    contact, looked_at = (SnowContact(SnowField(H, S, 10.0), [SKI]) for _ in range(2))
    first = history(contact, range(20))
    second = []
    for step in range(20):
        looked_at.force(*carving(step + 3, y=0.01), SPEED, 4e-3)
        second.append(looked_at.force(*carving(step), SPEED, 5e-4).wrench[0])
        looked_at.update(*carving(step), 5e-4)
    assert np.array_equal(first, np.array(second))


def test_a_state_whose_tracks_are_forgotten_is_refused() -> None:
    """A later state after an earlier one: the tracks in between are no more."""
    contact = SnowContact(SnowField(2e8, 3e5, 10.0), [Runner(np.array([0.4, -0.4]), np.full(2, 0.03), np.zeros(2))])

    def go(start: float, end: float) -> None:
        for x in np.arange(start, end, 0.05):
            contact.update([[x, 0.0, -1e-3]], [np.eye(3)], 1e-3)

    go(0.0, 1.0)
    early = contact.state()
    go(1.0, 3.0)
    late = contact.state()
    contact.restore(early)
    with raises(ParameterError, "invalid"):
        contact.restore(late)
    go(1.0, 3.5)
    before = contact.tracks()
    with raises(ParameterError, "invalid"):
        contact.restore(late)  # as many tracks, and more, but others
    assert np.array_equal(contact.tracks(), before)
    contact.restore(early)


def test_a_restored_state_goes_on_with_the_same_bits() -> None:
    contact = SnowContact(SnowField(H, S, 10.0), [SKI])
    history(contact, range(600))  # 2.4 m: lines have been left behind
    kept = contact.state()
    first, grooves = history(contact, range(600, 700)), contact.tracks()
    contact.restore(kept)
    assert np.array_equal(history(contact, range(600, 700)), first)
    assert np.array_equal(contact.tracks(), grooves)


def test_a_long_step_is_marched_like_short_ones() -> None:
    short, long = (SnowContact(SnowField(H, S, 10.0), [SKI]) for _ in range(2))
    history(short, range(41))
    for step in range(0, 41, 8):
        long.update(*carving(step), 4e-3 if step else 0.0)
    one, other = (each.force(*carving(41), SPEED, 5e-4).wrench[0] for each in (short, long))
    assert np.abs(one - other).max() < 0.01 * np.abs(one).max()


def test_bits_are_the_same_on_every_instruction_set_and_in_threads() -> None:
    def run(name: str) -> FloatArray:
        return history(SnowContact(SnowField(H, S, 10.0), [SKI], instruction_set=name), range(60))

    with ThreadPoolExecutor(3) as pool:
        found = list(pool.map(run, core.instruction_sets() * 2))
    assert all(np.array_equal(each, found[0]) for each in found)


def test_a_ski_that_has_taken_off_meets_its_groove_as_any_other_ski_does() -> None:
    snow = SnowField(H, S, 10.0)
    skis = [SnowContact(snow, [SKI]) for _ in range(2)]
    history(skis[0], range(60))
    position, rotation = carving(40)
    skis[0].update(position + np.array([0.0, 0.0, 1.0]), rotation, 0.01)
    own, other = (each.force(position, rotation, SPEED, 0.0).wrench[0] for each in skis)
    virgin = SnowContact(SnowField(H, S, 10.0), [SKI]).force(position, rotation, SPEED, 0.0).wrench[0]
    assert own == pytest.approx(other, rel=1e-9)
    assert abs(virgin[2] / own[2] - 1.0) > 0.05


def test_a_crossed_track_is_met_as_deep_as_it_was_left() -> None:
    """A flat ski over an old flat groove of half its depth: forces are less by the loss, whatever the heading."""
    depth, height = 2e-3, -1e-3
    for heading in (math.pi / 2, math.radians(30)):
        snow = SnowField(H, S, 10.0)
        first = SnowContact(snow, [straight(length=1.0)])
        for x in np.arange(-2.0, 2.0, 0.02):
            first.update([[x, 0.0, -depth]], [np.eye(3)], 5e-4)
        over = SnowContact(snow, [straight(length=1.0)])
        pose = [[-0.4, 0.0, height]], [edged(0.0, turn=heading)]
        found = over.force(*pose, SPEED * 0.0, 0.0).wrench[0][2]
        virgin = SnowContact(SnowField(H, S, 10.0), [straight(length=1.0)]).force(*pose, SPEED * 0.0, 0.0).wrench[0][2]
        # nothing pushes where the groove lies deeper by more than H_V/k_u of its depth
        under = min(0.06 / math.sin(heading), 1.0)
        assert found == pytest.approx(virgin * (1.0 - under), rel=0.02)


def test_a_tilted_plane_as_a_grid_is_a_plane() -> None:
    tilt = edged(0.0, lean=math.radians(-14.0))  # of the slope, x down
    x = np.linspace(-3.0, 3.0, 25)
    grid = Grid(x, x, np.repeat((x * tilt[2, 0] / tilt[0, 0])[:, None], 25, axis=1))
    plane, tilted = SnowContact(SnowField(H, S, 10.0), [SKI]), SnowContact(SnowField(H, S, 10.0, surface=grid), [SKI])
    for step in range(50):
        position, rotation = carving(step)
        turned = (tilt @ position[0])[None], (tilt @ rotation[0])[None]
        one = plane.force(position, rotation, SPEED, 5e-4).wrench[0].reshape(2, 3)
        velocity = (SPEED.reshape(2, 3) @ tilt.T).reshape(1, 6)
        other = tilted.force(*turned, velocity, 5e-4).wrench[0].reshape(2, 3) @ tilt
        assert np.abs(one - other).max() < 1e-7 * np.abs(one).max()
        plane.update(position, rotation, 5e-4)
        tilted.update(*turned, 5e-4)


def test_snow_may_differ_from_place_to_place() -> None:
    places = np.linspace(-2.0, 2.0, 9)
    varied = SnowField(Grid.along(places, H * (1.0 + 0.2 * places)), S, 10.0)
    pose = [[0.0, 0.0, -1e-3]], [np.eye(3)]
    found = SnowContact(varied, [straight(length=1.0)]).force(*pose, SPEED * 0.0, 0.0).wrench[0]
    assert found[2] == pytest.approx(H * 0.06 * 1e-3, rel=1e-9)
    # ∫ H_V (1 + 0.2 x) w d x dx over the length: about the y axis, nose up is negative
    assert found[4] == pytest.approx(-0.2 * H * 0.06 * 1e-3 / 12.0, rel=1e-3)


@pytest.mark.parametrize("angle_deg", [-50.0, 50.0])
def test_an_edge_that_slips_aside_meets_the_snow_of_where_it_is(angle_deg: float) -> None:
    """Ridges 0.2 m apart in H_V and S_f: over the forces in level snow those at the edge are the ridge's own."""
    angle, side = math.radians(angle_deg), math.copysign(1.0, angle_deg)
    y = np.linspace(-0.5, 0.5, 201)

    def ridge(place: FloatArray | float) -> FloatArray:
        return np.asarray(1.0 + 0.3 * np.sin(2.0 * math.pi * place / 0.2))

    hardness, strength = (Grid(np.array([-2.0, 2.0]), y, np.tile(size * ridge(y), (2, 1))) for size in (H, S))
    fields = SnowField(hardness, strength, 10.0), SnowField(H, S, 10.0)
    contacts = [SnowContact(each, [straight()]) for each in fields]
    for n in range(300):  # towards the base, which presses all that the edge then cuts
        position = np.array([[0.0, -side * 5e-4 * n, 0.03 * math.sin(abs(angle)) - 2e-3]])
        for contact in contacts:
            contact.update(position, edged(angle)[None], 1e-3)
        if n > 10:
            rugged, level = (c.force(position, edged(angle)[None], SPEED * 0.0, 0.0).wrench[0, 1:3] for c in contacts)
            edge = position[0, 1] + side * 0.03 * math.cos(angle)
            assert rugged == pytest.approx(level * ridge(edge), rel=2e-4)


def test_a_ski_that_drags_its_tail_goes_on_over_its_lines() -> None:
    """Tail down and rolled the lines lie as evenly as level: not laid anew, a strip of tracks each step."""
    contact = SnowContact(SnowField(H, S, 10.0), [straight()])
    rotation = edged(math.radians(55), lean=math.radians(40))[None]
    height = -min(float((rotation[0] @ [-0.8, side, 0.0])[2]) for side in (0.03, -0.03)) - 0.03
    for n in range(50):
        contact.update(np.array([[5e-3 * n, 0.0, height]]), rotation, 1e-3)
    assert contact.force([[0.25, 0.0, height]], rotation, SPEED * 0.0, 1e-3).wrench[0][2] > 0.0
    assert len(set(contact.tracks()[:, 0])) == 1


@dataclass(frozen=True)
class _Kinked(FrictionLaw):
    """A law written here."""

    def _coefficient(self, speed: FloatArray) -> FloatArray:
        return np.where(speed < 5.0, 0.02, 0.07)


@pytest.mark.parametrize(
    "law",
    [
        ConstantFriction(0.05),
        LinearFriction(0.03, 0.002),
        QuadraticFriction(0.03, 0.002, 1e-4),
        WaterFilmFriction(lubricated_friction=0.01, dry_friction=0.05, film_speed=3.0, viscous_slope=0.001),
        _Kinked(),
    ],
    ids=lambda law: type(law).__name__,
)
def test_every_friction_law_runs_and_is_its_own_formula(law: FrictionLaw) -> None:
    contact = SnowContact(SnowField(H, S, 10.0, friction=law), [SKI])
    contact.force(*carving(0), SPEED, 0.0)
    found = contact.sections()
    met = found.normal_force > 0.0
    speed = np.hypot(found.sliding, found.sliding_aside)
    assert met.sum() > 20
    assert found.mu[met] == pytest.approx(law.coefficient(speed)[met], rel=1e-12)
    assert found.rub[met] == pytest.approx((found.sliding / speed)[met], rel=1e-12)
    assert found.rub_aside[met] == pytest.approx((found.sliding_aside / speed)[met], rel=1e-12)


def sheared(law: ShearLaw, *, lean: float = 0.0) -> FloatArray:
    """Force of the shear on a straight edge of 1.6 m, 2 mm deep in the middle, at 50°, that is pushed aside (N)."""
    angle = math.radians(50)
    pose = np.array([[0.0, 0.0, 0.03 * math.sin(angle) - 2e-3]]), edged(angle, lean)[None]
    force = []
    for shear in (law, None):
        contact = SnowContact(SnowField(H, 0.0, 10.0, shear=shear), [straight()])
        contact.update(*pose, 0.0)
        force.append(contact.force(pose[0] + [[0.0, 2e-3, 0.0]], pose[1], SPEED * 0.0, 5e-4).wrench[0, :3])
    return force[0] - force[1]


@pytest.mark.parametrize("law", [AngleShear(3e5, 0.266), MachiningShear(1e5, 0.1)], ids=lambda law: type(law).__name__)
def test_shear_laws_give_strength_and_thrust(law: ShearLaw) -> None:
    _, across, off = sheared(law)
    assert -across == pytest.approx(float(law.failure_force(2e-3, 1.6, math.radians(50))), rel=1e-9)
    assert off == pytest.approx(float(law.thrust_force(2e-3, 1.6, math.radians(50))), rel=1e-9)


@pytest.mark.parametrize("lean", [0.001, -0.001])
def test_a_cut_does_no_work_on_an_edge_that_slides_along_itself(lean: float) -> None:
    """Nose up or down: a thrust along the snow's normal would drive a ski that rises along its own edge."""
    force = sheared(MachiningShear(1e5, 0.1), lean=lean)
    assert force[2] > 100.0
    assert force @ edged(math.radians(50), lean)[:, 0] == pytest.approx(0.0, abs=1e-9 * force[2])


def test_machining_below_its_friction_angle_is_refused() -> None:
    law = MachiningShear(1e5, 1.0)
    contact = SnowContact(SnowField(H, 0.0, 10.0, shear=law), [SKI])
    with raises(ParameterError, "invalid_law"):
        contact.force(*carving(0), SPEED, 0.0)


# Lines that learn of older tracks as the ski comes to them, and that stand for the ski halfway to their neighbours


WEAK = 3e5
LEVEL = np.eye(3)
AWAY = [0.0, 5.0, 1.0]


def turning_skid(spacing: float, slip: float = math.radians(18.0)) -> tuple[SnowContact, FloatArray]:
    """A ski on an arc of 20 m at 15 m/s, turned 18° inwards of its way: its lines fan out under it. The force after
    0.25 s, in its own axes."""
    place = np.linspace(0.8, -0.8, 81)
    ski = Runner(place, 0.033 + 0.02 * (place / 0.8) ** 2, 0.02 * np.maximum(np.abs(place) - 0.65, 0.0) / 0.15)
    contact = SnowContact(SnowField(H, WEAK, 10.0), [ski], spacing=spacing)
    speed, radius, dt = 15.0, 20.0, 1e-3
    for step in range(251):
        heading = speed / radius * step * dt
        pose = [[radius * math.sin(heading), radius * (1.0 - math.cos(heading)), 0.012]]
        rotation = edged(math.radians(25.0), lean=0.0026, turn=heading + slip)
        contact.update(pose, [rotation], dt if step else 0.0)
    motion = [[speed * math.cos(heading), speed * math.sin(heading), 0.0, 0.0, 0.0, speed / radius]]
    force = contact.force(pose, [rotation], motion, 0.0).wrench[0][:3]
    return contact, rotation.T @ np.asarray(force)


def test_the_lines_stand_for_the_whole_ski_however_they_fan_out() -> None:
    """By one spacing each they stood for 1.6 % more or less."""
    contact, force = turning_skid(0.02)
    assert np.sum(contact.sections(0).length) == pytest.approx(1.6, rel=1e-12)
    _, finer = turning_skid(0.005)
    assert np.linalg.norm(force - finer) < 0.005 * np.linalg.norm(finer)


@pytest.mark.parametrize("gap", [0.0, 0.7])
def test_a_ski_meets_the_groove_in_which_another_still_stands(gap: float) -> None:
    """It slips sideways to where the other ski was pressed and lifted; nobody has left a track by going on."""
    deep, height = -2e-3, -1e-3
    contact = SnowContact(SnowField(H, WEAK, 10.0), [straight(length=1.0), straight(length=1.0)])
    for z in (1e-3, deep, 0.5):
        contact.update([[gap, 0.0, z], AWAY], [LEVEL, LEVEL], 0.0)
    aside = np.arange(0.5, -0.001, -0.02)
    for y in aside:
        contact.update([[gap, 0.0, 0.5], [0.0, y, 0.002]], [LEVEL, LEVEL], 5e-3)
    found = contact.force([[gap, 0.0, 0.5], [0.0, 0.0, height]], [LEVEL, LEVEL], np.zeros((2, 6)), 0.0).wrench
    virgin = SnowContact(SnowField(H, WEAK, 10.0), [straight(length=1.0)])
    whole = virgin.force([[0.0, 0.0, height]], [LEVEL], np.zeros((1, 6)), 0.0).wrench[0][2]
    assert found[1][2] == pytest.approx(gap * whole, rel=0.02, abs=1e-9)


@pytest.mark.parametrize("x", [-0.25, 0.25])
@pytest.mark.parametrize("y", [-0.25, 0.25])
def test_a_track_is_found_wherever_it_lies(x: float, y: float) -> None:
    """To the right of the origin and behind it none was found by lines that begin there."""
    snow = SnowField(H, WEAK, 10.0)
    first = SnowContact(snow, [straight(length=0.1)])
    for step in np.arange(-1.0, 1.0, 0.02):
        first.update([[x + step, y, -2e-3]], [LEVEL], 5e-4)
    over = SnowContact(snow, [straight(length=0.3)])
    force = over.force([[x, y, -1e-3]], [LEVEL], np.zeros((1, 6)), 0.0).wrench[0]
    assert abs(force[2]) < 1e-9


@pytest.mark.parametrize("shift", np.arange(0.0, 0.02, 0.0025))
@pytest.mark.parametrize("turn", [0.5 * math.pi, 0.49 * math.pi, 0.3 * math.pi])
def test_a_thin_track_is_met_or_its_width_is_told(shift: float, turn: float) -> None:
    """An edge of 4 mm crosses the way of a ski: wherever its lines lie, they meet the track, or its width is told."""
    snow, ahead = SnowField(H, WEAK, 10.0), np.array([math.cos(turn), math.sin(turn), 0.0])
    thin = SnowContact(snow, [straight(length=0.05, width=0.004)])
    for step in np.arange(-0.3, 0.3, 0.02):
        thin.update([ahead * step + [shift, 0.0, -2e-3]], [edged(0.0, turn=turn)], 5e-4)
    over = SnowContact(snow, [straight(length=1.0, width=0.06)])
    force = over.force([[0.0, 0.0, -1e-3]], [LEVEL], np.zeros((1, 6)), 0.0).wrench[0][2]
    per_length = H * 1e-3 * 0.06
    missing, told = per_length * 1.0 - force, over.unseen_track_width
    assert told > 0.0 or missing > 0.5 * 0.004 * per_length / math.sin(turn)
    if turn == 0.5 * math.pi:
        assert (told, missing) in (
            (pytest.approx(0.004), pytest.approx(0.0, abs=1e-9)),
            (0.0, pytest.approx(0.02 * per_length)),
        )
    if turn == 0.3 * math.pi:
        assert told == 0.0
    assert thin.unseen_track_width == 0.0
