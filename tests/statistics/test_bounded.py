"""Least squares with bounds."""

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import nnls
from tests.coded import raises

from skisnow._support.arrays import FloatArray
from skisnow._support.errors import ParameterError
from skisnow.statistics import non_negative_fits
from skisnow.statistics.bounded import condensed


def problem(seed: int, n: int, p: int, low: float) -> tuple[FloatArray, FloatArray]:
    """Columns of sizes like A and V in mm² and mm³; coefficients from ``low`` to 1, so that some bounds hold."""
    rng = np.random.default_rng(seed)
    A = rng.uniform(0, 1, size=(n, p)) * 10.0 ** rng.uniform(-2, 4, size=p)
    return A, A @ (rng.uniform(low, 1, size=p) / np.linalg.norm(A, axis=0)) + 0.05 * rng.normal(size=n)


class BoundedFit:
    """A fit with coefficients ≥ 0: one problem, condensed and solved."""

    def __init__(self, design: npt.ArrayLike, response: npt.ArrayLike, weights: npt.ArrayLike | None = None) -> None:
        A, y = np.asarray(design, float), np.asarray(response, float)
        self.coefficients, self.rank = condensed(A, y, weights=weights).solved()
        residuals = y - A.reshape(len(y), -1) @ self.coefficients
        self.sse = float(np.sum(np.asarray(1.0 if weights is None else weights) * residuals**2))
        self.at_bound = self.coefficients == 0.0


def test_projected_columns_may_be_in_any_unit() -> None:
    A, y = problem(1, 30, 3, 0.8)
    units = np.array([1e-12, 1.0, 1e12])
    plain, other = condensed(A, y).solved(), condensed(A, y).solved(np.diag(units))
    assert (plain.rank, other.rank) == (3, 3)
    np.testing.assert_allclose(other.coefficients * units, plain.coefficients, rtol=1e-9)


@pytest.mark.parametrize("p", [1, 2, 3, 4, 6])
@pytest.mark.parametrize("low", [0.8, -1.0, -10.0])
def test_agrees_with_scipy(p: int, low: float) -> None:
    held = 0
    for seed in range(20):
        A, y = problem(seed, 30, p, low)
        unit = np.linalg.norm(A, axis=0)
        expected, norm = nnls(A / unit, y)  # scaled, or scipy's own tolerance would decide
        fit = BoundedFit(A, y)
        np.testing.assert_allclose(fit.coefficients * unit, expected, atol=1e-11)
        np.testing.assert_allclose(fit.sse, norm**2, rtol=1e-11)
        assert fit.rank == p
        held += int(fit.at_bound.sum())
    assert held > 0 if low < 0 else held < 20 * p


@pytest.mark.parametrize("p", [1, 2, 3, 4])
@pytest.mark.parametrize("low", [0.8, -1.0, -10.0])
def test_a_batch_agrees_with_its_members(p: int, low: float) -> None:
    problems = [problem(seed, 25, p, low) for seed in range(60)]
    gram, moment = np.stack([A.T @ A for A, _ in problems]), np.stack([A.T @ y for A, y in problems])
    found = non_negative_fits(gram, moment)
    for (A, y), beta in zip(problems, found, strict=True):
        fit = BoundedFit(A, y)
        unit = np.linalg.norm(A, axis=0)
        # normal equations: condition numbers up to 10³ are squared and meet a rounding of 10^-16
        np.testing.assert_allclose(beta * unit, fit.coefficients * unit, atol=1e-9)
        np.testing.assert_array_equal(beta == 0, fit.at_bound)


entry = st.integers(min_value=-4, max_value=4).map(float)


@st.composite
def small_problems(draw: st.DrawFn) -> tuple[FloatArray, FloatArray]:
    """Few small whole numbers: dependent, repeated and zero columns are frequent."""
    p, n = draw(st.integers(1, 4)), draw(st.integers(1, 6))
    cells = draw(st.lists(entry, min_size=n * p, max_size=n * p))
    return np.array(cells).reshape(n, p), np.array(draw(st.lists(entry, min_size=n, max_size=n)))


