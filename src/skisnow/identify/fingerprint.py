"""What finished simulations belong to."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from importlib.metadata import version

from ..content import pieces_of
from ..scenario.given import GivenScenario
from ..scenario.reading import files_of
from .track_positions import Measured


def fingerprint(given: GivenScenario, tracks: Sequence[Measured]) -> str:
    """The same for the same scenario, files that it names, times of the tracks, and version of skisnow.

    Places do not count: a simulation does not know what it is held against.
    """
    values = json.dumps(sorted((name, value) for name, value in given.values.items()), default=str)
    before = " ".join(sorted(given.before_results))
    digest = hashlib.sha256(f"{version('skisnow')} {values} {before}".strip().encode())
    if given.base is not None:
        for piece in pieces_of(given.base):
            digest.update(piece)
    for path in files_of(given):
        if path != given.file:
            digest.update(path.read_bytes())
    for track in tracks:
        digest.update(track.time.tobytes())
    return digest.hexdigest()
