"""Confined work, its values, and a lab that is killed."""

import math
import os
import sys
import threading
from pathlib import Path
from urllib.parse import parse_qs, urlsplit

import numpy as np
import pytest

from skisnow._support.errors import FieldDataError, ParameterError, StoreError
from skisnow.campaign.store import Journals, Store, replay_journal
from skisnow.studies import read_study
from skisnow.web.page_requests import address, analysis, correction_address, entry_address, export, required_id
from skisnow.web.study_fields import CARVE, Range, StudyQuestion
from skisnow.web.uploads import BOUNDS, Bounds, confined
from skisnow.web.widgets import _round_to_pixels
from skisnow.web.words import typed_number
from tests.coded import raises

from .browser_types import Page
from .confined_work import dies, is_wrong, other_process, refuse, takes_memory, takes_time
from .conftest import Served, entered, fill
from .test_day import create


def test_the_answer_and_the_errors_come_back() -> None:
    word, process = confined(BOUNDS, other_process, "snow")
    assert word == "snow"
    assert process != os.getpid()
    with pytest.raises(FieldDataError, match="a row is missing"):
        confined(BOUNDS, refuse)


def test_what_ends_the_other_process_is_reported_here(capfd: pytest.CaptureFixture[str]) -> None:
    for work in (dies, is_wrong):
        with raises(ParameterError, "cannot_read", seconds=120.0, megabytes=3000):
            confined(BOUNDS, work)
    assert "Traceback" not in capfd.readouterr().err


def test_time_has_an_end() -> None:
    with raises(ParameterError, "too_slow", seconds=0.5):
        confined(Bounds(seconds=0.5), takes_time)


@pytest.mark.skipif(sys.platform != "linux", reason="no such limit")
def test_memory_has_an_end() -> None:
    with raises(ParameterError, "cannot_read", seconds=120.0, megabytes=300):
        confined(Bounds(memory_bytes=300_000_000), takes_memory)


@pytest.mark.parametrize(
    ("address", "path", "query"),
    [
        (entry_address("ab12"), "/enter/ab12", {}),
        (entry_address("ab12", table="shear", test="s 1&2"), "/enter/ab12", {"table": ["shear"], "test": ["s 1&2"]}),
        (entry_address("a", table="b", head={"site": "A/B"}), "/enter/a", {"table": ["b"], "site": ["A/B"]}),
        (correction_address("ab12", test="7"), "/correct/ab12", {"test": ["7"]}),
        (analysis("kept", "ab12"), "/analysis/kept/ab12", {}),
        (export("entry", "ab12"), "/export/entry/ab12.zip", {}),
        (address("/carve", ski="my ski", other=""), "/carve", {"ski": ["my ski"]}),
        (address("/carve", ski="a/b", other="c&d"), "/carve", {"ski": ["a/b"], "other": ["c&d"]}),
    ],
)
def test_what_is_asked_is_in_the_address(address: str, path: str, query: dict[str, list[str]]) -> None:
    parts = urlsplit(address)
    assert (parts.path, parse_qs(parts.query)) == (path, query)


@pytest.mark.parametrize(
    ("said", "fits"),
    [("0af3", True), ("f" * 64, True), ("0af", False), ("f" * 65, False), ("0AF3", False), ("../a", False)],
)
def test_an_id_is_four_to_sixty_four_letters_and_digits(said: str, fits: bool) -> None:
    if fits:
        assert required_id(said) == said
    else:
        with raises(StoreError, "no_campaign"):
            required_id(said)


@pytest.mark.parametrize(("text", "value"), [("0,5", 0.5), (" 12.25 ", 12.25), ("−3", -3.0), ("1e-3", 1e-3)])
def test_as_hands_write_them(text: str, value: float) -> None:
    assert typed_number("the length", text) == value


@pytest.mark.parametrize("text", ["", "1x", "1.5.2", "nan", "inf", "1 2"])
def test_what_is_none_is_reported(text: str) -> None:
    with raises(ParameterError, "not_a_number", field="the length", value=text):
        typed_number("the length", text)


@pytest.mark.parametrize(
    ("values", "sent"),
    [
        ([12345.6789, -1.23456], [12346.0, -1.0]),
        ([0.0123456789, 0.001], [0.012346, 0.001]),
        ([1.0, None, math.inf, 0.123456], [1.0, None, None, 0.1235]),
        ([0.0, -0.0, None, math.nan], [0.0, 0.0, None, None]),
        ([None, math.inf], [None, None]),
        ([], []),
    ],
)
def test_five_digits_of_the_largest(values: list[float | None], sent: list[float | None]) -> None:
    assert _round_to_pixels(values) == sent


