"""Data of an identification: read from files, moved into the frame of the scenario, and checked."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Mapping, Sequence, Set
from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path
from typing import Any, Final, TypeAlias

from .._support.content import pieces_of
from .._support.errors import ParameterError
from .._support.spreadsheet_text import encoding_of, most_frequent_separator, named_separator
from .._support.user_files import is_file
from ..parameters import nearest
from ..scenario import ScenarioFile
from ..scenario.keys import EACH, SCENARIO_KEYS, free_key
from ..scenario.reading import input_files
from ..scenario.resolution import ScenarioInput
from ..track.readers.table import GEODETIC, LOCAL, TIMES
from ..track.track import Track
from .data_tables import (
    CELL_COLUMNS,
    GROOVE_COLUMNS,
    MeasuredGrooves,
    PhotoCells,
    grooves_of,
    photo_cells_of,
    read_table,
)
from .problem import START
from .track_frame import in_scenario_frame
from .track_positions import Measured, first_motion, measured, require_near

_HEAD: Final = 4096
_OF_CAMPAIGN: Final = {"experiment", "load_N", "moment_Nm", "lever_arm_mm"}
"""Columns of the campaign's tables that have a depth, as measured grooves do."""
Data: TypeAlias = Track | PhotoCells | MeasuredGrooves
SNOW_NUMBERS: Final = ("snow.H_V_N_per_mm3", "snow.S_f_N_per_mm2")


def read_data(path: str | Path) -> Data:
    """Read photo-cell times or measured grooves, by their columns, or else a track.

    A table with time, x and y, or time, latitude and longitude, is a track, whatever else it has: a run's own track.csv
    has the column ``turn_radius_m``, as measured grooves do.

    Raises
    ------
    ParameterError, FieldDataError
        The file cannot be read, or something in it is wrong; place and value are named.
    """
    path = Path(path)
    if not is_file(path):
        raise ParameterError(f"{path} cannot be read: there is no such file. Check the path")
    if path.suffix.lower() in (".csv", ".txt", ".tsv"):
        head = _head(path)
        if set(CELL_COLUMNS) <= head or ("station_m" in head and not _is_track(head)):
            return photo_cells_of(read_table(path))
        if head & set(GROOVE_COLUMNS) and not _is_track(head):
            if of_campaign := sorted(head & _OF_CAMPAIGN):
                raise ParameterError(
                    f"{path} has a column {of_campaign[0]}: it is a table of a campaign, no measured grooves. "
                    "Give its folder to `skisnow analyse`, and results.json as snow.results"
                )
            return grooves_of(read_table(path))
    from ..track.read import read_track

    return read_track(path)


def _is_track(head: set[str]) -> bool:
    return bool(head & set(TIMES)) and any(set(place[:2]) <= head for place in (LOCAL, GEODETIC))


def taken_for(data: Data) -> str:
    """Kind and size of the data recognised in a file, in words."""
    if isinstance(data, PhotoCells):
        return f"photo-cell times (runs: {len(data.runs)})"
    if isinstance(data, MeasuredGrooves):
        return f"measured grooves (places: {len(data)})"
    return f"a track (points: {len(data)})"


def _head(path: Path) -> set[str]:
    """Names of the columns; the rest of the file, and what is wrong with it, is for its reader."""
    with path.open("rb") as stream:
        head = stream.read(_HEAD)
    text = head.decode(encoding_of(head)[0], errors="replace").lstrip("\ufeff")
    named = named_separator(text)
    lines = [line for line in text.splitlines()[1 if named else 0 :] if line.strip(" ,;\t")]
    separator = named or most_frequent_separator(text)
    return {cell.strip(' "') for cell in lines[0].split(separator)} if lines else set()


def fingerprint(scenario_input: ScenarioInput, tracks: Sequence[Measured]) -> str:
    """The same for the same scenario, files that it names, times of the tracks, and version of skisnow.

    Places do not count: a simulation does not know what it is held against.
    """
    layers = json.dumps([sorted(layer.values.items()) for layer in scenario_input.layers], default=str)
    digest = hashlib.sha256(f"{version('skisnow')} {layers}".encode())
    if scenario_input.base is not None:
        for piece in pieces_of(scenario_input.base):
            digest.update(piece)
    for path in input_files(scenario_input):
        if path != scenario_input.file:
            digest.update(path.read_bytes())
    for track in tracks:
        digest.update(track.time.tobytes())
    return digest.hexdigest()


@dataclass(frozen=True, slots=True)
class Collected:
    """The data of an identification by kind, with names of runs that are all different.

    Attributes
    ----------
    tracks, cells, grooves
        Measured data.
    starts
        Values of keys that a run has for itself, by run, from ``[identify.runs."NAME"]``.
    fixed
        Values of keys in every simulated run.
    first_motions
        Start keys as the first points of each track show them, where there are several.
    taken
        The name of each datum, and what it was taken for.
    warnings, methods
        About the data.
    """

    tracks: tuple[Measured, ...]
    cells: tuple[PhotoCells, ...]
    grooves: tuple[MeasuredGrooves, ...]
    starts: Mapping[str, Mapping[str, float]]
    fixed: Mapping[str, float]
    first_motions: Mapping[str, Mapping[str, float]]
    taken: tuple[tuple[str, str], ...]
    warnings: tuple[str, ...]
    methods: tuple[str, ...]

    @property
    def runs(self) -> tuple[str, ...]:
        """Names of all runs."""
        return tuple(track.name for track in self.tracks) + tuple(run.name for cell in self.cells for run in cell.runs)


