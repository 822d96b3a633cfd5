"""Friction and drag from photo-cell times, against the Fisher information of the closed form."""

import math
from pathlib import Path

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.identification import Identification, PhotoCellRun, PhotoCells, identify, read_photo_cells
from skisnow.identification.data import read_data
from skisnow.scenario import scenario_file, scenario_text
from tests.coded import raises
from tests.present import present

from . import glide_in_closed_form as exact
from .test_glide import times_on_two_planes, two_planes

ANGLE_DEG, MU, AREA, SPEED, SD = 14.0, 0.05, 0.5, 3.0, 0.004
CHANGES: dict[str, object] = {
    "slope.angle_deg": ANGLE_DEG,
    "friction.mu_0": 0.03,
    "drag.drag_area_m2": 0.3,
    "start.speed_m_per_s": SPEED,
    "start.heading_deg": 0.0,
}
STATION = np.arange(10.0, 219.0, 8.0)


def mass() -> float:
    scenario = scenario_file("carved-46m").scenario
    return scenario.sledge.mass + 2.0 * scenario.ski.mass


def truth(angle_deg: float = ANGLE_DEG) -> np.ndarray:
    angle = math.radians(angle_deg)
    times = exact.passage_times(STATION, mu=MU, drag_area=AREA, speed=SPEED, mass=mass(), angle=angle)
    return np.asarray(times)


def cells(time: np.ndarray, sd: float | None = SD, name: str = "1") -> PhotoCells:
    run = PhotoCellRun(name, STATION, time, None if sd is None else np.full(len(time), sd))
    return PhotoCells("cells.csv", (run,))


def found_from(data: PhotoCells, free: str = "mu_0,drag_area") -> Identification:
    return identify("carved-46m", data, free, changes=CHANGES)


def with_section(folder: Path, text: str) -> Path:
    path = folder / "scenario.toml"
    path.write_text(f"{scenario_text('carved-46m')}\n{text}", encoding="utf-8")
    return path


def fisher_errors(columns: list[int]) -> np.ndarray:
    """Square roots of the diagonal of (DᵀD/σ²)⁻¹, D the derivatives of the closed form."""
    every = exact.derivatives(STATION, mass=mass(), angle=math.radians(ANGLE_DEG), mu=MU, drag_area=AREA, speed=SPEED)
    design = every[:, columns] / SD
    return np.asarray(np.sqrt(np.diag(np.linalg.inv(design.T @ design))))


def test_exact_times_give_the_truth_with_the_errors_of_the_fisher_information() -> None:
    """Central differences with steps of 10⁻³ of a size are 10⁻⁶ off; 10⁻⁴ leaves room for the step of integration."""
    found = found_from(cells(truth()), "mu_0,drag_area,speed")
    assert found.outcome == "converged"
    for each, true, error in zip(found.parameters, (MU, AREA, SPEED), fisher_errors([0, 1, 2]), strict=True):
        assert each.value == pytest.approx(true, abs=0.003 * error)
        assert each.standard_error == pytest.approx(error, rel=1e-4)
        assert present(each.interval)[1] == pytest.approx(true + 1.959964 * error, abs=0.003 * error)


@pytest.mark.slow
def test_errors_over_many_noises_are_what_the_intervals_say() -> None:
    """Over 30 seeds the squared errors in standard errors have mean 1, ± 0.26 as χ²/30; three times that is allowed."""
    squares = []
    for seed in range(30):
        noise = SD * np.random.default_rng(seed).standard_normal(len(STATION))
        found = found_from(cells(truth() + noise))
        for name, true in (("mu_0", MU), ("drag_area", AREA)):
            each = found[name]
            squares.append(((present(each.value) - true) / present(each.standard_error)) ** 2)
    assert 0.4 < np.mean(squares) < 1.8


def test_unstated_noise_is_estimated_from_the_residuals() -> None:
    """The estimate over 27 - 2 degrees of freedom is right to 14 %; 50 % is three and a half of these."""
    noise = SD * np.random.default_rng(5).standard_normal(len(STATION))
    found = found_from(cells(truth() + noise, sd=None))
    assert not found.accuracy_is_stated
    assert found["mu_0"].standard_error == pytest.approx(fisher_errors([0, 1])[0], rel=0.5)


