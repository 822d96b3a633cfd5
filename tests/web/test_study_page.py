"""A study is requested on its page, shown, taken away as files, and gives the table of the command."""

from __future__ import annotations

import io
import json
import zipfile
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from skisnow.studies import read_study, run_study

from .conftest import PATIENCE_MS, Served, fill, killed_and_started_again, ready, settled
from .test_runs import choose

if TYPE_CHECKING:
    from collections.abc import Iterator

    from playwright.sync_api import Browser, Page

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
def test_its_table_is_that_of_the_command(page: Page, served_with_figures: Served, tmp_path: Path) -> None:
    served = served_with_figures
    ask(page, served, {f"{FIRST}: number of values": "3", "Load (N)": "600,5"})
    page.get_by_text("3 points: equilibrium 3.").wait_for(timeout=LONG_MS)
    page.get_by_role("link", name="Table and figure").click()
    page.get_by_role("img", name="Chart of Carved radius (m) over Edge angle ϑ (°)").wait_for()
    assert page.locator("tbody tr").count() == 3
    page.wait_for_function("document.querySelector('figure img').naturalWidth > 100")
    folder = unpacked(page, tmp_path)
    assert sorted(each.name for each in folder.iterdir()) == ["map.svg", "study.toml", "table.csv"]
    found = (folder / "table.csv").read_bytes()
    (folder / "table.csv").unlink()
    table = run_study(read_study(folder / "study.toml"), workers=1)
    assert (folder / "table.csv").read_bytes() == found
    assert [row["load_N"] for row in table.rows] == [600.5] * 3
    for width in (1280, 390):
        page.set_viewport_size({"width": width, "height": 844})
        settled(page)
        assert page.evaluate("document.documentElement.scrollWidth") <= width


@pytest.mark.slow
def test_a_study_of_runs_is_cancelled_goes_on_and_outlives_its_server(
    page: Page, served: Served, tmp_path: Path
) -> None:
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


@pytest.mark.slow
def test_a_study_in_german(chromium: Browser, served: Served) -> None:
    context = chromium.new_context(locale="de-DE", viewport={"width": 390, "height": 844})
    context.set_default_timeout(PATIENCE_MS)
    page = context.new_page()
    page.goto(f"{served.address}study")
    page.get_by_text("13 Punkte. Dauert etwa").wait_for()
    ready(page)
    fill(page, {"Erste Eingabe: Anzahl der Werte": "2"})
    choose(page, "Zweite Eingabe", "Last (N)")
    page.get_by_label("Zweite Eingabe: von", exact=True).wait_for()
    page.get_by_role("button", name="Studie starten").click()
    page.get_by_text("Nicht begonnen: Last (N): beide Enden des Bereichs eintippen").wait_for()
    values = {"Zweite Eingabe: von": "600,123", "Zweite Eingabe: bis": "800", "Zweite Eingabe: Anzahl der Werte": "2"}
    fill(page, values)
    page.get_by_text("4 Punkte. Dauert etwa").wait_for()
    page.get_by_role("button", name="Studie starten").click()
    page.get_by_text("; Last (N): 600,123 bis 800, 2 Werte").wait_for()
    page.get_by_text("4 Punkte: Gleichgewicht 4.").wait_for(timeout=LONG_MS)
    page.get_by_role("link", name="Tabelle und Bild").click()
    page.get_by_role("columnheader", name="Gecarvter Radius (m)").wait_for()
    page.get_by_role("cell", name="10,0", exact=True).first.wait_for()
    page.get_by_text("Schneehärte H_V (N/mm³): 0,2; Scherfestigkeit S_f (N/mm²): 0,5").wait_for()
    page.get_by_text("Last (N): 600,1", exact=True).wait_for()
    assert page.get_by_text("auf Englisch").count() == 0  # nor is the map
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    context.close()


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
def test_a_scheduler_computes_the_studies_of_the_lab(
    page: Page, with_scheduler: tuple[Served, list[str]], tmp_path: Path
) -> None:
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
    assert "Receive client connection: Client-skisnow" in log
