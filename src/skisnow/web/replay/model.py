"""A moment of a replay as a glTF model in one binary file (GLB): snow, both skis, the groove so far."""

from __future__ import annotations

import json
import math
import struct
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeAlias

import numpy as np
import numpy.typing as npt

from ...files import write_file
from .looks import COLOURS, drawn_thickness, linear, linear_colours, round_above
from .replay import SKI_NAMES
from .shape import nearest_frame, ski_edges

if TYPE_CHECKING:
    from .replay import Replay

FloatArray: TypeAlias = npt.NDArray[np.float64]
IntArray: TypeAlias = npt.NDArray[np.int64]

_FLOAT, _UNSIGNED = 5126, 5125  # component types of glTF 2.0
_MARGIN: Final = 3.0
_JSON, _BINARY = 0x4E4F534A, 0x004E4942
LIFTED: Final = 0.0005
"""Height (m) of the groove over the snow of a model, or the two would flicker into each other (Choice)."""


def replay_model(replay: Replay, time: float, *, exaggeration: float = 1.0) -> bytes:
    """A GLB file of the moment nearest to a time (s); bending and twist taken `exaggeration` times.

    Notes
    -----
    Metres; y is up as glTF 2.0 wants it, the run's own axes are those of the node ``run`` below. Colours of vertices:
    force per length along the skis, depth that stays along the groove, on the same scales as in the picture.
    """
    frame = nearest_frame(replay, time)
    builder = _Builder()
    builder.add("snow", *_snow(replay))
    for ski, name in enumerate(SKI_NAMES):
        builder.add(f"{name} ski", *_ski(replay, frame, ski, exaggeration))
    if (replay.groove.time <= replay.time[frame]).any():
        builder.add("groove", *_groove(replay, float(replay.time[frame])))
    return builder.finished(replay)


def write_replay_model(replay: Replay, path: str | Path, time: float, *, exaggeration: float = 1.0) -> None:
    """Write the model of a moment; see `replay_model`.

    Raises
    ------
    OutputError
        The place cannot be written.
    """
    write_file(path, replay_model(replay, time, exaggeration=exaggeration))


@dataclass(slots=True)
class _Builder:
    """Collects meshes."""

    content: bytearray = field(default_factory=bytearray)
    views: list[dict[str, Any]] = field(default_factory=list)
    accessors: list[dict[str, Any]] = field(default_factory=list)
    meshes: list[dict[str, Any]] = field(default_factory=list)

    def add(self, name: str, vertices: FloatArray, colours: FloatArray, triangles: IntArray) -> None:
        """A mesh: vertices (v, 3) in m, linear colours (v, 3), triangles (t, 3) of their numbers."""
        place = vertices.astype("<f4")
        bounds = {"min": place.min(axis=0).tolist(), "max": place.max(axis=0).tolist()}
        attributes = {
            "POSITION": self._array(place, "VEC3", _FLOAT, bounds),
            "COLOR_0": self._array(colours.astype("<f4"), "VEC3", _FLOAT, {}),
        }
        indices = self._array(triangles.astype("<u4").reshape(-1), "SCALAR", _UNSIGNED, {})
        primitive = {"attributes": attributes, "indices": indices, "material": 0}
        self.meshes.append({"name": name, "primitives": [primitive]})

    def _array(self, values: npt.NDArray[Any], kind: str, component: int, further: dict[str, Any]) -> int:
        data = values.tobytes()
        self.views.append({"buffer": 0, "byteOffset": len(self.content), "byteLength": len(data)})
        self.content += data  # every part is a multiple of four bytes
        description = {"bufferView": len(self.views) - 1, "componentType": component, "count": len(values)}
        self.accessors.append(description | {"type": kind} | further)
        return len(self.accessors) - 1

    def finished(self, replay: Replay) -> bytes:
        """The file."""
        names = [mesh["name"] for mesh in self.meshes]
        nodes: list[dict[str, Any]] = [{"name": name, "mesh": i} for i, name in enumerate(names)]
        nodes.append({"name": "run", "rotation": _upright(replay.tilt), "children": list(range(len(names)))})
        surface = {"baseColorFactor": [1.0, 1.0, 1.0, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.9}
        description = {
            "asset": {"version": "2.0", "generator": "skisnow"},
            "scene": 0,
            "scenes": [{"name": replay.title, "nodes": [len(nodes) - 1]}],
            "nodes": nodes,
            "meshes": self.meshes,
            "materials": [{"pbrMetallicRoughness": surface, "doubleSided": True}],
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{"byteLength": len(self.content)}],
        }
        text = json.dumps(description, ensure_ascii=False, allow_nan=False).encode("utf-8")
        chunks = _chunk(_JSON, text, b" ") + _chunk(_BINARY, bytes(self.content), b"\0")
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def _chunk(kind: int, data: bytes, filling: bytes) -> bytes:
    data += filling * (-len(data) % 4)
    return struct.pack("<II", len(data), kind) + data


