"""Compact binary format of a replay for a browser.

The bytes are: the four letters ``SKRP``, a little-endian uint32 with the length of the header, the header as JSON in
UTF-8 padded with spaces to a multiple of four, then the arrays one after the other, each padded to a multiple of four.

The header has ``format`` (2), the words and single numbers of the replay, the colours it is shown in, and ``arrays``:
under each name its ``type`` ("float32" or "uint16", little-endian), ``shape``, ``start`` (bytes from the end of the
header), ``unit``, and for uint16 ``lowest`` and ``step``: value = lowest + step * number. ``error`` is the largest
difference from the run.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping
from dataclasses import fields, replace
from typing import Any, Final, TypeVar

import numpy as np
import numpy.typing as npt

from .._support.arrays import FloatArray, IntArray
from .._support.errors import ParameterError
from .._support.user_files import ContentError, json_value
from .meshes import COLOURS, drawn_thickness
from .replay import SKI_NAMES, Replay, ReplayBoots, ReplayGroove, ReplaySkier, ReplaySkis, ReplayTerrain, ReplayTrack
from .skier import JOINTS, Part, skier_parts

MAGIC: Final = b"SKRP"
FORMAT: Final = 2
MOST_FRAMES_PER_SECOND: Final = 100.0
"""Maximum number of moments per second in a file."""
_STEPS: Final = 65535
_EXACT: Final = "float32"
_COARSE: Final = "uint16"


_NAMES: Final[dict[tuple[str, str], str]] = {
    (_EXACT, "s"): "time groove_time track_time gate_time",
    (_EXACT, "m"): (
        "place depth profile station half_width base_height thickness middle groove_middle "
        "track_place gate_place boot_place terrain_x terrain_y terrain_height"
    ),
    (_EXACT, "1"): "attitude boot_attitude",
    (_EXACT, "m/s"): "speed",
    (_EXACT, "1/m"): "curvature",
    (_EXACT, "rad"): "heading",
    (_COARSE, "m"): "bending edge_depth groove_width groove_depth groove_residual_depth skier_joints skier_vertices",
    (_COARSE, "rad"): "twist",
    (_COARSE, "N/m"): "force_per_length",
    (_EXACT, "N"): "force normal_force",
    (_COARSE, "1"): "groove_left groove_ski skier_colours skier_triangles",
}
ARRAY_TYPES: Final = {name: of for of, names in _NAMES.items() for name in names.split()}
"""Types and units of all arrays; uint16 has an error of at most half a step, 1/131070 of the array's range."""
_MOTION: Final = ("time", "place", "attitude", "speed", "curvature", "heading", "depth")
_SKI_HISTORIES: Final = ("bending", "twist", "edge_depth", "force_per_length", "force", "normal_force")
_Part = TypeVar("_Part", Replay, ReplayBoots, ReplayGroove, ReplaySkier, ReplaySkis, ReplayTerrain, ReplayTrack)


def replay_bytes(replay: Replay) -> bytes:
    """Bytes of a replay in the format of this module.

    A run of 5 s of two skis with 42 stations at 100 moments a second is 0.5 MB: two thirds along the skis, a third of
    groove.
    """
    arrays, described, at = [], {}, 0
    for name, values in _arrays_by_name(thin_replay(replay)).items():
        content, description = _pack_array(*ARRAY_TYPES[name], values)
        described[name] = description | {"start": at}
        arrays.append(content)
        at += len(content)
    header = json.dumps(_head(replay) | {"arrays": described}, ensure_ascii=False, allow_nan=False).encode("utf-8")
    header += b" " * (-len(header) % 4)
    return b"".join([MAGIC, struct.pack("<I", len(header)), header, *arrays])


