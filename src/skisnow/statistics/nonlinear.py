"""Nonlinear least squares whose parameters and standard errors hold the certified digits of all 27 NIST sets.

A `FitWarning` reports parameters or standard errors with fewer digits.

Derivatives are differences. A step that is a fixed share of the parameter is wrong wherever a parameter is large
compared with the distance over which the model changes: the position of a narrow peak, a period. Therefore the
differences of a ladder of halved steps are extrapolated to step zero (Ridders, 1982, Adv. Eng. Softw. 4, 75-76), and
the extrapolation that agrees best with its neighbours is used.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Final, TypeAlias

import numpy as np
import numpy.typing as npt

from .._support.arrays import FloatArray
from .._support.errors import FitError, FitWarning, ParameterError
from .._support.messages import Message, template
from .combined_uncertainty import require_confidence
from .least_squares import Columns, Factorisation, as_response, factorise, require_finite, spread

Model: TypeAlias = Callable[..., Any]

_MOST_STEPS = 50
_SETTLED = 1e-6
"""A last step above this share of parameter and standard error together is not a solution."""
_PARAMETER_DIGITS = 1e-8
_ERROR_DIGITS = 1e-6
"""Relative uncertainty of parameters and of standard errors above which a warning is given."""
_EXACT = 10.0
"""Residuals not above so many roundings of the fitted values are zero: the data lie on the curve."""
_EPS = float(np.finfo(float).eps)
Values: TypeAlias = "Callable[[FloatArray], FloatArray]"
_COARSE_STEP: Final = float(np.finfo(float).eps) ** (1.0 / 3.0)
"""Step of a plain central difference: its truncation h² equals the rounding eps/h."""
_FIRST_STEP: Final = 0.1
"""The longest step of the ladder, as a share of the parameter, or of what changes the model by its own size."""
_RUNGS: Final = 9
_WORSE: Final = 4.0
_AT_ZERO: Final = 1e-6
"""A parameter not above this share of its scale counts as zero: the scale sets its step."""


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

    Results that need n > p are NaN for n = p.
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
        Confidence of the intervals.
    names
        Names of the parameters (default: b1, b2, …).

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
    A trust-region search (scipy) comes first; Gauss-Newton steps with extrapolated derivatives follow. At the end the
    residuals are orthogonal to the derivatives within rounding. The errors of rounding and of the derivatives are
    propagated to the parameters and the standard errors.

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
        raise ParameterError("{n_labels} names for {p} parameters; one is needed for each starting value").tag(
            "wrong_shape", n_labels=len(labels), p=p
        )
    if n < p:
        raise FitError("{n} observations cannot determine {p} parameters; at least {p} are needed").tag(
            "too_few_data", n=n, p=p
        )
    scale = np.where(b != 0, np.abs(b), 1.0)

    def values(parameters: FloatArray) -> FloatArray:
        with np.errstate(all="ignore"):  # trial steps may leave the model's domain; they are judged by their residuals
            fitted = np.asarray(model(x, *parameters), dtype=float)
        if fitted.shape != (n,):
            raise ParameterError("the model returned shape {shape}; one value is needed for each of {n} responses").tag(
                "wrong_shape", shape=str(fitted.shape), n=n
            )
        return fitted

    require_finite("model at the start", values(b))
    b = _search(values, observed, b, scale)
    b, design, uncertainty = _polished(values, observed, b, scale, labels)
    _warn(uncertainty, n > p)
    return NonlinearFit(**spread(b, observed - values(b), design, confidence), names=labels)


def _search(values: Values, observed: FloatArray, start: FloatArray, scale: FloatArray) -> FloatArray:
    from scipy.optimize import least_squares

    def missed(b: FloatArray) -> FloatArray:
        return values(b) - observed

    def slopes(b: FloatArray) -> FloatArray:
        return coarse_jacobian(values, b, scale)

    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        try:
            result = least_squares(
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
            raise FitError("the search broke off: {error}; start nearer to the solution").tag(
                "not_converged", error=error
            ) from error
    if result.status <= 0 or not np.all(np.isfinite(result.x)):
        raise FitError("the search did not settle in 2000 steps; start nearer to the solution, or fix a parameter").tag(
            "not_converged"
        )
    return np.asarray(result.x, dtype=float)


def _polished(
    values: Values, observed: FloatArray, b: FloatArray, scale: FloatArray, names: tuple[str, ...]
) -> tuple[FloatArray, Factorisation, _Known]:
    """Gauss-Newton steps until rounding dominates; returns parameters, derivatives, and the accuracy of both."""
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
        raise FitError("the last steps of the fit did not shrink; the data hardly determine the parameters").tag(
            "not_converged"
        )
    return b, design, _known(slopes, design, residual, values(b), np.abs(b) + error + _SETTLED * scale, least)


@dataclass(frozen=True)
class _Known:
    """Relative uncertainty of the parameters and of the standard errors by rounding and derivatives."""

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
        raise FitError(
            "the model has no finite derivatives at the solution; it may lie on the border of its domain"
        ).tag("not_a_number")
    length = np.linalg.norm(slopes.values, axis=0)
    unit = np.where(length > 0, length, 1.0)
    return factorise(Columns(slopes.values / unit, np.diag(1.0 / unit), names))


_FEW_DIGITS_OF_PARAMETERS: Final = template(
    "the parameters of the fit are known to about {digits} digits: the data hardly determine them, or the model is not "
    "smooth there"
)
_FEW_DIGITS_OF_ERRORS: Final = template(
    "the standard errors of the fit are known to about {digits} digits: the residuals are little above rounding, "
    "or the "
    "model is not smooth there"
)


def _warn(uncertainty: _Known, errors_exist: bool) -> None:
    checks = (
        (_FEW_DIGITS_OF_PARAMETERS, uncertainty.parameters, _PARAMETER_DIGITS),
        (_FEW_DIGITS_OF_ERRORS, uncertainty.standard_errors, _ERROR_DIGITS),
    )
    for few_digits, share, allowed in checks[: 2 if errors_exist else 1]:
        if not share <= allowed:
            digits = max(int(-np.log10(share)), 0) if np.isfinite(share) and share > 0 else 0
            warnings.warn(FitWarning(Message(few_digits, digits=digits)).tag("few_digits"), stacklevel=3)


@dataclass(frozen=True)
class Jacobian:
    """Derivatives (n, p) of n values by p parameters, and how far each may be off, (n, p) too."""

    values: FloatArray
    error: FloatArray


def coarse_jacobian(values: Values, b: FloatArray, scale: FloatArray) -> FloatArray:
    """Derivatives accurate to half the digits, with two evaluations for each parameter; for the way to a solution."""
    return np.stack(
        [_difference(values, b, j, _COARSE_STEP * size) for j, size in enumerate(_steps(b, scale))], axis=-1
    )


def jacobian(values: Values, b: FloatArray, scale: FloatArray) -> Jacobian:
    """Derivatives accurate to all but the last digits, with up to 20 evaluations for each parameter.

    values: function of the parameters that returns the n values of the model.
    b: the parameters, shape (p,).
    scale: above 0, shape (p,): the size of a parameter at 0.
    """
    here = float(np.linalg.norm(values(b)))
    coarse = np.linalg.norm(coarse_jacobian(values, b, scale), axis=0)
    reach = np.divide(here, coarse, out=np.full(len(b), np.inf), where=coarse > 0)
    columns = [
        _extrapolated(values, b, j, _FIRST_STEP * float(min(size, far)))
        for j, (size, far) in enumerate(zip(_steps(b, scale), reach, strict=True))
    ]
    return Jacobian(*(np.stack(part, axis=-1) for part in zip(*columns, strict=True)))


def _steps(b: FloatArray, scale: FloatArray) -> FloatArray:
    return np.where(np.abs(b) > _AT_ZERO * scale, np.abs(b), scale)


def _difference(values: Values, b: FloatArray, j: int, size: float) -> FloatArray:
    above, below = b.copy(), b.copy()
    above[j] += size
    below[j] -= size
    with np.errstate(all="ignore"):  # a long step may leave the model's domain: it is not taken then
        return np.asarray((values(above) - values(below)) / (above[j] - below[j]))


def _extrapolated(values: Values, b: FloatArray, j: int, size: float) -> tuple[FloatArray, FloatArray]:
    """Column j, and its error, from the entry of Neville's tableau that agrees best with the two it comes from."""
    first = _difference(values, b, j, size)
    best, error, least, above = first, np.full_like(first, np.inf), np.inf, [first]
    for rung in range(1, _RUNGS):
        row, closest = [_difference(values, b, j, size / 2.0**rung)], np.inf
        for order, before in enumerate(above, start=1):
            with np.errstate(all="ignore"):
                row.append(row[-1] + (row[-1] - before) / (4.0**order - 1.0))
                apart = np.maximum(np.abs(row[-1] - row[-2]), np.abs(row[-1] - before))
                distance = float(np.linalg.norm(apart))
            closest = min(closest, distance)
            if distance < least:
                best, error, least = row[-1], apart, distance
        if closest > _WORSE * least:  # shorter steps only add rounding
            break
        above = row
    return best, error
