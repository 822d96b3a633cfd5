"""Forces of the snow on each ski of a run, and the balance of the body over the skis."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.units import Facts, Shown, field_facts
from ..forces.shear import ShearLaw
from ..scenario import Plane
from ..scenario.terrain import down_and_left, normals_of

if TYPE_CHECKING:
    from ..ski import Ski
    from .moving_boots import BootHistory
    from .run import Run, SkiHistory


LEAST_LOAD: Final = 50.0
"""Load (N) of both skis above which there is a centre of pressure (modelling assumption)."""


def boots_of(run: Run) -> BootHistory:
    """The boots of a run.

    Raises ParameterError: they are not known.
    """
    if run.boots is None:
        raise ParameterError("this run has no data of its boots: it was not made by skisnow.simulate").tag("no_data")
    return run.boots


def balance_of(run: Run) -> BalanceHistory:
    """Lean of the body over the run."""
    boots = boots_of(run)
    normal = normals_of(run.scenario.slope, run.place[:, 0], run.place[:, 1])
    ahead = boots.axes[:, :, 0].mean(axis=1)
    ahead = ahead - np.einsum("na,na->n", ahead, normal)[:, None] * normal
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    left = np.cross(normal, ahead)
    centre = boots.centre_of_mass - boots.place.mean(axis=1)
    aside, up = (np.einsum("na,na->n", centre, axis) for axis in (left, normal))
    load = np.einsum("nka,na->nk", boots.force, normal)
    arm = boots.place - boots.place.mean(axis=1, keepdims=True)
    roll = np.einsum("na,na->n", (np.cross(arm, boots.force) + boots.moment).sum(axis=1), ahead)
    both = load.sum(axis=1)
    pressure = np.where(both > LEAST_LOAD, roll / np.where(both > LEAST_LOAD, both, 1.0), np.nan)
    lean = np.arctan2(aside, up)
    balanced, rolling = _balanced(run, normal, up)
    return BalanceHistory(
        lean=lean,
        pressure_lean=np.arctan2(aside - pressure, up),
        balanced_lean=balanced,
        rolling_lean=rolling,
        angulation=boots.angles[:, :, 0].mean(axis=1) - lean,
        leg=np.linalg.norm(centre, axis=1),
        pressure=pressure,
        load=load,
    )


def _balanced(run: Run, normal: FloatArray, up: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Leans (rad) that balance the acceleration of the centre of mass: without, and with roll and rise of the body.

    normal, up: (n, 3) normal of the snow, and (n,) height of the centre of mass above it (m).
    """
    boots, slope, gravity = boots_of(run), run.scenario.slope, run.scenario.gravity
    if len(run.time) < 5:
        return np.full(len(run.time), np.nan), np.full(len(run.time), np.nan)
    velocity = np.gradient(boots.centre_of_mass, run.time, axis=0)
    acceleration = np.gradient(velocity, run.time, axis=0)
    down = down_and_left(normal)[0]
    if isinstance(slope, Plane):
        across, fall = gravity * np.cos(slope.angle), np.full(len(run.time), gravity * np.sin(slope.angle))
    else:
        across, fall = gravity * normal[:, 2], -gravity * down[:, 2]
    along = velocity - np.einsum("na,na->n", velocity, normal)[:, None] * normal
    along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-9)
    left = np.cross(normal, along)
    turning = np.einsum("na,na->n", acceleration, left) - fall * np.einsum("na,na->n", down, left)
    rising = across + np.einsum("na,na->n", acceleration, normal)
    sledge, axis = run.scenario.sledge, run.attitude[:, :, 2]
    spin = np.cross(axis, np.gradient(axis, run.time, axis=0))
    rolling = np.gradient(-np.einsum("na,na->n", spin, run.attitude[:, :, 0]), run.time)  # to the left (rad/s²)
    by_roll = sledge.inertia[0] * rolling / (sledge.mass * np.maximum(up, 1e-3))
    out = np.array([np.arctan2(turning, across), np.arctan2(turning + by_roll, np.maximum(rising, 1e-3))])
    out[:, [0, 1, -2, -1]] = np.nan
    return out[0], out[1]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True, repr=False)
