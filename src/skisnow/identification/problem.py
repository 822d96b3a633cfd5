"""Parameters and data put together: one vector of residuals, data first, priors behind."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from .observations import Observations, Values
from .parameter import Parameter, values_of

FloatArray = npt.NDArray[np.float64]


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
        return all(each.accuracy_is_stated for each in self.observations)

    @property
    def points(self) -> int:
        """Points of all data."""
        return sum(each.points for each in self.observations)

    @property
    def nuisances(self) -> int:
        """Numbers fitted inside the residuals."""
        return sum(each.nuisances for each in self.observations)

    @property
    def priors(self) -> int:
        """How many parameters have one."""
        return sum(each.prior_sd is not None for each in self.parameters)

    @property
    def lengths(self) -> tuple[int, ...]:
        """How many residuals each kind of data has."""
        return tuple(sum(each.series) for each in self.observations)

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
        for each, length, noise in zip(self.observations, self.lengths, self.noise, strict=True):
            part = residuals[first : first + length]
            first += length
            measured = noise * float(np.sqrt(np.mean(part**2) / share))
            found.append(1.0 if each.accuracy_is_stated else max(measured, 1e-12))
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
        parts = [of(each, many) for each in self.observations]
        return [self._one([part[i] for part in parts], many[i]) for i in range(len(many))]

    def _one(self, parts: Sequence[FloatArray | None], values: Values) -> FloatArray | None:
        pieces = []
        for part, noise in zip(parts, self.noise, strict=True):
            if part is None or not np.all(np.isfinite(part)):
                return None
            pieces.append(part / noise)
        priors = [each.prior_residual(values[each.key]) for each in self.parameters]
        pieces.append(np.array([each for each in priors if each is not None], dtype=float))
        return np.concatenate(pieces)


def problem_of(parameters: tuple[Parameter, ...], observations: tuple[Observations, ...]) -> Problem:
    """A problem before anything is known of its noise."""
    return Problem(parameters, observations, tuple(1.0 for _ in observations))
