"""Corrections of single cells in a separate file, applied before the raw files are interpreted.

A correction has the old and the new text of the cell. It is not applied if the cell has another text, because then the
raw file or the correction is not the intended one.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from functools import partial
from typing import TypeAlias

from ..._support.messages import Message
from ..._support.spreadsheet_text import is_number, number
from ..problems import AppliedCorrection, Problem, error
from .columns import Table
from .header import Header
from .table_forms import CORRECTIONS, TABLES, TableForm

STATUS = "status"


@dataclass(frozen=True, slots=True)
class Correction(AppliedCorrection):
    """One row of corrections.csv; ``line`` is its line in corrections.csv, ``row`` the corrected line."""

    line: int

    def applied(self) -> AppliedCorrection:
        """Correction without its line, for the records of the campaign."""
        return AppliedCorrection(*(getattr(self, field.name) for field in fields(AppliedCorrection)))

    def mismatch(self, column: str, value: str, allowed: Message) -> Problem:
        """Error for a column of corrections.csv whose value in this correction does not match the raw file."""
        mismatch = partial(error, "correction_mismatch", CORRECTIONS.file, row=self.line, column=column)
        place = {"file": self.file, "row": self.row}
        action = Message("Look at {file}, row {row}: put this correction right, or delete its row.", **place)
        return mismatch(experiment=self.experiment or None, value=value, allowed=allowed, action=action)


RowCorrections: TypeAlias = "Mapping[int, Sequence[Correction]]"
"""Corrections of one file by line; those of a line in the order of corrections.csv."""


def corrections_by_file(table: Table, problems: list[Problem]) -> dict[str, dict[int, list[Correction]]]:
    """Corrections in the rows of corrections.csv, by corrected file and line; errors are added to the problems."""
    files = [form.file for form in TABLES]
    sorted_by_file: dict[str, dict[int, list[Correction]]] = {}
    lines, rows = table.row.tolist(), table.numbers["row"].tolist()
    names = (table.names[name].cells() for name in ("file", "experiment", "column"))
    texts = (table.further[name] for name in ("old", "new", "who", "when", "why"))
    for line, row, file, experiment, column, *rest in zip(lines, rows, *names, *texts, strict=True):
        if math.isnan(row) or not file:
            continue  # already reported: no number, or blank
        old, new, who, when, why = rest
        correction = Correction(file, experiment, int(row), column, old, new, who, when, why, line)
        if file not in files:
            problems.append(correction.mismatch("file", file, Message("one of {files}", files=files)))
        elif row != int(row):
            problems.append(correction.mismatch("row", f"{row:g}", Message("a whole number, the file's line")))
        else:
            sorted_by_file.setdefault(file, {}).setdefault(int(row), []).append(correction)
    return sorted_by_file


class Corrector:
    """Applies the corrections of one file to its rows while they are read.

    header: header of the file, with the column ``status`` if a correction cancels an experiment.
    mark: decimal mark of the file.
    """

    def __init__(
        self, form: TableForm, header: Header, corrections: RowCorrections, *, mark: str, problems: list[Problem]
    ) -> None:
        self._header = header
        self._position = header.position
        self._numbers = {column.name for column in form.numbers}
        self._key = form.key
        self._mark = mark
        self._problems = problems
        self._left = dict(corrections)

    def apply(self, lines: Sequence[int], rows: Sequence[list[str]]) -> None:
        """Change the cells of these records in place."""
        if not self._left:
            return
        for line, cells in zip(lines, rows, strict=True):
            for correction in self._left.pop(line, ()):
                self._correct_record(cells, correction)

    def finish(self) -> None:
        """Report corrections whose row is not in the file; call this after the last record."""
        for row, of_one_row in sorted(self._left.items()):
            allowed = Message("a row of measurements; the file has no rows")
            if row == self._header.row:
                allowed = Message("a row of measurements; this is the header")
            self._problems.extend(correction.mismatch("row", str(row), allowed) for correction in of_one_row)

    def _correct_record(self, cells: list[str], correction: Correction) -> None:
        """Apply a correction to a record in place; a problem if its column, experiment or old value does not match."""
        position = self._position.get(correction.column)
        if position is None:
            allowed = Message("a column of {file}: {columns}", file=correction.file, columns=list(self._position))
            self._problems.append(correction.mismatch("column", correction.column, allowed))
            return
        cells.extend([""] * (len(self._header.columns) - len(cells)))
        key_position = self._position.get(self._key)
        experiment = cells[key_position].strip() if key_position is not None else correction.experiment
        if experiment != correction.experiment:
            allowed = Message("the stored value: {experiment!r}", experiment=experiment)
            self._problems.append(correction.mismatch("experiment", correction.experiment, allowed))
            return
        current = cells[position].strip()
        value = number(current, self._mark)  # NaN, no number, equals nothing
        is_number_column = correction.column in self._numbers
        same_number = any(value == number(correction.old, mark) for mark in (self._mark, "."))
        if current == correction.old or (is_number_column and same_number):
            with_comma = self._mark == "," and is_number_column and is_number(correction.new, ".")
            cells[position] = correction.new.replace(".", ",") if with_comma else correction.new
        else:
            allowed = Message("what stands there: {current!r}", current=current)
            self._problems.append(correction.mismatch("old", correction.old, allowed))
