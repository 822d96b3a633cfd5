"""Forces, moments and bending computed again from what `carve` returns."""

import math
from types import SimpleNamespace
from typing import Any, cast, get_args

import numpy as np
import numpy.typing as npt
import pytest
from scipy.integrate import solve_bvp

from skisnow._support.arrays import FloatArray
from skisnow._support.errors import ParameterError
from skisnow.carving.edge_line import circle_radius
from skisnow.carving.equilibrium import GrooveForm, MomentBalance, carve
from skisnow.carving.result import Equilibrium, _warnings_of_line
from skisnow.ski import Ski, read_ski
from tests.coded import raises

from .synthetic import plain_ski, snow, weights

CLAMP = 0.3


def given(values: FloatArray | None) -> FloatArray:
    assert values is not None
    return values


def force_law(found: Equilibrium, ski: Ski, edge_angle: float, hardness: float, ratio: float) -> FloatArray:
    """Force per length from the returned depth and twist: 20 001 points across, the groove a running maximum."""
    angle = edge_angle + given(found.twist)
    depth = given(found.edge_depth)
    reach = ski.at(found.station).width * np.cos(angle)
    groove: FloatArray = np.full(4001, -1.0)
    place = np.linspace(0.0, min(float(reach.max()), 1.5 * depth.max() / math.tan(edge_angle)), 4001)
    force = np.zeros(len(depth))
    for i, (edge, phi) in enumerate(zip(depth, angle, strict=True)):
        base = edge - place * math.tan(phi)
        pressure = np.maximum(hardness * (base - (ratio - 1.0) * np.maximum(groove - base, 0.0)), 0.0)
        force[i] = np.trapezoid(pressure * (place <= reach[i]), place)
        groove = np.maximum(groove, base)
    return force


@pytest.mark.parametrize("moment", [-40.0, 0.0, 40.0])
@pytest.mark.parametrize(("angle_deg", "ratio"), [(20.0, 1.0), (45.0, 10.0), (65.0, 50.0)])
@pytest.mark.parametrize("groove", ["edge", "path"])
def test_load_and_moment(angle_deg: float, ratio: float, moment: float, groove: str) -> None:
    """∫ f ds = load and ∫ f s ds = moment, with weights and a trapezoidal rule of our own."""
    ski = read_ski("giant-slalom")
    found = carve(
        ski,
        snow(0.2),
        edge_angle=math.radians(angle_deg),
        load=900.0,
        moment=moment,
        unloading_ratio=ratio,
        groove="edge" if groove == "edge" else "path",
    )
    force = given(found.force_per_length)
    weight = weights(ski, CLAMP)
    assert weight.sum() == pytest.approx(ski.length, rel=1e-12)
    assert weight @ force == pytest.approx(900.0, rel=2e-8)
    assert weight @ (force * found.station) == pytest.approx(moment, abs=2e-8 * 900.0)
    assert found.residual_force == pytest.approx(weight @ force - 900.0, abs=1e-9)
    assert found.residual_moment == pytest.approx(weight @ (force * found.station) - moment, abs=1e-9)
    # without the package's weights: kinks in f, spacing 6 and 5 mm
    assert -np.trapezoid(force, found.station) == pytest.approx(900.0, rel=3e-3)


def test_a_moment_presses_the_tip_down() -> None:
    ahead, behind = (
        carve(
            read_ski("slalom"), snow(0.2), edge_angle=math.radians(45.0), load=800.0, moment=moment, unloading_ratio=1.0
        )
        for moment in (40.0, -40.0)
    )
    front = ahead.station > 0.2
    assert np.mean(given(ahead.edge_depth)[front]) > np.mean(given(behind.edge_depth)[front])


