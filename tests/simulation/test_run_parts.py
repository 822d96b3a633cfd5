"""Parts of a run, each on numbers that were made up for it."""

import math
from dataclasses import replace
from functools import cache
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from skisnow.dynamics.motion import MOMENT
from skisnow.geometry.vectors import axes_of
from skisnow.scenario import Plane, Profile, Terrain, load_scenario
from skisnow.simulation.moving_boots import BootHistory
from skisnow.simulation.run import Run
from skisnow.simulation.run_record import Record, _heading, turn_radius
from skisnow.simulation.run_setup import Setup
from skisnow.simulation.run_summary import GatesAhead, energies_dict, racer_parts, run_gates, summary_dict
from skisnow.simulation.verification import limit_sentences, verify
from skisnow.track.course import Course, Gate

from .straight_run import STRAIGHT, straight_run

PLAIN = load_scenario("carved-46m", changes=STRAIGHT)


def stub(**parts: Any) -> Any:
    return cast("Any", SimpleNamespace(**parts))


# The record


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_radius_of_a_circle(side: float) -> None:
    """In a plane that is tilted, at a speed that grows."""
    time = np.linspace(0.0, 1.0, 201)
    normal = np.array([0.6, 0.0, 0.8])
    level = np.array([[0.8, 0.0, -0.6], [0.0, 1.0, 0.0], normal])
    angle = side * (0.5 * time + 0.2 * time**2)
    speed = 12.0 * (0.5 + 0.4 * time)
    velocity = speed[:, None] * np.stack([np.cos(angle), np.sin(angle), 0.0 * time], axis=1) @ level
    found = turn_radius(time, velocity, np.broadcast_to(normal, velocity.shape))
    assert found[2:-2] == pytest.approx(np.full(197, side * 12.0), rel=1e-4)


def test_what_is_straight_or_stands_has_no_radius() -> None:
    time = np.linspace(0.0, 1.0, 11)
    up = np.broadcast_to([0.0, 0.0, 1.0], (11, 3))
    straight = np.stack([1.0 + time, 2.0 + 2.0 * time, 0.0 * time], axis=1)
    assert np.all(np.isinf(turn_radius(time, straight, up)))
    turning = np.stack([np.cos(time), np.sin(time), 0.0 * time], axis=1)
    assert np.all(np.isinf(turn_radius(time, 0.0099 * turning, up)))
    assert turn_radius(time, 0.0101 * turning, up)[5] == pytest.approx(0.0101, rel=2e-3)
    assert turn_radius(time[:1], turning[:1], up[:1]).tolist() == [math.inf]
    assert turn_radius(time[:2], turning[:2], up[:2]) == pytest.approx(np.ones(2), rel=1e-2)


def test_the_heading_continues_beyond_half_a_turn() -> None:
    """From where x points, seen from above, on a slope that falls to the left as well."""
    normal = np.array([0.3, 0.4, 1.0]) / math.sqrt(1.25)
    down = np.array([1.0, 0.0, -0.3]) / math.sqrt(1.09)
    angle = np.linspace(0.0, 7.0, 30)
    ahead = np.cos(angle)[:, None] * down + np.sin(angle)[:, None] * np.cross(normal, down)
    attitude = np.stack([ahead, ahead, ahead], axis=2)
    assert _heading(attitude, np.broadcast_to(normal, ahead.shape)) == pytest.approx(angle)


@pytest.mark.parametrize(
    ("first", "last", "gains"),
    [
        # kinetic, potential, elastic; ...; given by boots, by pushes: a twentieth of what is exchanged and 10 J
        ((1000.0, 0.0, 0.0, 0.0, 0.0), (1059.0, 0.0, 0.0, 0.0, 0.0), False),
        ((1000.0, 0.0, 0.0, 0.0, 0.0), (1061.0, 0.0, 0.0, 0.0, 0.0), True),
        ((1000.0, 50.0, 5.0, 0.0, 0.0), (1059.0, 50.0, 5.0, 0.0, 0.0), False),
        ((0.0, 500.0, 0.0, 0.0, 0.0), (534.0, 0.0, 0.0, 0.0, 0.0), False),  # a fall by 500 J is exchanged
        ((0.0, 500.0, 0.0, 0.0, 0.0), (536.0, 0.0, 0.0, 0.0, 0.0), True),
        ((0.0, 0.0, 0.0, 0.0, 0.0), (0.0, 9.0, 0.0, 0.0, 0.0), False),  # a rise is not
        ((0.0, 0.0, 0.0, 0.0, 0.0), (0.0, 11.0, 0.0, 0.0, 0.0), True),
        ((0.0, 0.0, 0.0, 0.0, 0.0), (300.0, 0.0, 24.0, 200.0, 100.0), False),
        ((0.0, 0.0, 0.0, 0.0, 0.0), (300.0, 0.0, 26.0, 200.0, 100.0), True),
        ((0.0, 0.0, 0.0, 0.0, 0.0), (-300.0, 0.0, 24.0, -200.0, -100.0), False),
        ((0.0, 0.0, 0.0, 0.0, 0.0), (math.nan, 0.0, 0.0, 0.0, 0.0), True),
    ],
)
def test_energy_out_of_nothing(first: tuple[float, ...], last: tuple[float, ...], gains: bool) -> None:
    rows = np.zeros((3, 39))
    rows[:, MOMENT["energies"]] = [first[:3], [math.inf] * 3, last[:3]]
    rows[:, MOMENT["work_given"]] = [first[3:], [math.inf] * 2, last[3:]]
    record = stub(_moments=[stub(row=row) for row in rows])
    assert cast("Any", Record.gains_energy).fget(record) is gains


