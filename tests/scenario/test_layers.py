"""Which layer of a scenario counts: random combinations and their recorded answers."""

import json
import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from skisnow import Scenario, load_scenario
from skisnow._support.errors import ParameterError, RangeWarning

from .layers.combinations import Combination, answer, combinations, write_files

ANSWERS = Path(__file__).parent / "layers" / "answers.json"
"""Nine in ten are those of an earlier resolver; the others follow from rules: the last layer that gives a quantity
counts, two keys of one layer for one quantity are an error, and so is a key without effect."""
H_V, S_F = "snow.H_V_N_per_mm3", "snow.S_f_N_per_mm2"

Resolved = list[tuple[Combination, Any]]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("layers")
    write_files(folder)
    return folder


def resolved(combination: Combination, folder: Path) -> Any:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        return answer(combination, folder, load_scenario, ParameterError)


@pytest.fixture(scope="module")
def answers(folder: Path) -> Resolved:
    """Every combination with its values; None if it is rejected."""
    return [(combination, resolved(combination, folder)) for combination in combinations()]


def test_answers_are_the_recorded_ones(answers: Resolved) -> None:
    for (combination, today), recorded in zip(answers, json.loads(ANSWERS.read_text("utf-8")), strict=True):
        assert today == recorded, combination


def test_one_number_replaces_only_its_own_quantity(answers: Resolved, folder: Path) -> None:
    """A change of H_V or S_f keeps all other numbers of the combination."""
    checked = 0
    for combination, with_number in answers:
        for place, name in enumerate((H_V, S_F)):
            if name not in combination.changes or with_number is None:
                continue
            changes = {key: value for key, value in combination.changes.items() if key != name}
            without = resolved(replace(combination, changes=changes), folder)
            if without is not None:
                for index, (one, other) in enumerate(zip(with_number, without, strict=True)):
                    assert index == place or one == other, combination
                checked += 1
    assert checked > 10


def test_changes_and_with_agree(answers: Resolved, folder: Path) -> None:
    """Numbers as a layer of changes, and as arguments of `with_`."""
    checked = 0
    for combination, values in answers:
        numbers = {name: value for name, value in combination.changes.items() if isinstance(value, float)}
        base = replace(combination, changes={})
        if len(numbers) < len(combination.changes) or resolved(base, folder) is None:
            continue

        def load(place: str | Path, numbers: dict[str, Any] = numbers, **_: dict[str, Any]) -> Scenario:
            return load_scenario(place).with_(**numbers)

        assert answer(base, folder, load, ParameterError) == values, combination
        checked += 1
    assert checked > 10
