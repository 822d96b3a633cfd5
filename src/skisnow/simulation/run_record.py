"""A run taken from output to output, and the stored rows."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Final, NamedTuple

import numpy as np

from .._support.arrays import FloatArray
from ..dynamics import Ended
from ..dynamics.motion import MOMENT, moment_parts
from ..scenario.terrain import down_and_left, heights_of, normals_of
from .moving_boots import BootHistory
from .run import GIVEN, LOST, STORED, Outcome, SkiHistory
from .run_forces import snow_forces, thrust_per_length
from .run_setup import Setup

GAINED_SHARE, GAINED = 0.05, 10.0
"""Share of the energy exchanged, and energy (J), that may seem to be gained before numbers have diverged (modelling
assumption)."""
_OUTCOMES: Final[dict[Ended, Outcome]] = {Ended.STEP_TOO_SMALL: "step_too_small", Ended.NOT_FINITE: "not_finite"}


class Moment(NamedTuple):
    """Values of one output time, SI.

    place, attitude, velocity: motion of the boots' middle, in space: (3,), (3, 3), (3,).
    row: all of the sledge and its skis, see `Dynamics.moment`.
    """

    place: FloatArray
    attitude: FloatArray
    velocity: FloatArray
    row: FloatArray


@dataclass(slots=True)
class Record:
    """Moments of a run in progress, stored one after the other."""

    setup: Setup
    run_length: float = 0.0
    _moments: list[Moment] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._moments.append(self._current_moment())

    def advance(
        self, moment: float, *, replace: bool = False, is_over: Callable[[], bool] = lambda: False
    ) -> Outcome | None:
        """Continue the run to a time (s) and store it, with `replace` instead of the last one.

        The outcome if the steps cannot go on. `is_over`: see `Setup.advance`.
        """
        ended = self.setup.advance(moment, self.run_length, is_over=is_over)
        last, present = self._moments[-1], self._current_moment()
        self.run_length += _arc(last, present)
        if (replace and len(self._moments) > 1) or present.row[0] <= last.row[0]:
            self._moments[-1] = present
        else:
            self._moments.append(present)
        return _OUTCOMES.get(ended)

    def _current_moment(self) -> Moment:
        """State of the run at this moment; without moving boots, the body's own row gives place and attitude."""
        setup, row = self.setup, self.setup.dynamics.moment
        if setup.drive is not None:
            return Moment(setup.place, setup.attitude, setup.velocity, row)
        attitude = row[MOMENT["rotation"]].reshape(3, 3)
        return Moment(row[MOMENT["position"]], attitude, attitude @ row[MOMENT["velocity"]][:3], row)

    @property
    def gains_energy(self) -> bool:
        """True if motion, height and deflection have more energy than at the start: numbers have diverged."""
        first, last = (moment.row[MOMENT["energies"]].tolist() for moment in (self._moments[0], self._moments[-1]))
        energy_given = sum(self._moments[-1].row[MOMENT["work_given"]].tolist())
        gained = sum(last) - sum(first) - energy_given
        exchanged = first[0] + max(0.0, first[1] - last[1]) + abs(energy_given)
        return not gained <= GAINED_SHARE * exchanged + GAINED

    def drop(self) -> None:
        """Remove the moment stored last."""
        if len(self._moments) > 1:
            gone = self._moments.pop()
            self.run_length -= _arc(self._moments[-1], gone)

    def histories(self) -> dict[str, Any]:
        """Arrays of a `Run` by name, from the stored moments."""
        place, attitude, velocity, rows = map(np.array, zip(*self._moments, strict=True))
        parts = moment_parts(rows, self.setup.dynamics.body.skis)
        time, energies = parts["time"], stored_and_lost(parts)
        normal = normals_of(self.setup.scenario.slope, place[:, 0], place[:, 1])
        unknown, dofs = self.setup.dynamics.body.skis[0].unknown, parts["beam_dofs"]
        bent = np.zeros((*dofs.shape[:-1], len(unknown), 3))  # 0 where the beam is held
        bent[..., unknown >= 0, :] = dofs.reshape(*dofs.shape[:-1], -1, 3)
        along = np.moveaxis(parts["along"], 2, 0)
        values = dict(zip(_ALONG, (*along, bent[..., 0], bent[..., 2]), strict=True))
        node, history = self.setup.node, self._boots(parts)
        depth = _at_boot(node, values["edge_depth"])
        fixed = self.setup.drive is None
        track = self._tracks(place, attitude, depth) if fixed else self._moved_tracks(history, depth)
        skis = SkiHistory(station=node, track=track, depth=depth, force=np.zeros_like(track), **values)
        return {
            "time": time,
            "place": place,
            "attitude": attitude,
            "velocity": velocity,
            "heading": _heading(attitude, normal),
            "turn_radius": turn_radius(time, velocity, attitude[:, :, 2]),
            "skis": self._with_forces(skis, parts["pushes"], history),
            "energies": {name: energies[:, i] for i, name in enumerate((*STORED, *LOST, *GIVEN))},
            "boots": history,
        }

    def _with_forces(self, skis: SkiHistory, pushes: FloatArray, boots: BootHistory) -> SkiHistory:
        """The skis with the thrust in their force along the snow's normal, and with the total force of the snow."""
        scenario, (x, y) = self.setup.scenario, boots.place.reshape(-1, 3).T[:2]
        normal = np.broadcast_to(normals_of(scenario.slope, x, y), (x.size, 3)).reshape(boots.place.shape)
        thrust = thrust_per_length(skis, boots, normal=normal, shear=self.setup.snow.shear)
        skis = replace(skis, force_per_length=skis.force_per_length + thrust)
        return replace(skis, force=snow_forces(skis, pushes, boots, normal=normal, ski=scenario.flexing_ski))

    def _boots(self, parts: Mapping[str, FloatArray]) -> BootHistory:
        """History of place, axes and loads of both boots, in the slope's axes."""
        forward, height = self.setup.scenario.sledge.centre_of_mass
        origin, axes, boots, wrench = (parts[name] for name in ("position", "rotation", "boots", "boot_wrench"))
        return BootHistory(
            place=origin[:, None] + np.einsum("nab,nkb->nka", axes, boots[:, :, 0]),
            axes=np.einsum("nab,nkcb->nkca", axes, boots[:, :, 1:4]),
            own_force=wrench[..., :3],
            own_moment=wrench[..., 3:],
            centre_of_mass=origin + axes @ np.array([forward, 0.0, height]),
        )

    def _moved_tracks(self, boots: BootHistory, depth: FloatArray) -> FloatArray:
        """Track (n, 2, 3) of each ski, where it bears the load, for boots that move against the sledge."""
        scenario, at_boot = self.setup.scenario, self.setup.scenario.ski.at(0.0)
        left, off = boots.axes[:, :, 1], boots.axes[:, :, 2]
        side = side_of_load(left[..., 2], depth, float(at_boot.width))
        out = boots.place + float(at_boot.base_height) * off + side[..., None] * left
        out[:, :, 2] = heights_of(scenario.slope, out[:, :, 0], out[:, :, 1])
        return np.asarray(out)

    def _tracks(self, place: FloatArray, attitude: FloatArray, depth: FloatArray) -> FloatArray:
        """Track of each ski (n, 2, 3): the place under the boot that bears the load, on the slope's surface."""
        scenario, tracks = self.setup.scenario, []
        at_boot = scenario.ski.at(0.0)
        for number, ski in enumerate(self.setup.dynamics.body.skis):
            side = side_of_load(attitude[:, 2] @ ski.axes[1], depth[:, number], float(at_boot.width))
            in_body = ski.boot + float(at_boot.base_height) * ski.axes[2] + side[:, None] * ski.axes[1]
            tracks.append(place + np.einsum("nab,nb->na", attitude, in_body))
        out = np.stack(tracks, axis=1)
        out[:, :, 2] = heights_of(scenario.slope, out[:, :, 0], out[:, :, 1])
        return out