# The state under way


@cache
def level_grid() -> Terrain:
    """From 0 to 10 m, and 2 m to either side."""
    return Terrain(np.linspace(0.0, 10.0, 5), np.linspace(-2.0, 2.0, 5), np.zeros((5, 5)))


def test_lean_and_height_are_against_the_slope_under_the_boots() -> None:
    x = np.arange(-5.0, 10.0)
    profile = Profile(x, -0.75 * np.minimum(x, 4.0))  # level from 4 m on
    setup = stub(scenario=stub(slope=profile), place=np.array([2.0, 7.0, -1.1]), attitude=np.eye(3))
    setup.slope_normal = lambda x, y: Setup.slope_normal(setup, x, y)
    setup._slope_at_boots = lambda: Setup._slope_at_boots(setup)
    assert cast("Any", Setup.height).fget(setup) == pytest.approx(0.4)
    assert cast("Any", Setup.tilt).fget(setup)[0] == pytest.approx(math.atan(0.75))
    setup.attitude = np.array([[0.8, 0.0, 0.6], [0.0, 1.0, 0.0], [-0.6, 0.0, 0.8]])
    assert cast("Any", Setup.tilt).fget(setup)[0] == pytest.approx(0.0, abs=1e-7)
    setup.attitude = -setup.attitude
    assert cast("Any", Setup.tilt).fget(setup)[0] == pytest.approx(math.pi)
    setup.scenario.slope, setup.attitude = Plane(0.5), np.eye(3)
    assert (cast("Any", Setup.height).fget(setup), cast("Any", Setup.tilt).fget(setup)[0]) == (-1.1, 0.0)


def under_way(t: float, *, driven: bool) -> Any:
    """A sledge that goes on a helix and rolls, with boots that move against it."""
    turn = Rotation.from_rotvec([0.3 * t, 0.0, 0.0]) * Rotation.from_rotvec([0.0, 0.0, 0.5 * t])
    rotation, along = turn.as_matrix(), np.array([3.0 * t, 2.0 * np.sin(t), -t])
    rates = np.array([3.0, 2.0 * np.cos(t), -1.0])
    spin = np.array([0.3, 0.0, 0.0]) + 0.5 * Rotation.from_rotvec([0.3 * t, 0.0, 0.0]).as_matrix()[:, 2]
    boots = np.zeros((2, 6, 3))
    boots[:, 0] = [[0.1 * t, 0.3, 0.2 * t * t], [0.0, -0.2 - 0.4 * t, 0.0]]
    boots[:, 4] = [[0.1, 0.0, 0.4 * t], [0.0, -0.4, 0.0]]
    dynamics = stub(
        position=along, rotation=rotation, boots=boots,
        velocity=np.concatenate([rotation.T @ rates, rotation.T @ spin]),
    )  # fmt: skip
    drive = stub(held=False) if driven else None
    return Setup(stub(), dynamics, stub(), np.zeros(3), {}, 0.0, drive)


@pytest.mark.parametrize("driven", [False, True])
def test_the_velocity_of_the_boots_is_the_rate_of_their_place(driven: bool) -> None:
    """By central differences; of boots that are on the sledge it is the sledge's."""
    now, before, after = (under_way(1.3 + step, driven=driven) for step in (0.0, -1e-5, 1e-5))
    rate = (after.place - before.place) / 2e-5
    assert now.velocity == pytest.approx(rate, abs=1e-8)
    assert now.speed == pytest.approx(float(np.linalg.norm(rate)), abs=1e-8)
    assert (now.place == pytest.approx(now.dynamics.position)) is not driven
    assert np.array_equal(now.attitude, now.dynamics.rotation)


# Gates


def booted(run: Run) -> Run:
    """Boots that stand wider and turned out by 0.3 rad, a tenth of a metre before the run's middle."""
    n = len(run.time)
    aside = np.array([[0.1, 0.5, 0.0], [0.1, -0.5, 0.0]])
    axes = np.stack([axes_of(0.0, 0.0, 0.3), axes_of(0.0, 0.0, -0.3)])
    none = np.zeros((n, 2, 3))
    boots = BootHistory(
        place=run.place[:, None] + aside, axes=np.broadcast_to(axes, (n, 2, 3, 3)), own_force=none, own_moment=none,
        centre_of_mass=run.place,
    )  # fmt: skip
    return replace(run, boots=boots)


