"""What finished simulations belong to."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from importlib.metadata import version

from .._support.content import pieces_of
from ..scenario.reading import input_files
from ..scenario.resolution import ScenarioInput
from .track_positions import Measured


def fingerprint(given: ScenarioInput, tracks: Sequence[Measured]) -> str:
    """The same for the same scenario, files that it names, times of the tracks, and version of skisnow.

    Places do not count: a simulation does not know what it is held against.
    """
    layers = json.dumps([sorted(layer.values.items()) for layer in given.layers], default=str)
    digest = hashlib.sha256(f"{version('skisnow')} {layers}".encode())
    if given.base is not None:
        for piece in pieces_of(given.base):
            digest.update(piece)
    for path in input_files(given):
        if path != given.file:
            digest.update(path.read_bytes())
    for track in tracks:
        digest.update(track.time.tobytes())
    return digest.hexdigest()
