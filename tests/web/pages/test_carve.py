"""*Carve*: its contents, and what its sliders and menus ask for."""

import io
import json
import re
import threading
from ast import literal_eval
from functools import cache
from pathlib import Path
from typing import Any
from unittest.mock import Mock

import pytest

from skisnow.campaign import read_campaign
from skisnow.carving.answer import answer_dict, answer_question
from skisnow.carving.question import carve_question
from skisnow.estimation import analyse, results_dict
from skisnow.estimation.results import results_json
from skisnow.report.formatting import significant
from skisnow.web.lab_skis import LabSkis
from skisnow.web.pages import carve as carve_page

from ..campaign_texts import HARD, SHEARED, SOFT, pressed, sheared
from .desk import Desk, Sheet

ANGLE, LOAD = "Edge angle (°)", "Load on this ski (N)"
HARDNESS, STRESS = "Snow hardness H_V (N/mm³)", "Failure shear stress S_f (N/mm²)"
RATIO = "Unloading ratio k_u/H_V"
FIRST_SNOW = {"H_V_N_per_mm3": 0.2, "S_f_N_per_mm2": 0.5}
FACTS = {
    "Load on the forebody": ("forebody_load_N", "N"),
    "Load on the afterbody": ("afterbody_load_N", "N"),
    "Contact length": ("contact_length_m", "m"),
    "Side force": ("side_force_N", "N"),
    "Shear capacity of the snow": ("side_force_limit_N", "N"),
    "Grip utilisation (1: side-slip)": ("grip_utilisation", ""),
    "Total force of the snow": ("total_force_N", "N"),
    "Moment at the boot about the cross axis": ("boot_pitch_moment_Nm", "N\u00a0m"),
    "Radius if the side force follows the pressure on the base": ("turn_radius_boot_other_spread_m", "m"),
    "Radius through the ends of the contact": ("turn_radius_chord_m", "m"),
}
CHARTS = {
    "Depth of the edge (mm)": "edge_depth_mm",
    "Normal force per length (N/m)": "force_per_length_N_per_m",
    "Deflection (mm)": "bending_mm",
    "Twist (°)": "twist_deg",
}
DEPTH = next(iter(CHARTS))
SHEAR = sheared({"a": ("A", 20)})


@cache
def answer(ski: str = "carver", angle: float = 45.0, load: float = 800.0, ratio: float = 10.0, snow: str = "") -> Any:
    """The library's answer; ``snow`` as JSON."""
    numbers = {"ski": ski, "edge_angle_deg": angle, "load_N": load, "unloading_ratio": ratio}
    return answer_dict(answer_question(carve_question(numbers | (json.loads(snow) if snow else FIRST_SNOW))))


def radius(found: Any) -> str:
    return f"[value] {found['ski']['name']}: carved radius {significant(found['turn_radius_boot_m'])} m"


def facts(*found: Any) -> list[str]:
    """The lines of the table."""
    lines = [each["ski"]["name"] for each in found]
    for words, (key, unit) in FACTS.items():
        lines += [words, *(f"{significant(each[key])} {unit}".rstrip() for each in found)]
    return lines


def slider(page: Sheet, name: str) -> Any:
    (found,) = (each for each in page.tagged("input") if each.props.get("aria-label") == name)
    return found


def move(page: Sheet, name: str, place: object) -> None:
    page.fire(slider(page, name), "input", place)


def told(page: Sheet) -> str:
    return next(line for line in page.outline() if line.startswith("[status] ")).removeprefix("[status] ")


def held(monkeypatch: pytest.MonkeyPatch) -> tuple[threading.Event, list[Any]]:
    """Answers that come when the event is set, and the questions."""
    released, asked = threading.Event(), list[Any]()
    at_once = carve_page.Solver.answers

    def late(self: Any, questions: Any) -> Any:
        asked.append(questions.questions)
        assert released.wait(300)
        return at_once(self, questions)

    monkeypatch.setattr(carve_page.Solver, "answers", late)
    return released, asked


def said_instead(monkeypatch: pytest.MonkeyPatch, *found: Any) -> None:
    """Let these be the answers."""
    monkeypatch.setattr(carve_page.Solver, "answers", lambda *_: list(found))


def campaign(desk: Desk, folder: Path, *, shear: str = "") -> str:
    """A kept campaign with two sites: how the menu calls it."""
    files = {"campaign.toml": SHEARED, "penetration.csv": pressed({"1": ("A", SOFT), "2": ("B", HARD)})}
    return f"kept-{desk.kept(folder, files | ({'shear.csv': shear} if shear else {}))}"


