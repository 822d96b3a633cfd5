"""A replay as a glTF model in one binary file (GLB): one moment, or the whole motion."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeAlias

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation

from .._support.staging import write_file
from .binary import at_moments, thinned
from .glb import Glb
from .meshes import (
    CORNERS,
    end_of_force_scale,
    grid_mesh,
    groove_mesh,
    ski_mesh,
    snow_mesh,
    surface_heights,
    unloaded_ski_mesh,
    upright,
)
from .replay import SKI_NAMES
from .shapes import continuous, nearest_frame
from .skier import JOINTS
from .skier_shapes import part_poses, skier_mesh, skier_parts

if TYPE_CHECKING:
    from .replay import Replay, ReplayBoots


def replay_model(replay: Replay, time: float, *, exaggeration: float = 1.0) -> bytes:
    """A GLB file of the moment nearest to a time (s); bending and twist taken `exaggeration` times.

    Notes
    -----
    Metres; y is up as glTF 2.0 wants it, the run's own axes are those of the node ``run`` below. Colours of vertices:
    normal force per length along the skis, depth that stays along the groove, on the same scales as in the picture.
    """
    frame = nearest_frame(replay, time)
    named = {"snow": snow_mesh(replay)}
    for ski, name in enumerate(SKI_NAMES):
        named[f"{name} ski"] = ski_mesh(replay, frame, ski, exaggeration)
    if replay.skier is not None:
        named["skier"] = skier_mesh(replay, frame)
    made = replay.groove.time <= replay.time[frame]
    if made.any():
        named["groove"] = groove_mesh(replay, made)
    model = Glb()
    parts = [model.node(name, mesh=model.mesh(name, mesh)) for name, mesh in named.items()]
    run = model.node("run", rotation=upright(replay.tilt), children=parts)
    return model.finished(replay.title, [run])


def write_replay_model(replay: Replay, path: str | Path, time: float, *, exaggeration: float = 1.0) -> None:
    """Write the model of a moment; see `replay_model`.

    Raises
    ------
    OutputError
        The place cannot be written.
    """
    write_file(path, replay_model(replay, time, exaggeration=exaggeration))


FloatArray: TypeAlias = npt.NDArray[np.float64]

GROOVE_STEP: Final = 0.05
"""Time (s) in which a part of the groove is made that appears as one, when it is complete (modelling assumption)."""
_EYE, _LOOKED_AT = (-4.0, 0.0, 2.0), (0.4, 0.0, 0.1)  # of the camera that goes along, from the sledge (m)
_HIDDEN_AND_SHOWN: Final = [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]]


def moving_replay_model(replay: Replay, *, exaggeration: float = 1.0) -> bytes:
    """A GLB file of a whole replay that plays at true speed; bending and twist taken `exaggeration` times.

    Notes
    -----
    Metres; y is up as glTF 2.0 wants it, the run's own axes are those of the node ``run``. The one animation, ``run``,
    begins at 0 with the first moment and has a key at every moment, at most 100 a second; between them places go
    straight and attitudes by the shortest turn. The node ``sledge`` has the middle between the boots; below it each ski
    has one joint for each station, from tip to tail, and a skier one node for each part of the body. Nothing of the
    skis stays the same but their colours, which glTF 2.0 cannot move: they show the mean normal force. Each part
    of the groove has scale 0 until it is made, as section 3.5.3 of the specification hides what is not to be seen. A
    camera goes along.
    """
    shown = _told_apart(thinned(replay))
    model = Glb()
    clock = model.array(shown.time, bounds=True)
    course = model.array(shown.place)
    boots, body = _skier(model, shown, clock)
    skis = [node for ski in range(2) for node in _ski(model, shown, ski, exaggeration, clock, boots[ski : ski + 1])]
    sledge = model.node("sledge", translation=shown.place[0], rotation=_xyzw(shown)[0], children=[*skis, *body])
    model.move(sledge, "translation", clock, course)
    model.move(sledge, "rotation", clock, model.array(_xyzw(shown)))
    ground = {"snow": snow_mesh(shown), "grid": grid_mesh(shown)}
    parts = [model.node(name, mesh=model.mesh(name, mesh)) for name, mesh in ground.items()]
    parts += [*_groove(model, shown), sledge, _camera(model, shown, clock, course)]
    run = model.node("run", rotation=upright(shown.tilt), children=parts, extras=_extras(shown, exaggeration))
    return model.finished(shown.title, [run], cameras=_CAMERAS)


def write_moving_replay_model(replay: Replay, path: str | Path, *, exaggeration: float = 1.0) -> None:
    """Write the model of a whole replay; see `moving_replay_model`.

    Raises
    ------
    OutputError
        The place cannot be written.
    """
    write_file(path, moving_replay_model(replay, exaggeration=exaggeration))


def _told_apart(replay: Replay) -> Replay:
    """From time 0 on, moments alone whose times differ as float32: keys of an animation must rise."""
    time = (replay.time - replay.time[0]).astype(np.float32).astype(float)
    groove = replace(replay.groove, time=replay.groove.time - replay.time[0])
    kept = np.flatnonzero(np.append(np.diff(time) > 0.0, True))  # of equal ones the last
    return at_moments(replace(replay, time=time, groove=groove), kept)


def _xyzw(replay: Replay) -> FloatArray:
    return replay.attitude[:, [1, 2, 3, 0]]


def _about(axis: int, angle: FloatArray | float) -> FloatArray:
    """Quaternions x, y, z, w of turns about an axis (0 x, 1 y, 2 z) by angles (rad)."""
    half = 0.5 * np.asarray(angle)
    found = np.zeros((*half.shape, 4))
    found[..., axis], found[..., 3] = np.sin(half), np.cos(half)
    return found


def _skier(model: Glb, replay: Replay, clock: int) -> tuple[list[int], list[int]]:
    """A skier: the nodes of both boots, which stand on the skis, and those of the body's parts on the sledge."""
    boots: list[int] = []
    body: list[int] = []
    for part in [] if replay.skier is None else skier_parts(replay.skier.height):
        mesh = model.mesh(part.name, part.mesh)
        if replay.skier is None or part.start not in JOINTS:
            boots.append(model.node(part.name, mesh=mesh))
            continue
        place, turn = part_poses(replay.skier, part)
        turn = np.roll(turn, -1, axis=1)
        body.append(model.node(part.name, mesh=mesh, translation=place[0], rotation=turn[0]))
        model.move(body[-1], "translation", clock, model.array(place))
        model.move(body[-1], "rotation", clock, model.array(turn))
    return boots, body