def collected(
    scenario_input: ScenarioInput, scenario: ScenarioFile, data: Sequence[Data | str | Path], keys: Sequence[str]
) -> Collected:
    """Read what are paths, turn tracks into the slope's frame, and refuse what does not go with the scenario.

    Raises
    ------
    ParameterError, FieldDataError
        A file cannot be used; a track is of another place; a run is named that is not there.
    """
    if not data:
        raise ParameterError("there are no data: name one or several files")
    _require_different([each for each in data if isinstance(each, str | Path)])
    read = [read_data(each) if isinstance(each, str | Path) else each for each in data]
    names = _Names()
    methods: list[str] = []
    tracks = []
    for each in (each for each in read if isinstance(each, Track)):
        track, how = in_scenario_frame(each, scenario, scenario_input.identify.get("site"))
        methods += how
        tracks.append(measured(replace(track, name=names.of(each.name))))
    cells = tuple(
        replace(each, runs=tuple(replace(run, name=names.of(run.name)) for run in each.runs))
        for each in read
        if isinstance(each, PhotoCells)
    )
    runs = [each.name for each in tracks] + [run.name for cell in cells for run in cell.runs]
    starts = _starts(scenario_input.identify.get("runs", {}), runs)
    _require_not_free(starts, keys)
    own = {key.partition("@")[0] for key in keys}
    warnings = [_near(track, scenario, starts, own) for track in tracks]
    snow = set(SNOW_NUMBERS) & own.union(*starts.values())
    return Collected(
        tracks=tuple(tracks),
        cells=cells,
        grooves=tuple(each for each in read if isinstance(each, MeasuredGrooves)),
        starts=starts,
        fixed={key: float(scenario.values[key]) for key in SNOW_NUMBERS} if snow else {},
        first_motions={track.name: first_motion(track) for track in tracks} if len(runs) > 1 else {},
        taken=tuple((_file_name(each, kind), taken_for(kind)) for each, kind in zip(data, read, strict=True)),
        warnings=tuple(text for text in warnings if text),
        methods=tuple(dict.fromkeys(methods)),
    )


def _file_name(given: Data | str | Path, read: Data) -> str:
    return str(given) if isinstance(given, str | Path) else read.name


def values_to_begin_with(scenario: ScenarioFile, data: Collected, given: Iterable[str]) -> dict[str, Any]:
    """The scenario's values, and for runs with a start of their own what is said or seen of it."""
    found = dict(scenario.values)
    said = set(given)
    for run in data.runs:
        own = {key: value for key, value in data.first_motions.get(run, {}).items() if key not in said}
        found |= {f"{key}@{run}": value for key, value in {**own, **data.starts.get(run, {})}.items()}
    if len(data.runs) == 1:
        found |= data.starts.get(data.runs[0], {})
    return found


class _Names:
    """Unique names of the runs."""

    def __init__(self) -> None:
        self._taken: set[str] = set()

    def of(self, name: str) -> str:
        """The name, with a number behind it where it is taken."""
        clean = name.replace("@", "_")
        free, number = clean, 2
        while free in self._taken:
            free, number = f"{clean}-{number}", number + 1
        self._taken.add(free)
        return free


def _require_different(paths: Sequence[str | Path]) -> None:
    """Refuse a file that is given twice: its data would count double, and every interval be too narrow."""
    seen: dict[bytes, str | Path] = {}
    for path in paths:
        if not is_file(path):
            continue  # said by its reader
        content = hashlib.sha256(Path(path).read_bytes()).digest()
        if content in seen:
            raise ParameterError(f"{path} holds the same as {seen[content]}: what was measured once counts once")
        seen[content] = path


def _starts(table: object, runs: Sequence[str]) -> dict[str, dict[str, float]]:
    if not isinstance(table, dict):
        raise ParameterError(f'identify.runs is {table!r}; write [identify.runs."NAME"] with keys below it')
    found = {}
    for run, entries in table.items():
        if run not in runs:
            raise ParameterError(f'[identify.runs."{run}"]: there is no such run. {nearest(run, runs)}')
        if not isinstance(entries, dict):
            raise ParameterError(f'identify.runs."{run}" is {entries!r}; it must be a table of keys')
        found[run] = dict(_own(run, word, value) for word, value in entries.items())
    return found


def _own(run: str, word: str, value: object) -> tuple[str, float]:
    try:
        key = free_key(word)
    except ParameterError as error:
        raise ParameterError(f'[identify.runs."{run}"]: {str(error).removeprefix("--free: ")}') from None
    number = SCENARIO_KEYS[key].in_range(value)
    if not isinstance(number, float):
        raise ParameterError(f'[identify.runs."{run}"]: {word} is {value!r}; it must be a number')
    return key, number


def _near(
    track: Measured, scenario: ScenarioFile, starts: Mapping[str, Mapping[str, float]], keys: Set[str]
) -> str | None:
    own = {**scenario.values, **starts.get(track.name, {})}
    free = {"start.x_m", "start.y_m"} <= keys
    return require_near(track, (float(own["start.x_m"]), float(own["start.y_m"])), start_is_free=free)


def _require_not_free(own: Mapping[str, Mapping[str, float]], keys: Sequence[str]) -> None:
    """A value of one run cannot be known while one for all runs is looked for."""
    for run, values in own.items():
        for key in values:
            if key in keys and not key.startswith(START):
                raise ParameterError(
                    f'[identify.runs."{run}"] gives {key}, which is looked for in all runs alike. Look for '
                    f"{key}@{EACH}, or take it out of the table"
                )
