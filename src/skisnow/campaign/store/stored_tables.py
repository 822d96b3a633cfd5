"""Cells of tables for entry and correction: tables of a stored campaign, and validation of typed cells."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from ..._support.errors import ParameterError
from ..._support.messages import Message
from ..._support.user_files import natural_number
from ..reading.campaign_file import CAMPAIGN_FILE, read_campaign_file
from ..reading.campaign_files import FilesOfFolder, RawFiles
from ..reading.columns import number
from ..reading.corrections import Corrector, corrections_by_file, header_with_status
from ..reading.header import Header, column_units, split_header
from ..reading.headings import Headings, UnitConversion
from ..reading.table_forms import BRANCH, BRANCHES, CORRECTIONS, TABLES
from ..reading.tables import decimal_mark_of, read_table
from ..reading.text import UnreadableTextError, decode, inspect_csv
from .rows import damage_error

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ...parameters import Quantity
    from ..reading.campaign_files import CampaignFiles
    from ..reading.corrections import RowCorrections
    from ..reading.headings import UnitConversion
    from ..reading.table_forms import TableForm
    from ..reading.text import CsvText


@dataclass(frozen=True, slots=True)
class StoredTable:
    """A table of a stored campaign.

    Attributes
    ----------
    form
        Required and allowed columns.
    columns
        Columns of the file, and ``status``, which a correction can add.
    tests
        Cells by test, line of the file and column, with the corrections of the campaign's corrections.csv.
    conversions
        Conversion of each column whose unit in the file differs from its name.
    """

    form: TableForm
    columns: tuple[str, ...]
    tests: Mapping[str, Mapping[int, Mapping[str, str]]]
    conversions: Mapping[str, UnitConversion]


def stored_tables(campaign: CampaignFiles | Path) -> dict[str, StoredTable]:
    """Readable tables of a campaign by file; the campaign is a folder, or files in memory."""
    files = RawFiles(FilesOfFolder(campaign) if isinstance(campaign, Path) else campaign)
    headings = _headings(files)
    corrections = _corrections(files, headings)
    tables = {form.file: _stored_table(files, form, corrections.get(form.file, {}), headings) for form in TABLES}
    return {file: table for file, table in tables.items() if table is not None}


def cell_key(line: int, column: str) -> str:
    """Key of a cell in an entry about a stored test.

    >>> cell_key(12, "depth_mm")
    '12/depth_mm'
    """
    return f"{line}/{column}"


def cell_of(key: str) -> tuple[int, str]:
    """Line of the file and column of a cell's key.

    >>> cell_of("12/depth_mm")
    (12, 'depth_mm')

    Raises
    ------
    StoreError
        The key is invalid: the entry is damaged.
    """
    text, _, column = key.partition("/")
    line = natural_number(text)
    if line is None or not column:
        raise damage_error(Message("A correction of the cell {cell!r}", cell=key[:80]))
    return line, column


def _csv_text(files: RawFiles, form: TableForm) -> CsvText | None:
    data = files.read(form.file)
    try:
        return inspect_csv(data) if data is not None else None
    except UnreadableTextError as failure:
        files.report_unreadable(form.file, failure)
        return None


def _headings(files: RawFiles) -> Headings:
    """Mapping of headings; empty if campaign.toml cannot be read."""
    data = files.read(CAMPAIGN_FILE)
    try:
        described = read_campaign_file(decode(data).text, []) if data is not None else None
    except UnreadableTextError:
        return Headings()
    return described.headings if described is not None else Headings()


def _corrections(files: RawFiles, headings: Headings) -> Mapping[str, RowCorrections]:
    text = _csv_text(files, CORRECTIONS)
    table = read_table(CORRECTIONS, text, corrections={}, files=files, headings=headings) if text is not None else None
    return corrections_by_file(table, files.problems) if table is not None and not table.absent else {}


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
                written = split_header(lines, rows)
                units = column_units(form, written, headings, []).conversions
                conversions = {column: conversion for column, conversion in units.items() if conversion.changes}
                header = header_with_status(form, written.renamed(form, headings), corrections)
                mark = decimal_mark_of(form, header, text)
                corrector = Corrector(form, header, corrections, mark=mark, problems=files.problems)
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


FORMS: Final = {form.file: form for form in TABLES}
"""Required and allowed columns of each table, by file."""
LONGEST_TEXT: Final = 200

EMPTY: Final = "{} is empty."
NOT_ALLOWED: Final = "{}: “{}” is not allowed."
TOO_LONG: Final = "{} is too long, or has several lines."
_PROBLEMS: Final = {"empty": EMPTY, "not_allowed": NOT_ALLOWED, "too_long": TOO_LONG}
NAME: Final = "Enter a name."
BRANCH_WORD: Final = "Enter loading or unloading, or leave it empty."
SHORT_LINE: Final = "Enter one line of at most {} characters."
ANY_NUMBER: Final = "Enter a number."
AT_LEAST: Final = "Enter a number of {} or more."
ABOVE: Final = "Enter a number above {}."
BETWEEN: Final = {
    (False, False): "Enter a number from {} to {}.",
    (False, True): "Enter a number from {} to below {}.",
    (True, False): "Enter a number above {} and up to {}.",
    (True, True): "Enter a number above {} and below {}.",
}
"""By whether the lowest and the highest number are excluded."""


class CellError(ParameterError):
    """A typed cell is rejected. The message has two sentences, each with its own template.

    Attributes
    ----------
    code
        empty, not_allowed or too_long.
    column, value
        Name of the column, and the typed text.
    problem, fix
        Template of each sentence; the fields of the first are `column` and `value`, those of the second `limits`.
    limits
        Numbers that limit what is allowed, in the unit of the text.
    """

    def __init__(self, code: str, column: str, value: str, fix: str, limits: tuple[float, ...] = ()) -> None:
        self.column, self.value = column, value
        self.problem, self.fix, self.limits = _PROBLEMS[code], fix, limits
        text = f"{self.problem.format(column, value)} {fix.format(*(f'{limit:g}' for limit in limits))}"
        super().__init__(text, code=code)


def checked_cell(form: TableForm, column: str, typed: str, *, conversion: UnitConversion | None = None) -> str:
    """The text of a cell as a table holds it: without blanks around it, a number with a decimal point.

    Parameters
    ----------
    form, column, typed
        Table, name of the column, and the text.
    conversion
        From the unit of the text to that of the column (default: it has the unit of the column).

    Raises
    ------
    CellError
        An empty name, a text that is too long, a text that is not a number, a number outside its range.

    >>> checked_cell(FORMS["penetration.csv"], "depth_mm", " 2,50 ")
    '2.50'
    """
    text = typed.strip()
    rule = next((rule for rule in form.numbers if rule.name == column), None)
    if rule is not None:
        return _number_cell(rule, text, conversion or UnitConversion(column))
    if column == BRANCH and text.casefold() not in BRANCHES:
        raise CellError("not_allowed", column, text, BRANCH_WORD)
    if not text and column in form.names:
        raise CellError("empty", column, text, NAME)
    if len(text) > LONGEST_TEXT or not all(letter.isprintable() for letter in text):
        raise CellError("too_long", column, text, SHORT_LINE, (LONGEST_TEXT,))
    return text


def _number_cell(rule: Quantity, text: str, conversion: UnitConversion) -> str:
    if not text and not rule.needed:
        return ""
    mark = "," if "," in text and "." not in text else "."
    value = number(text, mark)
    if math.isnan(value) or bool(rule.outside(conversion.convert(np.array([value])))[0]):
        fix, limits = _number_fix(rule)
        in_its_unit = tuple(conversion.revert(limit) for limit in limits)
        raise CellError("not_allowed" if text else "empty", rule.name, text, fix, in_its_unit)
    return text.replace(",", ".")


def _number_fix(rule: Quantity) -> tuple[str, tuple[float, ...]]:
    """Template and limits of the sentence that says which numbers are allowed."""
    if rule.highest < math.inf:
        return BETWEEN[rule.above, rule.below], (rule.lowest, rule.highest)
    if rule.lowest > -math.inf:
        return (ABOVE if rule.above else AT_LEAST), (rule.lowest,)
    return ANY_NUMBER, ()
