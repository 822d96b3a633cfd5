"""Boots that move against the body: at rest as if they were fixed; in the air by momentum; forces by weight."""

from dataclasses import replace

import numpy as np
import numpy.typing as npt
import pytest

from skisnow._support.errors import ParameterError
from skisnow.contact import Runner, SnowContact
from skisnow.dynamics import Body, BootMotion, BootPose, Dynamics, Ended, StepControl
from skisnow.dynamics.motion import moment_parts
from skisnow.geometry.vectors import angles_of, axes_of
from skisnow.simulation.sledge_body import sledge_body
from tests.coded import raises

from .sledges import ahead, body_of, clamped_ski, fixed, given, gravity, placed, sledge, snow_of

FloatArray = npt.NDArray[np.float64]
SCENARIO = given()
SLEDGE = SCENARIO.sledge
SIDES = np.array([0.25, -0.25])


def stays(end: float = 1.0) -> list[BootMotion]:
    poses = [BootPose.of([0.0, side, 0.0], SLEDGE.edge_angle) for side in SIDES]
    return [BootMotion(0.0, end, pose, pose) for pose in poses]


def test_boots_that_stay_are_fixed_boots() -> None:
    """The same balance to the last digits; moving, both take a bent ski's momentum about another point: ω² r apart."""
    runs = []
    for moves in (False, True):
        dynamics = sledge(SCENARIO)
        if moves:
            dynamics.move_boots(stays())
        assert dynamics.find_equilibrium() < 1e-9
        runs.append((dynamics, dynamics.position, dynamics.part("beam_dofs")))
    assert runs[0][1] == pytest.approx(runs[1][1], abs=1e-13)
    assert runs[0][2] == pytest.approx(runs[1][2], abs=1e-12)
    for dynamics, *_ in runs:
        dynamics.begin(ahead(7.0))
        assert dynamics.advance(0.2) is Ended.REACHED
    assert runs[0][0].position == pytest.approx(runs[1][0].position, abs=2e-6)
    assert runs[0][0].boot_wrench == pytest.approx(runs[1][0].boot_wrench, abs=0.5)
    assert runs[1][0].part("work_given").tolist() == [0.0, 0.0]


def test_boots_bear_the_weight_of_what_stands_on_them() -> None:
    """At rest the skis give the sledge its own weight and no more; the moment is that of its centre of mass."""
    dynamics = sledge(SCENARIO)
    dynamics.find_equilibrium()
    dynamics.begin(np.zeros(6))
    wrench, boots = dynamics.boot_wrench, dynamics.boots
    force = np.einsum("kca,kc->ka", boots[:, 1:4], wrench[:, :3])
    moment = np.einsum("kca,kc->ka", boots[:, 1:4], wrench[:, 3:]) + np.cross(boots[:, 0], force)
    weight = SLEDGE.mass * dynamics.rotation.T @ gravity(SCENARIO)
    centre = np.array([SLEDGE.centre_of_mass[0], 0.0, SLEDGE.centre_of_mass[1]])
    assert force.sum(axis=0)[2] == pytest.approx(-weight[2], rel=1e-9)
    assert moment.sum(axis=0)[:2] == pytest.approx(-np.cross(centre, weight)[:2], abs=1e-6)


def test_a_restored_motion_goes_on_with_its_bits_and_a_row_has_every_part() -> None:
    dynamics = sledge(SCENARIO)
    dynamics.find_equilibrium()
    dynamics.begin(ahead(7.0))
    assert dynamics.advance(0.05) is Ended.REACHED
    kept = dynamics.state()
    rows = []
    for _ in range(2):
        assert dynamics.advance(0.1) is Ended.REACHED
        rows.append(dynamics.moment)
        dynamics.restore(kept)
        assert dynamics.time == 0.05
    assert np.array_equal(rows[0], rows[1])
    assert dynamics.advance(0.1) is Ended.REACHED
    parts = moment_parts(dynamics.moment, dynamics.body.skis)
    for name in ("time", "position", "rotation", "velocity", "boots", "boot_wrench"):
        assert np.array_equal(parts[name], getattr(dynamics, name)), name
    assert type(dynamics.time) is float
    assert dynamics.touches is True
    assert len(dynamics.counts) == 5
    both = moment_parts(np.stack([rows[0], rows[1]]), dynamics.body.skis)
    nodes, unknowns = len(dynamics.body.skis[0].unknown), len(dynamics.body.skis[0].mass)
    assert {name: part.shape for name, part in both.items()} == {
        "time": (2,), "position": (2, 3), "rotation": (2, 3, 3), "velocity": (2, 6), "energies": (2, 3),
        "snow_energies": (2, 4), "snow_losses": (2, 5), "work": (2, 6), "work_given": (2, 2), "pushes": (2, 2, 3),
        "along": (2, 2, 3, nodes), "beam_dofs": (2, 2, unknowns), "boots": (2, 2, 6, 3), "boot_wrench": (2, 2, 6),
    }  # fmt: skip
    assert sum(part[0].size for part in both.values()) == len(rows[0])


