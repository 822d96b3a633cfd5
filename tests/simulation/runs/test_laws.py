"""Runs with each law: second pass, side slip, varying strength."""

import json
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from scipy.io import netcdf_file

from skisnow import Run, verify
from skisnow._support.errors import ParameterError, RangeWarning
from skisnow.contact import Laws
from skisnow.forces.friction import ConstantFriction, FrictionLaw, WaterFilmFriction
from skisnow.forces.penetration import HypoplasticPoint, MeanPressurePoint, PointLaw, VolumeWithAnglePoint
from skisnow.forces.shear import AngleShear, ConstantShear, MachiningShear
from skisnow.scenario import Solver, load_scenario
from skisnow.simulation.run_summary import summary_dict
from skisnow.simulation.simulated_run import simulate
from tests.present import present

from ...carving.synthetic import shovel
from .side_slip_apart import side_slip
from .sledges import GRAVITY, load, rigid_ski, scenario, total_mass

FloatArray = npt.NDArray[np.float64]
H, S = 0.2e9, 0.5e6


def weaker(_distance: float) -> float:
    """Snow that is weaker than the scenario's by a tenth."""
    return 0.9


@cache
def carve(seconds: float, laws: Laws | None = None) -> Run:
    return simulate(load_scenario("carved-46m", changes={"run.duration_s": seconds}), laws=laws)


@cache
def usual_carve() -> Run:
    return carve(0.15)


@dataclass(frozen=True)
class Own(FrictionLaw):
    """The scenario's friction, written here."""

    def _coefficient(self, speed: FloatArray) -> FloatArray:
        return np.full(speed.shape, 0.01)


def own() -> Own:
    """This law; 0.01 is below all measured coefficients."""
    with pytest.warns(RangeWarning):
        return Own()


@dataclass(frozen=True)
class Root(PointLaw):
    """p = a √ε with steep unloading: soft snow over a hard crust turned round."""

    def stress(self, depth: npt.ArrayLike, deepest: npt.ArrayLike) -> FloatArray:
        reached = self.deepest_after(depth, deepest)
        return np.asarray(np.maximum(3e7 * np.sqrt(reached) - 5e9 * (reached - np.asarray(depth, float)), 0.0))

    def residual_depth(self, deepest: npt.ArrayLike) -> FloatArray:
        reached = np.asarray(deepest, float)
        return np.asarray(np.maximum(reached - 3e7 * np.sqrt(reached) / 5e9, 0.0))

    def stored_energy(self, depth: npt.ArrayLike, deepest: npt.ArrayLike) -> FloatArray:
        return self.stress(depth, deepest) ** 2 / 1e10

    def lost_energy(self, deepest: npt.ArrayLike) -> FloatArray:
        reached = np.asarray(deepest, float)
        return 2e7 * reached**1.5 - 9e14 * reached / 1e10


def test_the_scenario_s_laws_from_python_give_its_run() -> None:
    """Three points of Gauss are exact for straight pressure, and parts end where it bends: the same forces to rounding.

    For a penetration law Newton's method has the pressure's derivative by differences instead of in closed form. It
    ends within a fifth of a step's error, which counts for at least 1e-7 m: 2e-8 m in each step, of either sign. The
    sum of n such numbers is of the size of their root mean square, √n times that of one. The weight's work differs by
    as much times the weight.
    """
    first = carve(0.1)
    weight = first.scenario.sledge.mass * first.scenario.gravity
    for laws, bound in (
        (Laws(penetration=HypoplasticPoint(H, 10.0)), 2e-8 * first.steps**0.5),
        (Laws(friction=own(), shear=ConstantShear(S)), 1e-9),
    ):
        again = carve(0.1, laws)
        assert np.abs(again.place - first.place).max() < bound
        assert again.steps == first.steps
        for name, energy in first.energies.items():
            assert again.energies[name] == pytest.approx(energy, abs=weight * bound)
        assert again.groove.residual_depth == pytest.approx(first.groove.residual_depth, abs=bound)