def replay_of_bytes(content: bytes) -> Replay:
    """Replay from the bytes of `replay_bytes`.

    Raises ParameterError: the bytes are not a replay, are incomplete, or have a later format.
    """
    if content[: len(MAGIC)] != MAGIC or len(content) < 8:
        raise ParameterError("these bytes are not a replay: they do not begin with SKRP").tag("not_a_replay")
    (length,) = struct.unpack("<I", content[4:8])
    try:
        header = json_value(content[8 : 8 + length].decode("utf-8"))
        if header["format"] != FORMAT:
            raise ParameterError("the replay has format {format}; this program reads format {readable}").tag(
                "unknown_format", format=header["format"], readable=FORMAT
            )
        arrays = {name: _unpack(content, 8 + length, description) for name, description in header["arrays"].items()}
        if not np.isin(np.rint(arrays["groove_ski"]), range(len(SKI_NAMES))).all():
            raise ParameterError("a piece of the groove belongs to no ski").tag("damaged")
        return _build_replay(header, arrays)
    except (ValueError, LookupError, TypeError, AttributeError, OverflowError, MemoryError) as error:
        if isinstance(error, ParameterError) and not isinstance(error, ContentError):
            raise
        raise ParameterError("the replay is damaged or cut off ({error}). Write it again").tag(
            "damaged", error=error
        ) from error


def thin_replay(replay: Replay) -> Replay:
    """Replay with at most `MOST_FRAMES_PER_SECOND` moments per second, including the first and the last."""
    number = len(replay.time)
    duration = float(replay.time[-1] - replay.time[0])
    step = max(1, round((number - 1) / max(duration * MOST_FRAMES_PER_SECOND, 1.0))) if number > 1 else 1
    if step == 1:
        return replay
    return select_moments(replay, np.unique(np.append(np.arange(0, number, step), number - 1)))


def select_moments(replay: Replay, moments: IntArray) -> Replay:
    """Replay with only the moments of these indices, and the whole groove."""

    def select(part: _Part, *names: str) -> _Part:
        return replace(part, **{name: getattr(part, name)[moments] for name in names})

    boots, skier = replay.skis.boots, replay.skier
    skis = replace(select(replay.skis, *_SKI_HISTORIES), boots=boots and select(boots, "place", "attitude"))
    return replace(select(replay, *_MOTION), skis=skis, skier=skier and select(skier, "joints"))


def _arrays_by_name(replay: Replay) -> dict[str, FloatArray]:
    skis, skier = replay.skis, replay.skier
    arrays: dict[str, Any] = {name: getattr(replay, name) for name in (*_MOTION, "profile")}
    arrays |= _arrays_of(skis) | {"thickness": drawn_thickness(skis.station)} | _arrays_of(replay.groove, "groove_")
    arrays |= _arrays_of(replay.track, "track_") | {"gate_place": replay.gates, "gate_time": replay.gate_times}
    arrays |= _arrays_of(skis.boots, "boot_") | _arrays_of(replay.terrain, "terrain_") | _arrays_of(skier, "skier_")
    if skier is not None:
        arrays |= _shape_arrays(skier_parts(skier.height))
    return {name: np.asarray(values, dtype=float) for name, values in arrays.items() if values is not None}


def _arrays_of(part: _Part | None, prefix: str = "") -> dict[str, FloatArray]:
    """Arrays among the fields of a part of a replay by their names in a file; empty without the part."""
    values = {} if part is None else {field.name: getattr(part, field.name) for field in fields(part)}
    return {f"{prefix}{name}": value for name, value in values.items() if isinstance(value, np.ndarray)}


def _shape_arrays(parts: list[Part]) -> dict[str, FloatArray]:
    """Concatenated meshes of the skier's parts; triangles count from each part's first vertex."""
    meshes = [part.mesh for part in parts]
    return {
        "skier_vertices": np.concatenate([mesh.vertices for mesh in meshes]),
        "skier_colours": np.concatenate([mesh.colours for mesh in meshes]),
        "skier_triangles": np.concatenate([mesh.pieces for mesh in meshes]).astype(float),
    }


