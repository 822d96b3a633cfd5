"""Triangle meshes of snow, skis and groove with the colours of a replay, and their glTF 2.0 file (GLB).

Section numbers are those of the specification: Khronos Group (2021), glTF 2.0 Specification, version 2.0.1.
"""

from __future__ import annotations

import json
import math
import struct
from collections import defaultdict
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from .._support.arrays import BoolArray, FloatArray, IntArray
from .replay import Replay, ski_edges

_MARGIN: Final = 3.0
LIFTED: Final = 0.0005
"""Height (m) of the groove over the snow of a model, or the two would flicker into each other (assumption)."""
_GRID: Final = {False: [188, 202, 217], True: [128, 149, 171]}
CORNERS: Final = 8
"""Vertices of a ski's cross section: left and right on top, right and left on the base, and the same for the walls."""


def rotation_to_gltf(tilt: float) -> list[float]:
    """Quaternion x, y, z, w from the run's axes to those of glTF: the inclination about y, then z up made y up."""
    y, w = math.sqrt(0.5) * math.sin(tilt / 2.0), math.sqrt(0.5) * math.cos(tilt / 2.0)
    return [-w, y, -y, w]  # (-√½, 0, 0, √½) times (0, sin, 0, cos)


def ski_mesh(replay: Replay, frame: int, ski: int, exaggeration: float) -> Mesh:
    """A ski as it is drawn at a moment, in its place: base, top and both walls, coloured by the force of the snow."""
    edges = ski_edges(replay, frame, exaggeration=exaggeration)[ski]
    along = np.gradient(edges.mean(axis=1), axis=0)
    away = np.cross(edges[:, 0] - edges[:, 1], along)  # across to the left and towards the tail: away from the snow
    away /= np.linalg.norm(away, axis=1)[:, None]
    top = edges + (drawn_thickness(replay.skis.station)[:, None] * away)[:, None]
    return _ski_with_walls(edges, top, _force_colours(replay, replay.skis.force_per_length[frame, ski]))


def unloaded_ski_mesh(replay: Replay, ski: int) -> Mesh:
    """A ski with its unloaded base, x ahead of the boot, y across the base to the left, z away from the snow.

    Its colours are those of the mean force over the run.
    """
    skis = replay.skis
    height = np.stack([skis.base_height, skis.base_height + drawn_thickness(skis.station)])
    side = np.stack([skis.half_width, -skis.half_width])
    place = np.empty((2, len(skis.station), 2, 3))  # base or top, station, left or right
    place[..., 0], place[..., 1], place[..., 2] = skis.station[:, None], side.T, height[..., None]
    return _ski_with_walls(place[0], place[1], _force_colours(replay, skis.force_per_length[:, ski].mean(axis=0)))


def _force_colours(replay: Replay, force: FloatArray) -> FloatArray:
    """Colours (m, 3) of forces (m,) along a ski in N/m, on the scale of the whole run."""
    share = force / end_of_force_scale(replay.skis.force_per_length)
    face = linear_colours("force", share)
    face[share <= COLOURS["least_share"]] = linear_light(COLOURS["unloaded"])
    return face


def _ski_with_walls(base: FloatArray, top: FloatArray, face: FloatArray) -> Mesh:
    """A ski from its base and top (station, left or right, 3) and its faces' colours (station, 3)."""
    ring = [top[:, 0], top[:, 1], base[:, 1], base[:, 0]]
    corners = np.stack([*ring, ring[3], *ring[:3]], axis=1)  # twice: for the faces and for the walls
    colours = np.empty_like(corners)
    colours[:, :4], colours[:, 4:] = face[:, None], linear_light(COLOURS["side"])
    pairs = [(0, 1), (2, 3), (4, 5), (6, 7)]
    return Mesh(corners.reshape(-1, 3), colours.reshape(-1, 3), _strips(len(corners), CORNERS, pairs))


