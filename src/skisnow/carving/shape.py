"""Derivatives of shape and stiffness of a clamped ski by its parameters, as the equations of a carve need it."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

from .._support.arrays import FloatArray, IntArray
from ..ski.beam import (
    GAUSS_POINTS,
    GAUSS_WEIGHTS,
    STATION_POINTS,
    ClampedSki,
    curvature_shape,
    deflection_shape,
    element_places,
    model_nodes,
    slope_shape,
)
from ..ski.editing import TableGrowth, table_growth

if TYPE_CHECKING:
    from ..ski.ski import Ski


Edges: TypeAlias = Sequence[tuple[FloatArray, FloatArray]]
"""For each output: places of the edge (m), and derivatives by width, height, deflection, twist there (4, places)."""


@dataclass(frozen=True, slots=True, eq=False)
class Shape:
    """Derivatives of a ski's numbers in the equations by one parameter, in SI per unit of the parameter.

    node, length: Nodes of the beam, and the lengths of its n elements.
    place, sections: At two stations of each element: place; width and height of the base, shape (2, 2 n).
    stiffness: EI and GJ at the Gauss points of each element, shape (2, n, 4).
    numbers: Running length, greatest width at the stations, base bevel, edge width, angle of the side, radius of the
        edge.
    moves, widens, stiffens: True if nodes, sections and stiffnesses depend on the parameter.
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


class _Interpolation(NamedTuple):
    """Linear interpolation between the rows of a ski's tables at some places; `ends`: indices of both rows of each."""

    row: IntArray
    share: FloatArray
    spacing: FloatArray
    ends: IntArray

    def along(self, table: FloatArray) -> FloatArray:
        """Values of tables (…, rows) at the places."""
        here = table.take(self.row, axis=-1)
        return np.asarray(here + self.share * (table.take(self.row + 1, axis=-1) - here))

    def by_parameter(self, table: FloatArray, station_rate: FloatArray, place_rate: FloatArray) -> FloatArray:
        """Derivatives of `along(table)` by a parameter that moves stations and places at these rates."""
        share = (self.along(station_rate) - place_rate) / self.spacing
        return np.asarray(share * (table[..., self.row + 1] - table[..., self.row]))

    def to_rows(self, by_value: FloatArray, rows: int) -> FloatArray:
        """Derivatives by the rows of one or two tables, from those by the values at the places (`along`)."""
        tables = len(by_value)
        pair = np.concatenate([(1.0 - self.share) * by_value, self.share * by_value], axis=1)
        ends = self.ends[: tables * pair.shape[1]]
        return np.asarray(np.bincount(ends, pair.ravel(), tables * rows), float).reshape(tables, rows)

    def by_station(self, table: FloatArray, by_value: FloatArray) -> FloatArray:
        """Derivatives by the station of the table at each place; transpose of `by_parameter`."""
        return np.asarray(np.sum(by_value * (table[:, self.row + 1] - table[:, self.row]), axis=0) / self.spacing)


class _NodesAndInterpolation(NamedTuple):
    """Nodes of a beam (m), and the interpolations at its stations and at its Gauss points."""

    node: FloatArray
    stations: _Interpolation
    gauss: _Interpolation


@functools.lru_cache(maxsize=16)
def _mesh(station: bytes, clamp_length: float, elements: int) -> _NodesAndInterpolation:
    """Nodes of the beam, and interpolation of tables at these stations to its stations and Gauss points."""
    rows = np.frombuffer(station)
    node = model_nodes(float(rows[0]), float(rows[-1]), clamp_length, elements)
    return _NodesAndInterpolation(
        node,
        _interpolation(station, element_places(node, STATION_POINTS).ravel()),
        _interpolation(station, element_places(node, GAUSS_POINTS).ravel()),
    )


def _interpolation(station: bytes, place: FloatArray) -> _Interpolation:
    """Interpolation at places (m) in a table with these stations (bytes of floats, falling)."""
    rows = np.frombuffer(station)
    row = np.clip(np.searchsorted(-rows, -place, side="right") - 1, 0, len(rows) - 2)
    spacing, pair = rows[row] - rows[row + 1], np.concatenate([row, row + 1])
    return _Interpolation(row, (rows[row] - place) / spacing, spacing, np.concatenate([pair, pair + len(rows)]))


