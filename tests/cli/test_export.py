"""skisnow export, schema, serve and identify."""

import builtins
import json
import os
import platform
import re
import shlex
import signal
import sys
import xml.etree.ElementTree as ET
import zipfile
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest

from skisnow._support.errors import SkisnowError
from skisnow.cli import main
from skisnow.cli.shell import NAMES, json_schema
from skisnow.report.figures.drawing import FORMS
from tests.present import present

from ..identification import straight_tracks
from ..identification.test_photo_cell_times import AREA, CHANGES, MU, STATION, truth
from .json_answer import json_answer

linux = pytest.mark.skipif(
    not sys.platform.startswith("linux") or platform.machine() != "x86_64",
    reason="FMUs hold a library for Linux on x86-64 alone",
)


@linux
@pytest.mark.parametrize(
    ("options", "version", "name", "first"),
    [
        (["--contact", "--skis", "1", "--fmi", "3"], "3.0", "skisnow contact", "ski.position[1]"),
        (["--contact"], "2.0", "skisnow contact", "left.position[1]"),
        (["--set", "speed_m_per_s=3"], "2.0", "skisnow sledge", "push.force[1]"),
    ],
)
def test_a_model_as_asked(
    options: list[str], version: str, name: str, first: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "model.fmu"
    assert main(["export", "fmu", "carved-46m", "--out", str(path), *options]) == 0
    assert capsys.readouterr().out.strip() == str(path)
    with zipfile.ZipFile(path) as archive:
        description = ET.fromstring(archive.read("modelDescription.xml"))
    assert (description.attrib["fmiVersion"], description.attrib["modelName"]) == (version, name)
    inputs = [each.attrib["name"] for each in description.iter() if each.attrib.get("causality") == "input"]
    assert inputs[0] == first
    if name == "skisnow sledge":
        (speed,) = (each for each in description.iter("ScalarVariable") if each.attrib["name"] == "start.speed")
        assert float(speed[0].attrib["start"]) == 3.0


def test_wrong_words_and_names_are_rejected(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = str(tmp_path / "sledge.zip")
    assert main(["export", "fmu", "carved-46m", "--out", out]) == 1
    assert ".fmu" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


# `skisnow serve` where the web lab is not installed. What it serves is tested with the pages


@pytest.fixture
def missing(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Importing the server fails without this module."""
    imported = builtins.__import__

    def put(name: str | None) -> None:
        def importing(module: str, *others: Any, **named: Any) -> Any:
            if module == "web.server":
                raise ModuleNotFoundError("gone", name=name)
            return imported(module, *others, **named)

        monkeypatch.setattr(builtins, "__import__", importing)

    return put


def test_a_missing_extra_is_named_with_its_installation(missing: Any, capsys: pytest.CaptureFixture[str]) -> None:
    missing("nicegui")
    assert main(["serve"]) == 1
    told = capsys.readouterr()
    assert "skisnow[web]" in told.err
    assert told.out == ""


@pytest.mark.parametrize("name", ["skisnow.web.server", "skisnow", None])
def test_a_missing_module_of_skisnow_itself(name: str | None, missing: Any, capsys: pytest.CaptureFixture[str]) -> None:
    missing(name)
    assert main(["serve"]) != 0
    assert "pip install" not in capsys.readouterr().err


# The commands of `make demo` print no warning


MAKEFILE = Path(__file__).parents[2] / "Makefile"
REDUCED = {
    "analyse": ["--resamples", "100"],
    "turn": ["--runs", "3", "--workers", "1", "--set", "run.duration_s=0.1"],
    "simulate": ["--set", "run.duration_s=0.1"],
}
"""Further options with which each command is quick."""


def commands(folder: Path) -> list[list[str]]:
    """Arguments of the commands of the demo, with its own settings."""
    text = MAKEFILE.read_text(encoding="utf-8")
    turn = re.search(r"^TURN := (.*)$", text, re.MULTILINE)
    recipe = present(re.search(r"^demo:.*\n((?:\t.*\n)+)", text, re.MULTILINE))
    lines = re.findall(r"^\t\$\(BIN\)/skisnow (.*)$", recipe[1], re.MULTILINE)
    values = {"DEMO": str(folder), "SEED": "1", "TURN": present(turn)[1]}
    return [shlex.split(re.sub(r"\$\((\w+)\)", lambda found: values[found[1]], line)) for line in lines]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("reduced", [True, pytest.param(False, marks=pytest.mark.slow)])
def test_the_demo_prints_no_warning(
    reduced: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str], request: pytest.FixtureRequest
) -> None:
    if reduced:
        request.getfixturevalue("undrawn")
    found = commands(tmp_path / "demo")
    assert [arguments[0] for arguments in found] == ["reference", "analyse", "turn", "simulate"]
    for arguments in found:
        status = main([*arguments, *(REDUCED.get(arguments[0], []) if reduced else [])])
        said = capsys.readouterr()
        # the reduced slalom passes no gate, which is the outcome of its length
        assert status == 0 or (reduced and arguments[0] == "simulate")
        assert "warning" not in (said.out + said.err).lower()


@pytest.mark.parametrize("name", NAMES)
def test_each_schema_is_valid(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["schema", name]) == 0
    schema = json.loads(capsys.readouterr().out)
    jsonschema.Draft202012Validator.check_schema(schema)
    assert schema["properties" if name != "carve" else "$defs"]


# `skisnow identify` as a user meets it


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
    return json_answer(["identify", *words], SCHEMA, printed, status=status)


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


@pytest.mark.usefixtures("undrawn")
def test_an_interrupted_search_continues(tmp_path: Path, capsys: Printed, monkeypatch: pytest.MonkeyPatch) -> None:
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
