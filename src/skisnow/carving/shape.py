"""Growth of shape and stiffness of a clamped ski with its parameters, as the equations of a carve need it."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .._support.arrays import FloatArray, IntArray
from ..ski.beam import (
    GAUSS_POINTS,
    GAUSS_WEIGHTS,
    STATION_POINTS,
    ClampedSki,
    curvature_shape,
    deflection_shape,
    model_nodes,
    places_within,
    twist_shape,
)
from ..ski.editing import TableGrowth, table_growth

if TYPE_CHECKING:
    from ..ski.ski import Ski


@dataclass(frozen=True, slots=True, eq=False)
class Shape:
    """Growth of a ski's numbers in the equations with a parameter, SI per its unit.

    Attributes
    ----------
    node, length
        Nodes of the beam, and the lengths of its n elements.
    place, sections
        At two stations of each element: place; width and height of the base, shape (2, 2 n).
    stiffness
        EI and GJ at the Gauss points of each element, shape (2, n, 4).
    numbers
        Running length, greatest width at the stations, base bevel, edge width.
    moves, widens, stiffens
        Whether nodes, sections and stiffnesses grow at all.
    """

    node: FloatArray
    length: FloatArray
    place: FloatArray
    sections: FloatArray
    stiffness: FloatArray
    numbers: FloatArray
    moves: bool
    widens: bool
    stiffens: bool


class _Lines(NamedTuple):
    """Places on the straight lines between two rows of a ski's tables."""

    row: IntArray
    share: FloatArray
    spacing: FloatArray

    def along(self, table: FloatArray) -> FloatArray:
        """Values of tables (…, rows) at the places."""
        return np.asarray(table[..., self.row] + self.share * (table[..., self.row + 1] - table[..., self.row]))

    def moved(self, table: FloatArray, station: FloatArray, place: FloatArray) -> FloatArray:
        """Growth of these where the tables' stations and the places grow; the rows stay the same."""
        share = (self.along(station) - place) / self.spacing
        return np.asarray(share * (table[..., self.row + 1] - table[..., self.row]))


class _Mesh(NamedTuple):
    node: FloatArray
    stations: _Lines
    gauss: _Lines


@functools.lru_cache(maxsize=16)
def _mesh(station: bytes, clamp_length: float, elements: int) -> _Mesh:
    """Mesh on a ski with these stations, the same for all skis of its lengths."""
    rows = np.frombuffer(station)
    node = model_nodes(float(rows[0]), float(rows[-1]), clamp_length, elements)
    return _Mesh(
        node,
        _lines(station, places_within(node, STATION_POINTS).ravel()),
        _lines(station, places_within(node, GAUSS_POINTS)),
    )


def _lines(station: bytes, place: FloatArray) -> _Lines:
    rows = np.frombuffer(station)
    row = np.clip(np.searchsorted(-rows, -place, side="right") - 1, 0, len(rows) - 2)
    spacing = rows[row] - rows[row + 1]
    return _Lines(row, (rows[row] - place) / spacing, spacing)


@functools.lru_cache(maxsize=16)
def _lines_at(station: bytes, place: tuple[float, ...]) -> _Lines:
    return _lines(station, np.array(place))


def shape_growth(ski: Ski, name: str, clamp_length: float, elements: int) -> Shape:
    """Growth of the shape with a parameter of the ski; elements and rows of the tables keep their numbers."""
    growth, station = table_growth(ski, name), ski.station.tobytes()
    widest = _widest(ski, clamp_length, elements)
    fixed = _fixed_shape(growth, station, clamp_length, elements, widest)
    by_station = growth.tables[0]
    if not by_station.any():
        return fixed
    mesh, half = _mesh(station, clamp_length, elements), clamp_length / 2.0
    parts = np.array([float(ski.station[-1]), -half, half, float(ski.station[0])])
    node = np.interp(mesh.node, parts, [by_station[-1], 0.0, 0.0, by_station[0]])
    place, gauss = places_within(node, STATION_POINTS).ravel(), places_within(node, GAUSS_POINTS)
    sections = fixed.sections + mesh.stations.moved(np.array([ski.width, ski.base_height]), by_station, place)
    stiffness = np.array([ski.bending_stiffness, ski.torsional_stiffness])
    return Shape(
        node,
        node[:-1] - node[1:],
        place,
        sections,
        fixed.stiffness + mesh.gauss.moved(stiffness, by_station, gauss),
        np.array([fixed.numbers[0], sections[0, widest], *fixed.numbers[2:]]),
        moves=True,
        widens=True,
        stiffens=True,
    )


