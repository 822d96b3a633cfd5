"""``skisnow replay``: the page and both models of a run that was written, from the terminal only."""

from __future__ import annotations

from pathlib import Path
from typing import TypeAlias

import numpy as np
import pytest

from skisnow.cli import main
from skisnow.replay import moving_replay_model, replay_bytes, replay_model, replay_of_bytes, replay_of_file
from skisnow.report.run.file import write_run_file
from skisnow.report.run.page import run_page
from skisnow.scenario import scenario_values
from skisnow.scenario.keys import in_sections

from ..replay.held import held_replay
from ..report.runs import circle_run
from ..report.test_run_report import summary_of

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


def test_page_and_both_models_are_those_of_the_library(folder: Path, capsys: Printed) -> None:
    assert main(["replay", str(folder), "--model", "--moment-s", "1.5", "--exaggeration", "4"]) == 0
    told = [Path(line) for line in capsys.readouterr().out.splitlines()]
    assert told == [folder / "replay.html", folder / "replay.glb", folder / "replay-1.50s.glb"]
    replay = replay_of_file(folder)
    assert held_replay(told[0], "run") == replay_bytes(replay)
    assert told[1].read_bytes() == moving_replay_model(replay, exaggeration=4.0)
    assert told[2].read_bytes() == replay_model(replay, 1.5, exaggeration=4.0)


def test_a_second_run_and_a_track_stand_in_the_page(folder: Path, tmp_path: Path) -> None:
    track = tmp_path / "measured.csv"
    track.write_text("time_s,x_m,y_m\n10,0,0\n11,4,1\n12,8,3\n", encoding="utf-8")
    words = ["--over", str(folder), "--track", str(track), "--starts-at-s", "0.5", "--title", "Both"]
    assert main(["replay", str(folder), *words, "--out", str(tmp_path / "new")]) == 0
    page = tmp_path / "new" / "replay.html"
    shown = replay_of_bytes(held_replay(page, "run"))
    assert (shown.title, shown.track is not None and shown.track.name) == ("Both", "measured.csv")
    assert shown.track is not None and shown.track.time is not None
    assert shown.track.place.tolist() == [[0, 0, 0], [4, 1, 0], [8, 3, 0]]  # on the snow, as no height was measured
    # its first point is 0.5 s after the run began
    assert shown.track.time == pytest.approx(np.array([0.5, 1.5, 2.5]))
    assert held_replay(page, "ghost") == replay_bytes(replay_of_file(folder))
    assert sorted(each.name for each in folder.iterdir()) == ["run.nc"]


@pytest.mark.parametrize("language", ["en", "de"])
def test_a_report_that_lies_there_gets_the_link_once(folder: Path, language: str, capsys: Printed) -> None:
    """It is then the page that a run with its replay has."""
    run = circle_run(count=21)
    without, linked = (run_page(run, summary_of(run), [], has_replay=each, language=language) for each in (False, True))
    assert 'href="replay.html"' not in without
    page = folder / "report.html"
    page.write_text(without, encoding="utf-8")
    assert main(["replay", str(folder / "run.nc")]) == 0
    assert page.read_text(encoding="utf-8") == linked
    assert "report.html" in capsys.readouterr().err
    assert main(["replay", str(folder)]) == 0
    assert page.read_text(encoding="utf-8") == linked
    assert "link" not in capsys.readouterr().err


def test_a_page_that_is_no_report_of_a_run_stays_as_it_is(folder: Path, tmp_path: Path) -> None:
    run = circle_run(count=21)
    mine, report = "<p>my own page, about skisnow</p>", run_page(run, summary_of(run), [])
    (folder / "report.html").write_text(mine, encoding="utf-8")
    assert main(["replay", str(folder)]) == 0
    assert (folder / "report.html").read_text(encoding="utf-8") == mine
    (folder / "report.html").write_text(report, encoding="utf-8")
    assert main(["replay", str(folder), "--out", str(tmp_path / "new")]) == 0  # the page lies elsewhere
    assert (folder / "report.html").read_text(encoding="utf-8") == report


@pytest.mark.parametrize("words", [["{}"], ["--ghost", "{}"]])
def test_a_second_run_is_the_ghost_of_the_first(folder: Path, words: list[str], tmp_path: Path) -> None:
    named = [word.format(folder) for word in words]
    assert main(["replay", str(folder), *named, "--out", str(tmp_path / "new")]) == 0
    assert held_replay(tmp_path / "new" / "replay.html", "ghost") == replay_bytes(replay_of_file(folder))


def test_a_track_in_latitude_and_longitude_needs_the_fall_line(folder: Path, tmp_path: Path, capsys: Printed) -> None:
    """South is down: 0.0001° of latitude are 11.1 m along the fall line."""
    track = tmp_path / "measured.gpx"
    track.write_text(GPX, encoding="utf-8")
    assert main(["replay", str(folder), "--track", str(track)]) == 1
    assert FALL_LINE in capsys.readouterr().err
    assert main(["replay", str(folder), "--track", str(track), FALL_LINE, "180"]) == 0
    shown = replay_of_bytes(held_replay(folder / "replay.html", "run"))
    assert shown.track is not None
    # horizontally 11.1 m and 2 m down, on a plane of 10° in its own axes
    assert shown.track.place[1, 0] == pytest.approx(
        11.12 * np.cos(np.radians(10)) + 2 * np.sin(np.radians(10)), abs=0.05
    )
    assert abs(shown.track.place[1, 1]) < 1e-3


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--starts-at-s", "2"], "--track"),
        (["--exaggeration", "21"], "from 1 to 20"),
        (["--moment-s", "x"], "x"),
        (["other", "--ghost", "another"], "--ghost"),
    ],
)
def test_wrong_words_are_refused_before_anything_is_read(words: list[str], said: str, capsys: Printed) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["replay", "nowhere", *words])
    assert ended.value.code == 2
    assert said in capsys.readouterr().err


def test_a_folder_without_a_run_is_named(tmp_path: Path, capsys: Printed) -> None:
    assert main(["replay", str(tmp_path)]) == 1
    assert "run.nc" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


@pytest.mark.usefixtures("undrawn")
def test_models_of_an_earlier_run_do_not_stay_beside_a_new_one(folder: Path) -> None:
    from skisnow.report.run.folder import write_run

    assert main(["replay", str(folder), "--model", "--moment-s", "1"]) == 0
    write_run(circle_run(count=21), folder)
    assert not [each.name for each in folder.iterdir() if each.suffix == ".glb" or each.name == "replay.html"]
