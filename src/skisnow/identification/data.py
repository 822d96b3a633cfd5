"""Data of an identification: read from files, moved to the slope frame, and checked."""

from __future__ import annotations

import difflib
import hashlib
import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path
from typing import Any, Final, TypeAlias

import numpy as np

from .._support.arrays import content_bytes
from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.spreadsheet_text import encoding_of, most_frequent_separator, named_separator
from .._support.units import DEGREE
from .._support.user_files.text_files import is_file
from ..parameters import build_declared, checked_table, suggest_and_list
from ..scenario import Plane, ScenarioFile
from ..scenario.identify_section import Site
from ..scenario.keys import EACH, SCENARIO_KEYS, free_key
from ..scenario.reading import input_files
from ..scenario.resolution import ScenarioInput
from ..track.projection import GeodeticPoint, east_north_up
from ..track.readers.table import GEODETIC, LOCAL, TIMES
from ..track.slope_frame import in_slope_frame
from ..track.track import Track
from .data_tables import CELL_COLUMNS, CELL_SPREAD, PhotoCells, read_photo_cells
from .problem import START
from .track_positions import TrackPoints, first_motion, require_near, track_points

_HEAD: Final = 4096
Data: TypeAlias = Track | PhotoCells
SNOW_NUMBERS: Final = ("snow.H_V_N_per_mm3", "snow.S_f_N_per_mm2")


def read_data(path: str | Path) -> Data:
    """Read photo-cell times, by their columns, or else a track.

    A table with time, x and y, or time, latitude and longitude, is a track unless it has all columns of photo cells.
    """
    path = Path(path)
    if not is_file(path):
        raise ParameterError("{path} cannot be read: the file does not exist. Check the path").tag("no_file", path=path)
    if path.suffix.lower() in (".csv", ".txt", ".tsv"):
        head = _head(path)
        is_track = bool(head & set(TIMES)) and any(set(place[:2]) <= head for place in (LOCAL, GEODETIC))
        if set(CELL_COLUMNS) <= head or ("station_m" in head and not is_track):
            _reject_misspelt(path, head)
            return read_photo_cells(path)
    from ..track.read import read_track

    return read_track(path)


def _reject_misspelt(path: Path, head: set[str]) -> None:
    """Reject a column of photo cells whose name is similar to that of a missing one: it would not be read."""
    columns = (*CELL_COLUMNS, CELL_SPREAD)
    absent = [name for name in columns if name not in head]
    for name in sorted(head.difference(columns)):
        if similar := difflib.get_close_matches(name.lower(), absent, n=1, cutoff=0.75):
            raise ParameterError(
                "{path}: unknown column {column}. Did you mean {similar}? Rename it, or give it a different name if it "
                "is not to be read"
            ).tag("misspelled_column", path=path, column=name, similar=similar[0])


def data_description(data: Data) -> Message:
    """Kind and size of the data recognised in a file, in words."""
    if isinstance(data, PhotoCells):
        return Message("photo-cell times (runs: {count})", count=len(data.runs))
    return Message("a track (points: {count})", count=len(data))


def _head(path: Path) -> set[str]:
    """Names of the columns in the header of a table; the file is not validated."""
    with path.open("rb") as stream:
        head = stream.read(_HEAD)
    text = head.decode(encoding_of(head)[0], errors="replace").lstrip("\ufeff")
    named = named_separator(text)
    lines = [line for line in text.splitlines()[1 if named else 0 :] if line.strip(" ,;\t")]
    separator = named or most_frequent_separator(text)
    return {cell.strip(' "') for cell in lines[0].split(separator)} if lines else set()


def fingerprint(scenario_input: ScenarioInput, tracks: Sequence[TrackPoints]) -> str:
    """SHA-256 of the inputs of a simulation: scenario, files that it names, times of the tracks, version of skisnow.

    Measured places are not included, because the simulated runs do not depend on them.
    """
    layers = json.dumps([sorted(layer.values.items()) for layer in scenario_input.layers], default=str)
    digest = hashlib.sha256(f"{version('skisnow')} {layers}".encode())
    if scenario_input.base is not None:
        for piece in content_bytes(scenario_input.base):
            digest.update(piece)
    for path in input_files(scenario_input):
        if path != scenario_input.file:
            digest.update(path.read_bytes())
    for track in tracks:
        digest.update(track.time.tobytes())
    return digest.hexdigest()


