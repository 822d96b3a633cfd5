"""A run of the reference: lines laid ahead, taken up behind, steps of one size, the accepted pressed into the snow."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import brentq

from skisnow.simulate.judge.run_setup import Setup
from skisnow.simulate.motion.lines import CELLS
from skisnow.simulate.motion.model import Snow, World
from skisnow.ski.beam.clamped import clamped

from .reference import Body, Motion, felt, motion_of, ros2_step
from .reference_snow import Line, lines_of, remember

FloatArray = npt.NDArray[np.float64]
AHEAD, BESIDE, FREE_CELLS, STEPS_PER_TANGENT, EASY = 0.12, 0.04, 24, 4, 1.0


class ReferenceRun:
    """Begins where a set-up begins, on virgin snow."""

    def __init__(self, setup: Setup) -> None:
        self.snow: Snow = setup.snow
        self.world: World = setup.world
        self.body = body_of(setup)
        self.motion: Motion = motion_of(setup.memory.state)
        self.lines = lines_of(setup.lines)
        self.spacing, self.cell = (float(value) for value in setup.lines.spacing)
        self.most_cells = CELLS - FREE_CELLS
        for line in (*self.lines[0], *self.lines[1]):
            line.cells, line.anchor, line.cell, line.slope, line.above, line.marked = (
                {},
                None,
                self.cell,
                0.0,
                None,
                None,
            )
        self.kept_for = 0
        self._feel()

    def step(self, h: float) -> None:
        """One step (s), accepted."""
        if self.kept_for == 0:
            self.tangent = self.start.tangent
            per_length = self.start.stiffness / np.maximum(self.start.met, 1.0) / self.spacing
            self.kept_for = STEPS_PER_TANGENT if max(per_length) * h**2 <= EASY else 1
        self.kept_for -= 1
        arguments = (self.body, self.snow, self.world, self.spacing, self.lines)
        self.motion = ros2_step(*arguments, self.motion, replace(self.start, tangent=self.tangent), h)
        for k in range(2):
            self._follow(k)
        self._feel()

    def _feel(self) -> None:
        """Forces first, then the snow gives way: what is felt for the first time counts as virgin snow."""
        self.start = felt(self.body, self.snow, self.spacing, self.lines, self.motion)
        for line in (*self.lines[0], *self.lines[1]):
            remember(line, self.snow, self.most_cells)

    def _follow(self, k: int) -> None:
        body, lines = self.body, self.lines[k]
        while self._station(k, lines[0]) < body.tail - AHEAD - 3.0 * self.spacing:
            lines.pop(0)
        s = self._station(k, lines[-1])
        while s < body.tip + AHEAD:
            s += self.spacing
            lines.append(self._laid(k, s))

    def _station(self, k: int, line: Line) -> float:
        """Where the line goes through the plane of the sledge's own x and z, under the ski's axis."""
        turn = self.motion.turn
        origin = turn.T @ (line.origin - self.motion.place) - self.body.middle[k]
        left = turn.T @ line.left
        return float(origin[0] - origin[1] / left[1] * left[0])

    def _laid(self, k: int, s: float) -> Line:
        turn, body = self.motion.turn, self.body
        lateral = turn @ body.lateral
        side = np.clip(-lateral[2] / self.snow.one_sided, -1.0, 1.0) * BESIDE
        origin = self.motion.place + turn @ body.middle[k] + s * turn[:, 0] + side * lateral
        above, axis = origin[2], turn[:, 0]

        def off(ahead: float) -> float:
            """How far the surface there lies from this station."""
            height = surface(self.world, float(origin[0] + ahead * axis[0]))[0]
            return float(ahead * axis[:2] @ axis[:2] + (height - above) * axis[2])

        if len(self.world.heights) > 1:
            origin[:2] += brentq(off, -0.5, 0.5, xtol=1e-15) * axis[:2]
        else:
            origin[:2] += above * axis[2] / (axis[:2] @ axis[:2]) * axis[:2]
        origin[2], gradient = surface(self.world, float(origin[0]))
        out = np.array([-gradient, 0.0, 1.0]) / math.hypot(1.0, gradient)
        ahead = turn[:, 0] - (turn[:, 0] @ out) * out
        ahead /= np.linalg.norm(ahead)
        return Line(origin, ahead, np.cross(out, ahead), out, self.cell)


def surface(world: World, x: float) -> tuple[float, float]:
    """Height and gradient of the slope."""
    if len(world.heights) == 1:
        return 0.0, 0.0
    at = world.slope_start + world.slope_step * np.arange(len(world.heights))
    curve = CubicHermiteSpline(at, world.heights[:, 0], world.heights[:, 1])
    return float(curve(x)), float(curve(x, 1))


def body_of(setup: Setup) -> Body:
    """The dense sledge of a set-up."""
    scenario = setup.scenario
    ski = clamped(scenario.ski, scenario.clamp_length, int(setup.numbers["elements"]))
    return Body(scenario.sledge, ski, setup.model.damping)
