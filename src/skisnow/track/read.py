"""Reader of tracks from files of all formats, which are recognised by their content."""

from __future__ import annotations

import re
import stat
from pathlib import Path
from typing import Final, Literal, TypeAlias

from .._support.messages import Message
from .projection import GeodeticPoint
from .readers.binary import SYNC, has_places, read_fit, read_ubx
from .readers.conversion import build_track
from .readers.gpx import read_gpx
from .readers.nmea import SENTENCE, read_nmea
from .readers.recording import Recording, track_error
from .readers.rtklib import HEADER, read_rtklib
from .readers.table import read_table
from .readers.text import decode_text
from .track import Track

TrackFormat: TypeAlias = Literal["csv", "gpx", "tcx", "fit", "nmea", "ubx", "rtklib"]
SUFFIXES: Final[dict[str, TrackFormat]] = {
    ".gpx": "gpx",
    ".tcx": "tcx",
    ".fit": "fit",
    ".ubx": "ubx",
    ".nmea": "nmea",
    ".nma": "nmea",
    ".pos": "rtklib",
    ".csv": "csv",
}
_BINARY_READERS: Final = {"fit": read_fit, "ubx": read_ubx, "nmea": read_nmea}
_TEXT_READERS: Final = {"gpx": read_gpx, "tcx": read_gpx, "rtklib": read_rtklib, "csv": read_table}
_HEAD: Final = 1 << 16
_PACKED: Final = (b"PK\x03\x04", b"\x1f\x8b")
_OTHER: Final = re.compile(rb"(?:\xef\xbb\xbf)?\s*(?:<|\{|A\w{3,}[^,;\t\n]*\r?\nH[FOP])")
"""Begin of a file in XML (KML) or JSON, and of a flight recorder's (IGC)."""
_UTF_16: Final = (b"\xff\xfe", b"\xfe\xff")
_UBX_NAVIGATION: Final = SYNC + b"\x01\x07"


def read_track(path: str | Path, *, origin: GeodeticPoint | None = None) -> Track:
    """Read a track: CSV, GPX, TCX, FIT, NMEA, UBX or RTKLIB's ``.pos``, recognised by its content, else by its ending.

    Parameters
    ----------
    path
        The file.
    origin
        Point at which the plane of projection touches the earth and x, y, z are zero (default: the origin in the file,
        else the first point with a fix).

    Returns
    -------
    Track
        The points from the first to the last one with a fix, in the order of the file. Doubtful ones are flagged, and
        records that are not used are counted in `Track.left_out`.

    Raises
    ------
    FieldDataError
        The file cannot be read, is empty or damaged, has an impossible value, no place at all, or times that run
        backwards. The error names file, row, column, value, allowed values and a remedy.

    See Also
    --------
    skisnow.track_summary : distance, speed, runs and turns of a track.
    skisnow.in_slope_frame : a track in the axes of a slope.
    skisnow.compare : distances to a simulated track.

    References
    ----------
    The page docs/files/track.md.
    """
    path = Path(path)
    data = _read_bytes(path)
    return build_track(_read_recording(data, path.name, recognise_format(data, path.suffix)), origin=origin)


def recognise_format(data: bytes, suffix: str) -> TrackFormat:
    """Format of a file by its content, else by its ending, else CSV.

    >>> recognise_format(b"time_s,x_m,y_m", ".txt"), recognise_format(b"$GPGGA,120000.00,", ".log")
    ('csv', 'nmea')
    """
    head = data[:_HEAD]
    signs: tuple[tuple[TrackFormat, object], ...] = (
        ("fit", data[8:12] == b".FIT"),
        ("ubx", _UBX_NAVIGATION in data and (has_places(data) or not SENTENCE.search(data))),
        ("gpx", re.search(rb"<(?:\w+:)?gpx[\s>]", head)),
        ("tcx", b"<TrainingCenterDatabase" in head),
        ("rtklib", HEADER.search(head.decode("latin-1").replace("\r", "\n"))),
        ("nmea", SENTENCE.search(data)),
        ("ubx", head.startswith(SYNC)),
    )
    return next((kind for kind, sign in signs if sign), SUFFIXES.get(suffix.lower(), "csv"))


def _read_bytes(path: Path) -> bytes:
    """Bytes of a file, UTF-16 converted to UTF-8; rejects an empty or unreadable file, a folder or a pipe."""
    try:
        # reading a pipe would block, and a folder cannot be read
        data = path.read_bytes() if stat.S_ISREG(path.stat().st_mode) else None
        reason: str = Message("it is not a plain file")
    except OSError as error:
        data, reason = None, error.strerror or str(error)
    if data is None:
        allowed, action = Message("a plain file that may be read"), Message("Check the path.")
        raise track_error("unreadable_file", str(path), allowed, action, value=reason)
    if not data.strip():
        action = Message("The file is empty; was anything recorded?")
        raise track_error("empty_file", path.name, Message("a track"), action)
    return data.decode("utf-16", errors="replace").encode() if data.startswith(_UTF_16) else data


def _read_recording(data: bytes, name: str, kind: TrackFormat) -> Recording:
    """Recording from the bytes of a file by the reader of its format; rejects packed and unknown files."""
    if kind in _BINARY_READERS:
        return _BINARY_READERS[kind](data, name)
    if data.startswith(_PACKED) or (kind == "csv" and _OTHER.match(data)):
        allowed = Message("CSV, GPX, TCX, FIT, NMEA, UBX or .pos of RTKLIB")
        action = Message("Export the track as GPX, or unpack it.")
        raise track_error("unreadable_file", name, allowed, action, value=data[:16].decode("latin-1"))
    return _TEXT_READERS[kind](decode_text(data, name), name)
