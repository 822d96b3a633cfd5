"""Boots that are held by a table, and the forces of the snow."""

import xml.etree.ElementTree as ET
from collections.abc import Sequence
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import skisnow
from skisnow import BootMoment, BootPose, Boots, Scenario, load_scenario, simulate
from skisnow._support.errors import ParameterError
from skisnow.replay import replay_of_run
from skisnow.scenario import Plane
from skisnow.scenario.boots import read_boots
from skisnow.simulation.run import Run
from skisnow.simulation.run_tables import boots_text, write_boots
from tests.coded import raises
from tests.present import present
from tests.replay.held import ski_edges


def turn(**changes: object) -> Scenario:
    return load_scenario("carved-46m", changes={name.replace("__", "."): value for name, value in changes.items()})


@pytest.fixture(scope="module")
def own() -> Run:
    return simulate(turn(run__duration_s=0.2, run__output_ms=1.0))


def test_boots_driven_back_give_the_forces_of_the_run(own: Run, tmp_path: Path) -> None:
    """Once the start is over within a tenth of the hundredth that is asked; the file is read and run as any."""
    file = tmp_path / "boots.csv"
    write_boots(own, file)
    driven = simulate(turn(run__duration_s=0.2, run__output_ms=1.0, boots__file=str(file)))
    assert driven.outcome == "finished"
    assert own.boots is not None
    assert driven.place == pytest.approx(own.place, abs=1e-9)
    size = np.linalg.norm(own.boots.own_force, axis=-1).mean()
    apart = np.linalg.norm(present(driven.boots).own_force - own.boots.own_force, axis=-1) / size
    assert apart[own.time > 0.1].max() < 0.01
    assert np.sqrt(np.mean(apart**2)) < 0.02
    assert present(driven.boots).force.mean(axis=0) == pytest.approx(own.boots.force.mean(axis=0), abs=0.01 * size)
    assert driven.energy_balance_error == pytest.approx(0.0, abs=1e-3)
    assert abs(driven.energies["boots"][-1]) > 1.0


def test_forces_are_the_sledge_s_acceleration(own: Run) -> None:
    """Both boots together move the sledge's own mass: F + m g = m a, by differences in time."""
    sledge = own.scenario.sledge
    centre = own.place + own.attitude @ [sledge.centre_of_mass[0], 0.0, sledge.centre_of_mass[1]]
    acceleration = np.gradient(np.gradient(centre, own.time, axis=0), own.time, axis=0)
    slope = own.scenario.slope.angle  # type: ignore[union-attr]
    gravity = 9.81 * np.array([np.sin(slope), 0.0, -np.cos(slope)])
    drag = 0.5 * own.scenario.air.density * own.scenario.air.drag_area * own.speed[:, None] * own.velocity
    found = present(own.boots).force.sum(axis=1) + sledge.mass * gravity - drag
    later = slice(150, -2)
    assert found[later] == pytest.approx(sledge.mass * acceleration[later], abs=0.01 * 80.0 * 9.81)


