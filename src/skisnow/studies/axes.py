"""What varies in a study: lists and ranges, as a grid or as a Latin hypercube."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Final, Self

import numpy as np
import numpy.typing as npt

from .._support.errors import ParameterError
from ..parameters import Quantity, checked_table, made
from .points import Column, GridPoints, Point, SampledPoints

FloatArray = npt.NDArray[np.float64]

MOST_POINTS: Final = 1_000_000
"""Of one study: a table of about half a gigabyte on disk; memory does not grow with it (modelling assumption)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Range:
    """What stands behind a key in place of its values: ends in the unit of the key."""

    first: Annotated[float, Quantity("from", "the first value; a range is written { from = 20, to = 70, n = 11 }")]
    last: Annotated[float, Quantity("to", "the last value; a range is written { from = 20, to = 70, n = 11 }")]
    n: Annotated[int | None, Quantity("n", "number of values on a grid", lowest=2)] = None
    log: Annotated[bool, Quantity("log", "whether it is even in the logarithm")] = False


@dataclass(frozen=True, slots=True)
class Axis:
    """Values of one input: a list, or a range with ends.

    Attributes
    ----------
    key
        The input.
    values
        The list; empty for a range.
    ends
        From and to, for a range.
    n
        Number of values of a range on a grid; None where a sample does not need it.
    log
        Whether the range is even in the logarithm.
    """

    key: Quantity
    values: tuple[Any, ...] = ()
    ends: tuple[float, float] = (0.0, 0.0)
    n: int | None = None
    log: bool = False

    @classmethod
    def of(cls, key: Quantity, value: object) -> Self:
        """Read what stands behind a key: one value, a list of values, or {from, to, n, log}.

        Raises
        ------
        ParameterError
            It is none of these; the message names the key.
        """
        if isinstance(value, dict):
            return cls._of_range(key, value)
        values = value if isinstance(value, list) and not _is_one(key, value) else [value]
        if not values:
            raise ParameterError(f"{key.name} is an empty list; write at least one value")
        checked = tuple(key.of_kind(each) for each in values)
        repeated = next((each for place, each in enumerate(checked) if each in checked[:place]), None)
        if repeated is not None:
            raise ParameterError(f"{key.name} holds {repeated!r} twice; write each value once")
        return cls(key, checked)

    @classmethod
    def _of_range(cls, key: Quantity, table: Mapping[str, Any]) -> Self:
        if key.kind not in ("number", "whole number"):
            raise ParameterError(f"{key.name} has no range; write a list such as {key.name} = [...]")
        asked = made(Range, checked_table(Range, table, key.name))
        low, high, log = asked.first, asked.last, asked.log
        if log and not (low > 0 and high > 0):
            raise ParameterError(f"{key.name}: a logarithmic range needs both ends above 0; they are {low:g}, {high:g}")
        if low > high:
            raise ParameterError(f"{key.name}: from is {low:g} and to is {high:g}; from must be the smaller one")
        if low == high:
            raise ParameterError(f"{key.name}: from and to are both {low:g}; write the value under [fixed]")
        return cls(key, ends=(low, high), n=asked.n, log=log)

    def on_grid(self) -> list[Any]:
        """The values of a grid."""
        if self.values:
            return list(self.values)
        if self.n is None:
            raise ParameterError(f"{self.key.name}: n, the number of values, is missing")
        low, high = self.ends
        share = np.linspace(0.0, 1.0, self.n)
        middle = self._at(share)
        return [self._in_kind(x) for x in (low, *middle[1:-1].tolist(), high)]

    def sampled(self, share: FloatArray) -> Column:
        """The values at shares from 0 to 1 of the axis; of a list each value has the same share."""
        if self.values:
            index = np.minimum((share * len(self.values)).astype(int), len(self.values) - 1)
            return Column(index, self.values)
        if self.n is not None:
            raise ParameterError(f"{self.key.name}: n stands once in [latin_hypercube], not in a range")
        numbers = self._at(share)
        whole = self.key.kind == "whole number"
        return Column(np.array([round(x) for x in numbers.tolist()]) if whole else numbers)

    def _at(self, share: FloatArray) -> FloatArray:
        low, high = (math.log(end) for end in self.ends) if self.log else self.ends
        even = low + (high - low) * share
        return np.exp(even) if self.log else even

    def _in_kind(self, number: float) -> float | int:
        return round(number) if self.key.kind == "whole number" else number


def grid_points(axes: list[Axis], fixed: Point) -> GridPoints:
    """Every combination; the last axis varies fastest."""
    require_count(math.prod(len(axis.values) or axis.n or 1 for axis in axes))  # before the values take memory
    return GridPoints(fixed, {axis.key.name: axis.on_grid() for axis in axes})


def hypercube_points(axes: list[Axis], fixed: Point, n: int, seed: int) -> SampledPoints:
    """A Latin hypercube: each of n equal slices of every axis holds one point, at a random place in its slice."""
    require_count(n)
    generator = np.random.default_rng(seed)
    columns = {axis.key.name: axis.sampled((generator.permutation(n) + generator.uniform(size=n)) / n) for axis in axes}
    return SampledPoints(fixed, columns, n)


def require_count(n: int) -> None:
    """Refuse a study that nobody can wait for."""
    if n > MOST_POINTS:
        raise ParameterError(f"the study has {n} points; at most {MOST_POINTS} are allowed. Take fewer values")


def _is_one(key: Quantity, value: list[Any]) -> bool:
    """Whether a list is one value: three numbers."""
    return key.kind == "three numbers" and not any(isinstance(each, list) for each in value)
