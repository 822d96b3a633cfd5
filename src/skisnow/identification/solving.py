"""Search, noise, polish: from a problem to its best place, with derivatives in standard deviations of the data."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np
import numpy.typing as npt

from .._support.errors import FitError, ParameterError
from .bootstrap import BootstrapBy, bootstrapped
from .intervals import profiled, with_posterior
from .parameter import bounds_of
from .problem import Problem
from .result import Identification
from .search import FINE, Search, SearchOptions, SearchState
from .solution import Solution, identification_of

FloatArray = npt.NDArray[np.float64]
Progress = Callable[[str], None]

OF_GROOVES: Final = replace(
    FINE, smallest_step=0.005, largest_step=0.005, tolerance=1e-3, worth=1e-6, rough=0.05, smallest_move=1e-6
)
"""For equilibria, which are found to some digits."""
_NOISE_ROUNDS: Final = 3
_SAME_NOISE: Final = 0.05
_STEPS_APART: Final = 3.0
"""Rms change of residuals (in standard deviations) by the finer solver from which on the search is repeated with it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Request:
    """What is wanted beside the best values.

    Attributes
    ----------
    title
        Of the scenario.
    starts
        Searches.
    profile, bootstrap, posterior
        Further intervals.
    bootstrap_by
        Whether each resample is refitted, or by the linearised model.
    rng
        Source of random numbers.
    progress
        Called with the current step.
    warnings, methods
        What is known before the search.
    """

    title: str
    starts: int
    profile: bool
    bootstrap: int
    posterior: int
    rng: np.random.Generator
    progress: Progress
    bootstrap_by: BootstrapBy = "refit"
    warnings: tuple[str, ...] = ()
    methods: tuple[str, ...] = ()


def solved(problem: Problem, plan: Request) -> Identification:
    """Search from every start, and go on from the best.

    Raises
    ------
    FitError
        Nothing can be computed at any start.
    """
    if plan.starts < 1:
        raise ParameterError(f"starts is {plan.starts}; at least 1 is needed")
    solution = solution_of(problem, plan)
    return with_further_intervals(identification_of(solution, plan.title, plan.warnings, plan.methods), solution, plan)


def with_further_intervals(identification: Identification, solution: Solution, plan: Request) -> Identification:
    """Profile, bootstrap and posterior, where they were asked for; Ctrl-C keeps those that are complete."""
    if identification.outcome == "interrupted":
        return identification
    try:
        if plan.profile:
            identification = profiled(identification, solution, plan.progress)
        if plan.bootstrap:
            identification = bootstrapped(
                identification, solution, plan.bootstrap, plan.bootstrap_by, plan.rng, plan.progress
            )
        if plan.posterior:
            identification = with_posterior(identification, solution, plan.posterior, plan.rng, plan.progress)
    except KeyboardInterrupt:
        warning = "what was asked beside the values was interrupted; values and intervals by curvature are complete"
        return replace(identification, outcome="interrupted", warnings=(*identification.warnings, warning))
    return identification


def solution_of(problem: Problem, plan: Request) -> Solution:
    """The best place, with derivatives in standard deviations of the data."""
    return _Solver(problem, plan).solution()


def options_of(problem: Problem) -> SearchOptions:
    """How to search: by the roughest of the data."""
    kinds = {observation.kind for observation in problem.observations}
    options = SearchOptions() if "track" in kinds else OF_GROOVES if "marks" in kinds else FINE
    return replace(options, accuracy_is_stated=problem.accuracy_is_stated)