@pytest.mark.parametrize(("angle_deg", "ratio"), [(20.0, 1.0), (45.0, 10.0), (65.0, 50.0)])
def test_force_is_the_point_law_of_the_depth(angle_deg: float, ratio: float) -> None:
    """Every f(s) from e(s) and φ(s) alone, memory included, by quadrature across."""
    ski, angle = read_ski("giant-slalom"), math.radians(angle_deg)
    found = carve(ski, snow(0.2), edge_angle=angle, load=900.0, unloading_ratio=ratio)
    force = given(found.force_per_length)
    # the groove is kept at five places and straight between them; where the ski twists it is 1 µm off, which the steep
    # unloading turns into force
    waterline = float(given(found.edge_depth).max()) / math.tan(angle)
    micrometre = 1e-6 * ratio * 0.2e9 * waterline
    assert force == pytest.approx(force_law(found, ski, angle, 0.2e9, ratio), abs=1e-4 * force.max() + micrometre)


def bent(ski: Ski, station: FloatArray, normal: FloatArray, turning: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Deflection and twist of both ends as cantilevers, by collocation: EI w⁗ = q, (GJ φ′)′ = -m."""
    deflection, twist = np.zeros_like(station), np.zeros_like(station)
    for sign in (1.0, -1.0):
        part = sign * station > CLAMP / 2.0
        order = np.argsort(sign * station[part])
        x = sign * station[part][order]
        end = abs(float(ski.station[0 if sign > 0.0 else -1]))

        def rates(
            at: npt.NDArray[np.float64],
            y: npt.NDArray[np.float64],
            x: FloatArray = x,
            sign: float = sign,
            normal: FloatArray = normal[part][order],
            turning: FloatArray = turning[part][order],
        ) -> FloatArray:
            section = ski.at(sign * at)
            return np.vstack(
                [
                    y[1],
                    y[2] / section.bending_stiffness,
                    y[3],
                    np.interp(at, x, normal),
                    y[5] / section.torsional_stiffness,
                    -np.interp(at, x, turning),
                ]
            )

        def ends(near: FloatArray, far: FloatArray) -> FloatArray:
            return np.array([near[0], near[1], far[2], far[3], near[4], far[5]])

        # nodes where the load has its kinks; between them it is straight
        mesh = np.concatenate([[CLAMP / 2.0], x, [end]])
        answer = solve_bvp(rates, ends, mesh, np.zeros((6, len(mesh))), tol=1e-3)
        assert answer.success
        deflection[part], twist[part] = answer.sol(sign * station[part])[[0, 4]]
    return deflection, twist


@pytest.mark.parametrize("side_force_bending", [True, False])
def test_bending_and_twist_under_the_returned_loads(side_force_bending: bool) -> None:
    """EI w⁗ = f cos ϑ + τ e sin ϑ; torque by f about the middle, and by τ e at the edge; solved by `solve_bvp`."""
    ski, angle, load = read_ski("slalom"), math.radians(50.0), 700.0
    found = carve(
        ski,
        snow(0.2),
        edge_angle=angle,
        load=load,
        unloading_ratio=1.0,
        side_force_bending=side_force_bending,
        elements=320,
    )
    depth, force, phi = given(found.edge_depth), given(found.force_per_length), given(found.twist)
    bite = np.maximum(depth, 0.0)
    stress = load * math.tan(angle) / float(weights(ski, CLAMP, 320) @ bite)
    shear = stress * bite * float(side_force_bending)
    half = ski.at(found.station).width / 2.0
    # a wedge of pressure: its centre is a third of the waterline from the edge
    lever = half * np.cos(angle + phi) - bite / np.tan(angle + phi) / 3.0
    deflection, twist = bent(
        ski,
        found.station,
        force * math.cos(angle) + shear * math.sin(angle),
        -force * lever - shear * half * np.sin(angle + phi),
    )
    # loads straight between stations instead of constant weights, and at the ends of the contact: 1e-3
    assert deflection == pytest.approx(given(found.bending), abs=1e-3 * float(np.max(given(found.bending))))
    assert twist == pytest.approx(phi, abs=1e-3 * float(np.max(np.abs(phi))))
    assert float(np.max(np.abs(phi))) > math.radians(0.5)


def test_side_force_is_the_balanced_one() -> None:
    found = carve(plain_ski(), snow(0.2), edge_angle=math.radians(30.0), load=600.0, unloading_ratio=1.0)
    assert found.side_force == pytest.approx(600.0 / math.sqrt(3.0), rel=1e-12)
    limit = 0.35e6 * float(weights(plain_ski(), CLAMP) @ np.maximum(given(found.edge_depth), 0.0))
    assert found.side_force_limit == pytest.approx(limit, rel=1e-12)


@pytest.mark.parametrize("moment_balance", ["boot", "free"])
@pytest.mark.parametrize("moment", [0.0, -30.0])
@pytest.mark.parametrize(("angle_deg", "ratio", "groove"), [(45.0, 10.0, "edge"), (60.0, 10.0, "path")])
def test_what_the_boot_holds_about_the_skis_cross_axis(
    angle_deg: float, ratio: float, groove: GrooveForm, moment: float, moment_balance: MomentBalance
) -> None:
    """All of the snow's forces at the edge in the bent ski's places, r × F summed and laid along the cross axis.

    Forward x, y in the snow surface towards the inside, z out of the snow: F = (0, τ e, f) per length. The base's
    normal is (0, sin ϑ, cos ϑ), the cross axis (0, cos ϑ, -sin ϑ), about which a force at the tip turns negatively.
    """
    ski, angle, load = read_ski("giant-slalom"), math.radians(angle_deg), 800.0
    found = carve(
        ski, snow(0.2), edge_angle=angle, load=load, moment=moment, unloading_ratio=ratio, groove=groove,
        moment_balance=moment_balance,
    )  # fmt: skip
    weight, bite = weights(ski, CLAMP), np.maximum(given(found.edge_depth), 0.0)
    stress = load * math.tan(angle) / (weight @ bite)
    place = np.column_stack([found.station, given(found.edge_line), -given(found.edge_depth)])
    force = np.column_stack([np.zeros_like(bite), stress * bite, given(found.force_per_length)])
    cross = np.array([0.0, math.cos(angle), -math.sin(angle)])
    taken = -float(weight @ (np.cross(place, force) @ cross))
    about_horizontal = -float(weight @ np.cross(place, force)[:, 1])
    assert found.boot_pitch_moment == pytest.approx(taken, abs=1e-6)
    balanced = taken if moment_balance == "free" else about_horizontal
    assert balanced == pytest.approx(moment, abs=2e-5)
    assert found.residual_moment == pytest.approx(balanced - moment, abs=1e-9)


def test_how_much_the_boot_holds_and_what_it_moves() -> None:
    """The side force pushes the deeper afterbody up, so the boot presses it down; without that the turn is tighter."""
    ski, shared = read_ski("slalom"), {"edge_angle": math.radians(45.0), "load": 800.0, "unloading_ratio": 10.0}
    by_boot, free = (carve(ski, snow(0.2), **shared, moment_balance=each) for each in ("boot", "free"))  # type: ignore[arg-type]
    given_back = carve(ski, snow(0.2), **shared, moment_balance="free", moment=by_boot.boot_pitch_moment)  # type: ignore[arg-type]
    assert by_boot.boot_pitch_moment is not None and by_boot.boot_pitch_moment < -50.0
    assert free.boot_pitch_moment == pytest.approx(0.0, abs=1e-5)
    assert by_boot.turn_radius_boot is not None and free.turn_radius_boot is not None
    assert 0.975 < free.turn_radius_boot / by_boot.turn_radius_boot < 0.985
    # the groove is kept at places across that follow from the first, elastic state, which is another one
    assert given_back.turn_radius_boot == pytest.approx(by_boot.turn_radius_boot, rel=1e-5)


def test_a_ski_that_is_flat_has_no_side_force_to_balance() -> None:
    found = [
        carve(
            read_ski("slalom"), snow(0.2), edge_angle=0.0, load=800.0, moment=25.0, unloading_ratio=10.0,
            moment_balance=each,
        )
        for each in get_args(MomentBalance)
    ]  # fmt: skip
    assert [each.boot_pitch_moment for each in found] == pytest.approx([25.0, 25.0], abs=1e-6)
    assert given(found[0].edge_depth) == pytest.approx(given(found[1].edge_depth), abs=1e-12)


def test_a_moment_balance_that_is_none() -> None:
    with raises(ParameterError, "unknown_choice", name="moment_balance"):
        carve(
            read_ski("slalom"), snow(0.2), edge_angle=0.5, load=800.0, unloading_ratio=10.0,
            moment_balance="ski",  # type: ignore[arg-type]
        )  # fmt: skip


@pytest.mark.parametrize(
    ("slope", "twist", "told"),
    [
        (0.35, -0.35, []),
        (0.3501, -0.35, ["the ski bends to a slope of 0.35: beyond 0.35 beams"]),
        (0.35, -0.3501, ["the ski twists by 20 degrees"]),
    ],
)
def test_beyond_small_deflections_the_answer_says_so(slope: float, twist: float, told: list[str]) -> None:
    line = SimpleNamespace(greatest_slope=lambda: slope, bend=(np.zeros(2), np.array([0.1, twist])))
    said = _warnings_of_line(cast("Any", line))
    assert [each for each, start in zip(said, told, strict=True) if not each.startswith(start)] == []


@pytest.mark.parametrize("ratio", [1.0, 10.0])
@pytest.mark.parametrize("groove", ["edge", "path"])
def test_each_spread_of_the_side_force_tells_the_others_radius(ratio: float, groove: GrooveForm) -> None:
    """Where the reaction is normal to the base everywhere, the boot holds no pitch moment but what it is given."""
    ski = read_ski("slalom")
    asked: dict[str, Any] = {"edge_angle": math.radians(45.0), "load": 800.0, "unloading_ratio": ratio, "moment": 20.0}
    by_depth = carve(ski, snow(0.2), **asked, groove=groove)
    by_reaction = carve(ski, snow(0.2), **asked, groove=groove, side_force_spread="base-reaction")
    assert by_reaction.turn_radius_boot == pytest.approx(by_depth.turn_radius_boot_other_spread, rel=1e-9)
    assert by_depth.turn_radius_boot == pytest.approx(by_reaction.turn_radius_boot_other_spread, rel=1e-9)
    assert by_reaction.turn_radius_boot != pytest.approx(by_depth.turn_radius_boot, rel=1e-3)
    assert by_reaction.boot_pitch_moment == pytest.approx(20.0 / math.cos(math.radians(45.0)), rel=1e-6)
    assert by_reaction.side_force == by_depth.side_force


def test_a_spread_that_is_none_is_refused() -> None:
    with raises(ParameterError, "unknown_choice", name="side_force_spread"):
        carve(
            read_ski("slalom"),
            snow(0.2),
            edge_angle=0.5,
            load=800.0,
            unloading_ratio=1.0,
            side_force_spread=cast(Any, "even"),
        )


@pytest.mark.parametrize(("name", "angle_deg"), [("slalom", 20.0), ("giant-slalom", 45.0), ("carver", 60.0)])
def test_the_median_radius_is_that_of_many_circles(name: str, angle_deg: float) -> None:
    """Half of the contact has tighter circles through its edge, 0.1 m to either side; by the answer's edge line."""
    found = carve(read_ski(name), snow(0.2), edge_angle=math.radians(angle_deg), load=800.0, unloading_ratio=10.0)
    line, depth, rising = given(found.edge_line)[::-1], given(found.edge_depth), found.station[::-1]
    before = np.flatnonzero(np.diff(np.sign(depth)))
    share = depth[before] / (depth[before] - depth[before + 1])
    front, rear = found.station[before] + share * (found.station[before + 1] - found.station[before])
    x = np.linspace(rear + 0.1, front - 0.1, 4001) + np.array([[0.1], [0.0], [-0.1]])
    y = np.interp(x, rising, line)
    radii = [circle_radius(*zip(a, b, strict=True)) for a, b in zip(x.T.tolist(), y.T.tolist(), strict=True)]
    assert found.turn_radius_median == pytest.approx(np.median(np.array(radii, float)), rel=3e-3)