def side_of_load(lean: FloatArray, depth: FloatArray, width: float) -> FloatArray:
    """Distance (m) of the loaded place from the middle of a ski to the left.

    It is at the edge that is down while only this edge is in the snow. While the other edge is in the snow, too, the
    place moves to the middle with the lean: the small rolling of a flat ski would make it jump from edge to edge.

    lean: sine of the angle by which the left edge is up.
    depth: depth of the edge that is down (m); a ski in the air or in hardly marked snow counts as 0.001 `width` deep.

    >>> side_of_load(np.array([-0.5, 0.0, 0.005]), np.full(3, 1e-3), 0.1).tolist()
    [0.05, -0.0, -0.025]
    """
    difference = lean * width / np.maximum(depth, 0.001 * width)
    return np.asarray(-0.5 * width * np.clip(difference, -1.0, 1.0))


def stored_and_lost(parts: Mapping[str, FloatArray]) -> FloatArray:
    """Energies by the names of `STORED`, `LOST` and `GIVEN` (J), (n, 13), from parts of n moments."""
    pressure, sheared, stuck, delayed = parts["snow_energies"].T
    penetration, shear, friction, rate, _ = parts["snow_losses"].T
    drag, damping = parts["work"].T[3:5]
    stored = (*parts["energies"].T, pressure + sheared + stuck, delayed)
    lost = (penetration, shear, friction, drag, damping, rate)
    return np.stack([*stored, *lost, *parts["work_given"].T], axis=1)


