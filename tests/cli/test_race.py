"""`skisnow race` as a user meets it, by the point; interrupted too."""

from __future__ import annotations

import csv
import json
import sys
from pathlib import Path

import pytest

from skisnow._support.errors import SkisnowError
from skisnow.cli import main
from skisnow.racing.windows import Windows

Printed = pytest.CaptureFixture[str]
EASY = [
    "race",
    "slalom-20-gates",
    "--set",
    "greatest_edge_deg=75",
    "--model",
    "point",
    "--gates",
    "2",
    "--workers",
    "1",
]


def race(out: Path, *more: str) -> int:
    return main([*EASY, "--out", str(out), *more])


def table(path: Path) -> list[dict[str, str]]:
    return list(csv.DictReader(path.read_text(encoding="utf-8").splitlines()))


def test_a_search_is_told_and_written(tmp_path: Path, capsys: Printed) -> None:
    pytest.importorskip("cmaes")
    assert race(tmp_path / "a", "--evaluations", "25", "--seed", "3") == 0
    out, _ = capsys.readouterr()
    assert "2 gates in" in out
    found = json.loads((tmp_path / "a" / "race.json").read_text(encoding="utf-8"))
    assert found["gained_s"] == pytest.approx(found["began_from_s"] - found["time_s"])
    assert found["gained_s"] > 0.0
    assert found["evaluations"] >= 25
    rows = table(tmp_path / "a" / "line.csv")
    assert [row["gate"] for row in rows] == ["1", "2"]
    assert [float(row["aside_m"]) for row in rows] == [turn["aside_m"] for turn in found["turns"]]
    evaluations = table(tmp_path / "a" / "evaluations.csv")
    assert min(float(row["value"]) for row in evaluations) == found["time_s"]
    assert (tmp_path / "a" / "lines.png").read_bytes().startswith(b"\x89PNG")
    again = tmp_path / "b"
    assert race(again, "--evaluations", "1", "--line", str(tmp_path / "a" / "line.csv"), "--json") == 0
    assert json.loads(capsys.readouterr().out)["time_s"] == pytest.approx(found["time_s"], abs=1e-9)


def test_variants_on_the_same_snows_without_the_search(
    tmp_path: Path, capsys: Printed, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "cmaes", None)
    more = ("--evaluations", "1", "--against", "giant-slalom", "--worth", "--snows", "2", "--snow-spread", "0.2")
    assert race(tmp_path, *more) == 0
    out = capsys.readouterr().out
    assert "friction 10 % less" in out
    assert "faster on" in out
    found = {each["name"]: each for each in json.loads((tmp_path / "race.json").read_text(encoding="utf-8"))["worth"]}
    assert found["friction 10 % less"]["on_own_snow_s"] < 0.0
    assert found["H_V 10 % more"]["on_own_snow_s"] == 0.0  # a point knows nothing of it
    rows = table(tmp_path / "worth.csv")
    assert len(rows) == 6 * 3
    assert (tmp_path / "worth.png").read_bytes().startswith(b"\x89PNG")
    gaps = table(tmp_path / "gaps_giant-slalom.csv")
    assert [row["gate"] for row in gaps] == ["1", "2"]
    assert gaps[-1]["other_time_s"] in rows[0].values()
    times = [float(gaps[-1][name]) for name in ("time_s", "other_time_s", "gap_s")]
    assert times[0] - times[1] == pytest.approx(times[2], abs=1e-12)
    assert next(tmp_path.glob("gaps_*.png")).read_bytes().startswith(b"\x89PNG")
    assert not list(tmp_path.glob("gaps_friction*"))
    assert race(tmp_path / "c") == 1
    assert "skisnow[racing]" in capsys.readouterr().err


def test_no_line_through_all_gates_exits_1(tmp_path: Path, capsys: Printed) -> None:
    assert race(tmp_path, "--evaluations", "1", "--set", "mu_0=0.9") == 1
    assert "not reached" in capsys.readouterr().out


def test_interrupted_it_says_where_the_races_are(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def stopped(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(Windows, "search_line", stopped)
    assert race(tmp_path, "--evaluations", "1") == 130
    assert not (tmp_path / "race.json").exists()


@pytest.mark.parametrize(
    ("more", "code"),
    [
        (["--gates", "21"], "out_of_range"),
        (["--line", "none.csv"], "cannot_read"),
        (["--snows", "2"], "no_data"),
        (["--against", "spoon", "--evaluations", "1"], "unknown_name"),
    ],
)
def test_what_is_refused(more: list[str], code: str, tmp_path: Path, noted_errors: list[SkisnowError]) -> None:
    assert race(tmp_path, "--evaluations", "1", *more) == 1
    assert noted_errors[-1].code == code
