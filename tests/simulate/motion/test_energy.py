"""Powers of the forces, and the energy in the snow, against differences of energies between neighbouring states."""

from __future__ import annotations

import copy
from collections.abc import Mapping

import numpy as np
import numpy.typing as npt
import pytest

from skisnow.simulate.judge.run_record import Record
from skisnow.simulate.judge.run_setup import Setup, set_up
from skisnow.simulate.motion.advance import observe
from skisnow.simulate.motion.equations import add_forces, drag_power, move
from skisnow.simulate.motion.forces import HELD, NORMAL, RELEASED, SHEAR, SIDEWAYS, SPRINGY, feel, new_forces
from skisnow.simulate.motion.history import _accounts
from skisnow.simulate.motion.lines import ANCHOR, DEPTH, EDGE, TOUCHED
from skisnow.simulate.motion.model import PADDING, new_state
from skisnow.simulate.motion.path import energy_in_snow, press
from skisnow.simulate.motion.system import new_vector
from skisnow.simulate.scenario import read_scenario

FloatArray = npt.NDArray[np.float64]
STILL: Mapping[str, object] = {
    "solver.fixed": True,
    "solver.elements": 12,
    "solver.line_spacing_mm": 24.0,
    "slope.angle_deg": 5.0,
}
UNIT = np.eye(6)
MOTIONS = {
    "down": -UNIT[2],
    "up": UNIT[2],
    "ahead": UNIT[0],
    "back": -UNIT[0],
    "left": UNIT[1],
    "right": -UNIT[1],
    "roll": UNIT[3],
    "pitch": UNIT[4],
    "yaw": UNIT[5],
    "all": np.array([3.0, -0.02, -0.05, 0.1, 0.1, -0.1]),
}


ELASTIC: Mapping[str, Mapping[str, object]] = {
    "edged": {},
    "soft": {"snow.H_V_N_per_mm3": 5e-4, "sledge.edge_angle_deg": 12.0},
    "flat": {"snow.H_V_N_per_mm3": 5e-4, "sledge.edge_angle_deg": 0.0},
}


@pytest.fixture(scope="module", params=ELASTIC)
def elastic(request: pytest.FixtureRequest) -> Setup:
    changes = {**STILL, "snow.penetration": "elastic", **ELASTIC[request.param]}
    setup = set_up(read_scenario("carved-46m", changes=changes))
    Record(setup).advance(np.array([0.02]))
    return setup


@pytest.fixture(scope="module")
def fresh() -> Setup:
    """Just set down on virgin snow with k_u = 10 H_V."""
    return set_up(read_scenario("carved-46m", changes={**STILL, "solver.cell_mm": 0.05}))


