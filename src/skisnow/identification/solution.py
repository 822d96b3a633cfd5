"""Result of a search: values, intervals, correlations, warnings and outcome."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

import numpy as np
from scipy.stats import chi2

from .._support.arrays import FloatArray
from .._support.messages import Message, template
from .parameter import bounds_of
from .problem import Problem
from .result import REASONS, Effort, Identification, Identified, Outcome
from .search import Progress, SearchOptions, SearchState
from .uncertainty import Uncertainty, correlation_warnings, linear_uncertainty, unknown_warnings

BootstrapBy: TypeAlias = Literal["refit", "linear"]

BOUND_DISTANCE: Final = 1e-6
"""Distance (sizes) from a bound that counts as on it."""
NOISE_MISMATCH_PROBABILITY: Final = 1e-3
"""Probability of the residuals, given the stated accuracy, below which the intervals are widened."""
REPORTED_CORRELATION: Final = 0.3
"""Smallest reported correlation of neighbouring residuals; it must also exceed three standard errors."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SearchRequest:
    """Options of an identification; see `identify`.

    starts: number of searches.
    profile, bootstrap, posterior: requested intervals, with the numbers of resamples and samples.
    bootstrap_by: method of the bootstrap.
    progress: called with the current step.
    warnings, methods: warnings and sentences on methods from before the search.
    """

    title: str
    starts: int
    profile: bool
    bootstrap: int
    posterior: int
    rng: np.random.Generator
    progress: Progress
    bootstrap_by: BootstrapBy = "refit"
    warnings: tuple[Message, ...] = ()
    methods: tuple[Message, ...] = ()


@dataclass(frozen=True, slots=True)
class Solution:
    """The best place of a problem; residuals and derivatives in standard deviations of the data.

    optimum: place, residuals, derivatives and outcome of the search.
    tried: starts, and the sum of squares that each led to.
    methods: sentences on how it was computed.
    """

    problem: Problem
    optimum: SearchState
    tried: tuple[tuple[FloatArray, float | None], ...]
    methods: tuple[Message, ...]
    options: SearchOptions

    @property
    def degrees_of_freedom(self) -> int:
        """Residuals and priors less parameters and nuisances."""
        return len(self.optimum.residuals) - len(self.problem.parameters) - self.problem.nuisances

    @property
    def widening(self) -> float:
        """Factor by which intervals are widened: √(χ² per degree of freedom) if significantly above 1, otherwise 1."""
        dof = self.degrees_of_freedom
        if not self.problem.accuracy_is_stated or dof < 1:
            return 1.0
        agrees = chi2.sf(self.optimum.cost, dof) > NOISE_MISMATCH_PROBABILITY
        return 1.0 if agrees else float(np.sqrt(self.optimum.cost / dof))

    @property
    def estimates_noise(self) -> bool:
        """True if the noise is estimated from the residuals."""
        return not self.problem.accuracy_is_stated or self.widening > 1.0

    def uncertainty(self) -> Uncertainty | None:
        """Uncertainty of the parameters; None without derivatives."""
        if self.optimum.jacobian is None:
            return None
        dof = float(self.degrees_of_freedom) if self.estimates_noise else None
        return linear_uncertainty(self.optimum.jacobian / self.widening, degrees_of_freedom=dof)


def build_identification(solution: Solution, plan: SearchRequest) -> Identification:
    """Build the result from a solution, with the warnings and methods from before the search."""
    problem, optimum = solution.problem, solution.optimum
    values = problem.values(optimum.place)
    uncertainty = solution.uncertainty()
    outcome: Outcome = optimum.state
    if outcome != "interrupted" and uncertainty is not None and uncertainty.unknown.any():
        outcome = "not_identifiable"
    observed = () if outcome == "interrupted" else problem.observations
    p = len(problem.parameters)
    slope = np.array([parameter.slope(values[parameter.key]) for parameter in problem.parameters])
    correlation = covariance = np.full((p, p), np.nan)
    if uncertainty is not None:
        correlation = uncertainty.correlation
        with np.errstate(invalid="ignore"):
            covariance = uncertainty.covariance * slope[:, None] * slope[None, :]
    return Identification(
        outcome=outcome,
        reason=REASONS[outcome],
        scenario=plan.title,
        parameters=tuple(_identified_parameters(solution, uncertainty)),
        correlation=correlation,
        covariance=covariance,
        noise=tuple(noise * solution.widening for noise in problem.noise),
        accuracy_is_stated=problem.accuracy_is_stated,
        points=problem.points,
        degrees_of_freedom=solution.degrees_of_freedom,
        warnings=(
            *plan.warnings,
            *_result_warnings(solution, uncertainty),
            *(warning for observation in observed for warning in observation.warnings(values)),
        ),
        methods=(*plan.methods, *solution.methods, *_interval_methods(solution)),
        fits=tuple(fit for observation in observed for fit in observation.fits(values)),
        starts=solution.tried,
        effort=Effort(rounds=optimum.rounds),
    )