@dataclass(frozen=True, slots=True)
class IdentificationData:
    """The data of an identification by kind; names of runs are unique.

    tracks, cells: measured data.
    starts: values of keys for single runs, by run, from ``[identify.runs."NAME"]``.
    fixed: values of keys in every simulated run.
    first_motions: if there are several runs: values of the start keys, by track, estimated from its first points.
    descriptions: name and recognised kind of each datum.
    warnings, methods: warnings about the data, and sentences on how they were transformed.
    """

    tracks: tuple[TrackPoints, ...]
    cells: tuple[PhotoCells, ...]
    starts: Mapping[str, Mapping[str, float]]
    fixed: Mapping[str, float]
    first_motions: Mapping[str, Mapping[str, float]]
    descriptions: tuple[tuple[str, Message], ...]
    warnings: tuple[Message, ...]
    methods: tuple[Message, ...]

    @property
    def runs(self) -> tuple[str, ...]:
        """Names of all runs."""
        return tuple(track.name for track in self.tracks) + tuple(run.name for cell in self.cells for run in cell.runs)


def collect_data(
    scenario_input: ScenarioInput, scenario: ScenarioFile, data: Sequence[Data | str | Path], keys: Sequence[str]
) -> IdentificationData:
    """Read the files, move tracks into the slope's frame, and check the data against the scenario."""
    if not data:
        raise ParameterError("there are no data: name one or several files").tag("no_data")
    _require_different([datum for datum in data if isinstance(datum, str | Path)])
    measurements = [read_data(datum) if isinstance(datum, str | Path) else datum for datum in data]
    names: set[str] = set()
    methods: list[Message] = []
    tracks = []
    for measurement in measurements:
        if isinstance(measurement, Track):
            track, sentences = move_to_scenario_frame(measurement, scenario, scenario_input.identify.get("site"))
            methods += sentences
            tracks.append(track_points(replace(track, name=_unique_name(measurement.name, names))))
    cells = tuple(
        replace(file, runs=tuple(replace(run, name=_unique_name(run.name, names)) for run in file.runs))
        for file in measurements
        if isinstance(file, PhotoCells)
    )
    runs = [track.name for track in tracks] + [run.name for file in cells for run in file.runs]
    starts = _run_starts(scenario_input.identify.get("runs", {}), runs, keys)
    own = {key.partition("@")[0] for key in keys}
    start_is_free = {"start.x_m", "start.y_m"} <= own
    begins = [{**scenario.values, **starts.get(track.name, {})} for track in tracks]
    warnings = [
        require_near(track, (float(begin["start.x_m"]), float(begin["start.y_m"])), start_is_free=start_is_free)
        for track, begin in zip(tracks, begins, strict=True)
    ]
    if _FROM_FIRST_POINT in methods and not start_is_free:
        warnings.append(_START_OF_FIRST_POINT)
    snow = set(SNOW_NUMBERS) & own.union(*starts.values())
    return IdentificationData(
        tracks=tuple(tracks),
        cells=cells,
        starts=starts,
        fixed={key: float(scenario.values[key]) for key in SNOW_NUMBERS} if snow else {},
        first_motions={track.name: first_motion(track) for track in tracks} if len(runs) > 1 else {},
        descriptions=tuple(
            (str(datum) if isinstance(datum, str | Path) else datum.name, data_description(measurement))
            for datum, measurement in zip(data, measurements, strict=True)
        ),
        warnings=tuple(text for text in warnings if text),
        methods=tuple(dict.fromkeys(methods)),
    )


def start_values(scenario: ScenarioFile, data: IdentificationData, listed: Iterable[str]) -> dict[str, Any]:
    """Values at which the search begins: the scenario's, and for several runs those of each run's start as KEY@RUN."""
    values = dict(scenario.values)
    listed_keys = set(listed)
    for run in data.runs:
        first_motion = {key: value for key, value in data.first_motions.get(run, {}).items() if key not in listed_keys}
        values |= {f"{key}@{run}": value for key, value in {**first_motion, **data.starts.get(run, {})}.items()}
    if len(data.runs) == 1:
        values |= data.starts.get(data.runs[0], {})
    return values


def _unique_name(name: str, taken: set[str]) -> str:
    """Name of a run, with a number appended if it is in `taken`; the name is added to `taken`."""
    clean = name.replace("@", "_")
    unique, number = clean, 2
    while unique in taken:
        unique, number = f"{clean}-{number}", number + 1
    taken.add(unique)
    return unique


def _require_different(paths: Sequence[str | Path]) -> None:
    """Reject two files with the same content: their data would count twice, and intervals would be too narrow."""
    seen: dict[bytes, str | Path] = {}
    for path in paths:
        if not is_file(path):
            continue  # its reader reports it
        content = hashlib.sha256(Path(path).read_bytes()).digest()
        if content in seen:
            raise ParameterError("{path} has the same content as {other}. Name each file once").tag(
                "same_file", path=path, other=seen[content]
            )
        seen[content] = path


