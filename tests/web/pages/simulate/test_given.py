"""*Simulate*: the ski, course and snow that go with a run, and the cards of the queue."""

import io
import json
import math
import os
import threading
from pathlib import Path
from typing import Any

import pytest
from nicegui import ui

from skisnow._support.errors import ParameterError
from skisnow.snow import snow_from_results
from skisnow.track.course import course_names
from skisnow.web import scenario_fields
from skisnow.web.lab_skis import LabSkis
from skisnow.web.lab_tracks import LabCourses, gates_of
from skisnow.web.pages.simulate import _Card
from skisnow.web.replay_addresses import show_address
from skisnow.web.runs import Job, Runs
from skisnow.web.scenario_fields import campaign_snow
from tests.coded import raises

from ...campaign_texts import SHEARED
from ..desk import Desk, in_this_process
from .shared import ENDS, GIVEN, HARDNESS, NUMBERS, STEERS, STRESS, asked, campaign, jobs, refused


def test_a_ski_of_the_catalogue_is_named_and_a_saved_one_is_a_file(desk: Desk) -> None:
    LabSkis(desk.lab.runs).save_texts("mine", LabSkis(desk.lab.runs).texts("slalom")[0], "")
    page = desk.open("/simulate")
    page.fill("Ski", "slalom")
    job = asked(desk, page)
    assert (job["changes"], job["given"]) == ({"ski.name": "slalom"}, "ski: slalom")
    page.fill("Ski", "mine")
    job = asked(desk, page)
    assert (job["changes"], job["given"]) == ({"ski.file": LabSkis(desk.lab.runs).word("mine")}, "ski: mine")


def test_a_skier_goes_through_the_course_that_is_chosen(desk: Desk) -> None:
    page = desk.open("/simulate")
    page.fill("Course", "slalom-20-gates")
    job = asked(desk, page)
    assert (job["changes"], job["given"]) == ({"course.name": "slalom-20-gates"}, "course: slalom-20-gates")
    page.fill("Scenario", "skier-10deg")
    page.shows(STEERS)
    page.fill("Ski", "slalom")
    job = asked(desk, page)
    assert job["changes"] == {"ski.name": "slalom", "course.name": "slalom-20-gates", "skier.steers": "gates"}
    assert job["given"].startswith("ski: slalom; ")
    page.fill("Scenario", "slalom-20-gates")
    page.shows(f"field {STEERS} = 'gates'")
    page.fill(STEERS, "turns")
    assert asked(desk, page)["changes"]["skier.steers"] == "turns"


def test_a_published_snow_takes_the_place_of_both_numbers(desk: Desk) -> None:
    page = desk.open("/simulate")
    page.fill(HARDNESS, "0.3")
    page.fill("Snow", "published-glacier")
    words = "H_V = 90.0 N/mm³, interval not known; S_f = 0.300 N/mm², interval not known"
    page.shows(f"[snow] Snow: {words}")
    assert not [line for line in page.outline() if HARDNESS in line or STRESS in line or "field Site" in line]
    job = asked(desk, page)
    assert (job["changes"], words in job["given"]) == ({"snow.published": "glacier"}, True)
    assert words in desk.open("/simulate").shows("carved-46m · ")
    page.fill("Snow", NUMBERS)
    page.shows(f"field {HARDNESS} = '0.3'")
    assert asked(desk, page)["changes"] == {"snow.H_V_N_per_mm3": "0.3", "snow.S_f_N_per_mm2": "0.5"}


