"""A run as object: record, table of its track, limits of the model."""

import csv
import io
import json
import math
import warnings
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from skisnow import BootMoment, BootPose, Scenario, load_scenario, simulate
from skisnow._support.errors import ModelLimitWarning, ParameterError
from skisnow._support.units import DEGREE
from skisnow.cli import main
from skisnow.dynamics import Ended
from skisnow.scenario import Plane
from skisnow.scenario.plausibility import model_limits
from skisnow.simulation.moving_boots import StrengthDrive
from skisnow.simulation.run_record import Record, stored_and_lost
from skisnow.simulation.run_setup import Setup, set_up
from skisnow.simulation.run_tables import COLUMNS, track_csv, write_track
from skisnow.ski import ski_named, write_ski
from skisnow.ski.editing import SkiEdit, edit_stations

from ..conftest import without_figures
from .straight_run import STRAIGHT, straight_run


def chords(record: Record) -> float:
    """Chord lengths in a turn of about 16 m radius, whose arcs of 0.1 m are two millionths longer."""
    return float(np.linalg.norm(np.diff(record.histories()["place"], axis=0), axis=1).sum())


def test_moments_are_kept_replaced_and_dropped() -> None:
    record = Record(set_up(load_scenario("carved-46m")))
    assert record.run_length == 0.0
    assert record.advance(0.01) is None
    record.advance(0.03)
    assert record.run_length == pytest.approx(chords(record), rel=1e-5)
    record.advance(0.035, replace=True)
    assert record.histories()["time"] == pytest.approx([0.0, 0.01, 0.035], abs=1e-12)
    assert record.run_length == pytest.approx(chords(record), rel=1e-5)
    record.advance(0.04)
    record.drop()
    assert record.run_length == pytest.approx(chords(record), rel=1e-5)
    record.drop()
    record.drop()
    assert record.histories()["time"].tolist() == [0.0]


def test_stored_and_lost_energies_are_separate() -> None:
    """Stored: kinetic, potential, skis, snow with what sticks, delayed depth; then losses and energies given."""
    parts = {
        "energies": [100.0, 200.0, 7.0],
        "snow_energies": [5.0, 3.0, 0.25, 0.5],
        "snow_losses": [19.5, 9.0, 19.75, 6.5, 0.0],
        "work": [10.0, 20.0, -30.0, 4.0, 5.0, 6.0],
        "work_given": [8.0, 9.0],
    }
    energies = stored_and_lost({name: np.array([numbers]) for name, numbers in parts.items()})
    stored, lost = (100.0, 200.0, 7.0, 8.25, 0.5), (19.5, 9.0, 19.75, 4.0, 5.0, 6.5)
    assert energies.tolist() == [[*stored, *lost, 8.0, 9.0]]


def test_forces_of_friction_are_sums_over_the_sections() -> None:
    record = Record(set_up(load_scenario("carved-46m", changes={"friction.mu_0": 0.1})))
    record.advance(0.03)
    dynamics = record.setup.dynamics
    for ski, pushes in enumerate(dynamics.part("pushes")):
        sections = dynamics.contact.sections(ski)
        sums = [float(force.sum()) for force in (sections.push, sections.push_across, sections.push_off)]
        assert sums[0] < -10.0
        assert pushes == pytest.approx(sums, rel=1e-12)


def test_what_is_reported_of_the_skis_is_what_the_beams_and_boots_have() -> None:
    """Deflection and twist at the free nodes; a stance between the edges at the boots."""
    scenario = load_scenario("carved-46m", changes={"start.x_m": 3.0, "start.y_m": -2.0, "start.heading_deg": 0.0})
    setup = set_up(scenario)
    skis = Record(setup).histories()["skis"]
    free = setup.dynamics.body.skis[0].unknown >= 0
    dofs = setup.dynamics.part("beam_dofs").reshape(2, -1, 3)
    assert skis.bending[0][:, free].tolist() == dofs[:, :, 0].tolist()
    assert skis.twist[0][:, free].tolist() == dofs[:, :, 2].tolist()
    assert np.abs(dofs[:, :, 0]).max() > 1e-3
    left, right = skis.track[0]
    stance, width = scenario.sledge.stance_width, float(scenario.ski.at(0.0).width)
    assert left[1] - right[1] == pytest.approx(stance, rel=0.05)
    assert 0.5 * (left + right)[:2] == pytest.approx([3.0, -2.0 + 0.5 * width], abs=0.5 * width)
    assert (left[2], right[2]) == (0.0, 0.0)


