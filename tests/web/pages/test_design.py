"""*Design*: the ski of its sliders beside a competitor, the search for a radius, and its files."""

import math
import tomllib
from ast import literal_eval
from typing import Any

import pytest

import skisnow
from skisnow.report.formatting import significant
from skisnow.ski.ski_file import ski_of_keys
from skisnow.snow import SnowProperties
from skisnow.web.lab_skis import LabSkis, texts_of_ski

from .desk import Desk, Sheet
from .test_carve import ANGLE, LOAD, move, slider, told

SIDECUT, WAIST, TIP, TAIL = "Sidecut, tip and tail (mm)", "Waist (mm)", "Tip (mm)", "Tail (mm)"
STIFFNESS, FRONT = "Stiffness EI ×", "EI before the middle ×"
KEYS = skisnow.read_ski("slalom").keys or {}
SNOW = SnowProperties(2e8, 5e5, source="sliders")


def carved(changes: dict[str, Any], angle: float = math.pi / 4, load: float = 800.0) -> skisnow.Equilibrium:
    """The library's answer for the slalom ski with changed keys."""
    return skisnow.carve(ski_of_keys({**KEYS, **changes}), SNOW, edge_angle=angle, load=load, unloading_ratio=10.0)


def headlines(page: Sheet) -> list[str]:
    return [line.removeprefix("[value] ") for line in page.outline() if line.startswith("[value] ")]


def peak(found: skisnow.Equilibrium) -> str:
    assert found.force_per_length is not None
    return f"{significant(found.force_per_length.max())} N/m"


def radius(name: str, found: skisnow.Equilibrium) -> str:
    return f"{name}: carved radius {significant(found.turn_radius_boot)} m"


def downloaded(page: Sheet) -> dict[str, Any]:
    return tomllib.loads(literal_eval(page.scripts[-1].removeprefix("download "))["src"].decode())


@pytest.mark.parametrize(
    ("name", "stop", "shown", "changes"),
    [
        (SIDECUT, 22, "-4", {"tip_width_mm": 112, "tail_width_mm": 97}),
        (WAIST, 34, "+2", {"waist_width_mm": 70}),
        (TIP, 24, "-3", {"tip_width_mm": 113}),
        (TAIL, 31, "+0.5", {"tail_width_mm": 101.5}),
        (STIFFNESS, 14, "1.2", {"EI_N_m2": [120, 300, 528, 312, 120]}),
        (FRONT, 6, "0.8", {"EI_N_m2": [80, 200, 440, 260, 100]}),
    ],
)
def test_the_ski_follows_its_sliders(desk: Desk, name: str, stop: int, shown: str, changes: dict[str, Any]) -> None:
    page = desk.open("/design?ski=slalom")
    page.shows("slalom, designed: equilibrium. slalom: equilibrium.")
    first = carved({})
    assert headlines(page) == [radius("slalom, designed", first), radius("slalom", first)]
    move(page, name, stop)
    found = carved(changes)
    assert f"{name}: {shown.replace('-', '−')}" in page.outline()
    page.until(lambda: peak(found) in page.outline())
    assert headlines(page) == [radius("slalom, designed", found), radius("slalom", first)]
    page.press("Download the file")
    for key, value in changes.items():
        assert downloaded(page)[key] == pytest.approx(value)


def test_both_skis_are_in_the_same_turn(desk: Desk) -> None:
    page = desk.open("/design?ski=slalom&other=carver")
    move(page, ANGLE, 30)
    move(page, LOAD, 20)
    other = skisnow.read_ski("carver").keys or {}
    skis = [carved(keys, math.radians(30.0), 1100.0) for keys in ({}, dict(other))]
    page.shows(radius("carver", skis[1]))
    lines = page.outline()
    begin = lines.index("Grip utilisation (1: side-slip)")
    deflections = [each.bending[abs(each.station - 0.4).argmin()] * 1e3 for each in skis]  # type: ignore[index]
    values = {
        "Grip utilisation (1: side-slip)": [significant(each.grip_utilisation) for each in skis],
        "Shear capacity of the snow": [f"{significant(each.side_force_limit)} N" for each in skis],
        "Greatest force per length": list(map(peak, skis)),
        "Deflection 0.4 m before the boot": [f"{significant(each)} mm" for each in deflections],
    }
    assert lines[begin : begin + 12] == [line for words, two in values.items() for line in (words, *two)]
    force = page.charts()["Normal force per length (N/m)"]["lines"]
    for line, each in zip(force, skis, strict=True):
        assert line["y"] == pytest.approx(each.force_per_length, rel=1e-3, abs=0.05)


