"""Layers of a scenario: random keys together, against rules that are written here."""

import json
import random
import warnings
from pathlib import Path
from typing import Any

import pytest

from skisnow import Scenario, load_scenario
from skisnow._support.errors import ParameterError, RangeWarning

H_V, S_F, RATIO = "snow.H_V_N_per_mm3", "snow.S_f_N_per_mm2", "snow.unloading_ratio"
RESULTS = {
    "penetration": {
        "experiments": [{"used": True, "site": "A", "H_V_N_per_mm3": 0.151}],
        "unloading": [{"site": "A", "unloading_ratio": 7.0, "unloading_ratio_interval": [6.0, 8.0]}],
    },
    "shear": {
        "experiments": [{"used": True, "site": "A", "S_f_N_per_mm2": 0.351}],
        "displacement": [{"site": "A", "shear_displacement_mm": 0.25, "shear_displacement_interval_mm": [0.2, 0.3]}],
    },
}
SNOWS: tuple[dict[str, Any], ...] = (
    {"snow.published": "race-piste"},
    {"snow.results": "results.json", "snow.site": "A"},
    {"snow.map_file": "both.csv"},
    {"snow.penetration": "elastic"},
)
PARTS: tuple[dict[str, Any], ...] = (
    *SNOWS,
    {H_V: 0.2}, {S_F: 0.4}, {RATIO: 12.0}, {"snow.map_file": "hardness.csv"}, {"snow.shear_displacement_mm": 0.3},
    {"ski.name": "carver"}, {"slope.kind": "plane", "slope.angle_deg": 10.0}, {"slope.profile": "profile.csv"},
    {"shear.law": "by-angle"}, {"shear.law": "by-angle", "shear.relative_decrease_per_rad": 0.2},
    {"shear.relative_decrease_per_rad": 0.3}, {"friction.mu_0": 0.05}, {"drag.drag_area_m2": 0.5},
)  # fmt: skip


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("layers")
    (folder / "results.json").write_text(json.dumps(RESULTS), encoding="utf-8")
    (folder / "hardness.csv").write_text("x_m,H_V_N_per_mm3\n-500,0.161\n500,0.161\n", encoding="utf-8")
    (folder / "both.csv").write_text(
        "x_m,H_V_N_per_mm3,S_f_N_per_mm2\n-500,0.171,0.371\n500,0.171,0.371\n", encoding="utf-8"
    )
    (folder / "profile.csv").write_text(
        "x,y\n" + "".join(f"{x},{-0.2 * x}\n" for x in range(-30, 90, 3)), encoding="utf-8"
    )
    return folder


def scenario_of(layer: dict[str, Any], folder: Path) -> Scenario:
    paths = {
        name: str(folder / value) if str(value).endswith((".json", ".csv")) else value for name, value in layer.items()
    }
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        return load_scenario("carved-46m", changes=paths)


def contradicts_itself(layer: dict[str, Any]) -> bool:
    """True if two keys of the layer give H_V, S_f or k_u/H_V."""
    named = [name for name in ("snow.results", "snow.published") if name in layer]
    in_map = {"hardness.csv": {H_V}, "both.csv": {H_V, S_F}}.get(layer.get("snow.map_file", ""), set())
    elastic = layer.get("snow.penetration") == "elastic" and RATIO in layer
    return elastic or any(
        len([*named, *({key} & layer.keys())]) > 1 or key in in_map & layer.keys() for key in (H_V, S_F)
    )


def has_no_effect(layer: dict[str, Any]) -> bool:
    """True if a key of the layer needs another value of a second key."""
    decrease = "shear.relative_decrease_per_rad" in layer and "shear.law" not in layer
    return decrease or ("slope.profile" in layer)


def numbers(scenario: Scenario) -> dict[str, float | None]:
    contact = scenario.contact
    return {
        H_V: contact.hardness_at(0.0, 0.0),
        S_F: contact.snow.failure_shear_stress,
        RATIO: contact.unloading_ratio,
        "snow.shear_displacement_mm": contact.shear_displacement,
        "waist": float(scenario.ski.width.min()),
        "shear.relative_decrease_per_rad": scenario.shear.relative_decrease,
        "friction.mu_0": contact.friction,
        "drag.drag_area_m2": scenario.air.drag_area,
    }


def test_a_layer_whose_keys_contradict_each_other_or_have_no_effect_is_rejected(folder: Path) -> None:
    draws, rejected = random.Random(20261128), 0
    for _ in range(150):
        layer = {name: value for part in draws.sample(PARTS, draws.randint(1, 3)) for name, value in part.items()}
        try:
            scenario_of(layer, folder)
            accepted = True
        except ParameterError:
            accepted = False
        assert accepted is not (contradicts_itself(layer) or has_no_effect(layer)), layer
        rejected += not accepted
    assert 30 < rejected < 120


@pytest.mark.parametrize("snow", SNOWS)
@pytest.mark.parametrize("key", [H_V, S_F, "friction.mu_0", "drag.drag_area_m2"])
def test_one_number_replaces_only_its_own_quantity(snow: dict[str, Any], key: str, folder: Path) -> None:
    """In a layer above that of the snow; the quantities of a map stay until it is removed."""
    base = scenario_of(snow, folder)
    if "snow.map_file" in snow and key in (H_V, S_F):
        with pytest.raises(ParameterError, match="snow_map=None"):
            base.with_(**{key: 0.33})
        return
    before, after = numbers(base), numbers(base.with_(**{key: 0.33}))
    assert after[key] != before[key]
    assert {name for name in before if before[name] != after[name]} == {key}


@pytest.mark.parametrize("key", [H_V, S_F, RATIO, "snow.shear_displacement_mm", "friction.mu_0", "drag.drag_area_m2"])
def test_changes_and_with_agree(key: str, folder: Path) -> None:
    changed = numbers(scenario_of({key: 0.7 if key != RATIO else 7.0}, folder))
    assert changed == numbers(load_scenario("carved-46m").with_(**{key: 0.7 if key != RATIO else 7.0}))
    assert changed != numbers(load_scenario("carved-46m"))
