"""State that a skier measures: lean, loads, speed, from the moments of a run."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol, TypeAlias

import numpy as np
import numpy.typing as npt

from ..scenario.terrain import down_and_left

FloatArray: TypeAlias = npt.NDArray[np.float64]


class Moment(Protocol):
    """What is asked of a `skisnow.BootMoment`."""

    @property
    def time(self) -> float: ...  # noqa: D102
    @property
    def until(self) -> float: ...  # noqa: D102
    @property
    def position(self) -> FloatArray: ...  # noqa: D102
    @property
    def rotation(self) -> FloatArray: ...  # noqa: D102
    @property
    def velocity(self) -> FloatArray: ...  # noqa: D102
    @property
    def boots(self) -> FloatArray: ...  # noqa: D102
    @property
    def wrench(self) -> FloatArray: ...  # noqa: D102


@dataclass(frozen=True, slots=True)
class Seen:
    """What is measured, in axes along the skis, to their left and out of the snow.

    Attributes
    ----------
    aside, aside_rate, height
        Offset of the centre of mass from the middle of the feet: to the left (m), its rate (m/s), above it (m).
    pressure
        How far the centre of pressure is to the left of that middle (m); 0 where nothing bears.
    left, right
        Loads of the skis (N).
    place, speed, heading, course
        State of the middle of the feet: x, y (m), (m/s), the skis' and the path's heading from the fall line (rad).
    bears, lifted
        Whether the loads tell anything, and whether one ski is off the snow.
    """

    aside: float
    aside_rate: float
    height: float
    pressure: float
    left: float
    right: float
    place: tuple[float, float]
    speed: float
    heading: float
    course: float
    bears: bool
    lifted: bool

    @property
    def load(self) -> float:
        """Of both skis (N)."""
        return self.left + self.right

    @property
    def lean(self) -> float:
        """Angle of the line from the middle of the feet to the centre of mass, positive left (rad)."""
        return math.atan2(self.aside, self.height)


def seen_at(moment: Moment, centre_height: float, normal: FloatArray, least_load: float, lifted_share: float) -> Seen:
    """State that the skier measures at a moment.

    Parameters
    ----------
    moment
        Moment of the run.
    centre_height
        Height of the centre of mass in the body (m).
    normal
        Normal of the snow, (3,).
    least_load
        Below which the loads tell nothing (N).
    lifted_share
        Share of the load below which a ski is lifted.
    """
    rotation, boots = moment.rotation, moment.boots
    up = normal @ rotation
    ahead = boots[:, 1].mean(axis=0)
    ahead = ahead - (ahead @ up) * up
    ahead /= np.linalg.norm(ahead)
    left = np.cross(up, ahead)
    force, turning = (np.einsum("kca,kc->ka", boots[:, 1:4], part) for part in np.split(moment.wrench, 2, axis=1))
    middle, drift = boots[:, 0].mean(axis=0), boots[:, 4].mean(axis=0)
    centre, spin = np.array([0.0, 0.0, centre_height]) - middle, moment.velocity[3:]
    loads = force @ up
    load = float(loads.sum())
    roll = float((np.cross(boots[:, 0] - middle, force) + turning).sum(axis=0) @ ahead)
    way = rotation @ (moment.velocity[:3] + np.cross(spin, middle) + drift)
    place, facing = moment.position + rotation @ middle, rotation @ ahead
    down, aside = down_and_left(normal)
    return Seen(
        aside=float(centre @ left),
        aside_rate=float((np.cross(spin, centre) - drift) @ left),
        height=float(centre @ up),
        pressure=roll / load if load > least_load else 0.0,
        left=float(loads[0]),
        right=float(loads[1]),
        place=(float(place[0]), float(place[1])),
        speed=math.hypot(way @ down, way @ aside),
        heading=math.atan2(facing @ aside, facing @ down),
        course=math.atan2(way @ aside, way @ down),
        bears=load > least_load,
        lifted=load > least_load and bool(loads.min() < lifted_share * load),
    )