@pytest.mark.parametrize(
    "laws",
    [
        Laws(friction=WaterFilmFriction(0.01, 0.05, 3.0, 0.001)),
        Laws(shear=AngleShear(3e5, 0.266)),
        Laws(shear=MachiningShear(1e5, 0.1)),
        pytest.param(Laws(penetration=VolumeWithAnglePoint(H, 10.0)), marks=pytest.mark.slow),
        pytest.param(Laws(penetration=MeanPressurePoint(0.034e9, 0.35e6, 10.0)), marks=pytest.mark.slow),
        Laws(penetration=Root()),
    ],
    ids=str,
)
def test_other_laws_run_in_a_turn(laws: Laws) -> None:
    """To the end, elsewhere than the scenario's laws, and every joule is somewhere."""
    run, usual = carve(0.15, laws), usual_carve()
    assert run.outcome == "finished"
    assert not run.has_residual_above(0.02)
    assert 1e-4 < np.linalg.norm(run.place[-1] - usual.place[-1]) < 0.5


@pytest.mark.usefixtures("undrawn")
def test_a_run_names_the_laws_that_it_was_given(tmp_path: Path) -> None:
    """In its repr, in summary.json, in run.nc and in the report; a run of the scenario's own laws names none."""
    turn = load_scenario("carved-46m", changes={"run.duration_s": 0.05})
    run = simulate(turn, laws=Laws(friction=own(), shear=ConstantShear(S)), strength_along=weaker)
    named = {
        "friction": "Own()",
        "shear": f"ConstantShear(failure_shear_stress={S!r})",
        "penetration": None,
        "strength_along": "weaker",
    }
    assert run.given_laws == summary_dict(run)["laws"] == named
    assert "strength_along weaker" in repr(run)
    assert repr(run).count("\n") < 9
    page = run.report(tmp_path).read_text(encoding="utf-8")
    assert f"<dd>{named['shear']}</dd>" in page
    assert "another strength" in page
    with netcdf_file(tmp_path / "run.nc", "r", mmap=False) as file:
        assert json.loads(file.laws) == named  # type: ignore[attr-defined]
    plain = simulate(turn)
    assert set(summary_dict(plain)["laws"].values()) == {None}
    assert "given in Python" not in repr(plain) + plain.report(tmp_path).read_text(encoding="utf-8")


def test_a_run_is_verified_on_its_own_laws() -> None:
    """On the scenario's friction the end would move by millimetres, and not by what a finer solver changes."""
    high = ConstantFriction(0.1)
    run = carve(0.1, Laws(friction=high))
    moved = {each.key: each.end_moves for each in verify(run)}
    assert present(moved["solver.tolerance_mm"]) < 1e-3 < np.linalg.norm(run.place[-1] - carve(0.1).place[-1])


def test_a_law_that_gives_no_strength_ends_the_run_with_its_name() -> None:
    """A wild pose of a step that is tried does not (the machining above meets one)."""
    with pytest.raises(ParameterError, match=r"MachiningShear.*strength"):
        carve(0.5, Laws(shear=MachiningShear(1e5, 1.0)))


SPEED, ANGLE_DEG = 3.0, 10.0


@cache
def up_and_back(unloading_ratio: float, *, duration: float = 3.2) -> Run:
    """Up the fall line on flat rigid skis, without friction; backwards it meets the lines that it has left."""
    ski = rigid_ski(base_height=shovel(1.2, 0.03, 1.6), running_length=1.2)
    return simulate(
        scenario(
            ski=ski,
            angle_deg=ANGLE_DEG,
            hardness=0.001,
            unloading_ratio=unloading_ratio,
            heading_deg=180.0,
            speed=SPEED,
            duration=duration,
            solver=Solver(tolerance=3e-8),
        )
    )


