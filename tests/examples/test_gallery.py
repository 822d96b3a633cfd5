"""Each example of the gallery finds a number that is known from elsewhere; its docstring says where."""

from __future__ import annotations

import math
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


def test_one_series(find: Find) -> None:
    """H_V = F/V, V = L e²/(2 tan 45°) by hand."""
    assert find("one_series")["hardness"] == pytest.approx(492 / (200 * 7.0**2 / 2), rel=1e-12)


def test_flat_or_edged(find: Find) -> None:
    """0.04 N/mm³ · 10,000 mm³; a wedge at half the depth displaces a quarter."""
    found = find("flat_or_edged")
    assert found["load"] == pytest.approx(400.0, rel=1e-12)
    assert found["half"] / found["load"] == pytest.approx(0.25, rel=1e-12)


def test_gauge_offset(find: Find) -> None:
    """The offset and the hardness that the readings were made with, to the digits that they were written with."""
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
    assert (found["low"], found["high"]) == pytest.approx(tuple(interval), rel=1e-9)
    assert found["pair"]["p"] == pytest.approx(peer.pvalue, rel=1e-6)


def test_shear_blade(find: Find) -> None:
    """M/(r L e) by hand."""
    found = find("shear_blade")
    assert found["stress"]["S3"] == pytest.approx(12.0 / 0.25 / (100 * 6.0), rel=1e-12)
    by_hand = [moment / 0.25 / (100 * depth) for depth, moment in found["tests"].values()]
    assert found["mean"] == pytest.approx(sum(by_hand) / 5, rel=1e-12)


def test_slope_of_a_relation(find: Find) -> None:
    found = find("slope_of_a_relation")
    slope, start = np.polyfit(found["angle"], found["stress"], 1)
    assert (found["slope"], found["found"].b[0]) == pytest.approx((slope, start), rel=1e-9)
    peer = stats.linregress(found["angle"], found["stress"])
    assert found["high"] - slope == pytest.approx(stats.t.ppf(0.975, 28) * peer.stderr, rel=1e-9)


def test_machining(find: Find) -> None:
    """S_f = 2 S for a vertical blade without friction, and Eqn 13 there."""
    found = find("machining")
    assert found["ratio"] == pytest.approx(2.0, rel=1e-12)
    assert 1e-6 * found["upright"] == pytest.approx(0.059 * (1 - 0.266 * math.pi / 2), rel=1e-9)
    assert found["flatter"] == pytest.approx(1 / math.tan(math.radians(15)), rel=1e-9)


def test_groomed_or_natural(find: Find) -> None:
    """As printed; 0.0015 is cut off, not rounded: 0.0016 follows from the printed relation."""
    groomed, natural = find("groomed_or_natural")["at_500"]
    assert groomed == pytest.approx(0.11, abs=0.005)
    assert natural == pytest.approx(0.0015, abs=1e-4)


def test_published_snows(find: Find) -> None:
    """The six printed numbers, to their two digits."""
    snows = find("published_snows")["snows"]
    printed = {"race-piste": (0.21, 0.52), "recreational-piste": (0.16, 0.086), "spring-snow": (0.022, 0.094)}
    for name, (hardness, stress) in printed.items():
        assert float(f"{1e-9 * snows[name].snow_hardness:.2g}") == hardness
        assert float(f"{1e-6 * snows[name].failure_shear_stress:.2g}") == stress


# Snow that remembers


def test_unloading(find: Find) -> None:
    """By hand: 9 mm of groove, 9 N/mm; elastic snow gives all back. The trapezoids miss the kinks a little."""
    found = find("unloading")
    assert found["groove"] == pytest.approx(9.0, rel=1e-12)
    assert found["lost"][10.0] == pytest.approx(9000.0, rel=1e-3)
    assert found["lost"][1.0] == pytest.approx(0.0, abs=1e-9)


def test_pushed_by_hand(find: Find) -> None:
    """½ H_V e² w, and (1 - H_V/k_u) of it in the groove; the lines of snow stand 5 mm apart on a ramp of 75 mm."""
    found = find("pushed_by_hand")
    assert found["steady"] == pytest.approx(0.5 * 2e8 * 0.003**2 * 0.08, rel=0.01)
    assert found["per_metre"] == pytest.approx(0.9 * 0.5 * 2e8 * 0.003**2 * 0.08, rel=0.01)


def test_second_in_the_groove(find: Find) -> None:
    """H_V 5 mm - k_u 0.25 mm over 60 · 1600 mm², and nothing until 4.5 mm."""
    found = find("second_in_the_groove")
    assert found["at"] == pytest.approx(0.2 * (5 - 10 * 0.25) * 60 * 1600, rel=1e-9)
    depth, second = 1e3 * found["depths"], np.array(found["second"])
    assert np.all(second[depth < 4.499] == 0.0)
    np.testing.assert_allclose(second[depth > 5.001], 0.2 * depth[depth > 5.001] * 60 * 1600, rtol=1e-9)


def test_edge_lets_go(find: Find) -> None:
    """S_f L e (Eqn 9)."""
    for depth, force in find("edge_lets_go")["held"].items():
        assert force == pytest.approx(0.3e6 * 1.6 * depth, rel=1e-6)


def test_two_angles(find: Find) -> None:
    """H_V L e²/(2 tan ϑ) of each by itself: 30° and 60° stand as tan 60° to tan 30°, three to one."""
    found = find("two_angles")
    np.testing.assert_allclose(found["found"][:, 1], found["exact"], rtol=1e-9)
    assert found["found"][0, 0] / found["found"][10, 1] == pytest.approx(3.0, rel=1e-9)


