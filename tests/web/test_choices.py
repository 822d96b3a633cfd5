"""What is typed and chosen in fields, without a page: ranges that are studied, and the snow that holds."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

pytest.importorskip("nicegui", reason="the web lab is not installed")

from skisnow import analyse, read_campaign
from skisnow.errors import ParameterError
from skisnow.inputs import Quantity
from skisnow.snow import published_snow
from skisnow.web.snow_choice import ALL_SITES, PUBLISHED, SnowChoice
from skisnow.web.study_axis import NOTHING, AxisFields

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
        (axis("10", "70", "1"), "the number of values is '1'; it must be 2 or more"),
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
        finished(self.inside._another())


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
    monkeypatch.setattr("skisnow.web.snow_choice.said_options", dict)
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
    with pytest.raises(ParameterError, match="the campaign is being analysed; wait a moment"):
        fields.made.chosen()
    assert fields.made.gives_stress
    fields.choose(f"{PUBLISHED}nowhere")
    with pytest.raises(ParameterError, match="nowhere"):
        fields.made.chosen()
