"""The analysis page follows what is chosen, and computes nothing again while nothing was entered."""

from __future__ import annotations

import re
import urllib.request
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from skisnow.campaign import read_campaign, write_reference
from skisnow.campaign.store import Journals, NewEntry, Store
from skisnow.estimation import analyse, results_dict
from skisnow.web.campaign_analysis import choosable_flags

from .conftest import DRAWING_MS, Served, downloaded_results, ready

if TYPE_CHECKING:
    from playwright.sync_api import Page, WebSocketRoute

SEED = 3
DESCRIPTION = """name = "growing"
load_steps_N = [20, 40, 60]
gauge_resolution_mm = 0.01
[[tool]]
name = "ski piece"
shape = "ski"
length_mm = 200
width_mm = 62
"""


def kept_campaign(served: Served, folder: Path) -> str:
    write_reference(folder, seed=SEED)
    with Store.open(served.store) as store:
        return store.add(folder).id


def used(results: dict[str, object]) -> tuple[int, int]:
    counts = []
    for kind in ("penetration", "shear"):
        part = results[kind]
        assert isinstance(part, dict)
        counts.append(sum(row["used"] for row in part["experiments"]))
    return counts[0], counts[1]


def html(served: Served, path: str) -> str:
    """The server's first answer to a browser."""
    with urllib.request.urlopen(served.address.rstrip("/") + path) as answer:
        return str(answer.read().decode())


@pytest.mark.slow
def test_one_experiment_less_by_choice(page: Page, served: Served, tmp_path: Path) -> None:
    id_ = kept_campaign(served, tmp_path / "reference")
    campaign = read_campaign(tmp_path / "reference")
    results = results_dict(analyse(campaign))
    pressed, sheared = used(results)
    of_pressed, of_sheared = (len(results[kind]["experiments"]) for kind in ("penetration", "shear"))

    def told(n: int) -> str:
        return f"{of_pressed} penetration experiments, {n} used; {of_sheared} shear experiments, {sheared} used."

    page.goto(f"{served.address}analysis/kept/{id_}")
    assert used(downloaded_results(page)) == (pressed, sheared)  # asked for before there was anything
    page.get_by_text(told(pressed), exact=True).wait_for(timeout=DRAWING_MS)
    drawn = page.locator("figure img").count()
    assert drawn >= 8
    page.set_viewport_size({"width": 390, "height": 844})
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    assert page.locator(".scroll").first.evaluate("(box) => box.scrollWidth > box.clientWidth && box.clientWidth > 0")
    page.set_viewport_size({"width": 1280, "height": 720})
    page.locator("summary", has_text="Included experiments").press("Enter")
    first = next(row for row in results["penetration"]["experiments"] if row["used"])
    words = f"Penetration {first['experiment']}, {first['site']}, {first['edge_angle_deg']:g}°"
    page.get_by_role("checkbox", name=words, exact=True).press("Space")
    given = downloaded_results(page)  # of the new choice, while the old one is still shown
    page.get_by_text(told(pressed - 1), exact=True).wait_for(timeout=DRAWING_MS)
    assert page.locator("figure img").count() == drawn
    row = next(row for row in given["penetration"]["experiments"] if row["experiment"] == first["experiment"])
    assert not row["used"] and "cancelled" in row["flags"]
    page.locator("summary", has_text="Exclude experiments with these quality flags").press("Enter")
    box = page.get_by_role("checkbox", name=choosable_flags()["layered"], exact=True)
    assert box.is_checked() == ("layered" in campaign.excluding)
    box.press("Space")
    excluding = campaign.excluding ^ {"layered"}
    more = used(results_dict(analyse(replace(campaign, excluding=excluding))))[0]
    assert more != pressed
    page.get_by_text(told(more - ("layered" not in first["flags"])), exact=True).wait_for(timeout=DRAWING_MS)
    page.locator("summary", has_text="Every penetration experiment").press("Enter")
    page.locator("details[open] table").get_by_text(str(first["experiment"]), exact=True).wait_for()
    page.set_viewport_size({"width": 390, "height": 844})
    wide = page.locator(".table", has=page.locator("caption", has_text="Table 2")).first
    wide.evaluate("(each) => each.scrollTo(each.scrollWidth, 0)")
    assert wide.evaluate("(each) => each.scrollLeft") > 100
    for stays in (wide.locator("caption"), wide.locator("tbody th").first):  # what the numbers are of
        seen = stays.bounding_box()
        assert seen is not None
        assert seen["x"] >= 0 and seen["x"] + seen["width"] <= 390


def test_the_numbers_are_there_with_the_page_until_something_is_entered(
    page: Page, served_with_figures: Served
) -> None:
    served = served_with_figures
    with Store.open(served.store) as store:
        journals = Journals(store)
        id_ = journals.begin(DESCRIPTION)
        last = 0
        for position, (load, depth) in enumerate((("20", "1.5"), ("40", "2.15"), ("60", "2.6"))):
            cells = {"experiment": "1", "site": "A", "spot": "", "tool": "ski piece", "edge_angle_deg": "30"}
            row = NewEntry(
                action="add", file="penetration.csv", test="1", position=position,
                cells={**cells, "load_N": load, "depth_mm": depth},
            )  # fmt: skip
            last = journals.append(id_, row, seen=last).sequence
    path = f"/analysis/entry/{id_}"
    assert "Computing" in html(served, path)
    page.goto(served.address.rstrip("/") + path)
    page.get_by_text("1 penetration experiment, 1 used; 0 shear experiments, 0 used.").first.wait_for()
    assert "1 penetration experiment, 1 used" in html(served, path)
    assert f"/enter/{id_}" in html(served, path)  # the way back
    drawn = page.locator("figure img").first
    drawn.wait_for()
    assert len(drawn.get_attribute("src") or "") > 5000 and drawn.evaluate("each => each.decode().then(() => true)")
    with Store.open(served.store) as store:
        cancelled = NewEntry(action="cancel", file="penetration.csv", test="1", why="the tool slipped")
        Journals(store).append(id_, cancelled, seen=last)
    assert "1 penetration experiment" not in html(served, path)
    page.reload()
    page.get_by_text("1 penetration experiment, 0 used").first.wait_for()


def test_the_report_is_of_what_was_chosen_just_before(page: Page, served: Served, tmp_path: Path) -> None:
    id_ = kept_campaign(served, tmp_path / "reference")
    said: list[tuple[WebSocketRoute, str | bytes]] = []
    is_slow = False

    def pass_on(socket: WebSocketRoute) -> None:
        lab = socket.connect_to_server()
        socket.on_message(lambda message: said.append((lab, message)) if is_slow else lab.send(message))

    page.route_web_socket("**/*", pass_on)
    page.goto(f"{served.address}analysis/kept/{id_}")
    page.locator(".status", has_text="used.").wait_for()
    ready(page)
    page.locator("summary", has_text="Included experiments").press("Enter")
    first = page.get_by_role("checkbox", name=re.compile("^Penetration P001,"))
    first.wait_for()
    is_slow = True
    first.press("Space")
    with page.expect_popup() as opened:
        page.get_by_role("link", name="Open the report").press("Enter")
        is_slow = False
        for lab, message in said:
            lab.send(message)
    report = opened.value
    report.wait_for_load_state()
    assert "cancelled" in report.content()