def _upright(tilt: float) -> list[float]:
    """Quaternion x, y, z, w: first the slope's inclination about y, then z up made y up."""
    y, w = math.sqrt(0.5) * math.sin(tilt / 2.0), math.sqrt(0.5) * math.cos(tilt / 2.0)
    return [-w, y, -y, w]  # (-√½, 0, 0, √½) times (0, sin, 0, cos)


def _strips(sections: int, corners: int, pairs: list[tuple[int, int]]) -> IntArray:
    """Triangles (t, 3) between neighbouring sections, for each pair of corners a strip."""
    j = np.arange(sections - 1)[:, None] * corners
    a, b = (np.array([pair[i] for pair in pairs]) + j for i in (0, 1))
    below, above = np.stack([a, a + corners, b], axis=-1), np.stack([b, a + corners, b + corners], axis=-1)
    return np.concatenate([below.reshape(-1, 3), above.reshape(-1, 3)])


def _ski(replay: Replay, frame: int, ski: int, exaggeration: float) -> tuple[FloatArray, FloatArray, IntArray]:
    """A ski as it is drawn: base, top and both walls."""
    edges = ski_edges(replay, frame, exaggeration=exaggeration)[ski]
    along = np.gradient(edges.mean(axis=1), axis=0)
    away = np.cross(edges[:, 0] - edges[:, 1], along)  # across to the left and towards the tail: away from the snow
    away /= np.linalg.norm(away, axis=1)[:, None]
    top = edges + (drawn_thickness(replay.skis.station)[:, None] * away)[:, None]
    ring = [top[:, 0], top[:, 1], edges[:, 1], edges[:, 0]]  # twice: for the faces and for the walls
    corners = np.stack([ring[0], ring[1], ring[2], ring[3], ring[3], ring[0], ring[1], ring[2]], axis=1)
    force = replay.skis.force_per_length
    share = force[frame, ski] / round_above(float(force.max()))
    face = linear_colours("force", share)
    face[share <= COLOURS["least_share"]] = linear(COLOURS["unloaded"])
    colours = np.empty_like(corners)
    colours[:, :4], colours[:, 4:] = face[:, None], linear(COLOURS["side"])
    pairs = [(0, 1), (2, 3), (4, 5), (6, 7)]
    return corners.reshape(-1, 3), colours.reshape(-1, 3), _strips(len(corners), 8, pairs)


def _groove(replay: Replay, time: float) -> tuple[FloatArray, FloatArray, IntArray]:
    """Pieces as rectangles of their true width, a little over the snow."""
    groove = replay.groove
    kept = groove.time <= time
    half = 0.5 * groove.width[kept, None] * groove.left[kept]
    up = _normals(replay, groove.middle[kept])
    ahead = 0.5 * groove.spacing * np.cross(groove.left[kept], up)
    middle = groove.middle[kept] + LIFTED * up
    corners = np.stack([middle - half - ahead, middle + half - ahead, middle + half + ahead, middle - half + ahead], 1)
    share = groove.residual_depth[kept] / round_above(float(groove.residual_depth.max()))
    colours = np.repeat(linear_colours("depth", share), 4, axis=0)
    first = 4 * np.arange(len(middle))[:, None]
    triangles = np.concatenate([first + np.array([0, 1, 2]), first + np.array([0, 2, 3])])
    return corners.reshape(-1, 3), colours, triangles


def _normals(replay: Replay, place: FloatArray) -> FloatArray:
    if replay.profile is None:
        return np.broadcast_to([0.0, 0.0, 1.0], place.shape)
    slope = np.interp(place[:, 0], replay.profile[:, 0], np.gradient(replay.profile[:, 1], replay.profile[:, 0]))
    return np.stack([-slope, np.zeros_like(slope), np.ones_like(slope)], axis=1) / np.hypot(1.0, slope)[:, None]


def _snow(replay: Replay) -> tuple[FloatArray, FloatArray, IntArray]:
    """The slope around the run."""
    low, high = replay.place.min(axis=0) - _MARGIN, replay.place.max(axis=0) + _MARGIN
    line = np.array([[low[0], 0.0], [high[0], 0.0]])
    if replay.profile is not None:
        x = np.linspace(low[0], high[0], max(2, math.ceil(high[0] - low[0]) * 4))
        line = np.column_stack([x, np.interp(x, replay.profile[:, 0], replay.profile[:, 1])])
    vertices = np.array([[x, y, z] for x, z in line for y in (low[1], high[1])])
    colours = np.broadcast_to(linear(COLOURS["snow"]), vertices.shape)
    return vertices, colours, _strips(len(line), 2, [(0, 1)])
