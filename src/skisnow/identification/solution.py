"""Result of a search: values, intervals, correlations, warnings and outcome."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy.stats import chi2

from .parameter import Parameter, bounds_of
from .problem import Problem
from .result import REASONS, Effort, Identification, Identified, Interval, Outcome
from .search import SearchOptions, SearchState
from .uncertainty import (
    Uncertainty,
    bound_warnings,
    correlation_warnings,
    few_points,
    model_warning,
    noise_warning,
    uncertainty,
    unknown_warnings,
)

FloatArray = npt.NDArray[np.float64]

ON_BOUND: Final = 1e-6
"""Distance (sizes) from a bound that counts as on it."""
SURE: Final = 1e-3
"""Probability below which residuals are not those of the stated accuracy."""
ALIKE: Final = 0.3
"""Correlation of neighbouring residuals from which on it is reported, where it is also beyond three standard errors."""


@dataclass(frozen=True, slots=True)
class Solution:
    """The best place of a problem; residuals and derivatives in standard deviations of the data.

    Attributes
    ----------
    problem
        With its noise.
    found
        Place, residuals, derivatives, state.
    tried
        Starts, and the sum of squares that each led to.
    methods
        How it was computed, in words.
    options
        Of the search.
    """

    problem: Problem
    found: SearchState
    tried: tuple[tuple[FloatArray, float | None], ...]
    methods: tuple[str, ...]
    options: SearchOptions

    @property
    def degrees_of_freedom(self) -> int:
        """Residuals and priors less parameters and nuisances."""
        return len(self.found.residuals) - len(self.problem.parameters) - self.problem.nuisances

    @property
    def widening(self) -> float:
        """By how much the stated accuracy is too small: the root of χ² per degree of freedom, beyond chance."""
        dof = self.degrees_of_freedom
        if not self.problem.accuracy_is_stated or dof < 1 or chi2.sf(self.found.cost, dof) > SURE:
            return 1.0
        return float(np.sqrt(self.found.cost / dof))

    @property
    def estimates_noise(self) -> bool:
        """Whether the noise is known from the residuals alone."""
        return not self.problem.accuracy_is_stated or self.widening > 1.0

    def known(self) -> Uncertainty | None:
        """How well the parameters are known; None before there are derivatives."""
        if self.found.jacobian is None:
            return None
        dof = float(self.degrees_of_freedom) if self.estimates_noise else None
        return uncertainty(self.found.jacobian / self.widening, degrees_of_freedom=dof)


def identification_of(
    solution: Solution, title: str, warnings: tuple[str, ...], methods: tuple[str, ...]
) -> Identification:
    """Put everything together."""
    problem, found = solution.problem, solution.found
    values = problem.values(found.place)
    known = solution.known()
    interrupted = found.state == "interrupted"
    observed = () if interrupted else problem.observations
    outcome = _outcome(found, known)
    p = len(problem.parameters)
    slope = np.array([parameter.slope(values[parameter.key]) for parameter in problem.parameters])
    with np.errstate(invalid="ignore"):
        covariance = np.full((p, p), np.nan) if known is None else known.covariance * slope[:, None] * slope[None, :]
    return Identification(
        outcome=outcome,
        reason=REASONS[outcome],
        scenario=title,
        parameters=tuple(_identified(solution, known)),
        correlation=np.full((p, p), np.nan) if known is None else known.correlation,
        covariance=covariance,
        noise=tuple(noise * solution.widening for noise in problem.noise),
        accuracy_is_stated=problem.accuracy_is_stated,
        points=problem.points,
        degrees_of_freedom=solution.degrees_of_freedom,
        warnings=(*warnings, *_warned(solution, known), *(w for each in observed for w in each.warnings(values))),
        methods=(*methods, *solution.methods, *_interval_words(solution)),
        fits=tuple(fit for each in observed for fit in each.fits(values)),
        starts=solution.tried,
        effort=Effort(rounds=found.rounds),
    )


def too_few(problem: Problem, title: str, warnings: tuple[str, ...]) -> Identification:
    """Nothing identified: fewer points than what is looked for."""
    p = len(problem.parameters)
    needed = p + problem.nuisances + (not problem.accuracy_is_stated)
    warning = (
        f"{problem.points} points are too few for {p} parameters"
        f"{f' and {problem.nuisances} clocks' if problem.nuisances else ''}: at least {needed} are needed"
        f"{'' if problem.accuracy_is_stated else ', one of them for the noise, which is not stated'}, and ten or more "
        "are worth having. Free fewer parameters, measure more, or give priors"
    )
    return Identification(
        outcome="too_few_points",
        reason=REASONS["too_few_points"],
        scenario=title,
        parameters=tuple(Identified(parameter=parameter, identifiable=False) for parameter in problem.parameters),
        correlation=np.full((p, p), np.nan),
        covariance=np.full((p, p), np.nan),
        accuracy_is_stated=problem.accuracy_is_stated,
        points=problem.points,
        degrees_of_freedom=problem.points - p - problem.nuisances,
        warnings=(*warnings, warning),
    )


def interval_of(parameter: Parameter, place: float, half: float) -> Interval:
    """The interval of a place plus and minus half a width, in sizes, as values inside the bounds."""
    lower, upper = bounds_of((parameter,))
    ends = np.clip([place - half, place + half], lower[0], upper[0])
    return parameter.value(float(ends[0])), parameter.value(float(ends[1]))


def _outcome(state: SearchState, spread: Uncertainty | None) -> Outcome:
    if state.state == "interrupted":
        return "interrupted"
    if spread is not None and spread.unknown.any():
        return "not_identifiable"
    return state.state


def _identified(solution: Solution, spread: Uncertainty | None) -> Iterator[Identified]:
    problem, place = solution.problem, solution.found.place
    lower, upper = bounds_of(problem.parameters)
    for j, parameter in enumerate(problem.parameters):
        value = parameter.value(float(place[j]))
        at_bound = bool(min(place[j] - lower[j], upper[j] - place[j]) <= ON_BOUND)
        error = None if spread is None else float(spread.standard_errors[j])
        if error is None or spread is None or not np.isfinite(error):
            yield Identified(parameter=parameter, value=value, at_bound=at_bound, identifiable=spread is None)
            continue
        yield Identified(
            parameter=parameter,
            value=value,
            standard_error=error * parameter.slope(value),
            interval=interval_of(parameter, float(place[j]), spread.factor * error),
            at_bound=at_bound,
            identifiable=not bool(spread.unknown[j]),
        )


def _warned(solution: Solution, spread: Uncertainty | None) -> Iterator[str]:
    parameters = solution.problem.parameters
    few = few_points(solution.problem.points, len(parameters))
    if few:
        yield few
    if spread is not None:
        yield from unknown_warnings(parameters, spread)
        yield from correlation_warnings(parameters, spread.correlation)
    yield from bound_warnings(parameters, [each.at_bound for each in _identified(solution, spread)])
    if solution.found.state == "interrupted":
        yield "the search had not ended: intervals and correlations are those of a place on the way"
        return
    if solution.widening > 1.0:
        yield noise_warning(solution.widening)
    alike = _likeness(solution)
    if alike is not None:
        yield model_warning(alike)
    yield from _starts_apart(solution)


def _likeness(solution: Solution) -> float | None:
    """Correlation of neighbouring residuals, where it is too large for chance."""
    products = squares = pairs = 0.0
    first = 0
    for observation in solution.problem.observations:
        for length in observation.series if observation.kind != "marks" else ():
            part = solution.found.residuals[first : first + length]
            first += length
            products += float(part[1:] @ part[:-1])
            squares += float(part @ part) * (length - 1) / max(length, 1)
            pairs += length - 1
        first += sum(observation.series) if observation.kind == "marks" else 0
    if pairs < 10 or squares == 0.0:
        return None
    alike = products / squares
    return alike if alike > max(ALIKE, 3.0 / np.sqrt(pairs)) else None


def _starts_apart(solution: Solution) -> Iterator[str]:
    costs = [cost for _, cost in solution.tried if cost is not None]
    missing = len(solution.tried) - len(costs)
    if missing:
        yield f"{missing} of {len(solution.tried)} starts could not be computed"
    if len(costs) < 2:
        return
    dof = max(solution.degrees_of_freedom, 1)
    unit = 1.0 if solution.problem.accuracy_is_stated else min(costs) / dof
    apart = sum(cost - min(costs) > 4.0 * unit for cost in costs)
    if apart:
        yield (
            f"{apart} of {len(costs)} searches ended elsewhere, with a worse fit: there are several minima; look at "
            "the best values with care, or try more starts"
        )


def _interval_words(solution: Solution) -> Iterator[str]:
    if solution.found.jacobian is None:
        return
    law = (
        "Student's t with the noise that the residuals show" if solution.estimates_noise else "the normal distribution"
    )
    stated = "stated by the data" if solution.problem.accuracy_is_stated else "estimated"
    yield f"95 % intervals from the curvature of the sum of squares, by {law}; accuracy {stated}"
    several = len(solution.tried)
    if several > 1:
        yield f"{several} starts"


def residuals_about_best(solution: Solution) -> Callable[[Sequence[FloatArray]], list[FloatArray | None]]:
    """Those of the search, moved so that at the best place they are those of the answer."""
    problem, found = solution.problem, solution.found
    quick = problem.residuals([found.place])[0]
    apart = np.zeros_like(found.residuals) if quick is None else found.residuals - quick

    def residuals(places: Sequence[FloatArray]) -> list[FloatArray | None]:
        return [None if residual is None else residual + apart for residual in problem.residuals(places)]

    return residuals


def samples_in_values(solution: Solution, places: FloatArray) -> FloatArray:
    """Places (N, p) of the search as values (N, p) in the keys' units."""
    parameters = solution.problem.parameters
    return np.array(
        [[parameter.value(float(u)) for parameter, u in zip(parameters, row, strict=True)] for row in places]
    )
