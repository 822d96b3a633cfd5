"""Profile-likelihood, bootstrap and posterior intervals of identified parameters."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np
from scipy.interpolate import PchipInterpolator

from .._support.arrays import FloatArray
from .._support.environment import import_extra
from .._support.errors import ParameterError
from .._support.messages import Message
from ..statistics import percentile_interval
from .parameter import bounds_of
from .result import Identification, Identified, Profile
from .search import Progress, step_inside
from .solution import SearchRequest, Solution, best_fit_residuals, values_at

PLACES: Final = (-3.0, -2.0, -1.0, 1.0, 2.0, 3.0)
"""Positions of the values of a profile, in standard errors from the best value."""
REFITS: Final = 2
"""Number of Gauss-Newton steps of the other parameters at each value, with the Jacobian of the best place."""
QUADRATIC_POSTERIOR: Final = Message(
    "posterior: emcee on the likelihood of residuals that are quadratic in each parameter (from the runs of the last "
    "Jacobian), for a simulated run takes too long; terms that mix two parameters are linear"
)
EXACT_POSTERIOR: Final = Message("posterior: emcee on the likelihood itself")
_WALKERS_PER_PARAMETER: Final = 4
_BURN_IN: Final = 0.3
_SMALL_BALL: Final = 0.5


def add_profile_intervals(identification: Identification, solution: Solution, plan: SearchRequest) -> Identification:
    """Add profile-likelihood intervals: fix each parameter at several values and refit all others.

    The interval ends where the rise is the square of the factor of the interval by curvature: 3.84 with stated noise.
    """
    uncertainty = solution.uncertainty()
    if uncertainty is None:
        return identification
    limit = uncertainty.factor**2 * (solution.widening**2)
    profiles, parameters = [], list(identification.parameters)
    for j, parameter in enumerate(solution.problem.parameters):
        plan.progress(f"profile of {parameter.name}")
        error = float(uncertainty.standard_errors[j])
        if not np.isfinite(error):
            continue
        place, rise = _along(solution, j, error)
        profile = Profile(parameter.key, np.array([parameter.value(float(u)) for u in place]), rise, limit)
        profiles.append(profile)
        ends = _ends(solution.optimum.place[j], place, rise, limit)
        low, high = (None if end is None else parameter.value(end) for end in ends)
        parameters[j] = replace(parameters[j], profile_interval=(low, high))
    method = Message("profiles: others refitted by {refits} Gauss-Newton steps at each value", refits=REFITS)
    methods = (*identification.methods, method)
    return replace(identification, profiles=tuple(profiles), parameters=tuple(parameters), methods=methods)


def _along(solution: Solution, j: int, error: float) -> tuple[FloatArray, FloatArray]:
    """Sorted positions of parameter j (in sizes, with the best one) and the rise of the sum of squares there."""
    problem, optimum = solution.problem, solution.optimum
    lower, upper = bounds_of(problem.parameters)
    centre = optimum.place
    ends = np.unique(np.clip(centre[j] + error * np.array(PLACES), lower[j], upper[j]))
    ends = ends[np.abs(ends - centre[j]) > 1e-9]
    compute = best_fit_residuals(solution)
    assert optimum.jacobian is not None
    points = []
    for end in ends:  # the others begin at the minimum of the linearised model
        place = centre.copy()
        place[j] = end
        residuals = optimum.residuals + optimum.jacobian[:, j] * (float(end) - centre[j])
        points.append(_step_of_others(solution, j, place, residuals))
    costs = np.full(len(ends), np.inf)
    for _ in range(REFITS + 1):  # the step after the last residuals does not count
        for i, residuals in enumerate(compute(points)):
            if residuals is not None:
                costs[i] = min(costs[i], float(residuals @ residuals))
                points[i] = _step_of_others(solution, j, points[i], residuals)
    places = np.concatenate([ends, [centre[j]]])
    rise = np.concatenate([costs - optimum.cost, [0.0]])
    order = np.argsort(places)
    return places[order], rise[order]


def _step_of_others(solution: Solution, j: int, place: FloatArray, residuals: FloatArray) -> FloatArray:
    """One Gauss-Newton step of all parameters but j, which stays; the new place is within the bounds."""
    jacobian = solution.optimum.jacobian
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
    """Positions at which the rise reaches the limit, below and above the best one; None if it does not."""
    root = np.sign(place - best) * np.sqrt(np.maximum(rise, 0.0))
    finite = np.isfinite(root)
    place, root = place[finite], np.maximum.accumulate(root[finite])
    rising = np.concatenate([[True], np.diff(root) > 0.0])
    place, root = place[rising], root[rising]
    ends: list[float | None] = []
    for target in (-np.sqrt(limit), np.sqrt(limit)):
        inside = len(root) > 1 and root[0] <= target <= root[-1]
        ends.append(float(PchipInterpolator(root, place)(target)) if inside else None)
    return ends[0], ends[1]


def add_posterior_intervals(identification: Identification, solution: Solution, plan: SearchRequest) -> Identification:
    """Add posterior samples and intervals, sampled by emcee inside the bounds."""
    places, how = posterior_places(solution, plan.posterior, plan.rng, plan.progress)
    if places is None:
        return replace(identification, warnings=(*identification.warnings, how))
    values = values_at(solution, places)
    intervals = percentile_interval(values)
    parameters: list[Identified] = [
        replace(parameter, posterior_interval=(float(low), float(high)))
        for parameter, (low, high) in zip(identification.parameters, intervals, strict=True)
    ]
    return replace(
        identification, posterior=values, parameters=tuple(parameters), methods=(*identification.methods, how)
    )


def require_emcee() -> Any:
    """Import emcee, the package that samples the posterior."""
    return import_extra("emcee", extra="posterior", what=Message("A posterior"))


def posterior_places(
    solution: Solution, samples: int, rng: np.random.Generator, progress: Progress
) -> tuple[FloatArray | None, Message]:
    """About `samples` samples (N, p) on the scale of the search, and a sentence on the method.

    Noise is normal with the stated or estimated standard deviation. Parameters without a prior have a flat one inside
    the bounds (in the logarithm for logarithmic parameters).
    """
    emcee = require_emcee()
    uncertainty = solution.uncertainty()
    if uncertainty is None or uncertainty.groups:
        return None, Message("no posterior: the data leave a parameter open")
    simulated = any(observation.kind == "track" for observation in solution.problem.observations)
    likelihood = _quadratic_likelihood(solution) if simulated else _exact_likelihood(solution)
    p = len(solution.optimum.place)
    walkers = max(_WALKERS_PER_PARAMETER * p, 16)
    steps = max(round(samples / walkers / (1.0 - _BURN_IN)), 20)
    lower, upper = bounds_of(solution.problem.parameters)
    about = _SMALL_BALL * uncertainty.standard_errors * rng.standard_normal((walkers, p))
    begin = np.clip(solution.optimum.place + about, lower, upper)
    sampler = emcee.EnsembleSampler(walkers, p, likelihood, vectorize=True)
    sampler.random_state = np.random.RandomState(int(rng.integers(2**31))).get_state()
    for number, _ in enumerate(sampler.sample(begin, iterations=steps)):
        progress(f"posterior: step {number + 1} of {steps}")
    chain = sampler.get_chain(discard=round(_BURN_IN * steps), flat=True)
    return np.asarray(chain, dtype=float), QUADRATIC_POSTERIOR if simulated else EXACT_POSTERIOR


def _quadratic_likelihood(solution: Solution) -> Callable[[FloatArray], FloatArray]:
    """Log likelihood as a function of places (n, p), from residuals to second order about the optimum."""
    optimum = solution.optimum
    lower, upper = bounds_of(solution.problem.parameters)
    jacobian, second = optimum.jacobian, optimum.second
    assert jacobian is not None and second is not None
    widening = solution.widening

    def log_probability(places: FloatArray) -> FloatArray:
        away = places - optimum.place
        residuals = optimum.residuals + away @ jacobian.T + 0.5 * away**2 @ second.T
        inside = np.all((places >= lower) & (places <= upper), axis=1)
        return np.where(inside, -0.5 * np.sum(residuals**2, axis=1) / widening**2, -np.inf)

    return log_probability


def _exact_likelihood(solution: Solution) -> Callable[[FloatArray], FloatArray]:
    """Log likelihood as a function of places (n, p), from the residuals computed at each."""
    lower, upper = bounds_of(solution.problem.parameters)
    widening = solution.widening

    def log_probability(places: FloatArray) -> FloatArray:
        inside = np.all((places >= lower) & (places <= upper), axis=1)
        log_probabilities = np.full(len(places), -np.inf)
        residual_sets = solution.problem.residuals(list(places[inside]))
        log_probabilities[inside] = [
            -np.inf if residuals is None else -0.5 * float(residuals @ residuals) / widening**2
            for residuals in residual_sets
        ]
        return log_probabilities

    return log_probability


FEWEST: Final = 40
"""Minimum number of resamples: the ends of a 95 % interval are then the smallest and the largest of them."""
MOST_STEPS: Final = 4
"""Maximum number of Gauss-Newton steps of a resample."""
SETTLED: Final = 0.1
"""A resample's search ends after a step that moves the residuals by fewer standard deviations of one residual."""
AT_ONCE: Final = 32
"""Number of resamples that are simulated in one batch."""


