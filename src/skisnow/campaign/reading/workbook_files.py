"""Workbooks as files of a campaign: a sheet with the name of a table replaces its CSV file, row by row."""

from __future__ import annotations

import csv
import hashlib
import io
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

from ..._support.messages import Message
from ..._support.spreadsheet_text import is_number
from ..._support.user_files.text_files import ContentError, toml_text
from ..._support.user_files.workbook import Rows, workbook_sheets
from ..problems import Problem, error, warning
from .campaign_file import CAMPAIGN_KEYS
from .campaign_files import CampaignFiles
from .headings import FORMS, columns_by_synonym
from .table_forms import TABLES

ENDINGS: Final = (".xlsx", ".xlsm")
DESCRIPTION: Final = "campaign.toml"
_LIKELY: Final = 0.6
"""Smallest share of required columns with which a sheet is proposed as a table."""


@dataclass(frozen=True, slots=True, eq=False)
class UnfoldedFiles(CampaignFiles):
    """Files of a campaign, with the sheets of its workbooks as CSV and TOML files.

    files: files of the campaign, including the workbooks.
    of_sheets: bytes of the files that the sheets replace, such as penetration.csv, by name.
    places: name of workbook and sheet for messages, by the name of the file.
    hashes: SHA-256 of each workbook that was read.
    unread: rows of the sheets with other names, by name of workbook and sheet.
    problems: problems of the workbooks.
    """

    files: CampaignFiles
    of_sheets: dict[str, bytes] = field(default_factory=dict)
    places: dict[str, str] = field(default_factory=dict)
    hashes: dict[str, str] = field(default_factory=dict)
    unread: dict[str, Rows] = field(default_factory=dict)
    problems: list[Problem] = field(default_factory=list)

    def read(self, name: str) -> bytes | None:
        """Bytes of a file, or CSV or TOML of a sheet with its name; None for a directory, pipe or the like."""
        return self.of_sheets[name] if name in self.of_sheets else self.files.read(name)

    def names(self) -> dict[str, bool]:
        """Names of the files with True for plain ones; sheets are in place of their workbooks."""
        there = {name: is_file for name, is_file in self.files.names().items() if name not in self.hashes}
        return there | dict.fromkeys(self.of_sheets, True)


def unfold_workbooks(files: CampaignFiles) -> UnfoldedFiles:
    """Replace the workbooks among the files of a campaign by the text files of their sheets."""
    workbooks = UnfoldedFiles(files.folder, files)
    names = files.names()
    for name in sorted(names):
        if names[name] and "/" not in name and is_workbook(name):
            _read_workbook(workbooks, name)
    for name in sorted(set(names) & set(workbooks.of_sheets)):
        workbooks.of_sheets.pop(name)
        action = Message("Keep one of {name} and the sheet; rename or remove the other.", name=name)
        place, allowed = workbooks.places.pop(name), Message("one table of a kind")
        workbooks.problems.append(error("unreadable_file", place, value=name, allowed=allowed, action=action))
    for place, rows in workbooks.unread.items():
        headings = next((cells for cells in rows if len(cells) > 2), [])
        shares = {
            form: len(set(columns_by_synonym(form, headings).values()) & set(form.required)) / len(form.required)
            for form in TABLES
        }
        form = max(shares, key=lambda form: shares[form])
        if shares[form] >= _LIKELY and form.file not in {*names, *workbooks.of_sheets}:
            action = Message(
                "It looks like {table}: call the sheet so if it is. Otherwise no action is needed.", table=form.name
            )
            allowed = Message("sheets called {names}", names=[*DESCRIBING, *FORMS])
            sheet = place.rpartition(", sheet ")[2]
            workbooks.problems.append(warning("unread_sheet", place, value=sheet, allowed=allowed, action=action))
    return workbooks


def is_workbook(name: str) -> bool:
    """True if a file is a workbook by its name, and not a lock file of a spreadsheet program.

    >>> is_workbook("Hang.XLSX"), is_workbook("~$Hang.xlsx"), is_workbook("hang.csv")
    (True, False, False)
    """
    return name.lower().endswith(ENDINGS) and not name.startswith((".", "~$"))


