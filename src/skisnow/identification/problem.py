"""Residuals of all data as one vector, followed by those of the priors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final, Literal, Protocol, TypeAlias

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.units import ShownFields
from ..parameters import suggest_and_list
from ..scenario.keys import EACH
from .parameter import Parameter

Values: TypeAlias = Mapping[str, float]
"""Parameters by key, in the units that the keys name."""
Kind: TypeAlias = Literal["track", "photo_cells"]
START: Final = "start."
"""Beginning of the keys that have a separate value in each run."""


@dataclass(frozen=True, slots=True)
class Problem:
    """Least-squares problem of a search.

    noise: standard deviation of the residuals of each set of observations; 1 if accuracies are stated, else estimated.
    """

    parameters: tuple[Parameter, ...]
    observations: tuple[Observations, ...]
    noise: tuple[float, ...]

    @property
    def accuracy_is_stated(self) -> bool:
        """True if all data state their accuracy."""
        return all(observation.accuracy_is_stated for observation in self.observations)

    @property
    def points(self) -> int:
        """Number of points of all data."""
        return sum(observation.points for observation in self.observations)

    @property
    def nuisances(self) -> int:
        """Number of values that are fitted inside the residuals."""
        return sum(observation.nuisances for observation in self.observations)

    @property
    def priors(self) -> int:
        """Number of parameters with a prior."""
        return sum(parameter.prior_sd is not None for parameter in self.parameters)

    @property
    def lengths(self) -> tuple[int, ...]:
        """Number of residuals of each kind of data."""
        return tuple(sum(observation.series) for observation in self.observations)

    def residuals(self, places: Sequence[FloatArray], *, final: bool = False) -> list[FloatArray | None]:
        """Residuals of data and priors at each point of the search; None for a point whose simulation failed.

        final: True for the scenario's solver, at the accuracy of the result.
        """
        many = [self.values(place) for place in places]
        parts = zip(*(observation.residuals(many, final=final) for observation in self.observations), strict=True)
        return [self._weighted_residuals(part, values) for part, values in zip(parts, many, strict=True)]

    def values(self, place: FloatArray) -> dict[str, float]:
        """Parameters by key at a place of the search, shape (p,)."""
        return {parameter.key: parameter.value(float(u)) for parameter, u in zip(self.parameters, place, strict=True)}

    def with_noise_of(self, residuals: FloatArray) -> Problem:
        """The problem with the noise estimated from these residuals, unless it is stated."""
        share = max(1.0 - (len(self.parameters) + self.nuisances) / max(sum(self.lengths), 1), 1e-3)
        noises, first = [], 0
        for observation, length, noise in zip(self.observations, self.lengths, self.noise, strict=True):
            part = residuals[first : first + length]
            first += length
            measured = noise * float(np.sqrt(np.mean(part**2) / share))
            noises.append(1.0 if observation.accuracy_is_stated else max(measured, 1e-12))
        return replace(self, noise=tuple(noises))

    def weights(self, other: Problem) -> FloatArray:
        """Factor of each of `other`'s n residuals to this problem's: the ratio of noises, 1 for priors."""
        ratios = [
            np.full(length, theirs / ours)
            for length, theirs, ours in zip(self.lengths, other.noise, self.noise, strict=True)
        ]
        return np.concatenate([*ratios, np.ones(self.priors)])

    def _weighted_residuals(self, parts: Sequence[FloatArray | None], values: Values) -> FloatArray | None:
        """Residuals divided by their noise, then those of the priors; None if a part is missing or not finite."""
        pieces = []
        for part, noise in zip(parts, self.noise, strict=True):
            if part is None or not np.all(np.isfinite(part)):
                return None
            pieces.append(part / noise)
        priors = [parameter.prior_residual(values[parameter.key]) for parameter in self.parameters]
        pieces.append(np.array([prior for prior in priors if prior is not None], dtype=float))
        return np.concatenate(pieces)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True, repr=False)
class Fit(ShownFields):
    """Measured and fitted values of one run.

    name, kind: name of the run, and kind of its data.
    along: (n,), abscissa of the points: time (s) of a track, distance (m) of photo cells.
    labels: names of the k quantities, with units.
    measured, fitted, sd: (n, k), values and the standard deviations that divide the residuals; NaN if a quantity was
        not measured.
    """

    name: str
    kind: Kind
    along: FloatArray
    labels: tuple[str, ...]
    measured: FloatArray
    fitted: FloatArray
    sd: FloatArray

    @property
    def residual(self) -> FloatArray:
        """Measured minus fitted, (n, k)."""
        return self.measured - self.fitted


class Observations(Protocol):
    """Data of one kind.

    kind: kind of the data.
    used_keys: keys of the scenario that can affect these data; None: all.
    points: number of points: times of a track, cells passed.
    nuisances: number of values that are fitted inside the residuals, such as the offset of a clock.
    accuracy_is_stated: True if residuals are in stated standard deviations, False if these are estimated.
    series: lengths of the time series in the residuals.
    """

    kind: Kind
    used_keys: tuple[str, ...] | None
    points: int
    nuisances: int
    accuracy_is_stated: bool
    series: tuple[int, ...]

    def residuals(self, many: Sequence[Values], *, final: bool = False) -> list[FloatArray | None]:
        """(Computed - measured)/standard deviation (n,) for each set of parameters; None if it cannot be computed."""

    def fits(self, values: Values) -> tuple[Fit, ...]:
        """Measured and fitted values of each run."""

    def warnings(self, values: Values) -> tuple[Message, ...]:
        """Warnings about these data at these parameters."""


def expand_keys(keys: Sequence[str], runs: Sequence[str]) -> tuple[str, ...]:
    """The free keys; with several runs, keys of the start and keys with ``@each`` are repeated for each run.

    >>> expand_keys(["friction.mu_0", "start.speed_m_per_s"], ["a", "b"])
    ('friction.mu_0', 'start.speed_m_per_s@a', 'start.speed_m_per_s@b')
    >>> expand_keys(["drag.drag_area_m2@each", "friction.mu_0@b"], ["a", "b"])
    ('drag.drag_area_m2@a', 'drag.drag_area_m2@b', 'friction.mu_0@b')
    """
    expanded: list[str] = []
    for key in keys:
        own, at, run = key.partition("@")
        if at and run != EACH and run not in runs:
            raise ParameterError("--free: {key}: unknown run {run!r}. {allowed}").tag(
                "unknown_run", key=key, run=run, allowed=suggest_and_list(run, runs)
            )
        if len(runs) < 2:
            expanded.append(own)
        elif run == EACH or (own.startswith(START) and not at):
            expanded += [f"{own}@{name}" for name in runs]
        else:
            expanded.append(key)
    for key in expanded:
        if expanded.count(key) > 1:
            raise ParameterError("--free: {key} is given twice. Remove one of them").tag("repeated_key", key=key)
    return tuple(expanded)


def run_values(values: Values, run: str) -> dict[str, float]:
    """The parameters of one run, by the scenario's keys."""
    selected = {}
    for key, value in values.items():
        own, at, key_run = key.partition("@")
        if not at or key_run == run:
            selected[own] = value
    return selected
