"""Sledges that fly: nothing but inertia, the skis' stiffness, and gravity if asked."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.linalg import eigh

from skisnow.simulate.motion.equations import copy_state
from skisnow.simulate.motion.fast import REACH, fast_step, new_past
from skisnow.simulate.motion.forces import new_forces
from skisnow.simulate.motion.lines import new_lines
from skisnow.simulate.motion.model import Model, Snow, World, new_state, sledge_model
from skisnow.simulate.motion.ros2 import GAMMA, new_room, ros2_step
from skisnow.simulate.motion.system import factor, new_factored
from skisnow.simulate.motion.tangent import CHANNELS
from skisnow.simulate.sledge import RigidSledge
from skisnow.ski.beam.banded import dense
from skisnow.ski.beam.clamped import ClampedSki, clamped
from tests.simulate.equilibrium.synthetic import plain_ski, shovel

from .dense_model import INNER, dense_mass

FloatArray = npt.NDArray[np.float64]
SLEDGE = RigidSledge(80.0, (6.0, 8.0, 10.0), (0.1, 0.2), 0.5, 0.5)
NO_SNOW = Snow(
    hardness=1e8,
    excess=1e9,
    shear_stress=1e5,
    holding=2e-4,
    compaction=1.0,
    friction=0.05,
    friction_by_speed=0.0,
    friction_speed=0.01,
    one_sided=0.03,
)


def light_ski() -> ClampedSki:
    """A ski of twelve elements."""
    return clamped(plain_ski(base_height=shovel(1.2, 0.1, 1.6), running_length=1.2), 0.3, 12)


def free_model(sledge: RigidSledge = SLEDGE) -> Model:
    """A sledge on such skis, without damping."""
    return sledge_model(sledge, light_ski(), damping_ratio=0.0)


def first_mode(ski: ClampedSki) -> tuple[float, FloatArray]:
    """Angular frequency (rad/s) and shape (size,) of the clamped ski's lowest mode, 1 cm at the most."""
    value, shape = eigh(dense(ski.stiffness), dense(ski.mass), subset_by_index=[0, 0])
    return float(np.sqrt(value[0])), 0.01 * shape[:, 0] / np.max(np.abs(shape[::3, 0]))


class Flight:
    """A sledge in the air."""

    def __init__(self, model: Model, *, gravity: float = 0.0) -> None:
        n = len(model.mass)
        self.model = model
        self.world = World(np.array([0.0, 0.0, -gravity]), 0.0, 0.0, 0.0, 1.0, np.zeros((1, 2)))
        self.state, self._next = new_state(n), new_state(n)
        self._forces, self._stage = new_forces(n, 4), new_forces(n, 4)
        self._lines = new_lines(4, spacing=0.02, cell=1e-3)
        self._system, self._room = new_factored(n), new_room(n)
        self._past = new_past(n)

    def fly(self, duration: float, steps: int, *, method: str = "ros2") -> Flight:
        """Go on for a duration (s) in equal steps."""
        h = duration / steps
        for i in range(steps):
            if i < 2:  # the fast mode's first step is one of Euler's method
                reach = GAMMA * h if method == "ros2" else h if self._past.step[0] != h else REACH * h
                structure = reach * (reach + self.model.damping)
                rows = np.zeros((2, CHANNELS, 6))
                assert factor(self.model, self._forces, rows, structure, reach * reach, self._system)
            if method == "fast":
                fast_step(
                    self.model, self.world, self.state, self._forces, self._system, h, self._past, self._next
                )  # fmt: skip
            else:
                ros2_step(
                    self.model, NO_SNOW, self.world, self._lines, self.state, self._forces, self._stage, self._system,
                    h, self._room, self._next,
                )  # fmt: skip
            copy_state(self._next, self.state)
        return self

    @property
    def speeds(self) -> FloatArray:
        """All velocities (6 + 2 n)."""
        return np.concatenate([self.state.velocity, self.state.bend_rate[:, INNER].ravel()])

    def momenta(self) -> tuple[FloatArray, FloatArray]:
        """Momentum and angular momentum about a fixed point, in space."""
        whole = dense_mass(self.model)[:6] @ self.speeds
        momentum = self.state.turn @ whole[:3]
        return momentum, self.state.turn @ whole[3:] + np.cross(self.state.place, momentum)
