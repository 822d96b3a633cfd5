"""Steps chosen by the error: what their tolerance promises, and what must not change their choice."""

from __future__ import annotations

from typing import Final

import numpy as np
import pytest

from skisnow.dynamics import Dynamics, StepControl

from .sledges import advanced, given

DURATION: Final = 0.5
CASES: Final = {
    "carves": {},
    "skids": {"snow__S_f_N_per_mm2": 0.1},
    "elastic": {"snow__unloading_ratio": 1.0},
    "hard": {"snow__H_V_N_per_mm3": 5.0},
}
CASE = pytest.mark.parametrize("changes", CASES.values(), ids=CASES)


def run(tolerance: float | None = None, **changes: float) -> Dynamics:
    control = StepControl() if tolerance is None else StepControl(tolerance=tolerance)
    return advanced(given(**changes), DURATION, control)


@CASE
def test_half_the_tolerance(changes: dict[str, float]) -> None:
    """All steps together may err by their number times the tolerance; the end moves by less."""
    tolerance = StepControl().tolerance
    one, other = run(tolerance, **changes), run(tolerance / 2.0, **changes)
    assert 0.0 < np.linalg.norm(one.position - other.position) < one.counts[0] * tolerance
    assert other.counts[0] > one.counts[0]


@CASE
def test_a_last_bit_of_the_start_speed(changes: dict[str, float]) -> None:
    """The ladder gives both the same steps, so that nothing is added to the 3.5e-12 m by which one leads."""
    one, other = (run(start__speed_m_per_s=7.0 * (1.0 + each), **changes) for each in (0.0, 1e-12))
    assert one.counts == other.counts
    assert 0.0 < np.linalg.norm(one.position - other.position) < 1e-10


def test_twice_the_same_bits() -> None:
    one, other = run(), run()
    assert one.counts == other.counts
    for name in ("position", "rotation", "velocity", "beam_dofs"):
        assert np.array_equal(getattr(one, name), getattr(other, name)), name
    assert (one.energies, one.work, one.snow_energies) == (other.energies, other.work, other.snow_energies)
    assert all(np.array_equal(one.along(k), other.along(k)) for k in range(2))
    assert np.array_equal(one.contact.tracks(), other.contact.tracks())
