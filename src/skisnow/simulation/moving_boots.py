"""Control of a run: boots moved by a table, a skier or a function, and varying strength, each with its period."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.units import Facts, Shown, amount, field_facts, name_with_values
from ..contact import SnowField
from ..dynamics import BootMotion, BootPose, Dynamics
from ..geometry.vectors import angles_of
from ..scenario.boots import Boots


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class BootMoment(Shown):
    """State of a run for a function that returns the next poses of the boots.

    Attributes
    ----------
    time, until
        Pose now, and the time at which the boots reach the target (s); equal at the start.
    distance
        Run so far (m).
    position, rotation, velocity
        Origin of the sledge (3,) in space (m), axes as columns (3, 3), velocity and angular velocity in its axes (6,).
    boots
        Pose of each boot against the sledge now: place, axes ahead, left and off the base, velocity, angular velocity,
        (2, 6, 3).
    wrench
        Load of each ski on its boot, in its axes: force (N), moment (N m), (2, 6). Zero at the start.

    See Also
    --------
    skisnow.simulate
    skisnow.BootPose
    """

    time: float
    until: float
    distance: float
    position: FloatArray
    rotation: FloatArray
    velocity: FloatArray
    boots: FloatArray
    wrench: FloatArray

    def _repr_facts(self) -> Facts:
        """Title with the time and its end (s), and rows with distance, speed and forces of the boots."""
        speed, bears = float(np.linalg.norm(self.velocity[:3])), np.linalg.norm(self.wrench[:, :3], axis=1)
        rows = (
            ("run", f"{amount(self.distance, 'm')}, now at {amount(speed, 'm/s')}"),
            ("forces", ", ".join(amount(float(bear), "N") for bear in bears)),
        )
        return Facts(f"at {amount(self.time, 's')}, for {amount(self.until, 's')}", rows)


BootControl: TypeAlias = Callable[[BootMoment], Sequence[BootPose]]
"""Gives the poses of the left and the right boot against the sledge at `BootMoment.until`, with their rates.