def test_the_snow_of_a_campaign_is_kept_with_the_run(desk: Desk, tmp_path: Path) -> None:
    """At B the wedge went in 1.7 mm under 60 N: H_V = 2 F tan 30° / (200 mm e²)."""
    id_ = campaign(desk, tmp_path / "kept")
    page = desk.open("/simulate")
    page.fill("Snow", f"kept-{id_}")
    assert page.shows("[snow] Snow: ") == "[snow] Snow: H_V = 0.0680 N/mm³, [0.0201, 0.230]"
    assert not [line for line in page.outline() if HARDNESS in line]
    assert page.field("Site").options == {"": "all sites", "A": "A", "B": "B"}
    job = asked(desk, page)
    stress = "S_f = 0.500 N/mm², interval not known"  # that of the page
    assert job["given"] == f"snow: Desk ({id_}), H_V = 0.0680 N/mm³, [0.0201, 0.230]; {stress}"
    kept = str(desk.lab.runs / job["name"] / "snow.json")
    assert job["changes"] == {"snow.S_f_N_per_mm2": "0.5", "snow.results": kept}
    by_hand = 2 * 60 * math.tan(math.radians(30)) / (200 * 1.7**2)
    assert snow_from_results(kept, site="B").snow_hardness == pytest.approx(by_hand * 1e9, rel=1e-9)
    page.fill("Site", "B")
    page.shows("[snow] Snow: H_V = 0.120 N/mm³, interval not known")
    job = asked(desk, page)
    assert job["changes"]["snow.site"] == "B"
    assert "0.120 N/mm³" in job["given"]
    assert job["given"] in desk.open("/simulate").shows("snow: Desk")
    page.fill("Snow", NUMBERS)
    page.until(lambda: not any("field Site" in line for line in page.outline()))
    assert asked(desk, page)["changes"] == {}


