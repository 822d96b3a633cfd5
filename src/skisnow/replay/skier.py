"""Drawn skier: joints from boots and body of the run, and the shapes of its parts.

The run gives the boots, the lean of the body and its centre of mass. The bend of the trunk, the places of the
hands and the lengths of the segments are assumptions; lower legs are in the planes of their boots if the knees allow
it. The hips are placed so that the centre of mass of all segments is that of the run.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation

from .._support.arrays import FloatArray, IntArray
from .._support.units import DEGREE
from ..skier.anthropometry import FOOT, FOREARM, HIP_WIDTH, SHANK, SHOULDER_WIDTH, THIGH, TRUNK, UPPER_ARM, Segment
from .replay import Replay, rotation_of

SIDED: Final = ("ankle", "knee", "hip", "shoulder", "elbow", "hand", "pole tip")
JOINTS: Final = ("pelvis", "neck", "head", *(f"{side} {name}" for side in ("left", "right") for name in SIDED))
"""Their order in `ReplaySkier.joints`."""

STAND_HEIGHT: Final = 0.07
"""Height of the boot's inner sole above the ski's base (m) (modelling assumption)."""
ANKLE_BEHIND: Final = 0.05
"""Distance of the ankle behind the boot's middle (m) (modelling assumption)."""
BENT: Final = 38.0 * DEGREE
"""Angle of the trunk to the body's own axis, forward (modelling assumption)."""
STRETCHED: Final = 0.995
"""Greatest length of a leg over that of its segments: a knee that is never quite straight (modelling assumption)."""
KNEE_ASIDE: Final = math.sin(50.0 * DEGREE)
"""Sine of the greatest angle by which a knee leaves the plane of hip, ankle and ahead (modelling assumption)."""
HANDS: Final = np.array([0.21, 0.07, -0.12])
"""From the shoulder ahead, outward and up, over the height (modelling assumption)."""
POLE: Final = 0.66
POLE_WAY: Final = np.array([-0.95, 0.2, -0.24])
"""Length of a pole over the height, and its way from the hand ahead, outward and up (modelling assumption)."""
HEAD: Final = 0.1
"""From the middle between the shoulders to that of the head, over the height (modelling assumption)."""
_ROUNDS: Final = 12
"""Iterations; each one reduces the error of the centre of mass about five times."""


def drawn_joints(
    height: float, place: FloatArray, attitude: FloatArray, boots: tuple[FloatArray, FloatArray], centre: FloatArray
) -> FloatArray:
    """Drawn joints (n, 17, 3) of a skier, as in `ReplaySkier`.

    place, attitude: origin (n, 3) (m) and axes as columns (n, 3, 3) of the frame of the joints.
    boots: places (n, 2, 3) (m) and axes as rows (n, 2, 3, 3) of the boots: ahead, left across the base, off it.
    centre: centre of mass (n, 3) (m).
    """
    body = np.moveaxis(attitude, -1, 0)
    ankle = boots[0] + (STAND_HEIGHT + FOOT.length * height) * boots[1][:, :, 2] - ANKLE_BEHIND * boots[1][:, :, 0]
    pelvis = centre - 0.08 * height * body[2]
    for _ in range(_ROUNDS):
        pelvis = _within_reach(pelvis, ankle, body[1], height)
        joints = _joints(height, body, pelvis, ankle, boots[1])
        pelvis = pelvis + centre - centre_of_mass(joints)
    joints = _joints(height, body, _within_reach(pelvis, ankle, body[1], height), ankle, boots[1])
    relative = np.stack([joints[name] for name in JOINTS], axis=1) - place[:, None]
    return np.einsum("nka,nab->nkb", relative, attitude)


def _hip_position(pelvis: FloatArray, left: FloatArray, side: int, height: float) -> FloatArray:
    """Positions of a hip (m), left of the pelvis for side 0 and right of it for side 1."""
    return pelvis + (0.25, -0.25)[side] * HIP_WIDTH * height * left


def _within_reach(pelvis: FloatArray, ankle: FloatArray, left: FloatArray, height: float) -> FloatArray:
    """Pelvis (n, 3) moved towards each ankle that is farther from its hip than a leg; `height`: of the body (m)."""
    longest = STRETCHED * (SHANK.length + THIGH.length) * height
    for side in (0, 1, 0, 1):
        way = ankle[:, side] - _hip_position(pelvis, left, side, height)
        length = np.linalg.norm(way, axis=1, keepdims=True)
        pelvis = pelvis + np.maximum(length - longest, 0.0) / length * way
    return pelvis


