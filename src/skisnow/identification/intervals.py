"""Profile-likelihood intervals and samples of the posterior distribution."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, Final

import numpy as np
import numpy.typing as npt
from scipy.interpolate import PchipInterpolator

from .._support.optional_packages import needed
from ..statistics import percentile_interval
from .parameter import Parameter, bounds_of
from .result import Identification, Identified, Interval, Profile
from .search import step_inside
from .solution import Solution, residuals_about_best, samples_in_values

FloatArray = npt.NDArray[np.float64]
Progress = Callable[[str], None]

PLACES: Final = (-3.0, -2.0, -1.0, 1.0, 2.0, 3.0)
"""Of a profile, in standard errors from the best value."""
REFITS: Final = 2
"""Gauss-Newton steps of all other parameters at each place, with the Jacobian of the best one."""
SIMULATED: Final = (
    "posterior: emcee on the likelihood of residuals that are quadratic in each parameter (from the runs of the last "
    "Jacobian), for a simulated run takes too long; terms that mix two parameters are linear"
)
TRUE: Final = "posterior: emcee on the likelihood itself"
_WALKERS_PER_PARAMETER: Final = 4
_BURN_IN: Final = 0.3
_SMALL_BALL: Final = 0.5


def profiled(identification: Identification, solution: Solution, progress: Progress) -> Identification:
    """Hold each parameter at several values, refit all others, and see how the sum of squares rises.

    Notes
    -----
    The interval ends where the rise is the square of the factor of the interval by curvature: 3.84 with stated noise.
    """
    known = solution.known()
    if known is None:
        return identification
    limit = known.factor**2 * (solution.widening**2)
    profiles, parameters = [], list(identification.parameters)
    for j, parameter in enumerate(solution.problem.parameters):
        progress(f"profile of {parameter.name}")
        error = float(known.standard_errors[j])
        if not np.isfinite(error):
            continue
        place, rise = _along(solution, j, error)
        profile = Profile(parameter.key, np.array([parameter.value(float(u)) for u in place]), rise, limit)
        profiles.append(profile)
        ends = _ends(solution.found.place[j], place, rise, limit)
        parameters[j] = replace(parameters[j], profile_interval=_as_values(parameter, ends))
    method = f"profiles: others refitted by {REFITS} Gauss-Newton steps at each value"
    return replace(
        identification,
        profiles=tuple(profiles),
        parameters=tuple(parameters),
        methods=(*identification.methods, method),
    )


def _along(solution: Solution, j: int, error: float) -> tuple[FloatArray, FloatArray]:
    """Places of parameter j in sizes, rising, and the rise of the sum of squares; the best one among them."""
    problem, found = solution.problem, solution.found
    lower, upper = bounds_of(problem.parameters)
    centre = found.place
    ends = np.unique(np.clip(centre[j] + error * np.array(PLACES), lower[j], upper[j]))
    ends = ends[np.abs(ends - centre[j]) > 1e-9]
    ask = residuals_about_best(solution)
    begun = [_moved(solution, j, float(end)) for end in ends]
    costs = np.full(len(ends), np.inf)
    for _ in range(REFITS):
        for i, residuals in enumerate(ask(begun)):
            if residuals is not None:
                costs[i] = min(costs[i], float(residuals @ residuals))
                begun[i] = _refitted(solution, j, begun[i], residuals)
    for i, residuals in enumerate(ask(begun)):
        if residuals is not None:
            costs[i] = min(costs[i], float(residuals @ residuals))
    places = np.concatenate([ends, [centre[j]]])
    rise = np.concatenate([costs - found.cost, [0.0]])
    order = np.argsort(places)
    return places[order], rise[order]


def _moved(solution: Solution, j: int, end: float) -> FloatArray:
    """The place with parameter j at `end`, the others where the linear model has its least."""
    found = solution.found
    assert found.jacobian is not None
    place = found.place.copy()
    place[j] = end
    away = found.residuals + found.jacobian[:, j] * (end - found.place[j])
    return _refitted(solution, j, place, away)


def _refitted(solution: Solution, j: int, place: FloatArray, residuals: FloatArray) -> FloatArray:
    jacobian = solution.found.jacobian
    assert jacobian is not None
    others = np.array([i for i in range(len(place)) if i != j], dtype=int)
    if not len(others):
        return place
    lower, upper = bounds_of(solution.problem.parameters)
    step = step_inside(jacobian[:, others], residuals, lower[others] - place[others], upper[others] - place[others])
    moved = place.copy()
    moved[others] = np.clip(place[others] + step, lower[others], upper[others])
    return moved


def _ends(best: float, place: FloatArray, rise: FloatArray, limit: float) -> tuple[float | None, float | None]:
    """Where the signed root of the rise passes that of the limit; None where it does not."""
    root = np.sign(place - best) * np.sqrt(np.maximum(rise, 0.0))
    known = np.isfinite(root)
    place, root = place[known], np.maximum.accumulate(root[known])
    rising = np.concatenate([[True], np.diff(root) > 0.0])
    place, root = place[rising], root[rising]
    found: list[float | None] = []
    for target in (-np.sqrt(limit), np.sqrt(limit)):
        inside = len(root) > 1 and root[0] <= target <= root[-1]
        found.append(float(PchipInterpolator(root, place)(target)) if inside else None)
    return found[0], found[1]


def _as_values(parameter: Parameter, ends: tuple[float | None, float | None]) -> Interval:
    low, high = (None if end is None else parameter.value(end) for end in ends)
    return low, high


def with_posterior(
    identification: Identification, solution: Solution, samples: int, rng: np.random.Generator, progress: Progress
) -> Identification:
    """Sample the posterior with emcee, inside the bounds."""
    places, how = posterior_places(solution, samples, rng, progress)
    if places is None:
        return replace(identification, warnings=(*identification.warnings, how))
    values = samples_in_values(solution, places)
    intervals = percentile_interval(values)
    parameters: list[Identified] = [
        replace(parameter, posterior_interval=(float(low), float(high)))
        for parameter, (low, high) in zip(identification.parameters, intervals, strict=True)
    ]
    return replace(
        identification, posterior=values, parameters=tuple(parameters), methods=(*identification.methods, how)
    )


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
    simulated = any(observation.kind == "track" for observation in solution.problem.observations)
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
