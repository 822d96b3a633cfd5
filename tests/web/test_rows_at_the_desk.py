"""What the form of one row at a time fills in, and which second row of a test it refuses; without a page."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

pytest.importorskip("nicegui", reason="the web lab is not installed")

from skisnow.campaign.reading.experiments import TURNING
from skisnow.web.entry.single import SingleForm
from skisnow.web.entry.table_view import TableView

SHEAR = {"site": "A", "plate": "blade", "edge_angle_deg": "30", "lever_arm_mm": "", "spot": "", "depth_mm": "10"}


def row(**cells: str) -> Any:
    return SimpleNamespace(cells=cells)


def of(name: str, *rows: Any) -> Any:
    return SimpleNamespace(name=name, rows=list(rows), history=[1])


def form(*tests: Any, repeats: bool = False) -> Any:
    """A form beside these tests, of shear, or of the drop cone with its repeats."""
    made: Any = object.__new__(SingleForm)
    made._view = SimpleNamespace(
        tests=lambda: list(tests), next_name=lambda: "next", form=SimpleNamespace(key="experiment", names=())
    )
    made._columns = ("experiment", "repeat") if repeats else ("experiment", "site")
    return made


@pytest.mark.parametrize(
    ("names", "expected"), [([], "1"), (["2", "9", "b"], "10"), (["3", "9" * 4300, "9" * 4301, "-5", "²"], "4")]
)
def test_the_next_number_is_above_all_numbers(names: list[str], expected: str) -> None:
    made: Any = object.__new__(TableView)
    made.file = "shear.csv"
    tests = [SimpleNamespace(name=name) for name in names]
    made.session = SimpleNamespace(campaign=SimpleNamespace(of_file=lambda file: tests if file == made.file else []))
    assert made.next_name() == expected


def test_the_first_test_has_nothing_but_a_name() -> None:
    assert form()._prefilled() == {
        "site": "", "plate": "", "edge_angle_deg": "", "lever_arm_mm": "", "experiment": "next",
    }  # fmt: skip
    assert form(repeats=True)._prefilled()["repeat"] == "1"


def test_the_next_test_has_what_it_shares_with_the_last_row_before() -> None:
    found = form(of("1", row(**SHEAR)), of("2", row(**SHEAR), row(**SHEAR | {"site": "B"})))._prefilled()
    assert (found["experiment"], found["site"], found["edge_angle_deg"]) == ("next", "B", "30")
    assert "depth_mm" not in found


def test_a_repeat_is_the_next_of_the_same_cone() -> None:
    found = form(of("c", row(experiment="c", repeat="1"), row(experiment="c", repeat="2")), repeats=True)._prefilled()
    assert (found["experiment"], found["repeat"]) == ("c", "3")


def test_an_angle_goes_on_with_its_test() -> None:
    found = form(of("m", row(**SHEAR | {"experiment": "m", TURNING: "5"})))._prefilled()
    assert (found["experiment"], found["depth_mm"], found["spot"]) == ("m", "10", "")
    assert TURNING not in found


@pytest.mark.parametrize(
    ("rows", "cells", "fault"),
    [
        ([SHEAR | {TURNING: "5"}], SHEAR | {TURNING: "10"}, ""),
        ([], SHEAR | {TURNING: "10"}, ""),
        ([SHEAR | {TURNING: "5"}], SHEAR | {TURNING: "10", "depth_mm": "11"}, "the rows of test t have one "),
        ([SHEAR | {TURNING: "5"}, SHEAR], SHEAR | {TURNING: "10"}, "there is a test t already"),
        ([SHEAR], SHEAR, "there is a test t already; give this one another name"),
        ([{"repeat": "1", "site": "A"}], {"repeat": "1", "site": "A"}, "test t has a repeat 1 already"),
        ([{"repeat": "1", "site": "A"}], {"repeat": "2", "site": "B"}, "test t is at the site A"),
        ([{"repeat": "1", "site": "A"}], {"repeat": "2", "site": "A"}, ""),
    ],
)
def test_a_second_row_that_does_not_go_with_the_first(
    rows: list[dict[str, str]], cells: dict[str, str], fault: str
) -> None:
    found = form()._second_row_fault(of("t", *(row(**each) for each in rows)), cells)
    assert found.startswith(fault)
    assert bool(found) is bool(fault)


@pytest.mark.parametrize("right", [True, False])
def test_a_correction_asks_for_a_reason_and_shows_what_came_of_it(right: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Any] = []
    said: list[str] = []
    shown: list[tuple[str, str]] = []
    written: list[Any] = []

    def ask_reason(_place: Any, lines: list[str], act: Any, **_: Any) -> None:
        asked.append((*lines, act[1]))

    def correct_it(_test: Any, *entry: Any) -> bool:
        written.append(entry)
        return right

    monkeypatch.setattr("skisnow.web.entry.single.ask_reason", ask_reason)
    monkeypatch.setattr("skisnow.web.language.language_of", lambda _: "en")
    made = form()
    made._ask, made._cells = None, lambda _: {"site": "A", "depth_mm": "12"}
    made._view.say = lambda words, *_: said.append(words)
    made._view.correct = correct_it
    made.show = lambda name, row: shown.append((name, row))
    before = SimpleNamespace(cells={"site": "A", "depth_mm": "10"}, entered=SimpleNamespace(sequence=7))
    assert made._ask_correction(of("t", before), before)
    ((words, correct),) = asked
    assert words.endswith("10 becomes 12.")
    assert correct("slip") is right
    assert written == [(7, {"depth_mm": "12"}, "slip")]
    assert shown == ([("t", "7")] if right else [])
    made._cells = lambda _: {"site": "A", "depth_mm": "10"}
    assert made._ask_correction(of("t", before), before)
    assert said[1:] == ["Nothing is different."]
    made._cells = lambda _: None
    assert not made._ask_correction(of("t", before), before)
    assert len(asked) == 1
