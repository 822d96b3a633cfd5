"""Reader of campaigns: each file is read once, all problems are reported, and records are made if none is an error."""

from __future__ import annotations

from collections.abc import Callable, Container, Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Final

from ..._support.csv_text import UnreadableTextError, decode
from ..._support.errors import FieldDataError
from ..._support.messages import Message, joined
from ..problems import AppliedCorrection, Problem, error, with_sheet_name
from ..records import Campaign
from ..smet import CampaignWeather
from .campaign_file import CAMPAIGN_FILE, CampaignFile, read_campaign_file
from .campaign_files import (
    ENDING,
    WEATHER_ENDING,
    CampaignFiles,
    FilesInMemory,
    RawFiles,
    campaign_weather,
    recording_contents,
    snow_micro_pen_recordings,
)
from .columns import Table
from .corrections import corrections_by_file
from .experiments import density_samples, drop_cone_tests, penetration_tests, shear_tests
from .headings import Headings
from .row_checks import check_rows
from .table_forms import CORRECTIONS, DENSITY, DROP_CONE, PENETRATION, SHEAR, SNOW_MICRO_PEN, TABLES
from .tables import Cells, read_table, table_of_cells
from .workbook_files import is_workbook, unfold_workbooks

CAMPAIGN_FILES: Final = (CAMPAIGN_FILE, CORRECTIONS.file, *(form.file for form in TABLES))
"""Names of the files of a campaign, in the order of reading; workbooks can replace them."""
ATTACHMENTS: Final = "attachments.csv"
"""Photos and positions of tests, which no number depends on."""


class _ReadFiles(Container[str]):
    """Names of the files of a campaign, of workbooks, and of files that tables can name."""

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
    """Check a campaign whose tables are in memory.

    description: text of campaign.toml.
    cells: tables by file, with their corrections applied.
    corrections: these corrections.
    Raises FieldDataError: as `read_campaign`.
    """
    files = RawFiles(FilesInMemory({}))
    described = read_campaign_file(description, files.problems)
    if described is not None:
        files.headings = described.headings
    tables: dict[str, Table] = {}
    for form in TABLES:
        table = table_of_cells(form, cells[form.file], files) if form.file in cells else None
        if table is not None:
            tables[form.file] = table
            files.problems.extend(check_rows(table, described))
    if not {form.file for form in MEASUREMENTS} & set(cells):
        files.problems.append(_missing_measurements())
    problems = _sort_problems(files.problems)
    return _require_valid(_Contents(Path("campaign"), described, tables, {}, problems, corrections))


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
    return _read_folder(Path(folder), None).problems


def _require_valid(contents: _Contents) -> Campaign:
    if contents.described is None or any(problem.severity == "error" for problem in contents.problems):
        raise FieldDataError(contents.problems)
    return _build_campaign(contents, contents.described)


@dataclass(frozen=True, slots=True)
class _Contents:
    """Contents of a campaign's files before conversion to records, with all problems."""

    folder: Path
    described: CampaignFile | None
    tables: Mapping[str, Table]
    hashes: Mapping[str, str]
    problems: tuple[Problem, ...]
    corrections: tuple[AppliedCorrection, ...] = ()
    unread: tuple[str, ...] = ()
    places: Mapping[str, str] = field(default_factory=dict)
    recordings: Mapping[str, bytes] = field(default_factory=dict)
    weather: CampaignWeather | None = None


def _read_folder(folder: Path, progress: Callable[[str], None] | None) -> _Contents:
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
        return _Contents(folder, None, {}, {}, (nowhere,))
    return _read_all(CampaignFiles(folder), progress)


def _read_all(campaign_files: CampaignFiles, progress: Callable[[str], None] | None) -> _Contents:
    campaign = unfold_workbooks(campaign_files)
    files = RawFiles(campaign, problems=campaign.problems)
    described = read_description(files)
    tables: dict[str, Table] = {}
    for form in TABLES:
        table = read_table(form, files, progress)
        if table is not None:
            tables[form.file] = table
            files.problems.extend(check_rows(table, described))
    if not any(problem.severity == "error" for problem in files.problems):
        files.problems.extend(_units_without_heading(files.headings, tables))
    recordings = recording_contents(tables.get(SNOW_MICRO_PEN.file), files)
    weather = None if described is None else campaign_weather(described.weather, files)
    names = campaign.names()
    files.problems.extend(_misnamed_files(names, files.absent))
    if {form.file for form in MEASUREMENTS} <= files.absent:
        files.problems.append(_missing_measurements())
    hashes = {name: digest for name, digest in files.hashes.items() if name not in campaign.of_sheets}
    applied = sorted(
        (correction for rows in files.corrections.values() for row in rows.values() for correction in row),
        key=lambda correction: correction.line,
    )
    return _Contents(
        campaign.folder,
        described,
        tables,
        hashes | campaign.hashes,
        tuple(with_sheet_name(problem, campaign.places) for problem in _sort_problems(files.problems)),
        tuple(correction.applied() for correction in applied),
        (*(name for name in _unread_files(names) if name not in files.hashes), *campaign.unread),
        campaign.places,
        recordings,
        weather,
    )


