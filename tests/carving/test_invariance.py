"""What physics asks whatever the numbers: units, mirror, continuity."""

import math
from dataclasses import replace

import numpy as np
import pytest

from skisnow.carving.edge_line import EdgeLine, circle_radius
from skisnow.carving.equilibrium import _conditions, carve, rest
from skisnow.carving.result import Equilibrium
from skisnow.carving.solve import solved
from skisnow.ski import Ski, read_ski
from skisnow.ski.beam import clamped
from skisnow.snow.properties import SnowProperties
from tests.present import present

from .synthetic import circular_sidecut, plain_ski, race_profile, snow


def ask(
    ski: Ski,
    *,
    hardness: float = 0.2,
    load: float = 800.0,
    angle: float = math.radians(45.0),
    unloading_ratio: float = 10.0,
    clamp_length: float = 0.3,
    moment: float = 0.0,
) -> Equilibrium:
    return carve(
        ski,
        snow(hardness),
        edge_angle=angle,
        load=load,
        unloading_ratio=unloading_ratio,
        clamp_length=clamp_length,
        moment=moment,
    )


def scaled(ski: Ski, length: float, force: float) -> Ski:
    """The ski in other units of length and force."""
    return replace(
        ski,
        station=ski.station * length,
        width=ski.width * length,
        base_height=ski.base_height * length,
        bending_stiffness=ski.bending_stiffness * force * length**2,
        torsional_stiffness=ski.torsional_stiffness * force * length**2,
        running_length=ski.running_length * length,
        sidecut_length=ski.sidecut_length * length,
        edge_width=ski.edge_width * length,
        sidecut_middle=ski.sidecut_middle * length,
    )


@pytest.mark.parametrize("force", [0.25, 4.0])
@pytest.mark.parametrize("length", [0.5, 0.9])
@pytest.mark.parametrize("ratio", [1.0, 10.0])
def test_units(length: float, force: float, ratio: float) -> None:
    """EI and GJ in force × length², H_V in force/length³, S_f in force/length²: depths and radii follow the length.

    The radius at the boot does not: its 0.4 m do not scale.
    """
    ski = read_ski("slalom")
    plain, other = (
        carve(
            scaled(ski, m, n),
            SnowProperties(0.2e9 * n / m**3, 0.3e6 * n / m**2, "test"),
            edge_angle=math.radians(45.0),
            load=800.0 * n,
            moment=20.0 * n * m,
            unloading_ratio=ratio,
            clamp_length=0.3 * m,
        )
        for m, n in ((1.0, 1.0), (length, force))
    )
    # the same equations but for rounding; Newton's method stops at 1e-11 m and 1e-8 of the load
    assert other.edge_depth == pytest.approx(length * present(plain.edge_depth), rel=1e-6, abs=1e-9)
    for name, factor in (
        ("turn_radius_chord", length),
        ("contact_length", length),
        ("bearing_length", length),
        ("afterbody_depth_ratio", 1.0),
        ("side_force", force),
        ("side_force_limit", force),
    ):
        assert getattr(other, name) == pytest.approx(factor * getattr(plain, name), rel=1e-6), name
    assert other.bending == pytest.approx(length * np.asarray(plain.bending), rel=1e-6, abs=1e-8)
    assert other.twist == pytest.approx(np.asarray(plain.twist), rel=1e-6, abs=1e-8)


def turned(ski: Ski) -> Ski:
    """The ski with tip and tail exchanged."""
    return replace(
        ski,
        station=-ski.station[::-1],
        **{
            name: getattr(ski, name)[::-1]
            for name in ("width", "base_height", "bending_stiffness", "torsional_stiffness", "mass_per_length")
        },
        sidecut_middle=-ski.sidecut_middle,
    )


def test_mirror() -> None:
    """On elastic snow nothing tells forwards from backwards: a ski turned round under the opposite moment."""
    ski = read_ski("giant-slalom")
    plain = ask(ski, unloading_ratio=1.0, moment=25.0)
    back = ask(turned(ski), unloading_ratio=1.0, moment=-25.0)
    assert present(back.edge_depth)[::-1] == pytest.approx(present(plain.edge_depth), rel=1e-6, abs=1e-9)
    assert back.turn_radius_boot == pytest.approx(plain.turn_radius_boot, rel=1e-7)
    assert back.afterbody_depth_ratio == pytest.approx(1.0 / present(plain.afterbody_depth_ratio), rel=1e-6)
    assert plain.forebody_load is not None and plain.afterbody_load is not None
    assert back.afterbody_load == pytest.approx(plain.forebody_load, rel=1e-6)
    assert plain.forebody_load + plain.afterbody_load == pytest.approx(800.0, rel=1e-7)
    assert plain.forebody_load > plain.afterbody_load  # the moment presses the tip down


def test_memory_tells_forwards_from_backwards() -> None:
    """The half that follows lies deeper, whichever it is."""
    ski = read_ski("giant-slalom")
    for each in (ski, turned(ski)):
        ratio = present(ask(each, unloading_ratio=10.0).afterbody_depth_ratio)
        assert ratio > 1.3


