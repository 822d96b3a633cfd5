"""The sheets that describe a campaign, as the text of campaign.toml: campaign, tools, plates, columns."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Final

from ..._support.spreadsheet_text import is_number
from .campaign_file import CAMPAIGN_KEYS

if TYPE_CHECKING:
    from ..._support.user_files.workbook import Rows

CAMPAIGN: Final = "campaign"
TOOLS: Final = "tools"
PLATES: Final = "plates"
COLUMNS: Final = "columns"
DESCRIBING: Final = (CAMPAIGN, TOOLS, PLATES, COLUMNS)
"""Names of the sheets; each has a header in its first row that is not blank."""

_LISTS: Final = ("observers", "exclude", "load_steps_N")
_TEXTS: Final = ("name", "shape", *(name for name, key in CAMPAIGN_KEYS.items() if key.kind == "text"))


def description_text(sheets: Mapping[str, Rows]) -> str:
    """What the sheets say, as TOML.

    Parameters
    ----------
    sheets
        Rows by the names of `DESCRIBING`. ``campaign`` has the columns key and value, with several values of one key
        parted by semicolons; ``tools`` and ``plates`` have the keys of ``[[tool]]`` and ``[[plate]]`` as columns;
        ``columns`` has heading, and column or unit or both, and may have table.
    """
    lines = [line for row in _records(sheets.get(COLUMNS, [])) for line in _column_lines(row)]
    for row in _records(sheets.get(CAMPAIGN, [])):
        key = row.get("key", "")
        if key and row.get("value"):
            lines.append(f"{'screening.' if key == 'exclude' else ''}{_pair(key, row['value'])}")
    for kind, sheet in (("tool", TOOLS), ("plate", PLATES)):
        for row in _records(sheets.get(sheet, [])):
            lines += [f"[[{kind}]]", *(_pair(key, cell) for key, cell in row.items() if key and cell)]
    return "\n".join((*filter(None, lines), ""))


def _records(rows: Rows) -> Iterator[Mapping[str, str]]:
    """Rows that are not blank, by the names in the first of them."""
    filled = (cells for cells in rows if any(cells))
    header: Sequence[str] = next(filled, [])
    for cells in filled:
        yield dict(zip(header, cells, strict=False))


def _column_lines(row: Mapping[str, str]) -> Iterator[str]:
    heading, table = row.get("heading", ""), row.get("table", "")
    for section, name in (("columns", "column"), ("units", "unit")):
        if heading and row.get(name):
            yield f"{section}.{f'{_quoted(table)}.' if table else ''}{_quoted(heading)} = {_quoted(row[name])}"


def _pair(key: str, cell: str) -> str:
    if key in _LISTS:
        several = ", ".join(_value(each) for each in re.split(r"\s*;\s*", cell) if each)
        return f"{_quoted(key)} = [{several}]"
    return f"{_quoted(key)} = {_quoted(cell) if key in _TEXTS else _value(cell)}"


def _value(cell: str) -> str:
    """A number where the cell is one, with a point or a comma, else a text.

    >>> _value("0,01"), _value("12"), _value("Müller")
    ('0.01', '12.0', '"Müller"')
    """
    if is_number(cell, ".") or is_number(cell, ","):
        return repr(float(cell.replace(",", ".")))
    return _quoted(cell)


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")
