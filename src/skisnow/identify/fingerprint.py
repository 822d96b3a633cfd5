"""What finished simulations belong to."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Sequence
from dataclasses import fields, is_dataclass
from importlib.metadata import version

import numpy as np

from ..scenario.given import GivenScenario
from ..scenario.reading import files_of
from .track_positions import Measured


def _pieces(thing: object) -> Iterator[bytes]:
    """What an object is made of, down to numbers and texts: the same for the same content."""
    if is_dataclass(thing) and not isinstance(thing, type):
        yield type(thing).__qualname__.encode()
        for each in fields(thing):
            if each.init:
                yield from _pieces(getattr(thing, each.name))
    else:
        yield thing.tobytes() if isinstance(thing, np.ndarray) else repr(thing).encode()


def fingerprint(given: GivenScenario, tracks: Sequence[Measured]) -> str:
    """The same for the same scenario, files that it names, times of the tracks, and version of skisnow.

    Places do not count: a simulation does not know what it is held against.
    """
    values = json.dumps(sorted((name, value) for name, value in given.values.items()), default=str)
    before = " ".join(sorted(given.before_results))
    digest = hashlib.sha256(f"{version('skisnow')} {values} {before}".strip().encode())
    if given.base is not None:
        for piece in _pieces(given.base):
            digest.update(piece)
    for path in files_of(given):
        if path != given.file:
            digest.update(path.read_bytes())
    for track in tracks:
        digest.update(track.time.tobytes())
    return digest.hexdigest()