Where it has a method ``push``, that is called after it with the same moment, and gives a force (N, in space) and where
it acts in the sledge's frame (m), until the next. Its attribute ``period`` is the time from call to call (s, default:
0.01).
"""

CONTROL_PERIOD: Final = 0.01
"""Time between two calls of a control that has no period (s)."""
SHORTEST_PERIOD: Final = 1e-4
"""Shortest period of a table of boots (s), however near its rows are."""
SAME_TIME: Final = 1e-9
"""Difference of two times (s) that are one: a step between them would be rounding."""


@dataclass(slots=True)
class BootDrive:
    """Calls the control of the boots at its period, and moves the boots to the poses that it returns."""

    control: BootControl
    held: bool = False
    _last: Sequence[BootPose] = ()
    _calls: int = 0

    @property
    def period(self) -> float:
        """Time from call to call (s)."""
        return float(getattr(self.control, "period", CONTROL_PERIOD))

    @property
    def until(self) -> float:
        """Time (s) to which the boots move by the last call; the next call is due there."""
        return self._calls * self.period

    @property
    def described(self) -> str:
        """Control of the boots, in words."""
        if isinstance(self.control, TableControl):
            return f"moved by {self.control.table.source}"
        return f"moved by {name_with_values(self.control)}"

    def begin(self, dynamics: Dynamics) -> None:
        """Put the boots where they are at the start."""
        if self.held:
            dynamics.hold_body()
        self._last = self._next_poses(dynamics, 0.0, 0.0)
        dynamics.move_boots([BootMotion(0.0, self.period, pose, pose) for pose in self._last])  # only its start is met

    def move(self, dynamics: Dynamics, distance: float) -> None:
        """Call the control, and let the boots move to its poses within a period. `distance`: run so far (m)."""
        self._calls += 1
        poses = self._next_poses(dynamics, self.until, distance)
        pairs = zip(self._last, poses, strict=True)
        dynamics.move_boots([BootMotion(dynamics.time, self.until, first, last) for first, last in pairs])
        self._last = poses

    def _next_poses(self, dynamics: Dynamics, until: float, distance: float) -> Sequence[BootPose]:
        """Poses that the control returns for this moment, one for each ski; rejects anything else."""
        moment = BootMoment(
            dynamics.time, until, distance, dynamics.position, dynamics.rotation, dynamics.velocity, dynamics.boots,
            dynamics.boot_wrench,
        )  # fmt: skip
        poses = self.control(moment)
        push = getattr(self.control, "push", None)
        if push is not None:
            dynamics.push(*push(moment))
        count = len(dynamics.body.skis)
        if len(poses) != count or not all(isinstance(pose, BootPose) for pose in poses):
            raise ParameterError("boots: the control gave {poses!r}; it must give {count} BootPose").tag(
                "wrong_kind", poses=poses, count=count
            )
        return poses


@dataclass(slots=True)
class StrengthDrive:
    """Updates the shear strength along the path: `share` gives its share of S_f at the distance run (m)."""

    share: Callable[[float], float]
    snow: SnowField
    _calls: int = 0

    @property
    def until(self) -> float:
        """Time (s) to which the last share counts."""
        return self._calls * CONTROL_PERIOD

    def move(self, _: Dynamics, distance: float) -> None:
        """Evaluate the share at a distance run (m)."""
        self._calls += 1
        self.snow.compiled.strength_share = self.share(distance)


@dataclass(frozen=True, slots=True)
class TableControl:
    """Control of the boots that returns the poses of a table."""

    table: Boots

    @property
    def period(self) -> float:
        """Smallest spacing of rows over time, at most 10 ms (s)."""
        if self.table.over == "distance":
            return CONTROL_PERIOD
        return min(CONTROL_PERIOD, max(SHORTEST_PERIOD, float(np.diff(self.table.at).min())))

    def __call__(self, moment: BootMoment) -> Sequence[BootPose]:
        """Poses at the time, or at the distance that will have been run then at the present speed."""
        at, rate = moment.until, 1.0
        if self.table.over == "distance":
            rate = float(np.linalg.norm(moment.velocity[:3]))
            at = moment.distance + rate * (moment.until - moment.time)
        place, axes, velocity, turning = self.table.poses(at)
        return [BootPose(*pose) for pose in zip(place, axes, rate * velocity, rate * turning, strict=True)]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True, repr=False)
class BootHistory(Shown):
    """Boots over time; index 0 is the time (n), index 1 the boot (0 left, 1 right).

    place: (n, 2, 3) in the slope's axes (m).
    axes: (n, 2, 3, 3): ahead, left across the base, off the base, as rows in the slope's axes.
    own_force, own_moment: (n, 2, 3) of the ski on its boot, about it, in the boot's axes (N, N m).
    centre_of_mass: (n, 3) of the body that they carry, without the skis (m).
    """

    place: FloatArray
    axes: FloatArray
    own_force: FloatArray
    own_moment: FloatArray
    centre_of_mass: FloatArray

    @property
    def force(self) -> FloatArray:
        """Force (N) of each ski on its boot in the slope's axes, (n, 2, 3)."""
        return np.asarray(np.einsum("nkca,nkc->nka", self.axes, self.own_force))

    @property
    def moment(self) -> FloatArray:
        """Moment (N m) of each ski on its boot, about the boot, in the slope's axes, (n, 2, 3)."""
        return np.asarray(np.einsum("nkca,nkc->nka", self.axes, self.own_moment))

    @property
    def angles(self) -> FloatArray:
        """Edge angle, pitch and heading (rad) of each boot in the slope's axes, (n, 2, 3)."""
        return angles_of(self.axes)

    def _repr_facts(self) -> Facts:
        return field_facts(
            self, {"place": "m", "axes": "", "own_force": "N", "own_moment": "N m", "centre_of_mass": "m"}
        )
