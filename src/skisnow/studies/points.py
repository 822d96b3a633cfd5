"""Points of a study from its axes: a grid, or a Latin hypercube."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Final, Self, TypeAlias

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from ..parameters import Allowed, Quantity, build_declared, checked_table

Point: TypeAlias = dict[str, Any]

MOST_POINTS: Final = 100_000
"""Of one study, all of whose rows are in memory: about 200 MB."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Range:
    """Values of an input as a range, instead of a list: first and last value in the unit of the key."""

    first: Annotated[float, Quantity("from", "the first value; a range is written { from = 20, to = 70, n = 11 }")]
    last: Annotated[float, Quantity("to", "the last value; a range is written { from = 20, to = 70, n = 11 }")]
    n: Annotated[int | None, Quantity("n", "number of values on a grid"), Allowed(2)] = None
    log: Annotated[bool, Quantity("log", "whether it is even in the logarithm")] = False


@dataclass(frozen=True, slots=True)
class Axis:
    """Values of one input: a list, or a range with ends.

    key: the input.
    values: the list; empty for a range.
    ends: from and to, for a range.
    n: number of values of a range on a grid; None where a sample does not need it.
    log: True if the values are evenly spaced in their logarithm.
    """

    key: Quantity
    values: tuple[Any, ...] = ()
    ends: tuple[float, float] = (0.0, 0.0)
    n: int | None = None
    log: bool = False

    @classmethod
    def of(cls, key: Quantity, value: object) -> Self:
        """Parse the value of a key: one value, a list of values, or {from, to, n, log}."""
        if isinstance(value, dict):
            return cls._of_range(key, value)
        values = value if isinstance(value, list) else [value]
        if key.kind == "three numbers" and not any(isinstance(item, list) for item in values):
            values = [value]  # the list is one value
        if not values:
            raise ParameterError("{name} is an empty list; write at least one value").tag("out_of_range", name=key.name)
        checked = tuple(key.in_kind(value) for value in values)
        repeated = next((value for place, value in enumerate(checked) if value in checked[:place]), None)
        if repeated is not None:
            raise ParameterError("{name} contains {repeated!r} twice; write each value once").tag(
                "repeated", name=key.name, repeated=repeated
            )
        return cls(key, checked)

    @classmethod
    def _of_range(cls, key: Quantity, table: Mapping[str, Any]) -> Self:
        """Axis of a range from a low to a high end; rejects equal or falling ends, and a logarithm of 0 or less."""
        if key.kind not in ("number", "whole number"):
            raise ParameterError("{name} has no range; write a list such as {name} = [...]").tag(
                "no_data", name=key.name
            )
        limits = build_declared(Range, checked_table(Range, table, key.name))
        low, high, log = limits.first, limits.last, limits.log
        if log and not (low > 0 and high > 0):
            raise ParameterError("{name}: a logarithmic range needs both ends above 0; they are {low:g}, {high:g}").tag(
                "out_of_range", name=key.name, low=low, high=high
            )
        if low > high:
            raise ParameterError("{name}: from is {low:g} and to is {high:g}; from must be the smaller one").tag(
                "wrong_kind", name=key.name, low=low, high=high
            )
        if low == high:
            raise ParameterError("{name}: from and to are both {low:g}; write the value under [fixed]").tag(
                "out_of_range", name=key.name, low=low
            )
        return cls(key, ends=(low, high), n=limits.n, log=log)

    def on_grid(self) -> list[Any]:
        """Values of the axis on a grid."""
        if self.values:
            return list(self.values)
        if self.n is None:
            raise ParameterError("{name}: n, the number of values, is missing").tag("missing", name=self.key.name)
        low, high = self.ends
        share = np.linspace(0.0, 1.0, self.n)
        middle = self._at(share)
        values = (low, *middle[1:-1].tolist(), high)
        return [round(x) for x in values] if self.key.kind == "whole number" else list(values)

    def sampled(self, share: FloatArray) -> list[Any]:
        """Values at shares (n,) from 0 to 1 of the axis; the values of a list share it equally."""
        if self.values:
            places = np.minimum((share * len(self.values)).astype(int), len(self.values) - 1)
            return [self.values[place] for place in places]
        if self.n is not None:
            raise ParameterError("{name}: n belongs in [latin_hypercube], not in a range").tag(
                "contradiction", name=self.key.name
            )
        numbers: list[Any] = self._at(share).tolist()
        return [round(x) for x in numbers] if self.key.kind == "whole number" else numbers

    def _at(self, share: FloatArray) -> FloatArray:
        """Values at shares from 0 to 1 of the range, on its linear or logarithmic scale."""
        low, high = (math.log(end) for end in self.ends) if self.log else self.ends
        even = low + (high - low) * share
        return np.exp(even) if self.log else even


def grid_points(axes: list[Axis], fixed: Point) -> list[Point]:
    """Every combination; the last axis varies fastest."""
    require_count(math.prod(len(axis.values) or axis.n or 1 for axis in axes))  # before the values take memory
    return _points([axis.key.name for axis in axes], itertools.product(*(axis.on_grid() for axis in axes)), fixed)


def hypercube_points(axes: list[Axis], fixed: Point, n: int, seed: int) -> list[Point]:
    """A Latin hypercube: each of n equal slices of every axis contains one point, at a random place in its slice."""
    require_count(n)
    generator = np.random.default_rng(seed)
    columns = [axis.sampled((generator.permutation(n) + generator.uniform(size=n)) / n) for axis in axes]
    return _points([axis.key.name for axis in axes], zip(*columns, strict=True), fixed)


def _points(names: list[str], values: Iterable[tuple[Any, ...]], fixed: Point) -> list[Point]:
    """One point for each row of values, with the fixed inputs added."""
    return [{**fixed, **dict(zip(names, chosen, strict=True))} for chosen in values]


def require_count(n: int) -> None:
    """Reject a study with more points than can be computed."""
    if n > MOST_POINTS:
        raise ParameterError("the study has {n} points; at most {most_points} are allowed. Use fewer values").tag(
            "out_of_range", n=n, most_points=MOST_POINTS
        )
