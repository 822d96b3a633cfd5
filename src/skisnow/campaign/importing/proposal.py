"""Proposal of an import: tables, columns, units, sites and tools of a file, with the questions that remain."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import permutations
from typing import Final

import numpy as np

from ..._support.errors import FieldDataError
from ..._support.messages import Message
from ..._support.spreadsheet_text import csv_text
from ..._support.units import N_PER_MM3
from ..problems import Problem, error
from ..reading.campaign import campaign_of_files
from ..reading.table_forms import TableForm
from .answers import NONE, Answers, Dialogue, Question
from .columns import Note, choose_columns, is_about_numbers, stated_days, stated_sites
from .folder import ToolText, campaign_files, described_tools, description
from .rows import ImportedTable, stored_rows
from .sections import Section, find_sections, likely_table, table_of
from .sheets import HIDDEN, KINDS, Sheet, read_sheets

SOFTEST: Final = 1e-4
HARDEST: Final = 1e3
"""Median H_V (N/mm³) far beyond the range of 0.022 to 90 that was measured (assumption)."""


@dataclass(frozen=True, slots=True)
class Proposal:
    """Proposal of an import.

    file: name of the file.
    tables: tables of a known kind.
    questions: open questions.
    problems: errors of the file; also those of the open questions, and of the campaign once no question is open.
    notes: texts around the tables, which campaign.toml keeps.
    files: contents of the campaign by name; empty with any problem.
    """

    file: str
    tables: tuple[ImportedTable, ...]
    questions: tuple[Question, ...]
    problems: tuple[Problem, ...]
    notes: tuple[Note, ...]
    files: Mapping[str, bytes]


def propose(name: str, data: bytes, answers: Answers = Answers()) -> Proposal:  # noqa: B008
    """Propose how to import a file.

    name, data: name and content of a workbook (.xlsx) or a CSV file.
    answers: answers to questions of an earlier proposal, or of a template.
    Raises ContentError or ParameterError: the file cannot be read.
    """
    ignored, hides = frozenset(answers.ignore), answers.cells.get(HIDDEN) == "no"
    sheets = [replace(sheet, ignored=ignored, hides_columns=hides) for sheet in read_sheets(name, data)]
    sections = [section for sheet in sheets for section in find_sections(sheet, answers.table)]
    dialogue = Dialogue(answers)
    forms = []
    for section in sections:
        form = table_of(section, answers)
        if form is not None:
            forms.append((section, form))
        else:
            value, proposed = ", ".join(section.headings), likely_table(section)
            dialogue.ask("table", section.key, section.key, value=value, choices=(*KINDS, NONE), proposed=proposed)
    notes = _notes(sheets, sections)
    if not sections:
        allowed = Message("a row of headings such as Versuch, Kantwinkel, Last, Eindringtiefe")
        action = Message('State the row of headings by --table "SHEET:ROW=penetration".')
        dialogue.refuse("no_table", name, allowed=allowed, action=action)
    tables = [_import_table(section, form, dialogue, notes) for section, form in forms]
    qualifying = {(section.sheet.name, section.header) for section, _ in forms if section.qualified()}
    for note in notes:
        if is_about_numbers(note) or (note.sheet, note.row) in qualifying:
            dialogue.ask("ignore", f"{note.sheet}!{note.row}", note.sheet, row=note.row, value=note.text)
    _refuse_repeated(tables, dialogue)
    tools = described_tools("tool", tables, dialogue, notes)
    plates = described_tools("plate", tables, dialogue, notes)
    tables = _with_names(tables, dialogue, notes, (tools, plates))
    questions = tuple(dict.fromkeys(item for item in dialogue.open if isinstance(item, Question)))
    problems = tuple(dict.fromkeys(item.problem if isinstance(item, Question) else item for item in dialogue.open))
    files: Mapping[str, bytes] = {}
    if not problems:
        described = description(name, data, _template(answers, tables), tools.values(), plates.values(), notes)
        files = campaign_files(_merged_texts(tables), described, name, data)
        problems = _problems(name, files, tables, is_stated=bool(answers.unit))
    return Proposal(name, tuple(tables), questions, problems, notes, {} if problems else files)


def _notes(sheets: Sequence[Sheet], sections: Sequence[Section]) -> tuple[Note, ...]:
    """Notes: texts of each row that are outside of tables, or the only cell of a row in a table."""
    notes = []
    for sheet in sheets:
        inside = [section for section in sections if section.sheet.name == sheet.name]
        for row, cells in enumerate(sheet.rows):
            texts = [
                cell.strip()
                for column, cell in enumerate(cells)
                if cell.strip() and not sheet.hides(column) and not any(section.has(row, column) for section in inside)
            ]
            if texts and not sheet.ignores_row(row):
                notes.append(Note(sheet.name, row + 1, ": ".join(texts)))
    return tuple(notes)


def _import_table(section: Section, form: TableForm, dialogue: Dialogue, notes: Sequence[Note]) -> ImportedTable:
    """Table from a section of a sheet; without rows if a question about its columns is open."""
    own = [note for note in notes if _is_about_table(note, section.sheet.name, {section.sheet.name})]
    before = len(dialogue.open)
    columns = choose_columns(section, form, dialogue, own)
    # with an open question the rows would repeat the same error in each
    rows = [] if len(dialogue.open) > before else stored_rows(section, columns, form, dialogue)
    return ImportedTable(section, form, tuple(columns), tuple(rows))


def _is_about_table(note: Note, sheet: str, with_tables: set[str]) -> bool:
    """True for a note on this sheet, or on a sheet that is not among those `with_tables`."""
    return note.sheet == sheet or note.sheet not in with_tables


def _refuse_repeated(tables: Sequence[ImportedTable], dialogue: Dialogue) -> None:
    """Add errors for tables whose rows are all in another one, such as a summary of all sheets."""
    contents = [
        Counter(
            tuple(row.cells.get(column.name, "") for column in table.form.numbers if column.needed)
            for row in table.rows
        )
        for table in tables
    ]
    for (table, own), (other, others) in permutations(zip(tables, contents, strict=True), 2):
        key, value = table.section.key, other.section.key
        if table.form is other.form and own and own <= others and (own != others or key < value):
            action = Message('Exclude one with --table "{key}=-".', key=key)
            dialogue.refuse("repeated_table", key, value=value, allowed=Message("each measurement once"), action=action)


def _with_names(
    tables: Sequence[ImportedTable],
    dialogue: Dialogue,
    notes: Sequence[Note],
    described: tuple[Mapping[tuple[str, str], ToolText], Mapping[tuple[str, str], ToolText]],
) -> list[ImportedTable]:
    """Copies of the tables with site, tool or blade (`described`), day, and a unique name of the test in each row."""
    with_tables = {table.section.sheet.name for table in tables}
    tools, plates = described
    named = []
    for table in tables:
        sheet = table.section.sheet.name
        site = "" if any("site" in row.cells for row in table.rows) else _choose_site(table, tables, dialogue, notes)
        days = stated_days(note for note in notes if _is_about_table(note, sheet, with_tables))
        added = {"site": site} | ({"time": days.pop()} if len(days) == 1 else {})
        rows = []
        for row in table.rows:
            cells = added | row.cells
            for name, texts in (("tool", tools), ("plate", plates)):
                if name in table.form.names:
                    text = texts.get((sheet, row.cells.get(name, "")))
                    cells[name] = text.name if text is not None else ""
            rows.append(replace(row, cells=cells))
        named.append(replace(table, rows=tuple(rows)))
    return _with_sites_before_names(named)


def _choose_site(
    table: ImportedTable, tables: Sequence[ImportedTable], dialogue: Dialogue, notes: Sequence[Note]
) -> str:
    """Site of a table by the answers, the notes just above it or else of its sheet; "" if a question is added."""
    section, sheet = table.section, table.section.sheet.name
    for key in (section.key, sheet):
        if key in dialogue.answers.site:
            return dialogue.answers.site[key]
    own = [note for note in notes if note.sheet == sheet]
    ends = [other.section.end for other in tables if other.section.sheet.name == sheet]
    above = max((end for end in ends if end <= section.header), default=0)
    near = [note for note in own if above < note.row <= section.header]
    stated = stated_sites(sheet, near) or stated_sites(sheet, own)
    if len(stated) == 1:
        return stated.pop()
    if not dialogue.has_asked("site", sheet):
        value = ", ".join(sorted(stated)) or None
        dialogue.ask("site", sheet, section.key, value=value, choices=tuple(sorted(stated)), proposed=sheet)
    return ""


def _with_sites_before_names(tables: Sequence[ImportedTable]) -> list[ImportedTable]:
    """Copies of the tables with the site before each name of a test if one occurs in several tables of a kind."""
    names = Counter(
        (table.form.file, name)
        for table in tables
        for name in {row.cells[table.form.key] for row in table.rows if row.cells.get(table.form.key)}
    )
    files = {file for (file, _), times in names.items() if times > 1}
    renamed = []
    for table in tables:
        key, rows = table.form.key, table.rows
        if table.form.file in files:
            named = [(row, row.cells) for row in rows if key in row.cells]
            rows = tuple(replace(row, cells=cells | {key: f"{cells['site']} {cells[key]}"}) for row, cells in named)
        renamed.append(replace(table, rows=rows))
    return renamed


def _merged_texts(tables: Sequence[ImportedTable]) -> dict[str, str]:
    """Text of each CSV file of the campaign, merged from the rows of all tables of its kind."""
    by_form: dict[TableForm, list[dict[str, str]]] = {}
    for table in tables:
        if table.rows:
            by_form.setdefault(table.form, []).extend(row.cells for row in table.rows)
    texts = {}
    for form, rows in by_form.items():
        present = {name for row in rows for name in row}
        columns = [*(name for name in form.known if name in present), *sorted(present - set(form.known))]
        texts[form.file] = csv_text([columns, *([row.get(column, "") for column in columns] for row in rows)])
    return texts


def _template(answers: Answers, tables: Sequence[ImportedTable]) -> Answers:
    """Answers extended by the columns and units of the tables, as a template for the import of a similar file."""
    for table in tables:
        for choice in table.columns:
            if choice.column != choice.heading and choice.column:
                answers = answers.with_("column", f"{table.form.name}.{choice.heading}", choice.column)
            if choice.unit is not None:
                answers = answers.with_("unit", f"{table.form.name}.{choice.heading}", choice.unit.name)
    return answers


def _problems(
    name: str, files: Mapping[str, bytes], tables: Sequence[ImportedTable], *, is_stated: bool
) -> tuple[Problem, ...]:
    """Errors of the proposed campaign, at sheets and rows of the file.

    Also an error for an impossible median H_V unless units are stated: columns may be exchanged, or a unit wrong.
    """
    try:
        campaign = campaign_of_files(files)
    except FieldDataError as failure:
        problems = (problem for problem in failure.problems if isinstance(problem, Problem))
        return tuple(_at_source(name, problem, tables) for problem in problems if problem.severity == "error")
    if is_stated or (tests := campaign.penetration) is None:
        return ()
    last = tests.first[1:] - 1
    volume = [
        float(campaign.tools[tool].displaced_volume(depth, angle))
        for tool, depth, angle in zip(tests.tool, tests.penetration_depth[last], tests.edge_angle, strict=True)
    ]
    loads = zip(tests.load[last].tolist(), volume, strict=True)
    hardness = [load / size / N_PER_MM3 for load, size in loads if load > 0.0 and size > 0.0]
    middle = float(np.median(hardness)) if hardness else SOFTEST
    if SOFTEST <= middle <= HARDEST:
        return ()
    value = Message("a median H_V of {middle:.3g} N/mm³", middle=middle)
    allowed = Message("{low:g} to {high:g} N/mm³", low=SOFTEST, high=HARDEST)
    action = Message("Correct the headings and units of load and depth, or state them by --column and --unit.")
    return (error("implausible_hardness", name, value=value, allowed=allowed, action=action),)


def _at_source(name: str, problem: Problem, tables: Sequence[ImportedTable]) -> Problem:
    """Copy of a problem with sheet and row of the imported file instead of the CSV file and its row."""
    places = [
        (table.section.sheet.name, row.source)
        for table in tables
        if table.form.file == problem.file
        for row in table.rows
    ]
    if problem.row is None or not 2 <= problem.row < len(places) + 2:
        return problem
    sheet, row = places[problem.row - 2]
    place = f"{sheet}!{row}"
    action = Message("{action} Or exclude the row with --ignore {place}.", action=problem.action, place=place)
    return replace(problem, file=f"{name}, sheet {sheet}", row=row, action=action)
