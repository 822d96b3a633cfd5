"""A table of a report, apart from its format, and the table as CSV (RFC 4180)."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass
from itertools import chain
from typing import TYPE_CHECKING, Any, Final, Literal, TypeAlias

import orjson

from ..._support.spreadsheet_text import guarded

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

Kind: TypeAlias = Literal[
    "text", "words", "codes", "yes", "tick", "count", "angle", "hundredths", "number", "p", "interval", "range",
    "estimate",
]  # fmt: skip
"""What a cell holds.

text: what a user wrote; words: our own, with symbols; codes: a list of names; yes: a truth value; tick: the same, shown
only where true; count: an integer; angle: degrees as they were set; hundredths: two decimals, as races are timed and
poles set; number: a float or None; p: a p value; interval: a pair or None; range: the same, minimum and maximum;
estimate: (value, pair), in HTML and LaTeX one cell.
"""

ROWS_IN_HTML: Final = 300
ROWS_IN_LATEX: Final = 2000


@dataclass(frozen=True, slots=True)
class Column:
    """One column.

    Attributes
    ----------
    key
        Name in CSV, unit included; the key of results.json where there is one.
    header, unit
        As people read them; symbols as ``H_V``.
    kind
        What the cells hold.
    digits
        Significant digits in HTML and LaTeX; CSV has them all.
    interval
        Key of the 95 % interval that belongs to an estimate.
    """

    key: str
    header: str
    kind: Kind = "number"
    unit: str = ""
    digits: int = 3
    interval: str = ""

    @property
    def numeric(self) -> bool:
        """Whether the cells are set right-aligned."""
        return self.kind in ("count", "angle", "hundredths", "number", "p", "interval", "range", "estimate")

    def cell(self, record: Mapping[str, Any]) -> Any:
        """Content of this column in the row of a record; an estimate gets its interval."""
        value = record.get(self.key)
        return (value, record.get(self.interval)) if self.kind == "estimate" else value


@dataclass(frozen=True)
class Table:
    """One table; a row has one cell for each column.

    ``caption`` is a sentence, ``note`` stands below it. ``rows_in_html`` cuts a long table in HTML; CSV holds all rows.
    ``synthetic`` says that its numbers were not measured.
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
        """The caption, with the word *synthetic* where it applies."""
        return f"{self.caption} Synthetic data." if self.synthetic else self.caption


def record_table(
    name: str, caption: str, columns: tuple[Column, ...], records: Iterable[Mapping[str, Any]], **options: Any
) -> Table:
    """A table with one row for each record, whose cells are found by the keys of the columns."""
    return Table(
        name, caption, columns, [tuple(column.cell(record) for column in columns) for record in records], **options
    )


def table_csv(table: Table) -> str:
    """The whole table; an interval takes two columns, ``…_low`` and ``…_high``, beside its value's."""
    buffer = io.StringIO(newline="")
    writer = csv.writer(buffer, lineterminator="\r\n")
    writer.writerow(chain.from_iterable(_names(column) for column in table.columns))
    columns = [_cells(column, [row[i] for row in table.rows]) for i, column in enumerate(table.columns)]
    writer.writerows(zip(*chain.from_iterable(columns), strict=True))
    return buffer.getvalue()


def _names(column: Column) -> tuple[str, ...]:
    ends = (f"{column.key}_low", f"{column.key}_high")
    return {"interval": ends, "range": ends, "estimate": (column.key, *ends)}.get(column.kind, (column.key,))


def _cells(column: Column, values: Sequence[Any]) -> list[Sequence[str]]:
    if column.kind in ("interval", "range"):
        return _ends(values)
    if column.kind == "estimate":
        return [_digits([value for value, _ in values]), *_ends([pair for _, pair in values])]
    if column.numeric:
        return [_digits(values)]
    return [list(map(_WRITTEN[column.kind], values))]


def _ends(pairs: Sequence[Any]) -> list[Sequence[str]]:
    return [_digits([None if pair is None else pair[end] for pair in pairs]) for end in (0, 1)]


def _digits(values: Sequence[float | None]) -> list[str]:
    """The fewest digits that read back as the same number, of a whole column at once; empty where there is none."""
    return orjson.dumps(values).decode("ascii")[1:-1].replace("null", "").split(",") if values else []


def _text(value: Any) -> str:
    return "" if value is None else guarded(str(value))


def _truth(value: bool) -> str:
    return "true" if value else "false"


_WRITTEN: Final[dict[str, Callable[[Any], str]]] = {
    "text": _text,
    "words": _text,
    "yes": _truth,
    "tick": _truth,
    "codes": lambda codes: guarded("; ".join(codes)),
}