@dataclass(slots=True)
class _Solver:
    problem: Problem
    plan: Request
    tried: list[tuple[FloatArray, float | None]] = field(default_factory=list)
    methods: list[str] = field(default_factory=list)

    def solution(self) -> Solution:
        best = self._best()
        if best.state != "interrupted":
            best = self._with_noise(best)
        if best.state != "interrupted" and self._has_tracks:
            best = self._polished(best)
        return self._weighed(best)

    @property
    def _has_tracks(self) -> bool:
        return any(observation.kind == "track" for observation in self.problem.observations)

    def _search(self, problem: Problem, about: str, *, final: bool = False) -> Search:
        lower, upper = bounds_of(problem.parameters)
        residuals = problem.final_residuals if final else problem.residuals
        return Search(residuals, lower, upper, options_of(problem), lambda text: self.plan.progress(f"{about}{text}"))

    def _best(self) -> SearchState:
        best: SearchState | None = None
        for number, start in enumerate(self._starts()):
            about = f"start {number + 1} of {self.plan.starts}: " if self.plan.starts > 1 else ""
            try:
                found = self._search(self.problem, about).run(start)
            except KeyboardInterrupt:
                if best is None:
                    raise
                return replace(best, state="interrupted")
            self.tried.append((start, None if found is None else found.cost))
            if found is not None and (best is None or found.cost < best.cost):
                best = found
            if found is not None and found.state == "interrupted":
                assert best is not None
                return replace(best, state="interrupted")
        if best is None:
            values = self.problem.values(np.zeros(len(self.problem.parameters)))
            warnings = "; ".join(
                text for observation in self.problem.observations for text in observation.warnings(values)
            )
            raise FitError(f"nothing can be computed at the start: {warnings or 'no residuals'}")
        return best

    def _starts(self) -> list[FloatArray]:
        """The given start, and others up to one size about it."""
        lower, upper = bounds_of(self.problem.parameters)
        p = len(lower)
        others = self.plan.rng.uniform(np.maximum(lower, -1.0), np.minimum(upper, 1.0), (self.plan.starts - 1, p))
        return [np.zeros(p), *others]

    def _with_noise(self, state: SearchState) -> SearchState:
        """Weigh priors, and data of several kinds, by the noise that the residuals show, until that stays."""
        problem = self.problem
        if problem.accuracy_is_stated or not (problem.priors or len(problem.observations) > 1):
            return state
        for _ in range(_NOISE_ROUNDS):
            renewed = problem.with_noise_of(state.residuals)
            if np.allclose(renewed.noise, problem.noise, rtol=_SAME_NOISE):
                break
            problem = renewed
            again = self._search(problem, "noise: ").run(state.place)
            if again is None or again.state == "interrupted":
                break
            state = again
        self.problem = problem
        return state

    def _polished(self, state: SearchState) -> SearchState:
        """The last steps with the scenario's own solver; all with it where the quick one was too far off."""
        self.plan.progress("last steps with the scenario's own solver")
        search = self._search(self.problem, "")
        quick = state.residuals
        try:
            polished = search.polished(state, self.problem.final_residuals)
            first = self.problem.final_residuals([state.place])[0]
            apart = 0.0 if first is None else float(np.sqrt(np.mean((first - quick) ** 2))) / search.noise(state)
            if apart > _STEPS_APART:
                self.methods.append(
                    "fixed steps of 1 ms were too long for this snow: searched again with the scenario's solver"
                )
                again = self._search(self.problem, "own solver: ", final=True).run(polished.place)
                return polished if again is None else again
        except KeyboardInterrupt:
            best = search.best if search.best is not None else state
            return replace(best, jacobian=state.jacobian, second=state.second, state="interrupted")
        self.methods.append(
            "searched with fixed steps of 1 ms (fast mode); last steps and answer with the scenario's own solver"
        )
        return polished

    def _weighed(self, state: SearchState) -> Solution:
        """Residuals and derivatives in standard deviations of the data, stated or seen."""
        problem = self.problem
        if not problem.accuracy_is_stated:
            seen = problem.with_noise_of(state.residuals)
            weight = seen.weights(problem)
            state = replace(
                state,
                residuals=state.residuals * weight,
                jacobian=None if state.jacobian is None else state.jacobian * weight[:, None],
                second=None if state.second is None else state.second * weight[:, None],
            )
            problem = seen
        return Solution(problem, state, tuple(self.tried), tuple(self.methods), options_of(problem))
