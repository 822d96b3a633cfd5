"""A table of the report: what it holds, apart from how it is written (`table_html`, `table_csv`, `table_latex`)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Literal, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

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
