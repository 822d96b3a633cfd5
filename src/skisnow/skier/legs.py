"""Legs: where the boots are against a body that leans, so that its centre of mass stays level over the snow."""

from __future__ import annotations

import math

import numpy as np

from ..dynamics import BootPose
from ..geometry.boot_axes import axes_of


def leg_poses(
    aside: tuple[float, float],
    edge: tuple[float, float],
    height: float,
    stance: float,
    half_width: float,
    blunt: float,
) -> list[BootPose]:
    """Poses of the left and the right boot against the body.

    Parameters
    ----------
    aside
        Offset of the centre of mass from the middle of the feet, to the left (m), and its rate (m/s).
    edge
        Angle against the snow (rad), and its rate (rad/s).
    height
        Height of the centre of mass above the snow (m), constant, and in the body above its boots at the start.
    stance, half_width
        Between the skis, and of a ski (m).
    blunt
        Edge angle (rad) below which a ski counts as flat: what it lifts its boot by is rounded.
    """
    (y, rate), (angle, turning) = aside, edge
    lean, swing = math.atan2(y, height), rate * height / (y * y + height * height)
    cos, sin = math.cos(lean), math.sin(lean)
    least = math.sin(blunt)
    root = math.hypot(math.sin(angle), least)
    up, rises = half_width * (root - least), half_width * math.sin(angle) * math.cos(angle) * turning / root
    axes = axes_of(angle - lean, 0.0, 0.0)
    poses = []
    for side in (0.5, -0.5):
        over, above = side * stance - y, up - height
        left, off = over * cos - above * sin, over * sin + above * cos
        velocity = [0.0, -rate * cos - rises * sin - swing * off, -rate * sin + rises * cos + swing * left]
        place = np.array([0.0, left, height + off])
        poses.append(BootPose(place, axes, np.array(velocity), np.array([swing - turning, 0.0, 0.0])))
    return poses