def test_one_slope_hardly_tells_friction_from_drag() -> None:
    one = found_from(cells(truth()))
    assert one.correlation[0, 1] < -0.9
    assert any("inclination" in text for text in one.warnings)


def test_a_stop_before_the_last_cell_does_not_end_the_search() -> None:
    """It begins with friction at which the body would stop."""
    stopping = CHANGES | {"friction.mu_0": 0.3, "drag.drag_area_m2": 1.0}
    found = identify("carved-46m", cells(truth()), "mu_0,drag_area", changes=stopping)
    assert found["mu_0"].value == pytest.approx(MU, abs=1e-6)


def test_each_run_has_a_start_speed_of_its_own() -> None:
    fast = exact.passage_times(STATION, mu=MU, drag_area=AREA, speed=8.0, mass=mass(), angle=math.radians(ANGLE_DEG))
    runs = (cells(truth(), name="slow").runs[0], cells(np.asarray(fast), name="fast").runs[0])
    found = found_from(PhotoCells("two", runs), "mu_0,drag_area,start.speed")
    assert [each.parameter.name for each in found.parameters][2:] == ["speed@slow", "speed@fast"]
    assert found["speed@slow"].value == pytest.approx(SPEED, abs=1e-5)
    assert found["speed@fast"].value == pytest.approx(8.0, abs=1e-5)


def test_a_free_clock_takes_an_offset_away_and_knows_less() -> None:
    shifted = cells(truth() + 17.25)
    found = identify("carved-46m", shifted, "mu_0,drag_area", changes=CHANGES, clock_is_free=True)
    assert found["mu_0"].value == pytest.approx(MU, abs=1e-6)
    error = present(found["mu_0"].standard_error)
    assert error > fisher_errors([0, 1])[0]


@pytest.mark.slow
def test_profile_and_bootstrap_agree_with_the_curvature_of_a_nearly_linear_problem() -> None:
    """Profiles: the times are linear in mu to 10⁻³ over an interval. Bootstrap: 27 residuals in stretches, ± 25 %."""
    noise = SD * np.random.default_rng(5).standard_normal(len(STATION))
    found = identify(
        "carved-46m", cells(truth() + noise), "mu_0,drag_area", changes=CHANGES, profile=True, bootstrap=400
    )
    for each in found.parameters:
        assert each.interval is not None
        assert each.bootstrap_interval is not None
        width = each.interval[1] - each.interval[0]  # type: ignore[operator]
        assert each.profile_interval == pytest.approx(each.interval, abs=0.01 * width)
        assert each.bootstrap_interval[1] - each.bootstrap_interval[0] == pytest.approx(width, rel=0.5)  # type: ignore[operator]


def test_a_prior_pulls_as_much_as_it_knows(tmp_path: Path) -> None:
    """A linear problem with standard error s₁ and a prior s₂ at distance d is pulled by d s₁²/(s₁² + s₂²)."""
    changes = CHANGES | {"drag.drag_area_m2": AREA}
    free = present(identify("carved-46m", cells(truth()), "mu_0", changes=changes)["mu_0"].standard_error)
    text = f'[identify."friction.mu_0"]\nprior_mean = {MU + 2.0 * free!r}\nprior_sd = {free!r}\n'
    found = identify(with_section(tmp_path, text), cells(truth()), "mu_0", changes=changes)["mu_0"]
    assert found.value == pytest.approx(MU + free, abs=0.02 * free)
    assert found.standard_error == pytest.approx(free / math.sqrt(2.0), rel=0.01)


