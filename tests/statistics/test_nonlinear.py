"""Nonlinear fits: NIST's Misra1a and Chwirut2 from both starting points, and cases with known answers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from skisnow.errors import FitError, ParameterError
from skisnow.statistics import linear_fit, nonlinear_fit

FloatArray = npt.NDArray[np.float64]


def misra1a(x: FloatArray, b1: float, b2: float) -> FloatArray:
    return np.asarray(b1 * (1 - np.exp(-b2 * x)))


def chwirut2(x: FloatArray, b1: float, b2: float, b3: float) -> FloatArray:
    return np.asarray(np.exp(-b1 * x) / (b2 + b3 * x))


@pytest.mark.parametrize("start", [0, 1])
@pytest.mark.parametrize(("name", "model"), [("Misra1a", misra1a), ("Chwirut2", chwirut2)])
def test_certified(
    nist: Callable[[str], Any], digits: Callable[..., float], name: str, model: Callable[..., FloatArray], start: int
) -> None:
    file = nist(name)
    rows = np.array([file.numbers_after(f"  b{j} =") for j in range(1, 4 if name == "Chwirut2" else 3)])
    fit = nonlinear_fit(model, file.data[:, 1], file.data[:, 0], rows[:, start])
    assert digits(fit.coefficients, rows[:, 2]) >= 9
    assert digits(fit.standard_errors, rows[:, 3]) >= 9
    assert digits(fit.sse, file.numbers_after("Residual Sum of Squares:")) >= 9
    assert digits(fit.rmse_dof, file.numbers_after("Residual Standard Deviation:")) >= 9


def test_a_straight_line_is_the_linear_fit(digits: Callable[..., float]) -> None:
    rng = np.random.default_rng(1)
    x = rng.uniform(1, 3, 30)
    y = 1 + 2 * x + rng.normal(size=30)
    plain = linear_fit(y, x, confidence=0.9)
    fit = nonlinear_fit(lambda x, a, b: a + b * x, x, y, [0.5, 0.5], confidence=0.9, names=("a", "b"))
    assert digits(fit.coefficients, plain.coefficients) > 11
    assert digits(fit.intervals, plain.intervals) > 10
    assert digits(fit.covariance, plain.covariance) > 10
    assert fit.names == ("a", "b")
    assert (fit.n, fit.n_parameters) == (30, 2)
    np.testing.assert_allclose(fit.residuals, plain.residuals, atol=1e-11)


def test_a_parameter_that_is_zero() -> None:
    x = np.linspace(0, 1, 9)
    fit = nonlinear_fit(lambda x, a, b: a * np.exp(b * x), x, np.full(9, 2.0), [1.0, 0.5])
    np.testing.assert_allclose(fit.coefficients, [2.0, 0.0], atol=1e-12)


def test_as_many_parameters_as_observations() -> None:
    x = np.array([0.0, 1.0])
    fit = nonlinear_fit(lambda x, a, k: a * np.exp(-k * x), x, np.array([8.0, 4.0]), [5.0, 1.0])
    np.testing.assert_allclose(fit.coefficients, [8.0, np.log(2.0)], rtol=1e-12)
    assert np.isnan(fit.intervals).all()


def test_what_cannot_be_fitted_is_an_error() -> None:
    x, y = np.linspace(1, 2, 6), np.array([1.0, 2.0, 1.0, 3.0, 2.0, 2.5])
    with pytest.raises(FitError, match="determine only 1 of 2"):
        nonlinear_fit(lambda x, a, b: a * b * x, x, y, [1.0, 1.0])
    with pytest.raises(FitError, match="2 observations"):
        nonlinear_fit(chwirut2, x[:2], y[:2], [0.1, 0.1, 0.1])
    with pytest.raises(ParameterError, match="at the start"):
        nonlinear_fit(lambda x, a: a / (x - 1), x, y, [1.0])
    with pytest.raises(ParameterError, match="2 names for 1"):
        nonlinear_fit(lambda x, a: a * x, x, y, [1.0], names=["a", "b"])
    with pytest.raises(ParameterError, match="shape"):
        nonlinear_fit(lambda x, a: a * x[:3], x, y, [1.0])