def _joints(
    height: float, body: FloatArray, pelvis: FloatArray, ankle: FloatArray, boot_axes: FloatArray
) -> dict[str, FloatArray]:
    """Places (n, 3) of all joints in space by name; `body`: axes of the body ahead, left and up, each (n, 3)."""
    ahead, left, up = body
    trunk = math.cos(BENT) * up + math.sin(BENT) * ahead
    neck = pelvis + TRUNK.length * height * trunk
    upright = _unit_vectors(trunk + np.array([0.0, 0.0, 1.0]))
    places = {"pelvis": pelvis, "neck": neck, "head": neck + HEAD * height * upright}
    for side, name in enumerate(("left", "right")):
        outward = (1.0, -1.0)[side] * left
        hip, shoulder = _hip_position(pelvis, left, side, height), neck + 0.5 * SHOULDER_WIDTH * height * outward
        own = np.stack([ahead, outward, up])
        hand = shoulder + height * np.einsum("a,anb->nb", HANDS, own)
        elbow = two_bones(shoulder, hand, UPPER_ARM.length * height, FOREARM.length * height, outward - up - ahead)
        tip = hand + POLE * height * np.einsum("a,anb->nb", POLE_WAY / np.linalg.norm(POLE_WAY), own)
        knee = _knee(hip, ankle[:, side], boot_axes[:, side], height)
        sided = (ankle[:, side], knee, hip, shoulder, elbow, hand, tip)
        places |= {f"{name} {joint}": place for joint, place in zip(SIDED, sided, strict=True)}
    return places


def _knee(hip: FloatArray, ankle: FloatArray, axes: FloatArray, height: float) -> FloatArray:
    """Place (n, 3) of a knee: ahead of hip and ankle, with the lower leg in the plane of its boot if possible."""
    lengths = THIGH.length * height, SHANK.length * height
    straight = two_bones(hip, ankle, *lengths, axes[:, 0])
    way = _unit_vectors(ankle - hip)
    foot = hip + _row_products(straight - hip, way) * way
    bend = straight - foot
    across = np.cross(way, bend)
    towards, beside = _row_products(across, axes[:, 1]), _row_products(straight - ankle, axes[:, 1])
    far = np.abs(towards) > 0.2 * np.linalg.norm(bend, axis=1, keepdims=True)
    aside = np.clip(np.where(far, -beside / np.where(far, towards, 1.0), 0.0), -KNEE_ASIDE, KNEE_ASIDE)
    return foot + np.sqrt(1.0 - aside**2) * bend + aside * across


def two_bones(start: FloatArray, end: FloatArray, first: float, second: float, bent_to: FloatArray) -> FloatArray:
    """Joint (n, 3) between two bones of given lengths (m) from start to end (n, 3), bent in a direction (n, 3).

    The distance of the ends is limited to that of the bones.
    """
    way = end - start
    length = np.linalg.norm(way, axis=1, keepdims=True)
    way = way / np.maximum(length, 1e-9)
    length = np.clip(length, abs(first - second) + 1e-6, first + second)
    along = (first**2 - second**2 + length**2) / (2.0 * length)
    out = np.sqrt(np.maximum(first**2 - along**2, 0.0))
    return np.asarray(start + along * way + out * _unit_vectors(bent_to - _row_products(bent_to, way) * way))


def _unit_vectors(vectors: FloatArray) -> FloatArray:
    """Vectors of length 1 in the same directions; zero vectors stay 0."""
    return np.asarray(vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-9))


def _row_products(one: FloatArray, other: FloatArray) -> FloatArray:
    """Scalar product of each pair of rows, shape (n, 1)."""
    return np.einsum("na,na->n", one, other)[:, None]