@functools.lru_cache(maxsize=512)
def _fixed_shape(growth: TableGrowth, station: bytes, clamp_length: float, elements: int, widest: int) -> Shape:
    """Growth of the shape on fixed places between fixed rows."""
    mesh, tables = _mesh(station, clamp_length, elements), growth.tables
    widens, stiffens = bool(tables[1:3].any()), bool(tables[3:].any())
    stations = len(mesh.stations.row)
    sections = mesh.stations.along(tables[1:3]) if widens else np.zeros((2, stations))
    stiffness = mesh.gauss.along(tables[3:]) if stiffens else np.zeros((2, *mesh.gauss.row.shape))
    running_length, bevel, edge_width = growth.numbers
    numbers = np.array([running_length, sections[0, widest], bevel, edge_width])
    none = np.zeros(len(mesh.node))
    return Shape(
        none, none[1:], np.zeros(stations), sections, stiffness, numbers, moves=False, widens=widens, stiffens=stiffens
    )


@functools.lru_cache(maxsize=64)
def _widest(ski: Ski, clamp_length: float, elements: int) -> int:
    """Number of the widest station."""
    return int(np.argmax(_mesh(ski.station.tobytes(), clamp_length, elements).stations.along(ski.width)))


@dataclass(frozen=True, slots=True, eq=False)
class Shapes:
    """Growth of a ski with several parameters, a row each: `Shape.numbers`, sections, stiffness of those at rest.

    `moving`: names of the parameters that move nodes; `tables`: growth of station, width and height of the base.
    """

    ski: Ski
    names: tuple[str, ...]
    moving: frozenset[str]
    tables: FloatArray
    numbers: FloatArray
    sections: FloatArray
    stiffness: FloatArray

    def sections_at(self, place: FloatArray) -> FloatArray:
        """Growth of width and height of the base with each parameter at fixed places (p, 2 k)."""
        lines = _lines_at(self.ski.station.tobytes(), tuple(place.tolist()))
        out = lines.along(self.tables[:, 1:])
        for row, name in enumerate(self.names):
            if name in self.moving:
                own = np.array([self.ski.width, self.ski.base_height])
                out[row] += lines.moved(own, self.tables[row, 0], 0.0 * place)
        return out.reshape(len(out), 2 * len(place))


@functools.lru_cache(maxsize=32)
def stacked_shapes(ski: Ski, names: tuple[str, ...], clamp_length: float, elements: int) -> Shapes:
    """Growth of the shape with each of the parameters."""
    shapes = [shape_growth(ski, name, clamp_length, elements) for name in names]
    stations = len(_mesh(ski.station.tobytes(), clamp_length, elements).stations.row)

    def stacked(rows: list[FloatArray], *size: int) -> FloatArray:
        return np.array(rows, float).reshape(len(names), *size)

    return Shapes(
        ski,
        names,
        frozenset(name for name, shape in zip(names, shapes, strict=True) if shape.moves),
        stacked([table_growth(ski, name).tables[:3] for name in names], 3, len(ski.station)),
        stacked([shape.numbers for shape in shapes], 4),
        stacked([shape.sections for shape in shapes], 2 * stations),
        stacked([0.0 * shape.stiffness if shape.moves else shape.stiffness for shape in shapes], 4 * stations),
    )


@functools.lru_cache(maxsize=32)
def _curvature(model: ClampedSki) -> tuple[FloatArray, FloatArray]:
    """Lengths of the elements, and their shapes of curvature at the Gauss points."""
    length = _lengths(model)
    return length, curvature_shape(GAUSS_POINTS[None, :], length[:, None])


