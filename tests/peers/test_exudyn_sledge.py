"""The snow in Exudyn: a rigid sledge goes as in MuJoCo and in our own steps."""

import runpy
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("exudyn", reason="Exudyn is not installed: pip install 'skisnow[peers]'")

EXAMPLE = Path(__file__).parents[2] / "examples" / "sledge_in_exudyn.py"
OURS = np.array([6.9494072, -2.6502885, 0.0256285])  # skisnow's steps of 0.05 ms: tests/peers/test_mujoco.py


@pytest.mark.slow
def test_a_rigid_sledge_goes_as_ours() -> None:
    """7.4 m: 2.7 mm at 0.2 ms; the force stands still over a step, which is of first order."""
    glide = runpy.run_path(str(EXAMPLE))["glide"]
    off = {step: float(np.linalg.norm(glide(1.0, step) - OURS)) for step in (4e-4, 2e-4)}
    assert off[2e-4] < 3e-3
    assert off[2e-4] < 0.7 * off[4e-4]
