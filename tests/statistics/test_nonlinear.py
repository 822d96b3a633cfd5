"""Nonlinear fits: the 27 sets of NIST from both starting points, and cases with known answers."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import nullcontext
from typing import Any

import numpy as np
import pytest
from tests.coded import raises, warns

from skisnow._support.errors import FitError, FitWarning, ParameterError
from skisnow.statistics import linear_fit, nonlinear_fit

from .nist_models import MODELS

SOLE_ROUNDING = "Lanczos1"
"""Its residuals of 1e-13 are a few hundred roundings of its data: doubles do not hold their size to six digits."""


@pytest.mark.parametrize("start", [0, 1])
@pytest.mark.parametrize("name", sorted(MODELS))
def test_certified(nist: Callable[[str], Any], digits: Callable[..., float], name: str, start: int) -> None:
    file = nist(name)
    starts, certified, errors = file.parameters[:2], file.parameters[2], file.parameters[3]
    y, x = file.data[:, 0], file.data[:, 1] if name != "Nelson" else file.data[:, 1:]
    y = np.log(y) if name == "Nelson" else y
    known_errors = name != SOLE_ROUNDING
    said = nullcontext() if known_errors else pytest.warns(FitWarning, match="standard errors .* about 2 digits")
    with said:
        fit = nonlinear_fit(MODELS[name], x, y, starts[start])
    assert digits(fit.coefficients, certified) >= 9
    assert digits(fit.standard_errors, errors) >= (9 if known_errors else 2)
    assert digits(fit.sse, file.numbers_after("Residual Sum of Squares:")) >= (9 if known_errors else 2)
    assert digits(fit.rmse_dof, file.numbers_after("Residual Standard Deviation:")) >= (9 if known_errors else 2)


def test_data_that_hardly_tell_two_parameters_apart_are_said_to() -> None:
    x = np.linspace(0.0, 1.0, 12)
    y = 2.0 + 3.0 * x + np.random.default_rng(2).normal(0.0, 0.1, 12)
    with warns(FitWarning, "few_digits"):
        nonlinear_fit(lambda x, a, b, c: a + b * x + c * np.sin(0.01 * x), x, y, [1.0, 1.0, 1.0])


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
    with raises(FitError, "rank_deficient", rank=1, count=2):
        nonlinear_fit(lambda x, a, b: a * b * x, x, y, [1.0, 1.0])
    with raises(FitError, "too_few_data", n=2):
        nonlinear_fit(MODELS["Chwirut2"], x[:2], y[:2], [0.1, 0.1, 0.1])
    with raises(ParameterError, "not_a_number"):
        nonlinear_fit(lambda x, a: a / (x - 1), x, y, [1.0])
    with raises(ParameterError, "wrong_shape", n_labels=2, p=1):
        nonlinear_fit(lambda x, a: a * x, x, y, [1.0], names=["a", "b"])
    with raises(ParameterError, "wrong_shape"):
        nonlinear_fit(lambda x, a: a * x[:3], x, y, [1.0])


def test_a_model_that_refuses_a_step_of_the_search_is_an_error() -> None:
    """It is defined at the start, and not where the search goes: towards 1000."""
    x = np.linspace(1.0, 2.0, 6)

    def narrow(x: Any, a: float) -> Any:
        if a > 2.0:
            raise ValueError("outside of the table")
        return a * x

    with raises(FitError, "not_converged", error="outside of the table"):
        nonlinear_fit(narrow, x, 1000.0 * x, [1.0])
