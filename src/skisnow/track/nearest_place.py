"""The nearest place on a path of straight pieces: between its points too, and with a word on who is beyond its ends."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from .._support.errors import ParameterError
from .piece_tree import PieceTree

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.intp]
BoolArray = npt.NDArray[np.bool_]

ABREAST: Final = 0.01
"""A place counts as beside an end while it is ahead of it by no more than this share of its distance (0.6°).

The last straight piece of a path is never quite the path's direction at its end; the distance is larger by at most
5 parts in 100 000 for it.
"""


@dataclass(frozen=True, slots=True, eq=False)
class NearestPlaces:
    """Of n asked points.

    Attributes
    ----------
    foot : (n, d) m
        The nearest place on the path.
    distance : (n,) m
        To it.
    arc_length : (n,) m
        Length of the path up to it.
    direction : (n, d)
        Unit vector of the path there.
    where : (n,)
        A number for each straight piece and each point of the path: the same for places on one of them.
    beyond : (n,) bool
        The nearest place is an end of the path, and the point is ahead of that end, outwards.
    """

    foot: FloatArray
    distance: FloatArray
    arc_length: FloatArray
    direction: FloatArray
    where: IntArray
    beyond: BoolArray


class Path:
    """Straight pieces through points, ready to be asked for nearest places.

    Parameters
    ----------
    points : (m, d) m
        In their order, d = 2 or 3, all finite, at least two of them in different places.

    Raises
    ------
    ParameterError
        All points are in one place.
    """

    def __init__(self, points: FloatArray) -> None:
        places = points[np.concatenate([[True], np.any(np.diff(points, axis=0) != 0.0, axis=1)])]
        if len(places) < 2:
            raise ParameterError("a path needs two points in different places; all of these are in one")
        self._start = places[:-1]
        self._along = np.diff(places, axis=0)
        self._squared = (self._along**2).sum(axis=1)
        self._piece = np.sqrt(self._squared)
        self._arc_length = np.concatenate([[0.0], np.cumsum(self._piece)])
        self._tree = PieceTree(places)

    @property
    def first(self) -> FloatArray:
        """Its first point, (d,) (m)."""
        return self._start[0]

    @property
    def length(self) -> float:
        """Of all pieces (m)."""
        return float(self._arc_length[-1])

    def nearest(self, points: FloatArray) -> NearestPlaces:
        """The nearest places to points (n, d): the true ones, on the pieces and not only among their ends."""
        piece = self._tree.nearest(points)
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
            beyond=ahead > np.maximum(ABREAST * distance, 1e-9 * self.length),
        )


def distance_beside(points: FloatArray, path: FloatArray) -> FloatArray:
    """Distance (n,) of points (n, d) to the nearest place of a path through (m, d) (m).

    NaN where there is none: ahead of the path's ends, at points that are not finite, and everywhere where the path is
    all in one place.

    >>> path = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]])
    >>> distance_beside(np.array([[1.0, 2.0, 0.0], [2.0, 3.0, 0.0], [5.0, 3.0, 0.0]]), path)
    array([ 2.,  3., nan])
    """
    distance = np.full(len(points), np.nan)
    path = path[np.isfinite(path).all(axis=1)]
    known = np.isfinite(points).all(axis=1)
    if known.any() and np.any(path != path[:1]):
        found = Path(path).nearest(points[known])
        distance[known] = np.where(found.beyond, np.nan, found.distance)
    return distance