def _read_workbook(workbooks: UnfoldedFiles, workbook: str) -> None:
    """Turn a workbook's sheets into campaign.toml and tables; other sheets stay unread.

    An unreadable workbook, and a second sheet of a table, become problems.
    """
    try:
        data = workbooks.files.read(workbook)
        if data is None:
            return
        workbooks.hashes[workbook] = hashlib.sha256(data).hexdigest()
        sheets = workbook_sheets(data, wanted=lambda _: True)
    except (ContentError, OSError) as failure:
        what = failure.strerror or str(failure) if isinstance(failure, OSError) else str(failure)
        value, _, advice = what.partition(". ")
        action = Message("{advice}", advice=advice) if advice else Message("Save it again, or as CSV.")
        allowed = Message("a workbook (.xlsx) with a sheet for each table")
        workbooks.problems.append(error("unreadable_file", workbook, value=value, allowed=allowed, action=action))
        return
    describing: dict[str, Rows] = {}
    for title, rows in ((title, rows) for title, rows in sheets.items() if rows):
        kind = _kind(title)
        place = f"{workbook}, sheet {title}"
        if kind in DESCRIBING:
            describing[kind] = rows
        elif kind not in FORMS:
            workbooks.unread[place] = rows
        elif FORMS[kind].file in workbooks.of_sheets:
            action = Message("Keep one of the sheets; rename or remove the other.")
            workbooks.problems.append(
                error("unreadable_file", place, value=title, allowed=Message("one table of a kind"), action=action)
            )
        else:
            workbooks.of_sheets[FORMS[kind].file] = _csv(rows)
            workbooks.places[FORMS[kind].file] = place
    if describing:
        workbooks.of_sheets[DESCRIPTION] = description_text(describing).encode()
        workbooks.places[DESCRIPTION] = f"{workbook}, sheets {', '.join(describing)}"


def _kind(title: str) -> str:
    """Name of a table from the title of a sheet.

    >>> _kind(" Drop cone "), _kind("penetration.csv")
    ('drop_cone', 'penetration')
    """
    return "_".join(title.casefold().removesuffix(".csv").split())


def _csv(rows: Iterable[list[str]]) -> bytes:
    """CSV of rows, all cells in quotes; each row, also a blank one, has one line, so that row numbers stay."""
    stream = io.StringIO()
    csv.writer(stream, lineterminator="\n", quoting=csv.QUOTE_ALL).writerows(rows)
    return stream.getvalue().encode()


CAMPAIGN: Final = "campaign"
TOOLS: Final = "tools"
PLATES: Final = "plates"
COLUMNS: Final = "columns"
DESCRIBING: Final = (CAMPAIGN, TOOLS, PLATES, COLUMNS)
"""Names of the sheets; each has a header in its first row that is not blank."""

_LISTS: Final = ("observers", "exclude", "load_steps_N")
_TEXTS: Final = ("name", "shape", *(name for name, key in CAMPAIGN_KEYS.items() if key.kind == "text"))


def description_text(sheets: Mapping[str, Rows]) -> str:
    """Convert the sheets that describe the campaign to TOML.

    sheets: rows by the names of `DESCRIBING`. ``campaign`` has the columns key and value, with semicolons between
        several values; ``tools`` and ``plates`` have the keys of ``[[tool]]`` and ``[[plate]]`` as columns; ``columns``
        has heading, column or unit or both, and optionally table.
    """
    lines = []
    for row in _records(sheets.get(COLUMNS, [])):
        keys = (*filter(None, (row.get("table"),)), row.get("heading", ""))
        for section, name in (("columns", "column"), ("units", "unit")):
            if row.get("heading") and row.get(name):
                lines.append(f"{'.'.join((section, *map(toml_text, keys)))} = {toml_text(row[name])}")
    for row in _records(sheets.get(CAMPAIGN, [])):
        key = row.get("key", "")
        if key and row.get("value"):
            lines.append(f"{'screening.' if key == 'exclude' else ''}{_toml_line(key, row['value'])}")
    for kind, sheet in (("tool", TOOLS), ("plate", PLATES)):
        for row in _records(sheets.get(sheet, [])):
            lines += [f"[[{kind}]]", *(_toml_line(key, cell) for key, cell in row.items() if key and cell)]
    return "\n".join((*filter(None, lines), ""))


def _records(rows: Rows) -> Iterator[Mapping[str, str]]:
    """Yield each row that is not blank as a mapping from the names in the first such row to its cells."""
    filled = (cells for cells in rows if any(cells))
    header: Sequence[str] = next(filled, [])
    for cells in filled:
        yield dict(zip(header, cells, strict=False))


def _toml_line(key: str, cell: str) -> str:
    """TOML line of a key and a cell's text; a list is separated by semicolons."""
    if key in _LISTS:
        several = ", ".join(_value(item) for item in re.split(r"\s*;\s*", cell) if item)
        return f"{toml_text(key)} = [{several}]"
    return f"{toml_text(key)} = {toml_text(cell) if key in _TEXTS else _value(cell)}"


def _value(cell: str) -> str:
    """Text of a cell as a value of TOML: a number with a decimal point or comma, or else a text.

    >>> _value("0,01"), _value("12"), _value("Müller")
    ('0.01', '12.0', '"Müller"')
    """
    if is_number(cell, ".") or is_number(cell, ","):
        return repr(float(cell.replace(",", ".")))
    return toml_text(cell)
