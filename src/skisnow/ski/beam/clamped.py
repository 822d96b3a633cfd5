"""A flexible ski held at the boot: two beams, tip to binding and binding to tail, and the stations that meet snow."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt

from ..._support.errors import ParameterError
from ..ski import Ski
from .banded import assembled
from .elements import (
    DOFS_PER_NODE,
    GAUSS_POINTS,
    deflection_shape,
    mass_matrices,
    slope_shape,
    stiffness_matrices,
    twist_shape,
)

FloatArray: TypeAlias = npt.NDArray[np.float64]
IntArray: TypeAlias = npt.NDArray[np.int64]

CLAMP_LENGTH: Final = 0.30
"""Length of ski that boot and binding keep straight (m). Modelling assumption: about a boot's sole; limits are tested
with 0."""
MOST_ELEMENTS: Final = 4000
"""Elements of 0.4 mm: finer ones would only cost time (modelling assumption)."""

_STATION_POINT, _STATION_WEIGHT = (1.0 - 1.0 / np.sqrt(3.0)) / 2.0, 0.5


@dataclass(frozen=True, slots=True, eq=False)
class Stations:
    """Where along the ski the snow is felt: two Gauss points per element, tip to tail, also under the clamp.

    All arrays are (n,) but for the shapes (n, 6) and `dof` (n, 6), which holds -1 where the ski is held.
    """

    station: FloatArray
    weight: FloatArray
    width: FloatArray
    base_height: FloatArray
    dof: IntArray
    deflection: FloatArray
    slope: FloatArray
    twist: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class ClampedSki:
    """Finite-element model of a ski whose clamped length is rigid, or bedded on a boot that is, and moves with it.

    Attributes
    ----------
    ski, clamp_length
        The ski and the length (m) that boot and binding keep straight, centred at the boot; 0: held at one section.
    node
        Positions of the nodes (m), tip to tail; the ends of the clamp are nodes.
    dof
        (elements, 6) numbers of the unknowns, -1 where held.
    size
        Number of unknowns.
    stiffness, mass
        Banded matrices (size, 11), relative to the boot.
    stations
        See `Stations`.
    """

    ski: Ski
    clamp_length: float
    node: FloatArray
    dof: IntArray
    size: int
    stiffness: FloatArray
    mass: FloatArray
    stations: Stations


@functools.lru_cache(maxsize=32)
def clamped(ski: Ski, clamp_length: float, elements: int, footprint_stiffness: float | None = None) -> ClampedSki:
    """Divide a ski into about that many elements of equal length and clamp it at the boot.

    Parameters
    ----------
    ski
        The ski; its boot is at station 0.
    clamp_length
        0 ≤ length (m); it must lie within the ski.
    elements
        ≥ 4, number of elements over the whole ski.
    footprint_stiffness
        > 0, of boot and binding between the boot and each metre of the clamped length (N/m²): the ski is then held at
        the boot's middle and bedded on it over that length, with k W²/12 against twist; None: rigid.
    """
    front, rear = float(ski.station[0]), float(ski.station[-1])
    if not 0.0 <= clamp_length / 2.0 < min(front, -rear):
        raise ParameterError(
            f"clamp_length is {clamp_length} m; it must be 0 or more and its half less than the distance from boot to "
            f"tip and to tail ({front:.3f} and {-rear:.3f} m)"
        )
    if elements < 4:
        raise ParameterError(f"elements is {elements}; a ski needs 4 or more")
    if footprint_stiffness is not None and not footprint_stiffness > 0.0:
        raise ParameterError(
            f"footprint_stiffness is {footprint_stiffness} N/m²; it must be above 0, or left out: rigid"
        )
    bedded = footprint_stiffness is not None
    node = _nodes(front, rear, clamp_length, elements, bedded=bedded)
    dof, size = _numbering(node, 0.0 if bedded else clamp_length)
    length = node[:-1] - node[1:]
    at = ski.at(node[:-1, None] - length[:, None] * GAUSS_POINTS)
    stiffness = stiffness_matrices(length, at.bending_stiffness, at.torsional_stiffness)
    if footprint_stiffness is not None:  # as a mass, which resists in the same shapes
        under = np.where(np.abs(node[:-1] + node[1:]) < clamp_length, footprint_stiffness, 0.0)[:, None]
        stiffness = stiffness + mass_matrices(length, under + 0.0 * at.width, under * at.width**2 / 12.0)
    mass = mass_matrices(length, at.mass_per_length, at.mass_per_length * at.width**2 / 12.0)
    return ClampedSki(
        ski,
        clamp_length,
        node,
        dof,
        size,
        assembled(stiffness, dof, size),
        assembled(mass, dof, size),
        _stations(ski, node, dof),
    )


def beam_at(model: ClampedSki, u: FloatArray, station: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Deflection (m) and twist (rad) of the base relative to the boot at stations (m), for the unknowns u (size,)."""
    where = np.atleast_1d(np.asarray(station, float))
    element = np.clip(np.searchsorted(-model.node, -where, side="right") - 1, 0, len(model.dof) - 1)
    length = model.node[element] - model.node[element + 1]
    local = (model.node[element] - where) / length
    dof = model.dof[element]
    value = np.where(dof >= 0, u[dof], 0.0)
    deflection = np.sum(deflection_shape(local, length) * value, axis=-1)
    return deflection, np.sum(twist_shape(local) * value, axis=-1)


