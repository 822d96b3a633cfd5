"""Solver of an identification: searches, estimate of the noise, and final steps with the scenario's solver."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import partial
from typing import Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import FitError, require_range
from .._support.messages import Message, template
from .intervals import add_bootstrap_intervals, add_posterior_intervals, add_profile_intervals
from .parameter import bounds_of
from .problem import Problem
from .result import Identification
from .search import CLOSED_FORM_SEARCH, Search, SearchOptions, SearchState
from .solution import SearchRequest, Solution, build_identification

_NOISE_ROUNDS: Final = 3
_SAME_NOISE: Final = 0.05
_LAST_TOLERANCE: Final = 0.2
"""`tolerance` of the search with the scenario's solver, which follows the quick one."""
_COMPARABLE: Final = 1.0
"""`tolerance` of a quick search whose sum of squares is compared with others or gives the noise."""
_STEPS_APART: Final = 3.0
"""The search is repeated with the scenario's solver if it changes the residuals by more standard deviations (rms)."""


def solve(problem: Problem, plan: SearchRequest) -> Identification:
    """Search from every start and compute the result at the best place."""
    require_range("starts", plan.starts, 1)
    solution = Solver(problem, plan).solution()
    identification = build_identification(solution, plan)
    if identification.outcome == "interrupted":
        return identification
    try:  # Ctrl-C keeps the further intervals that are complete
        if plan.profile:
            identification = add_profile_intervals(identification, solution, plan)
        if plan.bootstrap:
            identification = add_bootstrap_intervals(identification, solution, plan)
        if plan.posterior:
            identification = add_posterior_intervals(identification, solution, plan)
    except KeyboardInterrupt:
        warning = Message(
            "The requested further intervals were interrupted; values and intervals by curvature are complete"
        )
        return replace(identification, outcome="interrupted", warnings=(*identification.warnings, warning))
    return identification


def search_options(problem: Problem, plan: SearchRequest) -> SearchOptions:
    """Options of the search for the least accurate kind of data; bootstrap and posterior need second differences."""
    kinds = {observation.kind for observation in problem.observations}
    options = SearchOptions() if "track" in kinds else CLOSED_FORM_SEARCH
    central = options.central or plan.bootstrap > 0 or plan.posterior > 0
    return replace(options, accuracy_is_stated=problem.accuracy_is_stated, central=central)


@dataclass(slots=True)
class Solver:
    """Solves one problem; `tried` and `methods` record the starts and how the solution was computed."""

    problem: Problem
    plan: SearchRequest
    tried: list[tuple[FloatArray, float | None]] = field(default_factory=list)
    methods: list[Message] = field(default_factory=list)

    def solution(self) -> Solution:
        """The best place, with derivatives in standard deviations of the data."""
        best = self._search_best_start()
        if best.state != "interrupted":
            best = self._with_noise(best)
        if best.state != "interrupted" and self._has_tracks:
            best = self._polish(best)
        return self._weigh(best)

    @property
    def _has_tracks(self) -> bool:
        """True if any observation is a track."""
        return any(observation.kind == "track" for observation in self.problem.observations)

    def _make_search(self, problem: Problem, about: str, *, final: bool = False) -> Search:
        """Search of a problem; about: prefix of its progress; final: with the accurate solver and tolerance."""
        residuals, options = partial(problem.residuals, final=final), search_options(problem, self.plan)
        if final:
            options = replace(options, tolerance=_LAST_TOLERANCE)
        elif self._has_tracks and (self.plan.starts > 1 or not problem.accuracy_is_stated):
            options = replace(options, tolerance=_COMPARABLE)
        elif self._has_tracks:
            options = replace(options, renews=False)
        return Search(
            residuals, *bounds_of(problem.parameters), options, lambda text: self.plan.progress(f"{about}{text}")
        )

    def _search_best_start(self) -> SearchState:
        """Search from the given start and from random ones about it; the final state with the lowest cost."""
        lower, upper = bounds_of(self.problem.parameters)
        size = (self.plan.starts - 1, len(lower))
        others = self.plan.rng.uniform(np.maximum(lower, -1.0), np.minimum(upper, 1.0), size)  # up to one size off
        best: SearchState | None = None
        for number, start in enumerate([np.zeros(len(lower)), *others]):
            about = f"start {number + 1} of {self.plan.starts}: " if self.plan.starts > 1 else ""
            try:
                state = self._make_search(self.problem, about).run(start)
            except KeyboardInterrupt:
                if best is None:
                    raise
                return replace(best, state="interrupted")
            self.tried.append((start, None if state is None else state.cost))
            if state is not None and (best is None or state.cost < best.cost):
                best = state
            if state is not None and state.state == "interrupted":
                assert best is not None
                return replace(best, state="interrupted")
        if best is None:
            values = self.problem.values(np.zeros(len(self.problem.parameters)))
            warnings = [text for observation in self.problem.observations for text in observation.warnings(values)]
            sentence = template("nothing can be computed at the start: {warnings}")
            without = template("nothing can be computed at the start: no residuals")
            raise FitError(sentence if warnings else without).tag("no_residuals", warnings=warnings)
        return best

    def _with_noise(self, state: SearchState) -> SearchState:
        """Repeat the search with the noise estimated from its residuals, until that estimate is stable.

        This is needed if priors or several kinds of data have to be weighted against each other.
        """
        problem = self.problem
        if problem.accuracy_is_stated or not (problem.priors or len(problem.observations) > 1):
            return state
        for _ in range(_NOISE_ROUNDS):
            renewed = problem.with_noise_of(state.residuals)
            if np.allclose(renewed.noise, problem.noise, rtol=_SAME_NOISE):
                break
            problem = renewed
            again = self._make_search(problem, "noise: ").run(state.place)
            if again is None or again.state == "interrupted":
                break
            state = again
        self.problem = problem
        return state

    def _polish(self, state: SearchState) -> SearchState:
        """Take the last steps with the scenario's solver; search again with it if the fast one is too inaccurate."""
        self.plan.progress("last steps with the scenario's own solver")
        search = self._make_search(self.problem, "last steps: ", final=True)
        search.differences = self.problem.residuals
        try:
            polished, apart = search.resume(state)
            if apart > _STEPS_APART * search.noise(state):
                self.methods.append(
                    Message(
                        "fixed steps of 4 ms were too long for this snow: searched again with the scenario's solver"
                    )
                )
                again = self._make_search(self.problem, "own solver: ", final=True).run(polished.place)
                return polished if again is None else again
        except KeyboardInterrupt:
            best = search.best if search.best is not None else state
            return replace(best, jacobian=state.jacobian, second=state.second, state="interrupted")
        self.methods.append(
            Message(
                "searched with fixed steps of 4 ms (fast mode); last steps and answer with the scenario's own solver"
            )
        )
        return polished

    def _weigh(self, state: SearchState) -> Solution:
        """Solution with residuals and derivatives in standard deviations of the data, stated or estimated."""
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
        return Solution(problem, state, tuple(self.tried), tuple(self.methods), search_options(problem, self.plan))
