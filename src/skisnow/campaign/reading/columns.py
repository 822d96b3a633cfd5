"""A table as it was read: columns of names, numbers and texts, each cell checked."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np

from ..problems import error, warning
from .cell_values import is_number, iso_moment, numbers
from .table_forms import UNLOADING, allowed_words

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from ...parameters import Quantity
    from ..problems import Problem
    from ..records import BoolArray, FloatArray, IntArray
    from .heading_units import UnitConversion
    from .table_forms import TableForm


@dataclass(frozen=True, slots=True)
class Rows:
    """Some rows of a file: their file lines, and the cells of the column that names the experiment."""

    file: str
    line: Sequence[int]
    key: Sequence[str]

    def problem(self, code: str, index: int, *, column: str, value: str, allowed: str, action: str) -> Problem:
        """Make an error about one cell."""
        return error(
            code,
            self.file,
            row=self.line[index],
            column=column,
            experiment=self.key[index].strip() or None,
            value=value,
            allowed=allowed,
            action=action,
        )


class Collector(Protocol):
    """Takes the cells of one column, some rows at a time."""

    def take(self, cells: Sequence[str], rows: Rows, found: list[Problem]) -> None:
        """Take cells; put what is wrong with them into ``found``."""


@dataclass(frozen=True, slots=True)
class NameColumn:
    """A column of text in which few texts stand often: the distinct ones, and one code per row."""

    names: tuple[str, ...]
    code: IntArray

    @property
    def is_blank(self) -> BoolArray:
        """Tell the rows without a name."""
        blank = np.array([not name for name in self.names], dtype=np.bool_)
        return blank[self.code]

    def __getitem__(self, index: int) -> str:
        """Give one cell."""
        return self.names[self.code[index]]

    def cells(self) -> tuple[str, ...]:
        """Give all cells; equal ones are one object."""
        return tuple(map(self.names.__getitem__, self.code.tolist()))


class _NameCodes(dict[str, int]):
    """Code of each cell; the dictionary asks for each distinct cell once, and strips it."""

    def __init__(self) -> None:
        super().__init__()
        self.code_of_name: dict[str, int] = {}

    def __missing__(self, cell: str) -> int:
        code = self.code_of_name.setdefault(cell.strip(), len(self.code_of_name))
        self[cell] = code
        return code


class NameCollector:
    """Collects names; a required one may not be blank."""

    def __init__(self, column: str, *, required: bool) -> None:
        self._column = column
        self._required = required
        self._codes = _NameCodes()
        self._parts: list[IntArray] = []

    def take(self, cells: Sequence[str], rows: Rows, found: list[Problem]) -> None:
        """See `Collector.take`."""
        code = np.fromiter(map(self._codes.__getitem__, cells), np.int64, len(cells))
        self._parts.append(code)
        blank = self._codes.code_of_name.get("")
        if self._required and blank is not None:
            found.extend(self._blank(index, rows) for index in np.flatnonzero(code == blank).tolist())

    def _blank(self, index: int, rows: Rows) -> Problem:
        return rows.problem(
            "out_of_range", index, column=self._column, value="", allowed="a non-empty name", action="Fill the cell."
        )

    def column(self, count: int) -> NameColumn:
        """Give the column; blank where the file does not have it."""
        if not self._parts:
            return NameColumn(("",), np.zeros(count, dtype=np.int64))
        return NameColumn(tuple(self._codes.code_of_name), np.concatenate(self._parts))


class NumberCollector:
    """Collects numbers in the unit of the column's name; NaN where a cell is blank or refused."""

    def __init__(self, column: Quantity, mark: str, unit: UnitConversion | None = None) -> None:
        self._column = column
        self._mark = mark
        self._unit = unit if unit is not None and unit.changes else None
        self._parts: list[FloatArray] = []

    def take(self, cells: Sequence[str], rows: Rows, found: list[Problem]) -> None:
        """See `Collector.take`."""
        values = numbers(cells, self._mark)
        for index in np.flatnonzero(np.isnan(values)).tolist():
            cell = cells[index].strip()
            if cell or self._column.needed:
                found.append(self._refusal("not_a_number", index, cell, rows, self._how_to_write(cell)))
        if self._unit is not None:
            with np.errstate(over="ignore"):
                values = self._unit.convert(values)
        outside = self._column.outside(values) | np.isinf(values)
        for index in np.flatnonzero(outside).tolist():
            action = "Correct the cell; its unit stands in the column's name."
            cell = cells[index].strip() + (f" {self._unit.name}" if self._unit is not None else "")
            found.append(self._refusal("out_of_range", index, cell, rows, action))
        values[outside] = np.nan
        self._parts.append(values)

    def _refusal(self, code: str, index: int, cell: str, rows: Rows, action: str) -> Problem:
        return rows.problem(
            code, index, column=self._column.name, value=cell, allowed=allowed_words(self._column), action=action
        )

    def _how_to_write(self, cell: str) -> str:
        if not cell:
            return "Enter the number."
        for mark, other, words in ((",", ".", "decimal commas"), (".", ",", "decimal points")):
            if self._mark == mark and is_number(cell, other):
                return f"This file writes {words}; {cell} could be a thousand. Write it as the other cells."
        return f"Write a plain number such as 12{self._mark}5, without unit, remark or thousands separator."

    def column(self, count: int) -> FloatArray:
        """Give the column; NaN where the file does not have it."""
        return np.concatenate(self._parts) if self._parts else np.full(count, np.nan)


