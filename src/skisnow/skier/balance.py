"""A control of moving boots that keeps a tall body in balance while it turns.

The body is an inverted pendulum over the skis. What it can do: draw up one leg and stretch the other, so that it leans,
and edge the skis, so that they turn. Its lean ψ is that of the line from the middle of the feet to the centre of mass.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Final, Protocol, TypeAlias

import numpy as np
import numpy.typing as npt

from ..dynamics import BootPose
from ..errors import ParameterError
from ..geometry.boot_axes import axes_of
from ..scenario import Plane, Scenario
from .plan import TurnPlan

FloatArray: TypeAlias = npt.NDArray[np.float64]

AHEAD, STRIDE = 1.6, 0.02
"""Time (s) that is looked ahead, and its step."""
LIFTED: Final = 0.02
"""Share of the load below which a ski counts as lifted."""
LEAST_LOAD: Final = 150.0
"""Load (N) below which nothing is learnt of the centre of pressure."""


class Moment(Protocol):
    """What is asked of a `skisnow.BootMoment`."""

    @property
    def time(self) -> float: ...  # noqa: D102
    @property
    def until(self) -> float: ...  # noqa: D102
    @property
    def rotation(self) -> FloatArray: ...  # noqa: D102
    @property
    def velocity(self) -> FloatArray: ...  # noqa: D102
    @property
    def boots(self) -> FloatArray: ...  # noqa: D102
    @property
    def wrench(self) -> FloatArray: ...  # noqa: D102


@dataclass(frozen=True, slots=True, kw_only=True)
class BalanceTuning:
    """Numbers of the control, found by trial on a giant-slalom ski (modelling assumption).

    Attributes
    ----------
    gain
        Of the legs on the error of the capture point.
    edge_change, edge_filter, share_filter, load_filter
        Corner frequencies (Hz): of the planned change of edges, of the edge angle, of what balance asks of the edges,
        of what is learnt from the loads.
    edge_gain
        Of the edges on the same error.
    lean_more
        By how much more than in balance the body is to lean.
    reach
        How far the centre of pressure may go from the middle, as a share of half the stance.
    carving_share
        Of the planned acceleration from which on the edges are set as for carving.
    grip_at_1_deg
        Side force over load with an edge at 1°, which grows with the root of the angle.
    angulation
        Edge angle beyond the lean (rad).
    greatest_edge
        (rad).
    lag
        Way after which the path has the edge's curvature (m).
    correction
        Lean by which the loads may correct what is planned (rad).
    touch
        How fast a lifted ski is put down (1/s).
    """

    gain: float = 1.5
    edge_change: float = 1.2
    edge_filter: float = 3.0
    share_filter: float = 3.0
    load_filter: float = 4.0
    edge_gain: float = 0.8
    lean_more: float = 1.1
    reach: float = 0.86
    carving_share: float = 0.5
    grip_at_1_deg: float = 0.38
    angulation: float = math.radians(3.0)
    greatest_edge: float = math.radians(50.0)
    lag: float = 0.6
    correction: float = 0.15
    touch: float = 8.0


@dataclass(frozen=True, slots=True)
class BalanceRecord:
    """What the control saw and did at one moment: s, m/s, rad, m, N.

    Attributes
    ----------
    time, speed, heading
        When, how fast, and where to.
    lean, balanced_lean, capture
        Of the body; what would be in balance; the capture point's that is wanted.
    edge_angle
        Against the snow.
    pressure_aside
        The centre of pressure from the middle of the feet, to the left.
    left_load, right_load
        Along the snow's normal.
    """

    time: float
    speed: float
    heading: float
    lean: float
    balanced_lean: float
    capture: float
    edge_angle: float
    pressure_aside: float
    left_load: float
    right_load: float


@dataclass(slots=True)
class _Seen:
    """What is measured: lean (rad), the pressure's place aside (m), loads (N), speed, heading, height of the centre."""

    lean: float
    aside: float
    left: float
    right: float
    speed: float
    heading: float
    height: float

    @property
    def load(self) -> float:
        return self.left + self.right


