"""The sledge on two skis in MuJoCo, in free flight: each ski 20 rigid segments on bending and torsion hinges.

MuJoCo (Todorov, Erez and Tassa 2012) has no beam that bends and twists by given EI and GJ; chains of hinges with
springs are what one builds there. Each hinge has the compliance of the ski between the middles of its two segments.
Of its integrators that take the hinges' damping implicitly the quicker one: it leaves Coriolis' forces out of its
matrix, ends as near, and takes a fifth of the time.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any, Final, TypeAlias

import mujoco
import numpy as np
import numpy.typing as npt

from skisnow.ski.ski import Ski

from .clamped_modes import CLAMP_LENGTH, first_frequency

FloatArray: TypeAlias = npt.NDArray[np.float64]

ENGINE: Any = mujoco  # its compiled names are not typed
SEGMENTS: Final = 20
DAMPING_RATIO: Final = 0.02
POINTS: Final = 400
"""Of the integrals along a segment."""
RIGID: Final = 6
"""Unknowns of the sledge; those of the skis follow."""
HINGE_ANGLE: Final = -0.01
"""Each hinge of the foreski (rad) that the skis are released from: towards the sledge, 5 cm at the tip."""


def flight(ski: Ski, *, step: float) -> Any:
    """MuJoCo's model with that time step (s)."""
    bending, _ = clamped_frequencies(ENGINE.MjModel.from_xml_string(_text(ski, step, 0.0)))
    return ENGINE.MjModel.from_xml_string(_text(ski, step, 2.0 * DAMPING_RATIO / (2.0 * np.pi * bending)))


def clamped_frequencies(model: Any) -> tuple[float, float]:
    """First of bending and of torsion of one ski with the sledge held (Hz)."""
    stiffness, mass, bends = _one_ski(model)
    return first_frequency(stiffness, mass, bends), first_frequency(stiffness, mass, ~bends)


def released(model: Any) -> Any:
    """Data with both foreskis bent evenly."""
    data = ENGINE.MjData(model)
    for joint in range(1, model.njnt):
        if "front" in model.joint(joint).name and model.jnt_axis[joint, 1]:
            data.qpos[model.jnt_qposadr[joint]] = HINGE_ANGLE
    ENGINE.mj_forward(model, data)
    return data


def tips(data: Any) -> FloatArray:
    """Places of the foremost segments of both skis (2, 3) (m)."""
    return np.array([data.body(f"{side} front last").xpos for side in ("left", "right")])


def flown(model: Any, data: Any, steps: int) -> None:
    """Take so many steps in MuJoCo's own loop."""
    ENGINE.mj_step(model, data, steps)


def _one_ski(model: Any) -> tuple[FloatArray, FloatArray, npt.NDArray[np.bool_]]:
    data = ENGINE.MjData(model)
    ENGINE.mj_forward(model, data)
    full = np.zeros((model.nv, model.nv))
    ENGINE.mj_fullM(model, data, full)
    unknowns, joints = slice(RIGID, RIGID + 2 * SEGMENTS), slice(1, 1 + 2 * SEGMENTS)
    stiffness = np.asarray(model.jnt_stiffness[joints]).reshape(2 * SEGMENTS, -1)[:, 0]
    return np.diag(stiffness), full[unknowns, unknowns], model.jnt_axis[joints, 1] != 0.0


def _text(ski: Ski, step: float, damping: float) -> str:
    """The model in MuJoCo's XML; `damping` is a hinge's over its stiffness (s)."""
    sides = "".join(
        f'<body name="{side}" pos="0 {y} 0" euler="30 0 0">{_mount(ski)}{_chains(ski, side, damping)}</body>'
        for side, y in (("left", 0.25), ("right", -0.25))
    )
    return f"""<mujoco><compiler angle="degree" autolimits="true"/>
    <option timestep="{step}" integrator="implicitfast" gravity="1.7 0 -9.66">
    <flag contact="disable" constraint="disable"/></option>
    <worldbody><body name="sledge"><freejoint/><inertial pos="0 0 0.12" mass="80" diaginertia="6 8 10"/>{sides}
    </body></worldbody></mujoco>"""


def _mount(ski: Ski) -> str:
    half = CLAMP_LENGTH / 2.0
    return _inertial(ski, -half, half, 0.0)


def _chains(ski: Ski, side: str, damping: float) -> str:
    half = CLAMP_LENGTH / 2.0
    tip, tail = float(ski.station[0]), float(ski.station[-1])
    front = round(SEGMENTS * (tip - half) / (tip - tail - CLAMP_LENGTH))
    ends = (np.linspace(half, tip, front + 1), np.linspace(-half, tail, SEGMENTS - front + 1))
    names = (f"{side} front", f"{side} rear")
    return "".join(_half_ski_xml(ski, name, end, damping) for name, end in zip(names, ends, strict=True))


def _half_ski_xml(ski: Ski, name: str, end: FloatArray, damping: float) -> str:
    """Segments one in the other, from the clamp outwards."""
    middle = (end[:-1] + end[1:]) / 2.0
    opened = ""
    for i, (near, far) in enumerate(pairwise(end)):
        inner = end[0] if i == 0 else middle[i - 1]
        at = ski.at(_points(inner, middle[i]))
        place = near - (end[i - 1] if i else 0.0)
        last = "last" if i == len(middle) - 1 else str(i)
        opened += f'<body name="{name} {last}" pos="{place} 0 0">'
        for axis, along in (("0 1 0", at.bending_stiffness), ("1 0 0", at.torsional_stiffness)):
            stiffness = 1.0 / (abs(middle[i] - inner) * float(np.mean(1.0 / along)))
            opened += (
                f'<joint name="{name} {i} {axis}" type="hinge" axis="{axis}" stiffness="{stiffness}" '
                f'damping="{damping * stiffness}"/>'
            )
        opened += _inertial(ski, near, far, near)
    return opened + "</body>" * len(middle)


def _inertial(ski: Ski, near: float, far: float, origin: float) -> str:
    """Mass, middle and inertia of the ski between two stations, its frame at the station `origin`."""
    place = _points(near, far)
    at = ski.at(place)
    mass = at.mass_per_length * abs(far - near) / POINTS
    middle = float(mass @ place / mass.sum())
    about_axis = float(mass @ at.width**2 / 12.0)
    across = float(mass @ (place - middle) ** 2)
    inertia = f"{about_axis} {across} {across + about_axis}"
    return f'<inertial pos="{middle - origin} 0 0" mass="{mass.sum()}" diaginertia="{inertia}"/>'


def _points(near: float, far: float) -> FloatArray:
    """Middles of equal pieces between two stations."""
    return np.asarray(near + (np.arange(POINTS) + 0.5) / POINTS * (far - near))
