"""*Replay*: the runs that are kept, the form that puts two together, a track that is sent."""

import io
import json
import math
import os
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.replay import replay_bytes, replay_of_file, replay_of_run
from skisnow.replay.page import in_language
from skisnow.report.run.file import write_run_file
from skisnow.scenario import scenario_values
from skisnow.scenario.keys import in_sections
from skisnow.simulation.run_summary import summary_dict
from skisnow.ski import read_ski
from skisnow.track.read import read_track
from skisnow.web import lab_tracks
from skisnow.web.lab_skis import LabSkis
from skisnow.web.lab_tracks import Placing, TrackFolders, check_track, track_on_slope
from skisnow.web.replay_addresses import RunFolders, show_address, show_page
from tests.coded import raises

from ....report.runs import circle_run
from ...replay.test_addresses import gpx
from ..desk import Desk, Sheet, in_this_process

TRACK = b"time_s,x_m,y_m,z_m\n0,1,2,0.1\n1,4,6,0.2\n"
ODD = 'a "b" \\n <i>&c\\'


@pytest.fixture(scope="module")
def run_files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """Files of a turn as the command leaves them."""
    place, run = tmp_path_factory.mktemp("run") / "run.nc", circle_run(count=11)
    write_run_file(run, in_sections(scenario_values(run.scenario)), place)
    summary = json.dumps(summary_dict(run), allow_nan=False)
    return {"run.nc": place.read_bytes(), "summary.json": summary.encode()}