_TOO_FEW: Final = {
    (False, True): template(
        "{points} points are too few for {parameters} parameters: at least {needed} are needed, and ten or more are "
        "worth having. Free fewer parameters, measure more, or give priors"
    ),
    (True, True): template(
        "{points} points are too few for {parameters} parameters and {clocks} clocks: at least {needed} are needed, "
        "and ten or more are worth having. Free fewer parameters, measure more, or give priors"
    ),
    (False, False): template(
        "{points} points are too few for {parameters} parameters: at least {needed} are needed, one of them for the "
        "noise, which is not stated, and ten or more are worth having. Free fewer parameters, measure more, or give "
        "priors"
    ),
    (True, False): template(
        "{points} points are too few for {parameters} parameters and {clocks} clocks: at least {needed} are needed, "
        "one of them for the noise, which is not stated, and ten or more are worth having. Free fewer parameters, "
        "measure more, or give priors"
    ),
}
"""Warning of too few points: with free clocks or without, with stated noise or without."""


def too_few_points(problem: Problem, plan: SearchRequest) -> Identification:
    """Result without estimates: fewer points than free parameters."""
    p = len(problem.parameters)
    needed = p + problem.nuisances + (not problem.accuracy_is_stated)
    sentence = _TOO_FEW[problem.nuisances > 0, problem.accuracy_is_stated]
    warning = Message(sentence, points=problem.points, parameters=p, clocks=problem.nuisances, needed=needed)
    return Identification(
        outcome="too_few_points",
        reason=REASONS["too_few_points"],
        scenario=plan.title,
        parameters=tuple(Identified(parameter=parameter, identifiable=False) for parameter in problem.parameters),
        correlation=np.full((p, p), np.nan),
        covariance=np.full((p, p), np.nan),
        accuracy_is_stated=problem.accuracy_is_stated,
        points=problem.points,
        degrees_of_freedom=problem.points - p - problem.nuisances,
        warnings=(*plan.warnings, warning),
    )


def _identified_parameters(solution: Solution, spread: Uncertainty | None) -> Iterator[Identified]:
    """Estimates with standard errors and 95 % intervals, which end at the bounds; None without a spread."""
    problem, place = solution.problem, solution.optimum.place
    lower, upper = bounds_of(problem.parameters)
    for j, parameter in enumerate(problem.parameters):
        value = parameter.value(float(place[j]))
        at_bound = bool(min(place[j] - lower[j], upper[j] - place[j]) <= BOUND_DISTANCE)
        error = None if spread is None else float(spread.standard_errors[j])
        if error is None or spread is None or not np.isfinite(error):
            yield Identified(parameter=parameter, value=value, at_bound=at_bound, identifiable=spread is None)
            continue
        half = spread.factor * error
        low, high = np.clip([place[j] - half, place[j] + half], lower[j], upper[j]).tolist()
        yield Identified(
            parameter=parameter,
            value=value,
            standard_error=error * parameter.slope(value),
            interval=(parameter.value(low), parameter.value(high)),
            at_bound=at_bound,
            identifiable=not bool(spread.unknown[j]),
        )