@dataclass(slots=True)
class _Resample:
    """One resample: its residuals at the best place, the current place of its search, its best place and cost."""

    drawn: FloatArray
    place: FloatArray
    best: FloatArray
    cost: float = np.inf
    ended: bool = False


def require_bootstrap(resamples: int, method: str) -> None:
    """Reject too few resamples, and a method other than refit and linear."""
    if method not in ("refit", "linear"):
        raise ParameterError("Unknown bootstrap method {value!r}. Allowed: refit, linear").tag(
            "unknown_bootstrap", value=method
        )
    if resamples != 0 and resamples < FEWEST:
        raise ParameterError(
            "{resamples} resamples are too few for 95 % intervals: at least {fewest} are needed, some hundred are "
            "recommended"
        ).tag("too_few_resamples", resamples=resamples, fewest=FEWEST)


def add_bootstrap_intervals(identification: Identification, solution: Solution, plan: SearchRequest) -> Identification:
    """Add bootstrap intervals: resample blocks of residuals and refit each resample.

    The length of a block is the cube root of that of its series, at least 3, so correlated noise stays correlated.
    A resample's search begins at the minimum of the linearised model and continues with Gauss-Newton steps and
    separate simulations; derivatives are those of the best place, with their change along each parameter. With
    "linear" it ends at the start: this needs no simulation and ignores all nonlinearity.
    """
    if solution.optimum.jacobian is None or solution.degrees_of_freedom < 1:
        return identification
    samples = [_Resample(drawn, place, place) for drawn, place in _begin(solution, plan)]
    lost = 0
    if plan.bootstrap_by == "refit":
        plan.progress("bootstrap: first resamples")
        _refit_samples(solution, samples, plan.progress)
        lost = sum(not np.isfinite(sample.cost) for sample in samples)
        samples = [sample for sample in samples if np.isfinite(sample.cost)]
    if lost:
        warning = Message(
            "{lost} of {resamples} resamples of the bootstrap could not be computed",
            lost=lost,
            resamples=plan.bootstrap,
        )
        identification = replace(identification, warnings=(*identification.warnings, warning))
    if len(samples) < FEWEST:
        return identification
    values = values_at(solution, np.array([sample.best for sample in samples]))
    parameters = tuple(
        parameter
        if parameter.standard_error is None
        else replace(parameter, bootstrap_interval=(float(low), float(high)))
        for parameter, (low, high) in zip(identification.parameters, percentile_interval(values), strict=True)
    )
    how = Message("refitted")
    if plan.bootstrap_by == "linear":
        how = Message("fitted by the model linearised at the best values")
    method = Message(
        "bootstrap: {n_samples} resamples of stretches of residuals, each {how}", n_samples=len(samples), how=how
    )
    methods = (*identification.methods, method)
    return replace(identification, bootstrap=values, parameters=parameters, methods=methods)


