"""Files of a campaign in a folder or in memory, recordings and weather files that it names."""

from __future__ import annotations

import hashlib
import stat
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final, TypeVar

from ..._support.csv_text import CsvText, UnreadableTextError, inspect_csv
from ..._support.errors import FieldDataError
from ..._support.messages import Message
from ..problems import Problem, error, warning
from ..smet import CampaignWeather, WeatherSettings, parse_smet
from ..snow_micro_pen import parse_snow_micro_pen
from .campaign_file import CAMPAIGN_FILE
from .columns import Table
from .corrections import RowCorrections
from .headings import Headings
from .row_checks import MOST_LISTED
from .table_forms import SNOW_MICRO_PEN, TableForm

T = TypeVar("T")


@dataclass(frozen=True, slots=True, eq=False)
class CampaignFiles:
    """Files of one campaign by name: those of a folder; subclasses have other sources.

    folder: the folder; for files in memory its name is the default name of the campaign.
    """

    folder: Path

    def read(self, name: str) -> bytes | None:
        """Bytes of a file; None for a directory, pipe or the like.

        Raises FileNotFoundError: the file does not exist.
        Raises OSError: it cannot be read.
        """
        path = self.folder / name
        # reading a pipe would block, and a folder cannot be read
        return path.read_bytes() if stat.S_ISREG(path.stat().st_mode) else None

    def names(self) -> dict[str, bool]:
        """Names in the folder, with True for plain files."""
        return {path.name: path.is_file() for path in self.folder.iterdir()}


@dataclass(frozen=True, slots=True, eq=False)
class FilesInMemory(CampaignFiles):
    """Files in memory: contents by name, and names of other files, which are not read."""

    folder: Path = field(default=Path("campaign"), kw_only=True)
    contents: Mapping[str, bytes]
    others: tuple[str, ...] = ()

    def read(self, name: str) -> bytes | None:
        """Bytes of a file; FileNotFoundError if it is not in memory."""
        if name not in self.contents:
            raise FileNotFoundError(name)
        return self.contents[name]

    def names(self) -> dict[str, bool]:
        """Names of all files, each with True."""
        return dict.fromkeys((*self.contents, *self.others), True)


@dataclass(slots=True)
class RawFiles:
    """Reader of the files of one campaign that collects their problems.

    problems: problems so far.
    headings, corrections: mapping of headings to columns, and corrections by table, once they are read.
    hashes: SHA-256 of each file that was read.
    absent: names of missing files.
    """

    files: CampaignFiles
    problems: list[Problem] = field(default_factory=list)
    headings: Headings = field(default_factory=Headings)
    corrections: Mapping[str, RowCorrections] = field(default_factory=dict)
    hashes: dict[str, str] = field(default_factory=dict)
    absent: set[str] = field(default_factory=set)

    def read(self, name: str) -> bytes | None:
        """Bytes of a file; None if it is missing, or if it cannot be read, which is added to the problems."""
        value: str = Message("something other than a plain file")
        try:
            data = self.files.read(name)
        except FileNotFoundError:
            self.absent.add(name)
            return None
        except OSError as failure:
            data, value = None, failure.strerror or str(failure)
        if data is None:
            action = Message("Make the file readable, or remove it from the campaign.")
            allowed = Message("a plain file that may be read")
            self.problems.append(error("unreadable_file", name, value=value, allowed=allowed, action=action))
        else:
            self.hashes[name] = hashlib.sha256(data).hexdigest()
        return data

    def csv_text(self, form: TableForm) -> CsvText | None:
        """Text of a table, before it is split into records; None without a readable file."""
        text = self.decoded(form.file, inspect_csv)
        if text is not None:
            self.report_encoding(form.file, text.foreign_encoding)
        return text

    def decoded(self, name: str, decoder: Callable[[bytes], T]) -> T | None:
        """Result of decoding the bytes of a file; None without a readable file."""
        data = self.read(name)
        if data is None:
            return None
        try:
            return decoder(data)
        except UnreadableTextError as failure:
            self.report_unreadable(name, failure)
            return None

    def report_unreadable(self, name: str, failure: UnreadableTextError) -> None:
        """Add the problem of a file that is not valid text."""
        self.problems.append(error("unreadable_file", name, **vars(failure)))

    def report_encoding(self, name: str, foreign_encoding: str | None) -> None:
        """Add a note, which needs no action, about an encoding other than UTF-8; nothing for None."""
        if foreign_encoding is None:
            return
        action = Message("It was read as such; save as UTF-8 if letters look wrong in the report.")
        allowed = Message("UTF-8, in the plain form")
        self.problems.append(
            warning("encoding", name, value=foreign_encoding, allowed=allowed, action=action, needs_action=False)
        )