def test_elastic_snow_gives_back_everything_and_groove_is_paid_for_once() -> None:
    """Up v²/(2 g sin α), and as fast down as up at the same place: snow that springs back has no second pass."""
    run = up_and_back(1.0)
    x = run.place[:, 0]
    assert x.min() == pytest.approx(-(SPEED**2) / (2.0 * GRAVITY * math.sin(math.radians(ANGLE_DEG))), rel=1e-3)
    top = int(np.argmin(x))
    height = math.sin(math.radians(ANGLE_DEG)) * (x - x[top])
    assert run.speed == pytest.approx(np.sqrt(2.0 * GRAVITY * np.maximum(height, 0.0)), rel=2e-3, abs=5e-3)
    assert abs(run.energies["penetration"][-1]) < 1e-3
    # The way back, 1.8 m in the groove of the way up, costs less than a tenth of what that part of it had cost.
    run = up_and_back(10.0)
    x, lost = run.place[:, 0], run.energies["penetration"]
    top = int(np.argmin(x))
    back = x[-1] - x[top]
    assert back > 1.5
    first = lost[top] - np.interp(-x[-1], -x[: top + 1], lost[: top + 1])
    assert first > 2.5
    assert 0.0 <= lost[-1] - lost[top] < 0.1 * first
    assert present(run.energy_balance_error) < 1e-4


def test_it_stands_deeper_in_the_groove_than_in_virgin_snow_and_a_track_counts_once() -> None:
    """The groove was cut by the shovel's load; on the way back it bears the even load without sinking further."""
    run = up_and_back(10.0)
    x = run.place[:, 0]
    top = int(np.argmin(x))
    up = float(np.interp(1.2, -x[: top + 1], run.skis.depth[: top + 1, 0]))
    down = float(np.interp(-1.2, x[top:], run.skis.depth[top:, 0]))
    cut = float(np.median(run.groove.depth))
    assert up < down < cut
    assert down == pytest.approx(cut, rel=0.02)
    # All energy in the snow at the end, piece by piece of every 24 mm, does not exceed what was taken from the motion.
    # On the way up pieces are archived; the way back takes them over and archives them again.
    # Counted twice, the loss would double.
    run, half = up_and_back(10.0), up_and_back(10.0, duration=1.7)
    assert run.energies["penetration"][-1] == pytest.approx(half.energies["penetration"][-1], rel=0.1)


HARDNESS, STRENGTH, LENGTH, STANCE = 0.2, 0.06, 1.6, 0.5
EDGE, SLOPE = math.radians(20.0), math.radians(20.0)


@cache
def slipping(ratio: float, *, duration: float = 1.4) -> Run:
    run = simulate(
        scenario(
            ski=rigid_ski(length=LENGTH),
            hardness=HARDNESS,
            strength=STRENGTH,
            unloading_ratio=ratio,
            angle_deg=math.degrees(SLOPE),
            edge_deg=math.degrees(EDGE),
            heading_deg=90.0,
            stance=STANCE,
            duration=duration,
            solver=Solver(output_interval=0.02),
        )
    )
    assert run.outcome == "finished"
    return run


def acceleration(run: Run, low: float, high: float) -> float:
    """Mean over a part of the way (m/s²)."""
    way = run.place[:, 0]
    within = (way > low) & (way < high)
    return float(2.0 * np.polynomial.polynomial.polyfit(run.time[within], way[within], 2)[2])


def slipping_down(run: Run, depths: float) -> float:
    """g sin α - S_f L (e₁ + e₂)/m."""
    return GRAVITY * math.sin(SLOPE) - STRENGTH * 1e6 * LENGTH * depths / total_mass(run.scenario)


@pytest.mark.parametrize("ratio", [1.0, 10.0])
def test_virgin_snow_until_the_stance(ratio: float) -> None:
    """e = √(2 F tan ϑ/(H_V L)) for each ski, for any k_u; as they bear unequally the sum of depths is 0.3 % less."""
    run = slipping(ratio)
    depth = math.sqrt(load(run.scenario) * math.tan(EDGE) / (HARDNESS * 1e9 * LENGTH))
    assert acceleration(run, 0.05, 0.45) == pytest.approx(slipping_down(run, 2.0 * depth), rel=0.01)
    late = (run.place[:, 0] > 0.2) & (run.place[:, 0] < 0.45)
    assert run.skis.edge_depth[late].mean(axis=(0, 2)).sum() == pytest.approx(2.0 * depth, rel=5e-3)


