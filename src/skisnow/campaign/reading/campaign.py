"""Reader of campaigns: each file is read once, all problems are reported, and records are made if none is an error."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable, Mapping
from dataclasses import dataclass, field, fields
from functools import partial
from pathlib import Path
from typing import Final

from ..._support.csv_text import decode
from ..._support.errors import FieldDataError
from ..._support.messages import Message, joined
from ..._support.units import MM
from ..problems import AppliedCorrection, Problem, error, with_sheet_name
from ..records import Campaign
from ..smet import CampaignWeather
from ..snow_micro_pen import SnowMicroPenRecordings
from . import campaign_files
from .campaign_file import CAMPAIGN_FILE, CampaignFile, Description, read_campaign_file
from .campaign_files import ENDING, WEATHER_ENDING, CampaignFiles, FilesInMemory, RawFiles
from .columns import Table
from .corrections import corrections_by_file
from .experiments import density_samples, drop_cone_tests, penetration_tests, shear_tests, single_rows
from .row_checks import check_rows
from .table_forms import CORRECTIONS, DENSITY, DROP_CONE, PENETRATION, SHEAR, SNOW_MICRO_PEN, TABLES
from .tables import Cells, read_table, table_of_cells
from .workbook_files import is_workbook, unfold_workbooks

CAMPAIGN_FILES: Final = (CAMPAIGN_FILE, CORRECTIONS.file, *(form.file for form in TABLES))
"""Names of the files of a campaign, in the order of reading; workbooks can replace them."""
ATTACHMENTS: Final = "attachments.csv"
"""Photos and positions of tests, which no number depends on."""


class _ReadFiles(Container[str]):
    """Container that has every name of a file that a campaign may read: tables, workbooks, recordings, weather."""

    def __contains__(self, name: object) -> bool:
        if not isinstance(name, str) or "/" in name:
            return False
        return name in CAMPAIGN_FILES or name.lower().endswith((ENDING, WEATHER_ENDING)) or is_workbook(name)


READ_FILES: Final = _ReadFiles()
"""Names of files that a campaign may read.