@functools.lru_cache(maxsize=16)
def _interpolation_at(station: bytes, place: tuple[float, ...]) -> _Interpolation:
    """Interpolation of a ski's tables at places (m)."""
    return _interpolation(station, np.array(place))


def shape_growth(ski: Ski, name: str, clamp_length: float, elements: int) -> Shape:
    """Derivatives of the shape by a parameter of the ski; the numbers of elements and of rows stay."""
    growth, station = table_growth(ski, name), ski.station.tobytes()
    widest = widest_station(ski, clamp_length, elements)
    fixed = _fixed_shape(growth, station, clamp_length, elements, widest)
    by_station = growth.tables[0]
    if not by_station.any():
        return fixed
    mesh, half = _mesh(station, clamp_length, elements), clamp_length / 2.0
    parts = np.array([float(ski.station[-1]), -half, half, float(ski.station[0])])
    node = np.interp(mesh.node, parts, [by_station[-1], 0.0, 0.0, by_station[0]])
    place, gauss = element_places(node, STATION_POINTS).ravel(), element_places(node, GAUSS_POINTS).ravel()
    sections = fixed.sections + mesh.stations.by_parameter(np.array([ski.width, ski.base_height]), by_station, place)
    stiffness = np.array([ski.bending_stiffness, ski.torsional_stiffness])
    return Shape(
        node,
        node[:-1] - node[1:],
        place,
        sections,
        fixed.stiffness + mesh.gauss.by_parameter(stiffness, by_station, gauss).reshape(fixed.stiffness.shape),
        np.array([fixed.numbers[0], sections[0, widest], *fixed.numbers[2:]]),
        moves=True,
        widens=True,
        stiffens=True,
    )


@functools.lru_cache(maxsize=512)
def _fixed_shape(growth: TableGrowth, station: bytes, clamp_length: float, elements: int, widest: int) -> Shape:
    """Derivatives of the shape by a parameter that changes values of the tables, but no stations."""
    mesh, tables = _mesh(station, clamp_length, elements), growth.tables
    widens, stiffens = bool(tables[1:3].any()), bool(tables[3:].any())
    stations = len(mesh.stations.row)
    sections = mesh.stations.along(tables[1:3]) if widens else np.zeros((2, stations))
    gauss = mesh.gauss.along(tables[3:]) if stiffens else np.zeros((2, len(mesh.gauss.row)))
    stiffness = gauss.reshape(2, -1, len(GAUSS_POINTS))
    numbers = np.insert(growth.numbers, 1, sections[0, widest])
    none = np.zeros(len(mesh.node))
    return Shape(
        none, none[1:], np.zeros(stations), sections, stiffness, numbers, moves=False, widens=widens, stiffens=stiffens
    )


@functools.lru_cache(maxsize=64)
def widest_station(ski: Ski, clamp_length: float, elements: int) -> int:
    """Number of the widest station."""
    return int(np.argmax(_mesh(ski.station.tobytes(), clamp_length, elements).stations.along(ski.width)))


