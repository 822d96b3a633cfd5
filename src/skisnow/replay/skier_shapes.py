"""The drawn shape of a skier: round parts between joints, and how they stand. Nothing of it is computed with."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, TypeAlias

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation

from ..skier.segments import SHANK, THIGH, TRUNK, UPPER_ARM
from .glb import Mesh
from .meshes import linear
from .shapes import quaternions
from .skier import HEAD, JOINTS, POLE, STAND_HEIGHT

if TYPE_CHECKING:
    from collections.abc import Sequence

    from .replay import Replay, ReplaySkier

FloatArray: TypeAlias = npt.NDArray[np.float64]

DRAWN_HEIGHT: Final = 1.76
"""Height (m) of the body whose parts have these widths."""
AROUND: Final = 12
"""Corners of a cross section."""
PLASTIC, TROUSERS, JACKET, GLOVE, HELMET, VISOR, METAL = (
    (38, 44, 52), (31, 58, 95), (200, 55, 45), (28, 30, 34), (240, 242, 244), (22, 26, 32), (120, 128, 136),
)  # fmt: skip
Ring: TypeAlias = tuple[float, float, float, float]
"""Along the axis, half as wide ahead and aside, and its middle ahead (m)."""


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """A part of the skier.

    Attributes
    ----------
    name
        Such as "left thigh".
    start, end
        The joints at its origin and in the direction of its z axis; its y axis is to the left. Of a boot: "left boot"
        or "right boot", and it stands in the boot's own axes.
    mesh
        In these axes (m), colours in linear light.
    """

    name: str
    start: str
    end: str
    mesh: Mesh


def skier_parts(height: float) -> list[Part]:
    """All parts of a skier so tall (m)."""
    return [*_trunk_and_head(height), *(part for side in ("left", "right") for part in _sided(side, height))]


def _trunk_and_head(height: float) -> list[Part]:
    h, trunk, head = height / DRAWN_HEIGHT, TRUNK.length * height, HEAD * height
    hips = [(-0.11 * h, 0.04, 0.07, 0.0), (-0.07 * h, 0.105, 0.15, -0.01), (0.03 * h, 0.115, 0.165, -0.01)]
    chest = [
        (0.02 * h, 0.118, 0.168, -0.01), (0.4 * trunk, 0.105, 0.15, 0.0), (0.75 * trunk, 0.125, 0.185, 0.0),
        (0.95 * trunk, 0.1, 0.19, 0.0), (1.04 * trunk, 0.075, 0.13, 0.0), (1.08 * trunk, 0.05, 0.06, 0.0),
    ]  # fmt: skip
    neck = _round([(-0.02, 0.055, 0.06, 0.0), (0.8 * head, 0.055, 0.06, 0.0)], JACKET)
    helmet = _ball((0.01, 0.0, 1.05 * head), (0.125 * h, 0.105 * h, 0.125 * h), HELMET)
    visor = _ball((0.085 * h, 0.0, head), (0.055 * h, 0.085 * h, 0.05 * h), VISOR)
    return [
        Part("trunk", "pelvis", "neck", _joined([_round(hips, TROUSERS), _round(chest, JACKET)])),
        Part("head", "neck", "head", _joined([neck, helmet, visor])),
    ]


def _sided(side: str, height: float) -> list[Part]:
    h = height / DRAWN_HEIGHT
    shank, thigh, arm, pole = (share * height for share in (SHANK.length, THIGH.length, UPPER_ARM.length, POLE))
    return [
        Part(f"{side} boot", f"{side} boot", f"{side} boot", _boot()),
        Part(f"{side} lower leg", f"{side} ankle", f"{side} knee", _joined([
            _round([(-0.06, 0.05, 0.05, 0.0), (0.0, 0.068, 0.058, 0.0), (0.42 * shank, 0.075, 0.062, 0.0),
                    (0.5 * shank, 0.08, 0.066, 0.0)], PLASTIC),
            _round([(0.48 * shank, 0.066, 0.06, 0.0), (0.75 * shank, 0.07, 0.064, -0.01),
                    (shank, 0.064, 0.062, 0.0), (1.1 * shank, 0.03, 0.03, 0.0)], TROUSERS)])),
        Part(f"{side} thigh", f"{side} knee", f"{side} hip", _round([
            (-0.05 * h, 0.035, 0.035, 0.0), (0.0, 0.066, 0.063, 0.0), (0.4 * thigh, 0.082, 0.078, 0.0),
            (0.9 * thigh, 0.098, 0.092, 0.0), (1.1 * thigh, 0.05, 0.05, 0.0)], TROUSERS)),
        Part(f"{side} upper arm", f"{side} shoulder", f"{side} elbow", _round([
            (-0.07 * h, 0.03, 0.03, 0.0), (-0.02 * h, 0.066, 0.064, 0.0), (0.5 * arm, 0.055, 0.052, 0.0),
            (arm, 0.045, 0.045, 0.0), (1.1 * arm, 0.025, 0.025, 0.0)], JACKET)),
        Part(f"{side} forearm", f"{side} elbow", f"{side} hand", _joined([_round([
            (-0.04 * h, 0.025, 0.025, 0.0), (0.0, 0.046, 0.046, 0.0), (0.135 * height, 0.038, 0.038, 0.0)], JACKET),
            _ball((0.0, 0.0, 0.15 * height), (0.055, 0.05, 0.065), GLOVE)])),
        Part(f"{side} pole", f"{side} hand", f"{side} pole tip", _joined([
            _round([(-0.09, 0.016, 0.016, 0.0), (0.06, 0.016, 0.016, 0.0)], PLASTIC),
            _round([(0.0, 0.0085, 0.0085, 0.0), (pole, 0.005, 0.005, 0.0)], METAL),
            _round([(0.93 * pole, 0.035, 0.035, 0.0), (0.94 * pole, 0.03, 0.03, 0.0)], PLASTIC)])),
    ]  # fmt: skip


def _boot() -> Mesh:
    """A plate, and the shell up to the ankle, in the boot's axes."""
    plate = _round([(0.012, 0.2, 0.031, 0.0), (0.045, 0.18, 0.031, 0.0)], METAL, square=4.0)
    shell = [(0.04, 0.155, 0.044, 0.0), (0.075, 0.16, 0.05, 0.0), (0.105, 0.15, 0.052, -0.005)]
    top = STAND_HEIGHT + 0.07
    return _joined(
        [plate, _round([*shell, (top, 0.09, 0.058, -0.05), (top + 0.03, 0.07, 0.058, -0.05)], PLASTIC, square=2.6)]
    )


