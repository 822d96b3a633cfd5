"""What is typed and chosen in fields, without a page: ranges that are studied, and the snow that holds."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from tests.coded import raises

pytest.importorskip("nicegui", reason="the web lab is not installed")

from skisnow import analyse, read_campaign
from skisnow._support.errors import ParameterError
from skisnow.parameters import Quantity
from skisnow.snow import published_snow
from skisnow.web.line_chart import BEHIND
from skisnow.web.pages.correct import ImportedTestForm
from skisnow.web.pages.study_table import _ResultsView
from skisnow.web.snow_choice import ALL_SITES, PUBLISHED, SnowChoice
from skisnow.web.study_fields import NOTHING, AxisFields

from .finished import finished
from .test_in_memory import PENETRATION, TOML

ANGLE = Quantity("sledge.edge_angle_deg", "edge angle", label="edge angle", lowest=0.0, highest=90.0)
TURNS = Quantity("skier.turns", "turns", label="turns", lowest=1, highest=50, kind="whole number")


def axis(low: str, high: str, n: str = "10", *, log: bool = False, key: Quantity | None = ANGLE) -> AxisFields:
    """Fields with what was typed into them."""
    fields = object.__new__(AxisFields)
    fields._keys = {each.name: each for each in (ANGLE, TURNS)}
    made: Any = fields
    made._key = SimpleNamespace(value=NOTHING if key is None else key.name)
    made._ends = [SimpleNamespace(value=low), SimpleNamespace(value=high)]
    made._n, made._log = SimpleNamespace(value=n), SimpleNamespace(value=log)
    return fields


def test_a_range_as_it_is_typed() -> None:
    found = axis("10", " 70,5 ", "2", log=True).range()
    assert (found.low, found.high, found.n, found.log) == (10.0, 70.5, 2, True)
    assert axis("1", "3", "3", key=TURNS).range().n == 3
    assert (axis("", "", "x", key=None).name, axis("", "", "x", key=None).count()) == ("", 1)


@pytest.mark.parametrize(
    ("fields", "told"),
    [
        (axis("", "70"), "type both ends"),
        (axis("10", " "), "type both ends"),
        (axis("ten", "70"), "the lower end"),
        (axis("10", "seventy"), "the upper end"),
        (axis("10", "91"), "is 91"),
        (axis("-1", "70"), "is -1"),
        (axis("70", "10"), "it goes from 70 to 10; the first end must be the smaller one"),
        (axis("10", "10"), "it goes from 10 to 10"),
        (axis("0", "70", log=True), "it must begin above 0; it begins at 0"),
        (axis("10", "70", "1"), "the number of values is '1'; it must be from 2 to 10000"),
        (axis("10", "70", "2.5"), "the number of values is '2.5'"),
        (axis("0", "3", key=TURNS), "Turns is 0; allowed is whole numbers from 1 to 50"),
    ],
)
def test_what_is_no_range_is_told(fields: AxisFields, told: str) -> None:
    with pytest.raises(ParameterError) as refused:
        fields.range()
    assert told in str(refused.value)


class Fields:
    """The elements of a choice of snow, without a page."""

    def __init__(self, campaigns: dict[str, str]) -> None:
        self.told: list[str] = []
        self.changed = 0
        self.site = SimpleNamespace(value=ALL_SITES, options={}, visible=None)
        self.site.set_options = lambda options: setattr(self.site, "options", options)
        self.site.set_visibility = lambda visible: setattr(self.site, "visible", visible)
        self.site.set_value = lambda value: setattr(self.site, "value", value)
        made: Any = object.__new__(SnowChoice)
        made._numbers, made._campaigns = "numbers", campaigns
        made._menu, made._site = SimpleNamespace(value="numbers"), self.site
        made.words = SimpleNamespace(set_text=self.told.append)
        made._found, made._refused, made._analysis = None, "", None
        made._changed = self._once_more
        self.made: SnowChoice = made
        self.inside = made

    async def _once_more(self) -> None:
        self.changed += 1

    def choose(self, key: str) -> None:
        self.inside._menu.value = key
        finished(self.inside._choose_campaign_or_snow())


def test_a_published_snow_holds_until_numbers_are_chosen_again() -> None:
    fields = Fields({})
    assert (fields.made.is_numbers, fields.made.gives_hardness, fields.made.gives_stress) == (True, False, False)
    assert fields.made.chosen() is None
    fields.choose(f"{PUBLISHED}race-piste")
    found = fields.made.chosen()
    assert found is not None
    assert found.snow == published_snow("race-piste")
    assert (found.published, found.site, fields.changed) == ("race-piste", ALL_SITES, 1)
    assert (fields.made.gives_hardness, fields.made.gives_stress) == (True, True)
    assert fields.told[-1].startswith("Snow: ")
    fields.choose("numbers")
    assert fields.made.chosen() is None
    assert fields.told[-1] == ""


def test_a_snow_of_a_campaign_without_shear_gives_no_stress(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("skisnow.web.snow_choice.option_texts", dict)
    (tmp_path / "campaign.toml").write_text(TOML, encoding="utf-8")
    second = "".join(line.replace(",A,", ",B,").replace("1,", "3,", 1) + "\n" for line in PENETRATION.splitlines()[1:4])
    (tmp_path / "penetration.csv").write_text(PENETRATION + second, encoding="utf-8")
    fields = Fields({"kept-1": "Desk"})
    fields.inside._analysis = ("kept-1", analyse(read_campaign(tmp_path), n_resamples=100))
    fields.choose("kept-1")
    assert (fields.site.visible, list(fields.site.options)) == (True, [ALL_SITES, "A", "B"])
    assert (fields.made.gives_hardness, fields.made.gives_stress) == (True, False)
    found = fields.made.chosen()
    assert found is not None
    assert (found.words, found.site) == ("Desk", ALL_SITES)
    fields.site.value = "B"
    finished(fields.inside._choose())
    found = fields.made.chosen()
    assert found is not None
    assert (found.words, found.site) == ("Desk, B", "B")
    fields.choose("kept-1")  # all sites again, which the menu of sites then chooses
    assert fields.site.value == ALL_SITES


def test_what_is_not_there_yet_is_no_snow() -> None:
    fields = Fields({"kept-1": "Desk"})
    fields.inside._menu.value = "kept-1"
    with raises(ParameterError, "no_snow"):
        fields.made.chosen()
    assert fields.made.gives_stress
    fields.choose(f"{PUBLISHED}nowhere")
    with raises(ParameterError, "no_snow", name="nowhere"):
        fields.made.chosen()


def test_a_campaign_is_analysed_once_while_it_is_chosen(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "campaign.toml").write_text(TOML, encoding="utf-8")
    (tmp_path / "penetration.csv").write_text(PENETRATION, encoding="utf-8")
    analysis = analyse(read_campaign(tmp_path), n_resamples=100)
    asked: list[str] = []

    async def io_bound(work: Any, *given: Any) -> Any:
        return work(*given)

    def campaign_snow(_lab: Any, key: str) -> Any:
        asked.append(key)
        if key == "kept-3":
            raise ParameterError("it has no penetration tests")
        return None if key == "kept-4" else analysis

    monkeypatch.setattr("skisnow.web.snow_choice.run.io_bound", io_bound)
    monkeypatch.setattr("skisnow.web.snow_choice.campaign_snow", campaign_snow)
    monkeypatch.setattr("skisnow.web.snow_choice.option_texts", dict)
    fields = Fields({f"kept-{number}": f"day {number}" for number in range(1, 5)})
    fields.inside._lab = None
    for key in ("kept-1", "kept-1", "kept-2"):
        fields.choose(key)
        found = fields.made.chosen()
        assert found is not None
        assert found.words == f"day {key[-1]}"
    assert asked == ["kept-1", "kept-2"]
    assert fields.site.visible is False
    fields.choose("kept-3")
    assert fields.told[-1] == "it has no penetration tests"
    with raises(ParameterError, "no_snow"):
        fields.made.chosen()
    changed = fields.changed
    fields.choose("kept-4")  # the lab is about to end
    assert fields.changed == changed
    with raises(ParameterError, "no_snow"):
        fields.made.chosen()


def test_a_line_for_each_value_of_the_other_input_the_named_ones_last(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("skisnow.web.pages.study_table.said", str)
    made: Any = object.__new__(_ResultsView)
    made._keys = {"load_N": Quantity("load_N", "load", label="load"), "edge_angle_deg": ANGLE}
    made._x, made._other, made._lines = "edge_angle_deg", "load_N", [400.0, 600.0, 800.0, 1000.0]
    rows = [
        {"edge_angle_deg": angle, "load_N": load, "radius": load / angle}
        for load in made._lines for angle in (30.0, 10.0)
    ]  # fmt: skip
    made._table = SimpleNamespace(rows=rows)
    assert made._order() == [1, 0, 2, 3]
    lines = {number: made._line(number, "radius") for number in range(4)}
    assert (list(lines[1].x), list(lines[1].y)) == ([10.0, 30.0], [60.0, 20.0])
    assert [lines[number].style for number in range(4)] == [0, BEHIND, 1, 2]
    assert [bool(lines[number].name) for number in range(4)] == [True, False, True, True]
    assert lines[3].name.endswith("1000")
    made._other, made._lines = "", [None]
    assert len(made._line(0, "radius").x) == 8


def test_cells_that_were_typed_anew_are_those_of_every_row_that_has_them_once() -> None:
    made: Any = object.__new__(ImportedTestForm)
    now = {"2/site": "A", "3/site": "A", "2/depth_mm": "1.5", "3/depth_mm": "2"}
    assert made._is_once((2, 3), "site", now)
    assert not made._is_once((2, 3), "depth_mm", now)
    said: list[Any] = []
    made._view = SimpleNamespace(say=lambda words, _, items: said.extend((words, items)), form=None)
    made._table = SimpleNamespace(conversions={})
    made._fields = {
        (2, 3): {"site": SimpleNamespace(value=" B ", error=None)},
        (2,): {"depth_mm": SimpleNamespace(value="1.5", error=None)},
        (3,): {"depth_mm": SimpleNamespace(value="2.5", error=None)},
    }
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(
            "skisnow.web.pages.correct.checked_fields",
            lambda _, fields, **_conversions: {column: str(each.value).strip() for column, each in fields.items()},
        )
        patched.setattr(
            "skisnow.web.pages.correct.faults", lambda fields: [each.error for each in fields if each.error]
        )
        assert made._changed(now) == {"2/site": "B", "3/site": "B", "3/depth_mm": "2.5"}
        made._fields[(3,)]["depth_mm"].error = "Depth: no number"
        assert made._changed(now) is None
    assert said == ["Not corrected:", ["Depth: no number"]]
