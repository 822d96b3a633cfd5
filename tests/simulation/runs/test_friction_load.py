"""The load of glide friction: the load along the snow's normal, or that square on the base."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from skisnow import Run
from skisnow.contact import SnowContact, SnowField
from skisnow.forces.friction.load import ActsOn
from skisnow.simulation.simulated_run import simulate

from ...carving.synthetic import circular_sidecut
from ...contact.conftest import edged, straight
from .sledges import GRAVITY, arc_base, rigid_ski, scenario
from .test_steady_circle import EDGE_DEG, LENGTH, RADIUS, SIDECUT, SPEED, sufficient_strength

FRICTION, EDGE = 0.05, math.radians(EDGE_DEG)


def circle(acts_on: ActsOn) -> Run:
    """Level, on rigid skis whose edges are the arc, slowed by friction only, at 80 % of the grip.

    With much more grip both ends of a ski pull against each other, which loads the base beyond the balance.
    """
    given = scenario(
        ski=rigid_ski(length=LENGTH, width=circular_sidecut(SIDECUT), base_height=arc_base(SIDECUT, EDGE_DEG)),
        strength=sufficient_strength() / 0.8,
        unloading_ratio=1.0,
        compaction=False,
        edge_deg=EDGE_DEG,
        stance=0.3,
        friction=FRICTION,
        speed=SPEED,
        duration=3.0,
    )
    return simulate(replace(given, contact=replace(given.contact, friction_acts_on=acts_on)))


def test_on_the_snow_normal_the_circle_brakes_as_a_straight_run() -> None:
    """v² = v₀² - 2 μ g s."""
    run = circle("snow-normal")
    way = np.linalg.norm(np.diff(run.place[:, :2], axis=0), axis=1).sum()
    assert SPEED**2 - run.speed[-1] ** 2 == pytest.approx(2.0 * FRICTION * GRAVITY * way, rel=2e-3)


def test_on_the_base_it_brakes_with_the_side_force() -> None:
    """m v dv/ds = -μ (m g cos ϑ + m v² sin ϑ/R) at a fixed edge angle, so that with a = 2 μ sin ϑ/R and b = R g cot ϑ
    v² = (v₀² + b) exp(-a s) - b."""
    run = circle("base-normal")
    way = np.linalg.norm(np.diff(run.place[:, :2], axis=0), axis=1).sum()
    a, b = 2.0 * FRICTION * math.sin(EDGE) / RADIUS, RADIUS * GRAVITY / math.tan(EDGE)
    lost = SPEED**2 + b - (SPEED**2 + b) * math.exp(-a * way)
    assert SPEED**2 - run.speed[-1] ** 2 == pytest.approx(lost, rel=2e-3)


def test_in_balance_it_is_the_closed_form_of_a_leaning_skier() -> None:
    """v²(s) = R g sinh(asinh(v₀²/(R g)) - 2 μ s/R), where the edge angle follows tan ϑ = v²/(R g) at every speed.

    A rigid runner is held at that angle, at the depth that bears the weight, by the share of its grip that the circle
    asks for; its drag gives the speed by a fourth-order rule of Runge and Kutta.
    """
    radius, weight, speed, hardness, reach = 12.0, 800.0, 9.0, 2e8, 0.5e-3

    def drag(square: float) -> float:
        angle = math.atan(square / (radius * GRAVITY))
        depth = math.sqrt(2.0 * weight * math.tan(angle) / (hardness * 1.6))
        strength = 2.0 * weight * math.tan(angle) / (1.6 * depth)
        snow = SnowField(hardness, strength, 1.0, FRICTION, "base-normal", "along-ski", shear_displacement=reach)
        contact = SnowContact(snow, [straight()])
        height, turned = 0.03 * math.sin(angle) - depth, edged(angle)[None]
        contact.update([[0.0, 0.0, height]], turned, 1e-3)
        motion = [[math.sqrt(square), 0, 0, 0, 0, 0]]
        found = contact.force([[1e-3 * math.sqrt(square), -0.5 * reach, height]], turned, motion, 1e-3).wrench[0]
        assert found[1:3] == pytest.approx([weight * math.tan(angle), weight], rel=1e-9)
        return float(2.0 * GRAVITY * found[0] / weight)  # dv²/ds

    way, steps, square = 20.0, 10, speed**2
    for _ in range(steps):
        h = way / steps
        first = drag(square)
        second = drag(square + 0.5 * h * first)
        third = drag(square + 0.5 * h * second)
        square += h / 6.0 * (first + 2.0 * second + 2.0 * third + drag(square + h * third))
    scale = radius * GRAVITY
    exact = scale * math.sinh(math.asinh(speed**2 / scale) - 2.0 * FRICTION * way / radius)
    assert square == pytest.approx(exact, rel=1e-5)