@pytest.mark.parametrize("name", ["hardness", "load", "angle", "unloading_ratio", "clamp_length"])
@pytest.mark.parametrize("ratio", [1.0, 10.0])
@pytest.mark.parametrize("hardness", [0.04, 0.2, 10.0])
def test_small_changes_move_little(name: str, ratio: float, hardness: float) -> None:
    """A millionth more of any input moves radius, depth and contact by less than a hundred-thousandth."""
    start = {
        "hardness": hardness,
        "load": 800.0,
        "angle": math.radians(45.0),
        "unloading_ratio": ratio,
        "clamp_length": 0.3,
    }
    ski = read_ski("slalom")
    before, after = ask(ski, **start), ask(ski, **{**start, name: start[name] * (1.0 + 1e-6)})
    assert after.outcome == before.outcome
    assert after.turn_radius_boot == pytest.approx(before.turn_radius_boot, rel=1e-5)
    assert after.contact_length == pytest.approx(before.contact_length, rel=1e-5)
    assert present(after.edge_depth).max() == pytest.approx(present(before.edge_depth).max(), rel=1e-5)


def test_rest_is_a_carve_without_side_force_or_memory() -> None:
    ski = read_ski("slalom")
    standing = rest(ski, snow(0.2), edge_angle=math.radians(45.0), load=800.0)
    carving = ask(ski, unloading_ratio=1.0)
    unbent = carve(
        ski, snow(0.2), edge_angle=math.radians(45.0), load=800.0, unloading_ratio=1.0, side_force_bending=False
    )
    assert standing.edge_depth == pytest.approx(np.asarray(unbent.edge_depth), rel=1e-7, abs=1e-10)
    assert (standing.side_force, standing.holds) == (0.0, True)
    assert standing.turn_radius_boot is None  # it does not turn
    assert carving.turn_radius_boot != pytest.approx(unbent.turn_radius_boot, rel=0.01)


def test_harder_snow_heavier_load() -> None:
    """Depth falls with hardness and grows with the load; the radius moves the other way than the depth.

    From 500 N on: a light load does not bend the ski onto the snow, it stands on tip and tail and cuts deep there.
    """
    ski = read_ski("slalom")
    by_hardness = [ask(ski, hardness=h) for h in (0.04, 0.2, 1.0, 10.0)]
    by_load = [ask(ski, load=f) for f in (500.0, 1000.0, 1500.0, 2000.0)]
    for found, sign in ((by_hardness, -1.0), (by_load, 1.0)):
        depths = [float(np.max(np.asarray(each.edge_depth))) for each in found]
        assert np.all(sign * np.diff(depths) > 0.0)


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
        assert abs(present(found.turn_radius_chord) / limit - 1.0) < room
    assert room < 0.015  # 0.4 mm under the point load at 60°, against δ = 25 mm


@pytest.mark.parametrize("hardness", [0.04, 0.2, 1.0, 90.0])
@pytest.mark.parametrize("angle_deg", [20.0, 45.0, 60.0])
@pytest.mark.parametrize("clamp", [0.0, 0.3])
def test_depth_of_the_middle_tightens_the_turn(hardness: float, angle_deg: float, clamp: float) -> None:
    """R = R_sc cos ϑ/(1 + D sin ϑ/δ): D and δ over the chord of the contact, whatever bends the ski."""
    found = carved(circle_ski(), angle_deg, hardness, clamp=clamp)
    angle = math.radians(angle_deg)
    depth_at = np.interp([0.0, 0.7, -0.7], found.station[::-1], present(found.edge_depth)[::-1])
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
    half = present(found.contact_length) / 2.0
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
        present(carved(circle_ski(race=race), angle_deg, 90.0, clamp=clamp, load=800.0).turn_radius_boot)
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
    depth_at = np.interp([0.0, 0.4, -0.4], found.station[::-1], present(found.edge_depth)[::-1])
    deeper = depth_at[0] - (depth_at[1] + depth_at[2]) / 2.0
    assert found.turn_radius_boot == pytest.approx(0.4**2 / (2.0 * deeper), rel=2e-3)


def test_twisting_opens_the_angle_of_the_ends() -> None:
    """The snow pushes at the edge, so tip and tail lie flatter than the boot: twist is negative, the radius grows."""
    stiff, soft = (carved(circle_ski(), 45.0, 0.2, twist=twist) for twist in (False, True))
    assert np.all(np.asarray(stiff.twist) == 0.0)
    assert np.all(np.asarray(soft.twist)[np.abs(soft.station) > 0.1] < 0.0)
    assert present(soft.turn_radius_boot) != pytest.approx(present(stiff.turn_radius_boot), rel=0.01)


@pytest.mark.parametrize("radius", [4.0, -25.0])
def test_circle_through_three_points(radius: float) -> None:
    centre = np.array([0.13, 0.4 + radius])
    points = [(x, centre[1] - math.copysign(math.sqrt(radius**2 - (x - 0.13) ** 2), radius)) for x in (0.8, 0.1, -0.6)]
    assert circle_radius(*points) == pytest.approx(radius, rel=1e-9)


def test_the_straight_sides_of_a_flat_ski_lie_on_no_circle() -> None:
    ski = plain_ski()
    model = clamped(ski, 0.3, 40)
    line = EdgeLine(model, 0.0, solved(model, _conditions(ski, snow(0.2), 0.0, 400.0, 0.0, 1.0, twist=False)))
    assert line.radius_at_boot() is None
    with pytest.raises(ValueError, match="straight edge line"):
        line.offset_from_circle()
