"""A GLB file read and played by hand, after the glTF 2.0 specification, with nothing of the program that writes it."""

import json
import struct
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

COMPONENTS = {5126: "<f4", 5125: "<u4", 5123: "<u2"}  # section 3.6.2.2
PARTS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}
VERTICES, INDICES = 34962, 34963


class GlbFile:
    """The file's words and numbers."""

    def __init__(self, content: bytes) -> None:
        magic, version, length = struct.unpack("<4sII", content[:12])
        assert (magic, version, length) == (b"glTF", 2, len(content))
        size, kind = struct.unpack("<I4s", content[12:20])
        assert kind == b"JSON"
        assert size % 4 == 0
        self.words: dict[str, Any] = json.loads(content[20 : 20 + size])
        size2, kind2 = struct.unpack("<I4s", content[20 + size : 28 + size])
        assert kind2 == b"BIN\0"
        self.binary = content[28 + size :]
        assert size2 == len(self.binary)
        assert size2 % 4 == 0
        assert 0 <= size2 - self.words["buffers"][0]["byteLength"] <= 3
        assert [set(each) for each in self.words["buffers"]] == [{"byteLength"}]

    def array(self, number: int) -> np.ndarray:
        """(count, parts), with its alignment, place and bounds checked."""
        accessor = self.words["accessors"][number]
        view = self.words["bufferViews"][accessor["bufferView"]]
        kind, parts = np.dtype(COMPONENTS[accessor["componentType"]]), PARTS[accessor["type"]]
        start = view["byteOffset"] + accessor.get("byteOffset", 0)
        assert start % kind.itemsize == 0
        assert "byteStride" not in view
        assert kind.itemsize * parts * accessor["count"] == view["byteLength"]
        assert view["byteOffset"] + view["byteLength"] <= self.words["buffers"][0]["byteLength"]
        found = np.frombuffer(self.binary, kind, parts * accessor["count"], start).reshape(-1, parts)
        assert np.isfinite(found).all()
        if "min" in accessor:
            assert accessor["min"] == found.min(axis=0).tolist()  # exact, 3.6.2.5
            assert accessor["max"] == found.max(axis=0).tolist()
        return found

    def node(self, name: str) -> int:
        (found,) = [i for i, each in enumerate(self.words["nodes"]) if each["name"] == name]
        return found


class Playing:
    """A file at a time of its one animation."""

    def __init__(self, file: GlbFile, time: float) -> None:
        self.file, self.time = file, time
        self.nodes = [dict(each) for each in file.words["nodes"]]
        (animation,) = file.words["animations"]
        for channel in animation["channels"]:
            target, sampler = channel["target"], animation["samplers"][channel["sampler"]]
            self.nodes[target["node"]][target["path"]] = self.value(sampler, target["path"])
        self.parent = {child: i for i, each in enumerate(self.nodes) for child in each.get("children", [])}

    def value(self, sampler: dict[str, Any], path: str) -> np.ndarray:
        """At the time: the end's value beyond the ends, straight or by the shortest turn between keys, 3.11."""
        keys = self.file.array(sampler["input"])[:, 0].astype(float)
        values = self.file.array(sampler["output"]).astype(float)
        time = float(np.clip(self.time, keys[0], keys[-1]))
        if sampler["interpolation"] == "STEP":
            return values[np.searchsorted(keys, time, side="right") - 1]
        assert sampler["interpolation"] == "LINEAR"
        if path == "rotation" and len(keys) > 1:
            return Slerp(keys, Rotation.from_quat(values))(time).as_quat()
        return np.array([np.interp(time, keys, values[:, i]) for i in range(values.shape[1])])

    def matrix(self, number: int) -> np.ndarray:
        """From a node to the world: translation, rotation, scale, below those of its parents."""
        node = self.nodes[number]
        own = np.eye(4)
        own[:3, :3] = Rotation.from_quat(node.get("rotation", [0.0, 0.0, 0.0, 1.0])).as_matrix()
        own[:3, :3] *= np.asarray(node.get("scale", [1.0, 1.0, 1.0]))[None, :]
        own[:3, 3] = node.get("translation", [0.0, 0.0, 0.0])
        return self.matrix(self.parent[number]) @ own if number in self.parent else own

    def vertices(self, name: str) -> np.ndarray:
        """(v, 3) of a node's mesh in the world; one with a skin only by its joints, 3.7.3.2."""
        number = self.file.node(name)
        node = self.nodes[number]
        (primitive,) = self.file.words["meshes"][node["mesh"]]["primitives"]
        place = self.file.array(primitive["attributes"]["POSITION"]).astype(float)
        place = np.column_stack([place, np.ones(len(place))])
        if "skin" not in node:
            return (place @ self.matrix(number).T)[:, :3]
        skin = self.file.words["skins"][node["skin"]]
        into = self.file.array(skin["inverseBindMatrices"]).astype(float).reshape(-1, 4, 4).transpose(0, 2, 1)
        joints = np.array([self.matrix(joint) for joint in skin["joints"]]) @ into
        which = self.file.array(primitive["attributes"]["JOINTS_0"]).astype(int)
        weights = self.file.array(primitive["attributes"]["WEIGHTS_0"]).astype(float)
        blended = np.einsum("vw,vwij->vij", weights, joints[which])
        return np.einsum("vij,vj->vi", blended, place)[:, :3]
