"""Both turn radii against the sidecut: SCIENCE of a carved turn, exact to second order in chord over radius."""

from __future__ import annotations

import math

import numpy as np
import pytest

from skisnow.carving.edge_line import EdgeLine, circle_radius
from skisnow.carving.equilibrium import _conditions, carve
from skisnow.carving.result import Equilibrium
from skisnow.carving.solve import solved
from skisnow.ski import Ski
from skisnow.ski.beam import clamped

from .synthetic import circular_sidecut, plain_ski, race_profile, snow

SIDECUT = 13.0


def carved(
    ski: Ski, angle_deg: float, hardness: float, *, clamp: float = 0.0, twist: bool = False, load: float = 400.0
) -> Equilibrium:
    return carve(
        ski,
        snow(hardness),
        edge_angle=math.radians(angle_deg),
        load=load,
        unloading_ratio=1.0,
        clamp_length=clamp,
        twist=twist,
        elements=320,
    )


def known(value: float | None) -> float:
    assert value is not None
    return value


def circle_ski(*, race: bool = False) -> Ski:
    bending = race_profile(300.0) if race else 300.0
    return plain_ski(width=circular_sidecut(SIDECUT), bending=bending)


@pytest.mark.parametrize("angle_deg", [15.0, 30.0, 45.0, 60.0])
@pytest.mark.parametrize("race", [False, True])
def test_hard_snow_gives_the_sidecut_times_the_cosine(angle_deg: float, race: bool) -> None:
    """Circle through boot and contact ends: the sidecut c(s) leans out to c/cos ϑ where the edge lies in the surface.

    (s² + y²)/(2 y), y = c/cos ϑ, is R_sc cos ϑ to second order, exactly (1 + s² tan²ϑ/(4 R_sc²)) more. The depths that
    are left, D ≤ the greatest, move the radius by D sin ϑ/δ, and vanish as the snow hardens.
    """
    angle, half = math.radians(angle_deg), 0.8
    sagitta = SIDECUT - math.sqrt(SIDECUT**2 - half**2)
    y = sagitta / math.cos(angle)
    limit = (half**2 + y**2) / (2.0 * y)
    assert limit == pytest.approx(SIDECUT * math.cos(angle), rel=0.003)
    for hardness in (1.0, 10.0, 90.0):
        found = carved(circle_ski(race=race), angle_deg, hardness)
        room = float(np.max(np.asarray(found.edge_depth))) * math.sin(angle) / sagitta
        assert abs(known(found.turn_radius_chord) / limit - 1.0) < room
    assert room < 0.015  # 0.4 mm under the point load at 60°, against δ = 25 mm


@pytest.mark.parametrize("hardness", [0.04, 0.2, 1.0, 90.0])
@pytest.mark.parametrize("angle_deg", [20.0, 45.0, 60.0])
@pytest.mark.parametrize("clamp", [0.0, 0.3])
def test_depth_of_the_middle_tightens_the_turn(hardness: float, angle_deg: float, clamp: float) -> None:
    """R = R_sc cos ϑ/(1 + D sin ϑ/δ): D and δ over the chord of the contact, whatever bends the ski."""
    found = carved(circle_ski(), angle_deg, hardness, clamp=clamp)
    assert found.edge_depth is not None
    angle = math.radians(angle_deg)
    depth_at = np.interp([0.0, 0.7, -0.7], found.station[::-1], found.edge_depth[::-1])
    line = np.interp([0.7, 0.0, -0.7], found.station[::-1], np.asarray(found.edge_line)[::-1])
    deeper = depth_at[0] - (depth_at[1] + depth_at[2]) / 2.0
    sagitta = SIDECUT - math.sqrt(SIDECUT**2 - 0.7**2)
    expected = SIDECUT * math.cos(angle) / (1.0 + deeper * math.sin(angle) / sagitta)
    radius = circle_radius((0.7, line[0]), (0.0, line[1]), (-0.7, line[2]))
    # second order: the chord (0.7/R)²/4, R down to 4 m; the interpolation between stations adds 1e-4
    assert radius == pytest.approx(expected, rel=(0.7 / expected) ** 2 / 3.0 + 3e-4)


