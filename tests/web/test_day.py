"""A campaign's day as a person does it, from the first field to the replay; the command line gives the same numbers."""

import io
import json
import tomllib
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from PIL import Image

from skisnow.campaign.store import Journals, Store
from skisnow.campaign.store.replayed import description_text
from skisnow.cli import main

from .browser_types import Download, Locator, Page
from .conftest import Served, downloaded_results, entered, fill, follow, has_text, killed_and_started_again, ready

SERIES = {
    "1": ("30", ("1.5", "22.5", "2.6", "3.0")),  # the second one is a typing error for 2.15
    "2": ("30", ("1,4", "2,0", "2.5", "2.9")),
    "3": ("45", ("1.9", "2.7", "3.3", "3.8")),
}
LOADS = ("20", "40", "60", "80")


TOOL: dict[str, str | float] = {"name": "ski piece", "shape": "ski", "length_mm": 200.0, "width_mm": 62.0}
PLATE: dict[str, str | float] = {"name": "plate", "length_mm": 100.0}
VALUES: dict[str, str | float | tuple[str, ...] | tuple[float, ...]] = {
    "name": 'The day <b>"of" & tests</b>',
    "place": "a slope",
    "observers": ("Ada", "Bo"),
    "load_steps_N": tuple(map(float, LOADS)),
    "gauge_resolution_mm": 0.01,
    "moment_uncertainty_Nm": 0.5,
}


def create(page: Page, served: Served) -> None:
    """Open what `describe` makes, from the store: as good for later tests, and there at once."""
    text = description_text(VALUES, [TOOL], [PLATE])
    with Store.open(served.store) as store:
        id_ = Journals(store).begin(text)
    page.goto(f"{served.address}enter/{id_}")
    page.get_by_role("heading", name="New series").wait_for()


def describe(page: Page, served: Served) -> None:
    page.goto(served.address)
    follow(page, "New campaign")
    page.get_by_role("heading", name="New campaign").wait_for()
    fill(
        page,
        {
            "Name of the campaign": 'The day <b>"of" & tests</b>',
            "Place": "a slope",
            "Observers, with commas between": "Ada, Bo",
            "Disc loads (N), with blanks between": " ".join(LOADS),
            "Step of the depth gauge (mm)": "0.01",
            "Uncertainty of the moment (N m)": "0,5",
            "Name of tool 1": "ski piece",
            "Length (mm) of tool 1": "200",
            "Width (mm) of tool 1": "62",
            "Name of plate 1": "plate",
            "Length (mm) of plate 1": "100",
        },
    )
    page.get_by_role("button", name="Store and enter tests").press("Enter")
    page.get_by_role("heading", name="New series").wait_for()


def enter_series(page: Page, name: str) -> None:
    """From the form of a new series on, by keyboard only."""
    angle, depths = SERIES[name]
    fill(page, {"Name of the test": name, "Site": "A", "Edge angle (°)": angle})
    page.keyboard.press("Enter")
    page.keyboard.type("".join(f"{depth}\n" for depth in depths))
    page.get_by_role("heading", name=f"Series {name}").wait_for()
    page.get_by_text(f"Stored: {depths[-1].replace(',', '.')} mm under {LOADS[-1]} N.").wait_for()


def correct_the_typing_error(page: Page) -> None:
    page.get_by_label("Depth under 40 N (mm)").fill("2.15")
    page.keyboard.type("\n\n")  # and the usual reason
    page.get_by_text("Corrected; the first reading is kept.").wait_for()
    page.get_by_text("corrected from 22.5").wait_for()


def cancel(page: Page) -> None:
    ready(page)
    page.get_by_role("button", name="Cancel this test").press("Enter")
    page.keyboard.type("the tool slipped\n")
    page.get_by_text("Cancelled: the tool slipped").wait_for()


def next_series(page: Page) -> None:
    ready(page)
    page.get_by_role("button", name="Next series").press("Enter")
    page.get_by_role("heading", name="New series").wait_for()
    ready(page)


def enter_shear(page: Page) -> None:
    follow(page, "Shear")
    page.get_by_role("heading", name="New test").wait_for()
    page.keyboard.type("A\n90\n6\n250\n30\n")
    page.get_by_text("S_f = 0.200 N/mm²").wait_for()  # 30 N m / 0.25 m / (100 mm × 6 mm), by hand
    page.keyboard.type("8\n36\n")
    page.get_by_text("Stored: test 2.").wait_for()