def test_a_turn_is_there_with_the_page(desk: Desk) -> None:
    page, found = desk.open("/carve"), answer()
    page.shows("carver: equilibrium.")
    lines = page.outline()
    assert lines[1] == radius(found)
    begin = lines.index("carver")
    assert lines[begin : begin + len(facts(found))] == facts(found)
    values = (ANGLE, "45"), (LOAD, "800"), (HARDNESS, "0.2"), (STRESS, "0.5")
    assert {f"{name}: {value}" for name, value in values} <= set(lines)
    for line, key in zip(lines[-4:], CHARTS.values(), strict=True):
        numbers = [each for each in found[key] if each is not None]
        assert line.endswith(f"{significant(min(numbers))} to {significant(max(numbers))} (carver)")
    assert [each.text for each in page.of() if each.props.get("aria-current") == "page"] == ["Carve"]


@pytest.mark.parametrize(
    ("name", "place", "stands", "asked"),
    [
        (ANGLE, "46", "46", {"angle": 46.0}),
        (ANGLE, "-3", "0", {"angle": 0.0}),
        (LOAD, "15", "850", {"load": 850.0}),
        (LOAD, "1000", "3000", {"load": 3000.0}),
        (HARDNESS, "8", "0.25", {"snow": json.dumps(FIRST_SNOW | {"H_V_N_per_mm3": 0.25})}),
        (STRESS, "24", "0.52", {"snow": json.dumps(FIRST_SNOW | {"S_f_N_per_mm2": 0.52})}),
    ],
)
def test_the_answer_follows_a_slider(desk: Desk, name: str, place: str, stands: str, asked: Any) -> None:
    page = desk.open("/carve")
    page.shows("carver: equilibrium.")
    move(page, name, place)
    assert f"{name}: {stands}" in page.outline()
    found = answer(**asked)
    line = f"{significant(found['side_force_limit_N'])} N"
    page.until(lambda: line in page.outline())
    assert told(page).startswith(f"carver: {found['outcome']}")
    headline = next(words for words in page.outline() if words.startswith("[value] "))
    if found["turn_radius_boot_m"] is None:
        assert not re.search(r"\d", headline)
    else:
        assert headline == radius(found)


def test_the_ratio_is_requested(desk: Desk) -> None:
    page = desk.open("/carve")
    page.fill(RATIO, "inf")
    page.shows(radius(answer(ratio=float("inf"))))
    assert radius(answer(ratio=float("inf"))) != radius(answer())


def test_the_curves_of_both_skis_are_downloaded(desk: Desk) -> None:
    import pandas

    page, found = desk.open("/carve?ski=slalom&other=carver"), (answer("slalom"), answer())
    page.shows("slalom: equilibrium. carver: equilibrium.")
    page.press("Curves as CSV")
    file = literal_eval(page.scripts[-1].removeprefix("download "))
    table = pandas.read_csv(io.BytesIO(file["src"]))
    assert list(table.columns) == ["ski", "station_m", *CHARTS.values()]
    for each in found:
        of_ski = table[table["ski"] == each["ski"]["name"]]
        for key in ("station_m", *CHARTS.values()):
            assert of_ski[key].tolist() == pytest.approx(each[key])


def test_depth_counts_downwards_to_a_little_below_the_deepest_edge(desk: Desk) -> None:
    page = desk.open("/carve?ski=slalom&other=carver")
    page.shows("slalom: equilibrium. carver: equilibrium.")
    deepest = max(each for ski in ("slalom", "carver") for each in answer(ski)["edge_depth_mm"] if each is not None)
    ranges = {title: chart["range"] for title, chart in page.charts().items()}
    assert ranges.pop(DEPTH) == pytest.approx((1.1 * deepest, -3.0))
    assert list(ranges.values()) == [None] * 3


def test_skis_that_are_not_there_are_not_chosen(desk: Desk) -> None:
    page = desk.open("/carve?ski=none&other=neither")
    page.shows("carver: equilibrium.")
    assert [page.field(name).value for name in ("Ski", "Compared with")] == ["carver", "nothing"]


def test_what_the_snow_cannot_hold_is_reported(desk: Desk) -> None:
    page = desk.open("/carve")
    page.shows("carver: equilibrium.")
    move(page, STRESS, "1")
    found = answer(snow=json.dumps(FIRST_SNOW | {"S_f_N_per_mm2": 0.06}))
    page.shows("slips")
    assert told(page) == f"carver: slips, {found['remedy']}."
    assert any(line.startswith(f"{radius(found)}, ") for line in page.outline())
    move(page, ANGLE, "70")
    found = answer(angle=70.0, snow=json.dumps(FIRST_SNOW | {"S_f_N_per_mm2": 0.06}))
    page.shows("Warning")
    (warning,) = found["warnings"]
    assert told(page) == f"carver: slips, {found['remedy']}. Warning: {warning}."


