"""run.nc holds a run to the digit, with units and meanings that a program of the field understands."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.io import netcdf_file

from skisnow.report.run.file import MISSING, RUN_VARIABLES, write_run_file
from skisnow.simulation.run import LOST, STORED, Run

from ..docs.page_text import page_text
from .runs import RADIUS, SPEED, STANCE, circle_run

PAGE = page_text("files/run")
VARIABLES = PAGE.split("| variable |")[1].splitlines()
UNITS = {"s", "m", "m s-1", "rad", "N m-1", "J", "1", "N", "N m"}


def written(run: Run, path: Path, **further: Any) -> Any:
    write_run_file(run, {"snow": {"H_V_N_per_mm3": 0.2, "S_f_N_per_mm2": 0.5}}, path, **further)
    return netcdf_file(path, "r", mmap=False)


def text(value: bytes) -> str:
    return value.decode("utf-8")


@pytest.fixture(scope="module")
def run() -> Run:
    return circle_run()


@pytest.fixture(scope="module")
def file(run: Run, tmp_path_factory: pytest.TempPathFactory) -> Any:
    return written(run, tmp_path_factory.mktemp("run") / "run.nc")


def test_every_number_is_there_to_the_digit(run: Run, file: Any) -> None:
    read = {name: np.asarray(variable[:]) for name, variable in file.variables.items() if name != "ski_name"}
    for name, values in (
        ("time", run.time), ("speed", run.speed), ("heading", run.heading), ("turn_radius", run.turn_radius),
        ("attitude", run.attitude), ("station", run.skis.station), ("depth", run.skis.depth),
        ("edge_depth", run.skis.edge_depth), ("force_per_length", run.skis.force_per_length),
        ("shear_per_length", run.skis.shear_per_length), ("bending", run.skis.bending), ("twist", run.skis.twist),
        ("groove_width", run.groove.width), ("groove_depth", run.groove.depth),
        ("groove_residual_depth", run.groove.residual_depth),
    ):  # fmt: skip
        assert np.array_equal(read[name], values), name
    for place, axis in enumerate("xyz"):
        assert np.array_equal(read[axis], run.place[:, place])
        assert np.array_equal(read[f"velocity_{axis}"], run.velocity[:, place])
        assert np.array_equal(read[f"ski_{axis}"], run.skis.track[:, :, place])
        assert np.array_equal(read[f"groove_{axis}"], run.groove.middle[:, place])
        assert np.array_equal(read[f"groove_left_{axis}"], run.groove.left[:, place])
    for name in STORED:
        assert np.array_equal(read[f"{name}_energy"], run.energies[name])
    for name in LOST:
        assert np.array_equal(read[f"lost_{name}"], run.energies[name])


def test_sides_axes_and_units_mean_what_they_say(file: Any) -> None:
    """A left turn of 12 m at 8 m/s, read from the file alone: left ski inside, curvature and heading rate positive."""
    read = {name: np.asarray(variable[:]) for name, variable in file.variables.items()}
    names = ["".join(letter.decode() for letter in row).strip() for row in read["ski_name"]]
    assert names == ["left", "right"]
    middle = len(read["time"]) // 2  # heading 0: down the fall line
    assert read["heading"][middle] == pytest.approx(0.0, abs=1e-12)
    assert read["velocity_x"][middle] == pytest.approx(SPEED)
    assert read["ski_y"][middle, 0] - read["ski_y"][middle, 1] == pytest.approx(STANCE)
    rate = np.gradient(read["heading"], read["time"])[middle]
    assert rate == pytest.approx(SPEED / RADIUS)  # rad/s: degrees would be 57 times as much
    assert read["turn_radius"][middle] == pytest.approx(SPEED / rate)
    assert read["station"][0] > 0.0 > read["station"][-1]  # tip to tail
    # the tip stands above the snow, the middle in it by some 2 cm, in metres
    assert read["edge_depth"][middle, 1, 0] < 0.0 < read["edge_depth"][middle, 1, 30] < 0.05


def test_it_says_after_which_conventions_and_in_which_units(file: Any) -> None:
    assert text(file.Conventions) == "CF-1.11"
    assert file.version_byte == 2
    for variable in RUN_VARIABLES:
        found = file.variables[variable.name]
        assert text(found.units) == variable.units
        assert variable.units in UNITS
        assert len(text(found.long_name)) > 3
        assert found.dimensions == variable.dimensions
        for name in variable.coordinates.split():
            assert name in file.variables
    axes = {name: text(file.variables[name].axis) for name in ("time", "x", "y", "z")}
    assert axes == {"time": "T", "x": "X", "y": "Y", "z": "Z"}
    assert text(file.variables["z"].positive) == "up"


def test_scenario_and_outcome_are_in_the_file(run: Run, file: Any) -> None:
    assert json.loads(text(file.scenario))["snow"]["S_f_N_per_mm2"] == 0.5
    assert json.loads(text(file.scenario_keys))["snow.S_f_N_per_mm2"].endswith("S_f (N/mm²)")
    assert text(file.outcome) == run.outcome
    assert file.run_length_m == run.run_length
    assert file.steps == run.steps
    assert "skisnow" in json.loads(text(file.provenance))["versions"]


def test_straight_path_and_words_beyond_ascii(run: Run, tmp_path: Path) -> None:
    radius = run.turn_radius.copy()
    radius[3] = np.inf
    changed = replace(run, turn_radius=radius, remedy="Kürzer ≤ 1 ms")
    file = written(changed, tmp_path / "run.nc", provenance={"seed": 3})
    assert file.variables["turn_radius"][3] == file.variables["turn_radius"]._FillValue == MISSING
    assert text(file.remedy) == "Kürzer ≤ 1 ms"
    assert json.loads(text(file.provenance)) == {"seed": 3}


def test_run_that_ended_at_once_has_a_file(tmp_path: Path) -> None:
    short = circle_run(count=3)
    none = {name: getattr(short.groove, name)[:0] for name in ("middle", "left", "width", "depth", "residual_depth")}
    file = written(replace(short, groove=type(short.groove)(**none)), tmp_path / "run.nc")
    assert file.variables["groove_width"].shape == (0,)


def test_every_variable_is_reported_with_its_unit() -> None:
    for variable in RUN_VARIABLES:
        row = next(line for line in VARIABLES if line.startswith("|") and f"`{variable.name}`" in line)
        cells = [cell.strip() for cell in row.split("|")[1:-1]]
        assert cells[1] == ", ".join(variable.dimensions), variable.name
        assert cells[2] == variable.units, variable.name
