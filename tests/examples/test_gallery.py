"""The gallery of examples and its pages."""

import ast
import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import pytest
from scipy import stats

import skisnow

from .gallery import builder

Values: TypeAlias = dict[str, Any]
Find: TypeAlias = Callable[[str], Values]


@pytest.fixture
def find() -> Find:
    """Run an example; its variables. Its picture has more than one colour."""

    def found(name: str) -> Values:
        ran = builder().ran(name)
        assert ran.picture.startswith(b"\x89PNG")
        assert len(ran.picture) > 4000
        assert ran.printed
        values: Values = ran.values
        return values

    return found


# Tests on the slope


def test_one_series_and_gauge_offset(find: Find) -> None:
    """H_V = F/V, V = L e²/(2 tan 45°) by hand."""
    assert find("one_series")["hardness"] == pytest.approx(492 / (200 * 7.0**2 / 2), rel=1e-12)
    # The offset and the hardness that the readings were made with, to the digits that they were written with.
    found = find("gauge_offset")
    assert found["offset"] == pytest.approx(0.30, abs=1e-3)
    assert found["corrected"] == pytest.approx(0.10, rel=2e-3)
    assert found["as_read"] == pytest.approx(492 / (200 * 62 * (492 / 1240 + 0.3)), rel=1e-4)


def test_which_law(find: Find, tmp_path: Path) -> None:
    """The paper's choice; its rmse with nothing but the readings: F_7 V/V_7 against F, V = L W e or L e²/(2 tan ϑ)."""
    found = find("which_law")
    assert found["chosen"] == "H_V:a=none,b=one"
    skisnow.write_reference(tmp_path / "campaign", seed=1)
    tests = skisnow.read_campaign(tmp_path / "campaign").penetration
    assert tests is not None
    load, depth = (np.reshape(column, (-1, 7)) for column in (tests.load, tests.penetration_depth))
    angle = np.asarray(tests.edge_angle)[:, None]
    rim = 0.062 * np.sin(angle)
    wedge = depth**2 / (2 * np.tan(np.where(angle > 0, angle, 1.0)))
    volume = 0.2 * np.where(depth < rim, wedge, 0.062 * np.cos(angle) * (depth - rim / 2))
    off = load[:, -1:] * volume / volume[:, -1:] - load
    assert found["rmse"]["H_V:a=none,b=one"] == pytest.approx(np.sqrt(np.mean(off**2)), rel=1e-9)


def test_two_sites(find: Find) -> None:
    found = find("two_sites")
    logs = [np.log(found["hardness"][site]) for site in ("site A", "site B")]
    peer = stats.ttest_ind(*logs, equal_var=False)
    interval = np.exp(peer.confidence_interval(0.95))
    assert found["ratio"] == pytest.approx(np.exp(logs[0].mean() - logs[1].mean()), rel=1e-9)
    half = np.log(interval[1] / interval[0]) / 2
    assert np.log(found["high"] / found["low"]) / 2 == pytest.approx(half, rel=0.2)


def test_shear_blade(find: Find) -> None:
    """M/(r L e) by hand."""
    found = find("shear_blade")
    assert found["stress"]["S3"] == pytest.approx(12.0 / 0.25 / (100 * 6.0), rel=1e-12)
    by_hand = [moment / 0.25 / (100 * depth) for depth, moment in found["tests"].values()]
    assert found["mean"] == pytest.approx(sum(by_hand) / 5, rel=1e-12)


# Snow that remembers


def test_unloading(find: Find) -> None:
    """By hand: 9 mm of groove, 9 N/mm; elastic snow gives all back. The trapezoids miss the kinks a little."""
    found = find("unloading")
    assert found["groove"] == pytest.approx(9.0, rel=1e-12)
    assert found["lost"][10.0] == pytest.approx(9000.0, rel=1e-3)
    assert found["lost"][1.0] == pytest.approx(0.0, abs=1e-9)


def test_second_in_the_groove(find: Find) -> None:
    """H_V 5 mm - k_u 0.25 mm over 60 · 1600 mm², and nothing until 4.5 mm."""
    found = find("second_in_the_groove")
    assert found["at"] == pytest.approx(0.2 * (5 - 10 * 0.25) * 60 * 1600, rel=1e-9)
    depth, second = 1e3 * found["depths"], np.array(found["second"])
    assert np.all(second[depth < 4.499] == 0.0)
    np.testing.assert_allclose(second[depth > 5.001], 0.2 * depth[depth > 5.001] * 60 * 1600, rtol=1e-9)


def test_own_force_law(find: Find) -> None:
    """0.03 + 0.05 exp(-v)."""
    found = find("own_force_law")
    assert found["at_two"] == pytest.approx(0.03 + 0.05 * math.exp(-2), rel=2e-3)
    speed = found["speeds"]
    law = 0.03 + 0.05 * np.exp(-speed)
    np.testing.assert_allclose(found["share"], law, rtol=1e-9)


# A ski in snow


