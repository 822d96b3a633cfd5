"""What becomes of a question whose equilibrium the core does not find."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.carving import equilibrium
from skisnow.carving.equilibrium import _conditions, carve, rest
from skisnow.carving.laws import equivalent_snow
from skisnow.carving.result import SINKING_DEPTH, Equilibrium, _depth_ratio, equilibrium_of
from skisnow.carving.solve import Conditions, Solution, solved
from skisnow.forces.penetration import HypoplasticPoint
from skisnow.ski import read_ski
from skisnow.ski.beam import clamped
from tests.coded import raises

from .laws import Power
from .synthetic import boot_pose, plain_ski, rigid_ski, snow

HARDNESS = 0.2e9


def ends_below(monkeypatch: pytest.MonkeyPatch, greatest: float) -> list[float]:
    """No end above this unloading ratio; the ratios that were tried."""
    tried: list[float] = []

    def found(model: Any, conditions: Conditions, **more: Any) -> Solution:
        tried.append(conditions.excess / HARDNESS + 1.0)
        solution = solved(model, conditions, **more)
        return solution if tried[-1] < greatest else replace(solution, converged=False)

    monkeypatch.setattr(equilibrium, "solved", found)
    return tried


def asked(ratio: float) -> Any:
    return carve(
        read_ski("slalom"), snow(0.2), edge_angle=math.radians(45.0), load=800.0, unloading_ratio=ratio, elements=40
    )


@pytest.mark.parametrize(
    ("ratio", "greatest", "tried"),
    [
        (400.0, 250.0, [400.0, 300.0, 200.0]),
        (math.inf, 501.0, [1000.0, 500.0]),
        (300.0, 250.0, [300.0, 200.0]),
        (150.0, 250.0, [150.0]),
    ],
)
def test_steeper_unloading_without_an_end_falls_back_on_the_next_gentler(
    monkeypatch: pytest.MonkeyPatch, ratio: float, greatest: float, tried: list[float]
) -> None:
    known = asked(tried[-1])
    assert ends_below(monkeypatch, greatest) == []
    seen = ends_below(monkeypatch, greatest)
    found = asked(ratio)
    assert seen == pytest.approx(tried, rel=1e-12)
    assert np.array_equal(np.asarray(found.edge_depth), np.asarray(known.edge_depth))
    fell_back = tried[-1] < min(ratio, 1000.0)
    told = f"computed with k_u/H_V = {tried[-1]:g}: the steeper unloading that was asked did not converge"
    assert found.warnings == ((told,) if fell_back else ())


def test_where_none_has_an_end_there_is_no_equilibrium(monkeypatch: pytest.MonkeyPatch) -> None:
    seen = ends_below(monkeypatch, 0.0)
    found = asked(1000.0)
    assert seen == pytest.approx([1000.0, 500.0, 300.0, 200.0], rel=1e-12)
    assert (found.outcome, found.holds, found.turn_radius_boot, found.residual_force) == (
        "not_converged", None, None, None,
    )  # fmt: skip
    assert (
        found.remedy == "no equilibrium was found: try a smaller unloading ratio, more elements or a lower edge angle"
    )


@pytest.mark.parametrize("angle_deg", [0.0, 60.0])
def test_a_load_beyond_the_whole_base_at_the_sinking_depth_sinks_though_nothing_was_found(angle_deg: float) -> None:
    """H_V times 0.3 m of depth times the base as it is seen from above."""
    ski, angle = plain_ski(), math.radians(angle_deg)
    model = clamped(ski, 0.3, 20)
    bears = 1e6 * SINKING_DEPTH * 1.6 * 0.065 * math.cos(angle)
    for factor, outcome in ((0.999, "not_converged"), (1.001, "sinks")):
        conditions = _conditions(
            ski, snow(1e-3), angle, bears * factor, 0.0, 1.0, side_force_bending=False, twist=False
        )
        none = np.zeros(len(model.stations.station))
        solution = Solution(False, 7, np.zeros(model.size), 0.0, 0.0, 0.0, none, none)
        found = equilibrium_of(model, conditions, snow(1e-3), solution)
        assert (found.outcome, found.iterations) == (outcome, 7)


def test_a_path_that_is_not_found_in_time_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(equilibrium, "_MOST_PATHS", 1)
    found = carve(
        read_ski("slalom"), snow(0.2), edge_angle=math.radians(45.0), load=800.0, elements=40, unloading_ratio=10.0,
        groove="path",
    )  # fmt: skip
    assert (found.outcome, found.edge_depth) == ("not_converged", None)


@pytest.mark.parametrize("moment", [-640.0, 640.0, 650.0])
def test_a_moment_that_no_snow_balances_is_refused(moment: float) -> None:
    """Of 800 N, 0.8 m from the boot in the middle of a ski of 1.6 m."""
    ends: dict[str, Any] = {"moment": moment, "load": 800.0, "ahead": moment / 800.0, "tail": -0.8, "tip": 0.8}
    with raises(ParameterError, "out_of_range", **ends):
        carve(plain_ski(), snow(0.2), edge_angle=0.5, load=800.0, moment=moment, unloading_ratio=1.0)


def test_what_is_no_ski_and_no_snow_is_refused() -> None:
    plain: Any = {"edge_angle": 0.5, "load": 800.0, "unloading_ratio": 1.0}
    with raises(ParameterError, "wrong_kind", ski="slalom"):
        carve("slalom", snow(0.2), **plain)  # type: ignore[arg-type]
    with raises(ParameterError, "wrong_kind", snow=0.2):
        carve(read_ski("slalom"), 0.2, **plain)  # type: ignore[arg-type]


def test_the_last_edge_angle_is_85_degrees() -> None:
    plain: Any = {"load": 100.0, "unloading_ratio": 1.0, "elements": 20}
    assert carve(rigid_ski(), snow(0.2), edge_angle=math.radians(85.0), **plain).edge_depth is not None
    with raises(ParameterError, "out_of_range"):
        carve(rigid_ski(), snow(0.2), edge_angle=math.radians(85.001), **plain)


def test_the_loads_before_and_behind_the_boot_are_sums_over_the_stations() -> None:
    """With half of what stands under the boot on either side."""
    found = carve(
        read_ski("slalom"), snow(0.2), edge_angle=0.6, load=800.0, moment=30.0, unloading_ratio=10.0, elements=40
    )
    weight = clamped(read_ski("slalom"), 0.3, 40).stations.weight
    force, front = np.asarray(found.force_per_length), found.station > 0.0
    assert found.forebody_load == pytest.approx(float(weight[front] @ force[front]), rel=1e-12)
    assert found.afterbody_load == pytest.approx(float(weight[~front] @ force[~front]), rel=1e-12)
    assert found.bearing_length == pytest.approx(float(weight[force > 0.0].sum()), rel=1e-12)


def test_a_laws_search_begins_at_its_own_hardness_and_a_search_begins_where_a_straight_edge_bears_the_load() -> None:
    """Linear snow: the same H_V and k_u under any straight edge, and never steeper than 1000."""
    ski = plain_ski()
    for angle in (0.0, 0.5, 1.2):
        for ratio in (1.0, 10.0):
            hardness, found = equivalent_snow(HypoplasticPoint(HARDNESS, ratio), ski, angle, 800.0)
            assert (hardness, found) == pytest.approx((HARDNESS, ratio), rel=1e-6)
        assert equivalent_snow(HypoplasticPoint(HARDNESS, 1e5), ski, angle, 800.0)[1] == 1000.0
    # p = a ε² under an edge at 45°: F = a e³ L/3 over 0.9 of the running length; linear snow bears as much at e.
    # Depths are tried that are 2.34 % apart; the first that bears is taken. Unloading is four times the chord.
    law, ski = Power(4e10, 2.0, unloading_ratio=4.0), plain_ski()
    depth = (3.0 * 800.0 / (4e10 * 0.9 * 1.6)) ** (1.0 / 3.0)
    hardness, ratio = equivalent_snow(law, ski, math.radians(45.0), 800.0)
    assert depth * 1.024 >= hardness / (2.0 / 3.0 * 4e10) >= depth
    assert ratio == pytest.approx(4.0 * 1.5)  # the chord of p at e is a e, and linear snow has 2/3 of it


def test_a_search_begins_on_a_base_no_wider_than_the_ski() -> None:
    """p = a ε² at 60° and 16 cm: the wedge would reach 9 cm, the base half its width, r.

    F = a (e³ - (e - r tan ϑ)³) L/(3 tan ϑ), the volume (e² - (e - r tan ϑ)²) L/(2 tan ϑ).
    """
    law, ski = Power(4e8, 2.0, unloading_ratio=4.0), plain_ski()
    angle, deep = math.radians(60.0), 0.16
    falls = 0.5 * float(ski.at(0.0).width) * math.tan(angle)
    assert falls < deep

    def force(depth: float) -> float:
        return 4e8 * (depth**3 - (depth - falls) ** 3) * 0.9 * 1.6 / (3.0 * math.tan(angle))

    def hardness(depth: float) -> float:
        volume = (depth**2 - (depth - falls) ** 2) * 0.9 * 1.6 / (2.0 * math.tan(angle))
        return force(depth) / volume

    assert hardness(deep * 1.024) >= equivalent_snow(law, ski, angle, force(deep))[0] >= hardness(deep)


def test_the_boots_own_station_is_neither_before_nor_behind() -> None:
    """Twice as deep behind as before, whatever stands at 0; a ski on one side alone has no ratio."""
    station, weight = np.array([0.4, 0.2, 0.0, -0.2, -0.4]), np.array([0.1, 0.3, 0.2, 0.3, 0.1])
    depth = np.array([0.001, 0.001, 0.05, 0.002, -0.01])
    assert _depth_ratio(station, weight, depth) == pytest.approx(2.0)
    assert _depth_ratio(station, weight, np.array([0.001, 0.001, 0.05, -0.002, 0.0])) is None
    assert _depth_ratio(station, weight, np.array([0.0, -0.001, 0.05, 0.002, 0.0])) is None


LENGTH, WIDTH = 1.6, 0.065
EXACT = (
    5e-8  # Newton's method leaves 1e-8 N of force and 1e-8 N m of moment per N of load: 1e-8 (1 + 6 m/l) at the ends
)


@pytest.mark.parametrize("hardness", [0.02, 0.2, 2.0, 90.0])
@pytest.mark.parametrize("clamp", [0.0, 0.3])
def test_flat(hardness: float, clamp: float) -> None:
    """F/(H_V · area)."""
    found = rest(rigid_ski(), snow(hardness), edge_angle=0.0, load=800.0, clamp_length=clamp)
    expected = 800.0 / (hardness * 1e9 * LENGTH * WIDTH)
    assert found.outcome == "equilibrium"
    assert found.edge_depth == pytest.approx(np.full(320, expected), rel=EXACT)
    assert found.force_per_length == pytest.approx(np.full(320, 800.0 / LENGTH), rel=EXACT)
    assert found.turn_radius_boot is None
    assert (found.side_force, found.holds) == (0.0, True)


@pytest.mark.parametrize("moment", [-60.0, 20.0])
def test_flat_with_a_moment(moment: float) -> None:
    """ε = F/(H_V w l) + 12 M s/(H_V w l³): a moment that presses the tip down deepens it."""
    found = rest(rigid_ski(), snow(0.2), edge_angle=0.0, load=800.0, moment=moment)
    stiffness = 0.2e9 * WIDTH
    expected = 800.0 / (stiffness * LENGTH) + 12.0 * moment / (stiffness * LENGTH**3) * found.station
    assert found.edge_depth == pytest.approx(expected, rel=EXACT)


def test_flat_lifting_off() -> None:
    """M > F l/6: a triangle of pressure whose centre is under the load; length 3 (l/2 - M/F), depth 2F/(k length)."""
    load, moment = 800.0, 320.0  # 0.4 m before the boot
    found = rest(rigid_ski(), snow(0.2), edge_angle=0.0, load=load, moment=moment, elements=320)
    bearing = 3.0 * (LENGTH / 2.0 - moment / load)
    deepest = 2.0 * load / (0.2e9 * WIDTH * bearing)
    depth, slope = boot_pose(found, rigid_ski(), 0.0)
    # two points per element do not see where within an element the pressure ends: (h/l)² ~ 1e-5
    assert depth + slope * LENGTH / 2.0 == pytest.approx(deepest, rel=5e-5)
    assert found.contact_length == pytest.approx(bearing, abs=LENGTH / 320)
    assert found.outcome == "equilibrium"
    forward = rest(rigid_ski(), snow(0.2), edge_angle=0.0, load=load, moment=-moment, elements=320)
    assert forward.edge_depth is not None
    assert found.edge_depth == pytest.approx(forward.edge_depth[::-1], rel=1e-6, abs=1e-12)


def test_a_load_far_ahead_misses_the_boot() -> None:
    """M/F = 0.6 m: the triangle of 3 (0.8 - 0.6) m ends 0.2 m before the boot."""
    found = rest(rigid_ski(), snow(0.2), edge_angle=0.0, load=800.0, moment=480.0)
    assert found.outcome == "bridges"
    assert found.turn_radius_chord is None
    assert found.contact_length == pytest.approx(0.6, abs=0.01)  # an element


@pytest.mark.parametrize("angle_deg", [1.0, 5.0, 15.0, 30.0, 45.0, 60.0, 80.0])
@pytest.mark.parametrize("ratio", [1.0, 10.0, math.inf])
def test_wedge(angle_deg: float, ratio: float) -> None:
    """e = √(2 F tan ϑ/(H_V L)); an even groove under an even edge is not felt, whatever it remembers."""
    angle = math.radians(angle_deg)
    found = carve(rigid_ski(), snow(0.2), edge_angle=angle, load=800.0, unloading_ratio=ratio)
    expected = math.sqrt(2.0 * 800.0 * math.tan(angle) / (0.2e9 * LENGTH))
    assert expected < WIDTH * math.sin(angle)
    # with memory an edge that tilts by rounding already carries on its deeper end: e to 1e-6, its tilt no better
    assert found.edge_depth == pytest.approx(np.full(320, expected), rel=EXACT if ratio == 1.0 else 1e-6)


@pytest.mark.parametrize(("angle_deg", "load"), [(0.5, 800.0), (1.0, 3000.0), (2.0, 9000.0)])
def test_beyond_the_wedge(angle_deg: float, load: float) -> None:
    """e > W sin ϑ: F = H_V L W cos ϑ (e - W sin ϑ/2)."""
    angle = math.radians(angle_deg)
    found = rest(rigid_ski(), snow(0.02), edge_angle=angle, load=load)
    expected = load / (0.02e9 * LENGTH * WIDTH * math.cos(angle)) + WIDTH * math.sin(angle) / 2.0
    assert expected > WIDTH * math.sin(angle)
    assert found.edge_depth == pytest.approx(np.full(320, expected), rel=EXACT)


def test_wedge_and_trapezoid_meet() -> None:
    """At e = W sin ϑ both give F = H_V L W² sin ϑ cos ϑ/2; a millionth more or less of it moves e by as little."""
    angle = math.radians(2.0)
    load = 0.02e9 * LENGTH * WIDTH**2 * math.sin(angle) * math.cos(angle) / 2.0
    for factor in (1.0 - 1e-6, 1.0, 1.0 + 1e-6):
        found = rest(rigid_ski(), snow(0.02), edge_angle=angle, load=load * factor)
        assert found.edge_depth == pytest.approx(np.full(320, WIDTH * math.sin(angle)), rel=2e-6)


@pytest.mark.parametrize("slope", [-1.0e-3, 0.5e-3])
def test_tilted_wedge(slope: float) -> None:
    """e = a + b s: F = H_V/(2 tan ϑ) (a² l + b² l³/12), M = H_V/(2 tan ϑ) a b l³/6."""
    angle, depth = math.radians(40.0), 3e-3
    factor = 0.2e9 / (2.0 * math.tan(angle))
    load = factor * (depth**2 * LENGTH + slope**2 * LENGTH**3 / 12.0)
    moment = factor * depth * slope * LENGTH**3 / 6.0
    found = rest(rigid_ski(), snow(0.2), edge_angle=angle, load=load, moment=moment)
    assert found.edge_depth == pytest.approx(depth + slope * found.station, rel=1e-7)


def grip(load: float) -> Equilibrium:
    return carve(rigid_ski(), snow(0.2, 0.3), edge_angle=math.radians(50.0), load=load, unloading_ratio=1.0)


def test_grip_ends_at_a_depth() -> None:
    """Demand H_V e² L/2 = F tan ϑ against S_f e L: holds up to e = 2 S_f/H_V, the side force there is 2 S_f² L/H_V."""
    greatest = 2.0 * (0.3e6) ** 2 * LENGTH / 0.2e9
    load = greatest / math.tan(math.radians(50.0))
    below, above = grip(load * (1.0 - 1e-6)), grip(load * (1.0 + 1e-6))
    assert (below.outcome, below.holds) == ("equilibrium", True)
    assert (above.outcome, above.holds) == ("slips", False)
    assert above.side_force == pytest.approx(greatest, rel=2e-6)
    assert above.side_force_limit == pytest.approx(greatest, rel=2e-6)
    assert above.edge_depth == pytest.approx(np.full(320, 2.0 * 0.3 / 0.2 * 1e-3), rel=2e-6)
