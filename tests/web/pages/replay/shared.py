"""Helpers that the tests of this folder share."""

from __future__ import annotations

import io
import os
from pathlib import Path
from typing import Any

from skisnow.web.lab_tracks import Placing, TrackFolders

TRACK = b"time_s,x_m,y_m,z_m\n0,1,2,0.1\n1,4,6,0.2\n"


def keep(runs: Path, name: str, files: dict[str, bytes], *, when: int = 1_000_000_000) -> Path:
    """A run in the lab's folder."""
    place = runs / name
    place.mkdir(parents=True)
    for file, content in files.items():
        (place / file).write_bytes(content)
    os.utime(place / "run.nc", (when, when))
    return place


def keep_track(runs: Path, called: str = "measured.csv", **placed: Any) -> str:
    return TrackFolders(runs).keep(io.BytesIO(TRACK), Placing(called, **placed))[0]
