"""`skisnow track` as a user meets it."""

import json
from pathlib import Path

import jsonschema
import numpy as np
import pytest

from skisnow._support.errors import SkisnowError
from skisnow.cli import main
from skisnow.cli.schema import json_schema
from skisnow.report.figures.drawing import FORMS

from ..track.paths import NOISE, circle

SCHEMA = json_schema("track")
Printed = pytest.CaptureFixture[str]


@pytest.fixture
def turn(tmp_path: Path) -> Path:
    """5 s on a circle of 15 m to the left at 8 m/s, 10 Hz."""
    place = circle(15.0, 8.0, duration=5.0) + NOISE * np.random.default_rng(3).standard_normal((51, 2))
    rows = [f"{0.1 * number:.1f},{x:.4f},{y:.4f}" for number, (x, y) in enumerate(place)]
    path = tmp_path / "turn.csv"
    path.write_text("\n".join(["time_s,x_m,y_m", *rows, ""]), encoding="utf-8")
    return path


def test_json_is_the_contract(turn: Path, capsys: Printed) -> None:
    assert main(["track", str(turn), "--json"]) == 0
    found = json.loads(capsys.readouterr().out, parse_constant=lambda word: pytest.fail(f"{word} is no JSON"))
    jsonschema.validate(found, SCHEMA)
    assert found["points"] == 51
    assert found["distance_m"] == pytest.approx(40.0, rel=0.01)
    assert len(found["runs"]) == len(found["turns"]) == 1
    assert found["turns"][0]["turned_angle_deg"] == pytest.approx(np.degrees(40.0 / 15.0), rel=0.05)


def test_print_defines_its_numbers(turn: Path, capsys: Printed) -> None:
    assert main(["track", str(turn)]) == 0
    printed = capsys.readouterr().out
    assert printed.startswith("turn.csv\n")
    for words in ("51 in 5", "length of the estimated path", "is halved", "A run is a stretch in motion", "1 turn\n"):
        assert words in printed


def test_figures_and_json_are_written(turn: Path, tmp_path: Path, capsys: Printed) -> None:
    out = tmp_path / "out"
    assert main(["track", str(turn), "--json", "--out", str(out)]) == 0
    assert json.loads((out / "track.json").read_text(encoding="utf-8")) == json.loads(capsys.readouterr().out)
    written = sorted(path.name for path in (out / "figures").iterdir())
    assert written == sorted(f"{name}.{form}" for name in ("along", "map", "radius", "speed") for form in FORMS)


def test_window_and_noise_are_obeyed(turn: Path, capsys: Printed) -> None:
    assert main(["track", str(turn), "--json", "--window-s", "2", "--noise-m", "0.05"]) == 0
    smoothing = json.loads(capsys.readouterr().out)["smoothing"]
    assert (smoothing["window_s"], smoothing["place_noise_m"]) == (2.0, 0.05)


def test_tracks_without_enough_points_are_refused(turn: Path, tmp_path: Path, noted_errors: list[SkisnowError]) -> None:
    short = tmp_path / "short.csv"
    short.write_text("\n".join(turn.read_text(encoding="utf-8").splitlines()[:5]) + "\n", encoding="utf-8")
    absent = tmp_path / "absent.csv"
    for words, code in (([turn, "--window-s", "0.2"], "too_few_points"), ([short], "too_few_points"), ([absent], "")):
        assert main(["track", *map(str, words)]) == 1
        assert noted_errors[-1].code == code
