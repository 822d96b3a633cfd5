"""Where the energy goes: accounts of one run, stores and losses of the snow."""

import warnings
from dataclasses import replace
from typing import Any, Final

import numpy as np
import numpy.typing as npt
import pytest
from benchmarks.turns import allowed_keys

from skisnow._support.errors import SkisnowError
from skisnow.dynamics import Dynamics, Ended, StepControl
from skisnow.scenario import load_scenario
from skisnow.simulation.run_setup import AT_REST, set_up

from .sledges import ahead, given, sledge, started

FloatArray = npt.NDArray[np.float64]
DURATION: Final = 0.5
SHARE: Final = 2e-4
CASES: Final = {
    "carves": {},
    "skids": {"snow__S_f_N_per_mm2": 0.1},
    "elastic": {"snow__unloading_ratio": 1.0},
    "edged": {"sledge__edge_angle_deg": 45.0},
    "hard": {"snow__H_V_N_per_mm3": 5.0},
}


def accounts(dynamics: Dynamics) -> FloatArray:
    """Kinetic, potential, elastic in the skis, taken by shear and friction, not given by the snow, air, damping (J)."""
    shear, friction, normal, drag, damping, _ = dynamics.part("work")
    return np.array([*dynamics.part("energies"), shear, friction, -normal, drag, damping])


def in_snow(dynamics: Dynamics) -> float:
    """Elastic in the snow, and lost in grooves (J)."""
    return dynamics.part("snow_energies")[0] + dynamics.contact.groove_energy


@pytest.mark.parametrize("changes", CASES.values(), ids=CASES)
def test_the_balance_closes(changes: dict[str, float]) -> None:
    """Against what was turned over between looks 20 ms apart; slip loses what displaced edges do not hold."""
    dynamics = started(given(**changes))
    history = [accounts(dynamics)]
    for time in np.linspace(0.0, DURATION, 26)[1:]:
        assert dynamics.advance(float(time)) is Ended.REACHED
        history.append(accounts(dynamics))
    moved = np.diff(history, axis=0)
    turned_over = 0.5 * float(np.abs(moved).sum())
    assert turned_over > 400.0
    assert abs(moved.sum()) < SHARE * turned_over
    shear, friction, drag, damping = moved.sum(axis=0)[[3, 4, 6, 7]]
    assert shear > dynamics.part("snow_energies")[1]
    assert min(friction, drag, damping) > 0.0


@pytest.mark.parametrize(("hardness", "within"), [(0.03, 3e-4), (0.2, 2e-3)])
def test_what_the_snow_takes_is_in_its_grooves(hardness: float, within: float) -> None:
    """Straight on with a ski whose edges are straight: a flare, and an edge that comes from the side, press the groove
    without a force of their own. A line enters under the tip at once: what that leaves goes down with the spacing.
    Grooves are pressed at the deepest place on the way, work is summed at ends of steps: 1 % apart at 3e-8."""
    scenario = given(sledge__edge_angle_deg=0.0, start__heading_deg=0.0, snow__H_V_N_per_mm3=hardness)
    straight = replace(scenario.ski, width=np.full_like(scenario.ski.width, 0.07))
    dynamics = sledge(replace(scenario, ski=straight), StepControl(tolerance=3e-9), spacing=0.005)
    dynamics.find_equilibrium()
    dynamics.begin(ahead(scenario.start.speed))
    before = in_snow(dynamics)
    assert dynamics.advance(0.5 * DURATION) is Ended.REACHED
    kept = in_snow(dynamics) - before
    assert kept > 0.5
    assert -dynamics.part("work")[2] == pytest.approx(kept, rel=within)


# What the snow stores, what skis lose to it, and what an edge gives back


INTERVAL, SEEDS = 0.02, 2


