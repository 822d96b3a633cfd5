"""Tracks that are kept, and what the addresses of a run answer."""

from __future__ import annotations

import io
import json
import math
import os
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from skisnow._support.errors import OutputError, ParameterError
from skisnow.replay import moving_replay_model, replay_bytes, replay_model, replay_of_file, replay_of_run
from skisnow.replay.page import in_language, static_text
from skisnow.report.race.folder import gaps_of_folders
from skisnow.ski import read_ski
from skisnow.track.read import read_track
from skisnow.web import lab_tracks, replay_addresses
from skisnow.web.lab_skis import LabSkis
from skisnow.web.lab_tracks import Placing, TrackFolders, points_of_track, track_on_slope
from skisnow.web.replay_addresses import RunFolders, program_file, show_address, show_page
from tests.coded import raises

from ....report.runs import circle_run
from ...replay.test_tracks import gpx
from .shared import TRACK, keep, keep_track

if TYPE_CHECKING:
    from ..desk import Desk


def test_tracks_are_listed_the_newest_first_without_what_is_half_there(tmp_path: Path) -> None:
    folders = TrackFolders(tmp_path)
    assert folders.names() == []
    older, newer = keep_track(tmp_path, "z.csv"), keep_track(tmp_path, "a.csv")
    for name, when in ((older, 1_000_000_000), (newer, 1_100_000_000)):
        os.utime(tmp_path / "tracks" / name / "about.json", (when, when))
    (tmp_path / "tracks" / ".partial-x").mkdir()
    (tmp_path / "tracks" / ".partial-x" / "about.json").touch()
    (tmp_path / "tracks" / "empty").mkdir()
    assert folders.names() == [newer, older]
    assert newer[:2] == "a-" and len(newer) == 6
    assert sorted(each.name for each in (tmp_path / "tracks" / newer).iterdir()) == ["about.json", "track.csv"]


def test_a_track_keeps_an_ending_that_says_how_it_is_read(tmp_path: Path) -> None:
    files = []
    for called in ("a.CSV", "b.odd", "c"):
        name, _ = TrackFolders(tmp_path).keep(io.BytesIO(TRACK), Placing(called))
        files += [each.name for each in (tmp_path / "tracks" / name).iterdir() if each.name != "about.json"]
    assert files == ["track.csv", "track", "track"]
    name, _ = TrackFolders(tmp_path).keep(io.BytesIO(TRACK), Placing("Hütte.csv"))
    about = json.loads((tmp_path / "tracks" / name / "about.json").read_text(encoding="utf-8"))
    assert list(about.values()) == ["Hütte.csv", None, 0.0]


def test_no_more_tracks_than_the_lab_can_list(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lab_tracks, "MOST_TRACKS", 1)
    keep_track(tmp_path)
    with raises(ParameterError, "too_many_files", most=1):
        keep_track(tmp_path)


def test_tracks_of_a_folder_that_cannot_be_written_are_refused(tmp_path: Path) -> None:
    (tmp_path / "tracks").write_bytes(b"")
    with raises(OutputError, "cannot_write"):
        keep_track(tmp_path)


def test_a_track_is_no_longer_and_no_larger_than_allowed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    rows = b"".join(b"%d,%d,0,0\n" % (i, i) for i in range(3))
    monkeypatch.setattr(lab_tracks, "MOST_POINTS", 3)
    folders = TrackFolders(tmp_path)
    content = b"time_s,x_m,y_m,z_m\n" + rows
    assert folders.keep(io.BytesIO(content), Placing("x.csv"))[1] == 3
    with raises(ParameterError, "too_many_points", points=4, most=3):
        folders.keep(io.BytesIO(content + b"3,3,0,0\n"), Placing("x.csv"))
    (tmp_path / "long.csv").write_bytes(content + b"3,3,0,0\n")
    with raises(ParameterError, "too_many_points", points=4):
        track_on_slope(tmp_path / "long.csv", Placing("x.csv"), 0.0)
    monkeypatch.setattr(lab_tracks, "LARGEST_TRACK_BYTES", 2_000_000)
    monkeypatch.setattr(lab_tracks, "_CHUNK", 1_500_000)
    counted = folders.keep(io.BytesIO(bytes(2_000_000)), Placing("x.csv"), count=lambda place, _: place.stat().st_size)
    assert counted[1] == 2_000_000
    with raises(ParameterError, "too_large", most=2):
        folders.keep(io.BytesIO(bytes(2_000_001)), Placing("x.csv"), count=lambda *_: 1)


@pytest.mark.parametrize(
    ("placing", "is_allowed"),
    [
        (Placing("x.csv", 360.0), True),
        (Placing("x.csv", -360.0), True),
        (Placing("x.csv", 360.5), False),
        (Placing("x.csv", -360.5), False),
        (Placing("x.csv", math.nan), False),
        (Placing("x.csv", None, math.nan), False),
        (Placing("x.csv", None, -36_000.5), False),
    ],
)
def test_what_places_a_track_is_within_limits(tmp_path: Path, placing: Placing, is_allowed: bool) -> None:
    def kept() -> None:
        TrackFolders(tmp_path).keep(io.BytesIO(b""), placing, count=lambda *_: 0)

    if is_allowed:
        kept()
    else:
        with raises(ParameterError, "out_of_range"):
            kept()


