"""A study is requested on its page, shown, taken away as files, and gives the table of the command."""

import io
import zipfile
from pathlib import Path

import pytest
from fastapi import FastAPI

from skisnow.studies import read_study, run_study
from skisnow.web.replay_addresses import RunFolders, add_addresses

from ..track.course.test_passages import folder_of
from .browser_types import Page
from .conftest import PATIENCE_MS, Served, fill, killed_and_started_again, ready
from .replay.test_addresses import Client

LONG_MS = 4 * PATIENCE_MS
FIRST, SECOND = "First input", "Second input"


def ask(page: Page, served: Served, values: dict[str, str], of: str = "") -> None:
    page.goto(f"{served.address}study")
    page.get_by_label(f"{FIRST}: number of values", exact=True).wait_for()
    ready(page)
    if of:
        choose(page, "What is studied", of)
        page.get_by_label("Slope angle α (°)", exact=True).wait_for()
    fill(page, values)
    page.get_by_role("button", name="Start the study").click()


def unpacked(page: Page, folder: Path) -> Path:
    """The folder of what `Download everything` gives."""
    with page.expect_download() as download:
        page.get_by_role("link", name="Download everything").click()
    with zipfile.ZipFile(io.BytesIO(Path(download.value.path()).read_bytes())) as packed:
        packed.extractall(folder)
    return folder / "study"


@pytest.mark.slow
def test_a_study_of_runs_is_cancelled_continues_after_a_restart(page: Page, served: Served, tmp_path: Path) -> None:
    ask(page, served, {f"{FIRST}: number of values": "20", "Ends after (s)": "0.3"}, of="carved-46m")
    page.locator(".card .progress", has_text=" of 20 points").wait_for(timeout=LONG_MS)
    page.get_by_role("button", name="Cancel").click()
    page.get_by_text("of 20 points are finished and kept.").wait_for(timeout=LONG_MS)
    page.get_by_role("button", name="Go on").click()
    page.get_by_text("running").wait_for(timeout=LONG_MS)
    killed_and_started_again(page, served)
    page.get_by_text("20 points: finished 20.").wait_for(timeout=LONG_MS)
    page.get_by_role("link", name="Table and figure").click()
    page.get_by_role("img", name="Chart of Length of the run (m) over").wait_for()
    folder = unpacked(page, tmp_path)
    found = (folder / "table.csv").read_bytes()
    (folder / "table.csv").unlink()
    run_study(read_study(folder / "study.toml"), workers=2)
    assert (folder / "table.csv").read_bytes() == found


def choose(page: Page, label: str, option: str) -> None:
    page.get_by_label(label, exact=True).click()
    page.get_by_role("option", name=option).click()


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
    without = Client(app).get("/replay/gates", {"run": "mine", "ghost": "theirs"})
    assert (without.status_code, "0.25 s behind" in without.text) == (200, False)
    assert Client(app).get("/replay/gates", {"run": "mine", "ghost": "../etc"}).status_code == 404
