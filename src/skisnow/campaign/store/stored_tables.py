"""The tables of a stored campaign cell by cell, as its files say it: what is there to be corrected."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ..._support.user_files import natural_number
from ..reading.campaign_file import CAMPAIGN_FILE, read_campaign_file
from ..reading.campaign_files import FilesOfFolder, RawFiles
from ..reading.corrections import Corrector, corrections_by_file, header_with_status
from ..reading.header import Header, column_units, header_of
from ..reading.headings import Headings
from ..reading.table_forms import CORRECTIONS, TABLES
from ..reading.tables import decimal_mark_of, read_table
from ..reading.text import UnreadableTextError, decode, inspect_csv
from .rows import damaged

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ..reading.campaign_files import CampaignFiles
    from ..reading.corrections import RowCorrections
    from ..reading.heading_units import UnitConversion
    from ..reading.table_forms import TableForm
    from ..reading.text import CsvText


@dataclass(frozen=True, slots=True)
class StoredTable:
    """A table of a stored campaign.

    Attributes
    ----------
    form
        What the table must and may have.
    columns
        Those that the file has, and ``status``, which a correction may add.
    tests
        Cells by the test's name, file line and column, corrections of the campaign's own corrections.csv applied.
    conversions
        From the unit of its cells, of each column that has another unit in the file than its name states.
    """

    form: TableForm
    columns: tuple[str, ...]
    tests: Mapping[str, Mapping[int, Mapping[str, str]]]
    conversions: Mapping[str, UnitConversion]


def stored_tables(campaign: CampaignFiles | Path) -> dict[str, StoredTable]:
    """Every table of a campaign that can be read, by its file; the campaign is a folder, or files that are at hand."""
    files = RawFiles(FilesOfFolder(campaign) if isinstance(campaign, Path) else campaign)
    headings = _headings(files)
    corrections = _corrections(files, headings)
    found = {form.file: _stored_table(files, form, corrections.get(form.file, {}), headings) for form in TABLES}
    return {file: table for file, table in found.items() if table is not None}


def cell_key(line: int, column: str) -> str:
    """How an entry about a stored test names a cell.

    >>> cell_key(12, "depth_mm")
    '12/depth_mm'
    """
    return f"{line}/{column}"


def cell_of(key: str) -> tuple[int, str]:
    """The file line and the column that a key names.

    >>> cell_of("12/depth_mm")
    (12, 'depth_mm')

    Raises
    ------
    StoreError
        The key names no cell: the entry is damaged.
    """
    text, _, column = key.partition("/")
    line = natural_number(text)
    if line is None or not column:
        raise damaged(f"A correction of the cell {key[:80]!r}")
    return line, column


def _csv_text(files: RawFiles, form: TableForm) -> CsvText | None:
    data = files.read(form.file)
    try:
        return inspect_csv(data) if data is not None else None
    except UnreadableTextError as failure:
        files.report_unreadable(form.file, failure)
        return None


def _headings(files: RawFiles) -> Headings:
    """What stands for the columns' names; nothing where campaign.toml cannot be read."""
    data = files.read(CAMPAIGN_FILE)
    try:
        described = read_campaign_file(decode(data).text, []) if data is not None else None
    except UnreadableTextError:
        return Headings()
    return described.headings if described is not None else Headings()


def _corrections(files: RawFiles, headings: Headings) -> Mapping[str, RowCorrections]:
    text = _csv_text(files, CORRECTIONS)
    table = read_table(CORRECTIONS, text, corrections={}, files=files, headings=headings) if text is not None else None
    return corrections_by_file(table, files.found) if table is not None and not table.absent else {}


def _stored_table(
    files: RawFiles, form: TableForm, corrections: RowCorrections, headings: Headings
) -> StoredTable | None:
    text = _csv_text(files, form)
    if text is None:
        return None
    header: Header | None = None
    corrector: Corrector | None = None
    tests: dict[str, dict[int, dict[str, str]]] = {}
    conversions: dict[str, UnitConversion] = {}
    try:
        for lines, rows in text.records():
            if header is None and rows:
                written = header_of(lines, rows)
                units = column_units(form, written, headings, []).conversions
                conversions = {column: each for column, each in units.items() if each.changes}
                header = header_with_status(form, written.renamed(form, headings), corrections)
                mark = decimal_mark_of(form, header, text)
                corrector = Corrector(form, header, corrections, mark=mark, found=files.found)
            if header is None or corrector is None or form.key not in header.position:
                return None
            corrector.apply(lines, rows)
            for line, row in zip(lines, rows, strict=True):
                cells = {name: row[at].strip() if at < len(row) else "" for name, at in header.position.items()}
                tests.setdefault(cells[form.key], {})[line] = cells
    except UnreadableTextError as failure:
        files.report_unreadable(form.file, failure)
    if header is None:
        return None
    columns = tuple(dict.fromkeys((*header.position, "status")))
    return StoredTable(form, columns, tests, conversions)
