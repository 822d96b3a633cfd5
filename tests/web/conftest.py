"""A lab that is served as a person would, and a browser that drives it."""

import importlib.util
import json
import multiprocessing
import pkgutil
import runpy
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Self
from urllib.parse import urlsplit

import pytest

pytest.importorskip("nicegui", reason="the web lab is not installed: pip install 'skisnow[web]'")

from multiprocessing.process import BaseProcess

import skisnow.web.pages
from skisnow.campaign.store import Journals, ReplayedCampaign, Store, replay_journal
from skisnow.campaign.store.engine import writing
from skisnow.campaign.store.schema import metadata
from tests.present import present

from .browser_types import Browser, Locator, Page

# without windows it takes a quarter of the computing that the whole browser takes
CHROMIUM = next(filter(None, map(shutil.which, ("chromium-headless-shell", "chromium", "chromium-browser"))), None)
HAS_PLAYWRIGHT = importlib.util.find_spec("playwright") is not None
PATIENCE_MS = 150_000  # as long as a page of the lab itself waits for an answer; no time is asserted
DRAWING_MS = 180_000  # all figures of a report
DRAWS_IF_ASKED = """["drawArrays", "drawArraysInstanced", "drawElements", "drawElementsInstanced"].forEach((name) => {
  const draw = WebGL2RenderingContext.prototype[name];
  WebGL2RenderingContext.prototype[name] = function (...given) { if (window.draws) draw.apply(this, given); };
})"""
"""Drawing replays in software takes most of the time of these tests, and most of them look at no picture."""
LOADED_LATE = ("alembic.command", "nicegui.ui_run_with", "sqlalchemy.dialects.sqlite", "uvicorn.lifespan.on",
               "uvicorn.loops.uvloop", "uvicorn.protocols.websockets.auto")  # fmt: skip
"""Modules that every server would load when it starts."""


@dataclass
class Served:
    """A server process on a store, which can be killed and started again at the same address.

    The command takes seconds to load what it needs, so one process loads that and brings forth all servers; with
    `as_command` a server is started as a person does, with `further` words. Otherwise pictures of a report are empty.
    """

    store: Path
    as_command: bool = False
    further: tuple[str, ...] = ()
    address: str = ""
    process: BaseProcess | subprocess.Popen[str] | None = field(default=None, repr=False)
    was_killed: bool = False

    @property
    def lab(self) -> Path:
        """The folder of its skis and runs."""
        return self.store.parent / "lab"

    def start(self) -> Self:
        port = (urlsplit(self.address).port if self.address else None) or 0
        self.address = self._by_command(port) if self.as_command else self._by_fork(port)
        assert self.address.startswith("http://")
        return self

    def _by_command(self, port: int) -> str:
        command = [sys.executable, "-m", "skisnow", "serve", "--port", str(port), "--store", str(self.store)]
        command += self.further
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        with present(self.process.stdout) as told:
            return told.readline().strip()

    def _by_fork(self, port: int) -> str:
        context = multiprocessing.get_context("forkserver")
        pages = (f"skisnow.web.pages.{each.name}" for each in pkgutil.iter_modules(skisnow.web.pages.__path__))
        context.set_forkserver_preload(["skisnow.web.server", *pages, *LOADED_LATE])
        hears, tells = context.Pipe(duplex=False)
        program = str(Path(__file__).with_name("served_here.py"))
        given = self.store, port, tells
        process = context.Process(target=runpy.run_path, args=(program, {"given": given}, "__main__"))
        self.process = process
        process.start()
        tells.close()
        with hears:
            return str(hears.recv())

    def kill(self) -> None:
        self.was_killed = True
        assert self.process is not None
        self.process.kill()
        self.wait()

    def wait(self) -> None:
        """Wait until the process has ended."""
        if isinstance(self.process, subprocess.Popen):
            self.process.wait(300)
        elif self.process is not None:
            self.process.join(300)
            assert self.process.exitcode is not None

    def again(self) -> Self:
        self.kill()
        return self.start()

    def is_as_started(self) -> bool:
        """Whether no test has killed it, and nothing that one has left is still computed."""
        alive = not isinstance(self.process, subprocess.Popen) and self.process is not None and self.process.is_alive()
        jobs = (json.loads(place.read_text(encoding="utf-8")) for place in self.lab.rglob("job.json"))
        return alive and not self.was_killed and all(job["state"] not in {"waiting", "running"} for job in jobs)

    def empty(self) -> None:
        """Take everything out of store and folder, under the running server."""
        with Store.open(self.store) as store, writing(store.engine) as connection:
            for table in reversed(metadata.sorted_tables):
                connection.execute(table.delete())
        for each in self.lab.iterdir():
            if each.is_dir():
                shutil.rmtree(each)


