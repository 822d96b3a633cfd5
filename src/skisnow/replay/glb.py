"""A glTF 2.0 model in one binary file (GLB): numbers, meshes, nodes and what moves them, collected piece by piece.

Section numbers are those of the specification: Khronos Group (2021), glTF 2.0 Specification, version 2.0.1.
"""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass, field
from typing import Any, Final, TypeAlias

import numpy as np
import numpy.typing as npt

FloatArray: TypeAlias = npt.NDArray[np.float64]
IntArray: TypeAlias = npt.NDArray[np.int64]

FLOAT: Final = "<f4"
UNSIGNED: Final = "<u4"
UNSIGNED_SHORT: Final = "<u2"
_COMPONENTS: Final = {FLOAT: 5126, UNSIGNED: 5125, UNSIGNED_SHORT: 5123}  # 3.6.2.2
_TYPES: Final = {1: "SCALAR", 3: "VEC3", 4: "VEC4", 16: "MAT4"}
_MODES: Final = {2: 1, 3: 4}  # lines, triangles: 5.24.4
_VERTICES, _INDICES = 34962, 34963  # what a bufferView is for, 5.11.5
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
    """Collects a model; each method returns the number by which the others know what was added."""

    content: bytearray = field(default_factory=bytearray)
    views: list[dict[str, Any]] = field(default_factory=list)
    accessors: list[dict[str, Any]] = field(default_factory=list)
    meshes: list[dict[str, Any]] = field(default_factory=list)
    nodes: list[dict[str, Any]] = field(default_factory=list)
    skins: list[dict[str, Any]] = field(default_factory=list)
    channels: list[dict[str, Any]] = field(default_factory=list)
    samplers: list[dict[str, Any]] = field(default_factory=list)

    def array(
        self, values: npt.ArrayLike, *, kind: str = FLOAT, bounds: bool = False, target: int | None = None
    ) -> int:
        """Numbers (n,) or (n, parts), with least and most of each part where a reader wants them."""
        numbers = np.ascontiguousarray(values, dtype=kind)
        self.content += b"\0" * (-len(self.content) % 4)  # each begins at a multiple of its component's size, 3.6.2.4
        view = {"buffer": 0, "byteOffset": len(self.content), "byteLength": numbers.nbytes}
        self.views.append(view if target is None else view | {"target": target})
        self.content += numbers.tobytes()
        rows = numbers.reshape(len(numbers), -1)
        description: dict[str, Any] = {"bufferView": len(self.views) - 1, "componentType": _COMPONENTS[kind]}
        description |= {"count": len(rows), "type": _TYPES[rows.shape[1]]}
        if bounds:
            description |= {"min": rows.min(axis=0).tolist(), "max": rows.max(axis=0).tolist()}
        self.accessors.append(description)
        return len(self.accessors) - 1

    def mesh(self, name: str, mesh: Mesh, *, joints: IntArray | None = None, **further: Any) -> int:
        """A mesh; with `joints` (v,) each vertex follows one joint of a skin alone."""
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
        self.meshes.append({"name": name, "primitives": [primitive]} | further)
        return len(self.meshes) - 1

    def node(self, name: str, **what: Any) -> int:
        """A node; arrays among its properties become lists."""
        properties = {key: value.tolist() if isinstance(value, np.ndarray) else value for key, value in what.items()}
        self.nodes.append({"name": name} | properties)
        return len(self.nodes) - 1

    def skin(self, name: str, joints: list[int], skeleton: int, into_joints: FloatArray) -> int:
        """Joints (nodes), the node above them, and matrices (joint, 4, 4) from the resting mesh to each joint."""
        columns = np.swapaxes(into_joints, 1, 2).reshape(-1, 16)  # column by column, 3.6.2.4
        matrices = self.array(columns)
        self.skins.append({"name": name, "joints": joints, "skeleton": skeleton, "inverseBindMatrices": matrices})
        return len(self.skins) - 1

    def move(self, node: int, path: str, times: int, values: int, *, interpolation: str = "LINEAR") -> None:
        """Let a node's translation, rotation or scale go through the values of one array at the times of another."""
        self.samplers.append({"input": times, "output": values, "interpolation": interpolation})
        self.channels.append({"sampler": len(self.samplers) - 1, "target": {"node": node, "path": path}})

    def finished(self, title: str, roots: list[int], **further: Any) -> bytes:
        """The file: a scene of the nodes `roots`, one animation if something moves, and `further` of the top level."""
        description: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": "skisnow"},
            "scene": 0,
            "scenes": [{"name": title, "nodes": roots}],
            "nodes": self.nodes,
            "meshes": self.meshes,
            "materials": [{"name": "drawn", "pbrMetallicRoughness": _SURFACE, "doubleSided": True}],
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{"byteLength": len(self.content)}],
        }
        if self.skins:
            description["skins"] = self.skins
        if self.channels:
            description["animations"] = [{"name": "run", "channels": self.channels, "samplers": self.samplers}]
        text = json.dumps(description | further, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
        chunks = _chunk(_JSON, text.encode("utf-8"), b" ") + _chunk(_BINARY, bytes(self.content), b"\0")
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def _chunk(kind: int, data: bytes, filling: bytes) -> bytes:
    data += filling * (-len(data) % 4)
    return struct.pack("<II", len(data), kind) + data
