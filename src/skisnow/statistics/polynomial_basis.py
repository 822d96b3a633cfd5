"""Chebyshev polynomials as columns of a fit, with their exact way back to powers of x."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np

from .._support.errors import ParameterError
from .least_squares import Columns, FloatArray

Polynomial = list[Fraction]
"""Coefficients in ascending powers."""


def chebyshev_columns(x: FloatArray, degree: int) -> Columns:
    """T_0(t) … T_d(t) of t = (x - middle)/scale in [-1, 1], for x of shape (n, 1).

    The scale is a power of two and middle has few binary digits, so that t keeps every digit of x.
    """
    if x.shape[1] != 1 or degree < 0:
        raise ParameterError(f"a polynomial needs one predictor (found {x.shape[1]}) and a degree ≥ 0 (found {degree})")
    low, high = float(x.min()), float(x.max())
    scale = 2.0 ** math.ceil(math.log2(high - low) - 1.0) if high > low else 1.0
    middle = round((0.5 * low + 0.5 * high) / scale * 16.0) / 16.0 * scale
    t = (x[:, 0] - middle) / scale
    scaled: FloatArray = np.polynomial.chebyshev.chebvander(t, degree).astype(float)
    back = np.array([[float(c) for c in row] for row in exact_way_back(degree, middle, scale)])
    return Columns(scaled, back, tuple(f"power {j}" for j in range(degree + 1)))


def exact_way_back(degree: int, middle: float, scale: float) -> list[list[Fraction]]:
    """Matrix B, B[j][k] = coefficient of x^j in T_k((x - middle)/scale), exactly."""
    t: Polynomial = [Fraction(-middle) / Fraction(scale), 1 / Fraction(scale)]
    basis: list[Polynomial] = [[Fraction(1)], t]
    while len(basis) <= degree:  # T_{k+1} = 2 t T_k - T_{k-1}
        doubled = [2 * c for c in _product(t, basis[-1])]
        older = basis[-2] + [Fraction(0)] * (len(doubled) - len(basis[-2]))
        basis.append([a - b for a, b in zip(doubled, older, strict=True)])
    padded = [p + [Fraction(0)] * (degree + 1 - len(p)) for p in basis[: degree + 1]]
    return [[padded[k][j] for k in range(degree + 1)] for j in range(degree + 1)]


def _product(a: Polynomial, b: Polynomial) -> Polynomial:
    result = [Fraction(0)] * (len(a) + len(b) - 1)
    for i, left in enumerate(a):
        for j, right in enumerate(b):
            result[i + j] += left * right
    return result
