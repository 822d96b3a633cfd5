"""A study is requested on its page, shown, taken away as files, and gives the table of the command."""

import io
import json
import zipfile
from collections.abc import Iterator
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


@pytest.fixture
def with_scheduler(tmp_path: Path) -> Iterator[tuple[Served, list[str]]]:
    """A lab that sends its studies to a Dask scheduler, and the log of its worker."""
    pytest.importorskip("distributed", reason="Dask is not installed: skisnow[dask]")
    from tests.support.processes.test_dask import Cluster

    cluster = Cluster(tmp_path)
    try:
        cluster.hire(1)
        further = ("--scheduler", cluster.address)
        lab = Served(tmp_path / "lab" / "store.sqlite3", as_command=True, further=further)
        lab.store.parent.mkdir()
        try:
            yield lab.start(), [cluster.address]
        finally:
            lab.kill()
    finally:
        cluster.close()


@pytest.mark.slow
def test_a_scheduler_computes_the_studies(page: Page, with_scheduler: tuple[Served, list[str]], tmp_path: Path) -> None:
    served, (address,) = with_scheduler
    ask(page, served, {f"{FIRST}: number of values": "4"})
    page.get_by_text(f"The workers of {address} compute.").wait_for()
    page.get_by_text("4 points: equilibrium 4.").wait_for(timeout=LONG_MS)
    (job,) = (served.lab / "studies").glob("*/job.json")
    assert json.loads(job.read_text(encoding="utf-8"))["workers"] == 0
    found = job.with_name("table.csv").read_bytes()
    (tmp_path / "study.toml").write_bytes(job.with_name("study.toml").read_bytes())
    run_study(read_study(tmp_path / "study.toml"), workers=1)
    assert (tmp_path / "table.csv").read_bytes() == found
    log = (tmp_path / "dask_scheduler.log").read_text(encoding="utf-8")
    assert "Client-skisnow" in log


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
