"""Minus the tangent of the snow's forces: how they answer to depth, roll and place across of the skis' sections."""

from __future__ import annotations

from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt

from ...machine_code import compiled
from .compiled import PLAIN

FloatArray: TypeAlias = npt.NDArray[np.float64]

CHANNELS: Final = 6
"""Columns between beam and rigid body: depth, depth × s, roll, across, across × s, forwards."""


@compiled(**PLAIN, fastmath={"contract"}, inline="always")
def add_tangent(  # noqa: PLR0915 - entries written out: loops over so few cost more than they
    band: FloatArray, channels: FloatArray, corner: FloatArray, k: int, A: int, B: int, s: float, w0: float,
    w1: float, w2: float, w3: float, z: float,
    cn: float, cu: float, k0: float, k1: float, k2: float, reach: float, secant: float, ky: float, rise: float,
    aside: float,
) -> None:  # fmt: skip
    """Add minus the tangent of one section: depth and roll (k0, k1, k2, about the edge), and across (ky).

    A line feels the ski move along its base and along its edge: forwards, the depth grows by `rise`, and the edge
    comes to lie `aside` of the ski's axis. Without it a steadily carving ski would seem to be pushed across where it
    only follows its edge.
    """
    k2 = (k2 + 2.0 * reach * k1 + reach * reach * k0) * secant * secant
    k1 = (k1 + reach * k0) * secant
    ks, ys = k0 * s, ky * s
    corner[k, 0, 0] += k0
    corner[k, 0, 1] += ks
    corner[k, 1, 1] += ks * s
    corner[k, 0, 2] += k1
    corner[k, 1, 2] += k1 * s
    corner[k, 2, 2] += k2
    corner[k, 3, 3] += ky
    corner[k, 3, 4] += ys
    corner[k, 4, 4] += ys * s
    corner[k, 0, 5] -= k0 * rise
    corner[k, 1, 5] -= ks * rise
    corner[k, 2, 5] -= k1 * rise
    corner[k, 3, 5] -= ky * aside
    corner[k, 4, 5] -= ys * aside
    corner[k, 5, 5] += k0 * rise * rise + ky * aside * aside
    # of the deflection: depth falls by cn, place across grows by cu
    y = 1.0 - z
    ww, wp = k0 * cn * cn + ky * cu * cu, -k1 * cn
    c0, c2, cy = -cn * k0, -cn * k1, cu * ky
    c5, t5 = -c0 * rise - cy * aside, -k1 * rise
    if A >= 0:
        v0, v1 = w0 * ww, w1 * ww
        band[k, A, 0] += v0 * w0
        band[k, A + 1, 1] += v0 * w1
        band[k, A + 1, 0] += v1 * w1
        band[k, A + 2, 2] += y * w0 * wp
        band[k, A + 2, 1] += y * w1 * wp
        band[k, A + 2, 0] += y * y * k2
        _add_channels(channels, k, A, w0, w1, y, s, c0, c2, cy, c5, k1, k2, t5)
        if B >= 0:
            band[k, B, 3] += v0 * w2
            band[k, B, 2] += v1 * w2
            band[k, B, 1] += y * w2 * wp
            band[k, B + 1, 4] += v0 * w3
            band[k, B + 1, 3] += v1 * w3
            band[k, B + 1, 2] += y * w3 * wp
            band[k, B + 2, 5] += z * w0 * wp
            band[k, B + 2, 4] += z * w1 * wp
            band[k, B + 2, 3] += y * z * k2
    if B >= 0:
        v2, v3 = w2 * ww, w3 * ww
        band[k, B, 0] += v2 * w2
        band[k, B + 1, 1] += v2 * w3
        band[k, B + 1, 0] += v3 * w3
        band[k, B + 2, 2] += z * w2 * wp
        band[k, B + 2, 1] += z * w3 * wp
        band[k, B + 2, 0] += z * z * k2
        _add_channels(channels, k, B, w2, w3, z, s, c0, c2, cy, c5, k1, k2, t5)


@compiled(**PLAIN, fastmath={"contract"}, inline="always")
def _add_channels(
    channels: FloatArray, k: int, A: int, w0: float, w1: float, y: float, s: float, c0: float, c2: float, cy: float,
    c5: float, k1: float, k2: float, t5: float,
) -> None:  # fmt: skip
    """Add the columns of one node: deflection, slope, twist."""
    channels[k, A, 0] += w0 * c0
    channels[k, A, 1] += w0 * c0 * s
    channels[k, A, 2] += w0 * c2
    channels[k, A, 3] += w0 * cy
    channels[k, A, 4] += w0 * cy * s
    channels[k, A, 5] += w0 * c5
    channels[k, A + 1, 0] += w1 * c0
    channels[k, A + 1, 1] += w1 * c0 * s
    channels[k, A + 1, 2] += w1 * c2
    channels[k, A + 1, 3] += w1 * cy
    channels[k, A + 1, 4] += w1 * cy * s
    channels[k, A + 1, 5] += w1 * c5
    channels[k, A + 2, 0] += y * k1
    channels[k, A + 2, 1] += y * k1 * s
    channels[k, A + 2, 2] += y * k2
    channels[k, A + 2, 5] += y * t5