def _sort_problems(problems: list[Problem]) -> tuple[Problem, ...]:
    place = {name: index for index, name in enumerate(CAMPAIGN_FILES)}
    return tuple(sorted(problems, key=lambda problem: (place.get(problem.file, len(place)), problem.row or 0)))


def _unread_files(there: Mapping[str, bool]) -> tuple[str, ...]:
    """Files that are not part of a campaign, without hidden ones and Excel's lock files."""
    files = sorted(name for name, is_file in there.items() if is_file)
    return tuple(
        name for name in files if name not in (*CAMPAIGN_FILES, ATTACHMENTS) and not name.startswith((".", "~$"))
    )


def _units_without_heading(headings: Headings, tables: Mapping[str, Table]) -> list[Problem]:
    """Errors for units in campaign.toml whose heading is in no table, because they would be ignored silently."""
    there = {file: table.headings for file, table in tables.items()}
    return [
        error(
            "bad_toml",
            CAMPAIGN_FILE,
            column=path,
            value=path.rpartition(".")[2],
            allowed=Message("a heading of a table"),
            action=Message("Write the heading as the table has it, or remove the line."),
        )
        for path in headings.without_heading(there)
    ]


def _misnamed_files(there: Mapping[str, bool], absent: set[str]) -> list[Problem]:
    """Errors for files whose names differ from the expected ones only by case, because they would not be read."""
    return [
        error(
            "unreadable_file",
            name,
            value=name,
            allowed=name.lower(),
            action=Message("Rename it to {name}.", name=name.lower()),
        )
        for name in sorted(there)
        if name not in CAMPAIGN_FILES and name.lower() in absent
    ]


MEASUREMENTS: Final = (PENETRATION, SHEAR, SNOW_MICRO_PEN, DENSITY, DROP_CONE)
"""Tables of which a campaign needs one: recordings or samples of a pit alone are a campaign."""


def _missing_measurements() -> Problem:
    return error(
        "unreadable_file",
        PENETRATION.file,
        allowed=Message("at least one of {files}", files=[form.file for form in MEASUREMENTS]),
        action=Message("Put the tables of the experiments into the folder, under these names."),
    )


def read_description(files: RawFiles) -> CampaignFile | None:
    """Read campaign.toml and corrections.csv; the files get their headings, corrections and problems."""
    described = _read_campaign_toml(files)
    if described is not None:
        files.headings = described.headings
    table = read_table(CORRECTIONS, files)
    if table is not None and not table.absent:
        files.corrections = corrections_by_file(table, files.problems)
    return described


def _read_campaign_toml(files: RawFiles) -> CampaignFile | None:
    data = files.read(CAMPAIGN_FILE)
    if CAMPAIGN_FILE in files.absent:
        action = Message(
            "`skisnow new campaign` writes one into this folder; `skisnow import FILE --out DIR` makes a campaign of a "
            "workbook or table in another layout."
        )
        allowed = Message("a file of this name in the folder")
        files.problems.append(error("bad_toml", CAMPAIGN_FILE, allowed=allowed, action=action))
    if data is None:
        return None
    try:
        decoded = decode(data)
    except UnreadableTextError as failure:
        files.report_unreadable(CAMPAIGN_FILE, failure)
        return None
    if not decoded.text.strip():
        action = Message("Describe the tools and plates that the tables name.")
        files.problems.append(
            error("empty_file", CAMPAIGN_FILE, value="nothing", allowed=Message("keys and values"), action=action)
        )
        return None
    files.report_encoding(CAMPAIGN_FILE, decoded.foreign_encoding)
    return read_campaign_file(decoded.text, files.problems)


_SAME: Final = {field.name for field in fields(CampaignFile)} & {field.name for field in fields(Campaign)} - {
    "name", "snow_micro_pen", "weather",
}  # fmt: skip
"""Fields of a campaign that campaign.toml states as they are."""


def _build_campaign(contents: _Contents, described: CampaignFile) -> Campaign:
    tables = contents.tables
    return Campaign(
        name=described.name or contents.folder.resolve().name,
        folder=contents.folder,
        **{name: getattr(described, name) for name in _SAME},
        penetration=penetration_tests(tables[PENETRATION.file]) if PENETRATION.file in tables else None,
        shear=shear_tests(tables[SHEAR.file]) if SHEAR.file in tables else None,
        density=density_samples(tables[DENSITY.file]) if DENSITY.file in tables else None,
        drop_cone=drop_cone_tests(tables[DROP_CONE.file]) if DROP_CONE.file in tables else None,
        problems=contents.problems,
        file_hashes=contents.hashes,
        corrections=contents.corrections,
        unread_files=contents.unread,
        places=contents.places,
        snow_micro_pen=snow_micro_pen_recordings(
            tables[SNOW_MICRO_PEN.file], contents.recordings, described.snow_micro_pen
        )
        if SNOW_MICRO_PEN.file in tables
        else None,
        weather=contents.weather,
    )