class BalanceHistory(Shown):
    """Over time, (n,) each, in axes along the skis, to their left and out of the snow; leans are positive to the left.

    lean: angle of the line from the middle of the boots to the centre of mass, from the snow's normal (rad).
    pressure_lean: angle of the line from the centre of pressure to it (rad); NaN where the skis do not bear.
    balanced_lean: lean of a body in balance with speed v and path radius R of the centre of mass: tan Ψ = v²/(R g cos
        α) - tan α cos χ, χ from the horizontal (rad); NaN at both ends of a run.
    rolling_lean: the same, corrected for the body's roll and the rise of its centre of mass: tan Ψ = (a_l + I φ''/(m
        z))/(a_n), a_l and a_n the accelerations to the left and off the snow without gravity's share, φ the body's
        roll, z the height of the centre of mass (rad); NaN at both ends.
    angulation: mean edge angle less the lean (rad).
    leg: from the middle of the boots to the centre of mass (m).
    pressure: centre of pressure from the middle of the boots, to the left (m); NaN where the skis do not bear.
    load: (n, 2) force of each ski on its boot along the snow's normal (N).
    """

    lean: FloatArray
    pressure_lean: FloatArray
    balanced_lean: FloatArray
    rolling_lean: FloatArray
    angulation: FloatArray
    leg: FloatArray
    pressure: FloatArray
    load: FloatArray

    def _repr_facts(self) -> Facts:
        units = dict.fromkeys(("lean", "pressure_lean", "balanced_lean", "rolling_lean", "angulation"), "rad")
        return field_facts(self, units | {"leg": "m", "pressure": "m", "load": "N"})


_LEAST_DEPTH = 1e-9
"""Depth (m) at which a shear law is evaluated where the edge is above the snow and carries no shear."""


def snow_forces(
    skis: SkiHistory, pushes: FloatArray, boots: BootHistory, *, normal: FloatArray, ski: Ski
) -> FloatArray:
    """Total force of the snow on each ski in the slope's axes (N), (n, 2, 3).

    pushes: forces on each ski along the edge, forward positive: friction and compaction resistance; of friction across
        the edge, to the left; of friction off the surface (N), (n, 2, 3).
    normal: unit normal of the snow at each boot, (n, 2, 3).

    At each station the shear is perpendicular to the edge line of the bent ski; the push is along it, and across it as
    the load is. Both are in the snow's surface, but for the friction of a tilted base across the ski. The three parts
    are summed over the stations with the lengths of the nodes.
    """
    forward, left = _edge_direction(skis, boots, normal, ski)
    length = node_lengths(skis.station)
    sheared, loaded = skis.shear_per_length * length, skis.force_per_length * length
    push = pushes / np.maximum(loaded.sum(axis=2), 1e-9)[..., None]
    sheared = sheared + push[..., 1, None] * loaded
    ahead = (push[..., 0, None] * forward * loaded - left * sheared).sum(axis=2)
    aside = (push[..., 0, None] * left * loaded + forward * sheared).sum(axis=2)
    axes = _surface_axes(boots, normal)
    parts = zip((loaded.sum(axis=2) + pushes[..., 2], ahead, aside), (normal, *axes), strict=True)
    return np.asarray(sum(size[..., None] * axis for size, axis in parts))


def thrust_per_length(
    skis: SkiHistory, boots: BootHistory, *, normal: FloatArray, shear: ShearLaw | None
) -> FloatArray:
    """Force along the normal that comes with the shear, per length (N/m), (n, 2, m): in the law's proportion of both.

    skis, boots, normal: as in `snow_forces`.
    shear: law of the shear; None: a law without thrust.
    """
    if shear is None or type(shear).thrust_force is ShearLaw.thrust_force:
        return np.zeros_like(skis.shear_per_length)
    edge_angle = np.arctan2(-_dot(boots.axes[:, :, 1], normal), _dot(boots.axes[:, :, 2], normal))
    angle = np.minimum(np.abs(edge_angle[..., None] + skis.twist), np.pi / 2.0)
    stress, thrust = shear.stress_and_thrust(np.maximum(skis.edge_depth, _LEAST_DEPTH).ravel(), angle.ravel())
    share = np.divide(thrust, stress, out=np.zeros_like(stress), where=stress > 0.0)
    return np.asarray(np.abs(skis.shear_per_length) * share.reshape(angle.shape))


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
    skis: SkiHistory, boots: BootHistory, normal: FloatArray, ski: Ski
) -> tuple[FloatArray, FloatArray]:
    """Components along the ski and to its left of the edge's unit tangent in the surface, (n, 2, m) each."""
    station = skis.station
    base = ski.at(np.clip(station, float(ski.station[-1]), float(ski.station[0])))
    rise = np.gradient(skis.bending + base.base_height, station, axis=2)
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
    """Dot products of vectors and axes over times and skis, shape (n, k)."""
    return np.asarray(np.einsum("nka,nka->nk", vectors, axes))
