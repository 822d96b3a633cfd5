"""Residuals of all data as one vector, followed by those of the priors."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final, Literal, Protocol, TypeAlias

import numpy as np
import numpy.typing as npt

from .._support.display import ShownFields
from .._support.errors import ParameterError
from ..parameters import nearest
from ..scenario.keys import EACH
from .parameter import Parameter, values_of

FloatArray = npt.NDArray[np.float64]
Values: TypeAlias = Mapping[str, float]
"""Parameters by key, in the units that the keys name."""
Kind: TypeAlias = Literal["track", "photo_cells", "marks"]
START: Final = "start."
"""Keys that every run has for itself."""


@dataclass(frozen=True, slots=True)
class Problem:
    """What a search makes small.

    Attributes
    ----------
    parameters
        The free ones.
    observations
        Data of one kind or several.
    noise
        For each of them the standard deviation of its residuals: one where accuracies are stated, else an estimate.
    """

    parameters: tuple[Parameter, ...]
    observations: tuple[Observations, ...]
    noise: tuple[float, ...]

    @property
    def accuracy_is_stated(self) -> bool:
        """Whether all data state their accuracy."""
        return all(observation.accuracy_is_stated for observation in self.observations)

    @property
    def points(self) -> int:
        """Points of all data."""
        return sum(observation.points for observation in self.observations)

    @property
    def nuisances(self) -> int:
        """Numbers fitted inside the residuals."""
        return sum(observation.nuisances for observation in self.observations)

    @property
    def priors(self) -> int:
        """How many parameters have one."""
        return sum(parameter.prior_sd is not None for parameter in self.parameters)

    @property
    def lengths(self) -> tuple[int, ...]:
        """How many residuals each kind of data has."""
        return tuple(sum(observation.series) for observation in self.observations)

    def residuals(self, places: Sequence[FloatArray]) -> list[FloatArray | None]:
        """Of data and priors at places of the search."""
        return self._collected(places, lambda each, many: each.residuals(many))

    def final_residuals(self, places: Sequence[FloatArray]) -> list[FloatArray | None]:
        """The same with the accuracy of the answer."""
        return self._collected(places, lambda each, many: each.final_residuals(many))

    def values(self, place: FloatArray) -> dict[str, float]:
        """Parameters by key."""
        return values_of(self.parameters, place)

    def with_noise_of(self, residuals: FloatArray) -> Problem:
        """The same with the noise that these residuals show, where it is not stated."""
        share = max(1.0 - (len(self.parameters) + self.nuisances) / max(sum(self.lengths), 1), 1e-3)
        found, first = [], 0
        for observation, length, noise in zip(self.observations, self.lengths, self.noise, strict=True):
            part = residuals[first : first + length]
            first += length
            measured = noise * float(np.sqrt(np.mean(part**2) / share))
            found.append(1.0 if observation.accuracy_is_stated else max(measured, 1e-12))
        return replace(self, noise=tuple(found))

    def weights(self, other: Problem) -> FloatArray:
        """By which residuals of `other` are multiplied to become residuals of this one."""
        ratios = [
            np.full(length, theirs / ours)
            for length, theirs, ours in zip(self.lengths, other.noise, self.noise, strict=True)
        ]
        return np.concatenate([*ratios, np.ones(self.priors)])

    def _collected(
        self,
        places: Sequence[FloatArray],
        of: Callable[[Observations, Sequence[Values]], list[FloatArray | None]],
    ) -> list[FloatArray | None]:
        many = [self.values(place) for place in places]
        parts = [of(observation, many) for observation in self.observations]
        return [self._one([part[i] for part in parts], many[i]) for i in range(len(many))]

    def _one(self, parts: Sequence[FloatArray | None], values: Values) -> FloatArray | None:
        pieces = []
        for part, noise in zip(parts, self.noise, strict=True):
            if part is None or not np.all(np.isfinite(part)):
                return None
            pieces.append(part / noise)
        priors = [parameter.prior_residual(values[parameter.key]) for parameter in self.parameters]
        pieces.append(np.array([prior for prior in priors if prior is not None], dtype=float))
        return np.concatenate(pieces)


def problem_of(parameters: tuple[Parameter, ...], observations: tuple[Observations, ...]) -> Problem:
    """A problem before anything is known of its noise."""
    return Problem(parameters, observations, tuple(1.0 for _ in observations))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True, repr=False)
class Fit(ShownFields):
    """One run's data beside what the parameters give.

    Attributes
    ----------
    name, kind
        Name of the run.
    along : (n,)
        Abscissa of the points: time (s) of a track, distance (m) of photo cells, number of a place of a groove.
    labels
        Names of the k quantities, with units.
    measured, fitted, sd : (n, k)
        NaN where a quantity was not measured; `sd` is what the residual was divided by.
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
    """Data of one kind."""

    @property
    def kind(self) -> Kind:
        """Of the data."""

    @property
    def runs(self) -> tuple[str, ...]:
        """Names of the runs; each may have a start of its own."""

    @property
    def points(self) -> int:
        """Number of points: times of a track, cells passed, places of grooves."""

    def depends_on(self, key: str) -> bool:
        """Whether the scenario's key can play a part in these data."""

    @property
    def nuisances(self) -> int:
        """Numbers that are fitted inside the residuals, such as the offset of a clock."""

    @property
    def accuracy_is_stated(self) -> bool:
        """Whether residuals are in stated standard deviations, or in estimated ones that only weigh them."""

    @property
    def series(self) -> tuple[int, ...]:
        """Lengths of the pieces of the residuals that follow each other in time."""

    def residuals(self, many: Sequence[Values]) -> list[FloatArray | None]:
        """(Computed - measured)/standard deviation for each set of parameters; None where nothing can be computed."""

    def final_residuals(self, many: Sequence[Values]) -> list[FloatArray | None]:
        """The same with the accuracy of the answer, where the search is content with less."""

    def fits(self, values: Values) -> tuple[Fit, ...]:
        """What to draw."""

    def warnings(self, values: Values) -> tuple[str, ...]:
        """What a user should know of these data at these parameters."""


def keys_of_runs(keys: Sequence[str], runs: Sequence[str]) -> tuple[str, ...]:
    """The keys, those of the start and those that end in ``@each`` once for each run where there are several.

    Raises
    ------
    ParameterError
        A run is named that is not there, or a key is looked for twice in one run.

    Examples
    --------
    >>> keys_of_runs(["friction.mu_0", "start.speed_m_per_s"], ["a", "b"])
    ('friction.mu_0', 'start.speed_m_per_s@a', 'start.speed_m_per_s@b')
    >>> keys_of_runs(["drag.drag_area_m2@each", "friction.mu_0@b"], ["a", "b"])
    ('drag.drag_area_m2@a', 'drag.drag_area_m2@b', 'friction.mu_0@b')
    """
    found: list[str] = []
    for key in keys:
        own, at, run = key.partition("@")
        if at and run != EACH and run not in runs:
            raise ParameterError(f"--free: {key}: there is no run {run!r}. {nearest(run, runs)}")
        if len(runs) < 2:
            found.append(own)
        elif run == EACH or (own.startswith(START) and not at):
            found += [f"{own}@{each}" for each in runs]
        else:
            found.append(key)
    for key in found:
        if found.count(key) > 1:
            raise ParameterError(f"--free: {key} is looked for twice. Remove one of them")
    return tuple(found)


def values_of_run(values: Values, run: str) -> dict[str, float]:
    """The parameters that a run is computed with, under the scenario's own keys."""
    found = {}
    for key, value in values.items():
        own, at, whose = key.partition("@")
        if not at or whose == run:
            found[own] = value
    return found