def centre_of_mass(joints: dict[str, FloatArray]) -> FloatArray:
    """Centre of mass (n, 3) of a body with joints (n, 3) by name; the feet are at the ankles."""

    def of(segment: Segment, upper: str, lower: str) -> FloatArray:
        return segment.mass * ((1.0 - segment.centre) * joints[upper] + segment.centre * joints[lower])

    total = of(TRUNK, "pelvis", "neck")
    for side in ("left", "right"):
        total = total + FOOT.mass * joints[f"{side} ankle"]
        total = total + of(SHANK, f"{side} knee", f"{side} ankle") + of(THIGH, f"{side} hip", f"{side} knee")
        total = (
            total + of(UPPER_ARM, f"{side} shoulder", f"{side} elbow") + of(FOREARM, f"{side} elbow", f"{side} hand")
        )
    return total


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
class Mesh:
    """Vertices (v, 3) in m, their colours (v, 3) in linear light, triangles (t, 3) of their numbers."""

    vertices: FloatArray
    colours: FloatArray
    pieces: IntArray


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """A drawn part of the skier's body.

    start, end: names of the joints at its origin and in the direction of its z axis; its y axis is to the left. A boot
        has "left boot" or "right boot" for both, and the axes of the boot.
    mesh: mesh in these axes (m), with colours in linear light.
    """

    name: str
    start: str
    end: str
    mesh: Mesh


def skier_parts(height: float) -> list[Part]:
    """All drawn parts of a skier of this height (m): trunk, head, limbs, boots and poles."""
    return [*_trunk_and_head(height), *(part for side in ("left", "right") for part in _limb_parts(side, height))]


def _trunk_and_head(height: float) -> list[Part]:
    """Parts of trunk and head for a body height (m)."""
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
        Part("trunk", "pelvis", "neck", _join_meshes([_round(hips, TROUSERS), _round(chest, JACKET)])),
        Part("head", "neck", "head", _join_meshes([neck, helmet, visor])),
    ]


def _limb_parts(side: str, height: float) -> list[Part]:
    """Parts of one side, "left" or "right", for a body height (m): boot, leg, arm and pole."""
    h = height / DRAWN_HEIGHT
    shank, thigh, arm, pole = (share * height for share in (SHANK.length, THIGH.length, UPPER_ARM.length, POLE))
    return [
        Part(f"{side} boot", f"{side} boot", f"{side} boot", _boot()),
        Part(f"{side} lower leg", f"{side} ankle", f"{side} knee", _join_meshes([
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
        Part(f"{side} forearm", f"{side} elbow", f"{side} hand", _join_meshes([_round([
            (-0.04 * h, 0.025, 0.025, 0.0), (0.0, 0.046, 0.046, 0.0), (0.135 * height, 0.038, 0.038, 0.0)], JACKET),
            _ball((0.0, 0.0, 0.15 * height), (0.055, 0.05, 0.065), GLOVE)])),
        Part(f"{side} pole", f"{side} hand", f"{side} pole tip", _join_meshes([
            _round([(-0.09, 0.016, 0.016, 0.0), (0.06, 0.016, 0.016, 0.0)], PLASTIC),
            _round([(0.0, 0.0085, 0.0085, 0.0), (pole, 0.005, 0.005, 0.0)], METAL),
            _round([(0.93 * pole, 0.035, 0.035, 0.0), (0.94 * pole, 0.03, 0.03, 0.0)], PLASTIC)])),
    ]  # fmt: skip


def _boot() -> Mesh:
    """Mesh of a ski boot with its plate, in the axes of the boot."""
    plate = _round([(0.012, 0.2, 0.031, 0.0), (0.045, 0.18, 0.031, 0.0)], METAL, square=4.0)
    shell = [(0.04, 0.155, 0.044, 0.0), (0.075, 0.16, 0.05, 0.0), (0.105, 0.15, 0.052, -0.005)]
    top = STAND_HEIGHT + 0.07
    return _join_meshes(
        [plate, _round([*shell, (top, 0.09, 0.058, -0.05), (top + 0.03, 0.07, 0.058, -0.05)], PLASTIC, square=2.6)]
    )


def _round(rings: Sequence[Ring], colour: tuple[int, int, int], *, square: float = 2.0) -> Mesh:
    """Mesh of a closed surface through cross sections: ellipses, or angular superellipses with `square` above 2."""
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
    return Mesh(vertices, np.broadcast_to(linear_light(colour), vertices.shape), pieces)


def _ball(middle: tuple[float, float, float], half: tuple[float, float, float], colour: tuple[int, int, int]) -> Mesh:
    """Mesh of an ellipsoid about a middle, with half axes `half` (m)."""
    polar = np.linspace(0.0, np.pi, 8)[1:-1]
    rings = [(-half[2] * np.cos(at), half[0] * np.sin(at), half[1] * np.sin(at), 0.0) for at in polar.tolist()]
    mesh = _round(rings, colour)
    mesh.vertices[:AROUND, 2], mesh.vertices[-AROUND:, 2] = -half[2], half[2]
    return Mesh(mesh.vertices + np.array(middle), mesh.colours, mesh.pieces)


def linear_light(colour: npt.ArrayLike) -> FloatArray:
    """Linear light, 0 to 1, of an sRGB colour, 0 to 255 (IEC 61966-2-1)."""
    part = np.asarray(colour, dtype=float) / 255.0
    return np.where(part <= 0.04045, part / 12.92, ((part + 0.055) / 1.055) ** 2.4)


def _join_meshes(meshes: Sequence[Mesh]) -> Mesh:
    """One mesh of several, with the vertex numbers of the triangles moved on."""
    first = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes[:-1])])
    return Mesh(
        np.concatenate([mesh.vertices for mesh in meshes]),
        np.concatenate([mesh.colours for mesh in meshes]),
        np.concatenate([mesh.pieces + start for mesh, start in zip(meshes, first, strict=True)]),
    )