@dataclass(frozen=True, slots=True, eq=False)
class ShapeGradient:
    """Derivatives of an output by the quantities in the equations that come from the ski's shape and stiffness.

    `stations`: by place, weight, width, height of the base, and ln(length) of the elements of the slopes (6, 2 n);
    `stiffness`: by EI and GJ at the Gauss points (2, n, 4); `widest`: by the greatest width; `edge`, `by_edge`: places
    of the edge (m), and derivatives by width, height, deflection and twist there (4, k).
    """

    stations: FloatArray
    stiffness: FloatArray
    widest: float
    edge: FloatArray
    by_edge: FloatArray

    def by_tables(self, model: ClampedSki, elements: int, u: FloatArray, adjoint: FloatArray) -> FloatArray:
        """Derivatives by station, width, base height, EI and GJ of each row of the ski's tables, shape (5, rows)."""
        station, rows = model.ski.station.tobytes(), len(model.ski.station)
        mesh, out = _mesh(station, model.clamp_length, elements), np.zeros((5, rows))
        out[0] = self._by_stations(model, elements, u, adjoint)
        out[1:3] = mesh.stations.to_rows(self._sections(model, elements), rows)
        out[3:] = mesh.gauss.to_rows(self.stiffness.reshape(2, -1), rows)
        if len(self.edge):
            out[1:3] += _interpolation_at(station, tuple(self.edge.tolist())).to_rows(self.by_edge[:2], rows)
        return out

    def _sections(self, model: ClampedSki, elements: int) -> FloatArray:
        """Derivatives by width and base height at the stations, with that by the widest width added."""
        out = self.stations[2:4].copy()
        out[0, widest_station(model.ski, model.clamp_length, elements)] += self.widest
        return out

    def _by_stations(self, model: ClampedSki, elements: int, u: FloatArray, adjoint: FloatArray) -> FloatArray:
        """Derivatives of the output by the station of each row (rows,), through moved places and longer elements."""
        ski, half = model.ski, model.clamp_length / 2.0
        mesh, rows = _mesh(ski.station.tobytes(), model.clamp_length, elements), len(ski.station)
        shape = np.array([ski.width, ski.base_height])
        stiffness = np.array([ski.bending_stiffness, ski.torsional_stiffness])
        lines = mesh.stations, mesh.gauss, _interpolation_at(ski.station.tobytes(), tuple(self.edge.tolist()))
        by_line = [
            lines[0].by_station(shape, self._sections(model, elements)),
            lines[1].by_station(stiffness, self.stiffness.reshape(2, -1)),
            lines[2].by_station(shape, self.by_edge[:2]),
        ]
        out = np.sum([line.to_rows(by[None], rows)[0] for line, by in zip(lines, by_line, strict=True)], axis=0)
        station = (self.stations[0] - by_line[0]).reshape(-1, 2)
        gauss = -by_line[1].reshape(-1, len(GAUSS_POINTS))
        length = model.node[:-1] - model.node[1:]
        by_length = (self.stations[1] / 2.0 + (self.stations[4] + self.stations[5]) / np.repeat(length, 2)).reshape(
            -1, 2
        )
        stretch = _by_stretch(model, mesh.gauss.along(stiffness).reshape(self.stiffness.shape), u, adjoint)
        longer = by_length.sum(axis=1) + stretch / length
        node = np.zeros(len(mesh.node))
        node[:-1] += station @ (1.0 - STATION_POINTS) + gauss @ (1.0 - GAUSS_POINTS) + longer
        node[1:] += station @ STATION_POINTS + gauss @ GAUSS_POINTS - longer
        self._add_edge(model, u, node)
        out[0] += node @ np.clip((mesh.node - half) / (ski.station[0] - half), 0.0, 1.0)
        out[-1] += node @ np.clip((mesh.node + half) / (ski.station[-1] + half), 0.0, 1.0)
        return out

    def _add_edge(self, model: ClampedSki, u: FloatArray, node: FloatArray) -> None:
        """Add to `node` the derivatives by the nodes through deflection and twist at fixed places of the edge."""
        element = np.clip(np.searchsorted(-model.node, -self.edge, side="right") - 1, 0, len(model.dof) - 1)
        value, length = _by_element(model, u)[element], (model.node[:-1] - model.node[1:])[element]
        local, (by_deflection, by_twist) = (model.node[element] - self.edge) / length, self.by_edge[2:]
        slope = np.sum(slope_shape(local, length) * value, axis=1)
        forward = by_deflection * slope + by_twist * (value[:, 5] - value[:, 2]) / length
        of_slopes = np.sum((deflection_shape(local, length) * value)[:, [1, 4]], axis=1) / length
        longer = by_deflection * of_slopes - local * forward
        np.add.at(node, element, forward + longer)
        np.add.at(node, element + 1, -longer)


def _by_stretch(model: ClampedSki, stiffness: FloatArray, u: FloatArray, adjoint: FloatArray) -> FloatArray:
    """Derivatives of λ·K u by the logarithm of each element's length; curvature shapes fall as 1/ℓ² and 1/ℓ."""
    length, curvature = _curvature(model)
    falls = -np.array([2.0, 1.0, 0.0, 2.0, 1.0, 0.0]) * curvature
    (own, turn), (back, turn_back) = (curvature_and_turn(model, unknowns) for unknowns in (u, adjoint))
    own_falls, back_falls = (np.einsum("ngi,ni->ng", falls, _by_element(model, unknowns)) for unknowns in (u, adjoint))
    moment = stiffness[0] * ((own_falls + own) * back + own * back_falls) - stiffness[1] * turn * turn_back
    return np.asarray(moment @ GAUSS_WEIGHTS * length)