def test_feet_and_tips_are_where_the_sledge_or_the_boots_have_them() -> None:
    run = straight_run(PLAIN)
    quarter = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    tip, half = float(run.scenario.ski.station[0]), run.scenario.sledge.stance_width / 2.0
    turned = racer_parts(replace(run, attitude=np.broadcast_to(quarter, (len(run.time), 3, 3))))
    expected = {
        "left foot": (-half, 0.0), "right foot": (half, 0.0), "left tip": (-half, tip), "right tip": (half, tip),
    }  # fmt: skip
    assert turned.keys() == expected.keys()
    for name, aside in expected.items():
        assert turned[name].place == pytest.approx(run.place[:, :2] + np.array(aside)), name
    ahead, out = tip * math.cos(0.3), tip * math.sin(0.3)
    expected = {
        "left foot": (0.1, 0.5), "right foot": (0.1, -0.5),
        "left tip": (0.1 + ahead, 0.5 + out), "right tip": (0.1 + ahead, -0.5 - out),
    }  # fmt: skip
    moved = racer_parts(booted(run))
    for name, aside in expected.items():
        assert moved[name].place == pytest.approx(run.place[:, :2] + np.array(aside)), name


def test_a_course_is_over_behind_its_last_gate_whatever_the_order() -> None:
    course = Course(gates=tuple(Gate(name=str(x), turning=(x, -1.0), side="left") for x in (4.0, 8.0)))
    far, near, short = (np.array([x, 5.0, 0.0]) for x in (9.01, 8.99, 3.0))
    ahead = GatesAhead(course)
    assert [ahead.is_over(place, 1.0) for place in (short, near, far)] == [False, False, True]
    assert GatesAhead(course).is_over(far, 1.0)
    assert not GatesAhead(None).is_over(far, 1.0)


def test_one_moment_has_no_gates() -> None:
    course = Course(gates=tuple(Gate(name=str(x), turning=(x, -1.0), side="left") for x in (4.0, 8.0)))
    run = straight_run(PLAIN.with_(course=course))
    assert run_gates(straight_run(PLAIN)) is None
    assert run_gates(replace(run, time=run.time[:1])) is None
    result = run_gates(run)
    assert result is not None
    assert [each.outcome for each in result.passages] == ["passed"] * 2
    told = summary_dict(run)
    assert (told["gates_passed"], told["gates_missed"], len(told["gate_times_s"])) == (2, [], 2)
    none = summary_dict(straight_run(PLAIN))
    assert (none["gates_passed"], none["gates_missed"], none["gate_times_s"]) == (None, [], [])


# Energies and repetitions


def test_what_boots_took_is_exchanged_and_what_they_gave_is_not() -> None:
    run = straight_run(PLAIN)
    plain, n = run.energy_exchanged, len(run.time)
    given = {"boots": np.linspace(0.0, -30.0, n), "push": np.linspace(0.0, 20.0, n)}
    pushed = replace(run, energies=run.energies | given)
    assert pushed.energy_exchanged == pytest.approx(plain + 30.0)
    assert pushed.energy_residual == pytest.approx(10.0)
    assert pushed.has_residual_above(9.9 / (plain + 30.0))
    assert not pushed.has_residual_above(10.1 / (plain + 30.0))
    assert (energies_dict(pushed)["given_boots_J"], energies_dict(pushed)["given_push_J"]) == (-30.0, 20.0)


def test_the_axes_of_a_track_are_those_of_its_slope() -> None:
    run = straight_run(PLAIN)
    x = np.linspace(-50.0, 50.0, 21)
    others = (Profile(x, -0.2 * x), level_grid())
    tracks = [replace(run, scenario=PLAIN.with_(slope=slope)).track for slope in (PLAIN.slope, *others)]
    assert [each.frame.partition(",")[0] for each in tracks] == [
        "x down the fall line", "x horizontal distance down the fall line", "x horizontal",
    ]  # fmt: skip
    assert [each.frame.rpartition("left, ")[2] for each in tracks] == [
        "z out of the snow, in m",
        *["z height, in m"] * 2,
    ]


def test_of_more_and_less_of_an_input_what_moves_the_end_farther_counts() -> None:
    """A repetition without an end moves it farthest of all."""
    run = straight_run(PLAIN)

    def other(scenario: Any) -> Run:
        found = straight_run(scenario)
        more = scenario.start.speed > 5.0 + 1e-9, scenario.sledge.edge_angle > PLAIN.sledge.edge_angle + 1e-9
        if any(more):
            found.place[-1] += (math.nan if more[1] else 0.0, 3.0, 0.0)
        return found

    found = {each.key: each for each in verify(run, other)}
    speed, edge = found["start.speed_m_per_s"], found["sledge.edge_angle_deg"]
    assert (speed.now, speed.end_moves) == pytest.approx((5.005, math.hypot(0.01, 3.0)))
    assert edge.now > edge.was
    assert edge.end_moves is None
    assert limit_sentences({"start.speed_m_per_s": 0.1, "solver.elements": 9.0}, 20.0) == ()
    (first, *_) = limit_sentences({"start.speed_m_per_s": 0.1001, "snow.H_V_N_per_mm3": 0.05}, 20.0)
    assert "0.1 m" in first and "start.speed_m_per_s" in first
