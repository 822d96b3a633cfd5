"""A problem found in a campaign: where, what, what is allowed, what to do."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Final, Literal, TypeAlias

Severity: TypeAlias = Literal["error", "warning", "mark"]

ERROR_CODES = (
    "missing_column",
    "not_a_number",
    "out_of_range",
    "unknown_tool",
    "unknown_plate",
    "mixed_experiment",
    "empty_file",
    "unreadable_file",
    "bad_toml",
    "correction_mismatch",
    "other_unit",
    "unit_missing",
)
WARNING_CODES = (
    "angles_look_like_radians",
    "angle_above_60",
    "unlikely_unit",
    "repeated_row",
    "unknown_column",
    "unreadable_date",
    "unread_sheet",
    "encoding",
    "separator",
    "converted_unit",
)
_SHOWN = {"mark": "flag"}
"""What a severity is called on a terminal, where it is not its own word."""
LONGEST_VALUE: Final = 200
"""Characters of a value that its sentence shows."""


@dataclass(frozen=True, slots=True)
class Problem:
    """One problem. ``row`` is the line of the file (header: 1); what does not apply is None.

    ``needs_action`` is false where the program says how it read a file, and nobody need do anything.
    """

    severity: Severity
    code: str
    file: str
    row: int | None
    column: str | None
    experiment: str | None
    value: str | None
    allowed: str
    action: str
    needs_action: bool = True

    def __str__(self) -> str:
        """Say it in one line."""
        place = self.file
        if self.row is not None:
            place += f", row {self.row}"
        if self.column is not None:
            place += f", column {self.column}"
        if self.experiment is not None:
            place += f" (experiment {self.experiment})"
        found = "" if self.value is None else f" found {_shortened(self.value)!r};"
        shown = _SHOWN.get(self.severity, self.severity)
        return f"{shown} {self.code}: {place}:{found} allowed: {self.allowed}. {self.action}"

    def as_dict(self) -> dict[str, str | int | None]:
        """Give the problem as the object of ``skisnow check --json``."""
        entry = asdict(self)
        del entry["needs_action"]
        return entry


def _shortened(value: str) -> str:
    return value if len(value) <= LONGEST_VALUE else f"{value[:LONGEST_VALUE]}…"


def error(
    code: str,
    file: str,
    *,
    allowed: str,
    action: str,
    row: int | None = None,
    column: str | None = None,
    experiment: str | None = None,
    value: str | None = None,
) -> Problem:
    """Make a problem that refuses the campaign."""
    return Problem("error", code, file, row, column, experiment, value, allowed, action)


def warning(
    code: str,
    file: str,
    *,
    allowed: str,
    action: str,
    row: int | None = None,
    column: str | None = None,
    experiment: str | None = None,
    value: str | None = None,
    needs_action: bool = True,
) -> Problem:
    """Make a problem that is reported and leaves the campaign usable."""
    return Problem("warning", code, file, row, column, experiment, value, allowed, action, needs_action)


def placed(problem: Problem, places: Mapping[str, str]) -> Problem:
    """A problem of a table that is a sheet of a workbook, under the sheet's name."""
    place = places.get(problem.file)
    return problem if place is None else replace(problem, file=place)


MOST_ALIKE: Final = 10
"""Problems of one kind in one column that a terminal shows one by one."""


def _once_a_name(problems: Iterable[Problem]) -> list[Problem]:
    """An unknown tool or plate once for a file, with the number of its experiments: it is one thing to put right."""
    together: dict[object, list[Problem]] = {}
    for number, problem in enumerate(problems):
        name = (problem.code, problem.file, problem.value)
        together.setdefault(name if problem.code in _NAMES else number, []).append(problem)
    return [_of_all(alike) for alike in together.values()]


_NAMES: Final = ("unknown_tool", "unknown_plate")


def _of_all(alike: Sequence[Problem]) -> Problem:
    first, more = alike[0], len(alike) - 1
    where = f"{first.experiment} and {more} more, up to row {alike[-1].row}"
    return replace(first, experiment=where) if more else first


def _several(problems: Sequence[Problem]) -> Iterator[str]:
    """A line each; of more than some of one kind in one column the first, and how many more there are."""
    kinds = [(problem.severity, problem.code, problem.file, problem.column) for problem in problems]
    counts, shown = Counter(kinds), Counter[tuple[object, ...]]()
    for kind, problem in zip(kinds, problems, strict=True):
        shown[kind] += 1
        if shown[kind] <= MOST_ALIKE or counts[kind] == MOST_ALIKE + 1:
            yield str(problem)
        elif shown[kind] == counts[kind]:
            where = f"{problem.file}{f', column {problem.column}' if problem.column else ''}"
            more = f"{counts[kind] - MOST_ALIKE} more like these, up to row {problem.row}; --json lists all"
            yield f"{_SHOWN.get(problem.severity, problem.severity)} {problem.code}: {where}: {more}"


def lines_of(problems: Iterable[Problem]) -> list[str]:
    """A line for each problem, one for an unknown tool or plate, and one for all together that need no action.

    >>> told = [warning("separator", f"{name}.csv", value="semicolon", allowed="", action="", needs_action=False)
    ...         for name in ("shear", "density")]
    >>> lines_of(told)
    ['note: nothing need be done: semicolon in shear.csv, density.csv.']
    """
    every = list(problems)
    files: dict[str, list[str]] = {}
    for problem in every:
        if not problem.needs_action:
            kept = f"column {problem.value!r} kept as text" if problem.code == "unknown_column" else problem.value
            files.setdefault(kept or problem.code, []).append(problem.file)
    notes = "; ".join(f"{what} in {', '.join(dict.fromkeys(where))}" for what, where in files.items())
    lines = list(_several(_once_a_name(problem for problem in every if problem.needs_action)))
    return [*lines, f"note: nothing need be done: {notes}."] if notes else lines


@dataclass(frozen=True, slots=True)
class AppliedCorrection:
    """A cell that was read otherwise than the raw file has it; ``row`` is the line of that file."""

    file: str
    experiment: str
    row: int
    column: str
    old: str
    new: str
    who: str
    when: str
    why: str