TURNS = StudyQuestion(
    CARVE,
    {"edge_angle_deg": Range(10.0, 70.0, 3), "H_V_N_per_mm3": Range(0.1, 10.0, 3, log=True)},
    {"ski": "slalom", "load_N": 800.0, "S_f_N_per_mm2": 0.5, "unloading_ratio": float("inf")},
)
RUNS = StudyQuestion(
    "carved-46m",
    {"start.speed_m_per_s": Range(6.0, 9.0, 2)},
    {"run.duration_s": 0.1, "ski.name": "slalom", "sledge.inertia_kg_m2": (6.0, 8.0, 10.0)},
)


def test_its_file_asks_for_the_same_points(tmp_path: Path) -> None:
    for asked in (TURNS, RUNS):
        (tmp_path / "study.toml").write_bytes(asked.files()["study.toml"])
        study = read_study(tmp_path / "study.toml")
        assert study.varied == tuple(asked.varied)
        assert {name: study.points[0][name] for name in asked.fixed} == dict(asked.fixed)
    (tmp_path / "study.toml").write_text(TURNS.text(), encoding="utf-8")
    points = read_study(tmp_path / "study.toml").points
    assert [(each["edge_angle_deg"], round(each["H_V_N_per_mm3"], 9)) for each in points] == [
        (angle, hardness) for angle in (10.0, 40.0, 70.0) for hardness in (0.1, 1.0, 10.0)
    ]


LOADS = (20, 40, 60, 80)
UNANSWERED = """() => Object.fromEntries(Object.entries(localStorage)
    .filter(([key]) => key.startsWith('skisnow.reading'))
    .map(([, text]) => JSON.parse(text).cells).map((cells) => [cells.load_N, cells.depth_mm]))"""
LONGEST_S = 0.6  # a series takes about as long to type


def shown_as_stored(page: Page) -> dict[str, str]:
    """Depth by load, of the readings that the page calls stored."""
    rows: list[list[str]] = page.evaluate(
        """() => [...document.querySelectorAll('.reading')].map(row => [row.querySelector('.load').innerText,
             row.querySelector('input').value, row.querySelector('.stored').innerText])"""
    )
    return {load.removesuffix(" N"): depth for load, depth, stored in rows if stored == "stored"}


def in_the_store(place: Path, test: str) -> dict[str, str]:
    with Store.open(place) as store:
        assert store.verify() == ()
        (head,) = Journals(store).list()
        rows = replay_journal(Journals(store).entries(head.id)).test("penetration.csv", test).rows
    return {row.cells["load_N"]: row.cells["depth_mm"] for row in rows}


def killed_while_entering(page: Page, served: Served, test: str, delay_s: float) -> tuple[int, int]:
    """How many readings were shown as stored, and how many will be in the store: the browser sends again the others."""
    fill(page, {"Name of the test": test, "Site": "A", "Edge angle (°)": "30"})
    page.keyboard.press("Enter")
    page.get_by_label("Depth under 20 N (mm)").and_(page.locator(":focus")).wait_for()
    assert served.process is not None
    timer = threading.Timer(delay_s, served.process.kill)
    timer.start()
    for number in range(len(LOADS)):
        page.keyboard.type(f"{number + 1}.{test}")
        page.keyboard.press("Enter")
    timer.join()
    served.wait()
    shown, kept = shown_as_stored(page), in_the_store(served.store, test)
    assert shown.items() <= kept.items()
    wanted = {str(load): f"{number + 1}.{test}" for number, load in enumerate(LOADS)}
    unanswered: dict[str, str] = page.evaluate(UNANSWERED)
    assert kept.items() | unanswered.items() <= wanted.items()
    return len(shown), len(kept | unanswered)


@pytest.mark.slow
@pytest.mark.parametrize("trials", [pytest.param(4, id="a few times"), pytest.param(50, id="fifty times")])
def test_nothing_that_was_shown_as_stored_is_lost(trials: int, page: Page, served: Served) -> None:
    create(page, served)
    place = page.url.split("?")[0]
    delays = np.random.default_rng(1).uniform(0.0, LONGEST_S, trials)
    counts = []
    for trial, delay_s in enumerate(delays.tolist(), start=1):
        counts.append(killed_while_entering(page, served, str(trial), delay_s))
        page.goto("about:blank")  # else the page would come back by itself, at the same time
        served.again()
        page.goto(place)
        page.get_by_role("heading", name="New series").wait_for()
        page.wait_for_function(f"Object.keys(({UNANSWERED})()).length === 0")
    tests = entered(served).of_file("penetration.csv")
    assert sum(len(test.rows) for test in tests) == sum(kept for _, kept in counts)
    if trials == 50:  # the moments of death were spread over the entering
        assert len({shown for shown, _ in counts}) >= 3
