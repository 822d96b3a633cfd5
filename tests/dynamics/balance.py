"""Forces on a body at rest, summed here without its compiled equations."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from skisnow.contact import ContactForces
from skisnow.dynamics import Dynamics, FlexibleSki

FloatArray = npt.NDArray[np.float64]


def dense(lower: FloatArray) -> FloatArray:
    """A symmetric matrix of the lower half of its band: [i, j] is A[i, i - j]."""
    size, width = lower.shape
    full = np.zeros((size, size))
    for j in range(width):
        rows = np.arange(j, size)
        full[rows, rows - j] = full[rows - j, rows] = lower[rows, j]
    return full


def nodes_of(ski: FlexibleSki, bend: FloatArray) -> FloatArray:
    """Deflection, slope and twist at each node, (nodes, 3)."""
    free = ski.unknown >= 0
    out = np.zeros((len(free), 3))
    out[free] = bend[ski.unknown[free].astype(int)[:, None] + np.arange(3)]
    return out


def snow_forces(dynamics: Dynamics) -> ContactForces:
    """Of the snow at rest where the body is."""
    rotation, body = dynamics.rotation, dynamics.body
    boots = np.array([dynamics.position + rotation @ ski.boot for ski in body.skis])
    axes = np.array([rotation @ ski.axes.T for ski in body.skis])
    beams = [nodes_of(ski, bend) for ski, bend in zip(body.skis, dynamics.beam_dofs, strict=True)]
    return dynamics.contact.force(boots, axes, np.zeros((len(boots), 6)), 0.0, beam_dofs=beams)


def left_over(dynamics: Dynamics) -> tuple[FloatArray, list[FloatArray]]:
    """Force and moment on the body (6,), and on each ski's unknowns, in the body's axes."""
    body, rotation = dynamics.body, dynamics.rotation
    weight = rotation.T @ body.gravity
    total = np.concatenate([body.mass * weight, np.cross(body.first_moment, weight)])
    snow, of_skis = snow_forces(dynamics), []
    for k, ski in enumerate(body.skis):
        force, moment = rotation.T @ snow.wrench[k, :3], rotation.T @ snow.wrench[k, 3:]
        total += np.concatenate([force, moment + np.cross(ski.boot, force)])
        of_skis.append(_on_ski(ski, weight, dynamics.beam_dofs[k], snow.beam_loads[k]))
    return total, of_skis


def _on_ski(ski: FlexibleSki, weight: FloatArray, bend: FloatArray, loads: FloatArray) -> FloatArray:
    free = ski.unknown >= 0
    felt = np.zeros_like(bend)
    felt[ski.unknown[free].astype(int)[:, None] + np.arange(3)] = loads[free]
    return felt + ski.coupling[:, :3] @ weight - dense(ski.stiffness) @ bend
