"""Where the skis' edges are in space: the sledge's pose, the base's shape, bending and twist."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import numpy.typing as npt

from ..simulation.sledge.frames import base_lateral, base_normal, rotation

if TYPE_CHECKING:
    from .replay import Replay

FloatArray: TypeAlias = npt.NDArray[np.float64]


def ski_edges(replay: Replay, frame: int, *, exaggeration: float = 1.0) -> FloatArray:
    """Both edges of both skis' bases in space (m): (ski, station, edge (0 left, 1 right), 3).

    Parameters
    ----------
    replay
        What is shown.
    frame
        Number of the moment, 0 to n - 1.
    exaggeration
        Factor on bending and twist, the shape of the unloaded base kept; 1: as it is.

    Notes
    -----
    With x ahead, l across the base to the left and n away from the snow, a ski's base at station s has its middle at
    s x + (h + w) n from the boot and its edges at ± b/2 (cos φ l - sin φ n) beside: h the unloaded base, w the bending,
    b the width, φ the twist. The stations do not come nearer as a ski bends.
    """
    skis = replay.skis
    place, across, away, ahead = _boots(replay, frame)
    twist = exaggeration * skis.twist[frame][..., None]
    height = skis.base_height + exaggeration * skis.bending[frame]
    middle = place[:, None, :] + skis.station[:, None] * ahead[:, None] + height[..., None] * away[:, None]
    half = skis.half_width[:, None] * (np.cos(twist) * across[:, None] - np.sin(twist) * away[:, None])
    return np.stack([middle + half, middle - half], axis=2)


def _boots(replay: Replay, frame: int) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Place of each boot (2, 3) in space (m), and its axes across the base to the left, off it, and ahead."""
    skis = replay.skis
    if skis.boots is not None:
        axes = np.stack([rotation(each).T for each in skis.boots.attitude[frame]])
        return skis.boots.place[frame], axes[:, 1], axes[:, 2], axes[:, 0]
    turn = rotation(replay.attitude[frame])
    own = (base_lateral(skis.edge_angle), base_normal(skis.edge_angle), np.array([1.0, 0.0, 0.0]))
    across, away, ahead = (np.broadcast_to(turn @ axis, (len(skis.middle), 3)) for axis in own)
    return replay.place[frame] + skis.middle @ turn.T, across, away, ahead


def nearest_frame(replay: Replay, time: float) -> int:
    """Number of the moment nearest to a time (s)."""
    return int(np.argmin(np.abs(replay.time - time)))
