"""The nearest of many straight pieces that follow each other, by bounds on groups of their ends.

Ends are halved again and again across the direction in which a group is longest. A group lies within some radius of a
segment along that direction, so none of its ends is nearer to a point than the segment less the radius. A nearest place
within a piece is the foot of a perpendicular, so one end of that piece is no farther than the root of distance² +
(length of the piece / 2)². Groups beyond that are left out, the others opened. On a smooth path the radius falls with
the square of a group's length whatever the direction from which it is seen; boxes along the axes, seen aslant, leave
hundreds of groups.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.intp]

_SMALLEST_GROUP: Final = 4
_FIRST_GROUPS: Final = 8
_POINTS_AT_ONCE: Final = 1 << 12
"""So that what is looked at for them stays near the processor."""
_MOST_AT_ONCE: Final = 1 << 20
"""Groups."""
_ROUNDING: Final = 1e-12
"""Share by which squares may be wrong: a group is left out only where it is farther by more."""


@dataclass(frozen=True, slots=True, eq=False)
class _Segments:
    """Straight segments: first point (k, d), vector to the last (k, d), squared length (k,)."""

    start: FloatArray
    along: FloatArray
    squared: FloatArray

    def squares(self, points: FloatArray, number: IntArray) -> FloatArray:
        """Squared distances of points (n, d) to the segment with the number (n,) given for each."""
        apart, along, squared = points - self.start[number], self.along[number], self.squared[number]
        share = np.einsum("nd,nd->n", apart, along)
        share = np.clip(np.divide(share, squared, out=np.zeros_like(share), where=squared > 0.0), 0.0, 1.0)
        apart -= share[:, None] * along
        return np.asarray(np.einsum("nd,nd->n", apart, apart))


@dataclass(frozen=True, slots=True, eq=False)
class _Level:
    """Groups of about equal numbers of ends.

    Attributes
    ----------
    bounds : (k + 1,)
        Of the groups among the sorted ends.
    middle
        A segment along each group.
    radius : (k,)
        Within which of it all ends lie.
    slack : (k,)
        Square of half the longest piece that begins or ends in it.
    one : (k, d)
        An end of each.
    """

    bounds: IntArray
    middle: _Segments
    radius: FloatArray
    slack: FloatArray
    one: FloatArray


class PieceTree:
    """Straight pieces through places, ready to be asked which is nearest.

    Parameters
    ----------
    places : (m + 1, d) m
        Ends of m pieces, one or more.
    """

    def __init__(self, places: FloatArray) -> None:
        along = np.diff(places, axis=0)
        squared = (along**2).sum(axis=1)
        self._pieces = _Segments(places[:-1], along, squared)
        self._order = np.arange(len(places))
        slack = 0.25 * np.maximum(np.append(squared, 0.0), np.append(0.0, squared))
        rounding = 1e-13 * (1.0 + float(np.abs(places).max()))
        self._levels: list[_Level] = []
        deepest = max(0, math.ceil(math.log2(len(places) / _SMALLEST_GROUP)))
        for depth in range(deepest + 1):
            bounds = np.arange(2**depth + 1) * len(places) // 2**depth
            sorted_places, own = places[self._order], np.repeat(np.arange(2**depth), np.diff(bounds))
            axis, mean = _axes(sorted_places, bounds)
            apart = sorted_places - mean[own]
            where = np.einsum("nd,nd->n", apart, axis[own])
            if 2**depth >= _FIRST_GROUPS or depth == deepest:
                away = np.linalg.norm(apart - where[:, None] * axis[own], axis=1)
                low, high = (each.reduceat(where, bounds[:-1]) for each in (np.minimum, np.maximum))
                middle = _Segments(mean + low[:, None] * axis, (high - low)[:, None] * axis, (high - low) ** 2)
                radius, longest = (np.maximum.reduceat(each, bounds[:-1]) for each in (away, slack[self._order]))
                one = sorted_places[(bounds[:-1] + bounds[1:]) // 2]
                self._levels.append(_Level(bounds, middle, radius + rounding, longest, one))
            if depth < deepest:
                self._order = self._order[np.lexsort((where, own))]

    def nearest(self, points: FloatArray) -> IntArray:
        """Number of the nearest piece for each of the points (n, d)."""
        found = np.empty(len(points), dtype=np.intp)
        todo = [(first, first + _POINTS_AT_ONCE) for first in range(0, len(points), _POINTS_AT_ONCE)]
        while todo:
            first, last = todo.pop()
            last = min(last, len(points))
            some = self._among(points[first:last])
            if some is not None:
                found[first:last] = some
            else:
                middle = (first + last) // 2
                todo += [(middle, last), (first, middle)]
        return found

    def _among(self, points: FloatArray) -> IntArray | None:
        """The same for some points; None where too many groups would have to be looked at at once."""
        count = len(self._levels[0].one)
        asked = np.repeat(np.arange(len(points)), count)
        group = np.tile(np.arange(count), len(points))
        within = np.full(len(points), np.inf)  # squared distance in which there is an end
        for depth, level in enumerate(self._levels):
            if depth:
                asked, group = np.repeat(asked, 2), np.repeat(2 * group, 2)
                group[1::2] += 1
            if len(asked) > _MOST_AT_ONCE and len(points) > 1:
                return None
            where = points[asked]
            apart = where - level.one[group]
            within = np.minimum(within, _least_of_each(asked, np.einsum("nd,nd->n", apart, apart)))
            least = np.maximum(np.sqrt(level.middle.squares(where, group)) - level.radius[group], 0.0) ** 2
            kept = least <= (1.0 + _ROUNDING) * within[asked] + level.slack[group]
            asked, group = asked[kept], group[kept]
        asked, piece = self._opened(asked, group)
        square = self._pieces.squares(points[asked], piece)
        nearest = np.flatnonzero(square == _least_of_each(asked, square)[asked])
        found = np.empty(len(points), dtype=np.intp)
        found[asked[nearest[::-1]]] = piece[nearest[::-1]]  # the first of equals
        return found

    def _opened(self, asked: IntArray, group: IntArray) -> tuple[IntArray, IntArray]:
        """The pieces on both sides of every end in the groups."""
        bounds = self._levels[-1].bounds
        sizes = np.diff(bounds)[group]
        within = np.arange(int(sizes.sum())) - np.repeat(np.cumsum(sizes) - sizes, sizes)
        end = self._order[np.repeat(bounds[group], sizes) + within]
        sides = np.stack([np.maximum(end - 1, 0), np.minimum(end, len(self._pieces.squared) - 1)], axis=1)
        return np.repeat(asked, 2 * sizes), sides.ravel()


def _least_of_each(asked: IntArray, square: FloatArray) -> FloatArray:
    """The least square of each point; every number from 0 on is asked, and they do not fall."""
    return np.minimum.reduceat(square, np.flatnonzero(np.diff(asked, prepend=-1)))


def _axes(places: FloatArray, bounds: IntArray) -> tuple[FloatArray, FloatArray]:
    """About the direction in which each group of places is longest, (k, d), and its mean, (k, d).

    A power of the scatter has the longest direction in all its columns; the bounds hold for any direction.
    """
    count = np.diff(bounds)[:, None]
    mean = np.add.reduceat(places, bounds[:-1], axis=0) / count
    apart = places - np.repeat(mean, count[:, 0], axis=0)
    scatter = np.add.reduceat(apart[:, :, None] * apart[:, None, :], bounds[:-1], axis=0)
    for _ in range(4):
        scatter /= np.maximum(np.trace(scatter, axis1=1, axis2=2), 1e-300)[:, None, None]
        scatter = scatter @ scatter
    column = np.argmax(np.einsum("kdd->kd", scatter), axis=1)
    axis = scatter[np.arange(len(scatter)), :, column]
    length = np.linalg.norm(axis, axis=1)
    axis[length == 0.0, 0] = 1.0  # all in one place
    return axis / np.where(length > 0.0, length, 1.0)[:, None], mean