def _ski(model: Glb, replay: Replay, ski: int, exaggeration: float, clock: int, on_it: list[int]) -> tuple[int, int]:
    """A ski: the node on the sledge that carries its joints and what stands on it, and the node with its mesh.

    The joints alone place a mesh with a skin (section 3.7.3.2), wherever its node is. It is on the sledge because some
    viewers look once how far the mesh reaches from its node, and draw it while that is in the picture.
    """
    skis, name = replay.skis, f"{SKI_NAMES[ski]} ski"
    place = np.zeros((*skis.bending[:, ski].shape, 3))
    place[..., 0], place[..., 2] = skis.station, skis.base_height + exaggeration * skis.bending[:, ski]
    turn = _about(0, -exaggeration * skis.twist[:, ski])  # the left edge goes down as the edge angle grows
    joints = []
    for j in range(len(skis.station)):
        joints.append(model.node(f"{name}, station {j + 1}", translation=place[0, j], rotation=turn[0, j]))
        model.move(joints[j], "translation", clock, model.array(place[:, j]))
        model.move(joints[j], "rotation", clock, model.array(turn[:, j]))
    boot = {"translation": skis.middle[ski], "rotation": _about(0, -skis.edge_angle)}
    moved = None if skis.boots is None else _on_the_sledge(replay, skis.boots, ski)
    if moved is not None:
        boot = {"translation": moved[0][0], "rotation": moved[1][0]}
    carrier = model.node(f"{name}, boot", children=[*joints, *on_it], **boot)
    if moved is not None:
        model.move(carrier, "translation", clock, model.array(moved[0]))
        model.move(carrier, "rotation", clock, model.array(moved[1]))
    into_joints = np.tile(np.eye(4), (len(joints), 1, 1))
    into_joints[:, 0, 3], into_joints[:, 2, 3] = -skis.station, -skis.base_height
    skin = model.skin(name, joints, carrier, into_joints)
    of_section = np.repeat(np.arange(len(joints)), CORNERS)
    mesh = model.mesh(name, unloaded_ski_mesh(replay, ski), joints=of_section)
    return carrier, model.node(name, mesh=mesh, skin=skin)


