"""A mass on a line against exact solutions: straight glide, a turn on level snow; gates, and lines that fail."""

import math
from dataclasses import replace
from typing import Literal

import numpy as np
import pytest

from skisnow import Course, Gate, Profile, load_scenario
from skisnow._support.errors import ParameterError
from skisnow.racing import LineTurn, PointRacer, RacingLine, follower_line
from skisnow.racing.line import first_gates

RACER = PointRacer(slope_angle=math.radians(12.0), mass=80.0, friction=0.05, drag=0.35, speed=4.0)


class Straight:
    """Down the fall line."""

    def at(self, x: float) -> tuple[float, float, float]:
        return 0.0, 0.0, 0.0 * x


class Circle:
    """To the left from the fall line, of a radius (m)."""

    radius = 15.0

    def at(self, x: float) -> tuple[float, float, float]:
        rise = math.sqrt(self.radius**2 - x * x)
        return self.radius - rise, x / rise, self.radius**2 / rise**3


def glide(racer: PointRacer, way: float) -> tuple[float, float]:
    """Speed (m/s) and time (s) of a straight glide, exactly: v' = a - (k/m) v²."""
    a = racer.gravity * (math.sin(racer.slope_angle) - racer.friction * math.cos(racer.slope_angle))
    k = racer.drag / racer.mass
    limit = math.sqrt(a / k)
    speed = math.sqrt(limit**2 + (racer.speed**2 - limit**2) * math.exp(-2.0 * k * way))
    return speed, (math.atanh(speed / limit) - math.atanh(racer.speed / limit)) / math.sqrt(a * k)


def test_straight_glide() -> None:
    x, square, time = RACER.motion(Straight(), [0.0, 120.0])
    assert x[-1] == 120.0
    assert (math.sqrt(square[-1]), time[-1]) == pytest.approx(glide(RACER, 120.0), rel=1e-8)


class Diagonal:
    """Straight, half a metre to the left for each metre down."""

    def at(self, x: float) -> tuple[float, float, float]:
        return 0.5 * x, 0.5, 0.0


def test_a_traverse_bears_what_pulls_aside_too() -> None:
    """Without drag v² = v₀² + 2 (g sin α cos χ - μ √((g cos α)² + (g sin α sin χ)²)) s, tan χ = ½."""
    racer, long = replace(RACER, slope_angle=0.6, friction=0.3, drag=0.0), math.sqrt(1.25)
    x, square, time = racer.motion(Diagonal(), [0.0, 20.0])
    pull, press = 9.81 * math.sin(0.6), 9.81 * math.cos(0.6)
    gained = pull / long - 0.3 * math.hypot(press, pull * 0.5 / long)
    speed = math.sqrt(16.0 + 2.0 * gained * 20.0 * long)
    assert x[-1] == 20.0
    assert math.sqrt(square[-1]) == pytest.approx(speed, rel=1e-9)
    assert time[-1] == pytest.approx((speed - 4.0) / gained, rel=1e-4)


def test_a_turn_on_level_snow_slows_down_as_the_load_grows() -> None:
    """Without drag v² = R g sinh(asinh(v₀²/(R g)) - 2 μ s/R)."""
    level = replace(RACER, slope_angle=0.0, drag=0.0, speed=9.0)
    x, square, _ = level.motion(Circle(), [0.0, 13.0])
    bend = Circle.radius * level.gravity
    along = Circle.radius * math.asin(x[-1] / Circle.radius)
    exact = bend * math.sinh(math.asinh(81.0 / bend) - 2.0 * 0.05 * along / Circle.radius)
    assert square[-1] == pytest.approx(exact, rel=1e-6)


def test_without_losses_the_speed_is_that_of_the_height_whatever_the_line() -> None:
    free = replace(RACER, friction=0.0, drag=0.0)
    line = follower_line(load_scenario("slalom-20-gates"))
    x, square, _ = free.motion(line, line.breaks)
    assert square == pytest.approx(16.0 + 2.0 * 9.81 * math.sin(free.slope_angle) * x, rel=1e-6)