def bent_by(model: ClampedSki, u: FloatArray, growth: Shape) -> FloatArray:
    """Growth of the beam's elastic forces at the same unknowns (size,)."""
    out, lengthens = np.zeros(model.size), growth.moves
    if not (lengthens or growth.stiffens):
        return out
    bending, torsion = growth.stiffness
    value, (length, curvature) = _values(model, u), _curvature(model)
    kappa, turn = curvature_and_turn(model, u)
    weight = GAUSS_WEIGHTS * length[:, None]
    force = np.einsum("ng,ngi->ni", weight * bending * kappa, curvature)
    if lengthens:
        stiff = model.ski.at(model.node[:-1, None] - length[:, None] * GAUSS_POINTS)
        stretch = (growth.length / length)[:, None, None]
        # shapes of curvature fall as 1/ℓ² with deflections and as 1/ℓ with slopes
        falls = -stretch * np.array([2.0, 1.0, 0.0, 2.0, 1.0, 0.0]) * curvature
        moment = stiff.bending_stiffness * kappa
        grown = stiff.bending_stiffness * np.einsum("ngi,ni->ng", falls, value) + moment * stretch[:, :, 0]
        force += np.einsum("ng,ngi->ni", weight * grown, curvature) + np.einsum("ng,ngi->ni", weight * moment, falls)
        torsion = torsion - stiff.torsional_stiffness * stretch[:, :, 0]
    torque = torsion @ GAUSS_WEIGHTS * turn[:, 0]
    force[:, 5] += torque
    force[:, 2] -= torque
    np.add.at(out, model.dof[model.dof >= 0], force[model.dof >= 0])
    return out


def curvature_and_turn(model: ClampedSki, u: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Curvature at the Gauss points (n, 4) and rate of twist of the elements (n, 1) for unknowns of the beam."""
    value, (length, curvature) = _values(model, u), _curvature(model)
    return np.einsum("ngi,ni->ng", curvature, value), (value[:, 5:] - value[:, 2:3]) / length[:, None]


def beam_gradient(model: ClampedSki, bent: tuple[FloatArray, FloatArray], adjoint: FloatArray) -> FloatArray:
    """Growth of λ·K u with EI and GJ at the Gauss points: w ℓ κ_u κ_λ, and with the rates of twist; (2, n, 4).

    `bent`: curvature and rate of twist of u.
    """
    kappa, turn = curvature_and_turn(model, adjoint)
    weight = GAUSS_WEIGHTS * _lengths(model)[:, None]
    return np.array([weight * bent[0] * kappa, weight * (bent[1] * turn)])


def beam_moved(model: ClampedSki, u: FloatArray, place: FloatArray, growth: Shape) -> tuple[FloatArray, FloatArray]:
    """Growth of deflection and twist at fixed places for the same unknowns, where nodes move."""
    if not growth.moves:
        return np.zeros(len(place)), np.zeros(len(place))
    element = np.clip(np.searchsorted(-model.node, -place, side="right") - 1, 0, len(model.dof) - 1)
    value = _values(model, u)[element]
    step = 1e-6 / max(1e-12, float(np.max(np.abs(growth.node))))

    def at(side: float) -> tuple[FloatArray, FloatArray]:
        node = model.node + side * step * growth.node
        length = node[element] - node[element + 1]
        local = (node[element] - place) / length
        return (
            np.sum(deflection_shape(local, length) * value, axis=-1),
            np.sum(twist_shape(local) * value, axis=-1),
        )

    (w1, t1), (w0, t0) = at(1.0), at(-1.0)
    return (w1 - w0) / (2.0 * step), (t1 - t0) / (2.0 * step)


def _values(model: ClampedSki, u: FloatArray) -> FloatArray:
    return np.where(model.dof >= 0, u[model.dof], 0.0)


def _lengths(model: ClampedSki) -> FloatArray:
    return np.asarray(model.node[:-1] - model.node[1:])
