"""A lab that is served as a person would, and a browser that drives it."""

from __future__ import annotations

import importlib.util
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit

import pytest

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
MISSING = [name for name in ("nicegui", "playwright") if importlib.util.find_spec(name) is None]
PATIENCE_MS = 30_000  # on a busy machine; no time is asserted


@dataclass
class Served:
    """A server process on a store, which can be killed and started again at the same address."""

    store: Path
    words: tuple[str, ...] = ()
    address: str = ""
    process: subprocess.Popen[str] | None = field(default=None, repr=False)

    def start(self) -> Served:
        port = str(urlsplit(self.address).port) if self.address else "0"
        command = [sys.executable, "-m", "skisnow", "serve", "--port", port, "--store", str(self.store), *self.words]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env={**os.environ})
        assert self.process.stdout is not None
        self.address = self.process.stdout.readline().strip()
        assert self.address.startswith("http://"), self.process.wait(10)
        return self

    def kill(self) -> None:
        assert self.process is not None and self.process.stdout is not None
        self.process.kill()
        self.process.wait(30)
        self.process.stdout.close()

    def again(self) -> Served:
        self.kill()
        return self.start()


@pytest.fixture
def served(tmp_path: Path) -> Iterator[Served]:
    if "nicegui" in MISSING:
        pytest.skip("NiceGUI is not installed: pip install 'skisnow[web]'")
    lab = Served(tmp_path / "store.sqlite3").start()
    yield lab
    lab.kill()


@pytest.fixture(scope="session")
def chromium() -> Iterator[Browser]:
    if MISSING:
        pytest.skip(f"not installed: {', '.join(MISSING)} (pip install 'skisnow[test]')")
    if CHROMIUM is None:
        pytest.skip("there is no Chromium on this machine (Debian: apt install chromium)")
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield browser
        browser.close()


@dataclass
class Watched:
    """What a page did that it must not."""

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
    """A page of a desktop's size; it fails the test if anything asked for another machine."""
    context = chromium.new_context(viewport={"width": 1280, "height": 900}, accept_downloads=True)
    context.set_default_timeout(PATIENCE_MS)
    made = context.new_page()
    watched.of(made)
    yield made
    context.close()
    assert watched.foreign == []
    assert watched.errors == []


def ready(page: Page) -> None:
    """Wait until the page is connected and waits for no answer: keys pressed before go nowhere, or are held."""
    page.locator("html:not(.not-connected):not(.holding)").wait_for()


def fill(page: Page, values: dict[str, Any]) -> None:
    """Fill fields by their accessible names, once the page is ready: it holds what comes before as if it were typed."""
    ready(page)
    for label, value in values.items():
        page.get_by_label(label, exact=True).fill(str(value))