class TextCollector:
    """Collects texts, stripped; equal ones that stand near each other are one object."""

    def __init__(self) -> None:
        self._texts: list[str] = []

    def take(self, cells: Sequence[str], rows: Rows, found: list[Problem]) -> None:  # noqa: ARG002
        """See `Collector.take`."""
        once: dict[str, str] = {}
        self._texts.extend(once.setdefault(cell, cell) for cell in map(str.strip, cells))

    def column(self) -> tuple[str, ...]:
        """Give the column."""
        return tuple(self._texts)


@dataclass(frozen=True, slots=True)
class Table:
    """A table as it was read: n rows in the order of the file, numbers in the units of the columns' names.

    Attributes
    ----------
    form
        What the table must and may have.
    row
        File line of each row.
    names
        The required and the interpreted optional text columns, whether the file has them or not.
    numbers
        Every column of numbers of the form; NaN where blank, absent or refused.
    further
        The other columns of the file, unknown ones too, as text.
    absent
        Required columns that the file lacks.
    headings
        Headings as the file has them.
    unstated
        Headings without a unit, by their columns of numbers.
    """

    form: TableForm
    row: IntArray
    names: Mapping[str, NameColumn]
    numbers: Mapping[str, FloatArray]
    further: Mapping[str, tuple[str, ...]]
    absent: frozenset[str]
    headings: tuple[str, ...]
    unstated: Mapping[str, str]

    def __len__(self) -> int:
        """Count the rows."""
        return len(self.row)


class DateCollector:
    """Collects days and times, written after ISO 8601; one that cannot be read stays as it is, and is reported once."""

    def __init__(self, column: str) -> None:
        self._column = column
        self._written: dict[str, str | None] = {"": ""}
        self._texts: list[str] = []
        self._unread: list[tuple[int, str, str]] = []

    def take(self, cells: Sequence[str], rows: Rows, found: list[Problem]) -> None:  # noqa: ARG002
        """See `Collector.take`."""
        for index, cell in enumerate(map(str.strip, cells)):
            if cell not in self._written:
                self._written[cell] = iso_moment(cell)
            written = self._written[cell]
            if written is None:
                self._unread.append((rows.line[index], cell, rows.key[index]))
            self._texts.append(cell if written is None else written)

    def problems(self, file: str) -> list[Problem]:
        """What could not be read, in one warning."""
        if not self._unread:
            return []
        line, cell, key = self._unread[0]
        more = f", and {len(self._unread) - 1} more like it" if len(self._unread) > 1 else ""
        return [
            warning(
                "unreadable_date",
                file,
                row=line,
                column=self._column,
                experiment=key.strip() or None,
                value=f"{cell}{more}",
                allowed="a day such as 2026-11-23 or 23.11.2026, with or without a time such as 09:10",
                action="Write it so; no estimate needs it, but the report does not name this day.",
            )
        ]

    def column(self) -> tuple[str, ...]:
        """Give the column."""
        return tuple(self._texts)


def is_unloading_cell(cell: str) -> bool:
    """True if the cell marks a reading of the unloading, when discs are taken off."""
    return cell.strip().casefold() == UNLOADING


def is_unloading(branch: NameColumn) -> BoolArray:
    """True for each row that is a reading of the unloading."""
    return np.array(list(map(is_unloading_cell, branch.names)), dtype=np.bool_)[branch.code]