def test_deeper_in_the_groove_of_the_other() -> None:
    """Where snow keeps its groove the grip grows by a fifth; where it springs back nothing changes.

    The uphill ski falls into the groove at once and swings there: that costs it 4 % over many swings.
    """
    run, elastic = slipping(10.0), slipping(1.0)
    before = (run.place[:, 0] > 0.2) & (run.place[:, 0] < 0.45)
    uphill, downhill = run.skis.edge_depth[before].mean(axis=(0, 2))
    deeper = math.sqrt(uphill**2 + downhill**2 * 0.9)
    assert acceleration(run, 0.6, 1.0) == pytest.approx(slipping_down(run, downhill + deeper), rel=0.05)
    assert acceleration(elastic, 0.6, 1.0) == pytest.approx(slipping_down(run, downhill + uphill), rel=0.01)


@pytest.mark.slow
def test_the_uphill_ski_swings_in_the_groove() -> None:
    """A solution apart that swings, too, agrees within 3 % of the way; depths at rest would hold it back by 7 %."""
    run = slipping(10.0, duration=2.6)
    mass = total_mass(run.scenario)
    ways = side_slip(
        mass=mass,
        roll_inertia=run.scenario.sledge.inertia[0] + 2.0 * run.scenario.ski.mass * (0.5 * STANCE) ** 2,
        slope=SLOPE,
        edge=EDGE,
        hardness=HARDNESS * 1e9,
        strength=STRENGTH * 1e6,
        unloading_ratio=10.0,
        length=LENGTH,
        width=0.065,
        stance=STANCE,
        duration=2.6,
    )
    depth = math.sqrt(load(run.scenario) * math.tan(EDGE) / (HARDNESS * 1e9 * LENGTH))
    virgin, groove = slipping_down(run, 2.0 * depth), slipping_down(run, (1.0 + math.sqrt(1.9)) * depth)
    fast = math.sqrt(2.0 * virgin * STANCE)
    left = 2.6 - fast / virgin
    at_rest = STANCE + fast * left + 0.5 * groove * left**2
    assert run.place[-1, 0] == pytest.approx(2.0 * ways[-1] - ways[-2], rel=0.03)
    assert at_rest < 0.95 * run.place[-1, 0]


WEAKER = 4.0
"""Distance (m) from which the snow is weaker."""


@cache
def of_strength(strength_along: Callable[[float], float] | None = None, seconds: float = 1.2) -> Run:
    changes = {"run.duration_s": seconds, "solver.fixed": True}
    return simulate(load_scenario("carved-46m", changes=changes), strength_along=strength_along)


def test_the_same_strength_everywhere_gives_the_same_bits() -> None:
    short = of_strength(lambda _: 1.0, 0.15)
    assert np.array_equal(of_strength().place[: len(short.time)], short.place)


def test_where_it_gets_weaker_the_edges_slip() -> None:
    """Nothing changes before; behind, the sledge runs wide like on snow that is weak from the beginning."""
    distances: list[float] = []

    def strength(distance: float) -> float:
        distances.append(distance)
        return 0.1 if distance > WEAKER else 1.0

    plain, run = of_strength(), of_strength(strength)
    assert np.all(np.diff(distances) > 0.0)
    steps = np.linalg.norm(np.diff(plain.place, axis=0), axis=1)
    before = np.concatenate([[0.0], np.cumsum(steps)]) <= WEAKER
    assert 20 < before.sum() < len(before) - 20
    assert np.array_equal(run.place[: len(before)][before], plain.place[before])
    ahead = plain.place[-1] - plain.place[-2]
    aside = run.place[-1] - plain.place[-1]
    assert ahead[0] * aside[1] - ahead[1] * aside[0] < -0.05 * np.linalg.norm(ahead)  # the turn goes left
    assert run.energies["shear"][-1] > 1.2 * plain.energies["shear"][-1]  # 56 against 39 J
    assert present(run.energy_balance_error) < 0.005
