"""Replay as a glTF model in a binary file (GLB): one moment, or the whole motion."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, Final

import numpy as np
from scipy.spatial.transform import Rotation

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .meshes import (
    CORNERS,
    Glb,
    end_of_force_scale,
    grid_mesh,
    groove_mesh,
    rotation_to_gltf,
    ski_mesh,
    snow_mesh,
    surface_heights,
    unloaded_ski_mesh,
)
from .page import select_moments, thin_replay
from .replay import SKI_NAMES, Replay, nearest_frame, rotation_of, without_sign_jumps
from .skier import JOINTS, part_poses, skier_mesh, skier_parts


def replay_model(replay: Replay, time: float, *, exaggeration: float = 1.0) -> bytes:
    """GLB file of the moment nearest to a time (s); ``exaggeration`` is the factor of bending and twist.

    Metres; y is up as in glTF 2.0, and the node ``run`` below has the run's axes. Colours of vertices: normal force per
    length along the skis, residual depth along the groove, on the same scales as on the page.

    Raises ParameterError: the time is more than 0.01 s outside of the run.
    """
    first, last = replay.time[[0, -1]].tolist()
    if not first - 0.01 <= time <= last + 0.01:
        raise ParameterError("the run is from {first:g} to {last:g} s; {time:g} s is outside of it").tag(
            "out_of_range", first=first, last=last, time=time
        )
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
    run = model.node("run", rotation=rotation_to_gltf(replay.tilt), children=parts)
    return model.to_bytes(replay.title, [run])


GROOVE_STEP: Final = 0.05
"""Time (s) of the parts of the groove, each of which appears when it is complete."""
_EYE, _LOOKED_AT = (-4.0, 0.0, 2.0), (0.4, 0.0, 0.1)  # camera and its target from the sledge (m)
_HIDDEN_AND_SHOWN: Final = [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]]


def moving_replay_model(replay: Replay, *, exaggeration: float = 1.0) -> bytes:
    """GLB file of a whole replay at true speed; ``exaggeration`` is the factor of bending and twist.

    Metres; y is up as in glTF 2.0, and the node ``run`` has the run's axes. The animation ``run`` begins at 0 with the
    first moment and has a key at every moment, at most 100 per second; places are linear between them, attitudes take
    the shortest rotation. The node ``sledge`` is at the middle between the boots; each ski below it has a joint for a
    station, from tip to tail, and a skier a node for each part of the body. The colours of the skis are constant,
    because glTF 2.0 cannot animate them: they show the mean normal force. Each part of the groove has scale 0 until its
    time, the way to hide a node in section 3.5.3 of the specification. A camera moves with the sledge.
    """
    shown = _with_rising_times(thin_replay(replay))
    model = Glb()
    times = model.array(shown.time, bounds=True)
    places = model.array(shown.place)
    boots, body = _skier(model, shown, times)
    skis = [node for ski in range(2) for node in _ski(model, shown, ski, exaggeration, times, boots[ski : ski + 1])]
    turns = np.roll(shown.attitude, -1, axis=1)
    sledge = model.node("sledge", translation=shown.place[0], rotation=turns[0], children=[*skis, *body])
    model.move(sledge, "translation", times, places)
    model.move(sledge, "rotation", times, model.array(turns))
    ground = {"snow": snow_mesh(shown), "grid": grid_mesh(shown)}
    parts = [model.node(name, mesh=model.mesh(name, mesh)) for name, mesh in ground.items()]
    parts += [*_groove(model, shown), sledge, _camera(model, shown, times, places)]
    run = model.node("run", rotation=rotation_to_gltf(shown.tilt), children=parts, extras=_extras(shown, exaggeration))
    return model.to_bytes(shown.title, [run], cameras=_CAMERAS)


def _with_rising_times(replay: Replay) -> Replay:
    """Copy of a replay from time 0 without moments of equal time as float32, because keys of an animation must rise."""
    time = (replay.time - replay.time[0]).astype(np.float32).astype(float)
    groove = replace(replay.groove, time=replay.groove.time - replay.time[0])
    moments = np.flatnonzero(np.append(np.diff(time) > 0.0, True))  # the last one of equal times
    return select_moments(replace(replay, time=time, groove=groove), moments)


def _about(axis: int, angle: FloatArray | float) -> FloatArray:
    """Quaternions x, y, z, w of rotations about an axis (0 x, 1 y, 2 z) by angles (rad)."""
    half = 0.5 * np.asarray(angle)
    quaternions = np.zeros((*half.shape, 4))
    quaternions[..., axis], quaternions[..., 3] = np.sin(half), np.cos(half)
    return quaternions


def _skier(model: Glb, replay: Replay, times: int) -> tuple[list[int], list[int]]:
    """Add a skier; returns the nodes of the boots, to be put below the skis, and of the body, below the sledge."""
    boots: list[int] = []
    body: list[int] = []
    for part in [] if replay.skier is None else skier_parts(replay.skier.height):
        mesh = model.mesh(part.name, part.mesh)
        if replay.skier is None or part.start not in JOINTS:
            boots.append(model.node(part.name, mesh=mesh))
        else:
            place, turn = part_poses(replay.skier, part)
            body.append(_moving_node(model, part.name, times, place, np.roll(turn, -1, axis=1), mesh=mesh))
    return boots, body


def _moving_node(model: Glb, name: str, times: int, place: FloatArray, turn: FloatArray, **properties: Any) -> int:
    """Add a node that follows places (n, 3) and quaternions x, y, z, w (n, 4) at the times of the accessor `times`."""
    node = model.node(name, translation=place[0], rotation=turn[0], **properties)
    model.move(node, "translation", times, model.array(place))
    model.move(node, "rotation", times, model.array(turn))
    return node


def _ski(model: Glb, replay: Replay, ski: int, exaggeration: float, times: int, on_ski: list[int]) -> tuple[int, int]:
    """Add a ski; returns the node that carries its joints and boot, and that of its mesh, both below the sledge.

    Only the joints place a mesh with a skin (section 3.7.3.2). Its node is on the sledge because some viewers determine
    the visibility of a mesh once, from the place of its node.
    """
    skis, name = replay.skis, f"{SKI_NAMES[ski]} ski"
    place = np.zeros((*skis.bending[:, ski].shape, 3))
    place[..., 0], place[..., 2] = skis.station, skis.base_height + exaggeration * skis.bending[:, ski]
    turn = _about(0, -exaggeration * skis.twist[:, ski])  # the left edge goes down as the edge angle grows
    joints = [
        _moving_node(model, f"{name}, station {j + 1}", times, place[:, j], turn[:, j])
        for j in range(len(skis.station))
    ]
    on_boot = [*joints, *on_ski]
    if skis.boots is None:
        fixed = {"translation": skis.middle[ski], "rotation": _about(0, -skis.edge_angle)}
        carrier = model.node(f"{name}, boot", children=on_boot, **fixed)
    else:
        back = rotation_of(replay.attitude).inv()  # places and turns in the sledge's frame
        path = back.apply(skis.boots.place[:, ski] - replay.place)
        turns = without_sign_jumps((back * rotation_of(skis.boots.attitude[:, ski])).as_quat())
        carrier = _moving_node(model, f"{name}, boot", times, path, turns, children=on_boot)
    into_joints = np.tile(np.eye(4), (len(joints), 1, 1))
    into_joints[:, 0, 3], into_joints[:, 2, 3] = -skis.station, -skis.base_height
    skin = model.skin(name, joints, carrier, into_joints)
    of_section = np.repeat(np.arange(len(joints)), CORNERS)
    mesh = model.mesh(name, unloaded_ski_mesh(replay, ski), joints=of_section)
    return carrier, model.node(name, mesh=mesh, skin=skin)


def _groove(model: Glb, replay: Replay) -> list[int]:
    """Add the groove in parts of `GROOVE_STEP` seconds, each visible from its end on; returns their nodes."""
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


def _camera(model: Glb, replay: Replay, times: int, places: int) -> int:
    """Add a camera that follows uphill of the sledge, and on a profile or terrain pitches with the snow; its node.

    times, places: accessors of the moments and of the sledge's places.
    """
    back = np.subtract(_EYE, _LOOKED_AT)
    back /= math.hypot(*back)
    right = np.cross([0.0, 0.0, 1.0], back)
    right /= math.hypot(*right)
    axes = np.column_stack([right, np.cross(back, right), back])  # a camera looks along -z, y up, section 3.10
    eye = model.node("camera", camera=0, translation=list(_EYE), rotation=Rotation.from_matrix(axes).as_quat())
    x, y = replay.place[:, 0], replay.place[:, 1]
    rise = surface_heights(replay, x + _EYE[0], y) - surface_heights(replay, x, y)  # of the snow below the camera
    leans = _about(1, np.arctan2(rise, -_EYE[0]))
    along = model.node("camera's place", translation=replay.place[0], rotation=leans[0], children=[eye])
    model.move(along, "translation", times, places)
    if replay.profile is not None or replay.terrain is not None:
        model.move(along, "rotation", times, model.array(leans))
    return along


def _extras(replay: Replay, exaggeration: float) -> dict[str, Any]:
    """Values of a replay for the property `extras` of its model: exaggeration, meaning of the colours, facts."""
    force = end_of_force_scale(replay.skis.force_per_length)
    return {
        "exaggeration_of_bending_and_twist": exaggeration,
        "colour_of_skis": f"mean over the run of the normal force of the snow per length, 0 to {force:g} N/m and more",
        "facts": dict(replay.facts),
    }
