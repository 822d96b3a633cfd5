"""Remarks on a fit: neighbouring residuals that are alike."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from skisnow.identification.solution import _neighbour_correlation


def solution(residuals: Any, *series: tuple[str, int]) -> Any:
    observations = [SimpleNamespace(kind=kind, series=(length,)) for kind, length in series]
    return SimpleNamespace(
        problem=SimpleNamespace(observations=observations), optimum=SimpleNamespace(residuals=np.asarray(residuals))
    )


def test_neighbours_that_are_the_same_have_a_correlation_of_one() -> None:
    """Ten pairs at least; marks have no neighbours, and their residuals are passed over."""
    assert _neighbour_correlation(solution(np.ones(11), ("track", 11))) == pytest.approx(1.0)
    assert _neighbour_correlation(solution(np.ones(10), ("track", 10))) is None
    assert _neighbour_correlation(solution(np.tile([1.0, -1.0], 10), ("track", 20))) is None
    assert _neighbour_correlation(solution(np.zeros(20), ("track", 20))) is None
    mixed = np.concatenate([np.tile([1.0, -1.0], 10), np.full(11, 2.0)])
    assert _neighbour_correlation(solution(mixed, ("marks", 20), ("photo_cells", 11))) == pytest.approx(1.0)
    assert _neighbour_correlation(solution(np.ones(20), ("marks", 20))) is None


def test_two_series_have_no_pair_between_them() -> None:
    """Nine pairs of 1 and nine of 2: (9 + 36)/(10 · 0.9 + 40 · 0.9) = 1; one of 1 and the other of -1 as well."""
    residuals = np.concatenate([np.ones(10), np.full(10, -2.0)])
    assert _neighbour_correlation(solution(residuals, ("track", 10), ("track", 10))) == pytest.approx(1.0)