def test_a_prior_is_weighed_by_the_noise_that_the_residuals_show(tmp_path: Path) -> None:
    """No accuracy is stated; the noise is a fifth of the nominal 10 ms, and the pull as with that stated."""
    changes = CHANGES | {"drag.drag_area_m2": AREA}
    noise = 0.002 * np.random.default_rng(5).standard_normal(len(STATION))
    data = cells(truth() + noise, sd=None)
    alone = identify("carved-46m", data, "mu_0", changes=changes)["mu_0"]
    assert alone.value is not None and alone.standard_error is not None
    mean = alone.value + 2.0 * alone.standard_error
    text = f'[identify."friction.mu_0"]\nprior_mean = {mean!r}\nprior_sd = {alone.standard_error!r}\n'
    found = identify(with_section(tmp_path, text), data, "mu_0", changes=changes)["mu_0"]
    assert found.value == pytest.approx(alone.value + alone.standard_error, abs=0.1 * alone.standard_error)


def test_a_free_clock_is_set_by_the_times_that_are_known_best() -> None:
    """The sum of the residuals, each over its variance, is nothing."""
    sd = np.where(np.arange(len(STATION)) % 2, 0.002, 0.02)
    noise = sd * np.random.default_rng(2).standard_normal(len(STATION))
    data = PhotoCells("cells.csv", (PhotoCellRun("1", STATION, truth() + 5.0 + noise, sd),))
    found = identify("carved-46m", data, "mu_0,drag_area", changes=CHANGES, clock_is_free=True)
    (fit,) = found.fits
    weight = fit.sd[:, 0] ** -2.0
    assert np.sum(weight * fit.residual[:, 0]) / np.sum(weight) == pytest.approx(0.0, abs=1e-9)


def test_as_many_stations_as_times_and_at_least_one() -> None:
    with raises(ParameterError, "unequal_lengths"):
        PhotoCellRun("a", STATION[:2], truth()[:3])
    with raises(ParameterError, "unequal_lengths"):
        PhotoCellRun("a", STATION[:0], truth()[:0])


def test_progress_names_each_profile() -> None:
    lines: list[str] = []
    identify("carved-46m", cells(truth()), "mu_0,drag_area", changes=CHANGES, profile=True, progress=lines.append)
    profiles = [line for line in lines if line.startswith("profile")]
    assert [line.split()[-1] for line in profiles] == ["mu_0", "drag_area"]


def test_four_points_for_three_parameters_are_warned_of_and_two_are_too_few() -> None:
    few = PhotoCells("few", (PhotoCellRun("1", STATION[:4], truth()[:4]),))
    found = identify("carved-46m", few, "mu_0,drag_area,mu_1", changes=CHANGES)
    assert any("4 points" in text for text in found.warnings)
    fewer = PhotoCells("few", (PhotoCellRun("1", STATION[:2], truth()[:2]),))
    found = identify("carved-46m", fewer, "mu_0,drag_area,mu_1", changes=CHANGES)
    assert found.outcome == "too_few_points"
    assert all(each.value is None and each.interval is None for each in found.parameters)


def test_a_key_that_plays_no_part_is_rejected() -> None:
    with raises(ParameterError, "unused_key"):
        found_from(cells(truth()), "mu_0,S_f")


def test_mass_and_drag_area_cannot_be_distinguished() -> None:
    """Only C_dA/m acts: the columns are parallel, and both are named."""
    found = found_from(cells(truth()), "drag_area,mass")
    assert found.outcome == "not_identifiable"
    assert any("drag_area" in text and "mass" in text for text in found.warnings)


