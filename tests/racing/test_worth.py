"""Gains of variants: paired over the same snows, by the point."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from skisnow import load_scenario, read_ski
from skisnow._support.errors import ParameterError
from skisnow.racing import LineTurn, PointRacer, RacingLine, compare_variants, drawn_for_race, worth_changes
from skisnow.racing.worth import wider

from .test_point import WAY, glide, straight_course

SLALOM = load_scenario("slalom-20-gates").with_(course=straight_course())
LINE = RacingLine(straight_course(), (0.0, 0.0), (LineTurn(aside=1.0),) * 3)


def test_less_friction_on_a_straight_line_is_worth_what_the_glide_says() -> None:
    snows = drawn_for_race(SLALOM.contact.snow, 3, spread=0.2, seed=1)
    slower = SLALOM.with_(mu_0=0.06)
    found = {
        each.name: each
        for each in compare_variants(
            SLALOM, {"same": SLALOM, "more friction": slower}, LINE, snows, model="point", workers=1
        )
    }
    assert found["same"].differences.tolist() == [0.0, 0.0, 0.0, 0.0]
    exact = glide(PointRacer.of(slower), WAY)[1] - glide(PointRacer.of(SLALOM), WAY)[1]
    more = found["more friction"]
    assert more.on_own_snow == pytest.approx(exact, rel=1e-6)
    assert more.mean == pytest.approx(exact, rel=1e-6)
    assert more.faster == 0
    assert more.deviation == pytest.approx(0.0, abs=1e-12)


def test_a_race_that_fails_is_left_out_of_the_differences() -> None:
    stuck = SLALOM.with_(mu_0=0.9)
    (found,) = compare_variants(SLALOM, {"stuck": stuck}, LINE, [SLALOM.contact.snow], model="point", workers=1)
    assert found.on_own_snow is None
    assert (found.mean, found.deviation, len(found.differences)) == (None, None, 0)
    assert "not reached" in found.scores[0].words
    with pytest.raises(ParameterError, match="one variant"):
        compare_variants(SLALOM, {}, LINE, [SLALOM.contact.snow])


def test_drawn_snows_lie_about_the_scenarios_own() -> None:
    snow = SLALOM.contact.snow
    assert drawn_for_race(snow, 0, spread=None, seed=0) == [snow]
    own, *drawn = drawn_for_race(snow, 400, spread=0.2, seed=0)
    assert own.snow_hardness == snow.snow_hardness
    shares = np.log([each.snow_hardness / snow.snow_hardness for each in drawn])
    assert np.quantile(shares, [0.025, 0.5, 0.975]) == pytest.approx([-math.log(1.2), 0.0, math.log(1.2)], abs=0.01)
    again = drawn_for_race(snow, 400, spread=0.2, seed=0)
    assert [each.snow_hardness for each in again[1:]] == [each.snow_hardness for each in drawn]
    with pytest.raises(ParameterError, match="no interval"):
        drawn_for_race(snow, 4, spread=None, seed=0)
    with pytest.raises(ParameterError, match="above 0"):
        drawn_for_race(snow, 4, spread=0.0, seed=0)


def test_what_a_variant_changes_of_the_snow_it_changes_of_each_snow() -> None:
    from skisnow.racing.worth import _on

    snow = replace(SLALOM.contact.snow, snow_hardness=2e8, failure_shear_stress=4e5)
    changes = worth_changes(SLALOM)
    harder, stronger = (_on(changes[name], SLALOM, snow).contact.snow for name in ("H_V 10 % more", "S_f 10 % more"))
    assert (harder.snow_hardness, harder.failure_shear_stress) == pytest.approx((2.2e8, 4e5))
    assert (stronger.snow_hardness, stronger.failure_shear_stress) == pytest.approx((2e8, 4.4e5))
    assert changes["stiffness 5 % more"].stiffness_factor == pytest.approx(1.05)
    assert changes["friction 10 % less"].contact.friction == pytest.approx(0.045)
    stiffer = worth_changes(replace(SLALOM, stiffness_factor=1.2, contact=replace(SLALOM.contact, friction=0.1)))
    assert stiffer["stiffness 5 % more"].stiffness_factor == pytest.approx(1.26)
    assert stiffer["friction 10 % less"].contact.friction == pytest.approx(0.09)
    assert stiffer["friction 10 % less"].stiffness_factor == 1.2


def test_a_snow_whose_strength_is_not_known_is_raced_on_by_nobody() -> None:
    snow = replace(SLALOM.contact.snow, failure_shear_stress=None, failure_shear_stress_interval=None)
    with pytest.raises(ParameterError, match="S_f"):
        compare_variants(SLALOM, {"same": SLALOM}, LINE, [snow], model="point", workers=1)


def test_a_millimetre_more_waist_makes_the_sidecut_radius_larger() -> None:
    slalom = read_ski("slalom")
    other = wider(slalom, 1e-3)
    assert other.waist_width - slalom.waist_width == pytest.approx(1e-3, abs=2e-5)
    tip, waist, tail = slalom.sidecut_widths
    depth = (tip + tail - 2.0 * waist) / 4.0
    growth = other.sidecut_radius_of_three_widths / slalom.sidecut_radius_of_three_widths
    assert growth == pytest.approx(depth / (depth - 0.5e-3), rel=0.01)