def _round(rings: Sequence[Ring], colour: tuple[int, int, int], *, square: float = 2.0) -> Mesh:
    """A surface through rings, closed at both ends; `square` above 2 has corners (a superellipse)."""
    angle = 2.0 * np.pi * np.arange(AROUND) / AROUND
    cosine, sine = (np.sign(part) * np.abs(part) ** (2.0 / square) for part in (np.cos(angle), np.sin(angle)))
    ends = [(rings[0][0], 0.0, 0.0, rings[0][3]), *rings, (rings[-1][0], 0.0, 0.0, rings[-1][3])]
    vertices = np.concatenate(
        [
            np.column_stack([middle + ahead * cosine, aside * sine, np.full(AROUND, z)])
            for z, ahead, aside, middle in ends
        ]
    )
    corner, following = np.arange(AROUND), (np.arange(AROUND) + 1) % AROUND
    first = AROUND * np.arange(len(ends) - 1)[:, None]
    below, above = (
        np.stack(np.broadcast_arrays(first + corner, first + following, first + AROUND + corner), -1),
        np.stack(np.broadcast_arrays(first + following, first + AROUND + following, first + AROUND + corner), -1),
    )
    pieces = np.concatenate([below.reshape(-1, 3), above.reshape(-1, 3)])
    return Mesh(vertices, np.broadcast_to(linear(colour), vertices.shape), pieces)


def _ball(middle: tuple[float, float, float], half: tuple[float, float, float], colour: tuple[int, int, int]) -> Mesh:
    """An ellipsoid."""
    polar = np.linspace(0.0, np.pi, 8)[1:-1]
    rings = [(-half[2] * np.cos(at), half[0] * np.sin(at), half[1] * np.sin(at), 0.0) for at in polar.tolist()]
    found = _round(rings, colour)
    found.vertices[:AROUND, 2], found.vertices[-AROUND:, 2] = -half[2], half[2]
    return Mesh(found.vertices + np.array(middle), found.colours, found.pieces)


def _joined(meshes: Sequence[Mesh]) -> Mesh:
    first = np.cumsum([0, *(len(each.vertices) for each in meshes[:-1])])
    return Mesh(
        np.concatenate([each.vertices for each in meshes]),
        np.concatenate([each.colours for each in meshes]),
        np.concatenate([each.pieces + start for each, start in zip(meshes, first, strict=True)]),
    )


def part_poses(skier: ReplaySkier, part: Part) -> tuple[FloatArray, FloatArray]:
    """Origin (n, 3) and unit quaternion w, x, y, z (n, 4) of a part between joints, in the frame of the joints."""
    start, end = (skier.joints[:, JOINTS.index(joint)] for joint in (part.start, part.end))
    z = end - start
    z = z / np.linalg.norm(z, axis=1, keepdims=True)
    y = np.array([0.0, 1.0, 0.0]) - z[:, 1:2] * z
    y = y / np.maximum(np.linalg.norm(y, axis=1, keepdims=True), 1e-9)
    return start, quaternions(np.stack([np.cross(y, z), y, z], axis=2))


def skier_mesh(replay: Replay, frame: int) -> Mesh:
    """The skier of a replay at a moment, in its place."""
    skier, boots = replay.skier, replay.skis.boots
    assert skier is not None
    assert boots is not None
    body = _turn(replay.attitude[frame])
    placed = []
    for part in skier_parts(skier.height):
        if part.start in JOINTS:
            start, turn = (each[frame] for each in part_poses(skier, part))
            vertices = replay.place[frame] + body.apply(start + _turn(turn).apply(part.mesh.vertices))
        else:
            side = ("left boot", "right boot").index(part.start)
            vertices = boots.place[frame, side] + _turn(boots.attitude[frame, side]).apply(part.mesh.vertices)
        placed.append(Mesh(vertices, part.mesh.colours, part.mesh.pieces))
    return _joined(placed)


def _turn(quaternion: FloatArray) -> Rotation:
    return Rotation.from_quat(np.roll(quaternion, -1))
