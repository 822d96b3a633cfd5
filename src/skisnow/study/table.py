"""The table of a study: one row for each point."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import Any, Final

from ..errors import ParameterError
from ..given import json_value
from ..inputs import Quantity
from ..parallel.kept_rows import Row
from ..shown import Facts, Shown
from ..spreadsheet_text import (
    SEPARATOR_NAMES,
    NoTextError,
    decimal_mark,
    decoded,
    guarded,
    most_frequent_separator,
    named_separator,
    unguarded,
)

_HEAD: Final = 1 << 16


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class StudyTable(Shown):
    """Rows in the order of the points, each by the names of the columns; None where there is no value.

    Attributes
    ----------
    columns
        The names, inputs first.
    rows
        Numbers, texts and switches.
    varied
        The inputs that vary.

    See Also
    --------
    skisnow.study
    """

    columns: tuple[str, ...]
    rows: list[Row]
    varied: tuple[str, ...]

    def _facts(self) -> Facts:
        counts = ", ".join(f"{outcome} {count}" for outcome, count in self.counts().items())
        rows = (("outcomes", counts), ("varied", ", ".join(self.varied)), ("columns", ", ".join(self.columns)))
        return Facts(f"of {len(self.rows)} points", rows)

    def answers(self) -> list[Row]:
        """The rows whose point could be asked."""
        return [row for row in self.rows if row["outcome"] != "error"]

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


def read_table(path: str | Path, keys: Mapping[str, Quantity], *, varied: Sequence[str] = ()) -> StudyTable:
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
        text = decoded(Path(path).read_bytes()).text
        named = named_separator(text)
        separator = named if named in SEPARATOR_NAMES else most_frequent_separator(text[:_HEAD])
        stream = io.StringIO(text, newline="")
        skipped = len(stream.readline()[:1]) if named in SEPARATOR_NAMES else 0
        reader = csv.reader(stream, delimiter=str(separator))
        columns = tuple(next(reader, ()))
        _require_columns(path, columns)
        lines = [(reader.line_num + skipped, cells) for cells in reader if cells]
        mark = "." if separator == "," else decimal_mark([chain.from_iterable(row for _, row in lines)], separator=";")
        rows = [_row(f"{path}, line {line}", columns, cells, keys, mark) for line, cells in lines]
    except OSError as error:
        raise ParameterError(f"{path} cannot be read: {error.strerror or error}") from error
    except (NoTextError, csv.Error) as error:
        raise ParameterError(f"{path} is no table of a study: {error}") from error
    return StudyTable(columns, rows, tuple(varied))


def _require_columns(path: str | Path, columns: Sequence[str]) -> None:
    if not {"outcome", "study"} <= set(columns):
        raise ParameterError(f"{path} is no table of a study: its first line names no columns outcome and study")


def _row(place: str, columns: Sequence[str], cells: Sequence[str], keys: Mapping[str, Quantity], mark: str) -> Row:
    if len(cells) != len(columns):
        raise ParameterError(
            f"{place}: a row of this table has {len(columns)} cells, this line has {len(cells)}. Remove the line"
        )
    row = {}
    for name, cell in zip(columns, cells, strict=True):
        try:
            row[name] = _value(name, cell, keys, mark)
        except (ValueError, TypeError):
            raise ParameterError(f"{place}: {name} is {cell!r}; it must be a number. Correct or remove it") from None
    return row


def _cell(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list | tuple):
        return json.dumps(list(value))
    return guarded(value) if isinstance(value, str) else repr(value)


_TEXTS = ("outcome", "ski_name", "warnings", "reason", "study")


def _value(name: str, cell: str, keys: Mapping[str, Quantity], mark: str) -> Any:
    is_text = name in _TEXTS or (name in keys and keys[name].kind == "text")
    if cell == "":
        return "" if name in ("warnings", "reason") else None
    if is_text:
        return unguarded(cell)
    if cell.startswith("["):
        return [float(each) for each in json_value(cell)]
    if cell.lower() in ("true", "false"):
        return cell.lower() == "true"
    return (
        int(cell)
        if name in keys and keys[name].kind == "whole number"
        else float(cell if mark == "." else cell.replace(",", "."))
    )
