"""Steps chosen by the error: tolerance, order of the method, and what must not change their choice."""

import itertools
import math
from functools import cache
from types import SimpleNamespace
from typing import Final

import numpy as np
import numpy.typing as npt
import pytest

from skisnow import Scenario
from skisnow.dynamics import Dynamics, Ended, StepControl

from .sledges import advanced, ahead, fixed, given, sledge

DURATION: Final = 0.3
CASES: Final = {
    "carves": {},
    "skids": {"snow__S_f_N_per_mm2": 0.1},
    "elastic": {"snow__unloading_ratio": 1.0},
    "hard": {"snow__H_V_N_per_mm3": 5.0},
}
CASE = pytest.mark.parametrize("changes", CASES.values(), ids=CASES)


@cache
def run(tolerance: float = StepControl().tolerance, **changes: float) -> Dynamics:
    return advanced(given(**changes), DURATION, StepControl(tolerance=tolerance))


@CASE
def test_half_the_tolerance_and_a_last_bit_of_the_start_speed(changes: dict[str, float]) -> None:
    """All steps together may err by their number times the tolerance; the end moves by less."""
    tolerance = StepControl().tolerance
    one, other = run(**changes), run(tolerance / 2.0, **changes)
    assert 0.0 < np.linalg.norm(one.position - other.position) < one.counts[0] * tolerance
    assert other.counts[0] > one.counts[0]
    # The ladder gives both the same steps, so that nothing is added to the 3.5e-12 m by which one leads.
    one, other = run(**changes), run(start__speed_m_per_s=7.0 * (1.0 + 1e-12), **changes)
    assert one.counts == other.counts
    assert 0.0 < np.linalg.norm(one.position - other.position) < 1e-10


@pytest.mark.parametrize("ended", Ended)
def test_the_core_is_called_again_until_it_has_ended(ended: Ended, monkeypatch: pytest.MonkeyPatch) -> None:
    """It comes back from time to time, so that Ctrl-C is seen. Laws are asked for a reason where it failed."""
    dynamics, asked = sledge(given()), []
    answers = iter([len(Ended), len(Ended), int(ended)])
    monkeypatch.setattr(dynamics, "compiled", SimpleNamespace(advance=lambda *_: next(answers)))
    monkeypatch.setattr(dynamics, "contact", SimpleNamespace(require_finite_laws=lambda: asked.append(ended)))
    assert dynamics.advance(1.0) is ended
    assert asked == ([] if ended is Ended.REACHED else [ended])


def test_twice_the_same_bits() -> None:
    one, other = run(), advanced(given(), DURATION)
    assert one.counts == other.counts
    for name in ("position", "rotation", "velocity"):
        assert np.array_equal(getattr(one, name), getattr(other, name)), name
    assert all(
        np.array_equal(one.part(name), other.part(name)) for name in ("energies", "work", "snow_energies", "beam_dofs")
    )
    assert all(np.array_equal(one.part("along")[k], other.part("along")[k]) for k in range(2))
    assert np.array_equal(one.contact.tracks(), other.contact.tracks())


# The order of the method is seen where the motion is smooth enough for one


FloatArray = npt.NDArray[np.float64]
STEPS = (2e-3, 1e-3, 0.5e-3, 0.25e-3)
SMOOTH = 0.3
EXACT = 1e-5
"""Share of the tolerance to which Newton's method solves a step here: its error must not be seen in 2400 steps."""
BOUNCES = {
    "slope__angle_deg": 0.0,
    "snow__unloading_ratio": 1.0,
    "snow__H_V_N_per_mm3": 0.02,
    "snow__S_f_N_per_mm2": 1e-9,
    "friction__mu_0": 0.0,
    "start__heading_deg": 0.0,
}
ROCKING = np.array([3.0, 0.0, -0.05, 0.02, 0.05, 0.2])


def end(scenario: Scenario, velocity: FloatArray, step: float) -> FloatArray:
    """Place and rotation after the duration."""
    dynamics = sledge(scenario, StepControl(first=step, fixed=True, closeness=EXACT))
    dynamics.find_equilibrium()
    dynamics.begin(velocity)
    assert dynamics.advance(SMOOTH) is Ended.REACHED
    return np.concatenate([dynamics.position, dynamics.rotation.ravel()])