>>> ["shear.csv" in READ_FILES, "Hang.xlsx" in READ_FILES, "photos/Hang.xlsx" in READ_FILES, "photo.jpg" in READ_FILES]
[True, True, False, False]
"""


def read_campaign(folder: str | Path, *, progress: Callable[[str], None] | None = None) -> Campaign:
    """Read and check a campaign.

    Parameters
    ----------
    folder
        The folder with campaign.toml and the tables; or a workbook (.xlsx) with all of it in its sheets.
    progress
        Called with a few words on the progress of reading.

    Returns
    -------
    The campaign in SI with its corrections applied; ``problems`` has the warnings.

    Raises
    ------
    FieldDataError
        At least one problem is an error; the exception has all problems.

    See Also
    --------
    skisnow.check_campaign : list of the problems, without an exception.
    skisnow.analyse : hardness and shear stress of the snow.

    References
    ----------
    The page docs/files/campaign.md.
    """
    return _require_valid(_read_folder(Path(folder), progress))


def campaign_of_files(files: Mapping[str, bytes], *, others: tuple[str, ...] = ()) -> Campaign:
    """Read and check a campaign from files in memory.

    files: contents by name.
    others: names of other files in the campaign's folder, which are not read.
    Raises FieldDataError: as `read_campaign`.
    """
    return _require_valid(_read_all(FilesInMemory(files, others), None))


def campaign_of_cells(
    description: str, cells: Mapping[str, Cells], corrections: tuple[AppliedCorrection, ...] = ()
) -> Campaign:
    """Check a campaign whose tables are in memory and convert it to records.

    description: text of campaign.toml.
    cells: tables by the name of their file, with their corrections applied.
    corrections: the corrections that were applied to these cells.
    Raises FieldDataError: as `read_campaign`.
    """
    raw = _RawCampaign(FilesInMemory({}), applied=corrections)
    raw.described = read_campaign_file(description, raw.problems)
    if raw.described is not None:
        raw.headings = raw.described.headings
    for form in TABLES:
        if form.file in cells:
            raw.add_table(table_of_cells(form, cells[form.file], raw))
        else:
            raw.absent.add(form.file)
    return _require_valid(raw)


def check_campaign(folder: str | Path) -> tuple[Problem, ...]:
    """List all errors and warnings of a campaign, in the order of its files and rows.

    Parameters
    ----------
    folder
        Folder with campaign.toml and the tables, or a workbook.

    Returns
    -------
    tuple of Problem
        Problems with file, row, column, value, allowed values and remedy; empty for a valid campaign.

    See Also
    --------
    skisnow.read_campaign : the campaign, or an exception.

    References
    ----------
    The page docs/files/campaign.md.
    """
    return _read_folder(Path(folder), None).sorted_problems()


@dataclass(slots=True)
class _RawCampaign(RawFiles):
    """Tables and other contents of a campaign's files, and their problems, before the conversion to records."""

    described: CampaignFile | None = None
    tables: dict[str, Table] = field(default_factory=dict)
    applied: Iterable[AppliedCorrection] = ()
    unread: tuple[str, ...] = ()
    places: Mapping[str, str] = field(default_factory=dict)
    recordings: Mapping[str, bytes] = field(default_factory=dict)
    weather: CampaignWeather | None = None

    def add_table(self, table: Table | None) -> None:
        """Add a table and the problems of its rows; nothing for None, a table that cannot be read."""
        if table is not None:
            self.tables[table.form.file] = table
            self.problems.extend(check_rows(table, self.described))

    def sorted_problems(self) -> tuple[Problem, ...]:
        """All problems in the order of files and rows, at sheets of workbooks if the tables are such."""
        problems = self.problems
        if {form.file for form in TABLES} <= self.absent:
            allowed = Message("at least one of {files}", files=[form.file for form in TABLES])
            action = Message("Put the tables of the experiments into the folder, under these names.")
            problems = [*problems, error("unreadable_file", PENETRATION.file, allowed=allowed, action=action)]
        place = {name: index for index, name in enumerate(CAMPAIGN_FILES)}
        problems = sorted(problems, key=lambda problem: (place.get(problem.file, len(place)), problem.row or 0))
        return tuple(with_sheet_name(problem, self.places) for problem in problems)


def _read_folder(folder: Path, progress: Callable[[str], None] | None) -> _RawCampaign:
    """Read a campaign's folder or workbook; a path that is neither becomes a problem, not an exception."""
    if folder.is_file() and is_workbook(folder.name):
        return _read_all(FilesInMemory({folder.name: folder.read_bytes()}, folder=folder.with_suffix("")), progress)
    if not folder.is_dir():
        action = Message(
            "Name the folder of campaign.toml and the tables, or a workbook (.xlsx) that contains all of them."
        )
        if folder.is_file() and folder.suffix.lower() == ".toml":
            used = Message("A ski or a scenario is checked where it is used: by carve --ski FILE, by simulate FILE.")
            action = joined([action, used])
        value = Message("a file") if folder.exists() else Message("nothing")
        nowhere = error(
            "unreadable_file", str(folder), value=value, allowed=Message("a folder that exists"), action=action
        )
        return _RawCampaign(CampaignFiles(folder), [nowhere])
    return _read_all(CampaignFiles(folder), progress)