def _on_the_sledge(replay: Replay, boots: ReplayBoots, ski: int) -> tuple[FloatArray, FloatArray]:
    """Places (n, 3) of a boot that moves in the sledge's frame (m), and its quaternions x, y, z, w against it."""
    back = Rotation.from_quat(_xyzw(replay)).inv()
    turn = (back * Rotation.from_quat(np.roll(boots.attitude[:, ski], -1, axis=1))).as_quat()
    return back.apply(boots.place[:, ski] - replay.place), continuous(turn)


def _groove(model: Glb, replay: Replay) -> list[int]:
    """Parts of the groove, each seen from the end of its step on; those that are there from the start, always."""
    made = replay.groove.time
    step = np.maximum(0, np.ceil(made / GROOVE_STEP - 1e-9)).astype(int)
    appear = model.array(_HIDDEN_AND_SHOWN)
    parts = []
    for number in np.unique(step):
        time = min(float(number) * GROOVE_STEP, float(replay.time[-1]))
        name = f"groove to {time:.2f} s"
        parts.append(model.node(name, mesh=model.mesh(name, groove_mesh(replay, step == number))))
        if time > 0.0:
            times = model.array(np.array([0.0, time]), bounds=True)
            model.move(parts[-1], "scale", times, appear, interpolation="STEP")
    return parts


_CAMERAS: Final = [{"name": "along", "type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.5, "zfar": 300.0}}]


def _camera(model: Glb, replay: Replay, clock: int, course: int) -> int:
    """A camera uphill of the sledge that goes along and does not turn."""
    back = np.subtract(_EYE, _LOOKED_AT)
    back /= math.hypot(*back)
    right = np.cross([0.0, 0.0, 1.0], back)
    right /= math.hypot(*right)
    axes = np.column_stack([right, np.cross(back, right), back])  # a camera looks along -z, y up, section 3.10
    eye = model.node("camera", camera=0, translation=list(_EYE), rotation=Rotation.from_matrix(axes).as_quat())
    leans = _about(1, _steepness_behind(replay))
    along = model.node("camera's place", translation=replay.place[0], rotation=leans[0], children=[eye])
    model.move(along, "translation", clock, course)
    if replay.profile is not None or replay.terrain is not None:
        model.move(along, "rotation", clock, model.array(leans))
    return along


def _steepness_behind(replay: Replay) -> FloatArray:
    """Angle (n,) by which the snow falls from under the camera to the sledge (rad): by so much the camera is higher."""
    x, y = replay.place[:, 0], replay.place[:, 1]
    return np.arctan2(surface_heights(replay, x + _EYE[0], y) - surface_heights(replay, x, y), -_EYE[0])


def _extras(replay: Replay, exaggeration: float) -> dict[str, Any]:
    """What the model does not show of itself."""
    force = end_of_force_scale(replay.skis.force_per_length)
    return {
        "exaggeration_of_bending_and_twist": exaggeration,
        "colour_of_skis": f"mean over the run of the normal force of the snow per length, 0 to {force:g} N/m and more",
        "facts": dict(replay.facts),
    }
