"""Pictures a second of the replay, drawn in software by Chromium: ``python -m benchmarks.replay``, as Markdown.

The run is carved-46m with the same turn on elastic snow laid over it. Playwright and Chromium must be there; another
place of Chromium stands in the environment as SKISNOW_CHROMIUM. `--alone` leaves the second run out.
"""

from __future__ import annotations

import argparse
import os
import platform
import shutil
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skisnow.replay import replay_bytes, replay_of_run, write_replay
from skisnow.scenario import load_scenario
from skisnow.simulation.simulated_run import simulate

if TYPE_CHECKING:
    from skisnow.replay import Replay

SOFTWARE = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"]
SIZES = {"small, 1280 × 720": (1280, 720), "large, 1920 × 1080": (1920, 1080), "phone, 390 × 844": (390, 844)}
VIEWS = ("chase", "boot", "above", "edge", "free")
SETTINGS = ("low", "full")
GOAL = 30.0
"""At the low setting."""

# Plays for some seconds, of which the first tenth is left out.
PLAYED = """([view, setting, seconds]) => new Promise((done) => {
    const replay = window.skisnowReplay;
    replay.pause(); replay.drawAs(setting); replay.look(view); replay.seek(0); replay.play();
    setTimeout(() => {
        const frames = replay.frames, now = performance.now();
        setTimeout(() => {
            const rate = (replay.frames - frames) / (performance.now() - now) * 1000;
            replay.pause();
            done(rate);
        }, 900 * seconds);
    }, 100 * seconds);
})"""


def runs(duration: float) -> tuple[Replay, Replay]:
    """The run and its ghost."""
    changes = {"run.duration_s": duration}
    found = [
        simulate(load_scenario("carved-46m", changes=changes | {"snow.penetration": kind}))
        for kind in ("hypoplastic", "elastic")
    ]
    return replay_of_run(found[0], title="carved-46m"), replay_of_run(found[1], title="elastic snow")


def rates(page: Any, setting: str, seconds: float) -> dict[str, float]:
    """Pictures a second by view."""
    page.wait_for_function("window.skisnowReplay")
    return {view: float(page.evaluate(PLAYED, [view, setting, seconds])) for view in VIEWS}


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.replay", description=__doc__)
    parser.add_argument("--duration", type=float, default=5.0, help="simulated seconds, all of them played")
    parser.add_argument("--alone", action="store_true", help="no second run over it")
    options = parser.parse_args()
    from playwright.sync_api import sync_playwright

    run, ghost = runs(options.duration)
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        page = write_replay(run, Path(folder) / "replay.html", ghost=None if options.alone else ghost)
        print(f"{platform.machine()}, {os.cpu_count()} cores, busy with {os.getloadavg()[0]:.1f} processes before")
        print(f"{len(replay_bytes(run)) / 1e6:.2f} MB a run, {page.stat().st_size / 1e6:.2f} MB the page with two\n")
        place = (
            os.environ.get("SKISNOW_CHROMIUM") or shutil.which("chromium-headless-shell") or shutil.which("chromium")
        )
        browser = playwright.chromium.launch(executable_path=place, args=SOFTWARE)
        print(f"Chromium {browser.version}, drawing in software; goal: {GOAL:g} pictures a second at the low setting\n")
        print(f"| window | setting | {' | '.join(VIEWS)} |\n| --- | --- |{' ---: |' * len(VIEWS)}")
        for name, (width, height) in SIZES.items():
            seen = browser.new_page(viewport={"width": width, "height": height})
            seen.goto(page.as_uri())
            for setting in SETTINGS:
                cells = [f"{rate:.0f}" for rate in rates(seen, setting, options.duration).values()]
                print(f"| {name} | {setting} | {' | '.join(cells)} |", flush=True)
            seen.close()
        browser.close()


if __name__ == "__main__":
    main()