def _curvature(model: ClampedSki) -> tuple[FloatArray, FloatArray]:
    """Lengths of the elements, and their shapes of curvature at the Gauss points."""
    return _curvature_between(model.node.tobytes())


@functools.lru_cache(maxsize=16)
def _curvature_between(nodes: bytes) -> tuple[FloatArray, FloatArray]:
    """Lengths of the elements between nodes (m), and the curvature shapes at their Gauss points."""
    node = np.frombuffer(nodes)
    length = node[:-1] - node[1:]
    return length, curvature_shape(GAUSS_POINTS[None, :], length[:, None])


def bent_by(model: ClampedSki, u: FloatArray, growth: Shape) -> FloatArray:
    """Derivatives (size,) of the beam's elastic forces by the parameter of `growth`, at constant unknowns u."""
    out, lengthens = np.zeros(model.size), growth.moves
    if not (lengthens or growth.stiffens):
        return out
    bending, torsion = growth.stiffness
    value, (length, curvature) = _by_element(model, u), _curvature(model)
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
    value, (length, curvature) = _by_element(model, u), _curvature(model)
    return np.einsum("ngi,ni->ng", curvature, value), (value[:, 5:] - value[:, 2:3]) / length[:, None]


def beam_gradients(model: ClampedSki, u: FloatArray, adjoint: FloatArray) -> FloatArray:
    """Derivatives of λ·K u by EI and GJ at the Gauss points: w ℓ κ_u κ_λ, and with the rates of twist.

    For k pairs of u and λ, each (k, size); shape (k, 2, n, 4).
    """
    (length, curvature), pairs = _curvature(model), len(u)
    unknowns = np.zeros((2 * pairs, model.size + 1))  # -1: held
    unknowns[:pairs, :-1], unknowns[pairs:, :-1] = u, adjoint
    value = unknowns.take(model.dof, axis=1)
    kappa = (value.swapaxes(0, 1) @ curvature.swapaxes(1, 2)).swapaxes(0, 1)
    turn = (value[:, :, 5] - value[:, :, 2]) / length
    weight, out = GAUSS_WEIGHTS * length[:, None], np.empty((pairs, 2, *curvature.shape[:2]))
    out[:, 0] = weight * kappa[:pairs] * kappa[pairs:]
    out[:, 1] = weight * (turn[:pairs] * turn[pairs:])[:, :, None]
    return out


def growth_by_tables(
    model: ClampedSki, elements: int, tables: FloatArray, columns: FloatArray, stiffness: FloatArray, edges: Edges
) -> FloatArray:
    """Derivatives (k, parameters) of outputs by parameters that change the tables (parameters, 5, rows), not stations.

    columns, stiffness, edges: derivatives of outputs by width and height of the base at the stations (k, 2, 2 n), by
    EI and GJ at the Gauss points (k, 2, n, 4), and by width and height at places of the edge.
    """
    station, out = model.ski.station.tobytes(), np.zeros((len(columns), len(tables)))
    mesh, grow = _mesh(station, model.clamp_length, elements), np.asarray(tables.any(axis=-1))
    by_gauss = stiffness.reshape(*stiffness.shape[:2], -1)
    for number in np.flatnonzero(grow.any(axis=0)).tolist():
        which = grow[:, number]
        table, lines = tables[which, number], mesh.stations if number < 3 else mesh.gauss
        by = columns[:, number - 1] if number < 3 else by_gauss[:, number - 3]
        out[:, which] += by @ lines.along(table).T
        for row, (place, by_edge) in enumerate(edges if number < 3 else ()):
            if len(place):
                out[row, which] += _interpolation_at(station, tuple(place.tolist())).along(table) @ by_edge[number - 1]
    return out


def _by_element(model: ClampedSki, u: FloatArray) -> FloatArray:
    """Displacements of each element's degrees of freedom, shape (elements, dofs); 0 where the beam is held."""
    return np.append(u, 0.0)[model.dof]  # -1: held