def _run_starts(
    table: Mapping[str, Mapping[str, object]], runs: Sequence[str], free: Sequence[str]
) -> dict[str, dict[str, Any]]:
    """Values of single runs by full key; rejects an unknown run, and a key that is free with one value for all runs.

    Tables and keys were checked when the scenario was read.
    """
    starts: dict[str, dict[str, Any]] = {}
    for run, entries in table.items():
        if run not in runs:
            raise ParameterError('[identify.runs."{run}"]: unknown run. {allowed}').tag(
                "unknown_name", run=run, allowed=suggest_and_list(run, runs)
            )
        keys = {free_key(word): value for word, value in entries.items()}
        starts[run] = {key: SCENARIO_KEYS[key].in_range(value) for key, value in keys.items()}
        for key in keys:
            if key in free and not key.startswith(START):
                raise ParameterError(
                    '[identify.runs."{run}"] states {key}, but one value of {key} is free for all runs. Free '
                    "{key}@{each} instead, or remove it from the table"
                ).tag("value_of_free_key", run=run, key=key, each=EACH)
    return starts


FARTHEST: Final = 50_000.0
"""Largest distance (m) of a track from the site; beyond it the track is from another place and the earth not flat."""


def move_to_scenario_frame(
    track: Track, scenario: ScenarioFile, site: Mapping[str, Any] | None
) -> tuple[Track, list[Message]]:
    """Move a track to the slope's frame (x down the fall line, y to the left).

    track: track in any frame; a track in local metres is assumed to be in the slope's frame already.
    site: table ``[identify.site]`` with the place of the slope (optional).
    Returns: the moved track, and sentences on the method.
    """
    if track.axes != "east_north_up":
        return track, []
    if site is None:
        raise ParameterError(
            "{name} is in latitude and longitude, but the direction of the slope is missing. Fix: give "
            "--fall-line-azimuth-deg, the compass direction in which it falls, or write [identify.site] with "
            "fall_line_azimuth_deg, and latitude_deg and longitude_deg of x = y = 0; without these two the track's "
            "first point is used as the scenario's start"
        ).tag("site_missing", name=track.name)
    parsed = _read_site(site)
    plane = scenario.scenario.slope if isinstance(scenario.scenario.slope, Plane) else None
    if parsed.latitude_deg is not None and parsed.longitude_deg is not None and track.origin is not None:
        height = track.origin.height if parsed.height_m is None else parsed.height_m
        point = GeodeticPoint(parsed.latitude_deg, parsed.longitude_deg, height)
        coordinates = np.array([[point.latitude_deg, point.longitude_deg, point.height]])
        origin = east_north_up(coordinates, origin=track.origin)[0]
        distance = math.hypot(origin[0], origin[1])
        if distance > FARTHEST:
            raise ParameterError(
                "{name} is {distance:.4g} km from the site of [identify.site]. It is from another place, or latitude "
                "and longitude are swapped"
            ).tag("far_from_site", name=track.name, distance=distance / 1000.0)
        beginning = np.zeros(3)
        method = Message(
            "tracks are counted from the site at latitude {latitude:.12g}°, longitude {longitude:.12g}°, height "
            "{height:.9g} m",
            latitude=point.latitude_deg,
            longitude=point.longitude_deg,
            height=point.height,
        )
    else:
        origin = np.nan_to_num(track.place[int(np.argmax(track.usable))])
        start = scenario.scenario.start
        beginning, method = np.array([start.x, start.y, 0.0]), _FROM_FIRST_POINT
    turned = in_slope_frame(
        track,
        fall_line_azimuth=parsed.fall_line_azimuth_deg * DEGREE,
        slope_angle=None if plane is None else plane.angle,
        origin=origin,
        missing_height="on_slope",
    )
    return replace(turned, place=turned.place + beginning), [method]


_FROM_FIRST_POINT: Final = Message(
    "the first point of each track is taken as the scenario's start; its error is in all points"
)
_START_OF_FIRST_POINT: Final = Message(
    "The first point of each track is taken as the scenario's start. Its error is in all points, and no interval "
    "counts it. Add start.x,start.y to --free, or give the place of the slope in [identify.site]."
)


def _read_site(site: Mapping[str, Any]) -> Site:
    """Site of the table [identify.site]; latitude and longitude must be given together."""
    parsed = build_declared(Site, checked_table(Site, site, "[identify.site]"))
    if (parsed.latitude_deg is None) != (parsed.longitude_deg is None):
        raise ParameterError("[identify.site]: latitude_deg and longitude_deg go together; one is missing").tag(
            "half_place"
        )
    return parsed
