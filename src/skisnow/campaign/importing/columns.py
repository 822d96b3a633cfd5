"""Columns and units of a table to import, and notes around it: tool, blade, gauge, site, day, observers."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Final

from ..._support.messages import Message
from ..reading import headings
from ..reading.columns import iso_moment
from ..reading.header import NO_UNIT
from ..reading.table_forms import TableForm
from .answers import NONE, Dialogue
from .sections import Section
from .sheets import EXCLUDED, FROM_NOTES, HIDDEN, column_letters


@dataclass(frozen=True, slots=True)
class ColumnChoice:
    """A column of a table to import.

    place: index of the column on the sheet, from 0.
    heading: heading as written.
    column: column of the campaign's table, or the heading for a column that is kept as text; "" if it is ignored.
    unit: conversion of its numbers; None for a text, or if the unit is open.
    """

    place: int
    heading: str
    column: str
    unit: headings.UnitConversion | None = None


def number_columns(form: TableForm) -> list[str]:
    """Names of a table's columns with numbers that skisnow interprets."""
    return [column.name for column in form.numbers if column.name not in form.further]


def choose_columns(section: Section, form: TableForm, dialogue: Dialogue, notes: Sequence[Note]) -> list[ColumnChoice]:
    """Choose the campaign's column and the unit for each column of a section; questions are added to the dialogue."""
    if section.sheet.hidden_columns & set(section.columns) and HIDDEN not in dialogue.answers.cells:
        dialogue.ask("cells", HIDDEN, section.key, value=EXCLUDED[HIDDEN], choices=("yes", "no"))
        return []
    stated = []
    for heading in section.headings:
        answer = dialogue.answers.of_heading("column", form.name, heading)
        stated.append(answer if answer in form.known or answer == NONE else headings.stated_column(form, heading))
        if answer and answer != NONE and answer not in form.known:
            allowed = Message("the columns {columns}, or - for none", columns=list(form.known))
            action = Message("Correct --{option}.", option="column")
            dialogue.refuse("bad_answer", section.key, column=heading, value=answer, allowed=allowed, action=action)
    _ask_for_columns(section, form, stated, dialogue)
    numbers, cells_below = number_columns(form), section.units or ("",) * len(section.columns)
    choices = []
    for place, heading, below, column in zip(section.columns, section.headings, cells_below, stated, strict=True):
        unit = None
        if column in numbers:
            unit = _choose_unit(section, form, heading, column, below, dialogue, notes)
        elif column in form.further and headings.unit_of_column(column):
            units = _stated_units(form, heading, column, below, dialogue, notes)
            column = column if units == {headings.folded_unit(column)} else heading  # noqa: PLW2901
        choices.append(ColumnChoice(place, heading, "" if column == NONE else column or heading, unit))
    return choices


def _ask_for_columns(section: Section, form: TableForm, stated: Sequence[str], dialogue: Dialogue) -> None:
    """Ask for required columns that no heading states, and about headings that state the same column."""
    times = Counter(column for column in stated if column and column != NONE)
    for place, heading, column in zip(section.columns, section.headings, stated, strict=True):
        if section.headings.index(heading) < section.columns.index(place) and column != NONE:
            excluded = f"{section.sheet.name}!{column_letters(place)}"
            dialogue.ask("ignore", excluded, section.key, value=heading)
        elif times[column] > 1:
            key = f"{form.name}.{heading}"
            dialogue.ask("column", key, section.key, value=heading, choices=(column, NONE), proposed=column)
    missing = [name for name in form.required if name not in times and name not in FROM_NOTES]
    free = [heading for heading, column in zip(section.headings, stated, strict=True) if not column]
    only = dict(zip(free, missing, strict=True)) if len(free) == len(missing) == 1 else {}
    likely = only | headings.columns_by_synonym(form, free)
    for heading in free if missing else ():
        key, proposed = f"{form.name}.{heading}", likely.get(heading, NONE)
        choices = (*missing, *(name for name in form.known if name not in missing), NONE)
        dialogue.ask("column", key, section.key, value=heading, choices=choices, proposed=proposed)
    if missing and not free:
        allowed = Message("the columns {required}", required=list(form.required))
        action = Message(
            "Add {columns} to the sheet, or name the column with --{option}.", columns=missing, option="column"
        )
        dialogue.refuse("missing_column", section.key, value=None, allowed=allowed, action=action)


