"""A run.nc with numbers that no run has is an error that names the file and the variable."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.io import netcdf_file

from skisnow import load_scenario, simulate
from skisnow._support.errors import ParameterError
from skisnow.replay import replay_bytes, replay_of_file
from skisnow.report.run.file import write_run_file
from skisnow.simulation.run_summary import summary_dict
from tests.coded import raises


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


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 1e300, 1e38, 9.969209968386869e36])
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
