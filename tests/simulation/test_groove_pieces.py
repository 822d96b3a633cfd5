"""The groove that a run leaves, from lines across it: one piece for each, worked out by hand."""

from __future__ import annotations

from functools import partial
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from skisnow.simulation.run_setup import Setup
from skisnow.simulation.simulated_run import _groove

ROWS = np.array([
    # ski, line, x, y, z, depth
    [0, 0, 1.0, 2.0, 0.0, 0.01],
    [0, 0, 1.0, 2.4, 0.0, 0.02],
    [0, 0, 1.0, 2.6, 0.0, 0.015],
    [0, 1, 1.5, 2.0, 0.0, 0.03],
    [1, 1, 3.0, 0.0, 0.0, 0.04],
    [1, 1, 3.3, 0.4, 0.0, 0.005],
])  # fmt: skip


def groove(rows: np.ndarray) -> Any:
    contact = SimpleNamespace(tracks=lambda: rows)
    scenario = SimpleNamespace(contact=SimpleNamespace(unloading_ratio=5.0))
    setup = cast(
        "Any",
        SimpleNamespace(
            dynamics=SimpleNamespace(contact=contact), scenario=scenario, snow=SimpleNamespace(penetration=None)
        ),
    )
    setup.residual_depth = partial(Setup.residual_depth, setup)
    return _groove(setup)


def test_each_line_is_a_piece_as_deep_as_its_deepest_knot() -> None:
    """Of one knot alone there is no width; four fifths of the depth stay where the snow unloads five times as hard."""
    found = groove(ROWS)
    assert found.middle == pytest.approx(np.array([[1.0, 2.3, 0.0], [3.15, 0.2, 0.0]]))
    assert found.left == pytest.approx(np.array([[0.0, 1.0, 0.0], [0.6, 0.8, 0.0]]))
    assert found.width == pytest.approx([0.6, 0.5])
    assert found.depth == pytest.approx([0.02, 0.04])
    assert found.residual_depth == pytest.approx([0.016, 0.032])


def test_without_contact_there_is_none() -> None:
    found = groove(np.zeros((0, 6)))
    assert found.middle.shape == found.left.shape == (0, 3)
    assert len(found.width) == len(found.depth) == len(found.residual_depth) == 0
