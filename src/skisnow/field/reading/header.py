"""The header of a table: which columns it has, which are missing, which nobody knows."""

from __future__ import annotations

import difflib
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..problems import error, warning

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..problems import Problem
    from .table_forms import TableForm


@dataclass(frozen=True, slots=True)
class Header:
    """Names of the columns, stripped, and the file line at which they stand; an unnamed column is ``""``."""

    columns: tuple[str, ...]
    row: int

    @classmethod
    def from_cells(cls, cells: Sequence[str], row: int) -> Header:
        """Make a header from its cells."""
        return cls(tuple(cell.strip().strip("\ufeff").strip() for cell in cells), row)

    @property
    def position(self) -> dict[str, int]:
        """Where each named column stands; of equal names the first."""
        backwards = reversed(range(len(self.columns)))
        places = {self.columns[index]: index for index in backwards if self.columns[index]}
        return dict(sorted(places.items(), key=lambda item: item[1]))

    @property
    def unnamed(self) -> tuple[int, ...]:
        """Where columns without a name stand."""
        return tuple(index for index, name in enumerate(self.columns) if not name)

    def with_column(self, name: str) -> Header:
        """Append a column."""
        return Header((*self.columns, name), self.row)


def check_header(form: TableForm, header: Header) -> list[Problem]:
    """Find missing, repeated and unknown columns."""
    present = header.position
    unknown = [name for name in present if name not in form.known]
    missing = [name for name in form.required if name not in present]
    repeated = [name for name, times in Counter(filter(None, header.columns)).items() if times > 1]
    problems = [_repeated(form, name, header.row) for name in repeated]
    problems += [_missing(form, name, unknown, header.row) for name in missing]
    problems += [_unknown(form, name, header) for name in unknown]
    return problems


def _repeated(form: TableForm, name: str, row: int) -> Problem:
    return error(
        "unreadable_file",
        form.file,
        row=row,
        column=name,
        value=name,
        allowed="each column once",
        action="Rename or remove one of the columns of this name.",
    )


def _missing(form: TableForm, name: str, unknown: Sequence[str], row: int) -> Problem:
    as_written = {each.lower(): each for each in unknown}
    near = difflib.get_close_matches(name.lower(), list(as_written), n=1)
    meant = as_written[near[0]] if near else None
    hint = f"Is the column {meant!r} meant? Rename it" if meant else "Add it"
    return error(
        "missing_column",
        form.file,
        row=row,
        column=name,
        value=meant,
        allowed=f"the columns {', '.join(form.required)}",
        action=f"{hint}; the unit belongs to the name.",
    )


def _unknown(form: TableForm, name: str, header: Header) -> Problem:
    free = [each for each in form.known if each not in header.columns]
    near = difflib.get_close_matches(name, free, n=1)
    hint = f"rename it where {near[0]!r} is meant" if near else "nothing need be done"
    return warning(
        "unknown_column",
        form.file,
        row=header.row,
        column=name,
        value=name,
        allowed=f"the columns {', '.join(form.known)}",
        action=f"The column is kept as text and not interpreted; {hint}.",
    )