def test_a_function_moves_the_boots_and_the_lean_follows_the_legs() -> None:
    """The left boot is drawn up by 5 cm within 0.5 s: the sledge leans left by about 5 cm over its stance of 50."""

    def retract(moment: BootMoment) -> Sequence[BootPose]:
        share = min(moment.until / 0.5, 1.0)
        rate = 0.1 if 0.0 < moment.until < 0.5 else 0.0
        left = BootPose.of([0.0, 0.25, 0.05 * share], 0.0)
        moving = BootPose(left.place, left.axes, np.array([0.0, 0.0, rate]), np.zeros(3))
        return [moving, BootPose.of([0.0, -0.25, 0.0], 0.0)]

    flat = turn(run__duration_s=0.7, sledge__edge_angle_deg=0.0, start__heading_deg=0.0)
    run = simulate(flat, boots=retract)
    assert run.outcome == "finished"
    assert "retract" in present(run.boots_by)
    lean = np.arcsin(run.attitude[:, 2, 1])
    assert np.degrees(lean[-1]) == pytest.approx(-np.degrees(0.05 / 0.5), abs=1.0)
    replay = replay_of_run(run)
    at_boot = int(np.argmin(np.abs(replay.skis.station)))
    for frame in (0, len(run.time) // 2, -1):  # the run's own edges under the boots
        edges = ski_edges(replay, frame)[:, at_boot]
        places = np.linspace(edges[:, 0], edges[:, 1], 99, axis=1)  # nearer the middle where a ski is nearly level
        apart = np.linalg.norm(places - run.skis.track[frame][:, None], axis=-1).min(axis=1)
        assert apart.max() < abs(replay.skis.station[at_boot]) + 1e-3
    # the sledge leans and both skis lie on the snow; skis that stayed on the sledge would be 5 cm apart in height
    assert np.ptp(ski_edges(replay, -1)[:, at_boot, :, 2].mean(axis=1)) < 0.002
    with pytest.raises(ParameterError, match="must give 2 BootPose"):
        simulate(flat, boots=lambda _: [])


def test_turning_the_boots_left_is_the_mirror_of_turning_them_right(tmp_path: Path) -> None:
    """Edge angles from a table over the distance run; the columns that are not there are the sledge's."""
    ends = []
    for sense in (1.0, -1.0):
        file = tmp_path / f"table{sense}.csv"
        names = "distance_m,left_edge_angle_deg,right_edge_angle_deg"
        rows = [f"{d},{sense * angle},{sense * angle}" for d, angle in ((0, 5), (1, 10), (2, 20), (5, 25))]
        file.write_text("\n".join([names, *rows]) + "\n", encoding="utf-8")
        run = simulate(
            turn(run__duration_s=0.5, start__heading_deg=0.0, sledge__edge_angle_deg=5.0, boots__file=str(file))
        )
        ends.append([*run.place[-1], np.degrees(present(run.boots).angles[-1, 0, 0])])
    assert ends[0][1] > 0.005
    assert ends[0][0] == pytest.approx(ends[1][0], abs=1e-5)
    assert ends[0][1] == pytest.approx(-ends[1][1], abs=1e-5)
    assert ends[0][3] == pytest.approx(-ends[1][3], abs=1e-3)
    assert 18.0 < ends[0][3] < 26.0


def test_what_is_written_is_read(own: Run, tmp_path: Path) -> None:
    for ending in (".csv", ".mot", ".sto"):
        file = tmp_path / f"boots{ending}"
        write_boots(own, file)
        read = read_boots(file)
        assert (read.frame, read.over) == ("slope", "time")
        assert np.array_equal(read.at, own.time)
        assert np.array_equal(read.place, present(own.boots).place)
        assert read.axes == pytest.approx(present(own.boots).axes, abs=1e-14)
    with raises(ParameterError, "wrong_ending"):
        write_boots(own, tmp_path / "boots.txt")


def test_opensim_has_y_up_and_z_to_the_right(own: Run) -> None:
    """Its head, and what bears the left boot points up there."""
    lines = boots_text(own, ".mot", name="turn").splitlines()
    assert lines[:2] == ["turn", "version=1"]
    assert lines[2:6] == [f"nRows={len(own.time)}", f"nColumns={len(lines[6].split())}", "inDegrees=yes", "endheader"]
    row = dict(zip(lines[6].split(), map(float, lines[7].split()), strict=True))
    assert row["left_ski_force_vy"] == row["left_force_z_N"] > 300.0
    assert row["left_ski_force_vz"] == -row["left_force_y_N"]
    assert row["left_ski_force_px"] == row["left_x_m"]


def test_external_loads_name_columns_of_the_motion_file(own: Run, tmp_path: Path) -> None:
    """Three columns behind each identifier; the right ski acts on the right foot."""
    write_boots(own, tmp_path / "turn.sto")
    text = (tmp_path / "turn_external_loads.xml").read_text(encoding="utf-8")
    assert {line.count("<") - line.count("</") for line in text.splitlines()} == {0, 1}  # each element on its own line
    loads = ET.fromstring(text)
    assert loads.findtext(".//datafile") == "turn.sto"
    columns = (tmp_path / "turn.sto").read_text(encoding="utf-8").splitlines()[6].split("\t")
    forces = loads.findall(".//ExternalForce")
    assert [force.findtext("applied_to_body") for force in forces] == ["calcn_l", "calcn_r"]
    for side, force in zip(("left", "right"), forces, strict=True):
        assert {force.findtext(f"{frame}_expressed_in_body") for frame in ("force", "point")} == {"ground"}
        for kind in ("force", "point", "torque"):
            name = str(force.findtext(f"{kind}_identifier"))
            assert name.startswith(side)
            assert {name + axis for axis in "xyz"} <= set(columns)


def test_rates_of_a_table_are_those_of_its_poses() -> None:
    """By differences, in the frame; outside the table the boots rest."""
    time = np.linspace(0.0, 1.0, 11)
    place = np.stack([np.stack([time**2, np.sin(time), 0.1 * time], axis=-1)] * 2, axis=1)
    axes = np.array([[BootPose.of(np.zeros(3), 0.5 * t, 0.2 * t * t, t).axes] * 2 for t in time])
    boots = Boots(time, place, axes)
    (p0, a0, v0, w0), (p1, a1, _, _) = boots.poses(0.33), boots.poses(0.33 + 1e-6)
    assert (p1 - p0) / 1e-6 == pytest.approx(v0, abs=1e-5)
    assert (a1[0] - a0[0]) / 1e-6 == pytest.approx(np.cross(w0[0], a0[0]), abs=1e-5)
    assert not boots.poses(2.0)[2].any()
    assert boots.poses(2.0)[0] == pytest.approx(place[-1], abs=1e-15)


def level(**changes: float) -> Scenario:
    """Seen from nothing but snow: no slope, no friction, no air."""
    flat = dict.fromkeys(("angle_deg", "heading_deg", "edge_angle_deg", "mu_0", "drag_area_m2"), 0.0)
    return turn().with_(**flat | changes)


def curvature_by_speed(place: np.ndarray, time: np.ndarray) -> float:
    """v²/(R g) of a path, the mean over what is given."""
    velocity = np.gradient(place, time, axis=0)
    v, a = velocity[5:-5, :2], np.gradient(velocity, time, axis=0)[5:-5, :2]
    return float(np.mean((v[:, 0] * a[:, 1] - v[:, 1] * a[:, 0]) / np.linalg.norm(v, axis=1)) / 9.81)


def test_lean_of_a_steady_turn() -> None:
    """A body as tall as a skier, one leg shorter: the line from the centre of pressure to the centre of mass leans by
    tan Ψ = v²/(R g) with the centre of mass's own v and R; with those of the skis it is a little lower."""
    stance, height, lean = 0.44, 0.9, np.radians(8.0)

    def legs(_: BootMoment) -> Sequence[BootPose]:
        places = ([0.0, side * stance, side * stance * np.tan(lean)] for side in (0.5, -0.5))
        return [BootPose.of(place, np.radians(12.0) - lean) for place in places]

    tall = level(centre_of_mass_height_m=height, stance_width_m=stance, speed_m_per_s=5.5, duration_s=3.0)
    run = simulate(tall, boots=legs)
    assert run.outcome == "finished"
    assert run.boots is not None
    later = run.time > 1.5
    centre = (run.place + height * run.attitude[:, :, 2])[later]
    force, arm = run.boots.force[later], run.boots.place[later] - centre[:, None]
    moment, total = (np.cross(arm, force) + run.boots.moment[later]).sum(axis=1), force.sum(axis=1)
    pressure = np.stack([-centre[:, 2] * total[:, 0] - moment[:, 1], moment[:, 0] - centre[:, 2] * total[:, 1]], axis=1)
    ahead = np.gradient(centre, run.time[later], axis=0)[:, :2]
    ahead /= np.linalg.norm(ahead, axis=1)[:, None]
    aside = (pressure[:, 0] * ahead[:, 1] - pressure[:, 1] * ahead[:, 0]) / total[:, 2]  # of the centre of mass, left
    tangent = float(np.mean(aside / centre[:, 2]))
    assert tangent > 0.15
    assert tangent == pytest.approx(curvature_by_speed(centre, run.time[later]), rel=0.01)
    of_skis = curvature_by_speed(run.place[later], run.time[later])
    assert 0.002 < 1.0 - tangent / of_skis < 0.02


def test_a_control_may_push() -> None:
    """50 N ahead for 0.2 s at the centre of mass: the momentum, and the energy that stands as given."""

    class Pushed:
        def __call__(self, _: BootMoment) -> Sequence[BootPose]:
            return [BootPose.of([0.0, side, 0.0], 0.0) for side in (0.25, -0.25)]

        def push(self, moment: BootMoment) -> tuple[Sequence[float], Sequence[float]]:
            return ([50.0 if 0.1 <= moment.time < 0.2999 else 0.0, 0.0, 0.0], [0.0, 0.0, 0.12])

    flat = level(duration_s=0.4)
    run, alone = simulate(flat, boots=Pushed()), simulate(flat)
    mass = 80.0 + 2.0 * flat.ski.mass
    assert run.speed[-1] - alone.speed[-1] == pytest.approx(50.0 * 0.2 / mass, rel=0.01)
    gained = 0.5 * mass * (run.speed[-1] ** 2 - alone.speed[-1] ** 2)
    assert run.energies["push"][-1] == pytest.approx(gained, rel=0.02)
    assert run.energy_balance_error == pytest.approx(0.0, abs=1e-4)


@pytest.mark.parametrize("short_by", [2e-11, 9.9e-10, -9.9e-10])
def test_a_control_that_is_due_within_rounding_of_an_output_ends(short_by: float) -> None:
    """Rows a millisecond apart differ by rounding; 1e-9 s is not a step, so such an output is reached without one."""
    looks = []

    def look(at: float, _: float) -> None:
        looks.append(at)
        assert len(looks) < 100

    class Still:
        period = 0.01 - short_by

        def __call__(self, _: BootMoment) -> list[BootPose]:
            return [BootPose.of([0.0, 0.25, 0.0], 0.0), BootPose.of([0.0, -0.25, 0.0], 0.0)]

    flat = turn(run__duration_s=0.05, sledge__edge_angle_deg=0.0, start__heading_deg=0.0)
    run = simulate(flat, boots=Still(), progress=look)
    assert run.outcome == "finished"
    assert run.time == pytest.approx(0.01 * np.arange(6.0), abs=5e-9)


TURN = "carved-46m"
"""Edge angle 30°."""
SETTLED = slice(30, -5)
"""Moments after the start and before the end, where differences over time are accurate."""


@cache
def simulated(**changes: object) -> Run:
    return skisnow.simulate(skisnow.load_scenario(TURN, changes={"run.duration_s": 0.8} | changes))


def force_by_inertia(run: Run) -> np.ndarray:
    """Force on the boot, and mass of the ski times its acceleration without gravity (N), (n, 2, 3)."""
    slope, ski, boots = run.scenario.slope, run.scenario.ski, run.boots
    assert isinstance(slope, Plane)
    gravity = run.scenario.gravity * np.array([np.sin(slope.angle), 0.0, -np.cos(slope.angle)])
    acceleration = np.gradient(np.gradient(present(boots).place, run.time, axis=0), run.time, axis=0)
    return np.asarray(present(boots).force + ski.mass * (acceleration - gravity))


@pytest.mark.parametrize(
    "changes",
    [{}, {"friction.mu_0": 0.1, "friction.acts_on": "base-normal"}, {"snow.S_f_N_per_mm2": 0.1}],
    ids=["left", "friction", "side-slip"],
)
def test_the_total_force_is_what_boot_and_inertia_take(changes: dict[str, object]) -> None:
    run = simulated(**changes)
    expected = force_by_inertia(run)[SETTLED]
    assert np.linalg.norm(run.skis.force[SETTLED] - expected, axis=2).max() < 4.0  # of 300 to 900 N
    assert run.skis.total_force[SETTLED] == pytest.approx(np.linalg.norm(expected, axis=2), abs=4.0)


def test_the_total_force_is_the_vector_of_normal_force_shear_and_friction() -> None:
    """Friction is 0.01 of the normal force. The edge line turns by 0.1 rad at most: cos 0.1 = 0.995."""
    skis = simulated().skis
    normal, side = (
        np.trapezoid(each, -skis.station, axis=2) for each in (skis.force_per_length, skis.shear_per_length)
    )
    expected = np.sqrt(normal**2 + side**2 + (0.01 * normal) ** 2)
    assert skis.normal_force == pytest.approx(normal, rel=1e-3)
    assert skis.total_force[SETTLED] == pytest.approx(expected[SETTLED], rel=5e-3)
    assert np.median(skis.total_force / skis.normal_force) > 1.05
    assert np.all(skis.force[SETTLED][..., 2] == pytest.approx(skis.normal_force[SETTLED]))


def test_friction_is_along_the_ski_against_its_motion() -> None:
    """Flat skis straight down the fall line: no shear, and friction of a tenth of the normal force."""
    changes = {"sledge.edge_angle_deg": 0.0, "start.heading_deg": 0.0, "friction.mu_0": 0.1}
    run = simulated(**changes)
    share = run.skis.force[SETTLED] / run.skis.normal_force[SETTLED][..., None]
    assert share == pytest.approx(np.broadcast_to([-0.1, 0.0, 1.0], share.shape), abs=3e-3)


def test_the_thrust_of_a_cut_is_part_of_the_normal_force() -> None:
    """Cutting lifts the ski: nearly all of its normal force is the thrust at the edge."""
    run = simulated(**{"shear.law": "machining", "solver.method": "fast", "run.duration_s": 2.2})
    late = slice(3 * len(run.time) // 4, -5)
    expected = force_by_inertia(run)[late]
    assert np.median(np.linalg.norm(run.skis.force[late] - expected, axis=2)) < 2.0  # of 600 N
    assert np.median(run.skis.normal_force[late, 1]) == pytest.approx(np.median(expected[:, 1, 2]), rel=0.01)
