"""Tables of reports, as CSV (RFC 4180) and as HTML."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Any, Final, Literal, TypeAlias

import orjson
from markupsafe import Markup

from .._support.messages import Message, joined, local_number
from .._support.spreadsheet_text import protect_from_formulas
from . import formatting
from .formatting import html, prose

Kind: TypeAlias = Literal[
    "text", "words", "codes", "yes", "tick", "count", "angle", "hundredths", "number", "p", "interval", "range",
    "estimate",
]  # fmt: skip
"""Kind of the cells of a column.

text: text from a user; words: text of skisnow, with symbols; codes: list of names; yes: truth value; tick: truth value,
shown only if true; count: integer; angle: degrees with all given digits; hundredths: number with two decimals; number:
float or None; p: p value; interval: pair or None; range: minimum and maximum or None; estimate: (value, pair), one cell
in HTML.
"""

ROWS_IN_HTML: Final = 300


@dataclass(frozen=True, slots=True)
class Column:
    """Column of a table.

    key: name in CSV, including the unit; a key of the records.
    header, unit: texts in HTML, with symbols as ``H_V``.
    digits: significant digits in HTML; CSV has all digits.
    interval: key of the 95 % interval of an estimate.
    """

    key: str
    header: str
    kind: Kind = "number"
    unit: str = ""
    digits: int = 3
    interval: str = ""

    @property
    def numeric(self) -> bool:
        """True if the cells are right-aligned."""
        return self.kind in ("count", "angle", "hundredths", "number", "p", "interval", "range", "estimate")

    def cells(self, records: Sequence[Mapping[str, Any]]) -> list[Any]:
        """Values of this column for each record; of an estimate, the value with its interval."""
        values = [record.get(self.key) for record in records]
        if self.kind == "estimate":
            return [(value, record.get(self.interval)) for value, record in zip(values, records, strict=True)]
        return values


@dataclass(frozen=True)
class Table:
    """Table of a report; a row has one cell for each column.

    ``note`` is printed below the table. ``rows_in_html`` is the maximum number of rows in HTML; CSV has all rows.
    ``synthetic`` marks numbers that were not measured.
    """

    name: str
    caption: str
    columns: tuple[Column, ...]
    rows: Sequence[tuple[Any, ...]]
    note: str = ""
    rows_in_html: int = ROWS_IN_HTML
    synthetic: bool = False

    @property
    def file_stem(self) -> str:
        """Name of the table's files without their ending."""
        return f"{self.name}_synthetic" if self.synthetic else self.name

    @property
    def full_caption(self) -> str:
        """The caption, with a sentence if the data are synthetic."""
        return joined([self.caption, Message("Synthetic data.")]) if self.synthetic else self.caption


def record_table(
    name: str, caption: str, columns: tuple[Column, ...], records: Iterable[Mapping[str, Any]], **options: Any
) -> Table:
    """Table with one row for each record; the keys of the columns are those of the records."""
    rows = list(records)
    return Table(name, caption, columns, list(zip(*(column.cells(rows) for column in columns), strict=True)), **options)


def table_csv(table: Table) -> str:
    """CSV of the whole table; an interval has two columns, ``…_low`` and ``…_high``."""
    buffer = io.StringIO(newline="")
    writer = csv.writer(buffer, lineterminator="\r\n")
    endings = {"interval": ("_low", "_high"), "range": ("_low", "_high"), "estimate": ("", "_low", "_high")}
    writer.writerow(f"{column.key}{end}" for column in table.columns for end in endings.get(column.kind, ("",)))
    columns = [_csv_cells(column, [row[i] for row in table.rows]) for i, column in enumerate(table.columns)]
    writer.writerows(zip(*chain.from_iterable(columns), strict=True))
    return buffer.getvalue()


def _csv_cells(column: Column, values: Sequence[Any]) -> list[Sequence[str]]:
    """CSV columns of a table's column: two for an interval, three for an estimate, otherwise one."""
    if column.kind in ("interval", "range"):
        return _digits_of_ends(values)
    if column.kind == "estimate":
        return [_digits([value for value, _ in values]), *_digits_of_ends([pair for _, pair in values])]
    if column.numeric:
        return [_digits(values)]
    if column.kind in ("yes", "tick"):
        return [["true" if value else "false" for value in values]]
    texts = map("; ".join, values) if column.kind == "codes" else ("" if v is None else str(v) for v in values)
    return [list(map(protect_from_formulas, texts))]


def _digits_of_ends(pairs: Sequence[Any]) -> list[Sequence[str]]:
    """CSV columns of the lower and upper ends of intervals; empty cells for None."""
    return [_digits([None if pair is None else pair[end] for pair in pairs]) for end in (0, 1)]


def _digits(values: Sequence[float | None]) -> list[str]:
    """Numbers of a column with the fewest digits that are read as the same number; "" for None."""
    return orjson.dumps(values).decode("ascii")[1:-1].replace("null", "").split(",") if values else []