def weightless(body: Body) -> Body:
    return replace(body, gravity=np.zeros(3), drag=0.0)


def centre_of_mass(dynamics: Dynamics) -> FloatArray:
    """Of sledge and unbent skis, in space, from their parts."""
    places = [np.array([SLEDGE.centre_of_mass[0], 0.0, SLEDGE.centre_of_mass[1]])]
    masses = [SLEDGE.mass]
    for ski, (boot, *axes, _, _) in zip(dynamics.body.skis, dynamics.boots, strict=True):
        assert ski.inertia is not None
        own = np.array([ski.inertia[5, 1], ski.inertia[3, 2], ski.inertia[4, 0]]) / ski.inertia[0, 0]
        places.append(boot + own @ np.array(axes))
        masses.append(ski.inertia[0, 0])
    return dynamics.position + dynamics.rotation @ np.average(places, axis=0, weights=masses)


def test_in_the_air_the_centre_of_mass_stays_and_the_work_of_the_boots_is_there() -> None:
    """Both skis are moved by 0.1 m within 0.1 s and turned: momentum 0, angular momentum 0; then all of it rests."""
    body = weightless(body_of(SCENARIO, 8))
    dynamics = sledge(SCENARIO, fixed(5e-4), body=body, height=1.0, elements=8)
    first = [BootPose.of([0.0, side, 0.0], SLEDGE.edge_angle) for side in SIDES]
    last = [BootPose.of([0.0, side, 0.1], SLEDGE.edge_angle, 0.2, 0.0) for side in SIDES]
    start = dynamics.position
    dynamics.move_boots(stays())
    before = centre_of_mass(dynamics)
    dynamics.move_boots([BootMotion(0.0, 0.1, *pair) for pair in zip(first, last, strict=True)])
    dynamics.begin(np.zeros(6))
    assert dynamics.advance(0.05) is Ended.REACHED
    kinetic, _, elastic = dynamics.part("energies")
    assert kinetic > 1.0
    assert dynamics.part("work_given")[0] == pytest.approx(kinetic + elastic + dynamics.part("work")[4], rel=2e-3)
    assert dynamics.advance(0.1) is Ended.REACHED
    assert centre_of_mass(dynamics) == pytest.approx(before, abs=2e-4)  # a bent ski's own is not counted
    assert dynamics.position[2] - start[2] < -0.004


def test_angles_of_a_boot() -> None:
    """Left edge down, tip up, to the left."""
    ahead_, left, off = axes_of(0.3, 0.2, 0.1)
    assert left[2] < 0.0 < ahead_[2]
    assert ahead_[1] > 0.0
    assert np.cross(ahead_, left) == pytest.approx(off)
    assert angles_of(axes_of(0.3, 0.2, 0.1)) == pytest.approx([0.3, 0.2, 0.1])