def _head(replay: Replay) -> dict[str, Any]:
    return {
        "format": FORMAT,
        "title": replay.title,
        "facts": [list(fact) for fact in replay.facts],
        "tilt": replay.tilt,
        "edge_angle": replay.skis.edge_angle,
        "centre_of_mass_height": replay.centre_of_mass_height,
        "groove_spacing": replay.groove.spacing,
        "colours": COLOURS,
        **({} if replay.terrain is None else {"terrain_grade": list(replay.terrain.grade)}),
        "track_name": None if replay.track is None else replay.track.name,
        **({} if replay.skier is None else {"skier": _skier_words(replay.skier)}),
    }


def _skier_words(skier: ReplaySkier) -> dict[str, Any]:
    """Height and weight of the body, names of the joints, and joints and sizes of the parts' meshes."""
    parts = [
        {"name": part.name, "start": part.start, "end": part.end, "vertices": len(part.mesh.vertices),
         "triangles": len(part.mesh.pieces)}
        for part in skier_parts(skier.height)
    ]  # fmt: skip
    return {"height": skier.height, "weight": skier.weight, "joints": list(JOINTS), "parts": parts}


def _pack_array(kind: str, unit: str, values: FloatArray) -> tuple[bytes, dict[str, Any]]:
    description: dict[str, Any] = {"type": kind, "shape": list(values.shape), "unit": unit}
    if kind == _EXACT:
        numbers: npt.NDArray[Any] = values.astype("<f4")
        back = numbers.astype(float)
    else:
        lowest = float(values.min()) if values.size else 0.0
        step = (float(values.max()) - lowest) / _STEPS if values.size else 0.0
        numbers = np.rint((values - lowest) / (step or 1.0)).astype("<u2")
        description |= {"lowest": lowest, "step": step}
        back = lowest + step * numbers
    description["error"] = float(np.nan_to_num(np.abs(back - values)).max()) if values.size else 0.0
    content = numbers.tobytes()
    return content + b"\0" * (-len(content) % 4), description


def _unpack(content: bytes, base: int, description: Mapping[str, Any]) -> FloatArray:
    count = int(np.prod(description["shape"]))
    kind = "<f4" if description["type"] == _EXACT else "<u2"
    with np.errstate(invalid="ignore"):  # a damaged number may be a signalling NaN
        numbers = np.frombuffer(content, kind, count, base + description["start"]).astype(float)
    if description["type"] != _EXACT:
        numbers = description["lowest"] + description["step"] * numbers
    return np.asarray(numbers.reshape(description["shape"]))


def _build_replay(header: Mapping[str, Any], arrays: dict[str, FloatArray]) -> Replay:
    def build(part: type[_Part], prefix: str = "", **further: Any) -> _Part:
        """A part of the replay from its arrays, whose names in the file begin with the prefix."""
        named = {field.name: arrays.get(f"{prefix}{field.name}") for field in fields(part)}
        return part(**{name: values for name, values in named.items() if values is not None} | further)

    terrain = skier = track = None
    if "terrain_height" in arrays:
        grade = header["terrain_grade"]
        terrain = build(ReplayTerrain, "terrain_", grade=(grade[0], grade[1]))
    if "skier_joints" in arrays:
        body = header["skier"]
        skier = build(ReplaySkier, "skier_", height=body["height"], weight=body["weight"])
    if "track_place" in arrays:
        track = build(ReplayTrack, "track_", name=header["track_name"])
    boots = build(ReplayBoots, "boot_") if "boot_place" in arrays else None
    of_pieces = np.rint(arrays["groove_ski"]).astype(np.int64)
    return build(
        Replay,
        title=header["title"],
        facts=tuple((name, value) for name, value in header["facts"]),
        tilt=header["tilt"],
        centre_of_mass_height=header["centre_of_mass_height"],
        skis=build(ReplaySkis, edge_angle=header["edge_angle"], boots=boots),
        groove=build(ReplayGroove, "groove_", ski=of_pieces, spacing=header["groove_spacing"]),
        track=track,
        gates=arrays.get("gate_place"),
        gate_times=arrays.get("gate_time"),
        terrain=terrain,
        skier=skier,
    )