def _strips(sections: int, corners: int, pairs: list[tuple[int, int]]) -> IntArray:
    """Triangles (t, 3), as vertex indices, between neighbouring sections of a ski: a strip for each pair of corners."""
    j = np.arange(sections - 1)[:, None] * corners
    a, b = (np.array([pair[i] for pair in pairs]) + j for i in (0, 1))
    below, above = np.stack([a, a + corners, b], axis=-1), np.stack([b, a + corners, b + corners], axis=-1)
    return np.concatenate([below.reshape(-1, 3), above.reshape(-1, 3)])


def groove_mesh(replay: Replay, pieces_mask: BoolArray) -> Mesh:
    """Mesh of the masked pieces of groove, as rectangles of their width slightly above the snow."""
    groove = replay.groove
    half = 0.5 * groove.width[pieces_mask, None] * groove.left[pieces_mask]
    up = _snow_normals(replay, groove.middle[pieces_mask])
    ahead = 0.5 * groove.spacing * np.cross(groove.left[pieces_mask], up)
    middle = groove.middle[pieces_mask] + LIFTED * up
    corners = np.stack([middle - half - ahead, middle + half - ahead, middle + half + ahead, middle - half + ahead], 1)
    share = groove.residual_depth[pieces_mask] / round_above(float(groove.residual_depth.max()))
    colours = np.repeat(linear_colours("depth", share), 4, axis=0)
    first = 4 * np.arange(len(middle))[:, None]
    triangles = np.concatenate([first + np.array([0, 1, 2]), first + np.array([0, 2, 3])])
    return Mesh(corners.reshape(-1, 3), colours, triangles)


def _snow_normals(replay: Replay, place: FloatArray) -> FloatArray:
    if replay.terrain is not None:
        beside = 0.5 * float(replay.terrain.x[1] - replay.terrain.x[0])
        (x, y), heights = place[:, :2].T, replay.terrain.heights
        slope = (heights(x + beside, y) - heights(x - beside, y)) / (2.0 * beside)
        side = (heights(x, y + beside) - heights(x, y - beside)) / (2.0 * beside)
    elif replay.profile is not None:
        slope = np.interp(place[:, 0], replay.profile[:, 0], np.gradient(replay.profile[:, 1], replay.profile[:, 0]))
        side = np.zeros_like(slope)
    else:
        return np.broadcast_to([0.0, 0.0, 1.0], place.shape)
    return np.stack([-slope, -side, np.ones_like(slope)], axis=1) / np.sqrt(1.0 + slope**2 + side**2)[:, None]


def snow_mesh(replay: Replay) -> Mesh:
    """Mesh of the slope around the run."""
    low, high = _slope_bounds(replay)
    is_bent = replay.profile is not None, replay.terrain is not None
    x, y = (
        np.linspace(low[axis], high[axis], max(2, math.ceil(high[axis] - low[axis]) * 4) if bent else 2)
        for axis, bent in enumerate((any(is_bent), is_bent[1]))
    )
    place = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    vertices = np.column_stack([place, surface_heights(replay, *place.T)])
    colours = np.broadcast_to(linear_light(COLOURS["snow"]), vertices.shape)
    return Mesh(vertices, colours, _strips(len(x), len(y), [(j, j + 1) for j in range(len(y) - 1)]))


def grid_mesh(replay: Replay) -> Mesh:
    """Mesh of lines on the snow at each metre of x and y, darker at each fifth; a profile's x is horizontal.

    The lines have pieces of at most a metre, because some viewers do not draw one that passes behind the camera.
    """
    low, high = np.ceil(_slope_bounds(replay)[0]), np.floor(_slope_bounds(replay)[1])
    x, y = (np.arange(low[axis], high[axis] + 0.5) for axis in (0, 1))
    # finer, so that they follow the snow
    along_x = x if replay.profile is None and replay.terrain is None else np.arange(low[0], high[0] + 0.1, 0.25)
    along_y = y if replay.terrain is None else np.arange(low[1], high[1] + 0.1, 0.25)
    pieces, tones = [], []
    for along, across, order in ((along_y, x, (1, 0)), (along_x, y, (0, 1))):
        ends = np.stack([along[:-1], along[1:]], axis=1)
        place = np.stack(np.broadcast_arrays(ends[None], across[:, None, None]), axis=-1)  # line, piece, end, 2
        pieces.append(place[..., list(order)].reshape(-1, 2))
        tones.append(np.repeat(across % 5.0 == 0.0, 2 * len(ends)))
    place, dark = np.concatenate(pieces), np.concatenate(tones)
    vertices = np.column_stack([place, surface_heights(replay, *place.T)])
    vertices += LIFTED * _snow_normals(replay, vertices)
    colours = np.where(dark[:, None], linear_light(_GRID[True]), linear_light(_GRID[False]))
    return Mesh(vertices, colours, np.arange(len(vertices)).reshape(-1, 2))