def simulate(page: Page, served: Served) -> dict[str, Any]:
    """A tenth of a second on the snow of the campaign; the run's summary."""
    page.goto(f"{served.address}simulate")
    ready(page)
    page.get_by_label("Snow", exact=True).press("Space")
    page.get_by_role("option", name='The day <b>"of" & tests</b>').click()
    page.get_by_text("Snow: H_V = ").wait_for()  # until then it is being analysed, and nothing begins
    page.get_by_label("Ends after (s)", exact=True).fill("0.1")
    page.get_by_role("button", name="Simulate").press("Enter")
    page.get_by_role("link", name="Watch").wait_for()
    (place,) = (served.store.parent / "lab").glob("*/summary.json")
    summary: dict[str, Any] = json.loads(place.read_text(encoding="utf-8"))
    return summary


def watch(page: Page) -> None:
    """The replay's canvas shows something, and something else while it plays."""
    follow(page, "Watch")
    page.wait_for_function("window.skisnowReplay")
    page.evaluate("() => { window.draws = true; skisnowReplay.pause(); skisnowReplay.seek(0); }")
    canvas = page.locator("canvas.replay-canvas")
    before = picture(canvas)
    assert len(np.unique(before.reshape(-1, 3), axis=0)) > 50  # snow alone has shades, a blank canvas has one
    page.get_by_role("button", name="Play").press("Enter")
    page.wait_for_function("window.skisnowReplay.time > 0.05")
    assert np.any(picture(canvas) != before, axis=-1).mean() > 0.01


def picture(canvas: Locator) -> npt.NDArray[np.uint8]:
    with Image.open(io.BytesIO(canvas.screenshot())) as image:
        return np.asarray(image.convert("RGB"))


def unpacked(download: Download, place: Path) -> Path:
    with zipfile.ZipFile(download.path()) as packed:
        packed.extractall(place)
    return place


@pytest.mark.slow
def test_a_day(page: Page, served: Served, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    describe(page, served)
    found = tomllib.loads(entered(served).description)
    listed = {key: list(value) if isinstance(value, tuple) else value for key, value in VALUES.items()}
    assert found == {**listed, "tool": [TOOL], "plate": [PLATE]}
    enter_series(page, "1")
    page.get_by_text("below the one before it").wait_for()  # the mark in words, while the error stands
    correct_the_typing_error(page)
    page.get_by_text("below the one before it").wait_for(state="detached")
    next_series(page)
    enter_series(page, "2")
    killed_and_started_again(page, served)  # all that was shown as stored is stored
    page.get_by_role("heading", name="Series 2").wait_for()
    has_text(page.get_by_label("Depth under 80 N (mm)"), "2.9")
    next_series(page)
    enter_series(page, "3")
    cancel(page)
    enter_shear(page)
    assert page.get_by_role("heading", level=1).inner_text() == 'The day <b>"of" & tests</b>'

    follow(page, "Analysis")
    page.get_by_text("3 penetration experiments (2 used), 2 shear experiments (2 used)").wait_for()
    by_lab = downloaded_results(page)

    summary = simulate(page, served)
    watch(page)

    page.goto(served.address)
    with page.expect_download() as download:
        follow(page, "Export")
    folder = unpacked(download.value, tmp_path / "export") / "campaign"
    assert main(["analyse", str(folder), "--json"]) == 0
    by_command = json.loads(capsys.readouterr().out)
    for results in (by_command, by_lab):
        results["provenance"].pop("time")
    assert by_command == by_lab
    check_numbers(by_command, summary)


def check_numbers(results: dict[str, Any], summary: dict[str, Any]) -> None:
    """The analysis is what a hand computes, and the run was on this snow."""
    rows = {row["experiment"]: row for row in results["penetration"]["experiments"]}
    assert [rows[name]["used"] for name in "123"] == [True, True, False]
    # by hand, Eqn 2 of a wedge: V = L e² / (2 tan ϑ) at ϑ = 30°, e = 3 mm and 2.9 mm: H_V = 80 N / V
    by_hand = [80.0 / (200.0 * e**2 / (2.0 * 3.0**-0.5)) for e in (3.0, 2.9)]
    for name, hardness in zip("12", by_hand, strict=True):
        assert abs(rows[name]["H_V_N_per_mm3"] / hardness - 1.0) < 1e-9
    corrections = results["campaign"]["corrections"]
    assert [(each["column"], each["old"], each["new"]) for each in corrections] == [
        ("depth_mm", "22.5", "2.15"),
        ("status", "", "the tool slipped"),
    ]
    assert summary["outcome"] == "finished"
    snow = summary["scenario"]["snow"]
    # geometric mean of the used H_V; mean of the S_f 30/(0.25 × 0.1 × 0.006) and 36/(0.25 × 0.1 × 0.008) Pa
    assert abs(snow["H_V_N_per_mm3"] / (by_hand[0] * by_hand[1]) ** 0.5 - 1.0) < 1e-9
    assert abs(snow["S_f_N_per_mm2"] / ((0.2 + 0.18) / 2.0) - 1.0) < 1e-9
