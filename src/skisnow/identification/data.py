"""A file of measurements, recognised by what stands in it."""

from __future__ import annotations

from pathlib import Path
from typing import Final, TypeAlias

from .._support.errors import ParameterError
from .._support.spreadsheet_text import encoding_of, most_frequent_separator, named_separator
from .._support.user_files import is_file
from ..track.readers.table import GEODETIC, LOCAL, TIMES
from ..track.track import Track
from .measured_grooves import COLUMNS as GROOVE_COLUMNS
from .measured_grooves import MeasuredGrooves, grooves_of
from .photo_cells import COLUMNS as CELL_COLUMNS
from .photo_cells import PhotoCells, photo_cells_of
from .table_file import read_table

_HEAD: Final = 4096
_OF_CAMPAIGN: Final = {"experiment", "load_N", "moment_Nm", "lever_arm_mm"}
"""Columns of the campaign's tables that have a depth, as measured grooves do."""
Data: TypeAlias = Track | PhotoCells | MeasuredGrooves


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
    """What a file was taken for, in words."""
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