_TO_OPENSIM: Final = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
"""From axes ahead, left and up to those of OpenSim: ahead, up and to the right."""


def joint_columns(replay: Replay) -> dict[str, FloatArray]:
    """Motion of a replay's skier as coordinates of OpenSim's model of Rajagopal and others (2016) by name, (n,) each.

    Places of the pelvis are in m, angles in degrees.

    The pelvis has the axes of the body and is the middle of the hips. Knees flex to positive angles. The rotation of a
    foot about its shank, which the model's joints do not have, is left out.
    """
    skier, boots = replay.skier, replay.skis.boots
    assert skier is not None
    assert boots is not None
    body = rotation_of(replay.attitude).as_matrix()
    joints = dict(zip(JOINTS, np.moveaxis(skier.joints @ _TO_OPENSIM.T, 1, 0), strict=True))
    place = (replay.place + np.einsum("nab,nb->na", body, skier.joints[:, JOINTS.index("pelvis")])) @ _TO_OPENSIM.T
    turns = _TO_OPENSIM @ body @ _TO_OPENSIM.T
    columns = dict(zip(("pelvis_tilt", "pelvis_list", "pelvis_rotation"), _cardan_angles(turns), strict=True))
    columns |= {f"pelvis_t{axis}": place[:, i] for i, axis in enumerate("xyz")}
    columns["lumbar_extension"] = np.full(len(place), -BENT / DEGREE)
    for k, (side, letter, sense) in enumerate((("left", "l", -1.0), ("right", "r", 1.0))):
        hip, knee, ankle = (joints[f"{side} {name}"] for name in ("hip", "knee", "ankle"))
        thigh, shank = _unit_vectors(hip - knee), _unit_vectors(knee - ankle)
        axis = _unit_vectors(np.cross(shank, thigh))
        upper, lower = (np.stack([np.cross(up, axis), up, axis], axis=-1) for up in (thigh, shank))
        foot = _TO_OPENSIM @ rotation_of(boots.attitude[:, k]).as_matrix() @ _TO_OPENSIM.T
        flexion, adduction, rotation = _cardan_angles(upper)
        dorsal, inversion, _ = _cardan_angles(np.swapaxes(turns @ lower, 1, 2) @ foot)
        bend = np.arctan2(np.linalg.norm(np.cross(shank, thigh), axis=1), _row_products(shank, thigh)[:, 0]) / DEGREE
        columns |= {
            f"hip_flexion_{letter}": flexion, f"hip_adduction_{letter}": sense * adduction,
            f"hip_rotation_{letter}": sense * rotation, f"knee_angle_{letter}": bend,
            f"ankle_angle_{letter}": dorsal, f"subtalar_angle_{letter}": sense * inversion,
        }  # fmt: skip
    return columns


def _cardan_angles(matrices: FloatArray) -> FloatArray:
    """Angles (3, n) (degrees) of rotation matrices (n, 3, 3) about z, the rotated x and the rotated y."""
    return np.asarray(Rotation.from_matrix(matrices).as_euler("ZXY", degrees=True).T)
