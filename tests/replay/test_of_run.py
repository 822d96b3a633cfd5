"""A replay has the run's own numbers, from the object and from run.nc alike."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.io import netcdf_file
from scipy.spatial.transform import Rotation

from skisnow import load_scenario, simulate
from skisnow._support.errors import ParameterError
from skisnow._support.units import DEGREE
from skisnow.replay import measured_track, replay_bytes, replay_of_file, replay_of_run
from skisnow.replay.from_run import facts_of
from skisnow.report.run.file import write_run_file
from skisnow.scenario import Profile, scenario_values
from skisnow.scenario.keys import in_sections
from skisnow.simulation.run import Run
from skisnow.simulation.run_summary import run_gates, summary_dict
from skisnow.ski import ski_named, write_ski
from skisnow.track.course import Course, Gate, read_course
from skisnow.track.track import Track
from tests.coded import raises
from tests.present import present

from ..report.runs import RADIUS, SPEED, STANCE, circle_run


def written(run: Run, folder: Path, **changes: object) -> Path:
    values = {**scenario_values(run.scenario), **changes}
    write_run_file(run, in_sections(values), folder / "run.nc")
    return folder


@pytest.mark.parametrize("left", [True, False])
def test_numbers_are_those_of_the_run(left: bool) -> None:
    run = circle_run(left=left)
    replay = replay_of_run(run)
    assert replay.speed == pytest.approx(np.full(len(run.time), SPEED))
    assert replay.curvature == pytest.approx(np.full(len(run.time), (1.0 if left else -1.0) / RADIUS))
    assert Rotation.from_quat(replay.attitude, scalar_first=True).as_matrix() == pytest.approx(run.attitude, abs=1e-12)
    assert replay.tilt == pytest.approx(10.0 * DEGREE)
    assert replay.skis.middle.tolist() == [[0.0, STANCE / 2.0, 0.0], [0.0, -STANCE / 2.0, 0.0]]
    ski = run.scenario.ski
    assert replay.skis.half_width[30] == pytest.approx(0.5 * np.interp(0.05, ski.station[::-1], ski.width[::-1]))


def test_pieces_of_groove_have_the_time_when_the_boot_passed() -> None:
    """Piece j of the circle is at the boot's place at every second output, left ski first."""
    run = circle_run()
    groove = replay_of_run(run).groove
    assert groove.time == pytest.approx(np.repeat(run.time[::2], 2), abs=1e-9)
    order = np.lexsort((groove.ski, groove.time.round(9)))
    assert groove.ski[order].tolist() == [0, 1] * (len(order) // 2)
    assert groove.middle[order] == pytest.approx(run.groove.middle, abs=1e-12)
    assert groove.residual_depth[order] == pytest.approx(0.9 * groove.depth[order])


def test_the_file_gives_the_same_replay_as_the_object(tmp_path: Path) -> None:
    run = circle_run()
    of_file = replay_of_file(written(run, tmp_path), title="same")
    of_run = replay_of_run(run, title="same")
    assert replay_bytes(of_file) == replay_bytes(of_run)
    assert replay_of_file(tmp_path / "run.nc").title == tmp_path.name


def test_an_infinite_radius_survives_the_file(tmp_path: Path) -> None:
    run = circle_run(count=5)
    straight = replace(run, turn_radius=np.array([np.inf, 10.0, -20.0, np.inf, 5.0]))
    found = replay_of_file(written(straight, tmp_path)).curvature
    assert found == pytest.approx([0.0, 0.1, -0.05, 0.0, 0.2])


def test_a_ski_file_is_found_beside_the_run_and_asked_for_where_it_is_not(tmp_path: Path) -> None:
    run = circle_run(count=5)
    folder = written(run, tmp_path, **{"ski.name": None, "ski.file": "mine.toml"})
    with raises(ParameterError, "missing_file", file="mine.toml"):
        replay_of_file(folder)
    assert replay_of_file(folder, ski=ski_named("slalom")).facts[-1][1].startswith("slalom")
    write_ski(ski_named("slalom"), folder / "mine.toml")
    assert replay_of_file(folder).skis.half_width == pytest.approx(
        replay_of_file(folder, ski=ski_named("slalom")).skis.half_width, abs=1e-6
    )


@pytest.mark.parametrize("content", [b"no NetCDF at all", b"CDF\x01" + b"\0" * 60])
def test_what_is_no_run_is_rejected_with_its_name(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "run.nc").write_bytes(content)
    with raises(ParameterError, "not_a_run"):
        replay_of_file(tmp_path)
    with raises(ParameterError, "cannot_read"):
        replay_of_file(tmp_path / "gone.nc")


def test_a_profile_is_drawn_with_its_heights() -> None:
    x = np.linspace(-5.0, 40.0, 46)
    run = circle_run(count=5)
    on_profile = replace(run, scenario=replace(run.scenario, slope=Profile(x, -0.2 * x)))
    replay = replay_of_run(on_profile)
    assert replay.tilt == 0.0
    assert replay.profile is not None
    assert replay.profile[:, 1] == pytest.approx(-0.2 * replay.profile[:, 0], abs=1e-12)
    assert np.diff(replay.profile[:, 0]).max() <= 0.25 + 1e-12


def track(axes: str = "slope") -> Track:
    place = np.array([[0.0, 1.0, np.nan], [np.nan, np.nan, np.nan], [2.0, 3.0, 0.5]])
    return Track(
        name="mine", time=np.array([0.0, 0.1, 0.2]), place=place, speed=np.full(3, np.nan), time_scale="local",
        frame="", axes=axes,  # type: ignore[arg-type]
    )  # fmt: skip


def test_a_measured_track_keeps_its_places_and_moves_in_time() -> None:
    found = measured_track(track(), starts_at=1.5)
    assert found.place[:, :2].tolist() == [[0.0, 1.0], [2.0, 3.0]]
    assert found.time == pytest.approx([1.5, 1.7])
    with raises(ParameterError, "wrong_axes"):
        measured_track(track("east_north_up"))
    with raises(ParameterError, "too_few_points", track="mine", fewest=2):
        measured_track(replace(track(), place=np.array([[0.0, 1.0, 0.0], [np.nan] * 3, [2.0, np.nan, 0.5]])))


def test_a_course_of_the_catalogue_is_in_a_run_of_a_file(tmp_path: Path) -> None:
    run = circle_run(count=3)
    written(run, tmp_path, **{"course.name": "slalom-20-gates"})
    gates = present(replay_of_file(tmp_path).gates)
    assert gates[:, :2].tolist() == [list(gate.turning) for gate in read_course("slalom-20-gates").gates]


def test_times_at_gates_are_those_of_both_feet() -> None:
    """Poles 20 cm beside either ski, on a circle: the same times as the run has."""
    run = circle_run()
    gates = []
    for row, aside in ((60, 0.2 + STANCE / 2.0), (140, -0.2 - STANCE / 2.0)):
        x, y = (run.place[row] + aside * run.attitude[row, :, 1])[:2].tolist()
        gates.append(Gate(name=str(row), turning=(x, y), side="right" if aside > 0.0 else "left"))
    run = replace(run, scenario=replace(run.scenario, course=Course(gates=tuple(gates))))
    found, times = run_gates(run), replay_of_run(run).gate_times
    assert found is not None
    assert found.passed == 2
    assert times == pytest.approx([time - found.start_time for time in found.times if time is not None], abs=1e-9)


def test_settings_are_words_for_people() -> None:
    facts = dict(replay_of_run(circle_run(count=3)).facts)
    assert facts["H_V"] == "0.2 N/mm³"
    assert facts["S_f"] == "0.5 N/mm²"
    assert facts["Skis"].startswith("giant-slalom, ") and "30°" in facts["Skis"]
    for stress, word in ((None, "not given"), (0.5, "0.5 N/mm²")):
        told = dict(facts_of(outcome="energy_open", hardness=0.2, stress=stress, ratio=10.0, ski="", edge_angle=None))
        assert (told["Outcome"], told["S_f"], told["k_u / H_V"]) == ("energy open", word, "10")


def test_gates_stand_on_the_snow() -> None:
    places = [[2.0, 1.0], [8.0, -1.5]]
    assert replay_of_run(circle_run(count=5)).gates is None
    on_plane = replay_of_run(circle_run(count=5), gates=places).gates
    assert on_plane is not None and on_plane.tolist() == [[2.0, 1.0, 0.0], [8.0, -1.5, 0.0]]
    run = circle_run(count=5)
    x = np.linspace(-30.0, 60.0, 91)
    on_profile = replay_of_run(
        replace(run, scenario=replace(run.scenario, slope=Profile(x, -0.2 * x))), gates=places
    ).gates
    assert on_profile is not None and on_profile[:, 2] == pytest.approx([-0.4, -1.6])
    for wrong in ([1.0, 2.0], [[1.0, 2.0, 3.0]], [[np.nan, 1.0]]):
        with raises(ParameterError, "wrong_shape"):
            replay_of_run(run, gates=wrong)


@pytest.fixture(scope="module")
def sound(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    run = simulate(load_scenario("slalom-20-gates", changes={"run.duration_s": 0.1, "solver.method": "fast"}))
    place = tmp_path_factory.mktemp("run") / "run.nc"
    write_run_file(run, summary_dict(run)["scenario"], place)
    return place.read_bytes()


def changed(folder: Path, sound: bytes, change: Callable[[Any], None]) -> Path:
    place = folder / "run.nc"
    place.write_bytes(sound)
    with netcdf_file(place, "a", mmap=False) as file:
        change(file)
    return place


def put(name: str, value: float, at: tuple[int, ...] = (2,)) -> Callable[[Any], None]:
    def change(file: Any) -> None:
        file.variables[name][at] = value

    return change


def test_a_sound_run_is_drawn(tmp_path: Path, sound: bytes) -> None:
    place = changed(tmp_path, sound, lambda _: None)
    assert len(replay_bytes(replay_of_file(place))) > 1000


@pytest.mark.parametrize("value", [np.nan, 1e300, 1e38, 9.969209968386869e36])
@pytest.mark.parametrize(
    ("name", "at"),
    [
        ("x", (2,)),
        ("speed", (0,)),
        ("bending", (1, 0, 3)),
        ("force_per_length", (1, 1, 5)),
        ("station", (4,)),
        ("groove_x", (0,)),
    ],
)
def test_a_number_that_is_none(tmp_path: Path, sound: bytes, name: str, at: tuple[int, ...], value: float) -> None:
    place = changed(tmp_path, sound, put(name, value, at))
    with pytest.raises(ParameterError) as caught:
        replay_of_file(place)
    assert "run.nc" in str(caught.value)


@pytest.mark.parametrize("value", [0.0, 5e-324, np.nan])
def test_a_radius_that_no_turn_has(tmp_path: Path, sound: bytes, value: float) -> None:
    with raises(ParameterError, "not_a_run", name="turn_radius"):
        replay_of_file(changed(tmp_path, sound, put("turn_radius", value)))


@pytest.mark.parametrize(
    "change",
    [
        put("time", 0.0),
        put("attitude", 3.0, (1, 0, 0)),
        lambda file: setattr(file, "solver_line_spacing_m", np.nan),
        lambda file: setattr(
            file, "scenario", file.scenario.replace(b'"edge_angle_deg": 0.0', b'"edge_angle_deg": 1e99')
        ),
        lambda file: setattr(file, "scenario", file.scenario.replace(b'"mass_kg": 75.0', b'"mass_kg": -1')),
        lambda file: setattr(file, "scenario", b"[1]"),
        lambda file: setattr(file, "outcome", np.float64(3.0)),
    ],
)
def test_what_does_not_go_together(tmp_path: Path, sound: bytes, change: Callable[[Any], None]) -> None:
    with raises(ParameterError, "not_a_run"):
        replay_of_file(changed(tmp_path, sound, change))
