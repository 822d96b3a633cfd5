"""``python -m benchmarks.web.design``: times of the lab's page *Design*, on the server and to the picture."""

from __future__ import annotations

import os
import shutil
import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from skisnow.carving.outputs import OUTPUTS
from skisnow.design.evaluation import Evaluator
from skisnow.design.task import design_task

from .filled_lab import served
from .opening import DRAWN, PATIENCE_MS
from .reacting import moved_slider

if TYPE_CHECKING:
    from skisnow._support.arrays import FloatArray

SLIDERS: Final = ("Waist (mm)", "Stiffness EI ×", "Edge angle (°)")
LINES: Final = 4
"""Two charts with a line for each of the two skis."""
CHARTS: Final = 2
STEPS: Final = 40
_TURN: Final = {"published": "race-piste", "unloading_ratio": 10, "edge_angle_deg": 45, "load_N": 800}


def on_server() -> FloatArray:
    """Milliseconds for a ski that was changed: equilibrium, all outputs, their derivatives by the ski's sliders."""
    variables = {
        "sidecut_mm": [-10, 10],
        "waist_width_mm": [64, 74],
        "tip_width_mm": [110, 130],
        "tail_width_mm": [95, 115],
        "EI_factor": [0.7, 1.6],
    }
    goal = {"output": "turn_radius_boot_m", "target": 12.0}
    task = design_task({"ski": "slalom", "variables": variables, "conditions": [_TURN], "goals": [goal]})
    evaluator, found = Evaluator(task), []
    for z in np.random.default_rng(1).uniform(0.4, 0.6, (STEPS, len(variables))):
        began = time.perf_counter()
        evaluator.output_growths([(0, output) for output in OUTPUTS], z)
        found.append(1e3 * (time.perf_counter() - began))
    return np.array(found[1:])


def to_picture(browser: Any, address: str) -> dict[str, FloatArray]:
    """Milliseconds from a slider to the numbers and to the charts of both skis, by slider."""
    page = browser.new_context(viewport={"width": 1280, "height": 900}).new_page()
    page.goto(f"{address}/design?other=carver")
    page.wait_for_function(f"{DRAWN} >= {LINES}", timeout=PATIENCE_MS)
    found = {name: np.array(moved_slider(page, name, CHARTS)) for name in SLIDERS}
    page.context.close()
    return found


def _line(what: str, milliseconds: FloatArray, goal: float) -> str:
    middle, most = np.percentile(milliseconds, [50, 95])
    return f"| {what} | {middle:.0f} ms | {most:.0f} ms | {len(milliseconds)} | {goal:.0f} ms |"


def main() -> None:
    """Print the table; without Chromium the first row."""
    print(f"{os.getloadavg()[0]:.1f} processes were busy before\n")
    print("| what | median | 95 % | of | goal |\n| --- | ---: | ---: | ---: | ---: |")
    print(_line("server: one ski with derivatives", on_server(), 30.0), flush=True)
    place = os.environ.get("SKISNOW_CHROMIUM") or shutil.which("chromium") or shutil.which("chromium-headless-shell")
    if place is None:
        return
    from playwright.sync_api import sync_playwright

    with TemporaryDirectory() as folder, served(Path(folder) / "store") as address, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=place, args=["--no-sandbox"])
        for name, times in to_picture(browser, address).items():
            print(_line(f"{name}: numbers", times[:, 0], 100.0))
            print(_line(f"{name}: charts", times[:, 1], 100.0), flush=True)
        browser.close()


if __name__ == "__main__":
    main()