def moments(changes: dict[str, Any], count: int = 18) -> dict[str, FloatArray]:
    """Works, stores and losses (J) at equal intervals of time, or until the steps end; empty: it cannot stand."""
    rows: list[tuple[float, ...]] = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            setup = set_up(load_scenario("carved-46m", changes=changes))
        except SkisnowError:
            return {}
    dynamics = setup.dynamics
    if not setup.static_residual <= AT_REST:
        return {}
    for n in range(count):
        if n > 0 and dynamics.advance(INTERVAL * n) != 0:
            break
        shear, rubbed, normal, *_ = dynamics.part("work")
        rows.append((shear, rubbed, normal, *dynamics.part("snow_energies"), *dynamics.part("snow_losses")))
    stores = ("pressure", "held", "stuck", "delayed")
    names = ("work", "rubbed", "normal", *stores, "penetration", "shear", "friction", "rate", "owed")
    return dict(zip(names, np.array(rows).T, strict=True))


LOSSES: dict[str, dict[str, Any]] = {
    "carve": {},
    "elastic snow": {"snow.penetration": "elastic"},
    "skid": {"snow.S_f_N_per_mm2": 0.1},
    "delayed": {"snow.delayed_share": 5.0, "snow.retardation_time_ms": 2.0, "snow.S_f_N_per_mm2": 0.01},
    "damped": {"snow.damping_N_s_per_mm3": 0.01},
    "cut": {"shear.law": "machining"},
    "flat": {"sledge.edge_angle_deg": 1.0},
}


@pytest.mark.parametrize("changes", LOSSES.values(), ids=LOSSES)
def test_losses_never_fall_and_add_up(changes: dict[str, Any]) -> None:
    """All work on the snow is stored or lost, but for what it owes and for less than a thousandth of what it stores."""
    found = moments(changes)
    losses = np.array([found[name] for name in ("penetration", "shear", "rate")])
    assert (np.diff(losses) >= 0.0).all()
    assert (np.diff(found["friction"]) >= 0.0).all()
    taken = found["rubbed"] - (found["stuck"] - found["stuck"][0])
    assert found["friction"] == pytest.approx(taken, rel=1e-12, abs=1e-3 * found["stuck"].max())
    stored = found["pressure"] + found["held"] + found["delayed"]
    taken = found["work"] - found["normal"] - (stored - stored[0])
    assert (losses.sum(axis=0) - found["owed"] <= taken + 1e-9).all()
    assert (taken - losses.sum(axis=0) + found["owed"] <= 3e-3 * np.maximum.accumulate(stored) + 1e-9).all()


@pytest.mark.parametrize("law", allowed_keys.LAWS)
def test_shear_gives_back_no_more_than_it_stored(law: str) -> None:
    """With any values of the keys. A push deeper adds to what is stored: ½ S_f e u_y a metre, each time at most."""
    counted = 0
    for seed in range(100):
        found = moments(allowed_keys.changes(seed, law), count=15) if counted < SEEDS else {}
        if not found:
            continue
        counted += 1
        lost = found["work"] - (found["held"] - found["held"][0])
        fall = (np.maximum.accumulate(lost) - lost).max()
        assert fall <= 2.0 * found["held"].max() + 1e-9, seed
    assert counted == SEEDS


@pytest.mark.parametrize("law", allowed_keys.LAWS)
def test_a_tail_that_ploughs_gains_no_energy_from_the_shear(law: str) -> None:
    """Soft skis that bend by 65 mm at a pitch of 14°: the bent edge crosses a line 16 mm before the straight one."""
    found = moments(allowed_keys.changes(72_006, law), count=8)
    assert (-found["work"]).max() <= 0.0
    assert found["held"].max() > 0.0


@pytest.mark.slow
@pytest.mark.parametrize("law", allowed_keys.LAWS)
def test_shear_pushes_no_ski_beyond_what_it_stored(law: str) -> None:
    """In 200 runs with any values of the keys. Skis that plough with their shovels are among them. What a law gives
    does not depend on the steps: where these are too long for an impact, a tenth of the tolerance leaves nothing.
    """
    counted, repeated, seed = 0, 0, 30_000
    while counted < 200:
        changes = allowed_keys.changes(seed, law)
        found = moments(changes, count=12)
        if found and len(found["work"]) > 1:
            if (-found["work"]).max() > found["held"].max() + 1e-9:
                repeated += 1
                found = moments({**changes, "solver.tolerance_mm": 1e-4}, count=12)
                assert len(found["work"]) > 1, seed
            assert (-found["work"]).max() <= found["held"].max() + 1e-9, seed
            counted += 1
        seed += 1
    assert repeated <= 2