def beam_at_stations(model: ClampedSki, u: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Deflection (m) and twist (rad) of the base relative to the boot at the model's stations, for the unknowns u."""
    stations = model.stations
    value = np.where(stations.dof >= 0, u[stations.dof], 0.0)
    return np.einsum("ij,ij->i", stations.deflection, value), np.einsum("ij,ij->i", stations.twist, value)


def _nodes(front: float, rear: float, clamp_length: float, elements: int, *, bedded: bool) -> FloatArray:
    half = clamp_length / 2.0
    spacing = (front - rear) / elements

    def spaced(start: float, end: float) -> FloatArray:
        return np.linspace(start, end, max(1, round((start - end) / spacing)) + 1)

    under = np.zeros(1)
    if half > 0.0:
        under = np.append(spaced(half, 0.0)[:-1], spaced(0.0, -half)) if bedded else spaced(half, -half)
    parts = [spaced(front, half)[:-1], under, spaced(-half, rear)[1:]]
    return np.concatenate(parts)


def _numbering(node: FloatArray, clamp_length: float) -> tuple[IntArray, int]:
    free = np.abs(node) > clamp_length / 2.0 + 1e-12
    number = np.where(free, DOFS_PER_NODE * (np.cumsum(free) - 1), -DOFS_PER_NODE)
    dof = number[:, None] + np.arange(DOFS_PER_NODE)
    dof[~free] = -1
    return np.hstack([dof[:-1], dof[1:]]).astype(np.int64), int(DOFS_PER_NODE * free.sum())


def _stations(ski: Ski, node: FloatArray, dof: IntArray) -> Stations:
    length = node[:-1] - node[1:]
    local = np.array([_STATION_POINT, 1.0 - _STATION_POINT])
    station = node[:-1, None] - length[:, None] * local
    at = ski.at(station)

    def flat(values: FloatArray) -> FloatArray:
        return np.ascontiguousarray(values.reshape(-1, *values.shape[2:]))

    # the elements run from tip to tail, against the station: the slope along the station has the other sign
    return Stations(
        station=flat(station),
        weight=np.repeat(length * _STATION_WEIGHT, 2),
        width=flat(at.width),
        base_height=flat(at.base_height),
        dof=np.repeat(dof, 2, axis=0),
        deflection=flat(deflection_shape(local[None, :], length[:, None])),
        slope=-flat(slope_shape(local[None, :], length[:, None])),
        twist=np.tile(twist_shape(local), (len(length), 1)),
    )
