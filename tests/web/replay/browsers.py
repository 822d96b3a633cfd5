"""A browser that draws in software, as on a machine without a graphics card; skipped where there is none."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest

SOFTWARE = ("--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist")
NAMES = ("chromium", "chromium-browser", "google-chrome")


@contextmanager
def chromium() -> Iterator[Any]:
    """Playwright's handle of Chromium; skips the test with the reason where one of both is missing."""
    playwright = pytest.importorskip(
        "playwright.sync_api", reason="playwright is not installed: pip install playwright"
    )
    place = os.environ.get("SKISNOW_CHROMIUM") or next(filter(None, map(shutil.which, NAMES)), None)
    if place is None:
        pytest.skip(f"there is no Chromium: none of {', '.join(NAMES)} is found, and SKISNOW_CHROMIUM is not set")
    with playwright.sync_playwright() as started:
        browser = started.chromium.launch(executable_path=place, args=list(SOFTWARE))
        try:
            yield browser
        finally:
            browser.close()


class Watched:
    """A page with all that it asked for and said."""

    def __init__(self, browser: Any, address: str, *, width: int = 1280, height: int = 800) -> None:
        self.page = browser.new_page(viewport={"width": width, "height": height})
        self.requests: list[str] = []
        self.complaints: list[str] = []
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.page.on("console", self._heard)
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.goto(address)
        self.page.wait_for_function("window.skisnowReplay")

    def _heard(self, said: Any) -> None:
        if said.type in {"error", "warning"}:
            self.complaints.append(said.text)

    def does(self, script: str) -> Any:
        """The value of a script in which `replay` is the player."""
        return self.page.evaluate(f"() => {{ const replay = window.skisnowReplay; {script} }}")

    def picture(self) -> Any:
        """The canvas alone as an array (height, width, 3)."""
        import io

        import numpy as np
        from PIL import Image

        png = self.page.locator("canvas.replay-canvas").screenshot()
        with Image.open(io.BytesIO(png)) as image:
            return np.asarray(image.convert("RGB")).astype(int)

    def close(self) -> None:
        """Close the page."""
        self.page.close()