ENDING: Final = ".pnt"
WEATHER_ENDING: Final = ".smet"


def _read_named_file(
    files: RawFiles, name: str, ending: str, form: Message, refuse: Callable[[Message], None]
) -> bytes | None:
    """Bytes of a file that a table or campaign.toml names; otherwise None, after `refuse` (`form`: an allowed name)."""
    if "/" in name or "\\" in name or not name.lower().endswith(ending):
        refuse(form)
        return None
    data = files.read(name)
    if name in files.absent:
        refuse(Message("a file of this name in the campaign's folder"))
    return data


def recording_contents(table: Table | None, files: RawFiles) -> dict[str, bytes]:
    """Read and check the recordings that a table names; returns their bytes by name. Problems are added to `files`."""
    contents: dict[str, bytes] = {}
    if table is None or table.absent:
        return contents
    for name in (SNOW_MICRO_PEN.key, "file"):
        files.problems.extend(_repeated_names(table, name))
    most = len(files.problems) + MOST_LISTED
    for row, name in enumerate(table.names["file"].cells()):
        if name and name not in contents and len(files.problems) < most:
            data = _read_recording(table, row, name, files)
            if data is not None:
                contents[name] = data
    return contents


def _read_recording(table: Table, row: int, name: str, files: RawFiles) -> bytes | None:
    """Bytes of a valid .PNT file named in a row of the table; None, with problems added, if it is not valid."""

    def refuse(allowed: Message) -> None:
        action = Message("Put the file next to the tables, correct its name, or remove the row.")
        files.problems.append(table.error(row, "unreadable_file", "file", name, allowed, action))

    form = Message("the name of a .PNT file in the campaign's folder")
    data = _read_named_file(files, name, ENDING, form, refuse)
    try:
        if data is not None:
            parse_snow_micro_pen(name, data)
    except FieldDataError as failure:
        problems: list[Problem] = failure.problems  # type: ignore[assignment]
        recording = table.names[SNOW_MICRO_PEN.key][row]
        files.problems.extend(replace(problem, experiment=recording) for problem in problems)
        return None
    return data


def _repeated_names(table: Table, column: str) -> list[Problem]:
    """Errors, at most `MOST_LISTED`, for texts that occur in several rows of a column, as they would count twice."""
    first: dict[str, int] = {}
    problems: list[Problem] = []
    for row, name in enumerate(table.names[column].cells()):
        reference = first.setdefault(name, row)
        if name and reference != row and len(problems) < MOST_LISTED:
            allowed = Message("each {column} once; row {row} has it, too", column=column, row=int(table.row[reference]))
            action = Message("Correct the cell, or remove one of the rows.")
            problems.append(table.error(row, "mixed_experiment", column, table.names[column][row], allowed, action))
    return problems


def campaign_weather(settings: WeatherSettings, files: RawFiles) -> CampaignWeather | None:
    """Read the weather station's file; None if none is named, or if it cannot be read, which is a problem."""
    name = settings.file
    if not name:
        return None

    def refuse(allowed: Message) -> None:
        action = Message("Put the file next to campaign.toml, or correct its name.")
        files.problems.append(
            error("unreadable_file", CAMPAIGN_FILE, column="weather.file", value=name, allowed=allowed, action=action)
        )

    form = Message("the name of a .smet file in the campaign's folder")
    data = _read_named_file(files, name, WEATHER_ENDING, form, refuse)
    try:
        return None if data is None else CampaignWeather(parse_smet(name, data), settings)
    except FieldDataError as failure:
        files.problems.extend(failure.problems)  # type: ignore[arg-type]
        return None
