"""Nonlinear least squares whose parameters and standard errors hold the certified digits of all 27 NIST sets.

Where fewer digits are known than a reader would take for granted, a `FitWarning` says so.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import numpy.typing as npt

from .._support.errors import FitError, FitWarning, ParameterError
from .combined_uncertainty import require_confidence
from .derivatives import Jacobian, coarse_jacobian, jacobian
from .least_squares import Columns, Factorisation, FloatArray, as_response, factorise, require_finite, spread

if TYPE_CHECKING:
    from collections.abc import Sequence

Model: TypeAlias = Callable[..., Any]
_Values: TypeAlias = Callable[[FloatArray], FloatArray]

_MOST_STEPS = 50
_SETTLED = 1e-6
"""A last step above this share of parameter and standard error together is no solution."""
_PARAMETER_DIGITS = 1e-8
_ERROR_DIGITS = 1e-6
"""Relative uncertainty of parameters and of standard errors from which on a warning is given."""
_EXACT = 10.0
"""Residuals not above so many roundings of the fitted values are zero: the data lie on the curve."""
_EPS = float(np.finfo(float).eps)


@dataclass(frozen=True)
class NonlinearFit:
    """A nonlinear least-squares fit.

    Attributes
    ----------
    names
        Names of the parameters.
    coefficients, standard_errors, intervals, covariance
        Shapes (p,), (p,), (p, 2), (p, p); from the linearised model, by Student's t with n - p degrees of freedom.
    residuals
        Observed minus fitted, shape (n,).
    sse, rmse, rmse_dof
        Sum of squared residuals; its root mean over n; its root mean over n - p.
    n, n_parameters
        Observations n and parameters p.

    What needs n > p is NaN for n = p.
    """

    names: tuple[str, ...]
    coefficients: FloatArray
    standard_errors: FloatArray
    intervals: FloatArray
    covariance: FloatArray
    residuals: FloatArray
    sse: float
    rmse: float
    rmse_dof: float
    n: int
    n_parameters: int


def nonlinear_fit(
    model: Model,
    x: Any,
    y: npt.ArrayLike,
    start: npt.ArrayLike,
    *,
    confidence: float = 0.95,
    names: Sequence[str] | None = None,
) -> NonlinearFit:
    """Fit y = model(x, b1, …, bp) + error by least squares.

    Parameters
    ----------
    model
        Function of x and p further arguments that returns n values; smooth in the parameters.
    x
        Handed to the model as it is.
    y
        Response, shape (n,).
    start
        Starting values, shape (p,). Where a parameter comes to lie at 0 its starting value (1 for a start at 0) also
        limits the step of the derivatives; elsewhere its own size does.
    confidence
        Of the intervals.
    names
        Of the parameters; b1, b2, … where left out.

    Raises
    ------
    ParameterError
        If shapes do not fit, or the model has no finite values at the start.
    FitError
        If n < p, the search does not settle, or the data do not determine all parameters.

    Warns
    -----
    FitWarning
        If the parameters are known to fewer than eight digits or the standard errors to fewer than six.

    Notes
    -----
    A trust-region search (scipy) goes first; Gauss-Newton steps with extrapolated derivatives finish. At the end of
    the steps the residuals are orthogonal to the derivatives but for rounding. What rounding and the derivatives leave
    open is carried through to the parameters and the standard errors.

    Examples
    --------
    >>> x = np.array([0.0, 1.0, 2.0, 3.0])
    >>> fit = nonlinear_fit(lambda x, a, k: a * np.exp(-k * x), x, 8.0 * 0.5**x, [5.0, 1.0], names=["a", "k"])
    >>> [round(float(b), 9) for b in fit.coefficients]  # 8 and ln 2
    [8.0, 0.693147181]
    """
    require_confidence(confidence)
    observed, b = as_response(y), as_response(start)
    n, p = len(observed), len(b)
    labels = tuple(names) if names is not None else tuple(f"b{j + 1}" for j in range(p))
    if len(labels) != p:
        raise ParameterError(f"{len(labels)} names for {p} parameters; one is needed for each starting value")
    if n < p:
        raise FitError(f"{n} observations cannot determine {p} parameters; at least {p} are needed")
    scale = np.where(b != 0, np.abs(b), 1.0)

    def values(parameters: FloatArray) -> FloatArray:
        with np.errstate(all="ignore"):  # trial steps may leave the model's domain; they are judged by their residuals
            found = np.asarray(model(x, *parameters), dtype=float)
        if found.shape != (n,):
            raise ParameterError(
                f"the model returned shape {found.shape}; one value is needed for each of {n} responses"
            )
        return found

    require_finite("model at the start", values(b))
    b = _searched(values, observed, b, scale)
    b, design, known = _polished(values, observed, b, scale, labels)
    _warn(known, n > p)
    return NonlinearFit(**spread(b, observed - values(b), design, confidence), names=labels)


def _searched(values: _Values, observed: FloatArray, start: FloatArray, scale: FloatArray) -> FloatArray:
    from scipy.optimize import least_squares

    def missed(b: FloatArray) -> FloatArray:
        return values(b) - observed

    def slopes(b: FloatArray) -> FloatArray:
        return coarse_jacobian(values, b, scale)

    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        try:
            found = least_squares(
                missed,
                start,
                jac=slopes,
                x_scale="jac",
                ftol=1e-14,
                xtol=1e-14,
                gtol=None,
                max_nfev=2000,
            )
        except (ValueError, np.linalg.LinAlgError) as error:
            raise FitError(f"the search broke off: {error}; start nearer to the solution") from error
    if found.status <= 0 or not np.all(np.isfinite(found.x)):
        raise FitError("the search did not settle in 2000 steps; start nearer to the solution, or fix a parameter")
    return np.asarray(found.x, dtype=float)


def _polished(
    values: _Values, observed: FloatArray, b: FloatArray, scale: FloatArray, names: tuple[str, ...]
) -> tuple[FloatArray, Factorisation, _Known]:
    """Gauss-Newton steps until they are lost in rounding: parameters, derivatives, how well both are known."""
    least = np.inf
    for _ in range(_MOST_STEPS):
        slopes = jacobian(values, b, scale)
        design, residual = _factorised(slopes, names), observed - values(b)
        step, _ = design.solve(residual)
        error = np.linalg.norm(design.loadings, axis=1) * np.linalg.norm(residual)
        size = float(np.max(np.abs(step) / (np.abs(b) + error + _SETTLED * scale)))
        if size >= least:  # no smaller than the step before: rounding is reached
            break
        least = size
        b = b + step
    else:
        slopes = jacobian(values, b, scale)
        design, residual = _factorised(slopes, names), observed - values(b)
    if not least <= _SETTLED:
        raise FitError("the last steps of the fit did not shrink; the data hardly determine the parameters")
    return b, design, _known(slopes, design, residual, values(b), np.abs(b) + error + _SETTLED * scale, least)


@dataclass(frozen=True)
class _Known:
    """Relative uncertainty of the parameters and of the standard errors by rounding and derivatives alone."""

    parameters: float
    standard_errors: float


def _known(
    slopes: Jacobian, design: Factorisation, residual: FloatArray, fitted: FloatArray, size: FloatArray, last: float
) -> _Known:
    """To first order: δb = (JᵀJ)⁻¹ δJᵀ r - J⁺ δf, and δ(ln SE) ≤ ‖δJ R⁻¹‖ + δ‖r‖/‖r‖."""
    rounding = _EPS * float(np.linalg.norm(fitted))
    left = float(np.linalg.norm(residual))
    length = np.linalg.norm(design.loadings, axis=1)
    off = np.abs(design.loadings @ design.loadings.T) @ (slopes.error.T @ np.abs(residual)) + length * rounding
    exact = left <= _EXACT * rounding
    return _Known(
        parameters=max(last, float(np.max(off / size))),
        standard_errors=float(np.linalg.norm(slopes.error @ design.loadings)) + (0.0 if exact else rounding / left),
    )


def _factorised(slopes: Jacobian, names: tuple[str, ...]) -> Factorisation:
    if not (np.all(np.isfinite(slopes.values)) and np.all(np.isfinite(slopes.error))):
        raise FitError("the model has no finite derivatives at the solution; it may lie on the border of its domain")
    length = np.linalg.norm(slopes.values, axis=0)
    unit = np.where(length > 0, length, 1.0)
    return factorise(Columns(slopes.values / unit, np.diag(1.0 / unit), names))


def _warn(known: _Known, errors_exist: bool) -> None:
    checks = (
        ("parameters", known.parameters, _PARAMETER_DIGITS, "the data hardly determine them"),
        ("standard errors", known.standard_errors, _ERROR_DIGITS, "the residuals are little above rounding"),
    )
    for what, share, allowed, reason in checks[: 2 if errors_exist else 1]:
        if not share <= allowed:
            digits = max(int(-np.log10(share)), 0) if np.isfinite(share) and share > 0 else 0
            warnings.warn(
                f"the {what} of the fit are known to about {digits} digits: {reason}, or the model is not smooth there",
                FitWarning,
                stacklevel=3,
            )
