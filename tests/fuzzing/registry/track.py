"""Readers of tracks, photo cells, gates and lines."""

from functools import cache
from pathlib import Path

from skisnow import read_course, read_track, track_summary
from skisnow.identification.data import read_data
from skisnow.racing.line import read_line
from skisnow.track.course.gates_table import read_gate_gaps

from ..binaries import BINARY, sealed_fit, sealed_nmea, sealed_ubx
from ..markup import XML
from ..reader import Reader, Seal, single_file
from ..texts import TABLE, TEXT, Mutation
from ..track_files import FILES

_FORMATS: dict[str, tuple[tuple[Mutation, ...], Seal | None]] = {
    ".csv": (TABLE, None),
    ".gpx": (XML, None),
    ".fit": (BINARY, sealed_fit),
    ".nmea": (TABLE, sealed_nmea),
    ".ubx": (BINARY, sealed_ubx),
    ".pos": (TEXT, None),
}
_CELLS = b"run,station_m,time_s,time_sd_s\nfirst,20,3.34,0.01\nfirst,40,5.1,0.01\nfirst,60,6.5,0.02\n"
_COURSE = b"gate,x_m,y_m,side,outer_x_m,outer_y_m\n1,10,3,left,10,8\n2,20,-3,right,20,-8\n3,30,3,left,,\n"
_GATES = b"gate,outcome,time_s,x_m,y_m\n1,passed,1.5,10,3\n2,missed,,20,-3\n3,passed,4.5,30,3\n"
_LINE = b"gate,aside_m,along,turning,speed,apex_x_m\n1,0.8,0.5,0.6,1,10\n2,0.9,0.4,0.5,1,20\n3,0.8,0.5,0.6,1,30\n"
_WAYPOINTS = b"""<?xml version="1.0" encoding="UTF-8"?>
<gpx version="1.1" creator="x" xmlns="http://www.topografix.com/GPX/1/1">
<wpt lat="47.1" lon="11.3"><ele>2000</ele><name>1</name><type>left</type></wpt>
<wpt lat="47.0999" lon="11.3001"><ele>1998</ele><name>2</name><desc>right</desc></wpt>
<wpt lat="47.0998" lon="11.3"><name>3 left</name></wpt>
</gpx>
"""


def _summarised(path: Path) -> object:
    return track_summary(read_track(path))


def _track(name: str) -> Reader:
    mutations, seal = _FORMATS[Path(name).suffix]
    return Reader(
        name=f"track {name}",
        target=name,
        files=lambda: {name: FILES[name]},
        read=lambda folder: _summarised(folder / name),
        mutations=mutations,
        covers=("track.read:_read_bytes", f"track.readers.{_module(name)}"),
        seal=seal,
    )


def _module(name: str) -> str:
    kind = {".csv": "table", ".pos": "rtklib"}.get(Path(name).suffix, Path(name).suffix[1:])
    return f"{'binary' if kind in ('fit', 'ubx') else kind}:read_{kind}"


@cache
def _course_folder() -> dict[str, bytes]:
    return {"course.csv": _COURSE, "line.csv": _LINE, "course.gpx": _WAYPOINTS}


def _read_line(folder: Path) -> object:
    return read_line(folder / "line.csv", read_course(folder / "course.csv"), (0.0, 0.0))


_DATA = ("identification.data:_head", "identification.data_tables:read_photo_cells")
READERS = (
    *map(_track, FILES),
    single_file("photo cells", _CELLS, read_data, TABLE, *_DATA, target="cells.csv"),
    single_file(
        "course.csv", _course_folder, lambda path: repr(read_course(path)), TABLE,
        "track.course.course_file:read_course", "_support.spreadsheet_text:csv_rows",
    ),
    single_file(
        "course.gpx", _course_folder, lambda path: repr(read_course(path)), XML,
        "track.course.course_file:read_waypoints",
    ),
    Reader(
        name="line.csv", target="line.csv", files=_course_folder, read=_read_line, mutations=TABLE,
        covers=("racing.line:read_line",),
    ),
    Reader(
        name="gates.csv", target="one/gates.csv", files=lambda: {"one/gates.csv": _GATES, "other/gates.csv": _GATES},
        read=lambda folder: read_gate_gaps(folder / "one", folder / "other"), mutations=TABLE,
        covers=("track.course.gates_table:_gate_rows",),
    ),
)  # fmt: skip
