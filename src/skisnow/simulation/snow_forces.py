"""Total force of the snow on each ski: normal force, shear and friction as one vector."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import numpy.typing as npt

from ..forces.shear import ShearLaw

if TYPE_CHECKING:
    from ..ski import Ski
    from .moving_boots import BootHistory

FloatArray: TypeAlias = npt.NDArray[np.float64]

_LEAST_DEPTH = 1e-9
"""Depth (m) at which a shear law is evaluated where the edge is above the snow and carries no shear."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AlongEdge:
    """Histories along both skis, (n, 2, m), from which their total force follows.

    Attributes
    ----------
    station
        Positions along the ski, tip to tail, positive before the boot (m), (m,).
    depth, force, shear
        Edge depth (m); force along the snow's normal and shear per length (N/m).
    bending, twist
        Deflection of the base (m), growth of the edge angle (rad).
    push
        Forces on each ski along the edge, forward positive: friction and compaction resistance; of friction across the
        edge, to the left; of friction off the surface (N), (n, 2, 3).
    """

    station: FloatArray
    depth: FloatArray
    force: FloatArray
    shear: FloatArray
    bending: FloatArray
    twist: FloatArray
    push: FloatArray


def snow_forces(along: AlongEdge, boots: BootHistory, *, normal: FloatArray, ski: Ski) -> FloatArray:
    """Total force of the snow on each ski in the slope's axes (N), (n, 2, 3).

    Parameters
    ----------
    along, boots
        Histories of the run.
    normal
        Unit normal of the snow at each boot, (n, 2, 3).
    ski
        Width and base of both skis.

    Notes
    -----
    At each station the shear is perpendicular to the edge line of the bent ski; the push is along it, and across it as
    the load is. Both are in the snow's surface, but for the friction of a tilted base across the ski. The three parts
    are summed over the stations with the lengths of the nodes.
    """
    forward, left = _edge_direction(along, boots, normal, ski)
    length = node_lengths(along.station)
    sheared, loaded = along.shear * length, along.force * length
    push = along.push / np.maximum(loaded.sum(axis=2), 1e-9)[..., None]
    sheared = sheared + push[..., 1, None] * loaded
    ahead = (push[..., 0, None] * forward * loaded - left * sheared).sum(axis=2)
    aside = (push[..., 0, None] * left * loaded + forward * sheared).sum(axis=2)
    axes = _surface_axes(boots, normal)
    parts = zip((loaded.sum(axis=2) + along.push[..., 2], ahead, aside), (normal, *axes), strict=True)
    return np.asarray(sum(size[..., None] * axis for size, axis in parts))


def thrust_per_length(
    along: AlongEdge, boots: BootHistory, *, normal: FloatArray, shear: ShearLaw | None
) -> FloatArray:
    """Force along the normal that comes with the shear, per length (N/m), (n, 2, m): in the law's proportion of both.

    Parameters
    ----------
    along, boots, normal
        As in `snow_forces`.
    shear
        Law of the shear; None: a law without thrust.
    """
    if shear is None or type(shear).thrust_force is ShearLaw.thrust_force:
        return np.zeros_like(along.shear)
    edge_angle = np.arctan2(-_dot(boots.axes[:, :, 1], normal), _dot(boots.axes[:, :, 2], normal))
    angle = np.minimum(np.abs(edge_angle[..., None] + along.twist), np.pi / 2.0)
    stress, thrust = shear.stress_and_thrust(np.maximum(along.depth, _LEAST_DEPTH).ravel(), angle.ravel())
    share = np.divide(thrust, stress, out=np.zeros_like(stress), where=stress > 0.0)
    return np.asarray(np.abs(along.shear) * share.reshape(angle.shape))


def node_lengths(station: FloatArray) -> FloatArray:
    """Length of ski of each node (m), (m,).

    >>> node_lengths(np.array([0.5, 0.0, -1.0])).tolist()
    [0.25, 0.75, 0.5]
    """
    step = -np.diff(station)
    return np.asarray(0.5 * (np.append(step, 0.0) + np.append(0.0, step)))


def _surface_axes(boots: BootHistory, normal: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Unit vectors in the snow's surface along each ski and to its left, (n, 2, 3) each."""
    ahead = boots.axes[:, :, 0] - _dot(boots.axes[:, :, 0], normal)[..., None] * normal
    ahead = ahead / np.linalg.norm(ahead, axis=-1, keepdims=True)
    return ahead, np.cross(normal, ahead)


def _edge_direction(
    along: AlongEdge, boots: BootHistory, normal: FloatArray, ski: Ski
) -> tuple[FloatArray, FloatArray]:
    """Components along the ski and to its left of the edge's unit tangent in the surface, (n, 2, m) each."""
    station = along.station
    base = ski.at(np.clip(station, float(ski.station[-1]), float(ski.station[0])))
    rise = np.gradient(along.bending + base.base_height, station, axis=2)
    flare = 0.5 * np.gradient(base.width, station)
    lower = -np.sign(_dot(boots.axes[:, :, 1], normal))[..., None]
    forward, left = (
        _dot(boots.axes[:, :, 0], axis)[..., None]
        + lower * flare * _dot(boots.axes[:, :, 1], axis)[..., None]
        + rise * _dot(boots.axes[:, :, 2], axis)[..., None]
        for axis in _surface_axes(boots, normal)
    )
    size = np.hypot(forward, left)
    return forward / size, left / size


def _dot(vectors: FloatArray, axes: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("nka,nka->nk", vectors, axes))