def _slope_bounds(replay: Replay) -> FloatArray:
    """Lowest and highest coordinates (2, 3) of the shown slope."""
    return np.stack([replay.place.min(axis=0) - _MARGIN, replay.place.max(axis=0) + _MARGIN])


def surface_heights(replay: Replay, x: FloatArray, y: FloatArray) -> FloatArray:
    """Heights (k,) of the snow at places x, y (k,), all in m; 0 on a plane."""
    if replay.terrain is not None:
        return replay.terrain.heights(x, y)
    if replay.profile is None:
        return np.zeros_like(x)
    return np.interp(x, replay.profile[:, 0], replay.profile[:, 1])


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
"""Thickness (m) of a ski under the boot and at its ends: drawn, not computed with."""


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
    return linear_light(np.stack(parts, axis=-1))


def linear_light(colour: npt.ArrayLike) -> FloatArray:
    """Linear light, 0 to 1, of an sRGB colour, 0 to 255 (IEC 61966-2-1)."""
    part = np.asarray(colour, dtype=float) / 255.0
    return np.where(part <= 0.04045, part / 12.92, ((part + 0.055) / 1.055) ** 2.4)


def end_of_force_scale(force: FloatArray) -> float:
    """Upper end (N/m) of a scale of forces per length: a round number that 5 % of the positive forces exceed.

    The largest force of a run may be a short peak; most of a ski would be pale next to it.

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


FLOAT: Final = "<f4"
UNSIGNED: Final = "<u4"
UNSIGNED_SHORT: Final = "<u2"
_COMPONENTS: Final = {FLOAT: 5126, UNSIGNED: 5125, UNSIGNED_SHORT: 5123}  # 3.6.2.2
_TYPES: Final = {1: "SCALAR", 3: "VEC3", 4: "VEC4", 16: "MAT4"}
_MODES: Final = {2: 1, 3: 4}  # lines, triangles: 5.24.4
_VERTICES, _INDICES = 34962, 34963  # targets of a bufferView, 5.11.5
_JSON, _BINARY = 0x4E4F534A, 0x004E4942  # kinds of chunks, 4.4.3
_SURFACE: Final = {"baseColorFactor": [1.0, 1.0, 1.0, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.9}


@dataclass(frozen=True, slots=True, eq=False)
class Mesh:
    """Vertices (v, 3) in m, their colours (v, 3) in linear light, triangles (t, 3) or lines (t, 2) of their numbers."""

    vertices: FloatArray
    colours: FloatArray
    pieces: IntArray


@dataclass(slots=True)
class Glb:
    """Builder of a model file in glTF 2.0 (GLB); `array`, `mesh`, `node` and `skin` return an index of the element."""

    content: bytearray = field(default_factory=bytearray)
    elements: dict[str, list[dict[str, Any]]] = field(default_factory=lambda: defaultdict(list))

    def _add(self, kind: str, element: dict[str, Any]) -> int:
        self.elements[kind].append(element)
        return len(self.elements[kind]) - 1

    def array(
        self, values: npt.ArrayLike, *, kind: str = FLOAT, bounds: bool = False, target: int | None = None
    ) -> int:
        """Add an array (n,) or (n, parts) as an accessor; with minimum and maximum of each part if `bounds`."""
        numbers = np.ascontiguousarray(values, dtype=kind)
        self.content += b"\0" * (-len(self.content) % 4)  # each begins at a multiple of its component's size, 3.6.2.4
        view = {"buffer": 0, "byteOffset": len(self.content), "byteLength": numbers.nbytes}
        number = self._add("bufferViews", view if target is None else view | {"target": target})
        self.content += numbers.tobytes()
        rows = numbers.reshape(len(numbers), -1)
        description: dict[str, Any] = {"bufferView": number, "componentType": _COMPONENTS[kind]}
        description |= {"count": len(rows), "type": _TYPES[rows.shape[1]]}
        if bounds:
            description |= {"min": rows.min(axis=0).tolist(), "max": rows.max(axis=0).tolist()}
        return self._add("accessors", description)

    def mesh(self, name: str, mesh: Mesh, *, joints: IntArray | None = None) -> int:
        """Add a mesh; with `joints` (v,) each vertex follows one joint of a skin."""
        attributes = {
            "POSITION": self.array(mesh.vertices, bounds=True, target=_VERTICES),
            "COLOR_0": self.array(mesh.colours, target=_VERTICES),
        }
        if joints is not None:
            none = np.zeros_like(joints)
            of_four = np.stack([joints, none, none, none], axis=1)
            attributes["JOINTS_0"] = self.array(of_four, kind=UNSIGNED_SHORT, target=_VERTICES)
            attributes["WEIGHTS_0"] = self.array(np.eye(4)[none], target=_VERTICES)
        indices = self.array(mesh.pieces.reshape(-1), kind=UNSIGNED, target=_INDICES)
        primitive = {"attributes": attributes, "indices": indices, "material": 0, "mode": _MODES[mesh.pieces.shape[1]]}
        return self._add("meshes", {"name": name, "primitives": [primitive]})

    def node(self, name: str, **what: Any) -> int:
        """Add a node; arrays among its properties become lists."""
        properties = {key: value.tolist() if isinstance(value, np.ndarray) else value for key, value in what.items()}
        return self._add("nodes", {"name": name} | properties)

    def skin(self, name: str, joints: list[int], skeleton: int, into_joints: FloatArray) -> int:
        """Add a skin: joints (nodes), node above them, matrices (joint, 4, 4) from the resting mesh to the joints."""
        columns = np.swapaxes(into_joints, 1, 2).reshape(-1, 16)  # column by column, 3.6.2.4
        matrices = self.array(columns)
        skin = {"name": name, "joints": joints, "skeleton": skeleton, "inverseBindMatrices": matrices}
        return self._add("skins", skin)

    def move(self, node: int, path: str, times: int, values: int, *, interpolation: str = "LINEAR") -> None:
        """Animate a node's translation, rotation or scale (`path`) by the accessors of times and values."""
        sampler = self._add("samplers", {"input": times, "output": values, "interpolation": interpolation})
        self._add("channels", {"sampler": sampler, "target": {"node": node, "path": path}})

    def to_bytes(self, title: str, roots: list[int], **further: Any) -> bytes:
        """Bytes of the file: a scene of the nodes `roots`, an animation, and `further` properties of the top level."""
        animation = {kind: self.elements.pop(kind) for kind in ("channels", "samplers") if kind in self.elements}
        description: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": "skisnow"},
            "scene": 0,
            "scenes": [{"name": title, "nodes": roots}],
            "materials": [{"name": "drawn", "pbrMetallicRoughness": _SURFACE, "doubleSided": True}],
            "buffers": [{"byteLength": len(self.content)}],
            **self.elements,
            **({"animations": [{"name": "run"} | animation]} if animation else {}),
        }
        text = json.dumps(description | further, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
        chunks = _padded_chunk(_JSON, text.encode("utf-8"), b" ") + _padded_chunk(_BINARY, bytes(self.content), b"\0")
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def _padded_chunk(kind: int, data: bytes, filling: bytes) -> bytes:
    data += filling * (-len(data) % 4)
    return struct.pack("<II", len(data), kind) + data
