"""Samples of the posterior distribution with emcee (optional: ``pip install "skisnow[posterior]"``)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from .._support.optional_packages import needed
from .parameter import bounds_of
from .result import Solution

FloatArray = npt.NDArray[np.float64]

SIMULATED: Final = (
    "posterior: emcee on the likelihood of residuals that are quadratic in each parameter (from the runs of the last "
    "Jacobian), for a simulated run takes too long; terms that mix two parameters are linear"
)
TRUE: Final = "posterior: emcee on the likelihood itself"
_WALKERS_PER_PARAMETER: Final = 4
_BURN_IN: Final = 0.3
_SMALL_BALL: Final = 0.5


def require_emcee() -> Any:
    """The sampler's package.

    Raises
    ------
    ParameterError
        It is not installed.
    """
    return needed("emcee", extra="posterior", what="a posterior")


def posterior_places(
    solution: Solution, samples: int, rng: np.random.Generator, progress: Callable[[str], None]
) -> tuple[FloatArray | None, str]:
    """About that many samples (N, p) on the scale of the search, and how they came about.

    Notes
    -----
    Normal noise of the stated or estimated size, priors as they were given, flat inside the bounds otherwise (in the
    logarithm for logarithmic parameters).
    """
    emcee = require_emcee()
    known = solution.known()
    if known is None or known.groups:
        return None, "no posterior: the data leave a parameter open"
    simulated = any(each.kind == "track" for each in solution.problem.observations)
    likelihood = _quadratic(solution) if simulated else _true(solution)
    p = len(solution.found.place)
    walkers = max(_WALKERS_PER_PARAMETER * p, 16)
    steps = max(round(samples / walkers / (1.0 - _BURN_IN)), 20)
    lower, upper = bounds_of(solution.problem.parameters)
    about = _SMALL_BALL * known.standard_errors * rng.standard_normal((walkers, p))
    begin = np.clip(solution.found.place + about, lower, upper)
    sampler = emcee.EnsembleSampler(walkers, p, likelihood, vectorize=True)
    sampler.random_state = np.random.RandomState(int(rng.integers(2**31))).get_state()
    for number, _ in enumerate(sampler.sample(begin, iterations=steps)):
        progress(f"posterior: step {number + 1} of {steps}")
    chain = sampler.get_chain(discard=round(_BURN_IN * steps), flat=True)
    return np.asarray(chain, dtype=float), SIMULATED if simulated else TRUE


def _quadratic(solution: Solution) -> Callable[[FloatArray], FloatArray]:
    found = solution.found
    lower, upper = bounds_of(solution.problem.parameters)
    jacobian, second = found.jacobian, found.second
    assert jacobian is not None and second is not None
    widening = solution.widening

    def log_probability(places: FloatArray) -> FloatArray:
        away = places - found.place
        residuals = found.residuals + away @ jacobian.T + 0.5 * away**2 @ second.T
        inside = np.all((places >= lower) & (places <= upper), axis=1)
        return np.where(inside, -0.5 * np.sum(residuals**2, axis=1) / widening**2, -np.inf)

    return log_probability


def _true(solution: Solution) -> Callable[[FloatArray], FloatArray]:
    lower, upper = bounds_of(solution.problem.parameters)
    widening = solution.widening

    def log_probability(places: FloatArray) -> FloatArray:
        inside = np.all((places >= lower) & (places <= upper), axis=1)
        found = np.full(len(places), -np.inf)
        asked = solution.problem.residuals(list(places[inside]))
        found[inside] = [
            -np.inf if residuals is None else -0.5 * float(residuals @ residuals) / widening**2 for residuals in asked
        ]
        return found

    return log_probability
