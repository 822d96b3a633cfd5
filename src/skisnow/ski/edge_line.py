"""The circle that fits an edge line best."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from .checks import STRAIGHT

FloatArray = npt.NDArray[np.float64]


def radius_of_least_squares_circle(along: FloatArray, across: FloatArray) -> float:
    """Radius of the circle with the least sum of squared distances to points of a plane (m).

    Parameters
    ----------
    along, across
        Coordinates of the points (m). Shape (n,), n ≥ 3.

    Returns
    -------
    float
        Above 0, in m; infinite where the points lie on a straight line to a tenth of a micrometre.

    Notes
    -----
    Pratt's form A (x² + y²) + B x + C y + D = 0 with B² + C² - 4 A D = 1 (Pratt 1987, Computer Graphics 21:145). It
    minimises Σ (d + d²/2R)², d the distance of a point from the circle. The edge of a ski is within 0.1 mm of its
    circle and R is metres, so it is the circle of least squares to 5 digits beyond the first. Unlike the centre
    and radius themselves it stays well posed as the line becomes straight.

    Examples
    --------
    >>> turn = np.linspace(-0.05, 0.05, 41)
    >>> round(radius_of_least_squares_circle(13.0 * np.sin(turn), 0.034 + 13.0 * (1.0 - np.cos(turn))), 9)
    13.0
    """
    x, y = along - along.mean(), across - across.mean()
    scale = float(np.max(np.abs(x)))
    curvature = _pratt_curvature(x / scale, y / scale) / scale
    return 1.0 / curvature if curvature * scale**2 / 2.0 > STRAIGHT else float("inf")


def _pratt_curvature(x: FloatArray, y: FloatArray) -> float:
    points = np.column_stack([x**2 + y**2, x, y, np.ones_like(x)])
    constraint = np.array([[0.0, 0, 0, -2], [0, 1, 0, 0], [0, 0, 1, 0], [-2, 0, 0, 0]])
    residuals, circles = np.linalg.eig(np.linalg.solve(constraint, points.T @ points / len(x)))
    # the constraint has one negative direction, whose circle is imaginary: the answer is the one nearest to 0
    A, B, C, D = np.real(circles[:, np.argmin(np.abs(residuals))])
    return float(2.0 * abs(A) / np.sqrt(B**2 + C**2 - 4.0 * A * D))
