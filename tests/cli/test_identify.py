"""`skisnow identify` as a user meets it."""

import json
import os
import signal
import sys
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest

from skisnow._support.errors import SkisnowError
from skisnow.cli import main
from skisnow.cli.shell import json_schema
from skisnow.report.figures.drawing import FORMS

from ..identification import straight_tracks
from ..identification.test_photo_cell_times import AREA, CHANGES, MU, STATION, truth

SCHEMA = json_schema("identification")
SETS = [word for key, value in CHANGES.items() for word in ("--set", f"{key}={value}")]
Printed = pytest.CaptureFixture[str]


@pytest.fixture
def cells(tmp_path: Path) -> Path:
    noise = 0.004 * np.random.default_rng(1).standard_normal(len(STATION))
    rows = [f"a,{s:g},{t:.5f},0.004" for s, t in zip(STATION, truth() + noise, strict=True)]
    path = tmp_path / "cells.csv"
    path.write_text("run,station_m,time_s,time_sd_s\n" + "\n".join(rows) + "\n", encoding="utf-8")
    return path


def answer(words: list[str], printed: Printed, *, status: int = 0) -> Any:
    assert main(["identify", *words, "--json"]) == status
    found = json.loads(printed.readouterr().out, parse_constant=lambda word: pytest.fail(f"{word} is no JSON"))
    jsonschema.validate(found, SCHEMA)
    return found


def test_json_alone_with_full_keys(cells: Path, capsys: Printed) -> None:
    found = answer(["carved-46m", str(cells), "--free", "mu_0,drag_area", *SETS], capsys)
    assert found["outcome"] == "converged"
    low, high = found["parameters"]["friction.mu_0"]["interval"]
    assert low < MU < high
    low, high = found["parameters"]["drag.drag_area_m2"]["interval"]
    assert low < AREA < high
    r = found["correlation"]["friction.mu_0"]["drag.drag_area_m2"]
    assert r == found["correlation"]["drag.drag_area_m2"]["friction.mu_0"] < -0.9
    assert any("hardly told apart" in text for text in found["warnings"])


@pytest.mark.usefixtures("undrawn")
def test_a_report_is_written(cells: Path, tmp_path: Path, capsys: Printed) -> None:
    out = tmp_path / "out"
    words = ["identify", "carved-46m", str(cells), "--free", "mu_0,drag_area", "--out", str(out), "--profile", *SETS]
    assert main(words) == 0
    assert "friction.mu_0" in capsys.readouterr().out
    jsonschema.validate(json.loads((out / "identification.json").read_text(encoding="utf-8")), SCHEMA)
    page = (out / "report.html").read_text(encoding="utf-8")
    assert "friction.mu_0" in page
    assert "hardly told apart" in page
    lines = (out / "fits.csv").read_text(encoding="utf-8").splitlines()
    assert len(lines) == 1 + len(STATION)
    assert {path.name for path in (out / "figures").iterdir()} == {
        f"{name}.{kind}" for name in ("residuals_photo_cells", "profiles") for kind in FORMS
    }


@pytest.mark.parametrize("slip", [["--free", "mu0,start.speed"], ["--free", "mu_0,drag_area", "no.csv"]])
def test_a_slip_in_the_command_takes_no_kept_simulation_away(slip: list[str], cells: Path, tmp_path: Path) -> None:
    kept = tmp_path / "simulations.partial"
    kept.write_bytes(b"what hours have found")
    assert main(["identify", "carved-46m", *slip, str(cells), "--out", str(tmp_path), *SETS]) == 1
    assert kept.read_bytes() == b"what hours have found"


def test_asked_to_end_before_the_first_point_it_says_so(cells: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def ended(*_: object, **__: object) -> None:
        os.kill(os.getpid(), signal.SIGTERM)
        signal.pause()

    monkeypatch.setattr("skisnow.identification.identify", ended)
    assert main(["identify", "carved-46m", str(cells), "--free", "mu_0", *SETS]) == 143


def test_too_few_points_exit_with_1_and_say_so(cells: Path, capsys: Printed) -> None:
    lines = cells.read_text(encoding="utf-8").splitlines()[:2]
    cells.write_text("\n".join(lines) + "\n", encoding="utf-8")
    found = answer(["carved-46m", str(cells), "--free", "mu_0,drag_area", *SETS], capsys, status=1)
    assert found["outcome"] == "too_few_points"
    assert found["parameters"]["friction.mu_0"]["value"] is None


@pytest.mark.parametrize(
    ("words", "code"), [(["--free", "mu_9"], "unknown_name"), (["--free", "S_f"], "unused_key"), ([], "nothing_free")]
)
def test_a_fault_is_reported(
    cells: Path, capsys: Printed, noted_errors: list[SkisnowError], words: list[str], code: str
) -> None:
    assert main(["identify", "carved-46m", str(cells), *words, *SETS]) == 1
    assert noted_errors[-1].code == code
    assert str(noted_errors[-1]) in capsys.readouterr().err


def test_resuming_needs_a_place(cells: Path, capsys: Printed) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["identify", "carved-46m", str(cells), "--free", "mu_0", "--resume"])
    assert ended.value.code == 2
    assert "--out" in capsys.readouterr().err


def test_an_interrupted_search_is_kept_and_gone_on_with(
    tmp_path: Path, capsys: Printed, monkeypatch: pytest.MonkeyPatch
) -> None:
    straight_tracks.put(monkeypatch)
    track = straight_tracks.track(seed=1)
    path = tmp_path / "track.csv"
    rows = [f"{t:.1f},{x:.6f},{y:.6f}" for t, (x, y, _) in zip(track.time, track.place, strict=True)]
    path.write_text("time_s,x_m,y_m\n" + "\n".join(rows) + "\n", encoding="utf-8")
    sets = [word for key, value in straight_tracks.SCENARIO.items() for word in ("--set", f"{key}={value}")]
    words = ["carved-46m", str(path), "--free", "mu_0,speed", "--workers", "1", "--out", str(tmp_path / "out"), *sets]
    module = sys.modules["skisnow.simulation.simulated_run"]
    simulate, calls = module.simulate, []

    def stopping(scenario: Any) -> Any:
        calls.append(scenario)
        if len(calls) == 6:
            raise KeyboardInterrupt
        return simulate(scenario)

    monkeypatch.setattr(module, "simulate", stopping)
    assert answer(words, capsys, status=130)["outcome"] == "interrupted"
    found = answer([*words, "--resume"], capsys)
    assert found["outcome"] == "converged"
    assert found["effort"]["kept_simulations"] == 5


def test_the_strength_alone_from_marks(tmp_path: Path, capsys: Printed) -> None:
    """The kind of each file is in the terminal, and in the JSON."""
    path = tmp_path / "marks.csv"
    path.write_text("turn_radius_m\n16.1\n16.3\n16.2\n", encoding="utf-8")
    assert main(["identify", "carved-46m", str(path), "--free", "S_f", "--out", str(tmp_path / "found")]) == 0
    printed = capsys.readouterr()
    assert f"{path}: measured grooves (places: 3)\n" in printed.out
    assert "bounded from below" in printed.err
    found = json.loads((tmp_path / "found" / "identification.json").read_text("utf-8"))
    jsonschema.validate(found, SCHEMA)
    assert found["data"] == [{"name": str(path), "taken_for": "measured grooves (places: 3)"}]