def _stated_units(
    form: TableForm, heading: str, column: str, below: str, dialogue: Dialogue, notes: Sequence[Note]
) -> set[str]:
    """All units that are stated for a column: by answer, heading, row of units (`below`) and notes."""
    answer = headings.known_unit(dialogue.answers.of_heading("unit", form.name, heading))
    named = headings.folded_unit(column) if heading == column else headings.named_unit(heading)
    of_notes = units_in_notes(column, notes) if column in MEASURED else set()
    return {*filter(None, (answer, named, headings.known_unit(below))), *of_notes}


def _choose_unit(
    section: Section, form: TableForm, heading: str, column: str, below: str, dialogue: Dialogue, notes: Sequence[Note]
) -> headings.UnitConversion | None:
    """Conversion to a column's unit; None, with an error or a question added, unless exactly one unit is stated."""
    units = _stated_units(form, heading, column, below, dialogue, notes)
    sizes = {headings.conversion(unit, column) for unit in units}
    is_unknown = not headings.known_unit(below) and below.casefold() not in NO_UNIT and below != heading
    is_clear = not is_unknown or dialogue.answers.of_heading("unit", form.name, heading)
    if len(sizes) == 1 and None not in sizes and is_clear:
        return sizes.pop()
    if sizes:
        value = ", ".join(sorted(units | ({below} if is_unknown else set())))
        allowed = Message("one unit among {units}", units=headings.units_for(column))
        action = Message("Correct the heading, the row of units, the note or --unit: they state different units.")
        dialogue.refuse("other_unit", section.key, column=heading, value=value, allowed=allowed, action=action)
    else:
        choices = tuple(headings.units_for(column).split(", "))
        dialogue.ask("unit", f"{form.name}.{heading}", section.key, value=below or heading, choices=choices)
    return None


_NUMBER: Final = r"\d+(?:[.,]\d+)?"
_LENGTH: Final = rf"({_NUMBER})\s*(mm|cm|m|µm)?"
TOOL: Final = re.compile(
    rf"\b((?:skistück|ski piece|piece of ski|ski))\b[^\d;]{{0,20}}?{_LENGTH}\s*[x×*]\s*({_NUMBER})\s*(mm|cm|m)\b",
    re.IGNORECASE,
)
DISC: Final = re.compile(
    rf"\b((?:scheibe|disc|disk))\b[^\d;]{{0,8}}?(?:ø|durchmesser|diameter)\s*({_NUMBER})\s*(mm|cm|m)\b", re.IGNORECASE
)
PLATE: Final = re.compile(
    rf"\b(scherblatt|scherplatte|klinge|blade|shear plate|plate|-)?\s*({_NUMBER})\s*(mm|cm|m)\b(?!\s*[x×*])",
    re.IGNORECASE,
)
_GAUGE: Final = re.compile(rf"\b(messuhr|gauge)\b[^\d;,.]{{0,20}}({_NUMBER})\s*(mm|cm|µm)\b", re.IGNORECASE)
_SITE: Final = re.compile(r"\b(ort|messort|standort|site)\s*:\s*([^;,]+)", re.IGNORECASE)
_OBSERVERS: Final = re.compile(r"\b(beobachter|beobachterin|observers?)\s*:\s*([^;,]+)", re.IGNORECASE)
_DAY: Final = re.compile(r"\b\d{1,2}\. ?\d{1,2}\. ?\d{4}\b|\b\d{4}-\d{2}-\d{2}\b")
_LENGTH_LEFT: Final = re.compile(rf"{_NUMBER}\s*(?:mm|cm|m)\b")
_QUALIFIED: Final = re.compile(
    r"\b(ab|bis|außer|ausser|except|statt|instead|nicht|not|oder|or|ca|etwa|about|approx|circa|from|until|ohne|without|"
    r"plus|minus|zuzüglich|abzüglich|neu|new|alt|old|korrektur|nullpunkt|offset)\b|≈|~",
    re.IGNORECASE,
)
_LOAD: Final = re.compile(rf"{_NUMBER}\s*(?:kg|kp|k?N|daN|N ?c?m)\b(?!\s*/)", re.IGNORECASE)
MEASURED: Final = ("edge_angle_deg", "load_N", "depth_mm", "lever_arm_mm", "moment_Nm")


@dataclass(frozen=True, slots=True)
class Note:
    """Text of a sheet's row outside of tables."""

    sheet: str
    row: int
    text: str


