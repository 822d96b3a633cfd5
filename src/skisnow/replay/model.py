"""A moment of a replay as a glTF model in one binary file (GLB): snow, both skis, the skier, the groove so far."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from .._support.staging import write_file
from .glb import Glb
from .meshes import groove_mesh, ski_mesh, snow_mesh, upright
from .replay import SKI_NAMES
from .shape import nearest_frame
from .skier_shapes import skier_mesh

if TYPE_CHECKING:
    from .replay import Replay


def replay_model(replay: Replay, time: float, *, exaggeration: float = 1.0) -> bytes:
    """A GLB file of the moment nearest to a time (s); bending and twist taken `exaggeration` times.

    Notes
    -----
    Metres; y is up as glTF 2.0 wants it, the run's own axes are those of the node ``run`` below. Colours of vertices:
    normal force per length along the skis, depth that stays along the groove, on the same scales as in the picture.
    """
    frame = nearest_frame(replay, time)
    named = {"snow": snow_mesh(replay)}
    for ski, name in enumerate(SKI_NAMES):
        named[f"{name} ski"] = ski_mesh(replay, frame, ski, exaggeration)
    if replay.skier is not None:
        named["skier"] = skier_mesh(replay, frame)
    made = replay.groove.time <= replay.time[frame]
    if made.any():
        named["groove"] = groove_mesh(replay, made)
    model = Glb()
    parts = [model.node(name, mesh=model.mesh(name, mesh)) for name, mesh in named.items()]
    run = model.node("run", rotation=upright(replay.tilt), children=parts)
    return model.finished(replay.title, [run])


def write_replay_model(replay: Replay, path: str | Path, time: float, *, exaggeration: float = 1.0) -> None:
    """Write the model of a moment; see `replay_model`.

    Raises
    ------
    OutputError
        The place cannot be written.
    """
    write_file(path, replay_model(replay, time, exaggeration=exaggeration))