def _begin(solution: Solution, plan: SearchRequest) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Residuals of each resample at the best place, and the minimum of its linearised model inside the bounds."""
    fitted, jacobian = solution.optimum.residuals, solution.optimum.jacobian
    assert jacobian is not None
    data = sum(solution.problem.lengths)
    series = [length for observation in solution.problem.observations for length in observation.series]
    inflated = np.sqrt(data / max(solution.degrees_of_freedom, 1))
    lower, upper = bounds_of(solution.problem.parameters)
    best = solution.optimum.place
    for _ in range(plan.bootstrap):
        drawn = np.zeros_like(fitted)
        drawn[:data] = inflated * _resample(fitted[:data], series, plan.rng)
        drawn[data:] = plan.rng.standard_normal(len(fitted) - data)
        yield drawn, best + step_inside(jacobian, drawn, lower - best, upper - best)


def _resample(residuals: FloatArray, series: list[int], rng: np.random.Generator) -> FloatArray:
    """Residuals resampled in blocks, series by series, each without its mean."""
    parts, first = [], 0
    for length in series:
        part = residuals[first : first + length] - float(np.mean(residuals[first : first + length]))
        first += length
        stretch = min(length, max(3, round(length ** (1.0 / 3.0))))
        begin = rng.integers(0, length, size=-(-length // stretch))
        places = (begin[:, None] + np.arange(stretch)).ravel()[:length] % length  # circular: all points equally often
        parts.append(part[places])
    return np.concatenate(parts)


def _refit_samples(solution: Solution, samples: list[_Resample], progress: Progress) -> None:
    """Refit all samples; those of one batch take their steps together, so all processes have work."""
    compute = best_fit_residuals(solution)
    for first in range(0, len(samples), AT_ONCE):
        batch = samples[first : first + AT_ONCE]
        for _ in range(MOST_STEPS):
            active = [sample for sample in batch if not sample.ended]
            if not active:
                break
            for sample, residuals in zip(active, compute([sample.place for sample in active]), strict=True):
                _step(solution, sample, residuals)
        progress(f"bootstrap: {min(first + AT_ONCE, len(samples))} of {len(samples)} resamples")


def _step(solution: Solution, sample: _Resample, residuals: FloatArray | None) -> None:
    """Evaluate a sample's residuals and take its next step; end its search if it no longer improves or moves."""
    optimum = solution.optimum
    if residuals is None:
        sample.ended = True
        return
    own = residuals - optimum.residuals + sample.drawn
    cost = float(own @ own)
    if cost >= sample.cost:
        sample.ended = True
        return
    sample.best, sample.cost = sample.place, cost
    jacobian = optimum.jacobian
    assert jacobian is not None
    if optimum.second is not None:
        jacobian = jacobian + optimum.second * (sample.place - optimum.place)
    lower, upper = bounds_of(solution.problem.parameters)
    step = step_inside(jacobian, own, lower - sample.place, upper - sample.place)
    sample.place = np.clip(sample.place + step, lower, upper)
    if float(np.linalg.norm(jacobian @ step)) <= min(SETTLED, solution.options.tolerance):
        sample.best, sample.ended = sample.place, True
