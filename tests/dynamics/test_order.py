"""The order of the method is seen where the motion is smooth enough for one."""

from __future__ import annotations

import itertools
import math

import numpy as np
import numpy.typing as npt
import pytest

from skisnow import Scenario
from skisnow.dynamics import Ended, StepControl

from .sledges import ahead, given, sledge

FloatArray = npt.NDArray[np.float64]
STEPS = (1e-3, 0.5e-3, 0.25e-3, 0.125e-3)
DURATION = 0.3
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
    assert dynamics.advance(DURATION) is Ended.REACHED
    return np.concatenate([dynamics.position, dynamics.rotation.ravel()])


def orders(scenario: Scenario, velocity: FloatArray) -> list[float]:
    """Observed: by how much less each halving of the step changes the end than the halving before."""
    ends = [end(scenario, velocity, step) for step in STEPS]
    changes = [float(np.abs(fine - coarse).max()) for coarse, fine in itertools.pairwise(ends)]
    return [math.log2(before / after) for before, after in itertools.pairwise(changes)]


@pytest.mark.parametrize("edge_angle", [30.0, 45.0])
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