def displaced(setup: Setup, velocity: FloatArray, rate: FloatArray, time: float) -> tuple[float, FloatArray]:
    """Energy in the snow (J) once it has given way, and powers felt before, after moving for a time (s)."""
    lines, archive = copy.deepcopy(setup.lines), copy.deepcopy(setup.archive)
    state = new_state(len(setup.model.mass))
    move(setup.memory.state, velocity, rate, time, state)
    state.velocity[:], state.bend_rate[:] = velocity, rate
    out = new_forces(len(setup.model.mass), len(lines.flag) // 2)
    feel(setup.model, setup.snow, lines, state, False, True, out)
    press(setup.snow, lines, archive)
    return float(out.power[SPRINGY]) + energy_in_snow(setup.snow, lines, archive), out.power.copy()


def bending(setup: Setup, seed: int) -> FloatArray:
    """Some velocities of the skis' unknowns."""
    rng, size = np.random.default_rng(seed), len(setup.model.mass)
    rate = np.zeros((2, size + 2 * PADDING))
    rate[:, PADDING:-PADDING] = rng.normal(size=(2, size)) * np.tile([0.02, 0.1, 0.3], size // 3)
    return rate


def given(power: FloatArray) -> float:
    """Power that goes into the snow: against the normal force, sideways, less what is let go at the ends."""
    return float(-power[NORMAL] + power[SIDEWAYS] - power[RELEASED])


@pytest.mark.parametrize("name", [*MOTIONS, "bending"])
def test_elastic_snow_keeps_what_it_is_given(elastic: Setup, name: str) -> None:
    """Two-sided differences over ± 0.1 µm (m/s × 1e-7 s): they miss by the curvature alone."""
    none = np.zeros_like(elastic.memory.state.bend)
    velocity, rate = (np.zeros(6), bending(elastic, 1)) if name == "bending" else (MOTIONS[name], none)
    after, before = displaced(elastic, velocity, rate, 1e-7)[0], displaced(elastic, velocity, rate, -1e-7)[0]
    _, power = displaced(elastic, velocity, rate, 0.0)
    # along skis that press with 840 N, sections of tables and of the base across cost up to 0.05 N
    assert given(power) == pytest.approx((after - before) / 2e-7, rel=3e-3, abs=0.05)


@pytest.mark.parametrize("name", ["down", "ahead", "back", "roll", "pitch", "all"])
def test_a_tail_in_the_snow_takes_and_leaves_ground(name: str) -> None:
    """Sitting back by 0.02 rad: a fifth of the power along the skis is the ground that the tails leave or take."""
    changes = {**STILL, "snow.penetration": "elastic", "snow.H_V_N_per_mm3": 0.01, "sledge.edge_angle_deg": 20.0}
    setup = set_up(read_scenario("carved-46m", changes=changes))
    c, s = np.cos(0.02), np.sin(0.02)
    turn = setup.memory.state.turn
    turn[:] = turn @ np.array([[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]])
    none, velocity = np.zeros_like(setup.memory.state.bend), MOTIONS[name]
    after, before = displaced(setup, velocity, none, 1e-7)[0], displaced(setup, velocity, none, -1e-7)[0]
    _, power = displaced(setup, velocity, none, 0.0)
    if name in ("ahead", "back"):
        assert abs(power[RELEASED]) > 15.0
    # the share of a line under a tail goes linearly: half a line more or less
    assert given(power) == pytest.approx((after - before) / 2e-7, rel=0.01)


@pytest.mark.parametrize("name", ["down", "bending"])
def test_virgin_snow_takes_the_whole_work(fresh: Setup, name: str) -> None:
    """Pressed deeper than ever: springy and lost energy together are the work of the normal force."""
    none = np.zeros_like(fresh.memory.state.bend)
    velocity, rate = (MOTIONS["down"], none) if name == "down" else (0.3 * MOTIONS["down"], 0.2 * bending(fresh, 2))
    before, after = displaced(fresh, velocity, rate, 1e-6)[0], displaced(fresh, velocity, rate, 3e-6)[0]
    _, power = displaced(fresh, velocity, rate, 2e-6)
    # cells of 0.05 mm in a contact of 3 mm; where an edge reaches, a whole cell counts
    assert given(power) == pytest.approx((after - before) / 2e-6, rel=0.02)
    assert -power[NORMAL] > 100.0 * abs(power[SIDEWAYS] - power[RELEASED])


def test_unloading_gives_the_springy_part_back(fresh: Setup) -> None:
    none = np.zeros_like(fresh.memory.state.bend)
    before, after = (displaced(fresh, MOTIONS["up"], none, time)[0] for time in (1e-6, 3e-6))
    _, power = displaced(fresh, MOTIONS["up"], none, 2e-6)
    assert given(power) == pytest.approx((after - before) / 2e-6, rel=1e-3)
    # 1/10 of the springy energy's square root law: it falls from p²/2k_u per area as fast as p v
    assert given(power) < -100.0


@pytest.mark.parametrize("step", [5e-6, 5e-5, 2e-4])
@pytest.mark.parametrize(("way", "carried"), [(1.0, 0.1), (-1.0, 1.0)])
def test_edges_that_go_aside(way: float, carried: float, step: float) -> None:
    """By 1 mm at the same depth. Away from the base, to the left, they cut; k_u = 10 H_V.

    The ground that was cut is flat, so the pressure falls from H_V d at the edge to nothing where the base has risen
    by d H_V/k_u: a tenth of what it is on virgin snow, whatever the steps. Towards the base all ground is virgin.
    The snow gains what it is given, sideways alone.
    """
    setup = set_up(
        read_scenario("carved-46m", changes={**STILL, "sledge.edge_angle_deg": 60.0, "solver.cell_mm": 0.05})
    )
    out = new_forces(len(setup.model.mass), len(setup.lines.flag) // 2)
    state, none = setup.memory.state, np.zeros_like(setup.memory.state.bend)
    velocity = np.concatenate([state.turn.T @ [0.0, way, 0.0], np.zeros(3)])
    moved = new_state(len(setup.model.mass))
    moved.velocity[:] = velocity
    forces, powers, energies = [], [], []
    for number in range(round(1e-3 / step) + 1):
        move(state, velocity, none, number * step, moved)
        feel(setup.model, setup.snow, setup.lines, moved, False, True, out)
        press(setup.snow, setup.lines, setup.archive)
        forces.append(float(out.rigid @ np.append(state.turn[2], np.zeros(3))))
        powers.append(given(out.power))
        energies.append(float(out.power[SPRINGY]) + energy_in_snow(setup.snow, setup.lines, setup.archive))
    half = len(forces) // 2
    # the tenth of the contact that bears has three cells
    assert forces[half:] == pytest.approx(np.full(len(forces) - half, carried * forces[0]), rel=0.04)
    assert step * sum(powers[half + 1 :]) == pytest.approx(energies[-1] - energies[half], rel=0.02)


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_an_edge_that_holds_stores_what_it_is_given(way: float) -> None:
    """Moved across by less than its grip: the energy held grows by the work against the shear."""
    setup = set_up(read_scenario("carved-46m", changes=STILL))
    none, velocity = np.zeros_like(setup.memory.state.bend), np.array([0.0, way, 0.0, 0.0, 0.0, 0.0])
    held = [displaced(setup, velocity, none, time)[1][HELD] for time in (0.9e-4, 1.1e-4)]
    _, power = displaced(setup, velocity, none, 1e-4)
    # the depth of an edge that moves across grows or falls a little, and with it its strength
    assert -power[SHEAR] == pytest.approx((held[1] - held[0]) / 2e-5, rel=0.01)
    assert power[SHEAR] < -10.0
    assert power[HELD] == pytest.approx(0.5 * -power[SHEAR] * 1e-4, rel=0.01)


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_an_edge_that_yields_takes_its_hold_along(way: float) -> None:
    """Three times its grip across, and its hold is one grip behind; one grip back, and the shear has gone."""
    setup = copy.deepcopy(set_up(read_scenario("carved-46m", changes=STILL)))
    lines, holding, out = setup.lines, setup.snow.holding, new_forces(len(setup.model.mass), len(setup.lines.flag) // 2)
    left = setup.memory.state.turn[:, 1]
    for steps, behind in ((3.0, 1.0), (-1.0, 0.0), (-1.0, -1.0), (-5.0, -1.0)):
        setup.memory.state.place[:] += way * steps * holding * left
        feel(setup.model, setup.snow, lines, setup.memory.state, False, True, out)
        press(setup.snow, lines, setup.archive)
        deep = np.flatnonzero((lines.flag[:, TOUCHED] == 1) & (lines.value[:, DEPTH] > 5e-4))
        assert len(deep) > 10
        used = (lines.value[deep, ANCHOR] - lines.value[deep, EDGE]) / holding
        # lines lie along the skis as they were laid, 1 % aside of straight across at the most
        assert used == pytest.approx(np.full(len(deep), -way * behind), abs=0.02)


@pytest.mark.parametrize("lift", np.geomspace(1e-5, 2e-3, 12).tolist())
def test_a_ski_that_its_groove_hardly_bears(fresh: Setup, lift: float) -> None:
    """Lifted until next to nothing bears, then off: a force that is rounding gives next to nothing sideways."""
    setup, out = copy.deepcopy(fresh), new_forces(len(fresh.model.mass), len(fresh.lines.flag) // 2)
    state = setup.memory.state
    state.place[:] += lift * state.turn[:, 2]
    state.velocity[:] = 8.0, 5.0, 0.3, 1.0, 1.0, 2.0
    feel(setup.model, setup.snow, setup.lines, state, False, True, out)
    whole = float(np.abs(out.rigid[:3]).sum())
    # a force F on bases of 34° gives F tan 34° times the speed across, and where edges cover ground as much again
    assert abs(float(out.power[SIDEWAYS])) < 10.0 * (whole + 1.0) * 5.0
    assert np.isfinite(out.rigid).all()


def test_accounts_keep_their_sum() -> None:
    """And neither is below nothing, unless both together are."""
    for penetration, shear in (
        (3.0, 4.0),
        (-1.0, 5.0),
        (5.0, -1.0),
        (-1e-9, 0.0),
        (0.0, 0.0),
        (7.0, -6.0),
        (-2.0, 2.0),
    ):
        found = _accounts(penetration, shear)
        assert sum(found) == pytest.approx(penetration + shear, abs=1e-15)
        assert min(found) >= min(0.0, penetration + shear)
    assert _accounts(3.0, 4.0) == (3.0, 4.0)


def test_drag_takes_its_power() -> None:
    """At the centre of pressure, ½ ρ C_d A |v|³; and as the generalised force times the velocity."""
    setup = set_up(read_scenario("carved-46m", changes=STILL))
    state = setup.memory.state
    state.velocity[:] = 9.0, 2.0, -1.0, 0.5, -0.8, 0.3
    zero = new_forces(len(setup.model.mass), len(setup.lines.flag) // 2)
    powers = []
    for drag in (setup.world.drag, 0.0):
        out = new_vector(len(setup.model.mass))
        world = setup.world._replace(drag=drag)
        add_forces(setup.model, world, state, zero, 1.0, out)
        powers.append((drag_power(world, state.velocity), float(out.rigid @ state.velocity)))
    high = setup.world.drag_height
    wind = state.velocity[:3] + np.cross(state.velocity[3:], [0.0, 0.0, high])
    assert high == 0.12
    assert powers[0][0] == pytest.approx(0.5 * 1.2 * 0.42 * np.linalg.norm(wind) ** 3, rel=1e-12)
    assert powers[0][1] - powers[1][1] == pytest.approx(-powers[0][0], rel=1e-9)


def test_forces_of_motion_do_no_work() -> None:
    """- ω × p, - ω × L - v × p: no power, whatever the motion.

    Of the bend's own part, v × ω on the skis, and with the momentum b of bending - ω × b and v × b on the sledge,
    -b·(v × ω) is left: what the kinetic energy of a bent ski that turns would take up, and the constant mass matrix
    leaves out.
    """
    setup = set_up(read_scenario("carved-46m", changes=STILL))
    state, rng = setup.memory.state, np.random.default_rng(6)
    state.velocity[:] = rng.normal(size=6)
    state.bend_rate[:, PADDING:-PADDING] = bending(setup, 3)[:, PADDING:-PADDING]
    zero = new_forces(len(setup.model.mass), len(setup.lines.flag) // 2)
    out = new_vector(len(setup.model.mass))
    add_forces(setup.model, setup.world._replace(drag=0.0, gravity=np.zeros(3)), state, zero, 1.0, out)
    size = float(np.abs(out.rigid) @ np.abs(state.velocity))
    assert size > 10.0
    on_skis = float(np.sum(out.bend * state.bend_rate))
    assert on_skis != 0.0
    assert float(out.rigid @ state.velocity) == pytest.approx(-2.0 * on_skis, abs=1e-12 * size)


def test_work_is_summed_by_trapezoids(fresh: Setup) -> None:
    setup = copy.deepcopy(fresh)
    clock = setup.memory.clock
    before = clock.power.copy()
    clock.work[:], clock.time[2] = 0.0, 1e-3
    setup.memory.state.velocity[:3] = 8.0, 0.1, -0.1
    observe(setup.model, setup.snow, setup.world, setup.lines, setup.archive, setup.memory, False)
    assert clock.work == pytest.approx(0.5e-3 * (before + clock.power), rel=1e-12)
    assert np.all(clock.work[[1, 4, 5]] > 0.0)
