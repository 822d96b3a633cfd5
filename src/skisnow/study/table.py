"""The table of a study: one row for each point."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..errors import ParameterError
from ..simulate.batch_file import Row
from ..simulate.input_keys import InputKey


@dataclass(frozen=True, slots=True, eq=False)
class StudyTable:
    """Rows in the order of the points, each by the names of the columns; None where there is no value.

    Attributes
    ----------
    columns
        The names, inputs first.
    rows
        Numbers, texts and switches.
    varied
        The inputs that vary.
    """

    columns: tuple[str, ...]
    rows: list[Row]
    varied: tuple[str, ...]

    def csv(self) -> str:
        """The table as text: numbers with all their digits, true and false, nothing where there is no value."""
        stream = io.StringIO()
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(self.columns)
        writer.writerows([_cell(row.get(name)) for name in self.columns] for row in self.rows)
        return stream.getvalue()

    def counts(self) -> dict[str, int]:
        """How many rows have each outcome, the most frequent first."""
        outcomes = [str(row["outcome"]) for row in self.rows]
        return dict(sorted(((each, outcomes.count(each)) for each in set(outcomes)), key=lambda pair: (-pair[1], pair)))


def read_table(path: str | Path, keys: Mapping[str, InputKey], *, varied: Sequence[str] = ()) -> StudyTable:
    """Read a study's table back.

    Parameters
    ----------
    path
        The CSV file.
    keys
        The study's inputs: the texts among them stay texts.
    varied
        The inputs that vary.

    Raises
    ------
    ParameterError
        It cannot be read, or is no study's table.
    """
    try:
        with Path(path).open(newline="", encoding="utf-8") as stream:
            reader = csv.DictReader(stream)
            columns = tuple(reader.fieldnames or ())
            rows = [{name: _value(name, cell, keys) for name, cell in row.items()} for row in reader]
    except OSError as error:
        raise ParameterError(f"{path} cannot be read: {error.strerror or error}") from error
    except (UnicodeDecodeError, csv.Error, TypeError, AttributeError) as error:
        raise ParameterError(f"{path} is no table of a study: {error}") from error
    if not {"outcome", "study"} <= set(columns):
        raise ParameterError(f"{path} is no table of a study: it has no columns outcome and study")
    return StudyTable(columns, rows, tuple(varied))


def _cell(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    return value if isinstance(value, str) else repr(value)


_TEXTS = ("outcome", "warnings", "reason", "study")


def _value(name: str, cell: str, keys: Mapping[str, InputKey]) -> Any:
    is_text = name in _TEXTS or (name in keys and keys[name].kind == "text")
    if cell == "":
        return "" if name in ("warnings", "reason") else None
    if is_text:
        return cell
    if cell in ("true", "false"):
        return cell == "true"
    try:
        return int(cell) if name in keys and keys[name].kind == "whole number" else float(cell)
    except ValueError:  # a point that was refused keeps what was asked
        return cell
