"""Courses that are sent to the lab."""

from __future__ import annotations

import io
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from skisnow._support.errors import OutputError, ParameterError
from skisnow.track.course import course_names
from skisnow.web import lab_tracks
from skisnow.web.lab_tracks import LabCourses, gates_of
from tests.coded import raises

from ..desk import in_this_process
from .shared import GIVEN, asked

if TYPE_CHECKING:
    from ..desk import Desk

COURSE = b"gate,x_m,y_m,side\n1,12,1.5,left\n2,22,-1.5,right\n3,32,1.5,left\n"


@pytest.fixture
def here(monkeypatch: pytest.MonkeyPatch) -> None:
    """Courses are read in this process."""
    in_this_process(monkeypatch, "lab_tracks")


def test_a_course_is_sent_by_a_form_that_needs_no_script(desk: Desk) -> None:
    page = desk.open("/simulate")
    (form,) = page.tagged("form")
    assert form.props == {"method": "post", "action": "/simulate/course", "enctype": "multipart/form-data"}
    (file,) = page.tagged("input")
    assert file.props == {"id": "course-file", "name": "file", "type": "file", "required": True, "accept": ".csv,.gpx"}
    assert [each.props["for"] for each in page.tagged("label")] == ["course-file"]
    assert [each.props["type"] for each in page.tagged("button")] == ["submit"]


@pytest.mark.usefixtures("here")
def test_a_course_that_was_taken_in_is_chosen_for_a_skier(desk: Desk) -> None:
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
def test_what_is_no_course_is_refused(desk: Desk, form: dict[str, Any], code: str) -> None:
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
    assert newer[:2] + newer[6:] == "a-.csv"


def test_what_is_just_allowed_of_courses_is_taken(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    courses = LabCourses(tmp_path)
    monkeypatch.setattr(lab_tracks, "confined", lambda *_: 3)
    with raises(ParameterError, "too_large", most=1):
        courses.keep("a.csv", io.BytesIO(bytes(1_000_001)))
    courses.keep("a.csv", io.BytesIO(bytes(1_000_000)))
    monkeypatch.setattr(lab_tracks, "MOST_COURSES", 2)
    courses.keep("a.csv", io.BytesIO(COURSE))
    with raises(ParameterError, "too_many_files", most=2, folder="courses"):
        courses.keep("a.csv", io.BytesIO(COURSE))
    assert len(courses.kept()) == 2


@pytest.mark.usefixtures("here")
def test_a_course_that_cannot_be_read_is_told_under_its_own_name(tmp_path: Path) -> None:
    with raises(ParameterError, "unknown_choice", path="bad.csv") as found:
        LabCourses(tmp_path).keep("bad.csv", io.BytesIO(COURSE.replace(b"right", b"up")))
    assert str(tmp_path) not in str(found.value) and "partial" not in str(found.value)
    assert list((tmp_path / "courses").iterdir()) == []


def test_a_course_is_read_with_the_limits_of_uploads_and_a_full_disk_is_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    given: list[Any] = []
    monkeypatch.setattr(lab_tracks, "confined", lambda *what: given.append(what))
    LabCourses(tmp_path).keep("a.csv", io.BytesIO(COURSE))
    ((bounds, work, _),) = given
    assert (bounds.seconds, work) == (120.0, gates_of)

    def full(_self: Path, _to: Path) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "rename", full)
    with raises(OutputError, "cannot_write"):
        LabCourses(tmp_path).keep("b.csv", io.BytesIO(COURSE))
    assert [place.name[:2] for place in (tmp_path / "courses").iterdir()] == ["a-"]