LISTED_NAMES: Final = 20
COLUMNS_OF_NARROW: Final = 7
"""Maximum number of columns of a table that has intervals next to the values instead of below them."""


def table_html(table: Table, *, number: int) -> Markup:
    """HTML of a table in a scrolling box.

    On a narrow screen each cell is a line with the column's name (report.css); roles keep it a table.
    """
    head = Markup("").join(_header_html(column) for column in table.columns)
    shown = table.rows[: table.rows_in_html]
    body = Markup("\n").join(
        Markup('<tr role="row">')
        + Markup("").join(map(_cell_html, table.columns, row, range(len(row))))
        + Markup("</tr>")
        for row in shown
    )
    return Markup(
        '<div class="table" id="table-{name}" role="region" aria-label="{label}" tabindex="0">'
        '<table role="table"{kind}>\n'
        "<caption><b>{label}.</b> {caption}</caption>\n"
        '<thead role="rowgroup"><tr role="row">{head}</tr></thead>\n<tbody role="rowgroup">\n{body}\n</tbody>'
        "</table></div>\n{below}"
    ).format(
        name=table.name,
        kind=Markup(' class="narrow"') if len(table.columns) <= COLUMNS_OF_NARROW else Markup(""),
        label=str(Message("Table {number}", number=number)),
        caption=html(table.full_caption),
        head=head,
        body=body,
        below=_notes_below(table),
    )


def _header_html(column: Column) -> Markup:
    """HTML of a column's header with its unit."""
    unit = Markup(" <small>{}</small>").format(html(column.unit)) if column.unit else Markup("")
    return Markup('<th scope="col" role="columnheader"{kind}>{text}{unit}</th>').format(
        kind=Markup(' class="n"') if column.numeric else Markup(""), text=html(column.header), unit=unit
    )


def _cell_html(column: Column, value: Any, index: int) -> Markup:
    """HTML of a cell, a row header in the first column; a dash or the like for None."""
    content = Markup(formatting.ABSENT["typeset"]) if value is None else _SET[column.kind](value, column.digits)
    if index == 0:
        return Markup('<th scope="row" role="rowheader">{}</th>').format(content)
    named = f"{column.header} ({column.unit})" if column.unit else str(column.header)
    kind = Markup(' class="n"') if column.numeric else Markup("")
    return Markup('<td role="cell"{} data-name="{}">{}</td>').format(kind, named, content)


def _estimate_html(value: tuple[float | None, Any], digits: int) -> Markup:
    """HTML of a number and, unless it is None, its interval."""
    number, pair = value
    text = Markup(formatting.significant(number, digits))
    if pair is None:
        return text
    return Markup('{} <span class="i">{}</span>').format(text, formatting.interval(pair, digits))


def _names_text(names: list[str]) -> Markup:
    """The first names, and the number of the others."""
    listed = Markup(", ").join(names[:LISTED_NAMES])
    more = len(names) - LISTED_NAMES
    return prose("{listed} and {more} more", listed=listed, more=formatting.whole(more)) if more > 0 else listed


_SET: Final[dict[Kind, Callable[[Any, int], Markup]]] = {
    "text": lambda value, _: Markup.escape(str(value)),
    "words": lambda value, _: html(value),
    "codes": lambda value, _: _names_text(value),
    "yes": lambda value, _: html(Message("yes") if value else Message("no")),
    "tick": lambda value, _: Markup('<span role="img" aria-label="{}">✓</span>' if value else "").format(
        str(Message("yes"))
    ),
    "count": lambda value, _: Markup(formatting.whole(value)),
    "angle": lambda value, _: Markup(local_number(f"{value:.6g}")),
    "hundredths": lambda value, _: Markup(local_number(f"{value:.2f}".replace("-", "−"))),
    "number": lambda value, digits: Markup(formatting.significant(value, digits)),
    "p": lambda value, _: Markup.escape(formatting.probability(value).replace(" ", "\u00a0")),
    "interval": lambda value, digits: Markup(formatting.interval(value, digits)),
    "range": lambda value, digits: Markup(formatting.from_to(value, digits)),
    "estimate": _estimate_html,
}


def _notes_below(table: Table) -> Markup:
    """HTML of a table's note, and where all rows are if only the first are shown; empty without both."""
    cut = len(table.rows) - table.rows_in_html
    sentences = [html(table.note)] if table.note else []
    if cut > 0:
        sentences.append(
            prose(
                "The first {shown} of {all} rows; {file} contains all of them.",
                shown=formatting.whole(table.rows_in_html),
                all=formatting.whole(len(table.rows)),
                file=Markup("<code>tables/{}.csv</code>").format(table.file_stem),
            )
        )
    return Markup('<p class="note">{}</p>').format(Markup(" ").join(sentences)) if sentences else Markup("")
