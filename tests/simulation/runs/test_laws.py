"""Turns on laws that are not the scenario's own."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from scipy.io import netcdf_file

from skisnow import load_scenario, simulate, verify
from skisnow._support.errors import ParameterError
from skisnow.contact import Laws
from skisnow.forces.friction import ConstantFriction, FrictionLaw, WaterFilmFriction
from skisnow.forces.penetration import HypoplasticPoint, MeanPressurePoint, PointLaw, VolumeWithAnglePoint
from skisnow.forces.shear import AngleShear, ConstantShear, MachiningShear
from skisnow.simulation.run import Run
from skisnow.simulation.run_summary import summary_dict

FloatArray = npt.NDArray[np.float64]
H, S = 0.2e9, 0.5e6


def weaker(_distance: float) -> float:
    """Snow that is weaker than the scenario's by a tenth."""
    return 0.9


def carve(seconds: float, laws: Laws | None = None) -> Run:
    return simulate(load_scenario("carved-46m", changes={"run.duration_s": seconds}), laws=laws)


@dataclass(frozen=True)
class Own(FrictionLaw):
    """The scenario's friction, written here."""

    def _coefficient(self, speed: FloatArray) -> FloatArray:
        return np.full(speed.shape, 0.01)


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
    ends within a fifth of a step's error, which counts for at least 1e-7 m: so places and depths agree within 2e-8 m.
    """
    first = carve(1.0)
    for laws, bound in (
        (Laws(penetration=HypoplasticPoint(H, 10.0)), 2e-8),
        (Laws(friction=Own(), shear=ConstantShear(S)), 1e-9),
    ):
        again = carve(1.0, laws)
        assert np.abs(again.place - first.place).max() < bound
        assert again.steps == first.steps
        for name, energy in first.energies.items():
            assert again.energies[name] == pytest.approx(energy, abs=1e-6)
        assert again.groove.residual_depth == pytest.approx(first.groove.residual_depth, abs=bound)


@pytest.mark.parametrize(
    "laws",
    [
        Laws(
            friction=WaterFilmFriction(lubricated_friction=0.01, dry_friction=0.05, film_speed=3.0, viscous_slope=0.001)
        ),
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
    run, usual = carve(0.5, laws), carve(0.5)
    assert run.outcome == "finished"
    assert not run.has_residual_above(0.02)
    assert 1e-4 < np.linalg.norm(run.place[-1] - usual.place[-1]) < 0.5


@pytest.mark.usefixtures("undrawn")
def test_a_run_names_the_laws_that_it_was_given(tmp_path: Path) -> None:
    """In its repr, in summary.json, in run.nc and in the report; a run of the scenario's own laws names none."""
    turn = load_scenario("carved-46m", changes={"run.duration_s": 0.05})
    run = simulate(turn, laws=Laws(friction=Own(), shear=ConstantShear(S)), strength_along=weaker)
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
    assert moved["solver.tolerance_mm"] is not None
    assert moved["solver.tolerance_mm"] < 1e-3 < np.linalg.norm(run.place[-1] - carve(0.1).place[-1])


def test_a_law_that_gives_no_strength_ends_the_run_with_its_name() -> None:
    """A wild pose of a step that is tried does not (the machining above meets one)."""
    with pytest.raises(ParameterError, match=r"MachiningShear.*strength"):
        carve(0.5, Laws(shear=MachiningShear(1e5, 1.0)))
