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
from skisnow.web.snow_choice import ALL_SITES, PUBLISHED, SnowChoice

from .finished import finished
from .test_in_memory import PENETRATION, TOML


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
    assert fields.told[-1]
    with raises(ParameterError, "no_snow"):
        fields.made.chosen()
    changed = fields.changed
    fields.choose("kept-4")  # the lab is about to end
    assert fields.changed == changed
    with raises(ParameterError, "no_snow"):
        fields.made.chosen()