def test_a_boot_meets_both_ends_of_its_motion_with_their_rates() -> None:
    """The body held: what the core makes of the cubics, by differences in time."""
    first = BootPose(np.array([0.1, 0.2, 1.0]), axes_of(0.1, 0.2, 0.3), np.array([1.0, 2.0, 3.0]),
                     np.array([0.5, -1.0, 2.0]))  # fmt: skip
    last = BootPose(np.array([0.2, 0.3, 1.2]), axes_of(0.3, 0.1, 0.5), np.array([0.0, 1.0, -1.0]),
                    np.array([-2.0, 0.3, 0.1]))  # fmt: skip
    dynamics = sledge(SCENARIO, fixed(1e-3), body=weightless(body_of(SCENARIO, 8)), height=1.0, elements=8)
    dynamics.hold_body()
    dynamics.move_boots([BootMotion(0.0, 0.1, first, last)] * 2)
    dynamics.begin(np.zeros(6))
    for until, pose in ((0.0, first), (0.1, last)):
        dynamics.advance(until)
        boot = dynamics.boots[0]
        for place, known in enumerate((pose.place, *pose.axes, pose.velocity, pose.turning)):
            assert boot[place] == pytest.approx(known, abs=1e-12)
        assert dynamics.velocity == pytest.approx(0.0, abs=0.0)
    assert dynamics.advance(0.1 + 1e-5) is Ended.REACHED
    after = dynamics.boots[0]
    assert after[1:4] - last.axes == pytest.approx(np.cross(last.turning, last.axes) * 1e-5, abs=1e-8)


@pytest.mark.parametrize(("asides", "clamped_m"), [((0.0,), 0.3), ((0.0,), 0.75), ((0.3, 0.0, -0.3), 0.3)])
def test_any_number_of_skis(asides: tuple[float, ...], clamped_m: float) -> None:
    """On one ski, upright by nothing but its flat base, on one that two stiff bindings hold, and on three."""
    scenario = given(
        sledge__edge_angle_deg=0.0, sledge__centre_of_mass_height_m=0.05, start__heading_deg=0.0,
        ski__clamp_length_m=clamped_m,
    )  # fmt: skip
    ski = clamped_ski(scenario, 40)
    body = sledge_body(
        scenario.sledge, ski, damping_ratio=0.02, gravity=gravity(scenario), drag=0.0, drag_height=0.0, asides=asides
    )
    runner = Runner.of(scenario.ski, nodes=ski.node)
    contact = SnowContact(snow_of(scenario), [runner] * len(asides))
    dynamics = Dynamics(body, contact, *placed(scenario, height=0.0), StepControl())
    dynamics.move_boots([BootMotion(0.0, 1.0, *[BootPose.of([0.0, side, 0.0], 0.0)] * 2) for side in asides])
    assert dynamics.find_equilibrium() < 1e-9
    dynamics.begin(ahead(5.0))
    assert dynamics.advance(0.1) is Ended.REACHED
    assert dynamics.boot_wrench.shape == (len(asides), 6)
    assert dynamics.boot_wrench[:, 2].sum() == pytest.approx(-scenario.sledge.mass * body.gravity[2], rel=0.05)


def test_a_push_gives_momentum() -> None:
    """F t / m along the push at the centre of mass in the air, and its work is the kinetic energy."""
    body = weightless(body_of(SCENARIO, 8))
    dynamics = sledge(SCENARIO, fixed(1e-3), body=body, height=1.0, elements=8)
    dynamics.push([50.0, 0.0, 0.0], body.first_moment / body.mass)
    dynamics.begin(np.zeros(6))
    dynamics.advance(0.2)
    velocity = dynamics.rotation @ dynamics.velocity[:3]
    assert velocity[0] == pytest.approx(50.0 * 0.2 / body.mass, rel=3e-3)
    assert dynamics.part("work_given")[1] == pytest.approx(dynamics.part("energies")[0], rel=5e-3)


def test_what_cannot_move_is_refused() -> None:
    body = body_of(SCENARIO, 8)
    plain = replace(body, skis=tuple(replace(ski, inertia=None) for ski in body.skis))
    dynamics = sledge(SCENARIO, body=plain, elements=8)
    assert np.isnan(dynamics.boot_wrench).all()
    with raises(ParameterError, "no_data"):
        dynamics.move_boots(stays())
    with raises(ParameterError, "wrong_shape", n_motions=1, n_skis=2):
        sledge(SCENARIO, body=body, elements=8).move_boots(stays()[:1])
    pose = stays()[0].first
    with raises(ParameterError, "out_of_range"):
        BootMotion(1.0, 1.0, pose, pose)
    with raises(ParameterError, "out_of_range", degrees=90.0):
        BootMotion(0.0, 1.0, pose, BootPose.of(pose.place, SLEDGE.edge_angle, 0.0, np.pi / 2.0))