def assert_conditions(A: FloatArray, y: FloatArray, beta: FloatArray) -> None:
    """Karush-Kuhn-Tucker: feasible; no slope where free; where held, none that leads into the feasible side."""
    slope = A.T @ (y - A @ beta)
    tolerance = 1e-9  # entries are at most 4, rows 6: some 10^6 roundings of the largest product
    assert np.all(beta >= 0)
    assert np.all(slope <= tolerance)
    assert np.all(np.abs(slope[beta > 0]) <= tolerance)


@given(small_problems())
def test_conditions_of_the_solution_and_conditions_of_a_batch(case: tuple[FloatArray, FloatArray]) -> None:
    A, y = case
    fit = BoundedFit(A, y)
    assert_conditions(A, y, fit.coefficients)
    assert fit.rank == np.linalg.matrix_rank(A)
    assert np.sum(~fit.at_bound) <= fit.rank
    beta = non_negative_fits((A.T @ A)[None], (A.T @ y)[None])[0]
    assert_conditions(A, y, beta)
    assert np.sum(beta > 0) <= np.linalg.matrix_rank(A)


def test_given_coefficients_and_a_projection_leave_the_rest_to_the_fit() -> None:
    A, _ = problem(4, 25, 3, 0.5)
    offset, projection = np.array([0.3, 0.0, -0.2]), np.array([[1.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    few = condensed(A, A @ (offset + projection @ [2.0, 3.0]))
    np.testing.assert_allclose(few.solved(projection, offset).coefficients, [2.0, 3.0], rtol=1e-10)


def test_weights_count_as_repeated_rows() -> None:
    A, y = problem(11, 12, 2, -1.0)
    times = np.arange(12) % 4
    weighted = BoundedFit(A, y, weights=times)
    repeated = BoundedFit(np.repeat(A, times, axis=0), np.repeat(y, times))
    np.testing.assert_allclose(weighted.coefficients, repeated.coefficients, rtol=1e-12)
    np.testing.assert_allclose(weighted.sse, repeated.sse, rtol=1e-12)


def test_dependent_columns_share_no_coefficient() -> None:
    x = np.array([1.0, 2.0, 4.0])
    fit = BoundedFit(np.column_stack((x, 3 * x, x)), 6 * x)
    assert fit.rank == 1
    assert np.sum(~fit.at_bound) == 1
    np.testing.assert_allclose([1, 3, 1] @ fit.coefficients, 6.0, rtol=1e-13)


def test_singular_members_do_not_disturb_the_others() -> None:
    gram = np.array(
        [[[2.0, 0.0], [0.0, 3.0]], [[1.0, 1.0], [1.0, 1.0]], [[0.0, 0.0], [0.0, 4.0]], np.full((2, 2), np.nan)]
    )
    moment = np.array([[4.0, 3.0], [5.0, 5.0], [0.0, 2.0], [1.0, 1.0]])
    found = non_negative_fits(gram, moment)
    np.testing.assert_allclose(found[0], [2, 1], rtol=1e-14)
    assert found[1].sum() == pytest.approx(5.0)
    assert np.sum(found[1] == 0) == 1
    np.testing.assert_allclose(found[2], [0, 0.5], rtol=1e-14)
    assert np.isnan(found[3]).all()


def test_the_unit_of_a_column_does_not_matter() -> None:
    A, y = problem(5, 20, 3, -0.5)
    factors = np.array([1e-9, 1.0, 1e9])  # m³ beside mm³
    one, other = BoundedFit(A, y), BoundedFit(A * factors, y)
    np.testing.assert_allclose(other.coefficients * factors, one.coefficients, rtol=1e-10)
    S = A * factors
    batch = non_negative_fits((S.T @ S)[None], (S.T @ y)[None])[0]
    np.testing.assert_allclose(batch * factors, one.coefficients, rtol=1e-8)


def test_bad_input() -> None:
    with raises(ParameterError, "too_many"):
        BoundedFit(np.ones((9, 7)), np.ones(9))
    for weights in ([1.0, -1.0], [1.0, np.nan], [1.0]):
        with raises(ParameterError, "wrong_shape"):
            BoundedFit([1.0, 2.0], [1.0, 2.0], weights=weights)
    with raises(ParameterError, "wrong_shape"):
        non_negative_fits(np.ones((3, 2, 2)), np.ones((3, 3)))
    with raises(ParameterError, "too_many", p=7):
        non_negative_fits(np.ones((2, 7, 7)), np.ones((2, 7)))