def test_it_stops_where_friction_is_greater_than_the_slope() -> None:
    x, square, _ = replace(RACER, friction=0.5).motion(Straight(), [0.0, 60.0])
    assert x[-1] < 4.0**2 / (2.0 * 9.81 * (0.5 * math.cos(0.2094) - math.sin(0.2094))) + 0.5
    assert square[-1] > 0.0


def test_it_converges_with_the_fourth_power_of_the_step(monkeypatch: pytest.MonkeyPatch) -> None:
    line = follower_line(load_scenario("slalom-20-gates"))
    times = []
    for step in (2.0, 1.0, 0.5, 0.05):
        monkeypatch.setattr("skisnow.racing.point.STEP", step)
        times.append(RACER.motion(line, line.breaks[:13])[2][-1])
    first, second, third = (abs(each - times[-1]) for each in times[:-1])
    assert third < 1e-6
    assert np.log2([first / second, second / third]) == pytest.approx([4.0, 4.0], abs=0.8)


WAY = 30.0
"""To the last gate (m)."""


def straight_course(clear: float = 1.0) -> Course:
    """Gates across the fall line, which passes each at one distance from its pole."""
    sides: tuple[Literal["left", "right"], ...] = ("left", "right", "left")
    poles = [(10.0 + 10.0 * i, -clear if side == "left" else clear) for i, side in enumerate(sides)]
    return Course(
        gates=tuple(
            Gate(name=f"{x:g}", turning=(x, y), side=side, outer=(x, y + (6.0 if side == "left" else -6.0)))
            for (x, y), side in zip(poles, sides, strict=True)
        )
    )


def test_gates_are_passed_by_both_sides_of_the_racer() -> None:
    course, racer = straight_course(), replace(RACER, half_width=0.25)
    found = racer.score(RacingLine(course, (0.0, 0.0), (LineTurn(aside=1.0),) * 3))
    assert found.time == found.value == pytest.approx(glide(racer, WAY)[1], abs=1e-6)  # of steps
    near = racer.score(RacingLine(course, (0.0, 0.0), (LineTurn(aside=1.0), LineTurn(aside=0.2), LineTurn(aside=1.0))))
    assert (near.time, near.passed) == (None, 2)
    assert "straddled" in near.words
    nearer = racer.score(
        RacingLine(course, (0.0, 0.0), (LineTurn(aside=1.0), LineTurn(aside=0.1), LineTurn(aside=1.0)))
    )
    beside = racer.score(
        RacingLine(course, (0.0, 0.0), (LineTurn(aside=0.1), LineTurn(aside=0.1), LineTurn(aside=1.0)))
    )
    assert 1000.0 < near.value < nearer.value < 2000.0 < beside.value


def test_a_line_tighter_than_the_ski_fails_by_how_much() -> None:
    line = first_gates(follower_line(load_scenario("slalom-20-gates")), 4)
    assert replace(RACER, least_radius=4.0).score(line).time is not None
    found = [replace(RACER, least_radius=radius).score(line).value for radius in (5.0, 6.0)]
    assert 1000.0 < found[0] < found[1]


def test_point_model_of_a_scenario() -> None:
    slalom = load_scenario("slalom-20-gates")
    racer = PointRacer.of(slalom)
    assert racer.mass == pytest.approx(75.0 + 2.0 * slalom.ski.mass)
    assert racer.least_radius == pytest.approx(slalom.ski.sidecut_radius_of_edge_line * math.cos(math.radians(66.0)))
    assert racer.drag == pytest.approx(0.5 * slalom.air.density * 0.66)
    x = np.linspace(-5.0, 220.0, 300)
    with pytest.raises(ParameterError, match="races on a plane"):
        PointRacer.of(replace(slalom, slope=Profile(x, -0.12 * x)))
