"""Columns and units of a table to import: what its headings, its row of units, notes and answers state."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from ..._support.messages import Message
from ..problems import error
from ..reading.headings import conversion, known_unit, named_unit, own_unit, unit_of_column, units_for
from ..reading.synonyms import columns_by_synonym, stated_column
from .answers import NONE
from .notes import MEASURED, units_in_notes
from .questions import Question, ask

if TYPE_CHECKING:
    from ..problems import Problem
    from ..reading.headings import UnitConversion
    from ..reading.table_forms import TableForm
    from .answers import Answers
    from .notes import Note
    from .sheets import Section

_NO_UNIT: Final = frozenset({"", "-", "–", "#", "nr", "nr.", "no", "no."})
FROM_NOTES: Final = ("site", "tool", "plate")
"""Columns that a note can replace."""


@dataclass(frozen=True, slots=True)
class ColumnChoice:
    """A column of a table to import.

    Attributes
    ----------
    place
        Column of the sheet, from 0.
    heading
        As written.
    column
        Column of the campaign's table, or the heading for a column that is kept as text; "" if it is left out.
    unit
        Conversion of its numbers; None for a text, or if the unit is open.
    """

    place: int
    heading: str
    column: str
    unit: UnitConversion | None = None


def number_columns(form: TableForm) -> list[str]:
    """Columns whose numbers are interpreted."""
    return [column.name for column in form.numbers if column.name not in form.further]


def choose_columns(
    section: Section, form: TableForm, answers: Answers, notes: Sequence[Note], open_: list[Question | Problem]
) -> list[ColumnChoice]:
    """Columns of a section; open questions and errors are added to `open_`."""
    table = form.file.removesuffix(".csv")
    stated = [_stated(form, answers.of_heading("column", table, heading), heading) for heading in section.headings]
    open_.extend(_bad_answers(section, form, answers))
    open_.extend(_column_questions(section, form, stated))
    choices = []
    for place, heading, column in zip(section.columns, section.headings, stated, strict=True):
        unit = None
        if column in number_columns(form):
            unit = _unit(section, form, heading, column, place, answers, notes, open_)
        elif column in form.further and unit_of_column(column):
            units = _statements(section, heading, column, place, answers, table, notes)
            column = column if units == {own_unit(column)} else heading  # noqa: PLW2901
        choices.append(ColumnChoice(place, heading, "" if column == NONE else column or heading, unit))
    return choices


def _stated(form: TableForm, answer: str, heading: str) -> str:
    return answer if answer in form.known or answer == NONE else stated_column(form, heading)


def _bad_answers(section: Section, form: TableForm, answers: Answers) -> Iterator[Problem]:
    table = form.file.removesuffix(".csv")
    for heading in section.headings:
        answer = answers.of_heading("column", table, heading)
        if answer and answer != NONE and answer not in form.known:
            yield error(
                "bad_answer",
                section.key,
                column=heading,
                value=answer,
                allowed=Message("the columns {columns}, or - for none", columns=list(form.known)),
                action=Message("Correct --{option}.", option="column"),
            )


def _column_questions(section: Section, form: TableForm, stated: Sequence[str]) -> Iterator[Question | Problem]:
    """Questions for required columns that no heading states, and for headings that state the same column."""
    table = form.file.removesuffix(".csv")
    times = Counter(column for column in stated if column and column != NONE)
    for heading, column in zip(section.headings, stated, strict=True):
        if times[column] > 1:
            key = f"{table}.{heading}"
            yield ask("column", key, section, value=heading, choices=(column, NONE), proposed=column)
    missing = [name for name in form.required if name not in times and name not in FROM_NOTES]
    free = [heading for heading, column in zip(section.headings, stated, strict=True) if not column]
    likely = columns_by_synonym(form, free)
    for heading in free if missing else ():
        proposed = likely.get(heading, NONE)
        choices = (*missing, *(name for name in form.known if name not in missing), NONE)
        yield ask("column", f"{table}.{heading}", section, value=heading, choices=choices, proposed=proposed)
    if missing and not free:
        yield error(
            "missing_column",
            section.key,
            value=None,
            allowed=Message("the columns {required}", required=list(form.required)),
            action=Message(
                "Add {columns} to the sheet, or name the column with --{option}.", columns=missing, option="column"
            ),
        )


def _statements(
    section: Section, heading: str, column: str, place: int, answers: Answers, table: str, notes: Sequence[Note]
) -> set[str]:
    """Units that answer, heading, row of units and notes state for a column."""
    below = section.units[place - section.left] if section.units else ""
    named = own_unit(column) if heading == column else named_unit(heading)
    of_notes = units_in_notes(column, notes) if column in MEASURED else set()
    return {
        *filter(None, (known_unit(answers.of_heading("unit", table, heading)), named, known_unit(below))),
        *of_notes,
    }


def _unit(
    section: Section,
    form: TableForm,
    heading: str,
    column: str,
    place: int,
    answers: Answers,
    notes: Sequence[Note],
    open_: list[Question | Problem],
) -> UnitConversion | None:
    table = form.file.removesuffix(".csv")
    units = _statements(section, heading, column, place, answers, table, notes)
    sizes = {conversion(unit, column) for unit in units}
    below = section.units[place - section.left] if section.units else ""
    is_unknown = not known_unit(below) and below.casefold() not in _NO_UNIT and below != heading
    if len(sizes) == 1 and None not in sizes and (not is_unknown or answers.of_heading("unit", table, heading)):
        return sizes.pop()
    if sizes:
        open_.append(
            error(
                "other_unit",
                section.key,
                column=heading,
                value=", ".join(sorted(units | ({below} if is_unknown else set()))),
                allowed=Message("one unit among {units}", units=units_for(column)),
                action=Message(
                    "Correct the heading, the row of units, the note or --unit: they state different units."
                ),
            )
        )
    else:
        choices = tuple(units_for(column).split(", "))
        open_.append(ask("unit", f"{table}.{heading}", section, value=below or heading, choices=choices, proposed=""))
    return None
