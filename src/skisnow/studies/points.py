"""The points of a study: as many as a million, each made from its number when it is asked for."""

from __future__ import annotations

import itertools
import json
import math
from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final, TypeAlias, overload

import numpy.typing as npt

Point: TypeAlias = dict[str, Any]

AT_ONCE: Final = 1000
"""Points whose text is made in one piece: some hundred kilobytes (modelling assumption)."""


class Points(Sequence[Point], ABC):
    """Inputs by name, for each number from 0 on; never a list of them all."""

    __slots__ = ()

    @abstractmethod
    def point(self, number: int) -> Point:
        """The inputs of one point; `number` is within the range."""

    @abstractmethod
    def distinct(self, name: str) -> list[Any]:
        """What stands under a name, each once, in the order of the points; empty where no point has it."""

    @abstractmethod
    def json_texts(self) -> Iterator[str]:
        """What `json.dumps` writes for the list of all points between its brackets, in pieces parted by ``", "``."""

    @overload
    def __getitem__(self, place: int) -> Point: ...
    @overload
    def __getitem__(self, place: slice) -> list[Point]: ...
    def __getitem__(self, place: int | slice) -> Point | list[Point]:
        """One point, or some of them as a list."""
        if isinstance(place, slice):
            return [self.point(number) for number in range(len(self))[place]]
        return self.point(range(len(self))[place])

    def __iter__(self) -> Iterator[Point]:
        """Every point, made as it is reached."""
        return (self.point(number) for number in range(len(self)))

    def __eq__(self, other: object) -> bool:
        """Whether a sequence has the same points in the same order."""
        if not isinstance(other, Sequence):
            return NotImplemented
        return len(self) == len(other) and all(a == b for a, b in zip(self, other, strict=True))

    __hash__ = None  # type: ignore[assignment]  # as of a list


@dataclass(frozen=True, slots=True, eq=False)
class ListedPoints(Points):
    """Points that stand in a list."""

    points: Sequence[Point]

    def __len__(self) -> int:
        """Their number."""
        return len(self.points)

    def point(self, number: int) -> Point:
        """The entry of the list."""
        return self.points[number]

    def distinct(self, name: str) -> list[Any]:
        """What stands under a name, each once."""
        return list(dict.fromkeys(point[name] for point in self.points if name in point))

    def json_texts(self) -> Iterator[str]:
        """One piece for each point."""
        return (json.dumps(point) for point in self.points)


@dataclass(frozen=True, slots=True, eq=False)
class GridPoints(Points):
    """Every combination of the values of some axes; the last axis varies fastest.

    Attributes
    ----------
    fixed
        What all points share.
    axes
        Values by name; none of the names is fixed.
    """

    fixed: Mapping[str, Any]
    axes: Mapping[str, Sequence[Any]]

    def __len__(self) -> int:
        """The product of the numbers of values."""
        return math.prod(len(values) for values in self.axes.values())

    def point(self, number: int) -> Point:
        """The digits of its number, in a base of its own for each axis, are the places on the axes."""
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
        return _fixed(self.fixed, name) if name not in self.axes else list(dict.fromkeys(self.axes[name]))

    def json_texts(self) -> Iterator[str]:
        """A piece for each part of the last axis."""
        texts = [[_pair(name, value) for value in values] for name, values in self.axes.items()]
        for before in itertools.product(*texts[:-1]):
            head = "".join(f"{text}, " for text in (*_pairs(self.fixed), *before))
            for first in range(0, len(texts[-1]), AT_ONCE):
                yield ", ".join(f"{{{head}{text}}}" for text in texts[-1][first : first + AT_ONCE])


@dataclass(frozen=True, slots=True, eq=False)
class Column:
    """The values of one input over a sample, in a few bytes each.

    Attributes
    ----------
    numbers
        The values, or places in `listed` where it holds some (n,).
    listed
        The values that the places name.
    """

    numbers: npt.NDArray[Any]
    listed: tuple[Any, ...] = ()

    def __getitem__(self, number: int) -> Any:
        """The value of a point."""
        return self.values(number, number + 1)[0]

    def values(self, first: int, last: int) -> list[Any]:
        """The values of the points from `first` to before `last`."""
        found = self.numbers[first:last].tolist()
        return [self.listed[place] for place in found] if self.listed else found


@dataclass(frozen=True, slots=True, eq=False)
class SampledPoints(Points):
    """A value of every column for each point.

    Attributes
    ----------
    fixed
        What all points share.
    columns
        By name; none of the names is fixed.
    n
        The number of points.
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
        return _fixed(self.fixed, name) if column is None else list(dict.fromkeys(column.values(0, self.n)))

    def json_texts(self) -> Iterator[str]:
        """A piece for each part of the sample."""
        head = "".join(f"{text}, " for text in _pairs(self.fixed))
        for first in range(0, self.n, AT_ONCE):
            last = min(first + AT_ONCE, self.n)
            pairs = [
                [f"{json.dumps(name)}: {text}" for text in map(json.dumps, column.values(first, last))]
                for name, column in self.columns.items()
            ]
            yield ", ".join(f"{{{head}{', '.join(each)}}}" for each in zip(*pairs, strict=True))


def _fixed(fixed: Mapping[str, Any], name: str) -> list[Any]:
    return [fixed[name]] if name in fixed else []


def _pairs(values: Mapping[str, Any]) -> list[str]:
    return [_pair(name, value) for name, value in values.items()]


def _pair(name: str, value: Any) -> str:
    return f"{json.dumps(name)}: {json.dumps(value)}"
