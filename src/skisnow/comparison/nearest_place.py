"""Nearest places on a path of straight pieces, and whether a point is beyond the ends of the path."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from .._support.arrays import BoolArray, FloatArray
from .._support.errors import ParameterError

IntArray = npt.NDArray[np.intp]

BESIDE_END: Final = 0.01
"""A point counts as beside an end if it is ahead of it by at most this share of its distance (0.6°).

The direction of the last piece is not exactly the path's direction at its end. The tolerance increases the distance by
at most 5 parts in 100 000.
"""
_LONGEST: Final = 2.0
"""Longest piece between two nodes, in mean lengths of the pieces."""
_FIRST_NEIGHBOURS: Final = 4
_MOST_NUMBERS: Final = 1 << 17
"""Maximum number of neighbours in one query."""
_ROUNDING: Final = 1e-12
"""Relative error of squared distances."""


@dataclass(frozen=True, slots=True, eq=False)
class NearestPlaces:
    """Nearest places of n points.

    foot: (n, d) m, the nearest place on the path.
    distance: (n,) m, distance to it.
    arc_length: (n,) m, length of the path up to it.
    direction: (n, d), unit vector of the path there.
    where: (n,), number of the straight piece or point of the path on which the nearest place is.
    beyond: (n,) bool, True if the nearest place is an end of the path and the point is ahead of that end.
    """

    foot: FloatArray
    distance: FloatArray
    arc_length: FloatArray
    direction: FloatArray
    where: IntArray
    beyond: BoolArray


class Path:
    """Path of straight pieces through points, with a search for nearest places.

    Long pieces are divided by further nodes, and SciPy's k-d tree finds the nodes next to a point. A place within a
    piece of length L at the distance r from a point has an end of its piece within √(r² + L²/4). The number of
    neighbouring nodes is therefore doubled until the next one is farther than that for the nearest piece so far.

    points: (m, d) m, points in their order, d = 2 or 3, all finite, at least two different ones.
    """

    def __init__(self, points: FloatArray) -> None:
        places = points[np.concatenate([[True], np.any(np.diff(points, axis=0) != 0.0, axis=1)])]
        if len(places) < 2:
            raise ParameterError("a path needs two points in different places; all of these are in one").tag(
                "one_place"
            )
        self._start, self._along = places[:-1], np.diff(places, axis=0)
        self._squared = (self._along**2).sum(axis=1)
        self._piece = np.sqrt(self._squared)
        self._arc_length = np.concatenate([[0.0], np.cumsum(self._piece)])
        counts = np.maximum(1, np.ceil(self._piece / (_LONGEST * self._piece.mean()))).astype(np.intp)
        piece = np.repeat(np.arange(len(counts)), counts)
        share = (np.arange(len(piece)) - np.repeat(np.cumsum(counts) - counts, counts)) / counts[piece]
        nodes = self._start[piece] + share[:, None] * self._along[piece]
        self._tree = cKDTree(np.concatenate([nodes, places[-1:]]))
        self._before, self._after = np.append(piece[:1], piece), np.append(piece, piece[-1:])
        self._slack = 0.25 * float((self._piece / counts).max()) ** 2

    @property
    def first(self) -> FloatArray:
        """Its first point, (d,) (m)."""
        return self._start[0]

    @property
    def length(self) -> float:
        """Length of all pieces (m)."""
        return float(self._arc_length[-1])

    def nearest(self, points: FloatArray) -> NearestPlaces:
        """Nearest places on the pieces for points (n, d)."""
        piece = np.empty(len(points), dtype=np.intp)
        self._search(points, np.arange(len(points)), _FIRST_NEIGHBOURS, piece)
        start, along = self._start[piece], self._along[piece]
        raw = ((points - start) * along).sum(axis=1) / self._squared[piece]
        share = np.clip(raw, 0.0, 1.0)
        foot = start + share[:, None] * along
        distance = np.linalg.norm(points - foot, axis=1)
        ahead = np.where(piece == len(self._piece) - 1, raw - 1.0, -np.inf)
        ahead = np.maximum(ahead, np.where(piece == 0, -raw, -np.inf)) * self._piece[piece]
        return NearestPlaces(
            foot=foot,
            distance=distance,
            arc_length=self._arc_length[piece] + share * self._piece[piece],
            direction=along / self._piece[piece, None],
            where=2 * piece + np.sign(raw - share).astype(np.intp),
            beyond=ahead > np.maximum(BESIDE_END * distance, 1e-9 * self.length),
        )

    def _search(self, points: FloatArray, numbers: IntArray, neighbours: int, nearest: IntArray) -> None:
        """Write the piece nearest to each point in `numbers`, the first of equally near ones, into `nearest`.

        neighbours: number of nodes that are searched first; it is doubled for points that need more.
        """
        count = min(neighbours, self._tree.n)
        size = max(1, _MOST_NUMBERS // count)
        for begin in range(0, len(numbers), size):
            chunk = numbers[begin : begin + size]
            distance, node = (np.reshape(result, (-1, count)) for result in self._tree.query(points[chunk], k=count))
            piece = np.concatenate([self._before[node], self._after[node]], axis=1)
            square = self._squares(points[chunk], piece)
            least = square.min(axis=1)
            nearest[chunk] = np.where(square == least[:, None], piece, len(self._squared)).min(axis=1)
            unsure = distance[:, -1] ** 2 <= (1.0 + _ROUNDING) * (least + self._slack)
            if count < self._tree.n and unsure.any():
                self._search(points, chunk[unsure], 2 * count, nearest)

    def _squares(self, points: FloatArray, piece: IntArray) -> FloatArray:
        """Squared distances (n, k) of points (n, d) from pieces (n, k)."""
        number = piece.ravel()
        apart, along, squared = np.repeat(points, piece.shape[1], axis=0), self._along[number], self._squared[number]
        apart -= self._start[number]
        share = np.einsum("nd,nd->n", apart, along)
        share = np.clip(np.divide(share, squared, out=np.zeros_like(share), where=squared > 0.0), 0.0, 1.0)
        apart -= share[:, None] * along
        return np.asarray(np.einsum("nd,nd->n", apart, apart)).reshape(piece.shape)


def distance_from_path(points: FloatArray, path: FloatArray) -> FloatArray:
    """Distance (n,) of points (n, d) to the nearest place of a path through (m, d) (m).

    NaN for points ahead of the path's ends or not finite, and for all points if the path has only one place.

    >>> path = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]])
    >>> distance_from_path(np.array([[1.0, 2.0, 0.0], [2.0, 3.0, 0.0], [5.0, 3.0, 0.0]]), path)
    array([ 2.,  3., nan])
    """
    distance = np.full(len(points), np.nan)
    path = path[np.isfinite(path).all(axis=1)]
    finite = np.isfinite(points).all(axis=1)
    if finite.any() and np.any(path != path[:1]):
        nearest = Path(path).nearest(points[finite])
        distance[finite] = np.where(nearest.beyond, np.nan, nearest.distance)
    return distance