@pytest.fixture
def here(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """Read sent files in this process; gives limits, work and its arguments."""
    return in_this_process(monkeypatch, "replay_addresses")


def options(page: Sheet, key: str) -> list[tuple[str, str, bool]]:
    """Value, words and whether it is chosen, of each entry of a menu."""
    (menu,) = (each for each in page.tagged("select") if each.props["id"] == f"replay-{key}")
    assert menu.props["name"] == key
    found = [each.props for slot in menu.slots.values() for each in slot.children]
    return [(each["value"], each["label"], "selected" in each) for each in found]


def labels(page: Sheet) -> list[tuple[str, str]]:
    """The field of each label, and its words."""
    made = page.tagged("label")
    return [(each.props["for"], next(iter(each.default_slot.children)).text) for each in made if "for" in each.props]


def test_two_runs_are_put_together_the_newest_over_the_one_before(desk: Desk, run_files: dict[str, bytes]) -> None:
    keep(desk.lab.runs, "older", run_files, when=1_000_000_000)
    keep(desk.lab.runs, ODD, run_files, when=1_100_000_000)
    page = desk.open("/replay")
    lines = page.outline()
    assert lines.index(f"h2 {ODD}") < lines.index("h2 older")
    assert options(page, "run") == [(ODD, ODD, True), ("older", "older", False)]
    assert options(page, "ghost") == [("", "none", False), (ODD, ODD, False), ("older", "older", True)]
    assert options(page, "track") == [("", "none", True)]
    form = page.tagged("form")[0]
    assert form.props == {"action": "/replay/show", "method": "get"}
    together, compared, _ = page.tagged("button")
    assert together.props == {"type": "submit"}
    assert together.classes == ["act", "main"]
    assert compared.props == {"type": "submit", "formaction": "/replay/gates"}
    assert [name for name, _ in labels(page)][:3] == ["replay-run", "replay-ghost", "replay-track"]
    assert options(desk.open("/replay", "de"), "track") == [("", "keine", True)]


def test_a_track_that_was_imported_is_chosen_for_a_run_alone(desk: Desk, run_files: dict[str, bytes]) -> None:
    keep(desk.lab.runs, "older", run_files)
    (form,) = desk.open("/replay").tagged("details")
    assert "open" in form.props
    name = keep_track(desk.lab.runs)
    page = desk.open("/replay")
    assert "open" not in page.tagged("details")[0].props
    assert page.outline()[2] == "h2 Side by side"
    assert options(page, "ghost") == [("", "none", True), ("older", "older", False)]
    assert options(page, "track") == [("", "none", True), (name, name, False)]
    keep(desk.lab.runs, "newer", run_files, when=1_100_000_000)
    page = desk.open(f"/replay?track={name}")
    assert name in page.shows("[good]")
    assert [each.props["role"] for each in page.of() if "good" in each.classes] == ["status"]
    assert options(page, "ghost")[0] == ("", "none", True)
    assert options(page, "track") == [("", "none", False), (name, name, True)]
    assert "[good]" not in "".join(desk.open("/replay?track=nothing").outline())
    page.press(f"Remove {name}")
    assert TrackFolders(desk.lab.runs).names() == []


def test_a_track_without_direction_has_turns_and_no_run_next_to_it(desk: Desk, run_files: dict[str, bytes]) -> None:
    keep(desk.lab.runs, "older", run_files)
    own = keep_track(desk.lab.runs)
    without, placed = (
        TrackFolders(desk.lab.runs).keep(io.BytesIO(gpx([(0, 0), (9, 0)])), Placing("x.gpx", azimuth))
        for azimuth in (None, 90.0)
    )
    page = desk.open(f"/replay?track={without}")
    assert {name for name, _, _ in options(page, "track")} == {"", own, placed}
    files = [str(each.props["href"]) for each in page.of() if "/replay/turns" in str(each.props.get("href"))]
    assert [name for name in (own, without, placed) if any("track.gpx" in f and name in f for f in files)] == [
        without,
        placed,
    ]
    assert sum(f"/{without}/" in each or each.endswith(f"={without}") for each in files) == 3


@pytest.mark.parametrize(
    ("summary", "words"),
    [
        (None, "without"),
        ("{", "without"),
        ("[]", "without"),
        ('{"run_length_m": 1}', "without"),
        (json.dumps({"run_length_m": None, "simulated_s": 1, "outcome": "x"}), "without"),
        (json.dumps({"run_length_m": 12.345, "simulated_s": 1.2345, "outcome": "missed_gate"}), "12.3 m in 1.23 s, "),
    ],
)
def test_a_run_is_reported_in_a_line(desk: Desk, run_files: dict[str, bytes], summary: str | None, words: str) -> None:
    place = keep(desk.lab.runs, "mine", run_files)
    (place / "summary.json").unlink()
    if summary is not None:
        (place / "summary.json").write_text(summary, encoding="utf-8")
    assert desk.open("/replay").outline()[-2].startswith(f"[quiet] {words}")


def test_a_track_is_imported_with_what_was_typed(desk: Desk, here: list[Any]) -> None:
    def taken(file: str, content: bytes = TRACK, **typed: str) -> tuple[str, float | None, float]:
        answer = desk.post("/replay/track", files={"file": (file, content)}, data=typed)
        name = TrackFolders(desk.lab.runs).names()[0]
        assert (answer.status_code, answer.headers["location"]) == (303, f"/replay?track={name}")
        found = json.loads((desk.lab.runs / "tracks" / name / "about.json").read_text("utf-8"))
        (desk.lab.runs / "tracks" / name / "about.json").unlink()
        return found["called"], found["fall_line_azimuth_deg"], found["starts_at_s"]

    assert taken("Hang 3.csv") == ("Hang 3.csv", None, 0.0)
    assert taken("a.csv", start="2,5", azimuth="") == ("a.csv", None, 2.5)
    assert taken("a.gpx", gpx([(0, 0), (1, 1)]), azimuth="−90", start="") == ("a.gpx", -90.0, 0.0)
    assert taken(f"{'a' * 250}.csv")[0] == "a" * 200
    assert [bounds.seconds for bounds, *_ in here] == [120.0] * 4


@pytest.mark.usefixtures("here")
@pytest.mark.parametrize(
    ("form", "code"),
    [
        ({"files": [("file", ("a.csv", TRACK))] * 2}, ""),
        ({"files": [("other", ("a.csv", TRACK))]}, "no_file"),
        ({"files": [("file", ("a.csv", TRACK))], "data": {"azimuth": "x"}}, "not_a_number"),
        ({"files": [("file", ("a.csv", TRACK))], "data": {"start": "x"}}, "not_a_number"),
        ({"files": [("file", ("a.csv", TRACK))], "data": {"start": "36001"}}, "out_of_range"),
        ({"data": {"file": "a.csv"}}, "no_file"),
    ],
)
def test_an_invalid_track_is_rejected(desk: Desk, form: dict[str, Any], code: str) -> None:
    answer = desk.post("/replay/track", **form)
    assert answer.status_code == 400
    assert 'href="/replay"' in answer.text  # back to the form
    assert desk.code == code
    assert TrackFolders(desk.lab.runs).names() == []


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
    assert (older, newer, keep_track(tmp_path, "a.csv")) == ("z", "a", "a-2")
    assert sorted(each.name for each in (tmp_path / "tracks" / newer).iterdir()) == ["about.json", "track.csv"]


def test_a_track_is_no_longer_and_no_larger_than_allowed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    rows = b"".join(b"%d,%d,0,0\n" % (i, i) for i in range(3))
    monkeypatch.setattr(lab_tracks, "MOST_POINTS", 3)
    folders = TrackFolders(tmp_path)
    content = b"time_s,x_m,y_m,z_m\n" + rows
    folders.keep(io.BytesIO(content), Placing("x.csv"))
    with raises(ParameterError, "too_many_points", points=4, most=3):
        folders.keep(io.BytesIO(content + b"3,3,0,0\n"), Placing("x.csv"))
    (tmp_path / "long.csv").write_bytes(content + b"3,3,0,0\n")
    with raises(ParameterError, "too_many_points", points=4):
        track_on_slope(tmp_path / "long.csv", Placing("x.csv"), 0.0)
    monkeypatch.setattr(lab_tracks, "LARGEST_TRACK_BYTES", 2_000_000)
    kept = folders.keep(io.BytesIO(bytes(2_000_000)), Placing("x.csv"), check=lambda _, placing: placing)
    assert folders.file(kept)[0].stat().st_size == 2_000_000
    with raises(ParameterError, "too_large", most=2):
        folders.keep(io.BytesIO(bytes(2_000_001)), Placing("x.csv"), check=lambda _, placing: placing)


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
        TrackFolders(tmp_path).keep(io.BytesIO(b""), placing, check=lambda _, placing: placing)

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
    assert check_track(tmp_path / "earth.gpx", Placing("x.gpx")).is_geodetic
    with raises(ParameterError, "no_direction"):
        track_on_slope(tmp_path / "earth.gpx", Placing("mine.gpx"), 0.0)
    slope = replace(read_track(tmp_path / "own.csv"), axes="slope")
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(lab_tracks, "read_track", lambda _: slope)
        with raises(ParameterError, "needless_direction"):
            check_track(tmp_path / "own.csv", Placing("mine.csv", 90.0))
    (tmp_path / "track.csv").write_bytes(b"nonsense")
    with pytest.raises(ParameterError) as found:
        check_track(tmp_path / "track.csv", Placing("mine.csv"))
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


def test_a_run_has_its_track_and_the_readers_language(desk: Desk, run_files: dict[str, bytes], here: list[Any]) -> None:
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


def test_the_page_of_a_run_names_what_it_fetches(desk: Desk, run_files: dict[str, bytes]) -> None:
    keep(desk.lab.runs, "mine", run_files)
    keep(desk.lab.runs, "a b", run_files)
    answer = desk.get("/replay/show?run=mine")
    assert answer.text == show_page("mine", None)
    for path in ("data/mine", "files/replay.css"):
        assert f'"/replay/{path}"' in answer.text
    assert "data-ghost" not in answer.text
    answer = desk.get("/replay/show?run=a%20b&ghost=mine&track=c%2Fd", "de")
    assert answer.text == show_page("a b", "mine", "c/d", "de")
    assert 'data-ghost="/replay/data/mine"' in answer.text and "?track=c%2Fd" in answer.text
    for query in ("run=x", "run=mine&ghost=x"):
        assert (desk.get(f"/replay/show?{query}").status_code, desk.code) == (404, "unknown_run")
    assert show_address("a/b", "c/d").partition("?")[2] == "run=a%2Fb&ghost=c%2Fd"


def keep(runs: Path, name: str, files: dict[str, bytes], *, when: int = 1_000_000_000) -> Path:
    """A run in the lab's folder."""
    place = runs / name
    place.mkdir(parents=True)
    for file, content in files.items():
        (place / file).write_bytes(content)
    os.utime(place / "run.nc", (when, when))
    return place


def keep_track(runs: Path, called: str = "measured.csv", **placed: Any) -> str:
    return TrackFolders(runs).keep(io.BytesIO(TRACK), Placing(called, **placed))
