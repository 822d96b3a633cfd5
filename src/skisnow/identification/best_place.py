"""Residuals as they change from the best place on, and samples of places as values."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt

from .result import Solution

FloatArray = npt.NDArray[np.float64]


def residuals_about_best(solution: Solution) -> Callable[[Sequence[FloatArray]], list[FloatArray | None]]:
    """Those of the search, moved so that at the best place they are those of the answer."""
    problem, found = solution.problem, solution.found
    quick = problem.residuals([found.place])[0]
    apart = np.zeros_like(found.residuals) if quick is None else found.residuals - quick

    def residuals(places: Sequence[FloatArray]) -> list[FloatArray | None]:
        return [None if each is None else each + apart for each in problem.residuals(places)]

    return residuals


def samples_in_values(solution: Solution, places: FloatArray) -> FloatArray:
    """Places (N, p) of the search as values (N, p) in the keys' units."""
    parameters = solution.problem.parameters
    return np.array([[each.value(float(u)) for each, u in zip(parameters, row, strict=True)] for row in places])
