"""Shape and stiffness of a clamped ski as the equations of a carve need them, and their derivatives."""

from __future__ import annotations

import functools
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Final

import numpy as np

from .._support.arrays import FloatArray
from ..ski.beam import (
    GAUSS_POINTS,
    GAUSS_WEIGHTS,
    ClampedSki,
    curvature_shape,
    deflection_shape,
    model_nodes,
    twist_shape,
)
from ..ski.editing import LINEAR, is_linear, require_own_tables, shape_value, stiffness_growth, varied_ski

if TYPE_CHECKING:
    from ..ski.ski import Ski


_GAUSS_PLACES: Final = np.array([(1.0 - 1.0 / np.sqrt(3.0)) / 2.0, (1.0 + 1.0 / np.sqrt(3.0)) / 2.0])
_FREE: Final = ("name", "source", "mass_kg", "EI_N_m2", "GJ_N_m2", *LINEAR)  # keys without effect on linear growths
_MOST_KEPT: Final = 256
_LINEAR_GROWTHS: Final[dict[tuple[object, ...], Shape]] = {}
_STEP: Final = 1e-3  # step of a parameter; lengths in mm


@dataclass(frozen=True, slots=True, eq=False)
class Shape:
    """Numbers of a ski in the equations, SI; as a growth: per unit of a parameter.

    Attributes
    ----------
    node, length
        Nodes of the beam, and the lengths of its n elements.
    place, width, base_height
        At two stations of each element.
    bending, torsion
        EI and GJ at the Gauss points of each element, shape (n, 4).
    edge
        Place, width and base height at the places of the edge line that an output names, shape (3, k).
    numbers
        Running length, greatest width at the stations, base bevel, edge width.
    """

    node: FloatArray
    length: FloatArray
    place: FloatArray
    width: FloatArray
    base_height: FloatArray
    bending: FloatArray
    torsion: FloatArray
    edge: FloatArray
    numbers: FloatArray

    @property
    def stiffness(self) -> tuple[FloatArray, FloatArray]:
        """EI and GJ."""
        return self.bending, self.torsion

    def combined(self, other: Shape, own: float, others: float) -> Shape:
        """The sum of both, each times a factor."""
        return Shape(*(own * getattr(self, f.name) + others * getattr(other, f.name) for f in fields(Shape)))


def shape_of(ski: Ski, clamp_length: float, elements: int, edge: FloatArray) -> Shape:
    """Shape of a ski; `edge`: places (m from the boot) of the edge line."""
    node = model_nodes(ski, clamp_length, elements)
    length = node[:-1] - node[1:]
    place = (node[:-1, None] - length[:, None] * _GAUSS_PLACES).ravel()
    here, stiff = ski.at(place), ski.at(node[:-1, None] - length[:, None] * GAUSS_POINTS)
    on_edge = ski.at(edge)
    return Shape(
        node,
        length,
        place,
        here.width,
        here.base_height,
        stiff.bending_stiffness,
        stiff.torsional_stiffness,
        np.array([edge, on_edge.width, on_edge.base_height]),
        np.array([ski.running_length, here.width.max(), ski.base_bevel, ski.edge_width]),
    )


def shape_growth(ski: Ski, name: str, clamp_length: float, elements: int, edge: tuple[float, ...]) -> Shape:
    """Growth of the shape with a parameter of the ski, per its unit; meshes and tables keep their numbers of rows.

    Central differences of the ski, without an equilibrium: exact where it is linear in the parameter, otherwise
    extrapolated (Richardson).
    """
    key = name.removeprefix("ski.")
    if not name.startswith("ski.") or not ski.keys or not is_linear(ski.keys, key):
        return _growth_of(ski, name, clamp_length, elements, edge)
    shape_value(ski, name)  # the name is checked
    require_own_tables(ski)
    # the derivative by a linear parameter is the same for all skis of these lengths
    same = tuple((k, str(v)) for k, v in ski.keys.items() if k not in _FREE)
    widest = int(np.argmax(ski.width))
    if (same, widest, key, clamp_length, elements, edge) not in _LINEAR_GROWTHS:
        if len(_LINEAR_GROWTHS) >= _MOST_KEPT:
            _LINEAR_GROWTHS.clear()
        growth = _growth_of(ski, name, clamp_length, elements, edge)
        _LINEAR_GROWTHS[same, widest, key, clamp_length, elements, edge] = growth
    return _LINEAR_GROWTHS[same, widest, key, clamp_length, elements, edge]


