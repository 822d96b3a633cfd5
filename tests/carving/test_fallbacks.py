"""What becomes of a question whose equilibrium the core does not find."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.carving import equilibrium
from skisnow.carving.equilibrium import _conditions, carve
from skisnow.carving.laws import equivalent_snow
from skisnow.carving.result import SINKING_DEPTH, _depth_ratio, equilibrium_of
from skisnow.carving.solve import Conditions, Solution, solved
from skisnow.forces.penetration import HypoplasticPoint
from skisnow.ski import read_ski
from skisnow.ski.beam import clamped
from tests.coded import raises

from .laws import Power
from .synthetic import plain_ski, rigid_ski, snow

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
        (400.0, 250.0, [400.0, 300.0, 200.0, 200.0]),  # the last: with the side force spread otherwise
        (math.inf, 501.0, [1000.0, 500.0, 500.0]),
        (300.0, 250.0, [300.0, 200.0, 200.0]),
        (150.0, 250.0, [150.0, 150.0]),
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
        conditions = _conditions(ski, snow(1e-3), angle, bears * factor, 0.0, 1.0, False, False)
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
    with pytest.raises(ParameterError, match=rf"puts the resultant {moment / 800.0:.2f} m ahead of the boot: off the"):
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


def test_a_laws_search_begins_at_its_own_hardness() -> None:
    """Linear snow: the same H_V and k_u under any straight edge, and never steeper than 1000."""
    ski = plain_ski()
    for angle in (0.0, 0.5, 1.2):
        for ratio in (1.0, 10.0):
            hardness, found = equivalent_snow(HypoplasticPoint(HARDNESS, ratio), ski, angle, 800.0)
            assert (hardness, found) == pytest.approx((HARDNESS, ratio), rel=1e-6)
        assert equivalent_snow(HypoplasticPoint(HARDNESS, 1e5), ski, angle, 800.0)[1] == 1000.0


def test_a_search_begins_where_a_straight_edge_bears_the_load() -> None:
    """p = a ε² under an edge at 45°: F = a e³ L/3 over 0.9 of the running length; linear snow bears as much at e.

    Depths are tried that are 2.34 % apart; the first that bears is taken. Unloading is four times the chord.
    """
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
