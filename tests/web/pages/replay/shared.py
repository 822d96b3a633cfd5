"""What the tests of this room share."""

from __future__ import annotations

import io
import math
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skisnow.web.replay.tracks import Placing, TrackFolders

if TYPE_CHECKING:
    pass

TRACK = b"time_s,x_m,y_m,z_m\n0,1,2,0.1\n1,4,6,0.2\n"
EARTH = 6_371_000.0  # m


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


def gpx(points: list[tuple[float, float]]) -> bytes:
    """Metres east and north of a point at 47° N, a second apart."""
    lines = []
    for second, (east, north) in enumerate(points):
        latitude = 47.0 + math.degrees(north / EARTH)
        longitude = 11.0 + math.degrees(east / (EARTH * math.cos(math.radians(47.0))))
        time = f"2026-02-01T10:00:{second:02d}Z"
        lines.append(f'<trkpt lat="{latitude:.9f}" lon="{longitude:.9f}"><time>{time}</time></trkpt>')
    text = f"<trk><trkseg>{''.join(lines)}</trkseg></trk>"
    return f'<gpx version="1.1" creator="test" xmlns="http://www.topografix.com/GPX/1/1">{text}</gpx>'.encode()