@dataclass
class Servers:
    """The server that tests share, one after another; a new one after a test that it did not survive."""

    folders: Callable[[], Path]
    lab: Served | None = None

    def one(self) -> Served:
        """It runs, and nothing is in its store."""
        if self.lab is not None and self.lab.is_as_started():
            self.lab.empty()
        else:
            self.end()
            self.lab = Served(self.folders() / "store.sqlite3").start()
        return self.lab

    def end(self) -> None:
        if self.lab is not None:
            self.lab.kill()


@pytest.fixture(scope="session")
def servers(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Servers]:
    every = Servers(lambda: tmp_path_factory.mktemp("served"))
    yield every
    every.end()


@pytest.fixture
def served(servers: Servers) -> Served:
    """A lab in which nothing was entered yet; a test may kill it."""
    return servers.one()


@pytest.fixture(scope="session")
def chromium() -> Iterator[Browser]:
    if not HAS_PLAYWRIGHT:
        pytest.skip("Playwright is not installed: pip install playwright")
    if CHROMIUM is None:
        pytest.skip("there is no Chromium on this machine (Debian: apt install chromium)")
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=CHROMIUM, args=["--no-sandbox", "--renderer-process-limit=1"]
        )
        yield browser
        browser.close()


@pytest.fixture(scope="session")
def drawing_chromium(chromium: Browser) -> Iterator[Browser]:
    """A second Chromium, which draws in software as on a machine without a graphics card."""
    software = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"]
    browser = chromium.browser_type.launch(executable_path=CHROMIUM, args=software)
    yield browser
    browser.close()


@dataclass
class Watched:
    """Faults of a page."""

    foreign: list[str] = field(default_factory=list)
    errors: list[str] = field(default_factory=list)

    def of(self, page: Page) -> None:
        def requested(address: str) -> None:
            parts = urlsplit(address)
            if parts.scheme not in ("data", "blob", "about") and parts.hostname != "127.0.0.1":
                self.foreign.append(address)

        page.on("request", lambda request: requested(request.url))
        page.on("websocket", lambda socket: requested(socket.url))
        page.on("pageerror", lambda error: self.errors.append(str(error)))


@pytest.fixture
def watched() -> Watched:
    return Watched()


@pytest.fixture
def page(chromium: Browser, watched: Watched) -> Iterator[Page]:
    """A page of a desktop's size, on which no replay plays; it fails the test if anything asked for another machine."""
    context = chromium.new_context(
        viewport={"width": 1280, "height": 900}, accept_downloads=True, reduced_motion="reduce"
    )
    context.add_init_script(DRAWS_IF_ASKED)
    context.set_default_timeout(PATIENCE_MS)
    made = context.new_page()
    watched.of(made)
    yield made
    context.close()
    assert watched.foreign == []
    assert watched.errors == []


@pytest.fixture
def file_page(chromium: Browser) -> Iterator[Page]:
    """A page of files, not of a server."""
    made = chromium.new_page()
    yield made
    made.close()


def entered(served: Served) -> ReplayedCampaign:
    """The only campaign of the store."""
    with Store.open(served.store) as store:
        (head,) = Journals(store).list()
        return replay_journal(Journals(store).entries(head.id))


def killed_and_started_again(page: Page, served: Served) -> None:
    """Kill the server under an open page, start it again and open the page again."""
    place = page.url
    served.kill()
    page.goto("about:blank")  # else the page comes back by itself, at the same time
    served.start()
    page.goto(place)


def ready(page: Page) -> None:
    """Wait until the page is connected and waits for no answer: keys pressed before go nowhere, or are held."""
    page.locator("html:not(.not-connected):not(.holding)").wait_for()


def follow(page: Page, link: str, *, exact: bool = False) -> None:
    """Press Enter on a link, once the page is ready: a key that is held goes where the answer puts the focus."""
    ready(page)
    page.get_by_role("link", name=link, exact=exact).press("Enter")


def settled(page: Page) -> None:
    """Wait until colours have faded in and nothing moves any more, but for what always does."""
    page.wait_for_function(
        """document.getAnimations().every(each =>
             each.playState !== "running" || each.effect.getComputedTiming().endTime === Infinity)"""
    )


def fill(page: Page, values: dict[str, Any]) -> None:
    """Fill fields by their accessible names, once the page is ready: it holds what comes before as if it were typed."""
    ready(page)
    for label, value in values.items():
        page.get_by_label(label, exact=True).fill(str(value))


def has_text(field: Locator, text: str) -> None:
    """Wait until a field holds this text."""
    from playwright.sync_api import expect

    expect(field).to_have_value(text, timeout=PATIENCE_MS)


def downloaded_results(page: Page) -> dict[str, Any]:
    """results.json in the zip of the analysis that a page shows, whose report is drawn when it is requested."""
    with page.expect_download(timeout=DRAWING_MS) as download:
        page.get_by_role("link", name="Download everything").press("Enter", timeout=DRAWING_MS)
    with zipfile.ZipFile(download.value.path()) as packed:
        results: dict[str, Any] = json.loads(packed.read("analysis/results.json"))
    return results
