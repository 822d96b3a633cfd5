"""Colours with a meaning and drawn thickness of a replay, the same in the browser and in an exported model."""

from __future__ import annotations

from typing import Any, Final, TypeAlias

import numpy as np
import numpy.typing as npt

FloatArray: TypeAlias = npt.NDArray[np.float64]

COLOURS: Final[dict[str, Any]] = {
    # yellow, orange, red, purple, near black: darker throughout, distinct without red or green as well
    "force": [[255, 233, 148], [253, 180, 83], [240, 105, 68], [190, 45, 92], [112, 20, 106], [45, 10, 70]],
    "depth": [[170, 196, 219], [95, 144, 190], [38, 92, 150], [12, 42, 92]],
    "unloaded": [214, 220, 226],
    "side": [58, 66, 76],
    "snow": [241, 245, 249],
    "least_share": 0.002,
}
"""In sRGB, 0 to 255, each scale from nothing to the most; up to ``least_share`` of the most a ski is unloaded."""

_LARGE: Final = 0.95
THICKEST, THINNEST = 0.018, 0.006
"""Thickness (m) of a ski under the boot and at its ends: drawn, not computed with (modelling assumption)."""


def drawn_thickness(station: FloatArray) -> FloatArray:
    """Thickness (m) at stations (m), tip to tail: a core that thins to both ends.

    >>> drawn_thickness(np.array([0.9, 0.0, -0.8])).round(4).tolist()
    [0.006, 0.018, 0.006]
    """
    reach = np.where(station >= 0.0, station[0], -station[-1])
    return np.asarray(THINNEST + (THICKEST - THINNEST) * (1.0 - np.minimum(1.0, np.abs(station) / reach) ** 1.5))


def linear_colours(kind: str, share: FloatArray) -> FloatArray:
    """Colours (…, 3) in linear light, 0 to 1, of shares (…) of a scale: "force" or "depth".

    >>> linear_colours("depth", np.array([0.0])).round(3).tolist()
    [[0.402, 0.552, 0.708]]
    """
    scale = np.asarray(COLOURS[kind], dtype=float)
    at = np.clip(share, 0.0, 1.0) * (len(scale) - 1)
    parts = [np.interp(at, np.arange(len(scale)), scale[:, i]) for i in range(3)]
    return linear(np.stack(parts, axis=-1))


def linear(colour: npt.ArrayLike) -> FloatArray:
    """Linear light, 0 to 1, of an sRGB colour, 0 to 255 (IEC 61966-2-1)."""
    part = np.asarray(colour, dtype=float) / 255.0
    return np.where(part <= 0.04045, part / 12.92, ((part + 0.055) / 1.055) ** 2.4)


def end_of_force_scale(force: FloatArray) -> float:
    """The end (N/m) of a scale of forces per length: a round number above what a twentieth of those that press exceed.

    The largest of a run may be a moment's, beside which most of a ski would be pale.

    >>> end_of_force_scale(np.array([*np.linspace(10.0, 2000.0, 200), 30_000.0])), end_of_force_scale(np.zeros(3))
    (2000.0, 1.0)
    """
    pressed = np.sort(force[force > 0.0], axis=None)
    return round_above(float(pressed[int(_LARGE * pressed.size)])) if pressed.size else 1.0


def round_above(value: float) -> float:
    """The next of 1, 1.5, 2, 3, 5, 10 times a power of ten that is not below a number; 1 for 0: the end of a scale.

    >>> round_above(1446.0), round_above(2.7e-3), round_above(0.0)
    (1500.0, 0.003, 1.0)
    """
    if not value > 0.0:
        return 1.0
    power = 10.0 ** np.floor(np.log10(value))
    digit = next(digit for digit in (1.0, 1.5, 2.0, 3.0, 5.0, 10.0) if digit * power >= value * 0.999999)
    return float(digit * power)