def _result_warnings(solution: Solution, spread: Uncertainty | None) -> Iterator[Message]:
    """Warnings of few data, unknown or correlated parameters, bounds, an unfinished search and bad residuals."""
    parameters, points = solution.problem.parameters, solution.problem.points
    if points < max(10, 3 * len(parameters)):
        yield Message(
            "{points} points for {parameters} parameters are few: one bad point decides, and how well the model fits "
            "cannot be seen. Ten or more are worth having",
            points=points,
            parameters=len(parameters),
        )
    if spread is not None:
        yield from unknown_warnings(parameters, spread)
        yield from correlation_warnings(parameters, spread.correlation)
    for identified in _identified_parameters(solution, spread):
        if identified.at_bound:
            bounded = identified.parameter
            bounds = Message("{lower:g} to {upper:g}", lower=bounded.lower, upper=bounded.upper)
            yield Message(
                "{name} sits on its bound ({bounds}): its interval by curvature does not hold there; --profile gives "
                "one that does",
                name=bounded.name,
                bounds=Message("{number} {unit}", number=bounds, unit=bounded.unit) if bounded.unit else bounds,
            )
    if solution.optimum.state == "interrupted":
        yield Message("the search had not ended: intervals and correlations are those of a place on the way")
        return
    if solution.widening > 1.0:
        yield Message(
            "the residuals are {ratio:.2g} times the stated accuracy of the data: the accuracy is too optimistic, or "
            "the model is incomplete. Intervals are widened by that factor",
            ratio=solution.widening,
        )
    correlation = _neighbour_correlation(solution)
    if correlation is not None:
        yield Message(
            "neighbouring residuals are alike (correlation {correlation:.2f}): the model misses something, or the "
            "noise wanders, and the intervals by curvature are too narrow; --bootstrap resamples stretches of "
            "residuals",
            correlation=correlation,
        )
    yield from _multistart_warnings(solution)


def _neighbour_correlation(solution: Solution) -> float | None:
    """Correlation of neighbouring residuals; None unless it is significant."""
    products = squares = pairs = 0.0
    first = 0
    for observation in solution.problem.observations:
        for length in observation.series:
            part = solution.optimum.residuals[first : first + length]
            first += length
            products += float(part[1:] @ part[:-1])
            squares += float(part @ part) * (length - 1) / max(length, 1)
            pairs += length - 1
    if pairs < 10 or squares == 0.0:
        return None
    correlation = products / squares
    return correlation if correlation > max(REPORTED_CORRELATION, 3.0 / np.sqrt(pairs)) else None


def _multistart_warnings(solution: Solution) -> Iterator[Message]:
    """Warnings of failed starts, and of searches that ended in a worse minimum."""
    costs = [cost for _, cost in solution.tried if cost is not None]
    missing = len(solution.tried) - len(costs)
    if missing:
        yield Message("{missing} of {starts} starts could not be computed", missing=missing, starts=len(solution.tried))
    if len(costs) < 2:
        return
    dof = max(solution.degrees_of_freedom, 1)
    unit = 1.0 if solution.problem.accuracy_is_stated else min(costs) / dof
    apart = sum(cost - min(costs) > 4.0 * unit for cost in costs)
    if apart:
        yield Message(
            "{apart} of {searches} searches ended elsewhere, with a worse fit: there are several minima; look at the "
            "best values with care, or try more starts",
            apart=apart,
            searches=len(costs),
        )


def _interval_methods(solution: Solution) -> Iterator[Message]:
    """Sentences about how the intervals were computed; none without derivatives."""
    if solution.optimum.jacobian is None:
        return
    law = Message("the normal distribution")
    if solution.estimates_noise:
        law = Message("Student's t with the noise that the residuals show")
    stated = Message("stated by the data") if solution.problem.accuracy_is_stated else Message("estimated")
    yield Message(
        "95 % intervals from the curvature of the sum of squares, by {law}; accuracy {stated}", law=law, stated=stated
    )
    if len(solution.tried) > 1:
        yield Message("{starts} starts", starts=len(solution.tried))


def best_fit_residuals(solution: Solution) -> Callable[[Sequence[FloatArray]], list[FloatArray | None]]:
    """Residuals of the search, corrected by a constant so that they equal the final residuals at the best place."""
    problem, optimum = solution.problem, solution.optimum
    quick = problem.residuals([optimum.place])[0]
    correction = np.zeros_like(optimum.residuals) if quick is None else optimum.residuals - quick

    def residuals(places: Sequence[FloatArray]) -> list[FloatArray | None]:
        return [None if residual is None else residual + correction for residual in problem.residuals(places)]

    return residuals


def values_at(solution: Solution, places: FloatArray) -> FloatArray:
    """Values (N, p) in the keys' units at places (N, p) of the search."""
    parameters = solution.problem.parameters
    return np.array(
        [[parameter.value(float(u)) for parameter, u in zip(parameters, row, strict=True)] for row in places]
    )