@dataclass(slots=True, eq=False)
class BalancedSkier:
    """Moves the boots of a run: `skisnow.simulate(scenario, boots=BalancedSkier(scenario, plan))`.

    Parameters
    ----------
    scenario
        On a plane, its sledge as tall as the skier and without an edge angle.
    plan
        When it turns.
    tuning
        Numbers of the control.

    Attributes
    ----------
    records
        What it saw and did.

    Raises
    ------
    ParameterError
        The slope is no plane, or the boots are edged or moved by a table.

    Notes
    -----
    With ω² = m g h/(I + m h²) the lean obeys ψ'' = ω² (ψ - ψ_b - u/h): ψ_b would be in balance at the present
    acceleration, u is how far aside the centre of pressure is. Of the two movements the one that grows belongs to the
    capture point ξ = ψ + ψ'/ω; what it has to be is what is planned: ω ∫ exp(-ω s) ψ_b(t + s) ds. The legs bring u to
    where ξ - ξ_ref decays, as far as the stance allows, and edge angles help.
    """

    scenario: Scenario
    plan: TurnPlan
    tuning: BalanceTuning = field(default_factory=BalanceTuning)
    records: list[BalanceRecord] = field(default_factory=list)
    _lean: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])  # with its rates
    _edge: list[float] = field(default_factory=lambda: [0.0, 0.0])
    _share: list[float] = field(default_factory=lambda: [0.0, 0.0])  # of the planned acceleration, with its rate
    _asked: float = 0.0  # share that balance asks for
    _acceleration: float = 0.0  # of the feet to the left
    _correction: float = 0.0
    _last: tuple[float, float] = (0.0, 0.0)  # lean as seen, with its rate
    _gravity: float = field(init=False)
    _downhill: float = field(init=False)

    def __post_init__(self) -> None:
        slope, sledge = self.scenario.slope, self.scenario.sledge
        if not isinstance(slope, Plane):
            raise ParameterError("BalancedSkier: the slope is a profile; the control knows planes alone")
        if sledge.edge_angle != 0.0 or self.scenario.boots is not None:
            raise ParameterError(
                "BalancedSkier: it sets the edges itself; sledge.edge_angle_deg must be 0, no boots.file"
            )
        self._gravity = self.scenario.gravity * math.cos(slope.angle)
        self._downhill = self.scenario.gravity * math.sin(slope.angle)

    def __call__(self, moment: Moment) -> Sequence[BootPose]:
        """Where the boots shall be at the moment's end."""
        dt = moment.until - moment.time
        if dt > 0.0:
            seen = self._look(moment)
            wanted, balanced = self._foreseen(moment.until, seen, dt)
            self._step_lean(seen, wanted, balanced, dt)
            self._step_edge(moment.until, seen, dt)
            self.records.append(
                BalanceRecord(moment.until, seen.speed, seen.heading, seen.lean, balanced, wanted, self._edge[0],
                              seen.aside, seen.left, seen.right)
            )  # fmt: skip
        return self._poses()

    def _look(self, moment: Moment) -> _Seen:
        """Loads and lean, about the direction in which the body heads on the snow."""
        rotation, boots = moment.rotation, moment.boots
        force, turning = (np.einsum("kca,kc->ka", boots[:, 1:4], part) for part in np.split(moment.wrench, 2, axis=1))
        up = rotation[2]
        ahead = np.array([1.0, 0.0, 0.0]) - up[0] * up
        ahead /= np.linalg.norm(ahead)
        place, middle = boots[:, 0], boots[:, 0].mean(axis=0)
        roll = float((np.cross(place - middle, force) + turning).sum(axis=0) @ ahead)
        left, right = (float(each @ up) for each in force)
        load = left + right
        centre = np.array([0.0, 0.0, self.scenario.sledge.centre_of_mass[1]]) - middle
        heading = rotation @ ahead
        return _Seen(
            lean=math.atan2(float(centre @ np.cross(up, ahead)), float(centre @ up)),
            aside=roll / load if load > LEAST_LOAD else 0.0,
            left=left,
            right=right,
            speed=float(np.linalg.norm(moment.velocity[:3])),
            heading=math.atan2(heading[1], heading[0]),
            height=float(np.linalg.norm(centre)),
        )

    def _drop(self, height: float) -> float:
        """ω² (1/s²)."""
        sledge = self.scenario.sledge
        return self._gravity * height * sledge.mass / (sledge.inertia[0] + sledge.mass * height**2)

    def carving_edge(self, speed: float) -> float:
        """Edge angle (rad) at which a carve at this speed (m/s) is in balance, and some angulation."""
        ratio = min(0.95, speed**2 / (self.scenario.ski.sidecut_radius_of_edge_line * self._gravity))
        return min(math.asin(ratio) + self.tuning.angulation, self.tuning.greatest_edge)

    def carving_acceleration(self, speed: float) -> float:
        """Of such a carve (m/s²)."""
        return speed**2 / (self.scenario.ski.sidecut_radius_of_edge_line * math.cos(self.carving_edge(speed)))

    def edge_of(self, share: float, speed: float) -> float:
        """Edge angle (rad) for a share of that acceleration: little edge skids, from a share on it carves."""
        tuning, carving = self.tuning, self.carving_edge(speed)
        grip = abs(share) * self.carving_acceleration(speed) / self._gravity / tuning.grip_at_1_deg
        skidding = min(math.radians(grip**2), carving)
        x = min(1.0, max(0.0, (abs(share) - tuning.carving_share) / (1.0 - tuning.carving_share)))
        return math.copysign(skidding + (carving - skidding) * x * x * (3.0 - 2.0 * x), share)

    def _foreseen(self, now: float, seen: _Seen, dt: float) -> tuple[float, float]:
        """The capture point's lean that is wanted, and the lean that is in balance now."""
        tuning, omega = self.tuning, math.sqrt(self._drop(seen.height))
        change, lag = 2.0 * math.pi * tuning.edge_change, tuning.lag / max(seen.speed, 2.0)
        carve = self.carving_acceleration(seen.speed)
        (share, rate), acceleration, heading = self._share, self._acceleration, seen.heading
        ahead = np.arange(0.5 * STRIDE, AHEAD, STRIDE)
        planned = np.empty(len(ahead))
        for i, later in enumerate(ahead):
            rate += STRIDE * (change**2 * (self.plan.sense(now + later) - share) - 2.0 * change * rate)
            share += STRIDE * rate
            target = carve * (share + self._asked * math.exp(-later / 0.3))
            acceleration += (target - acceleration) * STRIDE / (lag + STRIDE)
            planned[i] = math.atan((acceleration + self._downhill * math.sin(heading)) / self._gravity)
            heading += acceleration / max(seen.speed, 1.0) * STRIDE
        self._learn(seen, float(planned[0]), dt)
        weight = np.exp(-omega * ahead)
        wanted = tuning.lean_more * float(weight @ (planned + self._correction * np.exp(-ahead / 0.3)) / weight.sum())
        self._acceleration += (carve * (self._share[0] + self._asked) - self._acceleration) * dt / (lag + dt)
        return wanted, float(planned[0]) + self._correction

    def _learn(self, seen: _Seen, planned: float, dt: float) -> None:
        """How far the lean in balance is from the planned one, by the loads while both skis bear."""
        if seen.load <= LEAST_LOAD or self._lifted(seen):
            self._correction *= 1.0 - 6.0 * dt
            return
        found = seen.lean - seen.aside / seen.height - self._lean[2] / self._drop(seen.height)
        most = self.tuning.correction
        self._correction += _share_of(dt, self.tuning.load_filter) * (
            max(-most, min(most, found - planned)) - self._correction
        )

    def _lifted(self, seen: _Seen) -> bool:
        return seen.load > LEAST_LOAD and min(seen.left, seen.right) < LIFTED * seen.load

    def _step_lean(self, seen: _Seen, wanted: float, balanced: float, dt: float) -> None:
        """Draw the capture point towards what is wanted, by legs and edges."""
        tuning, drop = self.tuning, self._drop(seen.height)
        omega, (lean, rate, _) = math.sqrt(drop), self._lean
        lean_before, rate_before = self._last
        swing = rate_before + _share_of(dt, 8.0) * ((seen.lean - lean_before) / dt - rate_before)
        self._last = (seen.lean, swing if self.records else 0.0)
        if self._lifted(seen):
            back = min(1.0, tuning.touch * dt)
            lean, rate = lean + back * (seen.lean - lean), rate + back * (swing - rate)
            error = seen.lean + swing / omega - wanted
        else:
            error = lean + rate / omega - wanted
        carve = math.atan(self.carving_acceleration(seen.speed) / self._gravity)
        asked = max(-1.0, min(1.0, tuning.edge_gain * error / max(carve, 0.1)))
        self._asked += _share_of(dt, tuning.share_filter) * (asked - self._asked)
        reach = tuning.reach * self.scenario.sledge.stance_width / 2.0 / seen.height
        aside = max(-reach, min(reach, (1.0 + tuning.gain) * error))
        growth = max(-30.0, min(30.0, drop * (lean - balanced - aside)))
        rate += growth * dt
        self._lean = [max(-1.1, min(1.1, lean + rate * dt)), rate, growth]

    def _step_edge(self, now: float, seen: _Seen, dt: float) -> None:
        """By critically damped filters: the planned change of edges, then the edge angle itself."""
        change, swift = (2.0 * math.pi * each for each in (self.tuning.edge_change, self.tuning.edge_filter))
        share, rate = self._share
        rate += (change**2 * (self.plan.sense(now) - share) - 2.0 * change * rate) * dt
        self._share = [share + rate * dt, rate]
        wanted = self.edge_of(max(-1.3, min(1.3, self._share[0] + self._asked)), seen.speed)
        edge, turning = self._edge
        turning += (swift**2 * (wanted - edge) - 2.0 * swift * turning) * dt
        self._edge = [edge + turning * dt, turning]

    def _poses(self) -> list[BootPose]:
        """Legs that lean the body, and are drawn up by as much as an edged ski lifts its boot."""
        (lean, rate, _), (edge, turning), stance = self._lean, self._edge, self.scenario.sledge.stance_width
        half, blunt = float(self.scenario.ski.at(0.0).width) / 2.0, math.sin(math.radians(3.0))
        root = math.hypot(math.sin(edge), blunt)
        up, upwards = half * (root - blunt), half * math.sin(edge) * math.cos(edge) * turning / root
        rise, rises = stance * math.tan(lean), stance * rate / math.cos(lean) ** 2
        axes = axes_of(edge - lean, 0.0, 0.0)
        return [
            BootPose(
                np.array([0.0, side * stance, side * rise + up]),
                axes,
                np.array([0.0, 0.0, side * rises + upwards]),
                np.array([rate - turning, 0.0, 0.0]),
            )
            for side in (0.5, -0.5)
        ]


def _share_of(dt: float, frequency: float) -> float:
    """Of a step towards its input that a filter of first order takes."""
    return dt / (dt + 1.0 / (2.0 * math.pi * frequency))