class TestFile:
    def test_rows_become_runs(self, tmp_path: Path) -> None:
        path = tmp_path / "cells.csv"
        path.write_text(
            "run;station_m;time_s;time_sd_s\na;10;2.5;0.01\na;20;3.5;0.01\nb;10;2.4;0.02\n", encoding="utf-8"
        )
        read = read_photo_cells(path)
        assert [run.name for run in read.runs] == ["a", "b"]
        assert read.runs[0].time.tolist() == [2.5, 3.5]
        sd = present(read.runs[1].time_sd)
        assert sd.tolist() == [0.02]

    @pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "cp1252"])
    @pytest.mark.parametrize("first", ["", "sep=;\n"])
    def test_tables_of_any_spreadsheet_program_are_read(self, tmp_path: Path, encoding: str, first: str) -> None:
        path = tmp_path / "cells.csv"
        path.write_text(f"{first}run;station_m;time_s\nfrüh;10;2,5\nfrüh;20,5;3\n", encoding=encoding)
        read = read_data(path)
        assert isinstance(read, PhotoCells)
        (run,) = read.runs
        assert run.name == "früh"
        assert run.station.tolist() == [10.0, 20.5]
        assert run.time.tolist() == [2.5, 3.0]

    @pytest.mark.parametrize(
        ("rows", "code", "place"),
        [
            ("a;10,5;2,5\na;20,5;3.5\n", "not_a_number", "row 3"),
            ("a;10;1_0\n", "not_a_number", "row 2"),
            ("a;10;3.5\na;20;2.5\n", "time_not_rising", "run a"),
            ("a;20;2.5\na;10;3.5\n", "station_not_rising", "run a"),
            (";10;3\n", "empty_cell", "row 2, column run"),
            ("a;ten;3\n", "not_a_number", "row 2"),
            ("a;-1;3\n", "before_start", "run a"),
            ("", "no_rows", "cells.csv"),
        ],
    )
    def test_errors(self, tmp_path: Path, rows: str, code: str, place: str) -> None:
        path = tmp_path / "cells.csv"
        path.write_text(f"run;station_m;time_s\n{rows}", encoding="utf-8")
        with raises(ParameterError, code) as caught:
            read_photo_cells(path)
        assert place in str(caught.value)

    def test_columns_that_are_missing_or_half_filled(self, tmp_path: Path) -> None:
        path = tmp_path / "cells.csv"
        path.write_text("run,station_m\na,10\n", encoding="utf-8")
        with raises(ParameterError, "missing_column"):
            read_photo_cells(path)
        path.write_text("run,station_m,time_s,time_sd_s\na,1,3,0.1\na,2,4,\n", encoding="utf-8")
        with raises(ParameterError, "partial_accuracy"):
            read_photo_cells(path)


def test_two_planes_give_friction_and_drag_with_true_errors(tmp_path: Path) -> None:
    """The search ends at the truth; its standard errors are those of central differences of the closed form."""
    station = np.arange(10.0, 141.0, 10.0)
    planes = math.radians(20.0), math.radians(10.0)
    profile = two_planes(*planes, 1.0)
    rows = "".join(f"{x!r},{z!r}\n" for x, z in zip(profile.x.tolist(), profile.height.tolist(), strict=True))
    (tmp_path / "profile.csv").write_text(f"x,y\n{rows}", encoding="utf-8")

    def times(mu: float, area: float) -> np.ndarray:
        return np.asarray(times_on_two_planes(*planes, mu, 0.5 * exact.DENSITY * area / mass(), station))

    scenario = scenario_file("carved-46m").values
    assert scenario["drag.air_density_kg_per_m3"] == exact.DENSITY
    data = PhotoCells("cells.csv", (PhotoCellRun("1", station, times(MU, AREA), np.full(len(station), SD)),))
    changes = CHANGES | {
        "slope.kind": "profile", "slope.profile": str(tmp_path / "profile.csv"), "start.speed_m_per_s": 6.0,
    }  # fmt: skip
    del changes["slope.angle_deg"]
    found = identify("carved-46m", data, "mu_0,drag_area", changes=changes)
    step = 1e-4
    design = np.column_stack(
        [
            (times(MU + step, AREA) - times(MU - step, AREA)) / (2.0 * step),
            (times(MU, AREA + step) - times(MU, AREA - step)) / (2.0 * step),
        ]
    )
    errors = SD * np.sqrt(np.diag(np.linalg.inv(design.T @ design)))
    assert found.outcome == "converged"
    assert [each.standard_error for each in found.parameters] == pytest.approx(errors, rel=0.01)
    assert abs(found["mu_0"].value - MU) < 0.1 * errors[0]  # type: ignore[operator]
    assert abs(found["drag_area"].value - AREA) < 0.1 * errors[1]  # type: ignore[operator]