def test_a_turn_that_is_none_has_no_numbers(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    nothing = dict.fromkeys(("turn_radius_boot_m", *(key for key, _ in FACTS.values()), *CHARTS.values()))
    said_instead(monkeypatch, answer() | nothing | {"outcome": "not_converged", "remedy": "take less", "holds": False})
    page = desk.open("/carve")
    page.shows("[status] carver: not converged, take less.")
    lines = page.outline()
    assert not re.search(r"\d", lines[1])
    assert [line for line in lines if line == "–"] == ["–"] * len(FACTS)
    assert [chart["range"] for chart in page.charts().values()] == [None] * 4


def test_numbers_that_some_stations_lack_are_left_out(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    few = {"station_m": [-1.0, 0.0, 1.0], "edge_depth_mm": [None, 2.0, -4.0], "twist_deg": None}
    said_instead(monkeypatch, answer() | few, answer("slalom"))
    page = desk.open("/carve?other=slalom")
    page.shows("carver: equilibrium. slalom: equilibrium.")
    charts = page.charts()
    assert [line["name"] for line in charts["Twist (°)"]["lines"]] == ["slalom"]
    assert charts["Twist (°)"]["lines"][0]["style"] == 1
    assert charts[DEPTH]["lines"][0]["y"] == [None, 2.0, -4.0]


def test_a_published_snow_takes_the_place_of_its_sliders(desk: Desk) -> None:
    page = desk.open("/carve")
    page.fill("Snow", "published-race-piste")
    found = answer(snow='{"published": "race-piste"}')
    page.shows(radius(found))
    assert not [line for line in page.outline() if line.startswith((HARDNESS, STRESS))]
    assert f"{LOAD}: 800" in page.outline()
    page.shows(f"{significant(found['side_force_limit_N'])} N")
    page.fill("Snow", "the sliders")
    page.shows(radius(answer()))
    assert f"{HARDNESS}: 0.2" in page.outline()
    assert f"{STRESS}: 0.5" in page.outline()


@pytest.mark.parametrize(
    ("shear", "site", "own"), [("", "", {"S_f_N_per_mm2": 0.5}), ("", "B", {"S_f_N_per_mm2": 0.5}), (SHEAR, "", {})]
)
def test_measured_snow_of_a_campaign(desk: Desk, tmp_path: Path, shear: str, site: str, own: dict[str, float]) -> None:
    key = campaign(desk, tmp_path / "kept", shear=shear)
    (tmp_path / "results.json").write_bytes(results_json(results_dict(analyse(read_campaign(tmp_path / "kept")))))
    snow = {"results": str(tmp_path / "results.json"), **({"site": site} if site else {}), **own}
    found = answer(snow=json.dumps(snow))
    page = desk.open("/carve")
    page.fill("Snow", key)
    page.shows("[snow] Snow: H_V = ")
    if site:
        page.fill("Site", site)
    page.shows(radius(found))
    page.until(lambda: f"{significant(found['side_force_limit_N'])} N" in page.outline())
    assert [line for line in page.outline() if line.startswith((HARDNESS, STRESS))] == [f"{STRESS}: 0.5" for _ in own]


def test_a_ski_that_cannot_be_read_is_reported(desk: Desk) -> None:
    skis = LabSkis(desk.lab.runs)
    skis.save_texts("mine", skis.texts("slalom")[0], "")
    page = desk.open("/carve?ski=mine")
    page.shows("[status] mine: equilibrium.")
    skis.save_texts("other", skis.texts("slalom")[0], "")
    page = desk.open("/carve")
    page.shows("[status] carver: equilibrium.")
    path = desk.lab.runs / "skis" / "other" / "ski.toml"
    path.write_text("length_m = 'a'", encoding="utf-8")
    page.fill("Ski", "other")
    assert page.shows(str(path)).startswith(f"[status] {path}")
    page.fill("Ski", "slalom")
    page.shows("[status] slalom: equilibrium.")


def test_a_late_answer_is_reported_and_one_question_waits(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    released, asked = held(monkeypatch)
    monkeypatch.setattr(carve_page, "PATIENCE_S", 0.0)
    page = desk.open("/carve")
    assert told(page) == "Computing …"
    page.until(lambda: asked)
    for place in ("46", "47", "48"):
        move(page, ANGLE, place)
    released.set()
    page.shows(radius(answer(angle=48.0)))
    assert [[each["edge_angle_deg"] for each in questions] for questions in asked] == [[45.0], [48.0]]
    released.clear()
    move(page, ANGLE, "49")
    page.shows("[status] Computing …")
    assert radius(answer(angle=48.0)) in page.outline()
    released.set()
    page.shows("[status] carver: equilibrium.")
    page.shows(radius(answer(angle=49.0)))


def test_what_goes_wrong_behind_a_page_is_reported_on_it(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    page = desk.open("/carve")
    page.shows("[status] carver: equilibrium.")
    failure = ZeroDivisionError("division by zero")
    monkeypatch.setattr(carve_page.Solver, "answers", Mock(side_effect=failure))
    move(page, ANGLE, "49")
    assert desk.fails() is failure
    page.told("notify ")
    assert "Reference: " in page.scripts[-1]
