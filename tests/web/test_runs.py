"""Simulations in the queue survive the server, and give what the command line gives."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from skisnow._support.units import N_PER_MM2, N_PER_MM3
from skisnow.campaign import read_campaign, write_reference
from skisnow.campaign.store import Store
from skisnow.estimation import analyse, results_dict
from skisnow.estimation.results import results_json
from skisnow.report.formatting import significant
from skisnow.snow import snow_from_results
from skisnow.web.lab_skis import LabSkis

from .conftest import Served, killed_and_started_again

if TYPE_CHECKING:
    from playwright.sync_api import Locator, Page

    from skisnow.snow import SnowProperties

LONG_MS = 120_000  # seconds, more on a busy machine


@pytest.mark.slow
def test_a_run_that_the_server_was_killed_in_is_begun_again(page: Page, served: Served) -> None:
    page.goto(f"{served.address}simulate")
    page.get_by_label("Ends after (s)", exact=True).fill("0.2")
    page.get_by_role("button", name="Simulate").click()
    page.get_by_text("is in the queue.").wait_for()
    page.get_by_text("running").first.wait_for()
    killed_and_started_again(page, served)
    page.get_by_text("finished: ").wait_for(timeout=LONG_MS)
    page.get_by_role("link", name="Watch").wait_for()
    (place,) = (served.store.parent / "lab").glob("*/summary.json")
    summary = json.loads(place.read_text(encoding="utf-8"))
    assert summary["outcome"] == "finished"
    assert summary["scenario"]["run"]["duration_s"] == 0.2


def test_a_value_that_cannot_be_is_refused_in_words(page: Page, served: Served) -> None:
    page.goto(f"{served.address}simulate")
    page.locator("summary", has_text="Expert inputs").click()
    wrong = page.get_by_label("Stance width (m)", exact=True)
    wrong.fill("-5")
    page.locator("summary", has_text="Expert inputs").click()
    page.get_by_role("button", name="Simulate").click()
    page.get_by_text("Not begun: Stance width (m) is -5").wait_for()
    page.get_by_text("Nothing was simulated yet.").wait_for()
    assert wrong.evaluate("field => field === document.activeElement && field.selectionEnd - field.selectionStart") == 2
    page.get_by_role("alert").get_by_text("Stance width (m) is -5").wait_for()


def kept_campaign(served: Served, folder: Path) -> tuple[str, SnowProperties]:
    """A campaign in the store, and its snow by the library."""
    write_reference(folder, seed=2)
    results = folder.with_suffix(".json")
    results.write_bytes(results_json(results_dict(analyse(read_campaign(folder)))))
    with Store.open(served.store) as store:
        return store.add(folder).id, snow_from_results(results)


def choose(page: Page, label: str, option: str) -> None:
    page.get_by_label(label, exact=True).click()
    page.get_by_role("option", name=option).click()


@pytest.mark.slow
def test_the_snow_of_a_campaign_comes_with_its_uncertainty(page: Page, served: Served, tmp_path: Path) -> None:
    id_, snow = kept_campaign(served, tmp_path / "reference")
    assert snow.snow_hardness_interval is not None and snow.failure_shear_stress_interval is not None
    LabSkis(served.store.parent / "lab").save_texts("mine", LabSkis(tmp_path).texts("giant-slalom")[0], "")
    page.goto(f"{served.address}simulate")
    choose(page, "Snow", id_)
    low, high = (significant(end / N_PER_MM3) for end in snow.snow_hardness_interval)
    page.get_by_text(f"H_V = {significant(snow.snow_hardness / N_PER_MM3)} N/mm³, [{low}, {high}]").wait_for()
    choose(page, "Ski", "mine")
    page.get_by_label("Ends after (s)", exact=True).fill("0.1")
    page.get_by_role("button", name="Simulate").click()
    page.get_by_text("finished: ").wait_for(timeout=LONG_MS)
    card = page.locator(".card").inner_text()
    assert "ski: mine" in card and f"[{low}, {high}]" in card and str(served.store.parent) not in card
    (place,) = (served.store.parent / "lab").glob("*/summary.json")
    summary = json.loads(place.read_text(encoding="utf-8"))
    # the same numbers, through a file of text
    assert summary["scenario"]["snow"]["H_V_N_per_mm3"] == pytest.approx(snow.snow_hardness / N_PER_MM3, rel=1e-12)
    assert summary["snow"]["H_V_interval_N_per_mm3"] == pytest.approx(
        [end / N_PER_MM3 for end in snow.snow_hardness_interval], rel=1e-12
    )
    assert summary["snow"]["S_f_interval_N_per_mm2"] == pytest.approx(
        [end / N_PER_MM2 for end in snow.failure_shear_stress_interval], rel=1e-12
    )
    assert summary["ski"]["name"] == "mine"
    page.get_by_role("link", name="Watch").click()
    page.wait_for_function("window.skisnowReplay")  # its ski is found, though the run was not with one of the catalogue


def pressed_while_it_goes_on(page: Page, button: Locator) -> None:
    """The finger goes down, the progress is shown again, the finger goes up; the keyboard's focus stays."""
    told = "document.querySelector('.card .progress:not(.hidden)').innerText"
    button.hover()
    page.mouse.down()
    page.wait_for_function(f"before => {told} !== before", arg=page.evaluate(told))
    button.and_(page.locator(":focus")).wait_for()
    page.mouse.up()


@pytest.mark.slow
def test_a_cancelled_run_keeps_what_was_computed(page: Page, served: Served) -> None:
    page.goto(f"{served.address}simulate")
    page.get_by_label("Ends after (s)", exact=True).fill("60")
    page.get_by_label("Ends after a way of (m)", exact=True).fill("900")
    page.locator("summary", has_text="Expert inputs").click()  # long to compute, and few rows to write
    page.get_by_label("Distance of the snow lines (mm)", exact=True).fill("2")
    page.get_by_label("Time between outputs (ms)", exact=True).fill("100")
    for _ in range(2):
        page.get_by_role("button", name="Simulate").click()
        page.get_by_text("is in the queue.").wait_for()
    page.get_by_text("times real time").wait_for(timeout=LONG_MS)
    waiting = page.get_by_role("button", name="Cancel").first  # the newest is on top
    waiting.click()
    page.get_by_text("cancelled · It had not begun.").wait_for()
    pressed_while_it_goes_on(page, page.get_by_role("button", name="Cancel"))
    page.get_by_text("The results so far are kept.").wait_for(timeout=LONG_MS)
    (place,) = (served.store.parent / "lab").glob("*/summary.json")
    summary = json.loads(place.read_text(encoding="utf-8"))
    assert summary["outcome"] == "interrupted"
    assert 0.0 < summary["simulated_s"] < 60.0
    assert {"run.nc", "track.csv", "report.html"} <= {each.name for each in place.parent.iterdir()}
    page.get_by_role("link", name="Watch").click()
    page.wait_for_function("window.skisnowReplay")
    assert page.evaluate("skisnowReplay.run.arrays.time.values.at(-1)") == pytest.approx(
        summary["simulated_s"], abs=0.11
    )
