"""A table as it was read."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ..records import FloatArray, IntArray
    from .columns import NameColumn
    from .table_forms import TableForm


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
