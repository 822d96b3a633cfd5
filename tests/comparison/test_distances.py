"""Means of lengths of vectors that change linearly, against integrals done by quadrature and by hand."""

import math

import numpy as np
import numpy.typing as npt
import pytest
from scipy.integrate import quad

from skisnow.comparison.distances import OffsetSeries, distance_statistics, mean_lengths

FloatArray = npt.NDArray[np.float64]


def test_mean_length_against_quadrature() -> None:
    """From nearly constant vectors to ones that pass through nothing; both formulas and the seam between them."""
    random = np.random.default_rng(3)
    first = random.normal(size=(60, 3))
    change = random.normal(size=(60, 3)) * np.repeat([1e-12, 1e-3, 0.049, 0.051, 1.0, 50.0], 10)[:, None]
    found = mean_lengths(first, first + change)
    for begin, step, value in zip(first, change, found, strict=True):
        low = float(np.clip(-(begin @ step) / (step @ step), 0.0, 1.0))

        def length(share: float, begin: FloatArray = begin, step: FloatArray = step) -> float:
            return float(np.linalg.norm(begin + share * step))

        expected, _ = quad(length, 0.0, 1.0, points=[low], epsabs=0.0, epsrel=1e-12)
        assert value == pytest.approx(expected, rel=1e-11)


def test_numbers_of_a_straight_line_that_leaves_another() -> None:
    """d = s tan α: mean L tan α / 2, rms L tan α / √3, largest at the end; the standstill at 2 m weighs nothing."""
    arc_length = np.array([0.0, 2.0, 2.0, 7.0, 10.0])
    found = distance_statistics(OffsetSeries(arc_length, np.column_stack([0.0 * arc_length, 0.1 * arc_length])))
    assert found is not None
    assert (found.max, found.max_at, found.mean, found.compared) == pytest.approx((1.0, 10.0, 0.5, 10.0))
    assert found.rms == pytest.approx(1.0 / math.sqrt(3.0), rel=1e-14)


def test_what_has_no_offset_is_left_out() -> None:
    offset = np.array([[1.0, 0.0], [1.0, 0.0], [np.nan, np.nan], [3.0, 0.0], [3.0, 0.0]])
    found = distance_statistics(OffsetSeries(np.array([0.0, 1.0, 5.0, 6.0, 9.0]), offset))
    assert found is not None
    assert (found.compared, found.mean) == pytest.approx((4.0, (1.0 + 3.0 * 3.0) / 4.0))
    assert distance_statistics(OffsetSeries(np.array([0.0, 1.0]), np.full((2, 2), np.nan))) is None
    assert distance_statistics(OffsetSeries(np.array([1.0, 1.0]), np.ones((2, 2)))) is None
