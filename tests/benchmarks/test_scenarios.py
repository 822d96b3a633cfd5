"""Random scenarios: the same for a seed, computed once, and told where one does not end."""

from __future__ import annotations

from pathlib import Path

import pytest
from benchmarks.turns import allowed_keys, scenarios

from skisnow.scenario.keys import SCENARIO_KEYS
from skisnow.scenario.reading import load_input
from skisnow.scenario.resolution import resolve
from skisnow.ski.ski_file import Sources

QUICK = 10
"""A seed whose sledge tips over soon."""


def test_a_seed_is_a_scenario_within_the_ranges() -> None:
    for seed in range(50):
        given = scenarios.changes(seed)
        assert given == scenarios.changes(seed)
        for key, (least, most) in (scenarios.UNIFORM | scenarios.LOGARITHMIC).items():
            assert key not in given or least <= given[key] <= most
    assert {scenarios.changes(seed)["snow.penetration"] for seed in range(50)} == set(scenarios.CONTACTS)


def test_any_values_are_those_of_a_scenario() -> None:
    """A seed gives the same values each time; each key is one of a scenario."""
    for seed in range(200):
        given = allowed_keys.changes(seed, "by-angle")
        assert given == allowed_keys.changes(seed, "by-angle")
        assert set(given) <= set(SCENARIO_KEYS)
        assert given["shear.law"] == "by-angle"
        resolve(load_input("carved-46m").changed(given), Sources())
    assert {allowed_keys.changes(seed)["shear.law"] for seed in range(50)} == set(allowed_keys.LAWS)


def test_what_stands_in_the_file_is_not_computed_again(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "rows.jsonl"
    scenarios.print_table(QUICK, 1, path)
    first, told = path.read_text(encoding="utf-8"), capsys.readouterr().out
    assert "| tipped_over | 1 |" in told and told.count("none") == 3
    scenarios.print_table(QUICK, 1, path)
    assert (path.read_text(encoding="utf-8"), capsys.readouterr().out) == (first, told)


def test_one_that_does_not_end_is_told_and_the_next_are_computed(monkeypatch: pytest.MonkeyPatch) -> None:
    """The process begins anew behind it; here every one takes too long."""
    monkeypatch.setattr(scenarios, "_work", _sleep)
    assert [each["outcome"] for each in scenarios.rows([1, 2], limit=0.05)] == ["hangs", "hangs"]


def _sleep(seeds: list[int], answers: object, any_values: bool) -> None:  # noqa: ARG001
    import time

    time.sleep(60.0)
