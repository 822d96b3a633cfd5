"""Contents of a replay's page, and where its skis and snow are, by hand."""

import base64
import json
import math
import re
import struct
from pathlib import Path
from typing import Any

import numpy as np
from scipy.interpolate import RegularGridInterpolator

from skisnow.replay import Replay
from skisnow.replay.replay import ReplayTerrain
from skisnow.simulation.sledge_body import base_lateral, base_normal, rotation


def held_replay(page: Path, name: str) -> bytes:
    """The bytes of ``run`` or ``ghost``."""
    text = page.read_text(encoding="utf-8")
    (found,) = re.findall(rf'<script type="application/octet-stream" id="{name}">([^<]+)</script>', text)
    return base64.b64decode(found)


def unpacked(content: bytes) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """Header and arrays of a replay, read as the text of the format says."""
    (length,) = struct.unpack("<I", content[4:8])
    header: dict[str, Any] = json.loads(content[8 : 8 + length])
    arrays = {}
    for name, of in header["arrays"].items():
        kind = {"float32": "<f4", "uint16": "<u2"}[of["type"]]
        numbers = np.frombuffer(content, kind, math.prod(of["shape"]), 8 + length + of["start"]).astype(float)
        arrays[name] = (of.get("lowest", 0.0) + of.get("step", 1.0) * numbers).reshape(of["shape"])
    return header, arrays


def ski_edges(replay: Replay, frame: int, *, exaggeration: float = 1.0) -> np.ndarray:
    """Both edges of both skis' bases in space (m): (ski, station, edge (0 left, 1 right), 3).

    frame: index of the moment, 0 to n - 1.
    exaggeration: factor of bending and twist.

    With x ahead, l across the base to the left and n away from the snow, a ski's base at station s has its middle at
    s x + (h + w) n from the boot and its edges at ± b/2 (cos φ l - sin φ n): h the unloaded base, w the bending, b the
    width, φ the twist. Bending does not shorten the distances of stations.
    """
    skis = replay.skis
    place, across, away, ahead = _boots(replay, frame)
    twist = exaggeration * skis.twist[frame][..., None]
    height = skis.base_height + exaggeration * skis.bending[frame]
    middle = place[:, None, :] + skis.station[:, None] * ahead[:, None] + height[..., None] * away[:, None]
    half = skis.half_width[:, None] * (np.cos(twist) * across[:, None] - np.sin(twist) * away[:, None])
    return np.stack([middle + half, middle - half], axis=2)


def _boots(replay: Replay, frame: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Place of each boot (2, 3) in space (m), and its axes across the base to the left, off it, and ahead."""
    skis = replay.skis
    if skis.boots is not None:
        axes = np.stack([rotation(quaternion).T for quaternion in skis.boots.attitude[frame]])
        return skis.boots.place[frame], axes[:, 1], axes[:, 2], axes[:, 0]
    turn = rotation(replay.attitude[frame])
    own = (base_lateral(skis.edge_angle), base_normal(skis.edge_angle), np.array([1.0, 0.0, 0.0]))
    across, away, ahead = (np.broadcast_to(turn @ axis, (len(skis.middle), 3)) for axis in own)
    return replay.place[frame] + skis.middle @ turn.T, across, away, ahead


def snow_heights(terrain: ReplayTerrain, x: Any, y: Any) -> np.ndarray:
    """Heights (m) of the drawn snow at places x, y (m): linear between its places, a plane beyond them."""
    within = np.clip(x, *terrain.x[[0, -1]]), np.clip(y, *terrain.y[[0, -1]])
    near = RegularGridInterpolator((terrain.x, terrain.y), terrain.height)(within)
    return np.asarray(near + terrain.grade[0] * (x - within[0]) + terrain.grade[1] * (y - within[1]))
