"""Which layer of a scenario counts: 500 random combinations, compared with an earlier version's answers."""

import json
import warnings
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from skisnow import Scenario, load_scenario
from skisnow._support.errors import ParameterError, RangeWarning

from .layers.combinations import Combination, answer, combinations, write_files

ANSWERS = Path(__file__).parent / "layers" / "58cc12bf.json"
CARVED_46M = {"snow.H_V_N_per_mm3": 0.2, "snow.S_f_N_per_mm2": 0.5, "ski.name": "giant-slalom", "slope.angle_deg": 10.0}
NAMED = ("snow.results", "snow.published")
H_V, S_F, RATIO = "snow.H_V_N_per_mm3", "snow.S_f_N_per_mm2", "snow.unloading_ratio"
NEEDED = {
    "shear.relative_decrease_per_rad": ("shear.law", "by-angle", "constant"),
    "shear.snow_density_kg_per_m3": ("shear.law", "by-density", "constant"),
    "slope.profile": ("slope.kind", "profile", "plane"),
}
"""Key, value that it needs, and default, of keys without effect otherwise."""

REJECTED, ACCEPTED, CHANGED = "rejected", "accepted", "other values"
COUNTS = {
    "same values": 258,
    "rejected as before": 169,
    "a key without effect": 33,
    "two keys of one layer for one quantity": 29,
    "a number instead of a named snow's H_V or S_f": 9,
    "k_u/H_V after elastic snow": 1,
    "u_y that an earlier snow measured": 1,
}

Layer = dict[str, Any]


def contradicts_itself(layer: Layer) -> bool:
    """True if two keys of the layer give H_V, S_f, k_u/H_V or the ski."""
    named = [name for name in NAMED if name in layer]
    hardness = [*named, *({H_V} & layer.keys())]
    stress = [*named, *({S_F} & layer.keys())]
    maps = {"hardness.csv": (H_V,), "both.csv": (H_V, S_F)}.get(layer.get("snow.map_file", ""), ())
    elastic = layer.get("snow.penetration") == "elastic" and layer.get(RATIO, 1.0) != 1.0
    return (
        len(hardness) > 1
        or len(stress) > 1
        or any(name in layer for name in maps)
        or elastic
        or ("ski.name" in layer and "ski.file" in layer)
    )


def has_no_effect(base: Layer, changes: Layer) -> bool:
    """True if a key of a layer needs another value of a second key than that layer leaves it."""
    below: Layer = {}
    for layer in (base, changes):
        below = below | layer
        if any(name in layer and below.get(key, default) != value for name, (key, value, default) in NEEDED.items()):
            return True
    return False


def replaces_one_number(base: Layer, changes: Layer) -> bool:
    """True if the changes give H_V or S_f of a snow that the base names."""
    named = any(name in base for name in NAMED) and not any(name in changes for name in NAMED)
    return named and bool({H_V, S_F} & changes.keys())


def number_after_elastic(base: Layer, changes: Layer) -> bool:
    return base.get("snow.penetration") == "elastic" and RATIO in changes


def measured_by_another_snow(base: Layer, changes: Layer) -> bool:
    """True if the base names a snow with a measured u_y, and the changes one without."""
    return base.get("snow.site") == "A" and "snow.published" in changes


KINDS: dict[str, tuple[str, Callable[[Layer, Layer], bool]]] = {
    "two keys of one layer for one quantity": (REJECTED, lambda *both: any(map(contradicts_itself, both))),
    "a key without effect": (REJECTED, has_no_effect),
    "a number instead of a named snow's H_V or S_f": (ACCEPTED, replaces_one_number),
    "k_u/H_V after elastic snow": (ACCEPTED, number_after_elastic),
    "u_y that an earlier snow measured": (CHANGED, measured_by_another_snow),
}
"""Kinds of differences from the earlier version, what changed, and when a combination is of that kind."""


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


def difference(earlier: Any, today: Any) -> str:
    if earlier is None or today is None:
        return REJECTED if today is None else ACCEPTED
    return CHANGED


def test_answers_differ_from_the_earlier_version_only_by_the_rules(answers: Resolved) -> None:
    """Every difference follows from a rule; docs/decisions.md has the counts."""
    counts: Counter[str] = Counter()
    for (combination, today), earlier in zip(answers, json.loads(ANSWERS.read_text()), strict=True):
        if today == earlier:
            counts["rejected as before" if today is None else "same values"] += 1
            continue
        base = combination.file or CARVED_46M
        kinds = [
            name
            for name, (change, applies) in KINDS.items()
            if change == difference(earlier, today) and applies(base, combination.changes)
        ]
        assert kinds, combination
        counts[kinds[0]] += 1
    assert counts == COUNTS


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
    assert checked > 20


def test_changes_and_with_agree(answers: Resolved, folder: Path) -> None:
    """Numbers as a layer of changes, and as arguments of `with_`."""
    checked = 0
    for combination, values in answers:
        numbers = {name: value for name, value in combination.changes.items() if isinstance(value, float)}
        base = replace(combination, changes={})
        if len(numbers) < len(combination.changes) or resolved(base, folder) is None:
            continue

        def load(place: str | Path, numbers: Layer = numbers, **_: Layer) -> Scenario:
            return load_scenario(place).with_(**numbers)

        assert answer(base, folder, load, ParameterError) == values, combination
        checked += 1
    assert checked > 20
