"""From files and a scenario to the data of one identification: frames, starts of runs, what is refused at once."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping, Sequence, Set
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

from .._support.errors import ParameterError
from .._support.user_files import is_file
from ..parameters import nearest
from ..scenario import ScenarioFile
from ..scenario.keys import EACH, SCENARIO_KEYS, free_key
from ..scenario.resolution import ScenarioInput
from ..track.track import Track
from .data import Data, read_data, taken_for
from .measured_grooves import MeasuredGrooves
from .observations import START
from .photo_cells import PhotoCells
from .track_frame import in_scenario_frame
from .track_positions import Measured, first_motion, measured, require_near

SNOW_NUMBERS: Final = ("snow.H_V_N_per_mm3", "snow.S_f_N_per_mm2")


@dataclass(frozen=True, slots=True)
class Collected:
    """The data of an identification by kind, with names of runs that are all different.

    Attributes
    ----------
    tracks, cells, grooves
        What was measured.
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
        return tuple(each.name for each in self.tracks) + tuple(run.name for each in self.cells for run in each.runs)


def collected(
    given: ScenarioInput, asked: ScenarioFile, data: Sequence[Data | str | Path], keys: Sequence[str]
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
        track, how = in_scenario_frame(each, asked, given.identify.get("site"))
        methods += how
        tracks.append(measured(replace(track, name=names.of(each.name))))
    cells = tuple(
        replace(each, runs=tuple(replace(run, name=names.of(run.name)) for run in each.runs))
        for each in read
        if isinstance(each, PhotoCells)
    )
    runs = [each.name for each in tracks] + [run.name for each in cells for run in each.runs]
    starts = _starts(given.identify.get("runs", {}), runs)
    _require_not_free(starts, keys)
    own = {key.partition("@")[0] for key in keys}
    warnings = [_near(track, asked, starts, own) for track in tracks]
    snow = set(SNOW_NUMBERS) & own.union(*starts.values())
    return Collected(
        tracks=tuple(tracks),
        cells=cells,
        grooves=tuple(each for each in read if isinstance(each, MeasuredGrooves)),
        starts=starts,
        fixed={key: float(asked.values[key]) for key in SNOW_NUMBERS} if snow else {},
        first_motions={track.name: first_motion(track) for track in tracks} if len(runs) > 1 else {},
        taken=tuple((_file_name(each, kind), taken_for(kind)) for each, kind in zip(data, read, strict=True)),
        warnings=tuple(text for text in warnings if text),
        methods=tuple(dict.fromkeys(methods)),
    )


def _file_name(given: Data | str | Path, read: Data) -> str:
    return str(given) if isinstance(given, str | Path) else read.name


def values_to_begin_with(asked: ScenarioFile, data: Collected, given: Iterable[str]) -> dict[str, Any]:
    """The scenario's values, and for runs with a start of their own what is said or seen of it."""
    found = dict(asked.values)
    said = set(given)
    for run in data.runs:
        own = {key: value for key, value in data.first_motions.get(run, {}).items() if key not in said}
        found |= {f"{key}@{run}": value for key, value in {**own, **data.starts.get(run, {})}.items()}
    if len(data.runs) == 1:
        found |= data.starts.get(data.runs[0], {})
    return found


class _Names:
    """Gives every run a name of its own."""

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
    track: Measured, asked: ScenarioFile, starts: Mapping[str, Mapping[str, float]], keys: Set[str]
) -> str | None:
    own = {**asked.values, **starts.get(track.name, {})}
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