def test_a_campaign_that_is_analysed_is_waited_for(desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    id_, released, analysed = campaign(desk, tmp_path / "kept"), threading.Event(), list[Any]()

    def late(*what: Any) -> Any:
        assert released.wait(300)
        analysed.append(campaign_snow(*what))
        return analysed[0]

    monkeypatch.setattr(scenario_fields, "campaign_snow", late)
    page = desk.open("/simulate")
    page.fill("Snow", f"kept-{id_}")
    page.shows("[snow] The campaign is being analysed …")
    assert refused(desk, page) == "no_snow"
    page.fill("Snow", "published-glacier")
    told = page.shows("[snow] Snow: H_V = 90.0 N/mm³")
    page.fill("Ski", "slalom")
    released.set()
    page.until(lambda: analysed)
    job = asked(desk, page)
    assert job["changes"] == {"ski.name": "slalom", "snow.published": "glacier"}
    assert job["given"] == f"ski: slalom; {told[7].lower()}{told[8:]}".replace("snow: ", "snow: glacier, ")
    assert page.shows("[snow] ") == told


def test_a_campaign_that_gives_no_snow_says_why(desk: Desk, tmp_path: Path) -> None:
    id_ = desk.kept(tmp_path / "kept", {"campaign.toml": SHEARED})
    page = desk.open("/simulate")
    page.fill("Snow", f"kept-{id_}")
    page.shows("[snow] ")
    assert refused(desk, page) == "no_snow"
    assert jobs(desk) == []


RENAMING = ["Rename", "field Name of the run = 'mine'", "button Use this name"]


@pytest.mark.parametrize(
    ("state", "lines"),
    [("waiting", ["button Cancel"]), ("running", ["[quiet progress] 1.2 s of 5 s", "button Cancel"]), ("failed", [])],
)
def test_a_card_shows_how_its_run_stands(
    desk: Desk, monkeypatch: pytest.MonkeyPatch, state: Any, lines: list[str]
) -> None:
    page, runs, cancelled = desk.open("/replay"), Runs(desk.lab.runs), list[str]()
    monkeypatch.setattr(runs, "cancel", cancelled.append)
    job = Job("mine", "carved-46m", {"run.duration_s": "2", "ski.file": "/a/b"}, "2026", state, "so", "ski: b")
    before = len(page.outline())

    def shown() -> None:
        with page.content:
            _Card(runs, job, lambda action: action()).show(job)

    runs.progress = "1.2 s of 5 s"
    desk.do(shown, page.client)
    assert page.outline()[before:] == [
        "h3 mine",
        f"[quiet] carved-46m · {ENDS}: 2 · ski: b · {state} · so",
        *lines,
        *RENAMING,
    ]
    if lines:
        page.press("Cancel mine")
        assert cancelled == ["mine"]


def test_a_run_gets_a_name_in_words_that_can_be_changed(desk: Desk) -> None:
    first, second = (asked(desk, desk.open("/simulate")) for _ in range(2))
    assert [job["title"] for job in (first, second)] == ["carved 46m, 1", "carved 46m, 2"]
    page = desk.open("/simulate")
    page.fill("Name of the run", "  warm   snow ")
    page.press("Use this name")
    page.shows("h3 warm snow")
    assert Runs(desk.lab.runs).jobs()[0].shown_name == "warm snow"
    with raises(ParameterError, "bad_title"):
        Runs(desk.lab.runs).rename(first["name"], " ")


def test_a_run_with_a_file_of_its_course_can_be_watched(desk: Desk) -> None:
    (desk.lab.runs / "a run").mkdir()
    job = {"name": "a run", "scenario": "carved-46m", "changes": {}, "asked_at": "2026", "state": "done", "said": "so"}
    (desk.lab.runs / "a run" / "job.json").write_text(json.dumps(job), encoding="utf-8")
    assert "Watch" not in [each.text for each in desk.open("/simulate").of(ui.link)]
    (desk.lab.runs / "a run" / "run.nc").touch()
    assert desk.open("/simulate").link("Watch") == show_address("a run")


COURSE = b"gate,x_m,y_m,side\n1,12,1.5,left\n2,22,-1.5,right\n3,32,1.5,left\n"


@pytest.fixture
def here(monkeypatch: pytest.MonkeyPatch) -> None:
    """Courses are read in this process."""
    in_this_process(monkeypatch, "lab_tracks")


@pytest.mark.usefixtures("here")
def test_a_course_that_was_imported_is_chosen_for_a_skier(desk: Desk) -> None:
    answer = desk.post("/simulate/course", files={"file": ("Hang 3.csv", COURSE)})
    (name,) = LabCourses(desk.lab.runs).kept()
    assert (answer.status_code, answer.headers["location"]) == (303, f"/simulate?course={name}")
    page = desk.open(answer.headers["location"])
    assert [page.field(name).value for name in ("Scenario", "Course")] == ["slalom-20-gates", name]
    assert list(page.field("Course").options) == [GIVEN, *course_names(), name]
    job = asked(desk, page)
    word = str(desk.lab.runs / "courses" / name)
    assert (job["changes"], job["given"]) == ({"course.file": word, "skier.steers": "gates"}, f"course: {name}")
    page = desk.open("/simulate?course=nothing.csv")
    assert [page.field(name).value for name in ("Scenario", "Course")] == ["carved-46m", GIVEN]
    with raises(ParameterError, "unknown_course"):
        LabCourses(desk.lab.runs).change("../lab.log")


@pytest.mark.usefixtures("here")
@pytest.mark.parametrize(
    ("form", "code"),
    [
        ({"files": [("file", ("a.csv", COURSE))] * 2}, ""),
        ({"files": [("other", ("a.csv", COURSE))]}, "no_file"),
        ({"files": [("file", ("a.txt", COURSE))]}, "unknown_ending"),
        ({"files": [("file", (f"{'a' * 250}.csv", COURSE))]}, "unknown_ending"),
        ({"data": {"file": "a.csv"}}, "no_file"),
    ],
)
def test_an_invalid_course_is_rejected(desk: Desk, form: dict[str, Any], code: str) -> None:
    assert desk.post("/simulate/course", **form).status_code == 400
    assert desk.code == code
    assert LabCourses(desk.lab.runs).kept() == []


@pytest.mark.usefixtures("here")
def test_courses_are_listed_the_newest_first_without_what_is_none(tmp_path: Path) -> None:
    courses = LabCourses(tmp_path)
    assert courses.names() == list(course_names())
    older, newer = (courses.keep(name, io.BytesIO(COURSE)) for name in ("z.csv", "a.csv"))
    for name, when in ((older, 1_000_000_000), (newer, 1_100_000_000)):
        os.utime(tmp_path / "courses" / name, (when, when))
    for name in (".partial-x.csv", "words.txt"):
        (tmp_path / "courses" / name).write_bytes(COURSE)
    assert courses.kept() == [newer, older]
    assert courses.names() == [*course_names(), newer, older]
    assert gates_of(tmp_path / "courses" / newer) == 3
    assert (older, newer) == ("z.csv", "a.csv")
    assert courses.keep("a.csv", io.BytesIO(COURSE)) == "a-2.csv"


@pytest.mark.usefixtures("here")
def test_a_course_that_cannot_be_read_is_reported_under_its_own_name(tmp_path: Path) -> None:
    with raises(ParameterError, "unknown_choice", path="bad.csv") as found:
        LabCourses(tmp_path).keep("bad.csv", io.BytesIO(COURSE.replace(b"right", b"up")))
    assert str(tmp_path) not in str(found.value) and "partial" not in str(found.value)
    assert list((tmp_path / "courses").iterdir()) == []
