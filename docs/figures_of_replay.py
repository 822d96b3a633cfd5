"""Take the pictures of the replay for the docs, in a browser: python docs/figures_of_replay.py.

Playwright and Chromium must be there (another place of Chromium: SKISNOW_CHROMIUM).
"""

from __future__ import annotations

import io
import os
import shutil
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PIL import Image

from skisnow import load_scenario, simulate
from skisnow.replay import replay_of_run, write_replay

if TYPE_CHECKING:
    from skisnow.replay import Replay

FOLDER = Path(__file__).resolve().parent / "_static" / "replay"
SCENARIO = "carved-46m"
MOMENT = 2.5
SLALOM = "slalom-15deg"
FRAMES_PER_SECOND = 12
FILM_S = (2.0, 6.0)
QUALITY = 88
SOFTWARE = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"]

PAGE = "replay.pause(); replay.seek({time}); replay.show('ghost', false)"
VIEWS = (
    "replay.show('forces', true); replay.look('edge')",
    "replay.show('forces', false); replay.look('boot')",
    "replay.look('above'); replay.nearer(1.7)",
    "replay.show('ghost', true); replay.seek(4.6); replay.look('chase'); replay.turn(0.5, 0.1)",
)
FILM = "replay.pause(); replay.show('forces', false); replay.look('chase')"


def replays() -> tuple[Replay, Replay]:
    """The turn on snow that keeps its groove, and on snow that springs back."""
    run, elastic = (
        simulate(load_scenario(SCENARIO, changes={"snow.penetration": kind})) for kind in ("hypoplastic", "elastic")
    )
    return replay_of_run(run, title=SCENARIO), replay_of_run(elastic, title="elastic snow")


def does(page: Any, script: str) -> None:
    """Run a script with the player, and wait until it is drawn."""
    page.wait_for_function("window.skisnowReplay")
    page.evaluate(f"() => {{ const replay = window.skisnowReplay; {script.replace('{time}', str(MOMENT))} }}")
    page.wait_for_timeout(300)


def picture(content: bytes, *, width: int) -> Image.Image:
    """A screenshot, smaller."""
    with Image.open(io.BytesIO(content)) as image:
        return image.convert("RGB").resize((width, round(image.height * width / image.width)), Image.Resampling.LANCZOS)


def write(image: Image.Image, name: str) -> None:
    """With all its colours: fewer would band the scales or tint the snow, and a PNG of all has six times the bytes."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    image.save(FOLDER / f"{name}.webp", quality=QUALITY, method=6)


def sheet(pictures: list[Image.Image]) -> Image.Image:
    """Four pictures, two beside each other."""
    width, height = pictures[0].size
    gap = 8
    whole = Image.new("RGB", (2 * width + gap, 2 * height + gap), "white")
    for i, each in enumerate(pictures):
        whole.paste(each, ((i % 2) * (width + gap), (i // 2) * (height + gap)))
    return whole


def film(browser: Any, folder: Path) -> None:
    """A skier through gates as a moving picture."""
    run = simulate(load_scenario(SLALOM, changes={"solver.method": "fast", "run.duration_s": 8.0}))
    page = browser.new_page(viewport={"width": 960, "height": 760})
    page.goto(write_replay(replay_of_run(run, title=SLALOM), folder / "slalom.html").as_uri())
    does(page, FILM)
    start, end = (round(FRAMES_PER_SECOND * moment) for moment in FILM_S)
    frames = []
    for number in range(start, end):
        page.evaluate(f"() => window.skisnowReplay.seek({number / FRAMES_PER_SECOND})")
        page.wait_for_timeout(80)
        frames.append(picture(page.locator(".replay-canvas").screenshot(), width=500))
    spacing = round(1000 / FRAMES_PER_SECOND)
    frames[0].save(
        FOLDER / "slalom.webp", save_all=True, append_images=frames[1:], duration=spacing, loop=0, quality=30, method=6
    )


def main() -> None:
    """Simulate, write the page, look at it."""
    from playwright.sync_api import sync_playwright

    run, ghost = replays()
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        address = write_replay(run, Path(folder) / "replay.html", ghost=ghost).as_uri()
        place = (
            os.environ.get("SKISNOW_CHROMIUM") or shutil.which("chromium-headless-shell") or shutil.which("chromium")
        )
        browser = playwright.chromium.launch(executable_path=place, args=SOFTWARE)
        page = browser.new_page(viewport={"width": 1200, "height": 860}, device_scale_factor=1.5)
        page.goto(address)
        does(page, PAGE)
        write(picture(page.screenshot(), width=1000), "page")
        taken = []
        for script in VIEWS:
            does(page, script)
            taken.append(picture(page.locator(".replay-canvas").screenshot(), width=560))
        write(sheet(taken), "views")
        film(browser, Path(folder))
        browser.close()


if __name__ == "__main__":
    main()
