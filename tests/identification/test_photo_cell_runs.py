"""Several runs and skiers at once, runs that weigh differently, and a slope of changing inclination."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.identification import Identification, PhotoCellRun, PhotoCells, identify
from tests.coded import raises

from . import glide_in_closed_form as exact
from .test_photo_cell_times import ANGLE_DEG, AREA, CHANGES, MU, SD, SPEED, STATION, mass, with_section

SKIS = mass() - 80.0
HEAVY, LARGE = 95.0, 0.7
"""Mass without skis (kg) and drag area (m²) of a second skier."""


def run(name: str, *, area: float = AREA, body: float = 80.0, sd: float = SD, noise: int | None = None) -> PhotoCellRun:
    angle = math.radians(ANGLE_DEG)
    time = exact.passage_times(STATION, mu=MU, drag_area=area, speed=SPEED, mass=body + SKIS, angle=angle)
    time = time + (0.0 if noise is None else sd * np.random.default_rng(noise).standard_normal(len(STATION)))
    return PhotoCellRun(name, STATION, np.asarray(time), np.full(len(STATION), sd))


def found_from(scenario: str | Path, runs: tuple[PhotoCellRun, ...], free: str) -> Identification:
    return identify(scenario, PhotoCells("cells.csv", runs), free, changes=CHANGES)


class TestSkiers:
    SECTION = f'[identify.runs."second"]\nmass_kg = {HEAVY}\n'
    RUNS = (run("first"), run("second", area=LARGE, body=HEAVY))

    def test_two_skiers_have_one_friction_and_a_drag_area_each(self, tmp_path: Path) -> None:
        found = found_from(with_section(tmp_path, self.SECTION), self.RUNS, "mu_0,drag_area@each")
        assert found.outcome == "converged"
        assert found["mu_0"].value == pytest.approx(MU, abs=1e-7)
        assert found["drag_area@first"].value == pytest.approx(AREA, abs=1e-6)
        assert found["drag_area@second"].value == pytest.approx(LARGE, abs=1e-6)

    def test_one_run_may_differ(self, tmp_path: Path) -> None:
        path = with_section(tmp_path, self.SECTION + f"drag_area_m2 = {LARGE}\n")
        found = found_from(path, self.RUNS, "mu_0,drag_area@first")
        assert found["mu_0"].value == pytest.approx(MU, abs=1e-7)
        assert next(iter(found.values)) == "friction.mu_0"
        assert [each.parameter.name for each in found.parameters] == ["mu_0", "drag_area@first"]

    @pytest.mark.parametrize(
        ("free", "section", "code"),
        [
            ("drag_area@third", "", "unknown_run"),
            ("drag_area@", "", "missing"),
            ("mu_0@each,mu_0@first", "", "repeated_key"),
            ("S_f@each", "", "unused_key"),
            ("drag_area", "drag_area_m2 = 0.7", "value_of_free_key"),
            ("drag_area", 'mass_kg = "much"', "wrong_kind"),
        ],
    )
    def test_errors(self, tmp_path: Path, free: str, section: str, code: str) -> None:
        path = with_section(tmp_path, f'[identify.runs."second"]\n{section}\n')
        with raises(ParameterError, code):
            found_from(path, self.RUNS, free)

    @pytest.mark.parametrize("entry", ["mas_kg = 80", "mass_kg = -80"])
    def test_a_wrong_entry_of_a_run_names_its_key(self, tmp_path: Path, entry: str) -> None:
        path = with_section(tmp_path, f'[identify.runs."second"]\n{entry}\n')
        with pytest.raises(ParameterError, match="mass"):
            found_from(path, self.RUNS, "drag_area")


def design(columns: list[int]) -> np.ndarray:
    derivatives = exact.derivatives(
        STATION, mass=mass(), angle=math.radians(ANGLE_DEG), mu=MU, drag_area=AREA, speed=SPEED
    )
    return np.asarray(derivatives[:, columns])


class TestWeights:
    def test_standard_errors_are_those_of_the_weighted_fisher_information(self) -> None:
        """Runs with 4 and 40 ms, and a run whose later cells are better."""
        mixed = replace(run("mixed"), time_sd=np.linspace(0.05, 0.002, len(STATION)))
        runs = (run("good"), run("bad", sd=10.0 * SD), mixed)
        found = found_from("carved-46m", runs, "mu_0,drag_area")
        weighted = np.vstack([design([0, 1]) / each.time_sd[:, None] for each in runs if each.time_sd is not None])
        wanted = np.sqrt(np.diag(np.linalg.inv(weighted.T @ weighted)))
        assert [each.standard_error for each in found.parameters] == pytest.approx(wanted, rel=1e-4)

    def test_a_run_pulls_by_its_weight(self) -> None:
        """Weighted least squares of the closed form, linear over so small a way to 1 % of a standard error."""
        runs = (run("good", noise=1), run("bad", sd=10.0 * SD, noise=2))
        found = found_from("carved-46m", runs, "mu_0,drag_area")
        noise = [each.time - run("").time for each in runs]
        matrix = np.vstack([design([0, 1]) / sd for sd in (SD, 10.0 * SD)])
        wanted = np.linalg.lstsq(matrix, np.concatenate([noise[0] / SD, noise[1] / (10.0 * SD)]))[0]
        error = np.sqrt(np.diag(np.linalg.inv(matrix.T @ matrix)))
        away = [each.value - true for each, true in zip(found.parameters, (MU, AREA), strict=True) if each.value]
        assert np.array(away) / error == pytest.approx(wanted / error, abs=0.02)

    def test_runs_that_state_nothing_beside_runs_that_do_are_rejected(self) -> None:
        with raises(ParameterError, "partial_accuracy"):
            found_from("carved-46m", (run("one"), replace(run("other"), time_sd=None)), "mu_0")


class TestTwoSlopes:
    """Planes of 8° and 22°, the inclination of the second with its run."""

    STATION = np.arange(20.0, 300.0, 30.0)
    SECTION = '[identify.runs."steep"]\nangle_deg = 22\n'

    def run(self, name: str, angle_deg: float) -> PhotoCellRun:
        angle = math.radians(angle_deg)
        time = exact.passage_times(self.STATION, mu=MU, drag_area=AREA, speed=SPEED, mass=mass(), angle=angle)
        return PhotoCellRun(name, self.STATION, np.asarray(time), np.full(len(self.STATION), SD))

    def found(self, folder: Path, *runs: PhotoCellRun) -> Identification:
        section = self.SECTION if any(each.name == "steep" for each in runs) else ""
        changes = CHANGES | {"slope.angle_deg": 8.0}
        return identify(with_section(folder, section), PhotoCells("cells", runs), "mu_0,drag_area", changes=changes)

    def test_two_runs_together_separate_friction_from_drag_better_than_one(self, tmp_path: Path) -> None:
        """As the Fisher information of the closed form says: r is -0.927, of one of them -0.97 to -0.98."""
        gentle, steep = self.run("gentle", 8.0), self.run("steep", 22.0)
        both = self.found(tmp_path, gentle, steep)
        assert both["mu_0"].value == pytest.approx(MU, abs=1e-7)
        assert both["drag_area"].value == pytest.approx(AREA, abs=1e-6)
        own = {"mass": mass(), "mu": MU, "drag_area": AREA, "speed": SPEED}
        parts = [exact.derivatives(self.STATION, angle=math.radians(angle), **own)[:, :2] for angle in (8.0, 22.0)]
        covariance = np.linalg.inv(sum(part.T @ part for part in parts) / SD**2)
        errors = np.sqrt(np.diag(covariance))
        assert [each.standard_error for each in both.parameters] == pytest.approx(errors, rel=1e-4)
        assert both.correlation[0, 1] == pytest.approx(covariance[0, 1] / errors[0] / errors[1], abs=1e-4)
        for one in (gentle, steep):
            alone = self.found(tmp_path, one)
            assert abs(both.correlation[0, 1]) < 0.96 * abs(alone.correlation[0, 1])
            assert all(
                together.standard_error < 0.85 * each.standard_error
                for together, each in zip(both.parameters, alone.parameters, strict=True)
                if together.standard_error and each.standard_error
            )
