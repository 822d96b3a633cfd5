"""Measured radii of edged skis beside ours."""

import math

import pytest
from benchmarks.page_tables import stale_tables
from scipy.stats import chi2

from benchmarks import measured_radii as measured

from ..carving.synthetic import snow


def test_on_a_floor_radii_agree_within_their_uncertainty() -> None:
    rows = measured.floor_rows()
    off = [(ours - radius) / sd for _, _, radius, sd, _, ours in rows]
    assert max(map(abs, off)) < 2.0
    assert sum(each**2 for each in off) < chi2.ppf(0.95, len(off))
    for _, _, _, _, exact, ours in rows:
        assert ours == pytest.approx(exact, rel=6e-3)


def test_degrees_taken_for_radians_would_be_seen() -> None:
    """At half the angle every floor radius but the flattest would be off by more than two standard deviations."""
    of = measured.FLOOR[0]
    degrees, radius, sd = of.measured[2]
    assert abs(of.sidecut * math.cos(math.radians(0.5 * degrees)) - radius) > 10.0 * sd


def test_at_the_greatest_angle_a_ski_carves_as_tight_as_the_tightest_measured_turn() -> None:
    """Only a bound: with some load between 500 and 2500 N; the wider course is wider than any carve at its angle."""
    short, long = measured.TURNS
    loads = measured.choices(short)["load 500 to 2500 N"]
    assert min(measured.radii(loads)) < short.radius < max(measured.radii(loads))
    assert max(measured.radii(measured.choices(long)["load 500 to 2500 N"])) < long.radius


def test_the_chord_is_the_radius_that_the_clamp_moves_least() -> None:
    for turn in measured.TURNS:
        for of, most in ((measured.chord, 0.2), (measured.boot, math.inf)):
            free, held = (of(measured.carved(turn.angle, clamp_length=length)) for length in (0.0, 0.3))
            assert abs(held / free - 1.0) < most
        assert abs(held / free - 1.0) > 0.8  # by the boot


def test_published_strengths_fail_at_racing_angles() -> None:
    """S_f = 0.40 N/mm², the most measured on race slopes, at H_V = 1 N/mm³ and 65.7°."""
    found = measured.carved(65.7, snow=snow(1.0, 0.40))
    assert found.outcome == "slips"
    assert measured.grip(found) < 0.7


def test_the_page_is_what_is_computed() -> None:
    assert stale_tables(measured.PAGE, measured.tables()) == []


def test_a_footprint_that_gives_bears_under_the_boot() -> None:
    """From a rigid one to the boot's middle only, the headline radius by less than the radius at the boot."""
    rows = measured.footprint_rows()
    for which in range(2):
        found = [each[which] for _, each in rows]
        borne = [measured.borne_by_boot(each) for each in found]
        assert borne[0] < 0.2
        assert borne[-1] > 0.75
        assert sorted(borne[:-1]) == borne[:-1]
        for of, most in ((measured.chord, 0.2), (measured.boot, 0.5)):
            radii = [of(each) for each in found]
            assert sorted(radii, reverse=True) == radii
            assert radii[-2] == pytest.approx(radii[-1], rel=0.03)
            assert 1.0 - radii[-1] / radii[0] < most
