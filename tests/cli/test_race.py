"""skisnow replay, race and track."""

import csv
import json
import sys
from pathlib import Path
from typing import TypeAlias

import numpy as np
import pytest

from skisnow._support.errors import SkisnowError
from skisnow.cli import main
from skisnow.cli.shell import json_schema
from skisnow.racing.windows import Windows
from skisnow.replay import replay_bytes, replay_of_file
from skisnow.report.figures.drawing import FORMS
from skisnow.report.run.file import write_run_file
from skisnow.report.run.page import run_page
from skisnow.scenario import scenario_values
from skisnow.scenario.keys import in_sections

from ..replay.held import held_replay, unpacked
from ..report.runs import circle_run
from ..report.test_run_report import summary_of
from ..track.paths import NOISE, circle
from .json_answer import json_answer

Printed: TypeAlias = pytest.CaptureFixture[str]
FALL_LINE = "--fall-line-azimuth-deg"
GPX = """<gpx version="1.1" creator="test" xmlns="http://www.topografix.com/GPX/1/1"><trk><trkseg>
<trkpt lat="47.0" lon="11.0"><ele>2000</ele><time>2026-01-10T10:00:00Z</time></trkpt>
<trkpt lat="46.9999" lon="11.0"><ele>1998</ele><time>2026-01-10T10:00:01Z</time></trkpt>
</trkseg></trk></gpx>"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    run = circle_run(count=21)
    place = tmp_path / "turn"
    place.mkdir()
    write_run_file(run, in_sections(scenario_values(run.scenario)), place / "run.nc")
    return place


def test_the_page_is_that_of_the_library(folder: Path, capsys: Printed) -> None:
    assert main(["replay", str(folder)]) == 0
    assert capsys.readouterr().out == f"{folder / 'replay.html'}\n"
    assert held_replay(folder / "replay.html", "run") == replay_bytes(replay_of_file(folder))


def test_a_second_run_and_a_track_are_in_the_page(folder: Path, tmp_path: Path) -> None:
    track = tmp_path / "measured.csv"
    track.write_text("time_s,x_m,y_m\n10,0,0\n11,4,1\n12,8,3\n", encoding="utf-8")
    words = [str(folder), "--track", str(track), "--starts-at-s", "0.5", "--title", "Both"]
    assert main(["replay", str(folder), *words, "--out", str(tmp_path / "new")]) == 0
    page = tmp_path / "new" / "replay.html"
    head, shown = unpacked(held_replay(page, "run"))
    assert (head["title"], head["track_name"]) == ("Both", "measured.csv")
    assert shown["track_place"].tolist() == [[0, 0, 0], [4, 1, 0], [8, 3, 0]]  # on the snow, as no height was measured
    # its first point is 0.5 s after the run began
    assert shown["track_time"] == pytest.approx(np.array([0.5, 1.5, 2.5]))
    assert held_replay(page, "ghost") == replay_bytes(replay_of_file(folder))
    assert sorted(each.name for each in folder.iterdir()) == ["run.nc"]


def test_a_page_that_is_no_report_of_a_run_stays_as_it_is(folder: Path, tmp_path: Path) -> None:
    run = circle_run(count=21)
    mine, report = "<p>my own page, about skisnow</p>", run_page(run, summary_of(run), [])
    (folder / "report.html").write_text(mine, encoding="utf-8")
    assert main(["replay", str(folder)]) == 0
    assert (folder / "report.html").read_text(encoding="utf-8") == mine
    (folder / "report.html").write_text(report, encoding="utf-8")
    assert main(["replay", str(folder), "--out", str(tmp_path / "new")]) == 0  # the page lies elsewhere
    assert (folder / "report.html").read_text(encoding="utf-8") == report


def test_a_second_run_is_the_ghost_of_the_first(folder: Path, tmp_path: Path) -> None:
    assert main(["replay", str(folder), str(folder), "--out", str(tmp_path / "new")]) == 0
    assert held_replay(tmp_path / "new" / "replay.html", "ghost") == replay_bytes(replay_of_file(folder))


def test_a_track_in_latitude_and_longitude_needs_the_fall_line(folder: Path, tmp_path: Path, capsys: Printed) -> None:
    """South is down: 0.0001° of latitude are 11.1 m along the fall line."""
    track = tmp_path / "measured.gpx"
    track.write_text(GPX, encoding="utf-8")
    assert main(["replay", str(folder), "--track", str(track)]) == 1
    assert FALL_LINE in capsys.readouterr().err
    assert main(["replay", str(folder), "--track", str(track), FALL_LINE, "180"]) == 0
    _, shown = unpacked(held_replay(folder / "replay.html", "run"))
    # horizontally 11.1 m and 2 m down, on a plane of 10° in its own axes
    assert shown["track_place"][1, 0] == pytest.approx(
        11.12 * np.cos(np.radians(10)) + 2 * np.sin(np.radians(10)), abs=0.05
    )
    assert abs(shown["track_place"][1, 1]) < 1e-3


def test_a_folder_without_a_run_is_named(tmp_path: Path, capsys: Printed) -> None:
    assert main(["replay", str(tmp_path)]) == 1
    assert "run.nc" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


EASY = [
    "race", "slalom-20-gates", "--set", "greatest_edge_deg=75", "--model", "point", "--gates", "2", "--workers", "1",
]  # fmt: skip


def race(out: Path, *more: str) -> int:
    return main([*EASY, "--out", str(out), *more])


def table(path: Path) -> list[dict[str, str]]:
    return list(csv.DictReader(path.read_text(encoding="utf-8").splitlines()))


def test_a_search_is_reported_and_written(tmp_path: Path, capsys: Printed) -> None:
    pytest.importorskip("cmaes")
    drawn = ("--snows", "2", "--snow-spread", "0.2")
    assert race(tmp_path / "a", "--evaluations", "25", "--seed", "3", *drawn) == 0
    out, _ = capsys.readouterr()
    assert "2 gates in" in out
    found = json.loads((tmp_path / "a" / "race.json").read_text(encoding="utf-8"))
    assert found["gained_s"] == pytest.approx(found["began_from_s"] - found["time_s"])
    assert found["gained_s"] > 0.0
    assert found["evaluations"] >= 25
    (margin,) = found["worth"]  # of the start line: one point on one snow has no spread
    assert margin["interval_s"] == pytest.approx([found["gained_s"]] * 2)
    assert margin["verdict"] == "slower"
    rows = table(tmp_path / "a" / "line.csv")
    assert [row["gate"] for row in rows] == ["1", "2"]
    assert [float(row["aside_m"]) for row in rows] == [turn["aside_m"] for turn in found["turns"]]
    assert (tmp_path / "a" / "lines.png").read_bytes().startswith(b"\x89PNG")
    again = tmp_path / "b"
    assert race(again, "--evaluations", "1", "--line", str(tmp_path / "a" / "line.csv"), "--json") == 0
    assert json.loads(capsys.readouterr().out)["time_s"] == pytest.approx(found["time_s"], abs=1e-9)


def test_variants_on_the_same_snows(tmp_path: Path, capsys: Printed, monkeypatch: pytest.MonkeyPatch) -> None:
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
def test_rejected_input(more: list[str], code: str, tmp_path: Path, noted_errors: list[SkisnowError]) -> None:
    assert race(tmp_path, "--evaluations", "1", *more) == 1
    assert noted_errors[-1].code == code


SCHEMA = json_schema("track")


@pytest.fixture
def turn(tmp_path: Path) -> Path:
    """5 s on a circle of 15 m to the left at 8 m/s, 10 Hz."""
    place = circle(15.0, 8.0, duration=5.0) + NOISE * np.random.default_rng(3).standard_normal((51, 2))
    rows = [f"{0.1 * number:.1f},{x:.4f},{y:.4f}" for number, (x, y) in enumerate(place)]
    path = tmp_path / "turn.csv"
    path.write_text("\n".join(["time_s,x_m,y_m", *rows, ""]), encoding="utf-8")
    return path


def test_json_is_the_contract(turn: Path, capsys: Printed) -> None:
    found = json_answer(["track", str(turn)], SCHEMA, capsys)
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


@pytest.mark.usefixtures("undrawn")
def test_figures_and_json_are_written(turn: Path, tmp_path: Path, capsys: Printed) -> None:
    out = tmp_path / "out"
    assert main(["track", str(turn), "--json", "--out", str(out)]) == 0
    assert json.loads((out / "track.json").read_text(encoding="utf-8")) == json.loads(capsys.readouterr().out)
    written = sorted(path.name for path in (out / "figures").iterdir())
    assert written == sorted(f"{name}.{form}" for name in ("along", "map", "radius", "speed") for form in FORMS)


def test_window_and_noise_are_obeyed(turn: Path, capsys: Printed, monkeypatch: pytest.MonkeyPatch) -> None:
    """Twice the noise is twice the interval of the curvature 1/r."""
    monkeypatch.setattr("skisnow.track.curvature.estimate_path", lambda *_: None)  # seconds, and only for the speed
    widths = []
    for noise in ("0.05", "0.1"):
        assert main(["track", str(turn), "--json", "--window-s", "2", "--noise-m", noise]) == 0
        found = json.loads(capsys.readouterr().out)
        assert found["smoothing"]["window_s"] == 2.0
        low, high = found["turns"][0]["least_radius_interval_m"]
        widths.append(1.0 / low - (0.0 if high is None else 1.0 / high))
    assert widths[1] == pytest.approx(2.0 * widths[0], rel=1e-6)


def test_tracks_with_too_few_points_are_rejected(turn: Path, tmp_path: Path, noted_errors: list[SkisnowError]) -> None:
    short = tmp_path / "short.csv"
    short.write_text("\n".join(turn.read_text(encoding="utf-8").splitlines()[:5]) + "\n", encoding="utf-8")
    absent = tmp_path / "absent.csv"
    for words, code in (([turn, "--window-s", "0.2"], "too_few_points"), ([short], "too_few_points"), ([absent], "")):
        assert main(["track", *map(str, words)]) == 1
        assert noted_errors[-1].code == code
