"""A skier as it is drawn: joints from what the run knows of boots and body, the rest by assumption.

Computed are the boots, the body's lean and its centre of mass. Assumed is how far the trunk is bent forward, where
the hands are, that the lower legs stand in the planes of their boots as far as knees can, and the segments' lengths.
The hips are where the masses of all segments have their centre in the run's centre of mass.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, TypeAlias

import numpy as np
import numpy.typing as npt

from .._support.units import DEGREE
from ..skier.segments import FOOT, FOREARM, HIP_WIDTH, SHANK, SHOULDER_WIDTH, THIGH, TRUNK, UPPER_ARM
from .replay import ReplaySkier

if TYPE_CHECKING:
    from ..skier.segments import Segment

FloatArray: TypeAlias = npt.NDArray[np.float64]

SIDED: Final = ("ankle", "knee", "hip", "shoulder", "elbow", "hand", "pole tip")
JOINTS: Final = ("pelvis", "neck", "head", *(f"{side} {name}" for side in ("left", "right") for name in SIDED))
"""Their order in `ReplaySkier.joints`."""

STAND_HEIGHT: Final = 0.07
"""Of the boot's inner sole above the ski's base (m) (modelling assumption)."""
ANKLE_BEHIND: Final = 0.05
"""Of the boot's middle (m) (modelling assumption)."""
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
"""Each brings the centre of mass about five times nearer."""


def replay_skier(
    height: float, place: FloatArray, attitude: FloatArray, boots: tuple[FloatArray, FloatArray], centre: FloatArray
) -> ReplaySkier:
    """Joints of a skier.

    Parameters
    ----------
    height
        Of the body (m).
    place, attitude
        (n, 3) origin (m) and (n, 3, 3) axes as columns of the frame in which the joints are told.
    boots
        Their places (n, 2, 3) in m and axes (n, 2, 3, 3) as rows: ahead, left across the base, off it.
    centre
        (n, 3) centre of mass (m).
    """
    body = np.moveaxis(attitude, -1, 0)
    ankle = boots[0] + (STAND_HEIGHT + FOOT.length * height) * boots[1][:, :, 2] - ANKLE_BEHIND * boots[1][:, :, 0]
    pelvis = centre - 0.08 * height * body[2]
    for _ in range(_ROUNDS):
        pelvis = _within_reach(pelvis, ankle, body[1], height)
        joints = _joints(height, body, pelvis, ankle, boots[1])
        pelvis = pelvis + centre - centre_of_mass(joints)
    joints = _joints(height, body, _within_reach(pelvis, ankle, body[1], height), ankle, boots[1])
    found = np.stack([joints[name] for name in JOINTS], axis=1) - place[:, None]
    return ReplaySkier(height=height, joints=np.einsum("nka,nab->nkb", found, attitude))


def _hip(pelvis: FloatArray, left: FloatArray, side: int, height: float) -> FloatArray:
    return pelvis + (0.25, -0.25)[side] * HIP_WIDTH * height * left


def _within_reach(pelvis: FloatArray, ankle: FloatArray, left: FloatArray, height: float) -> FloatArray:
    """Drawn towards an ankle that is farther from its hip than a leg is long."""
    longest = STRETCHED * (SHANK.length + THIGH.length) * height
    for side in (0, 1, 0, 1):
        way = ankle[:, side] - _hip(pelvis, left, side, height)
        length = np.linalg.norm(way, axis=1, keepdims=True)
        pelvis = pelvis + np.maximum(length - longest, 0.0) / length * way
    return pelvis


def _joints(
    height: float, body: FloatArray, pelvis: FloatArray, ankle: FloatArray, boot_axes: FloatArray
) -> dict[str, FloatArray]:
    """All joints in space by name; `body` are its axes ahead, left and up, (n, 3) each."""
    ahead, left, up = body
    trunk = math.cos(BENT) * up + math.sin(BENT) * ahead
    neck = pelvis + TRUNK.length * height * trunk
    upright = _unit(trunk + np.array([0.0, 0.0, 1.0]))
    found = {"pelvis": pelvis, "neck": neck, "head": neck + HEAD * height * upright}
    for side, name in enumerate(("left", "right")):
        outward = (1.0, -1.0)[side] * left
        hip, shoulder = _hip(pelvis, left, side, height), neck + 0.5 * SHOULDER_WIDTH * height * outward
        own = np.stack([ahead, outward, up])
        hand = shoulder + height * np.einsum("a,anb->nb", HANDS, own)
        elbow = two_bones(shoulder, hand, UPPER_ARM.length * height, FOREARM.length * height, outward - up - ahead)
        tip = hand + POLE * height * np.einsum("a,anb->nb", POLE_WAY / np.linalg.norm(POLE_WAY), own)
        knee = _knee(hip, ankle[:, side], boot_axes[:, side], height)
        sided = (ankle[:, side], knee, hip, shoulder, elbow, hand, tip)
        found |= {f"{name} {joint}": place for joint, place in zip(SIDED, sided, strict=True)}
    return found


def _knee(hip: FloatArray, ankle: FloatArray, axes: FloatArray, height: float) -> FloatArray:
    """Ahead of hip and ankle, and as far aside that the lower leg stands in the plane of its boot, where it can."""
    lengths = THIGH.length * height, SHANK.length * height
    straight = two_bones(hip, ankle, *lengths, axes[:, 0])
    way = _unit(ankle - hip)
    foot = hip + _dot(straight - hip, way) * way
    bend = straight - foot
    across = np.cross(way, bend)
    towards, beside = _dot(across, axes[:, 1]), _dot(straight - ankle, axes[:, 1])
    far = np.abs(towards) > 0.2 * np.linalg.norm(bend, axis=1, keepdims=True)
    aside = np.clip(np.where(far, -beside / np.where(far, towards, 1.0), 0.0), -KNEE_ASIDE, KNEE_ASIDE)
    return foot + np.sqrt(1.0 - aside**2) * bend + aside * across


def two_bones(start: FloatArray, end: FloatArray, first: float, second: float, bent_to: FloatArray) -> FloatArray:
    """The joint (n, 3) between two bones of given lengths (m) from start to end (n, 3), bent towards (n, 3).

    Ends that are too near or too far for the bones are taken at the nearest distance that is not.
    """
    way = end - start
    length = np.linalg.norm(way, axis=1, keepdims=True)
    way = way / np.maximum(length, 1e-9)
    length = np.clip(length, abs(first - second) + 1e-6, first + second)
    along = (first**2 - second**2 + length**2) / (2.0 * length)
    out = np.sqrt(np.maximum(first**2 - along**2, 0.0))
    return np.asarray(start + along * way + out * _unit(bent_to - _dot(bent_to, way) * way))


def _unit(vectors: FloatArray) -> FloatArray:
    return np.asarray(vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-9))


def _dot(one: FloatArray, other: FloatArray) -> FloatArray:
    return np.einsum("na,na->n", one, other)[:, None]


def centre_of_mass(joints: dict[str, FloatArray]) -> FloatArray:
    """Centre of mass (n, 3) of a body with joints (n, 3) by name; the feet's are at the ankles."""

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
