"""One ski in Exudyn, swinging: half of what flies in MuJoCo's model, with bending in its plane alone.

The chain of geometrically exact cables is the one that the tests hold our statics against, with the ski's own mass.
Clamped at the middle of the boot: the clamp's length is held by its nodes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final, TypeAlias

import exudyn
import numpy as np
import numpy.typing as npt

from skisnow.ski.ski import Ski

from ..exudyn_contact import ACROSS, ALONG, ITEMS, SLOPE_ACROSS, SLOPE_ALONG, chain
from .clamped_modes import CLAMP_LENGTH

FloatArray: TypeAlias = npt.NDArray[np.float64]

ELEMENTS: Final = 40
DAMPING_RATIO: Final = 0.02
FREQUENCY_SWING_S: Final = 0.4
FREQUENCY_STEP: Final = 0.5e-3
"""(s)"""
TIP_SPEED: Final = 2.0
"""Across at the tip at the start (m/s), falling to none at the clamp: a swing of some centimetres."""


@dataclass(frozen=True, slots=True)
class SwingingSki:
    """Exudyn's system, and its sensor of the tip's displacement."""

    system: Any
    sensor: Any

    def tip(self, seconds: float, *, step: float) -> FloatArray:
        """Deflection of the tip across, over time (n, 2) (s, m), with that step (s); each call starts afresh."""
        settings: Any = exudyn.SimulationSettings()
        settings.solution.file.write = False
        settings.solution.sensors.writePeriod = step
        settings.timeIntegration.endTime = seconds
        settings.timeIntegration.numberOfSteps = round(seconds / step)
        settings.timeIntegration.newton.useModifiedNewton = True
        settings.linearSolver.solverType = exudyn.LinearSolverType.EigenSparse
        assert self.system.SolveDynamic(settings)
        return np.asarray(self.system.GetSensorStoredData(self.sensor))[:, [0, 2]]

    def frequency(self) -> float:
        """Of the tip's swing, from its passages through the middle (Hz); by then higher modes have died."""
        time, across = self.tip(FREQUENCY_SWING_S, step=FREQUENCY_STEP).T
        rising = np.flatnonzero((across[:-1] < 0.0) & (across[1:] >= 0.0))
        share = across[rising] / (across[rising] - across[rising + 1])
        passages = time[rising] + share * (time[rising + 1] - time[rising])
        return float((len(passages) - 1) / (passages[-1] - passages[0]))


def swinging(ski: Ski, *, frequency: float) -> SwingingSki:
    """The ski with 2 % damping of its first mode, whose frequency (Hz) is known."""
    tip, tail, half = float(ski.station[0]), float(ski.station[-1]), CLAMP_LENGTH / 2.0
    front = round(ELEMENTS * (tip - half) / (tip - tail))
    rear = round(ELEMENTS * (-half - tail) / (tip - tail))
    middle = np.linspace(-half, half, ELEMENTS - front - rear + 1)
    place = np.concatenate([np.linspace(tail, -half, rear + 1)[:-1], middle, np.linspace(half, tip, front + 1)[1:]])
    beam = chain(lambda x: ski.at(x).bending_stiffness, place)
    for i, at in enumerate((place[:-1] + place[1:]) / 2.0):
        section = ski.at(at)
        damping = 2.0 * DAMPING_RATIO / (2.0 * np.pi * frequency) * float(section.bending_stiffness)
        beam.system.SetObjectParameter(i, "massPerLength", float(section.mass_per_length))
        beam.system.SetObjectParameter(i, "bendingDamping", damping)
    for node in range(rear, rear + len(middle)):
        beam.hold(node, ALONG, ACROSS, SLOPE_ALONG, SLOPE_ACROSS)
    for node, x in zip(beam.nodes, place, strict=True):
        speed = TIP_SPEED * (x - half) / (tip - half) if x > half else 0.0
        beam.system.SetNodeParameter(node, "initialVelocities", [0.0, speed, 0.0, speed and TIP_SPEED / (tip - half)])
    displacement = exudyn.OutputVariableType.Displacement
    sensor = ITEMS.SensorNode(nodeNumber=beam.nodes[-1], storeInternal=True, outputVariableType=displacement)
    number = beam.system.AddSensor(sensor)
    beam.system.Assemble()
    return SwingingSki(beam.system, number)