def test_a_ski_that_cannot_be_is_rejected_and_the_next_one_is_answered(desk: Desk) -> None:
    page = desk.open("/design?ski=slalom")
    page.shows("equilibrium")
    page.fill("Ski", "giant-slalom")
    page.shows("giant-slalom, designed: equilibrium.")
    move(page, WAIST, 60)
    move(page, SIDECUT, 0)
    page.until(lambda: "equilibrium" not in told(page) and "Computing" not in told(page))
    assert (desk.code, desk.fields["key"]) == ("out_of_range", "tail_width_mm")
    page.fill("Ski", "slalom")
    page.shows("slalom, designed: equilibrium.")
    assert f"{WAIST}: +0" in page.outline()
    assert page.scripts.count(f"getHtmlElement({slider(page, WAIST).id}).value = 30") == 2


def test_the_search_sets_sidecut_and_stiffness(desk: Desk) -> None:
    page = desk.open("/design?ski=slalom")
    page.shows("equilibrium")
    move(page, WAIST, 34)
    page.fill("Wanted radius (m)", "12,5")
    page.press("Find the design")
    page.shows("[status good] Sidecut and stiffness are set")
    page.shows("slalom, designed: carved radius 12.5 m")
    page.press("Download the file")
    found = downloaded(page)
    assert found["waist_width_mm"] == 70
    assert found["tip_width_mm"] - KEYS["tip_width_mm"] == pytest.approx(found["tail_width_mm"] - KEYS["tail_width_mm"])
    assert carved(found).turn_radius_boot == pytest.approx(12.5, rel=1e-6)


@pytest.mark.parametrize(("typed", "told_of"), [("300", "turn_radius_boot_m"), ("wide", "the wanted radius")])
def test_a_radius_out_of_reach_is_reported(desk: Desk, typed: str, told_of: str) -> None:
    page = desk.open("/design?ski=slalom")
    page.shows("equilibrium")
    page.fill("Wanted radius (m)", typed)
    page.press("Find the design")
    assert told_of in page.shows("[status bad]")


def test_the_ski_is_saved_in_the_lab(desk: Desk) -> None:
    page = desk.open("/design?ski=slalom", "de")
    page.shows("slalom")
    move(page, "Mitte (mm)", 34)
    page.fill("Neuer Name", "my slalom")
    page.press("Im Labor speichern")
    page.shows("[status good]")
    ski = skisnow.read_ski(LabSkis(desk.lab.runs).word("my slalom"))
    assert (ski.name, (ski.keys or {})["waist_width_mm"]) == ("my slalom", 70.0)
    assert "my slalom" in page.field("Verglichen mit").options
    page.press("Im Labor speichern")
    page.shows("[status bad]")
    assert desk.code == "already_there"


def test_only_skis_of_widths_and_a_list_of_stiffness_are_designed(desk: Desk) -> None:
    skis = LabSkis(desk.lab.runs)
    skis.save_texts("of a table", *texts_of_ski(skisnow.read_ski("carver")))
    skis.save_texts("broken", skis.texts("slalom")[0], "")
    (desk.lab.runs / "skis" / "broken" / "ski.toml").write_text("length_mm = 'a'", encoding="utf-8")
    page = desk.open("/design")
    assert set(page.field("Ski").options) == {"carver", "giant-slalom", "slalom"}
    assert {"of a table", "nothing"} <= set(page.field("Compared with").options)
    page.fill("Compared with", "nothing")
    page.until(lambda: len(headlines(page)) == 1)
