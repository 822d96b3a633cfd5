"""Points of a study from its axes: a list, a grid, or a Latin hypercube of up to a million points."""

from __future__ import annotations

import itertools
import math
from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Annotated, Any, Final, Self, TypeAlias, overload

import numpy as np
import numpy.typing as npt

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from ..parameters import Allowed, Quantity, build_declared, checked_table

Point: TypeAlias = dict[str, Any]

MOST_POINTS: Final = 1_000_000
"""Of one study: a table of about half a gigabyte on disk."""


class LazySequence(Sequence[Point], ABC):
    """Read-only sequence of values by name, computed on access; equal to any sequence of equal values."""

    __slots__ = ()

    @abstractmethod
    def point(self, number: int) -> Point:
        """Values by name of the element with this number, which the caller has checked."""

    @overload
    def __getitem__(self, place: int) -> Point: ...
    @overload
    def __getitem__(self, place: slice) -> list[Point]: ...
    def __getitem__(self, place: int | slice) -> Point | list[Point]:
        """The values at one place, or at some as a list."""
        if isinstance(place, slice):
            return [self.point(number) for number in range(len(self))[place]]
        return self.point(range(len(self))[place])

    def __iter__(self) -> Iterator[Point]:
        """One after the other."""
        return (self.point(number) for number in range(len(self)))

    def __eq__(self, other: object) -> bool:
        """True if a sequence has the same values in the same order."""
        if not isinstance(other, Sequence):
            return NotImplemented
        return len(self) == len(other) and all(a == b for a, b in zip(self, other, strict=True))

    __hash__ = None  # type: ignore[assignment]  # as of a list


class Points(LazySequence):
    """Inputs of all points of a study, computed on access instead of stored in a list."""

    __slots__ = ()

    @abstractmethod
    def distinct(self, name: str) -> list[Any]:
        """Distinct values of an input, in the order of the points; empty where no point has it."""


def distinct_values(points: Sequence[Point], name: str) -> list[Any]:
    """Distinct values of an input, as `Points.distinct`; the points may be a list, too."""
    if isinstance(points, Points):
        return points.distinct(name)
    return list(dict.fromkeys(point[name] for point in points if name in point))


@dataclass(frozen=True, slots=True, eq=False)
class GridPoints(Points):
    """Every combination of the values of some axes; the last axis varies fastest.

    fixed: values of the inputs that all points share.
    axes: values by name; none of the names is fixed.
    """

    fixed: Mapping[str, Any]
    axes: Mapping[str, Sequence[Any]]

    def __len__(self) -> int:
        """The product of the numbers of values."""
        return math.prod(len(values) for values in self.axes.values())

    def point(self, number: int) -> Point:
        """Values of the point with this number, whose digits in a mixed base are the places on the axes."""
        chosen = []
        for values in reversed(list(self.axes.values())):
            number, place = divmod(number, len(values))
            chosen.append(values[place])
        return {**self.fixed, **dict(zip(self.axes, reversed(chosen), strict=True))}

    def __iter__(self) -> Iterator[Point]:
        """Every point, made as it is reached."""
        for chosen in itertools.product(*self.axes.values()):
            yield {**self.fixed, **dict(zip(self.axes, chosen, strict=True))}

    def distinct(self, name: str) -> list[Any]:
        """The values of an axis, or the one that is fixed."""
        return _fixed_value(self.fixed, name) if name not in self.axes else list(dict.fromkeys(self.axes[name]))


@dataclass(frozen=True, slots=True, eq=False)
class Column:
    """The values of one input over a sample, in a few bytes each.

    numbers: the values, or indices into `listed` if it is not empty (n,).
    listed: the values that the places name.
    """

    numbers: npt.NDArray[Any]
    listed: tuple[Any, ...] = ()

    def values(self) -> list[Any]:
        """Values of all points, with indices replaced by the listed values."""
        return [self.listed[place] for place in self.numbers] if self.listed else self.numbers.tolist()

    def __getitem__(self, number: int) -> Any:
        """The value of a point."""
        value = self.numbers[number].item()
        return self.listed[value] if self.listed else value


@dataclass(frozen=True, slots=True, eq=False)
class SampledPoints(Points):
    """Points of a sample, each with one value of every column.

    fixed: values of the inputs that all points share.
    columns: by name; none of the names is fixed.
    n: the number of points.
    """

    fixed: Mapping[str, Any]
    columns: Mapping[str, Column] = field(repr=False)
    n: int

    def __len__(self) -> int:
        """Their number."""
        return self.n

    def point(self, number: int) -> Point:
        """One value of every column."""
        return {**self.fixed, **{name: column[number] for name, column in self.columns.items()}}

    def distinct(self, name: str) -> list[Any]:
        """The values of a column, or the one that is fixed."""
        column = self.columns.get(name)
        return _fixed_value(self.fixed, name) if column is None else list(dict.fromkeys(column.values()))


def _fixed_value(fixed: Mapping[str, Any], name: str) -> list[Any]:
    return [fixed[name]] if name in fixed else []


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
        values = value if isinstance(value, list) and not _is_one(key, value) else [value]
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

    def sampled(self, share: FloatArray) -> Column:
        """Column of the values at shares (n,) from 0 to 1 of the axis; the values of a list share it equally."""
        if self.values:
            index = np.minimum((share * len(self.values)).astype(int), len(self.values) - 1)
            return Column(index, self.values)
        if self.n is not None:
            raise ParameterError("{name}: n belongs in [latin_hypercube], not in a range").tag(
                "contradiction", name=self.key.name
            )
        numbers = self._at(share)
        whole = self.key.kind == "whole number"
        return Column(np.array([round(x) for x in numbers.tolist()]) if whole else numbers)

    def _at(self, share: FloatArray) -> FloatArray:
        """Values at shares from 0 to 1 of the range, on its linear or logarithmic scale."""
        low, high = (math.log(end) for end in self.ends) if self.log else self.ends
        even = low + (high - low) * share
        return np.exp(even) if self.log else even


def grid_points(axes: list[Axis], fixed: Point) -> GridPoints:
    """Every combination; the last axis varies fastest."""
    require_count(math.prod(len(axis.values) or axis.n or 1 for axis in axes))  # before the values take memory
    return GridPoints(fixed, {axis.key.name: axis.on_grid() for axis in axes})


def hypercube_points(axes: list[Axis], fixed: Point, n: int, seed: int) -> SampledPoints:
    """A Latin hypercube: each of n equal slices of every axis contains one point, at a random place in its slice."""
    require_count(n)
    generator = np.random.default_rng(seed)
    columns = {axis.key.name: axis.sampled((generator.permutation(n) + generator.uniform(size=n)) / n) for axis in axes}
    return SampledPoints(fixed, columns, n)


def require_count(n: int) -> None:
    """Reject a study with more points than can be computed."""
    if n > MOST_POINTS:
        raise ParameterError("the study has {n} points; at most {most_points} are allowed. Use fewer values").tag(
            "out_of_range", n=n, most_points=MOST_POINTS
        )


def _is_one(key: Quantity, value: list[Any]) -> bool:
    """True if a list is one value: three numbers."""
    return key.kind == "three numbers" and not any(isinstance(number, list) for number in value)
