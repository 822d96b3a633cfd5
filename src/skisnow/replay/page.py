"""Replay in a compact binary format for a browser, and as one self-contained HTML file."""

from __future__ import annotations

import base64
import json
import re
import struct
from dataclasses import fields, replace
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any, Final, TypeVar

import numpy as np
import numpy.typing as npt
from jinja2 import Environment, PackageLoader, StrictUndefined, Template
from markupsafe import Markup

from .._support.arrays import FloatArray
from .._support.errors import ParameterError, require_language
from .._support.messages import ENGLISH, translated, translations
from .._support.staging import write_file
from ..simulation.run import Run
from .from_run import replay_of_run
from .replay import Replay, ReplayBoots, ReplayGroove, ReplaySkier, ReplaySkis, ReplayTerrain, ReplayTrack
from .run_file import replay_of_file
from .skier import JOINTS, skier_parts

MODULES: Final = (
    "words.js", "three.core.min.js", "three.module.min.js", "binary.js", "motion.js", "colours.js", "snow_tile.js",
    "quads.js",
    "snow.js", "grid.js", "relief.js", "groove.js", "sledge.js", "skier.js", "skis.js", "labels.js", "landmarks.js",
    "force_arrows.js", "plume.js", "cameras.js", "sharpness.js", "controls.js", "mini_map.js", "takeaway.js",
    "gap.js",
    "stage.js", "replay.js",
)  # fmt: skip
"""Scripts, each one before those that import it."""
STYLE: Final = "replay.css"
_PACKAGE: Final = "skisnow.replay"
_ENDS_A_SCRIPT: Final = ("</script", "<!--")
_SAID: Final = re.compile(r'\bsaid\("([^"]+)"')
"""Pattern of a translated text in a script."""


def write_replay(
    run: Run | Replay | str | Path,
    path: str | Path,
    *,
    ghost: Run | Replay | str | Path | None = None,
    title: str | None = None,
    language: str = ENGLISH,
) -> Path:
    """Write a replay as one HTML file that opens without a server and without network.

    run: a run, its replay, or its folder or file.
    path: path of the HTML file; an existing file is replaced.
    ghost: second run, shown translucent at the same times.
    title: title for the reader (default: the folder's name, or "A simulated run").
    language: language of the page (en, de).
    Returns: path of the file.
    Raises ParameterError: a folder has no run that can be shown, or the language is unknown.
    Raises OutputError: the file cannot be written.
    """
    require_language(language)
    shown = _make_replay(run, title)
    write_file(path, replay_page(shown, None if ghost is None else _make_replay(ghost), language=language))
    return Path(path)


def _make_replay(run: Run | Replay | str | Path, title: str | None = None) -> Replay:
    """Replay of a run, a run file or a replay; rejects a title for a replay, which has its own."""
    if isinstance(run, Replay):
        if title is not None:
            raise ParameterError("a replay has its own title: give it to replay_of_run or replay_of_file").tag(
                "not_together"
            )
        return run
    if isinstance(run, Run):
        return replay_of_run(run) if title is None else replay_of_run(run, title=title)
    return replay_of_file(run, title=title)


def replay_page(run: Replay, ghost: Replay | None = None, *, language: str = ENGLISH) -> str:
    """HTML of a replay in a language, with a second run if one is given."""
    named = {"run": run} if ghost is None else {"run": run, "ghost": ghost}
    content = {name: replay_bytes(in_language(replay, language)) for name, replay in named.items()}
    return page_template("replay.html").render(
        title=run.title,
        language=language,
        said=translations(language).gettext,
        words=page_words(language),
        css=Markup(static_text(STYLE)),
        runs=[{"id": name, "base64": base64.b64encode(data).decode()} for name, data in content.items()],
        modules=[{"name": name, "text": _script_text(name)} for name in MODULES],
    )


def page_template(name: str) -> Template:
    """Template of a page with a replay by its file name; text from users is escaped in it."""
    environment = Environment(loader=PackageLoader(_PACKAGE, "static"), autoescape=True, undefined=StrictUndefined)
    return environment.get_template(name)


@cache
def page_words(language: str) -> dict[str, str]:
    """Translation of each text in the scripts of the page by its English text; empty for English."""
    if language == ENGLISH:
        return {}
    texts = {text for name in MODULES for text in _SAID.findall(static_text(name))}
    return {text: translations(language).gettext(text) for text in sorted(texts)}


def in_language(run: Replay, language: str) -> Replay:
    """Copy of a replay whose facts, the texts shown with it, are in a language."""
    facts = ((translated(name, language), translated(text, language)) for name, text in run.facts)
    return replace(run, facts=tuple(facts))


def static_text(name: str) -> str:
    """Content of a script or style sheet of the replay page by its file name."""
    return files(_PACKAGE).joinpath("static", name).read_text(encoding="utf-8")