@functools.lru_cache(maxsize=256)
def _growth_of(ski: Ski, name: str, clamp_length: float, elements: int, edge: tuple[float, ...]) -> Shape:
    value, places = shape_value(ski, name), np.array(edge)
    stiffness = stiffness_growth(ski, name)
    if stiffness is not None:
        return _stiffer(ski, model_nodes(ski, clamp_length, elements), places, *stiffness)
    # a length moves stations over rows of the tables, between which they are linear: a small step
    step = _STEP * abs(value) if value and not name.endswith("_mm") else _STEP

    def central(h: float) -> Shape:
        ends = [shape_of(varied_ski(ski, name, side * h), clamp_length, elements, places) for side in (1.0, -1.0)]
        return ends[0].combined(ends[1], 0.5 / h, -0.5 / h)

    if name.startswith("edit.") or is_linear(ski.keys or {}, name.removeprefix("ski.")):
        return central(1e-2 * abs(value) or _STEP)
    return central(step / 2.0).combined(central(step), 4.0 / 3.0, -1.0 / 3.0)


def _stiffer(ski: Ski, node: FloatArray, edge: FloatArray, attribute: str, growth: FloatArray) -> Shape:
    """Growth of a shape by that of one stiffness at the ski's stations."""
    length = node[:-1] - node[1:]
    table = np.interp(node[:-1, None] - length[:, None] * GAUSS_POINTS, ski.station[::-1], growth[::-1])
    tables = (table, 0.0 * table) if attribute == "bending_stiffness" else (0.0 * table, table)
    stations, at_edge = np.zeros(2 * len(length)), np.zeros((3, len(edge)))
    return Shape(0.0 * node, 0.0 * length, stations, stations, stations, *tables, at_edge, np.zeros(4))


@functools.lru_cache(maxsize=32)
def _curvature(model: ClampedSki) -> tuple[FloatArray, FloatArray]:
    """Lengths of the elements, and their shapes of curvature at the Gauss points."""
    length = _lengths(model)
    return length, curvature_shape(GAUSS_POINTS[None, :], length[:, None])


def bent_by(model: ClampedSki, u: FloatArray, growth: Shape) -> FloatArray:
    """Growth of the beam's elastic forces at the same unknowns (size,)."""
    out, lengthens = np.zeros(model.size), growth.length.any()
    if not (lengthens or growth.bending.any() or growth.torsion.any()):
        return out
    value = _values(model, u)
    length, curvature = _curvature(model)
    kappa = np.einsum("ngi,ni->ng", curvature, value)
    weight = GAUSS_WEIGHTS * length[:, None]
    turn = (value[:, 5] - value[:, 2]) / length
    force = np.einsum("ng,ngi->ni", weight * growth.bending * kappa, curvature)
    torsion = growth.torsion
    if lengthens:
        stiff = model.ski.at(model.node[:-1, None] - length[:, None] * GAUSS_POINTS)
        stretch = (growth.length / length)[:, None, None]
        # shapes of curvature fall as 1/ℓ² with deflections and as 1/ℓ with slopes
        falls = -stretch * np.array([2.0, 1.0, 0.0, 2.0, 1.0, 0.0]) * curvature
        moment = stiff.bending_stiffness * kappa
        grown = stiff.bending_stiffness * np.einsum("ngi,ni->ng", falls, value) + moment * stretch[:, :, 0]
        force += np.einsum("ng,ngi->ni", weight * grown, curvature) + np.einsum("ng,ngi->ni", weight * moment, falls)
        torsion = torsion - stiff.torsional_stiffness * stretch[:, :, 0]
    torque = torsion @ GAUSS_WEIGHTS * turn
    force[:, 5] += torque
    force[:, 2] -= torque
    np.add.at(out, model.dof[model.dof >= 0], force[model.dof >= 0])
    return out


def curvature_and_turn(model: ClampedSki, u: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Curvature at the Gauss points (n, 4) and rate of twist of the elements (n, 1) for unknowns of the beam."""
    value, length = _values(model, u), _lengths(model)[:, None]
    z = GAUSS_POINTS[None, :]
    bend = (12.0 * z - 6.0) / length**2 * (value[:, :1] - value[:, 3:4])
    slopes = (6.0 * z - 4.0) / length * value[:, 1:2] + (6.0 * z - 2.0) / length * value[:, 4:5]
    return bend + slopes, (value[:, 5:] - value[:, 2:3]) / length


def beam_gradient(
    model: ClampedSki, bent: tuple[FloatArray, FloatArray], adjoint: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Growth of λ·K u with EI and GJ at the Gauss points: w ℓ κ_u κ_λ, and with the rates of twist; (n, 4) each.

    `bent`: curvature and rate of twist of u.
    """
    kappa, turn = curvature_and_turn(model, adjoint)
    weight = GAUSS_WEIGHTS * _lengths(model)[:, None]
    return weight * bent[0] * kappa, weight * (bent[1] * turn)


def beam_moved(model: ClampedSki, u: FloatArray, place: FloatArray, growth: Shape) -> tuple[FloatArray, FloatArray]:
    """Growth of deflection and twist at fixed places for the same unknowns, where nodes move."""
    if not growth.node.any():
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