def test_the_depth_formula_on_the_contact_chord() -> None:
    """The same with the returned radius: symmetric ski, ends of the contact at the surface, D = depth at the boot."""
    found = carved(plain_ski(width=circular_sidecut(SIDECUT)), 30.0, 0.2)
    half = known(found.contact_length) / 2.0
    depth = np.asarray(found.edge_depth)
    # the ski ends in the snow: D is the depth at the boot less that at the ends
    deeper = float(np.interp(0.0, found.station[::-1], depth[::-1])) - float((depth[0] + depth[-1]) / 2.0)
    sagitta = SIDECUT - math.sqrt(SIDECUT**2 - half**2)
    expected = SIDECUT * math.cos(math.pi / 6.0) / (1.0 + deeper * 0.5 / sagitta)
    assert found.turn_radius_chord == pytest.approx(expected, rel=(half / expected) ** 2 / 3.0 + 3e-4)
    assert expected < 0.99 * SIDECUT * math.cos(math.pi / 6.0)


@pytest.mark.parametrize("race", [False, True])
@pytest.mark.parametrize("angle_deg", [30.0, 45.0, 60.0])
def test_a_radius_is_a_definition(angle_deg: float, race: bool) -> None:
    """Boot ± 0.4 m: 4 to 22 % smaller than R_sc cos ϑ under a point load of 800 N, larger with a clamp of 0.3 m."""
    limit = SIDECUT * math.cos(math.radians(angle_deg))
    free, clamped = (
        known(carved(circle_ski(race=race), angle_deg, 90.0, clamp=clamp, load=800.0).turn_radius_boot)
        for clamp in (0.0, 0.3)
    )
    assert 0.78 < free / limit < 0.96
    assert clamped > limit


def test_a_ski_that_cannot_bend_keeps_its_edge_line() -> None:
    """Rigid with a sidecut: from above the edge is the sidecut seen at the angle, R = R_sc/cos ϑ."""
    ski = plain_ski(width=circular_sidecut(SIDECUT), bending=1e16, torsional=1e16)
    found = carved(ski, 45.0, 0.2, clamp=0.0, twist=True)
    # three points on the ellipse of half axes R_sc and R_sc cos ϑ: 0.4²/R² of the second order
    assert found.turn_radius_boot == pytest.approx(SIDECUT / math.cos(math.pi / 4.0), rel=1e-3)


def test_a_straight_flexible_edge_turns_by_its_depth_alone() -> None:
    """No sidecut: y = e's difference times tan ϑ, R = l²/(2 D tan ϑ)."""
    found = carved(plain_ski(), 45.0, 0.04)
    assert found.edge_depth is not None
    depth_at = np.interp([0.0, 0.4, -0.4], found.station[::-1], found.edge_depth[::-1])
    deeper = depth_at[0] - (depth_at[1] + depth_at[2]) / 2.0
    assert found.turn_radius_boot == pytest.approx(0.4**2 / (2.0 * deeper), rel=2e-3)


def test_twisting_opens_the_angle_of_the_ends() -> None:
    """The snow pushes at the edge, so tip and tail lie flatter than the boot: twist is negative, the radius grows."""
    stiff, soft = (carved(circle_ski(), 45.0, 0.2, twist=twist) for twist in (False, True))
    assert np.all(np.asarray(stiff.twist) == 0.0)
    assert np.all(np.asarray(soft.twist)[np.abs(soft.station) > 0.1] < 0.0)
    assert known(soft.turn_radius_boot) != pytest.approx(known(stiff.turn_radius_boot), rel=0.01)


@pytest.mark.parametrize("radius", [4.0, -25.0])
def test_circle_through_three_points(radius: float) -> None:
    centre = np.array([0.13, 0.4 + radius])
    points = [(x, centre[1] - math.copysign(math.sqrt(radius**2 - (x - 0.13) ** 2), radius)) for x in (0.8, 0.1, -0.6)]
    assert circle_radius(*points) == pytest.approx(radius, rel=1e-9)


def test_the_straight_sides_of_a_flat_ski_lie_on_no_circle() -> None:
    ski = plain_ski()
    model = clamped(ski, 0.3, 40)
    line = EdgeLine(model, 0.0, solved(model, _conditions(ski, snow(0.2), 0.0, 400.0, 0.0, 1.0, False, False)))
    assert line.radius_at_boot() is None
    with pytest.raises(ValueError, match="straight edge line"):
        line.offset_from_circle()