def test_own_force_law(find: Find) -> None:
    """0.03 + 0.05 exp(-v); the contact lets friction fade below 10 mm/s, as v/√(v² + 0.01²)."""
    found = find("own_force_law")
    assert found["at_two"] == pytest.approx(0.03 + 0.05 * math.exp(-2), rel=2e-3)
    speed = found["speeds"]
    law = 0.03 + 0.05 * np.exp(-speed)
    np.testing.assert_allclose(found["share"], law * speed / np.hypot(speed, 0.01), rtol=1e-6)


# A ski in snow


def test_beam_on_snow(find: Find) -> None:
    """Hetényi's deflection under a force in the middle of a free beam, P λ/(2 k) (2 + Ch + c)/(Sh + s) of λ L."""
    found = find("beam_on_snow")
    k, wave = 0.022e9 * 0.06, (0.022e9 * 0.06 / (4 * 600.0)) ** 0.25
    a = wave * 0.6
    exact = 400 * wave / (2 * k) * (2 + math.cosh(a) + math.cos(a)) / (math.sinh(a) + math.sin(a))
    assert found["exact"][0] == pytest.approx(exact, rel=1e-9)
    assert float(found["depth"].max()) == pytest.approx(exact, rel=1e-3)


def test_more_waist(find: Find) -> None:
    """δ = (116 + 101 - 2 · 68)/4 = 20.25 mm less 1 mm; on hard snow the carved radius follows."""
    found = find("more_waist")
    assert found["growth"] == pytest.approx(20.25 / 19.25, rel=1e-3)
    assert found["carved"] == pytest.approx(20.25 / 19.25, rel=5e-3)


def test_sidecut_and_angle(find: Find) -> None:
    """R_sc cos ϑ, a rule for arcs that are flat beside their radius; and the ski sinks in a tenth of a millimetre."""
    found = find("sidecut_and_angle")
    np.testing.assert_allclose(found["hard"][:8], found["rule"][:8], rtol=0.015)


def test_does_it_hold(find: Find) -> None:
    """Statics: 800 N tan ϑ."""
    for angle, force in find("does_it_hold")["asked"].items():
        assert force == pytest.approx(800 * math.tan(math.radians(angle)), rel=1e-9)


def test_many_carved_turns(find: Find) -> None:
    found = find("many_carved_turns")
    assert len(found["table"].rows) == 200
    assert found["worst"] < 1e-9
    slips = [row["outcome"] == "slips" for row in found["rows"]]
    np.testing.assert_array_equal(slips, found["force"] > found["limit"])


# Turns


def test_straight_glide(find: Find) -> None:
    """Newton's point mass; the sledge also presses a little snow and bends its skis."""
    found = find("straight_glide")
    pull, drag = 9.81 * (math.sin(math.radians(10)) - 0.05 * math.cos(math.radians(10))), 0.5 * 1.2 * 0.42
    final = math.sqrt(pull * found["mass"] / drag)
    exact = final * math.tanh(math.atanh(3.0 / final) + 8.0 * pull / final)
    assert float(found["run"].speed[-1]) == pytest.approx(exact, rel=2e-3)


def test_one_leg_drawn_up(find: Find) -> None:
    """Statics of a lean by hand, with what the legs' stop still swings."""
    found = find("one_leg_drawn_up")
    assert found["lean"][-1] == pytest.approx(math.degrees(math.atan2(0.08, 0.5)), abs=0.1)
    known = 80.0 * 9.81 * (0.25 + 0.6 * 0.16) / (0.5 + 0.08 * 0.16)
    assert found["found"] == pytest.approx(known, rel=0.01)


def test_over_a_roll(find: Find) -> None:
    """Height and speed exchange; what the skis swing with the roll is a few hundredths of a metre per second."""
    found = find("over_a_roll")
    assert found["run"].outcome == "finished"
    assert found["off"] < 0.05


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


def test_radius_of_a_track(find: Find) -> None:
    """The arc that was made; its mean radius within what 51 points that are 10 mm off allow."""
    found = find("radius_of_a_track")
    turn = found["turn"]
    assert turn.direction == "left"
    assert turn.length / turn.mean_radius == pytest.approx(turn.length / 15.0, abs=3 * turn.turned_angle_sd)
    assert turn.mean_radius == pytest.approx(15.0, rel=0.015)


def test_two_tracks(find: Find) -> None:
    """Circles about one centre; at equal arc length s the angles s/12.5 and s/12 differ."""
    found = find("two_tracks")["largest"]
    assert found["nearest place"] == pytest.approx(0.5, abs=1e-4)
    way = 12 * math.pi / 2
    apart = abs(12.5 * np.exp(1j * way / 12.5) - 12 * np.exp(1j * way / 12))
    assert found["equal arc length"] == pytest.approx(apart, abs=1e-3)


def test_track_on_a_slope(find: Find) -> None:
    """An arc second on WGS84: (M + h) π/648000, M = a (1 - e²)/(1 - e² sin²φ)^1.5."""
    found = find("track_on_a_slope")
    e2, latitude = 0.00669437999014, math.radians(47.0)
    meridian = 6378137.0 * (1 - e2) / (1 - e2 * math.sin(latitude) ** 2) ** 1.5
    south = (meridian + 1500.0) * math.pi / 648000
    assert found["x"][-1] - found["x"][0] == pytest.approx(south / math.cos(math.radians(20)), abs=2e-3)


@pytest.mark.slow
def test_friction_from_photo_cells(find: Find) -> None:
    found = find("friction_from_photo_cells")
    assert found["low"] < 0.05 < found["high"]
    assert found["friction"] == pytest.approx(0.05, abs=5e-4)
