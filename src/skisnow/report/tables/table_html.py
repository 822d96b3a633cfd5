"""A table as HTML: caption, header cells with scope, numbers to a few digits, long tables cut with a sentence."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from markupsafe import Markup

from .. import formatting
from ..symbols import html, prose

if TYPE_CHECKING:
    from collections.abc import Callable

    from .table import Column, Kind, Table

LISTED_NAMES: Final = 20
COLUMNS_OF_NARROW: Final = 7
"""Up to so many columns an interval stands beside its value, else below it."""


def table_html(table: Table, *, number: int) -> Markup:
    """The table in a box of its own.

    On a narrow screen its rows stand below each other, each cell behind its column's name (report.css); roles say that
    it stays a table.
    """
    head = Markup("").join(_header(column) for column in table.columns)
    shown = table.rows[: table.rows_in_html]
    body = Markup("\n").join(
        Markup('<tr role="row">')
        + Markup("").join(_cell(column, value, index) for index, (column, value) in _pairs(table, row))
        + Markup("</tr>")
        for row in shown
    )
    return Markup(
        '<div class="table" id="table-{name}" role="region" aria-label="{label}" tabindex="0">'
        '<table role="table"{kind}>\n'
        "<caption><b>Table {number}.</b> {caption}</caption>\n"
        '<thead role="rowgroup"><tr role="row">{head}</tr></thead>\n<tbody role="rowgroup">\n{body}\n</tbody>'
        "</table></div>\n{below}"
    ).format(
        name=table.name,
        kind=Markup(' class="narrow"') if len(table.columns) <= COLUMNS_OF_NARROW else Markup(""),
        label=f"Table {number}",
        number=number,
        caption=html(table.full_caption),
        head=head,
        body=body,
        below=_below(table),
    )


def _pairs(table: Table, row: tuple[Any, ...]) -> enumerate[tuple[Column, Any]]:
    return enumerate(zip(table.columns, row, strict=True))


def _header(column: Column) -> Markup:
    unit = Markup(" <small>{}</small>").format(html(column.unit)) if column.unit else Markup("")
    return Markup('<th scope="col" role="columnheader"{kind}>{text}{unit}</th>').format(
        kind=Markup(' class="n"') if column.numeric else Markup(""), text=html(column.header), unit=unit
    )


def _cell(column: Column, value: Any, index: int) -> Markup:
    content = cell_html(column, value)
    if index == 0:
        return Markup('<th scope="row" role="rowheader">{}</th>').format(content)
    named = column.header + (f" ({column.unit})" if column.unit else "")
    kind = Markup(' class="n"') if column.numeric else Markup("")
    return Markup('<td role="cell"{} data-name="{}">{}</td>').format(kind, named, content)


def cell_html(column: Column, value: Any) -> Markup:
    """The content of a cell."""
    return Markup(formatting.ABSENT["typeset"]) if value is None else _SET[column.kind](value, column.digits)


def _estimate(value: tuple[float | None, Any], digits: int) -> Markup:
    number, pair = value
    if pair is None:
        return Markup(formatting.significant(number, digits))
    return Markup('{} <span class="i">{}</span>').format(
        formatting.significant(number, digits), formatting.interval(pair, digits)
    )


def _names(names: list[str]) -> Markup:
    listed = Markup(", ").join(names[:LISTED_NAMES])
    more = len(names) - LISTED_NAMES
    return listed + f" and {formatting.whole(more)} more" if more > 0 else listed


_SET: Final[dict[Kind, Callable[[Any, int], Markup]]] = {
    "text": lambda value, _: Markup.escape(value),
    "words": lambda value, _: html(value),
    "codes": lambda value, _: _names(value),
    "yes": lambda value, _: Markup("yes" if value else "no"),
    "tick": lambda value, _: Markup('<span role="img" aria-label="yes">✓</span>' if value else ""),
    "count": lambda value, _: Markup(formatting.whole(value)),
    "angle": lambda value, _: Markup(f"{value:.6g}"),
    "hundredths": lambda value, _: Markup(f"{value:.2f}".replace("-", "−")),
    "number": lambda value, digits: Markup(formatting.significant(value, digits)),
    "p": lambda value, _: Markup.escape(formatting.probability(value).replace(" ", "\u00a0")),
    "interval": lambda value, digits: Markup(formatting.interval(value, digits)),
    "range": lambda value, digits: Markup(formatting.from_to(value, digits)),
    "estimate": _estimate,
}


def _below(table: Table) -> Markup:
    cut = len(table.rows) - table.rows_in_html
    sentences = [html(table.note)] if table.note else []
    if cut > 0:
        sentences.append(
            prose(
                "The first {shown} of {all} rows; {file} holds them all.",
                shown=formatting.whole(table.rows_in_html),
                all=formatting.whole(len(table.rows)),
                file=Markup("<code>tables/{}.csv</code>").format(table.file_stem),
            )
        )
    return Markup('<p class="note">{}</p>').format(Markup(" ").join(sentences)) if sentences else Markup("")