@pytest.mark.parametrize("degrees", [0.0, 57.2, 57.4, 120.0, 180.0])
def test_a_boot_turns_by_a_radian_at_most(degrees: float) -> None:
    """From poses whose axes are rounded: their product may exceed 1 or fall below -1."""
    for edge_angle in np.linspace(-1.0, 1.0, 9):
        first = BootPose.of(np.zeros(3), edge_angle, 0.3 * edge_angle, 0.1)
        turn = axes_of(0.0, 0.0, np.radians(degrees))
        last = BootPose(first.place, first.axes @ turn)
        if degrees < 57.3:
            assert BootMotion(0.5, 2.0, first, last).numbers[:2].tolist() == [0.5, 2.0]
            continue
        with raises(ParameterError, "out_of_range", start=0.5, end=2.0, limit=np.degrees(1.0)) as caught:
            BootMotion(0.5, 2.0, first, last)
        assert caught.value.fields["degrees"] == pytest.approx(degrees, abs=1e-4)


def test_axes_of_a_boot_are_right_handed_and_orthonormal() -> None:
    """Off by a millionth in one condition of six at a time; by a ten-thousandth of that they are accepted."""
    ahead_, left, off = axes_of(0.4, 0.3, 0.2)

    def axes(by: float) -> list[FloatArray]:
        longer, broader, skew = (1.0 + by) * ahead_, (1.0 + by) * left, left + by * ahead_
        pairs = [(longer, left), (ahead_, broader), (ahead_, skew)]
        thirds = [off + by * axis for axis in np.eye(3)]
        return [np.array([a, b, np.cross(a, b)]) for a, b in pairs] + [np.array([ahead_, left, c]) for c in thirds]

    for good, bad, size in zip(axes(1e-10), axes(1e-6), (2e-6, 2e-6, 1e-6, 1e-6, 1e-6, 1e-6), strict=True):
        assert BootPose(np.zeros(3), good).axes.tolist() == good.tolist()
        with raises(ParameterError, "not_a_rotation") as caught:
            BootPose(np.zeros(3), bad)
        assert caught.value.fields["off"] == pytest.approx(size, rel=1e-5)
    with raises(ParameterError, "not_a_rotation", off=2.0):
        BootPose(np.zeros(3), np.diag([1.0, 1.0, -1.0]))


@pytest.mark.parametrize("name", ["place", "axes", "velocity", "turning"])
def test_numbers_of_a_boot(name: str) -> None:
    pose = BootPose(*map(np.array, ([1.0, 2.0, 3.0], np.eye(3), [3.0, 4.0, 0.0], [0.0, 0.0, 0.5])))
    shape = "(3, 3)" if name == "axes" else "(3,)"
    with raises(ParameterError, "wrong_shape", name=f"BootPose: {name}", shape="(2,)", needed=shape):
        replace(pose, **{name: np.zeros(2)})
    assert pose.numbers.tolist() == [1, 2, 3, 1, 0, 0, 0, 1, 0, 0, 0, 1, 3, 4, 0, 0, 0, 0.5]
    unchecked = BootPose.unchecked(pose.place, pose.axes, pose.velocity, pose.turning)
    assert unchecked.numbers.tolist() == pose.numbers.tolist()
    at_rest = BootPose.of([1.0, 2.0, 3.0], 0.0)
    assert at_rest.numbers.tolist() == [1, 2, 3, 1, 0, 0, 0, 1, 0, 0, 0, 1, *[0] * 6]


def test_a_boot_is_shown_with_its_angles_and_speeds() -> None:
    """In degrees."""
    axes = axes_of(np.radians(30.0), np.radians(20.0), np.radians(10.0))
    shown = repr(BootPose(np.array([1.0, 2.0, 3.0]), axes, np.array([3.0, 4.0, 0.0]), np.array([0.0, 0.0, 0.5])))
    parts = ("edge 30°", "pitch 20°", "heading 10°", "5 m/s", "0.5 rad/s", "(1, 2, 3) m")
    assert [part for part in parts if part not in shown] == []
