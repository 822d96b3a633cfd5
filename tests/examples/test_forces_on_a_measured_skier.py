"""Boots in, forces out, against the run that was captured."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest

from skisnow.interop.opensim import read_motion

ROOT = Path(__file__).parents[2]


@pytest.mark.slow
def test_forces_of_a_capture_are_those_of_the_run_that_was_captured(tmp_path: Path) -> None:
    rows = runpy.run_path(str(ROOT / "examples" / "forces_on_a_measured_skier.py"))["main"](tmp_path)
    (_, mean, rms), *noisy = rows
    assert (abs(mean), rms) < (0.002, 0.005)
    assert [row[2] for row in noisy] == sorted(row[2] for row in noisy)
    page = (ROOT / "docs" / "how-to" / "boots.md").read_text(encoding="utf-8")
    for noise, mean, rms in rows:
        assert f"{noise:19.1f} {100.0 * mean:23.1f} {100.0 * rms:29.1f}\n" in page
    forces = read_motion(tmp_path / "forces.sto").columns
    assert forces["left_ski_force_vy"].max() > 500.0