def orders(scenario: Scenario, velocity: FloatArray) -> list[float]:
    """Observed: by how much less each halving of the step changes the end than the halving before."""
    ends = [end(scenario, velocity, step) for step in STEPS]
    changes = [float(np.abs(fine - coarse).max()) for coarse, fine in itertools.pairwise(ends)]
    return [math.log2(before / after) for before, after in itertools.pairwise(changes)]


@pytest.mark.parametrize("edge_angle", [pytest.param(30.0, marks=pytest.mark.slow), 45.0])
def test_elastic_snow(edge_angle: float) -> None:
    """Bouncing, rocking and gliding without grip, which slips and so has kinks."""
    seen = orders(given(**BOUNCES, sledge__edge_angle_deg=edge_angle), ROCKING)
    assert seen == pytest.approx([2.0, 2.0], abs=0.2)


def test_carve() -> None:
    """In snow that remembers, at 15°, an edge that gives way by half a millimetre.

    Where edges slip and dig, as at 45°, or swing in a grip of 0.02 mm at 150 Hz, no order is seen at such steps.
    """
    scenario = given(sledge__edge_angle_deg=15.0, snow__shear_displacement_mm=0.5)
    seen = orders(scenario, ahead(scenario.start.speed))
    assert seen == pytest.approx([2.0, 2.0], abs=0.2)


# What must not matter: which side is left, where the start lies, where a level slope's axes point, the last bit


SKIDS: Final = {"snow__S_f_N_per_mm2": 0.1}
LEVEL: Final = {"slope__angle_deg": 0.0}
MIRROR: Final = np.diag([1.0, -1.0, 1.0])


def stepped(**changes: float) -> Dynamics:
    """Every step half a millisecond: the choice of steps is not what is looked at."""
    return advanced(given(**changes), DURATION, fixed(0.5e-3))


@pytest.mark.parametrize("changes", [{}, SKIDS], ids=["carves", "skids"])
@pytest.mark.parametrize("edge_angle", [30.0, pytest.param(45.0, marks=pytest.mark.slow)])
def test_mirror(changes: dict[str, float], edge_angle: float) -> None:
    """The other edges, heading and side of the slope: left and right change places, twists their sign."""
    one, other = (
        stepped(
            sledge__edge_angle_deg=sign * edge_angle, start__heading_deg=-sign * 30.0, start__y_m=sign * 1.5, **changes
        )
        for sign in (1.0, -1.0)
    )
    assert other.position == pytest.approx(MIRROR @ one.position, abs=1e-9)
    assert other.rotation == pytest.approx(MIRROR @ one.rotation @ MIRROR, abs=1e-9)
    assert other.velocity == pytest.approx(one.velocity * [1.0, -1.0, 1.0, -1.0, 1.0, -1.0], abs=1e-7)
    untwisted = np.where(np.arange(one.part("beam_dofs").shape[1]) % 3 == 2, -1.0, 1.0)
    assert other.part("beam_dofs") == pytest.approx(one.part("beam_dofs")[::-1] * untwisted, abs=1e-9)
    assert abs(one.position[1] - 1.5) > 0.6  # it goes somewhere


def test_straight_down_stays_straight() -> None:
    dynamics = stepped(sledge__edge_angle_deg=0.0, start__heading_deg=0.0, snow__H_V_N_per_mm3=0.03)
    assert abs(dynamics.position[1]) < 1e-12
    assert dynamics.position[0] > 1.9


def test_start_elsewhere() -> None:
    """A plane is the same everywhere."""
    one, other = stepped(), stepped(start__x_m=13.7, start__y_m=-8.2)
    assert other.position == pytest.approx(one.position + np.array([13.7, -8.2, 0.0]), abs=1e-9)
    assert other.rotation == pytest.approx(one.rotation, abs=1e-9)


@pytest.mark.parametrize("changes", [{}, SKIDS], ids=["carves", "skids"])
def test_a_level_slope_knows_no_direction(changes: dict[str, float]) -> None:
    """Turned by 70° at the start, the whole run is turned by 70°."""
    one, other = (stepped(start__heading_deg=heading, **LEVEL, **changes) for heading in (0.0, 70.0))
    c, s = math.cos(math.radians(70.0)), math.sin(math.radians(70.0))
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    assert other.position == pytest.approx(turn @ one.position, abs=1e-9)
    assert other.rotation == pytest.approx(turn @ one.rotation, abs=1e-9)
    assert one.position[1] > 0.1  # it does turn
