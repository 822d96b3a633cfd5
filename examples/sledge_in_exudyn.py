"""A rigid sledge in Exudyn on skisnow's snow: Exudyn moves it, a user function before each step asks the contact.

    python examples/sledge_in_exudyn.py

Printed is where the sledge is after a time. It needs Exudyn (pip install exudyn).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from skisnow import read_ski
from skisnow.contact import Runner, SnowContact, SnowField

FloatArray = npt.NDArray[np.float64]
MASS, INERTIA, HEIGHT, STANCE = 88.0, np.diag([3.0, 6.0, 8.0]), 0.2, 0.5
SLOPE, EDGE, HEADING, SPEED = math.radians(10.0), math.radians(30.0), math.radians(-30.0), 7.0
GRAVITY = 9.81 * np.array([math.sin(SLOPE), 0.0, -math.cos(SLOPE)])  # x down the slope, z out of the snow
START, PITCH, ROLL = np.array([0.0, 0.0, 0.027189309]), -2.0784154e-3, 4.708869e-4  # at rest in this snow
FEET = np.array([[0.0, side * STANCE / 2.0, -HEIGHT] for side in (1.0, -1.0)])  # of the boots from the centre of mass
EDGED = np.array([[1, 0, 0], [0, math.cos(EDGE), math.sin(EDGE)], [0, -math.sin(EDGE), math.cos(EDGE)]])
STEP = 2e-4


def axes_at_start() -> FloatArray:
    """Of the sledge as columns: heading, then pitch, then roll."""
    (sh, ch), (sp, cp), (sr, cr) = ((math.sin(a), math.cos(a)) for a in (HEADING, PITCH, ROLL))
    about_z = np.array([[ch, -sh, 0.0], [sh, ch, 0.0], [0.0, 0.0, 1.0]])
    about_y = np.array([[cp, 0.0, sp], [0.0, 1.0, 0.0], [-sp, 0.0, cp]])
    return about_z @ about_y @ np.array([[1.0, 0.0, 0.0], [0.0, cr, -sr], [0.0, sr, cr]])


def glide(duration: float, step: float = STEP) -> FloatArray:
    """Where the boots' middle is after a time (m)."""
    import exudyn
    import exudyn.utilities

    engine, items = exudyn, exudyn.utilities  # they are not typed
    container: Any = engine.SystemContainer()
    system = container.AddSystem()
    axes = axes_at_start()
    body = system.CreateRigidBody(
        inertia=items.RigidBodyInertia(mass=MASS, inertiaTensor=INERTIA),
        referencePosition=(START + HEIGHT * axes[:, 2]).tolist(),
        referenceRotationMatrix=axes,
        initialVelocity=(SPEED * axes[:, 0]).tolist(),
        gravity=GRAVITY.tolist(),
    )
    marker = system.AddMarker(items.MarkerBodyRigid(bodyNumber=body))
    force = system.AddLoad(items.Force(markerNumber=marker, loadVector=[0, 0, 0]))
    moment = system.AddLoad(items.Torque(markerNumber=marker, loadVector=[0, 0, 0]))
    runner = Runner.of(read_ski("giant-slalom"))
    contact = SnowContact(SnowField(2e8, 5e5, 10.0, friction=0.01), [runner, runner])
    kinds = engine.OutputVariableType

    def before_step(system: Any, time: float) -> bool:
        """The force at the step's beginning acts over the step; the pose there enters the snow's history."""
        place, spin, speed = (
            np.asarray(system.GetObjectOutputBody(body, kind, [0, 0, 0]))
            for kind in (kinds.Position, kinds.AngularVelocity, kinds.Velocity)
        )
        turned = np.asarray(system.GetObjectOutputBody(body, kinds.RotationMatrix, [0, 0, 0])).reshape(3, 3)
        arms, since = FEET @ turned.T, step if time > 0.5 * step else 0.0
        pose = place + arms, orthonormal(turned) @ np.array([EDGED, EDGED])
        moves = np.column_stack([speed + np.cross(spin, arms), np.tile(spin, (2, 1))])
        wrench = contact.force(*pose, moves, since).wrench
        contact.update(*pose, since)
        system.SetLoadParameter(force, "loadVector", wrench[:, :3].sum(axis=0).tolist())
        about = (wrench[:, 3:] + np.cross(arms, wrench[:, :3])).sum(axis=0)
        system.SetLoadParameter(moment, "loadVector", about.tolist())
        return True

    system.SetPreStepUserFunction(before_step)
    system.Assemble()
    settings = engine.SimulationSettings()
    settings.timeIntegration.numberOfSteps = round(duration / step)
    settings.timeIntegration.endTime = duration
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    system.SolveDynamic(settings, solverType=engine.DynamicSolverType.GeneralizedAlpha)
    end = np.asarray(system.GetObjectOutputBody(body, kinds.Position, [0, 0, 0]))
    up = np.asarray(system.GetObjectOutputBody(body, kinds.RotationMatrix, [0, 0, 0])).reshape(3, 3)[:, 2]
    return end - HEIGHT * up


def orthonormal(axes: FloatArray) -> FloatArray:
    """The rotation next to axes that have drifted."""
    left, _, right = np.linalg.svd(axes)
    return np.asarray(left @ right)


if __name__ == "__main__":
    x, y, z = glide(1.0)
    print(f"after 1 s at ({x:.4f}, {y:.4f}, {z:.4f}) m")