def test_a_track_is_placed_by_what_it_is_in(tmp_path: Path) -> None:
    """To the east down a plane of 60°: a metre east is two along it; towards the north is left."""
    (tmp_path / "own.csv").write_bytes(TRACK)
    (tmp_path / "earth.gpx").write_bytes(gpx([(0, 0), (10, 0), (10, 5)]))
    own = track_on_slope(tmp_path / "own.csv", Placing("own.csv", None, 3.0), 1.0)
    assert own.place.tolist() == [[1.0, 2.0, 0.1], [4.0, 6.0, 0.2]]
    assert (own.name, list(own.time if own.time is not None else ())) == ("own.csv", [3.0, 4.0])
    earth = track_on_slope(tmp_path / "earth.gpx", Placing("x.gpx", 90.0), math.radians(60.0))
    assert earth.place[:, :2] == pytest.approx(np.array([[0, 0], [20, 0], [20, 5]]), rel=5e-3, abs=1e-3)
    assert points_of_track(tmp_path / "earth.gpx", Placing("x.gpx", 90.0)) == 3
    with raises(ParameterError, "no_direction"):
        points_of_track(tmp_path / "earth.gpx", Placing("mine.gpx"))
    slope = replace(read_track(tmp_path / "own.csv"), axes="slope")
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(lab_tracks, "read_track", lambda _: slope)
        with raises(ParameterError, "needless_direction"):
            points_of_track(tmp_path / "own.csv", Placing("mine.csv", 90.0))
    (tmp_path / "track.csv").write_bytes(b"nonsense")
    with pytest.raises(ParameterError) as found:
        points_of_track(tmp_path / "track.csv", Placing("mine.csv"))
    assert str(tmp_path) not in str(found.value) and "track.csv" not in str(found.value)
    assert "mine.csv" in str(found.value)


def test_a_track_is_turned_to_the_slope_of_its_run(tmp_path: Path) -> None:
    """A plane has an angle, a measured profile its heights."""
    name, shown = keep_track(tmp_path), replay_of_run(circle_run(count=11))
    given: list[Any] = []

    def read(*what: Any) -> Any:
        given.append(what)

    TrackFolders(tmp_path).beside(name, shown, read=read)
    TrackFolders(tmp_path).beside(name, replace(shown, profile=np.zeros((2, 2))), read=read)
    place = tmp_path / "tracks" / name / "track.csv"
    assert given == [(place, Placing("measured.csv"), shown.tilt), (place, Placing("measured.csv"), None)]
    assert shown.tilt == pytest.approx(math.radians(10.0))
    with raises(ParameterError, "unknown_track"):
        TrackFolders(tmp_path).beside("x", shown)


def test_a_run_is_fetched_with_its_track_and_in_the_readers_language(
    desk: Desk, run_files: dict[str, bytes], here: list[Any]
) -> None:
    keep(desk.lab.runs, "mine", run_files)
    name = keep_track(desk.lab.runs, starts_at_s=2.0)
    alone = replay_of_file(desk.lab.runs / "mine", title="mine")
    answer = desk.get("/replay/data/mine")
    assert answer.content == replay_bytes(alone)
    assert answer.headers["content-type"] == "application/octet-stream"
    assert answer.headers["cache-control"] == "no-cache"
    assert desk.get("/replay/data/mine", "de").content == replay_bytes(in_language(alone, "de"))
    assert here == []
    track = lab_tracks.track_on_slope(
        desk.lab.runs / "tracks" / name / "track.csv", Placing("measured.csv", None, 2.0), 0.0
    )
    beside = replay_of_file(desk.lab.runs / "mine", title="mine", track=track)
    assert desk.get(f"/replay/data/mine?track={name}").content == replay_bytes(beside)
    assert [bounds.seconds for bounds, *_ in here] == [120.0]
    for path, code in (("/replay/data/mine?track=x", "unknown_track"), ("/replay/data/x", "unknown_run")):
        assert (desk.get(path).status_code, desk.code) == (404, code)


def test_a_run_has_the_ski_that_its_job_names(desk: Desk, run_files: dict[str, bytes]) -> None:
    LabSkis(desk.lab.runs).save_texts("mine", LabSkis(desk.lab.runs).texts("slalom")[0], "")
    word = LabSkis(desk.lab.runs).word("mine")
    place = keep(desk.lab.runs, "run", run_files)
    (place / "job.json").write_text(json.dumps({"changes": {"ski.file": word}}), encoding="utf-8")
    expected = replay_of_file(place, title="run", ski=read_ski(word))
    assert replay_bytes(RunFolders(desk.lab.runs).replay("run")) == replay_bytes(expected)
    assert replay_bytes(expected) != replay_bytes(replay_of_file(place, title="run"))
    for job in ("{", "[]", '{"changes": {}}', "null"):
        (place / "job.json").write_text(job, encoding="utf-8")
        assert replay_bytes(RunFolders(desk.lab.runs).replay("run")) == replay_bytes(replay_of_file(place, title="run"))