def _script_text(name: str) -> Any:
    """Text of a script for a page, marked as safe; RuntimeError if it contains the end of a script."""
    text = static_text(name)
    if any(words in text for words in _ENDS_A_SCRIPT):
        raise RuntimeError(f"{name} cannot be put into a page: it has {' or '.join(_ENDS_A_SCRIPT)} in it")
    return Markup(text)


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
THICKEST, THINNEST = 0.018, 0.006
"""Thickness (m) of a ski under the boot and at its ends: drawn, not computed with."""


def drawn_thickness(station: FloatArray) -> FloatArray:
    """Thickness (m) at stations (m), tip to tail: a core that thins to both ends.

    >>> drawn_thickness(np.array([0.9, 0.0, -0.8])).round(4).tolist()
    [0.006, 0.018, 0.006]
    """
    reach = np.where(station >= 0.0, station[0], -station[-1])
    return np.asarray(THINNEST + (THICKEST - THINNEST) * (1.0 - np.minimum(1.0, np.abs(station) / reach) ** 1.5))


def replay_bytes(replay: Replay) -> bytes:
    """Bytes of a replay as the page reads it: a header in JSON, then the arrays.

    A run of 5 s of two skis with 42 stations at 100 moments a second is 0.5 MB: two thirds along the skis, a third of
    groove.
    """
    arrays, described, at = [], {}, 0
    for name, values in _arrays_by_name(_thin_replay(replay)).items():
        content, description = _pack_array(*ARRAY_TYPES[name], values)
        described[name] = description | {"start": at}
        arrays.append(content)
        at += len(content)
    header = json.dumps(_head(replay) | {"arrays": described}, ensure_ascii=False, allow_nan=False).encode("utf-8")
    header += b" " * (-len(header) % 4)
    return b"".join([MAGIC, struct.pack("<I", len(header)), header, *arrays])


def _thin_replay(replay: Replay) -> Replay:
    """Replay with at most `MOST_FRAMES_PER_SECOND` moments per second, including the first and the last."""
    number = len(replay.time)
    duration = float(replay.time[-1] - replay.time[0])
    step = max(1, round((number - 1) / max(duration * MOST_FRAMES_PER_SECOND, 1.0))) if number > 1 else 1
    if step == 1:
        return replay
    moments = np.unique(np.append(np.arange(0, number, step), number - 1))

    def select(part: _Part, *names: str) -> _Part:
        return replace(part, **{name: getattr(part, name)[moments] for name in names})

    boots, skier = replay.skis.boots, replay.skier
    skis = replace(select(replay.skis, *_SKI_HISTORIES), boots=boots and select(boots, "place", "attitude"))
    return replace(select(replay, *_MOTION), skis=skis, skier=skier and select(skier, "joints"))


def _arrays_by_name(replay: Replay) -> dict[str, FloatArray]:
    """All arrays of a replay as floats by their name in the page; missing ones are left out."""
    skis, skier = replay.skis, replay.skier
    arrays: dict[str, Any] = {name: getattr(replay, name) for name in (*_MOTION, "profile")}
    arrays |= _arrays_of(skis) | {"thickness": drawn_thickness(skis.station)} | _arrays_of(replay.groove, "groove_")
    arrays |= _arrays_of(replay.track, "track_") | {"gate_place": replay.gates, "gate_time": replay.gate_times}
    arrays |= _arrays_of(skis.boots, "boot_") | _arrays_of(replay.terrain, "terrain_") | _arrays_of(skier, "skier_")
    if skier is not None:
        meshes = [part.mesh for part in skier_parts(skier.height)]
        arrays |= {
            "skier_vertices": np.concatenate([mesh.vertices for mesh in meshes]),
            "skier_colours": np.concatenate([mesh.colours for mesh in meshes]),
            # of each part they count from its first vertex
            "skier_triangles": np.concatenate([mesh.pieces for mesh in meshes]).astype(float),
        }
    return {name: np.asarray(values, dtype=float) for name, values in arrays.items() if values is not None}


def _arrays_of(part: _Part | None, prefix: str = "") -> dict[str, FloatArray]:
    """Arrays among the fields of a part of a replay by their names in a file; empty without the part."""
    values = {} if part is None else {field.name: getattr(part, field.name) for field in fields(part)}
    return {f"{prefix}{name}": value for name, value in values.items() if isinstance(value, np.ndarray)}


def _head(replay: Replay) -> dict[str, Any]:
    """Header of a replay's page: values that do not change over time."""
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
    """Header of a skier: height, weight, names of the joints; of each part its joints and the size of its mesh."""
    parts = [
        {"name": part.name, "start": part.start, "end": part.end, "vertices": len(part.mesh.vertices),
         "triangles": len(part.mesh.pieces)}
        for part in skier_parts(skier.height)
    ]  # fmt: skip
    return {"height": skier.height, "weight": skier.weight, "joints": list(JOINTS), "parts": parts}


def _pack_array(kind: str, unit: str, values: FloatArray) -> tuple[bytes, dict[str, Any]]:
    """Bytes, padded to 4, of 32-bit floats or 16-bit steps, with the description to unpack them."""
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