def test_the_track_of_a_flat_ski_does_not_jump_from_edge_to_edge() -> None:
    """The skis of a sledge without edging, 67 mm wide: their tracks move aside by less than 5 mm in 10 ms."""
    run = simulate(load_scenario("carved-46m", changes={"sledge.edge_angle_deg": 0.0, "run.duration_s": 0.3}))
    aside = np.einsum("nka,na->nk", run.skis.track - run.place[:, None], run.attitude[:, :, 1])
    assert np.abs(np.diff(aside, axis=0)).max() < 5e-3


def test_the_track_of_a_ski_is_its_lower_edge_and_its_middle_where_it_is_flat() -> None:
    """A ski 0.3 m to the left of its boots' middle, 0.06 m wide, rolled by 0.2 rad to either side about its way."""
    ski = SimpleNamespace(boot=np.array([0.0, 0.3, -0.05]), axes=np.eye(3))
    parts: Any = SimpleNamespace(
        scenario=SimpleNamespace(
            ski=SimpleNamespace(at=lambda _: SimpleNamespace(width=0.06, base_height=0.02)), slope=Plane(0.4)
        ),
        dynamics=SimpleNamespace(body=SimpleNamespace(skis=[ski])),
    )
    place = np.tile([5.0, 1.0, 0.03], (3, 1))
    attitude = Rotation.from_rotvec([[0.0, 0.0, 0.0], [0.2, 0.0, 0.0], [-0.2, 0.0, 0.0]]).as_matrix()
    found = Record._tracks(cast("Any", SimpleNamespace(setup=parts)), place, attitude, np.zeros((3, 1)))
    cos, sin = math.cos(0.2), math.sin(0.2)
    aside = [1.3, 1.0 + 0.27 * cos + 0.03 * sin, 1.0 + 0.33 * cos - 0.03 * sin]
    assert found[:, 0] == pytest.approx(np.array([[5.0, y, 0.0] for y in aside]), abs=1e-12)


class _Clock:
    """Dynamics that are a time and the outputs on the way to it."""

    def __init__(self) -> None:
        self.time, self.position, self.way = 0.0, np.zeros(3), [0.0]

    def advance(self, until: float) -> Ended:
        self.time = until
        self.way.append(until)
        return Ended.REACHED

    def state(self) -> tuple[float, list[float]]:
        return self.time, list(self.way)

    def restore(self, state: tuple[float, list[float]]) -> None:
        self.time, self.way = state[0], list(state[1])


def test_outputs_between_the_times_of_a_drive_leave_no_trace() -> None:
    """Called every 10 ms, whatever the outputs; after an output in between the steps begin at the state before it."""
    calls: list[float] = []

    def share(_: float) -> float:
        calls.append(dynamics.time)
        return 1.0

    dynamics, nothing = _Clock(), cast("Any", SimpleNamespace())
    setup = Setup(nothing, cast("Any", dynamics), nothing, np.zeros(3), {}, 0.0)
    snow = cast("Any", SimpleNamespace(compiled=SimpleNamespace()))
    setup.strength = StrengthDrive(share, snow)
    reached = []
    for output in (0.004, 0.008, 0.01, 0.025, 0.05):
        assert setup.advance(output, 0.0) is Ended.REACHED
        reached.append(dynamics.time)
    assert reached == pytest.approx([0.004, 0.008, 0.01, 0.025, 0.05])
    assert calls == pytest.approx([0.0, 0.01, 0.02, 0.03, 0.04])
    assert dynamics.way == pytest.approx([0.0, 0.01, 0.02, 0.03, 0.04, 0.05])


@pytest.mark.parametrize(
    ("method", "function", "arguments"),
    [
        (lambda run: run.plot(), "run.drawings.run_figure", ("track",)),
        (lambda run: run.plot("motion"), "run.drawings.run_figure", ("motion",)),
        (lambda run: run.report(Path("out")), "run.page.write_run", (Path("out"),)),
        (lambda run: run.to_dataframe(), "run.file.run_dataframe", ()),
        (lambda run: run.to_xarray(), "run.file.run_dataset", ()),
    ],
)
def test_a_method_returns_the_result_of_the_upper_package(
    method: Callable[[Any], Any], function: str, arguments: tuple[Any, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    run, result = straight_run(load_scenario("carved-46m", changes=STRAIGHT)), object()
    calls: list[tuple[Any, ...]] = []

    def record(*given: Any) -> object:
        calls.append(given)
        return result

    monkeypatch.setattr(f"skisnow.report.{function}", record)
    assert method(run) is result
    assert calls == [(run, *arguments)]


HEAD = (
    "time_s,x_m,y_m,z_m,speed_m_per_s,heading_deg,turn_radius_m,"
    "left_x_m,left_y_m,left_depth_mm,right_x_m,right_y_m,right_depth_mm,"
    "left_total_force_N,right_total_force_N,left_normal_force_N,right_normal_force_N"
)


def rows_of(text: str) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(text)))


