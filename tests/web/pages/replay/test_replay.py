"""*Replay*: the runs that are kept, the form that puts two together, a track that is sent."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest

from skisnow.web.lab_tracks import TrackFolders
from skisnow.web.replay_addresses import show_address

from ...replay.test_tracks import gpx
from .shared import TRACK, keep, keep_track

if TYPE_CHECKING:
    from ..desk import Desk, Sheet

ODD = 'a "b" \\n <i>&c\\'


def options(page: Sheet, key: str) -> list[tuple[str, str, bool]]:
    """Value, words and whether it is chosen, of each entry of a menu."""
    (menu,) = (each for each in page.tagged("select") if each.props["name"] == key)
    assert menu.props["id"] == f"replay-{key}"
    found = [each.props for slot in menu.slots.values() for each in slot.children]
    return [(each["value"], each["label"], "selected" in each) for each in found]


def labels(page: Sheet) -> list[tuple[str, str]]:
    """The field of each label, and its words."""
    made = page.tagged("label")
    return [(each.props["for"], next(iter(each.default_slot.children)).text) for each in made if "for" in each.props]


def test_without_a_run_there_is_nothing_to_choose(desk: Desk) -> None:
    page = desk.open("/replay")
    assert [each.text for each in page.of() if each.props.get("aria-current") == "page"] == ["Replay"]
    assert page.tagged("select") == []


def test_a_run_alone_is_listed_and_has_nothing_to_stand_beside(desk: Desk, run_files: dict[str, bytes]) -> None:
    """The turn goes on for 4 s at 8 m/s."""
    keep(desk.lab.runs, "a turn", run_files)
    page = desk.open("/replay")
    lines = page.outline()
    assert lines[lines.index("h2 a turn") + 1].startswith("[quiet] 32.0 m in 4.00 s, ")
    assert page.link("Watch") == show_address("a turn")
    (watch,) = (each for each in page.of() if each.props.get("href") == show_address("a turn"))
    assert watch.props["aria-label"].endswith(" a turn")
    assert page.tagged("select") == []


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


def test_a_track_that_was_taken_in_is_chosen_for_a_run_alone(desk: Desk, run_files: dict[str, bytes]) -> None:
    keep(desk.lab.runs, "older", run_files)
    name = keep_track(desk.lab.runs)
    page = desk.open("/replay")
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
def test_a_run_is_told_in_a_line(desk: Desk, run_files: dict[str, bytes], summary: str | None, words: str) -> None:
    place = keep(desk.lab.runs, "mine", run_files)
    (place / "summary.json").unlink()
    if summary is not None:
        (place / "summary.json").write_text(summary, encoding="utf-8")
    assert desk.open("/replay").outline()[-2].startswith(f"[quiet] {words}")


def test_a_track_is_sent_by_a_form_that_needs_no_script(desk: Desk) -> None:
    page = desk.open("/replay")
    (form,) = page.tagged("form")
    assert form.props == {"method": "post", "action": "/replay/track", "enctype": "multipart/form-data"}
    assert [each.props for each in page.tagged("input")] == [
        {"id": "track-file", "name": "file", "type": "file", "required": True},
        {"id": "track-azimuth", "name": "azimuth", "inputmode": "decimal"},
        {"id": "track-start", "name": "start", "inputmode": "decimal", "value": "0"},
    ]
    assert [each.classes for each in page.tagged("input")] == [[], ["act", "plain"], ["act", "plain"]]
    assert [name for name, _ in labels(page)] == ["track-file", "track-azimuth", "track-start"]
    assert [each.props["type"] for each in page.tagged("button")] == ["submit"]


def test_a_track_is_taken_in_with_what_was_typed(desk: Desk, here: list[Any]) -> None:
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
def test_what_is_no_track_is_refused(desk: Desk, form: dict[str, Any], code: str) -> None:
    assert desk.post("/replay/track", **form).status_code == 400
    assert desk.code == code
    assert TrackFolders(desk.lab.runs).names() == []
