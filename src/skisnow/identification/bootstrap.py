"""Intervals by resampled residuals: each sample refitted with its own simulations, or by the linearised model."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Final, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from .._support.errors import ParameterError
from ..statistics import percentile_interval
from .parameter import bounds_of
from .result import Identification
from .search import step_inside
from .solution import Solution, residuals_about_best, samples_in_values

FloatArray = npt.NDArray[np.float64]
Progress: TypeAlias = Callable[[str], None]
BootstrapBy: TypeAlias = Literal["refit", "linear"]

FEWEST: Final = 40
"""Resamples: the ends of a 95 % interval are the first and the last of so many."""
MOST_STEPS: Final = 4
"""Gauss-Newton steps of a resample."""
SETTLED: Final = 0.1
"""A step that moves the residuals by less than so many standard deviations of one is the last (assumption)."""
AT_ONCE: Final = 32
"""Resamples whose runs are asked together."""


@dataclass(slots=True)
class _Sample:
    """One resample: what its residuals are at the best place, where its search is, and its least so far."""

    drawn: FloatArray
    place: FloatArray
    best: FloatArray
    cost: float = np.inf
    ended: bool = False


def require_bootstrap(resamples: int, by: str) -> None:
    """Refuse numbers and words that are none.

    Raises
    ------
    ParameterError
        Fewer than `FEWEST` resamples but not 0, or an unknown way.
    """
    if by not in ("refit", "linear"):
        raise ParameterError(f"a bootstrap goes by refit or linear, not by {by!r}")
    if resamples != 0 and resamples < FEWEST:
        raise ParameterError(
            f"{resamples} resamples are too few for 95 % intervals: at least {FEWEST} are needed, and some hundred are "
            "worth having"
        )


def bootstrapped(
    identification: Identification,
    solution: Solution,
    resamples: int,
    by: BootstrapBy,
    rng: np.random.Generator,
    progress: Progress,
) -> Identification:
    """Resample stretches of residuals and refit each sample.

    Notes
    -----
    Stretches have the length of the cube root of a series, 3 at least: noise that wanders keeps its nature. A sample's
    search begins where the linearised model has its least, and goes on by Gauss-Newton steps with simulations of its
    own; derivatives are those of the best place with their change along each parameter. By "linear" it ends where it
    began: no simulation, and blind to what is not linear.
    """
    if solution.found.jacobian is None or solution.degrees_of_freedom < 1:
        return identification
    samples = [_Sample(drawn, place, place) for drawn, place in _begun(solution, resamples, rng)]
    lost = 0
    if by == "refit":
        progress("bootstrap: first resamples")
        _refitted(solution, samples, progress)
        lost = sum(not np.isfinite(sample.cost) for sample in samples)
        samples = [sample for sample in samples if np.isfinite(sample.cost)]
    warnings = (f"{lost} of {resamples} resamples of the bootstrap could not be computed",) if lost else ()
    if len(samples) < FEWEST:
        return replace(identification, warnings=(*identification.warnings, *warnings))
    values = samples_in_values(solution, np.array([sample.best for sample in samples]))
    parameters = tuple(
        parameter
        if parameter.standard_error is None
        else replace(parameter, bootstrap_interval=(float(low), float(high)))
        for parameter, (low, high) in zip(identification.parameters, percentile_interval(values), strict=True)
    )
    how = "refitted" if by == "refit" else "fitted by the model linearised at the best values"
    method = f"bootstrap: {len(samples)} resamples of stretches of residuals, each {how}"
    return replace(
        identification,
        bootstrap=values,
        parameters=parameters,
        warnings=(*identification.warnings, *warnings),
        methods=(*identification.methods, method),
    )


def _begun(solution: Solution, resamples: int, rng: np.random.Generator) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Residuals of each sample at the best place, and where the linearised model has its least inside the bounds."""
    fitted, jacobian = solution.found.residuals, solution.found.jacobian
    assert jacobian is not None
    data = sum(solution.problem.lengths)
    series = [length for observation in solution.problem.observations for length in observation.series]
    inflated = np.sqrt(data / max(solution.degrees_of_freedom, 1))
    lower, upper = bounds_of(solution.problem.parameters)
    best = solution.found.place
    for _ in range(resamples):
        drawn = np.zeros_like(fitted)
        drawn[:data] = inflated * _resampled(fitted[:data], series, rng)
        drawn[data:] = rng.standard_normal(len(fitted) - data)
        yield drawn, best + step_inside(jacobian, drawn, lower - best, upper - best)


def _resampled(residuals: FloatArray, series: list[int], rng: np.random.Generator) -> FloatArray:
    """Each series put together again from stretches of it, its mean taken away."""
    parts, first = [], 0
    for length in series:
        part = residuals[first : first + length] - float(np.mean(residuals[first : first + length]))
        first += length
        stretch = min(length, max(3, round(length ** (1.0 / 3.0))))
        begin = rng.integers(0, length, size=-(-length // stretch))
        places = (begin[:, None] + np.arange(stretch)).ravel()[:length] % length  # circular: all points equally often
        parts.append(part[places])
    return np.concatenate(parts)


def _refitted(solution: Solution, samples: list[_Sample], progress: Progress) -> None:
    """Search on for each sample; those of one batch take their steps together, so that all processes have work."""
    ask = residuals_about_best(solution)
    for first in range(0, len(samples), AT_ONCE):
        batch = samples[first : first + AT_ONCE]
        for _ in range(MOST_STEPS):
            going = [each for each in batch if not each.ended]
            if not going:
                break
            for each, residuals in zip(going, ask([each.place for each in going]), strict=True):
                _step(solution, each, residuals)
        progress(f"bootstrap: {min(first + AT_ONCE, len(samples))} of {len(samples)} resamples")


def _step(solution: Solution, sample: _Sample, residuals: FloatArray | None) -> None:
    """Take note of the residuals where a sample is, and move it, until it no longer improves, or hardly moves."""
    found = solution.found
    if residuals is None:
        sample.ended = True
        return
    own = residuals - found.residuals + sample.drawn
    cost = float(own @ own)
    if cost >= sample.cost:
        sample.ended = True
        return
    sample.best, sample.cost = sample.place, cost
    jacobian = found.jacobian
    assert jacobian is not None
    if found.second is not None:
        jacobian = jacobian + found.second * (sample.place - found.place)
    lower, upper = bounds_of(solution.problem.parameters)
    step = step_inside(jacobian, own, lower - sample.place, upper - sample.place)
    sample.place = np.clip(sample.place + step, lower, upper)
    if float(np.linalg.norm(jacobian @ step)) <= min(SETTLED, solution.options.tolerance):
        sample.best, sample.ended = sample.place, True
