"""Courses in the lab: stored, chosen for a skier, and two runs through one compared at its gates."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

pytest.importorskip("nicegui", reason="the web lab is not installed: pip install 'skisnow[web]'")

from fastapi import FastAPI

from skisnow.web.replay_addresses import RunFolders, add_addresses

from ..track.course.test_gates_table import folder_of
from .replay.test_addresses import Client

if TYPE_CHECKING:
    from playwright.sync_api import Page

    from .conftest import Served

COURSE = b"gate,x_m,y_m,side\n1,12,1.5,left\n2,22,-1.5,right\n3,32,1.5,left\n"


@pytest.mark.slow
def test_times_at_gates_of_two_runs_are_a_page(tmp_path: Path) -> None:
    for name, times in (("mine", [1.5, 3.25]), ("theirs", [1.5, 3.0])):
        (folder_of(tmp_path / name, list(times)) / "run.nc").touch()
    app = FastAPI()
    add_addresses(app, RunFolders(tmp_path))
    answer = Client(app).get("/replay/gates", {"run": "mine", "ghost": "theirs"})
    assert answer.status_code == 200
    assert "0.25 s behind" in answer.text
    (tmp_path / "theirs" / "gates.csv").unlink()
    refused = Client(app).get("/replay/gates", {"run": "mine", "ghost": "theirs"})
    assert (refused.status_code, "same gates" in refused.text) == (404, True)
    assert Client(app).get("/replay/gates", {"run": "mine", "ghost": "../etc"}).status_code == 404


@pytest.mark.slow
def test_a_skier_is_sent_through_an_uploaded_course(page: Page, served: Served, tmp_path: Path) -> None:
    (tmp_path / "mine.csv").write_bytes(COURSE)
    page.goto(f"{served.address}simulate")
    assert page.get_by_label("Steers by", exact=True).count() == 0  # a sledge steers nothing
    page.locator("summary", has_text="Add a course").click()
    page.locator("#course-file").set_input_files(tmp_path / "mine.csv")
    page.get_by_role("button", name="Add the course").click()
    page.wait_for_url("**/simulate?course=mine-*")
    page.get_by_role("combobox", name="Steers by").wait_for()
    assert page.get_by_label("Edge angle ϑ (°)", exact=True).count() == 0  # the skier sets it
    page.get_by_label("Ends after (s)", exact=True).fill("0.05")
    page.get_by_role("button", name="Simulate").click()
    page.get_by_text("missed gate: ").wait_for()
    (job,) = (served.store.parent / "lab").glob("*/job.json")
    changes = json.loads(job.read_text(encoding="utf-8"))["changes"]
    assert Path(changes["course.file"]).read_bytes() == COURSE
    assert changes["skier.steers"] == "gates"
    assert (job.parent / "gates.csv").read_text(encoding="utf-8").count("not_reached") == 3
    page.get_by_role("link", name="Watch").wait_for()