def test_more_waist(find: Find) -> None:
    """δ = (116 + 101 - 2 · 68)/4 = 20.25 mm less 1 mm; on hard snow the carved radius follows."""
    found = find("more_waist")
    assert found["growth"] == pytest.approx(20.25 / 19.25, rel=1e-3)
    assert found["carved"] == pytest.approx(20.25 / 19.25, rel=5e-3)


def test_does_it_hold(find: Find) -> None:
    """Statics: 800 N tan ϑ."""
    for angle, force in find("does_it_hold")["asked"].items():
        assert force == pytest.approx(800 * math.tan(math.radians(angle)), rel=1e-9)


def test_twelve_metres(find: Find) -> None:
    assert find("twelve_metres")["confirmed"] == pytest.approx(12.0, rel=1e-6)


def test_stiffer_tip(find: Find) -> None:
    """To first order in a change by 10 %."""
    found = find("stiffer_tip")
    assert found["predicted"] == pytest.approx(found["carved"], rel=0.2)


@pytest.mark.slow
def test_robust_ski(find: Find) -> None:
    """Equal deviations on both sides, four tenths of those of the ski for one snow."""
    found = find("robust_ski")
    softest, _, hardest = (found["radius"](found["skis"]["three snows"], each) for each in found["SNOWS"])
    assert hardest - 12.0 == pytest.approx(12.0 - softest, rel=1e-3)
    assert found["worst"]["three snows"] < 0.5 * found["worst"]["one snow"]


# Turns


@pytest.mark.slow
def test_energy_of_a_turn(find: Find) -> None:
    assert find("energy_of_a_turn")["open_by"] < 1e-3


@pytest.mark.slow
def test_skid_to_carve(find: Find) -> None:
    """R_sc cos ϑ within a tenth, once the snow holds: the ski sinks in, which the rule does not know."""
    found = find("skid_to_carve")
    assert found["carved"] == pytest.approx(found["rule"], rel=0.1)
    assert found["skids"] > 2.5 * found["carved"]
    assert found["run"].outcome == "finished"


# Measured tracks


def test_radius_of_a_track_and_two_tracks(find: Find) -> None:
    """The arc that was made; its mean radius within what 51 points that are 10 mm off allow."""
    found = find("radius_of_a_track")
    turn = found["turn"]
    assert turn.direction == "left"
    assert turn.length / turn.mean_radius == pytest.approx(turn.length / 15.0, abs=3 * turn.turned_angle_sd)
    assert turn.mean_radius == pytest.approx(15.0, rel=0.015)
    # Circles about one centre; at equal arc length s the angles s/12.5 and s/12 differ.
    found = find("two_tracks")["largest"]
    assert found["nearest place"] == pytest.approx(0.5, abs=1e-4)
    way = 12 * math.pi / 2
    apart = abs(12.5 * np.exp(1j * way / 12.5) - 12 * np.exp(1j * way / 12))
    assert found["equal arc length"] == pytest.approx(apart, abs=1e-3)


@pytest.mark.slow
def test_friction_from_photo_cells(find: Find) -> None:
    found = find("friction_from_photo_cells")
    assert found["low"] < 0.05 < found["high"]
    assert found["friction"] == pytest.approx(0.05, abs=5e-4)


PUBLIC_PACKAGES = ("skisnow.forces", "skisnow.geometry", "skisnow.identification")
"""Packages whose names docs/api.md shows beside those of `skisnow`."""
NAMES = tuple(builder().names())


def test_every_script_has_its_place() -> None:
    assert sorted(NAMES) == sorted(path.stem for path in builder().EXAMPLES.glob("*.py"))
    assert len(set(NAMES)) == len(NAMES) == 19
    assert sorted(NAMES) == sorted(path.stem for path in builder().PRINTED.iterdir())


@pytest.mark.parametrize("name", NAMES)
def test_examples_are_short_and_use_public_names_and_every_example_is_described(name: str) -> None:
    source = (builder().EXAMPLES / f"{name}.py").read_text(encoding="utf-8")
    assert len(source.splitlines()) < 60
    tree = ast.parse(source)
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("skisnow"):
            assert (node.module or "").startswith(PUBLIC_PACKAGES)
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "skisnow":
            assert node.attr in skisnow.__all__
    assert not re.search(r"skisnow\S*\._", source)
    example = builder().words(name)
    assert example.title and example.text and example.figure and example.known
    assert (builder().PICTURES / f"{name}.png").exists()


def test_the_build_writes_a_card_and_a_section_for_each(tmp_path: Path) -> None:
    builder().write_pages(tmp_path)
    cards, sections = ((tmp_path / f"{name}.md").read_text(encoding="utf-8") for name in ("cards", "examples"))
    assert [cards.count(f"(#{name})") for name in NAMES] == [1] * len(NAMES)
    assert [sections.count(f"({name})=") for name in NAMES] == [1] * len(NAMES)
    assert all(builder().printed(name) in sections for name in NAMES)


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_page_prints_what_the_script_prints(name: str) -> None:
    """After a change of the physics: python docs/write_gallery.py."""
    assert builder().printed(name) == builder().ran(name).printed