@pytest.mark.usefixtures("here")
def test_a_run_with_a_track_beside_it_keeps_its_ski(desk: Desk, run_files: dict[str, bytes]) -> None:
    LabSkis(desk.lab.runs).save_texts("mine", LabSkis(desk.lab.runs).texts("slalom")[0], "")
    word = LabSkis(desk.lab.runs).word("mine")
    place = keep(desk.lab.runs, "run", run_files)
    (place / "job.json").write_text(json.dumps({"changes": {"ski.file": word}}), encoding="utf-8")
    found = RunFolders(desk.lab.runs).replay("run", keep_track(desk.lab.runs))
    assert found.track is not None
    assert found.track.name == "measured.csv"
    expected = replay_of_file(place, title="run", ski=read_ski(word))
    assert replay_bytes(replace(found, track=None)) == replay_bytes(expected)


def test_models_are_those_of_the_library(desk: Desk, run_files: dict[str, bytes]) -> None:
    keep(desk.lab.runs, "a b", run_files)
    shown = replay_of_file(desk.lab.runs / "a b", title="a b")
    still, moving = desk.get("/replay/model/a%20b.glb"), desk.get("/replay/moving-model/a%20b.glb")
    assert still.content == replay_model(shown, 0.0, exaggeration=1.0)
    assert moving.content == moving_replay_model(shown, exaggeration=1.0)
    assert "a%20b-0.00s.glb" in still.headers["content-disposition"]
    assert "a%20b.glb" in moving.headers["content-disposition"]
    assert {each.headers["content-type"] for each in (still, moving)} == {"model/gltf-binary"}
    at = desk.get("/replay/model/a%20b.glb?time=1.5&exaggeration=2")
    assert at.content == replay_model(shown, 1.5, exaggeration=2.0)
    for path in ("model", "moving-model"):
        assert (desk.get(f"/replay/{path}/x.glb").status_code, desk.code) == (404, "unknown_run")


def test_the_page_of_a_run_names_what_it_fetches(desk: Desk, run_files: dict[str, bytes]) -> None:
    keep(desk.lab.runs, "mine", run_files)
    keep(desk.lab.runs, "a b", run_files)
    answer = desk.get("/replay/show?run=mine")
    assert answer.text == show_page("mine", None)
    for path in ("data/mine", "model/mine.glb", "moving-model/mine.glb", "files/replay.css"):
        assert f'"/replay/{path}"' in answer.text
    assert "data-ghost" not in answer.text
    answer = desk.get("/replay/show?run=a%20b&ghost=mine&track=c%2Fd", "de")
    assert answer.text == show_page("a b", "mine", "c/d", "de")
    assert 'data-ghost="/replay/data/mine"' in answer.text and "?track=c%2Fd" in answer.text
    for query in ("run=x", "run=mine&ghost=x"):
        assert (desk.get(f"/replay/show?{query}").status_code, desk.code) == (404, "unknown_run")
    assert show_address("a/b", "c/d").partition("?")[2] == "run=a%2Fb&ghost=c%2Fd"


def test_times_at_gates_are_asked_of_both_folders(
    desk: Desk, run_files: dict[str, bytes], monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("mine", "theirs"):
        keep(desk.lab.runs, name, run_files)
    given: list[Any] = []

    def page(most: Any, work: Any, *what: Any) -> str:
        given.append((most.seconds, work, *what))
        return "<p>so</p>"

    monkeypatch.setattr(replay_addresses, "confined", page)
    answer = desk.get("/replay/gates?run=mine&ghost=theirs", "de")
    assert (answer.status_code, answer.text) == (200, "<p>so</p>")
    assert answer.headers["content-type"].startswith("text/html")
    places = (desk.lab.runs / "mine", desk.lab.runs / "theirs")
    assert given == [(120.0, gaps_of_folders, *places, "de")]
    assert (desk.get("/replay/gates?run=mine").status_code, desk.code) == (404, "unknown_run")


def test_files_of_the_program_are_given_out_as_they_are() -> None:
    for name, kind in (("replay.js", "text/javascript; charset=utf-8"), ("replay.css", "text/css; charset=utf-8")):
        answer = program_file(name)
        assert bytes(answer.body).decode("utf-8") == static_text(name)
        assert (answer.headers["content-type"], answer.headers["cache-control"]) == (kind, "no-cache")
    refused = program_file("show.html")
    assert (refused.status_code, bytes(refused.body)) == (404, b"The replay has no such file.")