def length_mm(number: str, unit: str) -> float:
    """A length in mm from a number and its unit.

    >>> length_mm("6,2", "cm")
    62.0
    """
    size = headings.conversion(unit.casefold(), "depth_mm")
    assert size is not None
    return float(f"{float(number.replace(',', '.')) * size.factor:.10g}")


def stated_tools(notes: Iterable[Note]) -> set[str]:
    """Tools that notes state, as answers: ski with length and width, disc with diameter; "" for an unclear note."""
    tools: set[str] = set()
    for note in notes:
        for match in TOOL.finditer(note.text):
            length, width = length_mm(match[2], match[3] or match[5]), length_mm(match[4], match[5])
            tools.add("" if length <= width or _is_unclear(note) else f"ski {length:g} x {width:g} mm")
        for match in DISC.finditer(note.text):
            tools.add("" if _is_unclear(note) else f"disc {length_mm(match[2], match[3]):g} mm")
    return tools


def stated_plates(notes: Iterable[Note]) -> set[str]:
    """Lengths of blades that notes state, as answers; "" for an unclear note."""
    return {
        "" if _is_unclear(note) else f"{length_mm(match[2], match[3]):g} mm"
        for note in notes
        for match in PLATE.finditer(TOOL.sub("", DISC.sub("", _GAUGE.sub("", note.text))))
        if match[1] and match[1] != "-"
    }


def _is_unclear(note: Note) -> bool:
    """True if a note has a word such as "about", "not" or "from", or a length that belongs to no tool or blade."""
    rest = TOOL.sub("", DISC.sub("", _GAUGE.sub("", note.text)))
    rest = PLATE.sub(lambda match: "" if match[1] and match[1] != "-" else match[0], rest)
    return bool(_QUALIFIED.search(note.text) or _LENGTH_LEFT.search(rest))


def gauge_steps_mm(notes: Iterable[Note]) -> set[float]:
    """Resolutions of the depth gauge (mm) found in the texts of notes."""
    return {length_mm(match[2], match[3]) for note in notes for match in _GAUGE.finditer(note.text)}


def stated_sites(sheet: str, notes: Sequence[Note]) -> set[str]:
    """Sites that the notes of a sheet state; the name of the sheet if a note repeats it."""
    sites = {match[2].strip() for note in notes for match in _SITE.finditer(note.text)}
    parts = {" ".join(part.split()).casefold() for note in notes for part in re.split(r"[,;:–]", note.text)}
    return sites | ({sheet.strip()} if " ".join(sheet.split()).casefold() in parts else set())


def stated_days(notes: Iterable[Note]) -> set[str]:
    """Dates (ISO 8601) found in the texts of notes; impossible ones are left out."""
    days = {iso_moment(match[0].replace(". ", ".")) for note in notes for match in _DAY.finditer(note.text)}
    return {day for day in days if day}


def stated_observers(notes: Iterable[Note]) -> list[str]:
    """Different names after a word such as "observer" in the texts of notes, in their order."""
    lists = [match[2] for note in notes for match in _OBSERVERS.finditer(note.text)]
    return list(dict.fromkeys(name.strip() for names in lists for name in re.split(r"[/&+]", names) if name.strip()))


def units_in_notes(column: str, notes: Iterable[Note]) -> set[str]:
    """Units that notes state for a column, such as "Last in kg"."""
    words = "|".join(re.escape(word) for word in headings.SYNONYMS[column] if len(word) > 2)
    pattern = re.compile(rf"\b(?:{words})(?:en|e|n|s)?\s*(?:in|:|=|\[|\()\s*([^\s\]),;.]+)", re.IGNORECASE)
    texts = [note.text.replace("ä", "ae").replace("ö", "oe").replace("ü", "ue") for note in notes]
    units = {headings.known_unit(match[1]) for text in texts for match in pattern.finditer(text)}
    return {unit for unit in units if unit and headings.conversion(unit, column)}


def is_about_numbers(note: Note) -> bool:
    """True for a note that may change the measurements: it has a load or moment, or a column's name with a number."""
    words = headings.letters(note.text).split()
    synonyms = {word for column in MEASURED for word in headings.SYNONYMS[column] if len(word) > 2}
    named = any(
        word in synonyms or any(word == f"{synonym}{end}" for synonym in synonyms for end in ("e", "en", "n", "s"))
        for word in words
    )
    rest = _DAY.sub("", note.text)
    return bool(_LOAD.search(rest)) or (named and bool(re.search(r"\d", rest) or _QUALIFIED.search(rest)))