def _at_boot(node: FloatArray, values: FloatArray) -> FloatArray:
    """Values (..., m) at station 0, interpolated between the nodes, which go from tip to tail."""
    i = min(int(np.count_nonzero(node > 0.0)), len(node) - 1) - 1
    f = node[i] / (node[i] - node[i + 1])
    return np.asarray(values[..., i] + f * (values[..., i + 1] - values[..., i]))


def _arc(one: Moment, other: Moment) -> float:
    """Length of path between two moments (m), by the velocities at both ends and the chord."""
    chord = math.dist(one.place, other.place)
    before, after = math.hypot(*one.velocity.tolist()), math.hypot(*other.velocity.tolist())
    if before * after == 0.0:
        return chord
    angle2 = max(0.0, 2.0 * (1.0 - float(one.velocity @ other.velocity) / (before * after)))
    return chord * (1.0 + angle2 / 24.0) if angle2 < 1.0 else chord


_ALONG = ("edge_depth", "force_per_length", "shear_per_length", "bending", "twist")


def _heading(attitude: FloatArray, normal: FloatArray) -> FloatArray:
    """Angle of the skis to the fall line in the slope's plane, positive left (rad): (n, 3, 3) and (n, 3) to (n,)."""
    ahead, (down, left) = attitude[:, :, 0], down_and_left(normal)
    across, along = (np.einsum("na,na->n", ahead, axis) for axis in (left, down))
    return np.asarray(np.unwrap(np.arctan2(across, along)))


def turn_radius(time: FloatArray, velocity: FloatArray, normal: FloatArray) -> FloatArray:
    """Radius of the path (n,) in the snow's surface, positive left, infinite where straight (m).

    By central differences.
    """
    if len(time) < 2:
        return np.full(len(time), np.inf)
    speed = np.linalg.norm(velocity, axis=1)
    acceleration = np.gradient(velocity, time, axis=0)
    turning = np.einsum("ij,ij->i", np.cross(velocity, acceleration), normal)
    moving = (speed > 0.01) & (np.abs(turning) > 1e-6 * speed**3)
    return np.where(moving, speed**3 / np.where(moving, turning, 1.0), np.inf)
