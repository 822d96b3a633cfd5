"""*Replay*: the runs that are kept, the form that puts two together, a track that is sent."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest

from skisnow.web.lab_tracks import TrackFolders

from ...replay.test_tracks import gpx
from .shared import TRACK, keep, keep_track

if TYPE_CHECKING:
    from ..desk import Desk, Sheet

ODD = 'a "b" \\n <i>&c\\'
ADDING = (
    "[quiet] CSV, GPX, FIT, NMEA, UBX or RTKLIB, up to 20 MB and 20000 points. A track in latitude and longitude needs "
    "the compass direction in which the slope falls; it begins where the run begins. One in the run's own axes (x down "
    "the fall line, y left, z out of the snow, in m) needs none, and stands where it says. Nothing is fitted."
)
BELOW = [
    "Add a measured track",
    ADDING,
    "Track",
    "Direction of the fall line (°), clockwise from north",
    "Time of the run at its first point (s)",
    "Add the track",
]


def options(page: Sheet, key: str) -> list[tuple[str, str, bool]]:
    """Value, words and whether it is chosen, of each entry of a menu."""
    (menu,) = (each for each in page.tagged("select") if each.props["name"] == key)
    assert menu.props["id"] == f"replay-{key}"
    found = [each.props for slot in menu.slots.values() for each in slot.children]
    return [(each["value"], each["label"], "selected" in each) for each in found]


def labels(page: Sheet) -> list[tuple[str, str]]:
    """What each label is for, and its words."""
    made = page.tagged("label")
    return [(each.props["for"], next(iter(each.default_slot.children)).text) for each in made if "for" in each.props]


def test_without_a_run_the_page_says_where_one_comes_from(desk: Desk) -> None:
    page = desk.open("/replay")
    assert page.outline() == [
        "h1 Replay",
        "[quiet] 0 runs kept, the newest first.",
        "Simulate one, then it can be watched here.",
        *BELOW,
    ]
    assert [each.text for each in page.of() if each.props.get("aria-current") == "page"] == ["Replay"]
    assert "<title>Replay · skisnow</title>" in page.html
    assert page.tagged("select") == []


def test_a_run_alone_is_listed_and_has_nothing_to_stand_beside(desk: Desk, run_files: dict[str, bytes]) -> None:
    """The turn goes on for 4 s at 8 m/s."""
    keep(desk.lab.runs, "a turn", run_files)
    page = desk.open("/replay")
    assert page.outline() == [
        "h1 Replay",
        "[quiet] 1 run kept, the newest first.",
        *BELOW,
        "h2 a turn",
        "[quiet] 32.0 m in 4.00 s, finished",
        "link[main] Watch -> /replay/show?run=a%20turn",
    ]
    assert [each.props["aria-label"] for each in page.of() if each.props.get("href", "").startswith("/replay/")] == [
        "Watch a turn"
    ]
    assert [each.tag for each in page.of() if "card" in each.classes] == ["section"]


def test_two_runs_are_put_together_the_newest_over_the_one_before(desk: Desk, run_files: dict[str, bytes]) -> None:
    keep(desk.lab.runs, "older", run_files, when=1_000_000_000)
    keep(desk.lab.runs, ODD, run_files, when=1_100_000_000)
    page = desk.open("/replay")
    assert page.outline()[1:8] == [
        "[quiet] 2 runs kept, the newest first.",
        "h2 Side by side",
        "Run",
        "Laid over it, translucent",
        "Measured track beside it",
        "Watch together",
        "Compare times at gates",
    ]
    assert page.outline()[14:16] == [f"h2 {ODD}", "[quiet] 32.0 m in 4.00 s, finished"]
    assert options(page, "run") == [(ODD, ODD, True), ("older", "older", False)]
    assert options(page, "ghost") == [("", "none", False), (ODD, ODD, False), ("older", "older", True)]
    assert options(page, "track") == [("", "none", True)]
    form = page.tagged("form")[0]
    assert form.props == {"action": "/replay/show", "method": "get"}
    together, compared, _ = page.tagged("button")
    assert together.props == {"type": "submit"}
    assert together.classes == ["act", "main"]
    assert compared.props == {"type": "submit", "formaction": "/replay/gates"}
    assert labels(page)[:3] == [
        ("replay-run", "Run"),
        ("replay-ghost", "Laid over it, translucent"),
        ("replay-track", "Measured track beside it"),
    ]
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
    assert page.outline()[1] == f"[good] The track {name} is kept. Choose the run that it is to stand beside."
    assert [each.props["role"] for each in page.of() if "good" in each.classes] == ["status"]
    assert options(page, "ghost")[0] == ("", "none", True)
    assert options(page, "track") == [("", "none", False), (name, name, True)]
    assert "[good]" not in "".join(desk.open("/replay?track=nothing").outline())


@pytest.mark.parametrize(
    ("summary", "words"),
    [
        (None, "without a readable summary"),
        ("{", "without a readable summary"),
        ("[]", "without a readable summary"),
        ('{"run_length_m": 1}', "without a readable summary"),
        ('{"run_length_m": null, "simulated_s": 1, "outcome": "x"}', "without a readable summary"),
        ('{"run_length_m": 12.345, "simulated_s": 1.2345, "outcome": "missed_gate"}', "12.3 m in 1.23 s, missed gate"),
    ],
)
def test_a_run_is_told_in_a_line(desk: Desk, run_files: dict[str, bytes], summary: str | None, words: str) -> None:
    place = keep(desk.lab.runs, "mine", run_files)
    (place / "summary.json").unlink()
    if summary is not None:
        (place / "summary.json").write_text(summary, encoding="utf-8")
    assert desk.open("/replay").outline()[-2] == f"[quiet] {words}"


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
    assert labels(page) == [
        ("track-file", "Track"),
        ("track-azimuth", "Direction of the fall line (°), clockwise from north"),
        ("track-start", "Time of the run at its first point (s)"),
    ]
    assert [each.props["type"] for each in page.tagged("button")] == ["submit"]


def test_a_track_is_taken_in_with_what_was_typed(desk: Desk, here: list[Any]) -> None:
    def taken(file: str, content: bytes = TRACK, **typed: str) -> dict[str, Any]:
        answer = desk.post("/replay/track", files={"file": (file, content)}, data=typed)
        name = TrackFolders(desk.lab.runs).names()[0]
        assert (answer.status_code, answer.headers["location"]) == (303, f"/replay?track={name}")
        found: dict[str, Any] = json.loads((desk.lab.runs / "tracks" / name / "about.json").read_text("utf-8"))
        (desk.lab.runs / "tracks" / name / "about.json").unlink()
        return found

    assert taken("Hang 3.csv") == {"called": "Hang 3.csv", "fall_line_azimuth_deg": None, "starts_at_s": 0.0}
    with_start = taken("a.csv", start="2,5", azimuth="")
    assert with_start == {"called": "a.csv", "fall_line_azimuth_deg": None, "starts_at_s": 2.5}
    turned = taken("a.gpx", gpx([(0, 0), (1, 1)]), azimuth="−90", start="")
    assert turned == {"called": "a.gpx", "fall_line_azimuth_deg": -90.0, "starts_at_s": 0.0}
    assert taken(f"{'a' * 250}.csv")["called"] == "a" * 200
    assert [bounds.seconds for bounds, *_ in here] == [120.0] * 4


@pytest.mark.usefixtures("here")
@pytest.mark.parametrize(
    ("files", "typed", "told"),
    [
        ([("file", ("a.csv", TRACK))] * 2, {}, "one file at a time is taken in."),
        ([("other", ("a.csv", TRACK))], {}, "no file was chosen; choose the file of a track"),
        ([("file", ("a.csv", TRACK))], {"azimuth": "x"}, "the direction of the fall line: &#x27;x&#x27; is no number"),
        ([("file", ("a.csv", TRACK))], {"start": "x"}, "the time at the first point: &#x27;x&#x27; is no number"),
        (
            [("file", ("a.csv", TRACK))],
            {"start": "36001"},
            "the start of the track is 36001 s; it must be within 36000 s",
        ),
    ],
)
def test_what_is_no_track_is_told_on_a_page(desk: Desk, files: list[Any], typed: dict[str, str], told: str) -> None:
    answer = desk.post("/replay/track", files=files, data=typed)
    assert answer.status_code == 400
    assert f"<h1>This was not taken in</h1><p>Nothing was stored: {told}" in answer.text
    assert TrackFolders(desk.lab.runs).names() == []


def test_a_track_without_a_file_is_told_on_a_page(desk: Desk) -> None:
    answer = desk.post("/replay/track", data={"file": "a.csv"})
    assert answer.status_code == 400
    assert "Nothing was stored: no file was chosen; choose the file of a track" in answer.text