def test_columns_are_those_of_the_contract(tmp_path: Path) -> None:
    run = straight_run(load_scenario("carved-46m", changes=STRAIGHT))
    write_track(run, tmp_path / "track.csv")
    text = track_csv(run)
    assert (tmp_path / "track.csv").read_text(encoding="utf-8") == text
    assert text.splitlines()[0] == HEAD == ",".join(COLUMNS)
    assert len(rows_of(text)) == 201  # 2 s in steps of 10 ms, both ends


def test_numbers_have_their_units_and_all_digits() -> None:
    run = straight_run(load_scenario("carved-46m", changes={**STRAIGHT, "y_m": 3.0}))
    turned = replace(run, heading=np.full(len(run.time), -math.pi / 6.0))
    row = rows_of(track_csv(turned))[100]
    assert float(row["time_s"]) == 1.0
    # 5 t + a t²/2 with a = 9.81 (sin 10° - 0.05 cos 10°), by hand
    assert float(row["x_m"]) == pytest.approx(5.0 + (1.703488622912587 - 0.483048202852488) / 2.0, rel=1e-12)
    assert float(row["speed_m_per_s"]) == pytest.approx(5.0 + 1.703488622912587 - 0.483048202852488, rel=1e-12)
    assert float(row["heading_deg"]) == pytest.approx(-30.0, rel=1e-12)
    assert float(row["left_y_m"]) - float(row["right_y_m"]) == pytest.approx(0.5, rel=1e-12)
    assert (float(row["left_depth_mm"]), float(row["right_depth_mm"])) == pytest.approx((4.0, 8.0), rel=1e-12)
    assert row["left_x_m"] == row["right_x_m"] == row["x_m"] == repr(float(run.place[100, 0]))


def test_radius_is_empty_where_the_path_is_straight() -> None:
    run = straight_run(load_scenario("carved-46m", changes=STRAIGHT))
    radius = run.turn_radius.copy()
    radius[1] = -12.5
    found = [row["turn_radius_m"] for row in rows_of(track_csv(replace(run, turn_radius=radius)))]
    assert found[:3] == ["", "-12.5", ""]


def turn(**changes: object) -> Scenario:
    return load_scenario("carved-46m", changes={"run.duration_s": 0.05} | changes)


def test_no_edge_angle_is_warned_of() -> None:
    for edge_angle in (0.0, 0.01, -1.0, 30.0):
        with warnings.catch_warnings(record=True) as caught:
            simulate(turn(**{"sledge.edge_angle_deg": edge_angle}))
        assert [each for each in caught if issubclass(each.category, ModelLimitWarning)] == []


@pytest.mark.parametrize(
    ("change", "codes"),
    [
        ({"base_bevel": 1.0 * DEGREE}, []),
        ({"side_edge": 88.0 * DEGREE}, ["side_edge_without_radius"]),
        ({"side_edge": 88.0 * DEGREE, "edge_radius": 1e-4}, ["edge_radius_unmeasured"]),
    ],
)
def test_grinding_without_a_measurement_is_warned_of(change: dict[str, Any], codes: list[str]) -> None:
    assert list(model_limits(replace(ski_named("giant-slalom"), **change))) == codes


def test_the_terminal_and_the_report_have_the_warning(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    ground = replace(ski_named("giant-slalom"), edge_radius=1e-4)
    write_ski(ground, tmp_path / "ground.toml")
    settings = ["--set", f"ski.file={tmp_path / 'ground.toml'}", "--set", "run.duration_s=0.05"]
    with without_figures():
        main(["simulate", "carved-46m", *settings, "--out", str(tmp_path / "out")])
    (text,) = model_limits(ground).values()
    assert capsys.readouterr().err.count(text) == 1
    assert text in json.loads((tmp_path / "out" / "summary.json").read_text(encoding="utf-8"))["warnings"]
    assert text in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")


def test_a_function_does_not_replace_a_skier_s_balance() -> None:
    def still(_: BootMoment) -> list[BootPose]:
        return [BootPose.of([0.0, side, 0.0], 0.0) for side in (0.2, -0.2)]

    with pytest.raises(ParameterError, match="with_"):
        simulate(load_scenario("skier-10deg"), boots=still)


@pytest.mark.parametrize("part", ["factors", "values"])
def test_an_unknown_column_of_an_edit_is_an_error(part: str) -> None:
    station = edit_stations(ski_named("slalom"))
    arguments: dict[str, Any] = {part: {"sidecut": 1.2 if part == "factors" else station}}
    with pytest.raises(ParameterError, match="sidecut"):
        SkiEdit(station, **arguments)
