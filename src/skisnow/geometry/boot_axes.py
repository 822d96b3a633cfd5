"""Axes of a ski at its boot, and the angles that give them: heading, then pitch, then edge angle."""

from __future__ import annotations

import math

import numpy as np

from .._support.arrays import FloatArray


def axes_of(edge_angle: float, pitch: float, heading: float) -> FloatArray:
    """Axes of a boot, ahead, left and off the base as rows, (3, 3).

    edge_angle: about the ski, the left edge down for positive ones (rad): the last rotation.
    pitch: the tip up for positive ones (rad).
    heading: to the left for positive ones (rad): the first rotation.
    """
    (sh, ch), (sp, cp), (se, ce) = ((math.sin(a), math.cos(a)) for a in (heading, pitch, edge_angle))
    ahead = np.array([ch * cp, sh * cp, sp])
    level = np.array([-sh, ch, 0.0])
    above = np.array([-ch * sp, -sh * sp, cp])
    return np.array([ahead, ce * level - se * above, se * level + ce * above])


def angles_of(axes: FloatArray) -> FloatArray:
    """Edge angle, pitch and heading (rad) of axes, (…, 3, 3) to (…, 3): the inverse of `axes_of`.

    >>> [round(float(angle), 12) for angle in angles_of(axes_of(0.7, 0.1, -0.3))]
    [0.7, 0.1, -0.3]
    """
    ahead, left, off = (axes[..., i, :] for i in range(3))
    heading = np.arctan2(ahead[..., 1], ahead[..., 0])
    pitch = np.arctan2(ahead[..., 2], np.hypot(ahead[..., 0], ahead[..., 1]))
    return np.stack([np.arctan2(-left[..., 2], off[..., 2]), pitch, heading], axis=-1)