def _read_all(files: CampaignFiles, progress: Callable[[str], None] | None) -> _RawCampaign:
    """Read all files of a campaign: tables with corrections applied, recordings, weather, and all problems."""
    campaign = unfold_workbooks(files)
    raw = _RawCampaign(campaign, campaign.problems, places=campaign.places)
    raw.described = read_description(raw)
    for form in TABLES:
        raw.add_table(read_table(form, raw, progress))
    if not any(problem.severity == "error" for problem in raw.problems):
        allowed = Message("a heading of a table")
        action = Message("Write the heading as the table has it, or remove the line.")
        # without an error these units would be ignored silently
        refused = partial(error, "bad_toml", CAMPAIGN_FILE, allowed=allowed, action=action)
        for path in raw.headings.without_heading({file: table.headings for file, table in raw.tables.items()}):
            raw.problems.append(refused(column=path, value=path.rpartition(".")[2]))
    raw.recordings = campaign_files.recording_contents(raw.tables.get(SNOW_MICRO_PEN.file), raw)
    raw.weather = None if raw.described is None else campaign_files.campaign_weather(raw.described.weather, raw)
    names = campaign.names()
    for name in sorted(names):  # a file whose name differs by case would not be read
        if name not in CAMPAIGN_FILES and name.lower() in raw.absent:
            right = Message("{name}", name=name.lower())
            action = Message("Rename it to {name}.", name=right)
            raw.problems.append(error("unreadable_file", name, value=name, allowed=right, action=action))
    other = [name for name in sorted(names) if names[name] and name not in (*CAMPAIGN_FILES, ATTACHMENTS, *raw.hashes)]
    raw.unread = (*(name for name in other if not name.startswith((".", "~$"))), *campaign.unread)
    hashes = {name: sha256 for name, sha256 in raw.hashes.items() if name not in campaign.of_sheets}
    raw.hashes = hashes | campaign.hashes
    corrections = (correction for rows in raw.corrections.values() for row in rows.values() for correction in row)
    raw.applied = [correction.applied() for correction in sorted(corrections, key=lambda correction: correction.line)]
    return raw


def read_description(files: RawFiles) -> CampaignFile | None:
    """Contents of campaign.toml, None if it is missing, empty or unreadable; reads corrections.csv, too.

    `files` gets the headings of campaign.toml, the corrections, and the problems of both.
    """
    decoded, described = files.decoded(CAMPAIGN_FILE, decode), None
    if CAMPAIGN_FILE in files.absent:
        action = Message(
            "`skisnow new campaign` writes one into this folder; `skisnow import FILE --out DIR` makes a campaign of a "
            "workbook or table in another layout."
        )
        allowed = Message("a file of this name in the folder")
        files.problems.append(error("bad_toml", CAMPAIGN_FILE, allowed=allowed, action=action))
    elif decoded is not None and not decoded.text.strip():
        action, allowed = Message("Describe the tools and plates that the tables name."), Message("keys and values")
        files.problems.append(error("empty_file", CAMPAIGN_FILE, value="nothing", allowed=allowed, action=action))
    elif decoded is not None:
        files.report_encoding(CAMPAIGN_FILE, decoded.foreign_encoding)
        described = read_campaign_file(decoded.text, files.problems)
    if described is not None:
        files.headings = described.headings
    table = read_table(CORRECTIONS, files)
    if table is not None and not table.absent:
        files.corrections = corrections_by_file(table, files.problems)
    return described


def _require_valid(raw: _RawCampaign) -> Campaign:
    """Convert a campaign to records; FieldDataError if it has errors."""
    problems, described, tables = raw.sorted_problems(), raw.described, raw.tables
    if described is None or any(problem.severity == "error" for problem in problems):
        raise FieldDataError(problems)
    folder, recordings = raw.files.folder, None
    if (table := tables.get(SNOW_MICRO_PEN.file)) is not None:
        recordings = SnowMicroPenRecordings(
            **single_rows(table),
            spot=table.names["spot"].cells(),
            surface=table.numbers["surface_mm"] * MM,
            contents=tuple(raw.recordings[name] for name in table.names["file"].cells()),
            settings=described.snow_micro_pen,
        )
    return Campaign(
        **{field.name: getattr(described, field.name) for field in fields(Description)}
        | {"name": described.name or folder.resolve().name},
        folder=folder,
        penetration=penetration_tests(tables[PENETRATION.file]) if PENETRATION.file in tables else None,
        shear=shear_tests(tables[SHEAR.file]) if SHEAR.file in tables else None,
        density=density_samples(tables[DENSITY.file]) if DENSITY.file in tables else None,
        drop_cone=drop_cone_tests(tables[DROP_CONE.file]) if DROP_CONE.file in tables else None,
        problems=problems,
        file_hashes=raw.hashes,
        corrections=tuple(raw.applied),
        unread_files=raw.unread,
        places=raw.places,
        snow_micro_pen=recordings,
        weather=raw.weather,
    )
