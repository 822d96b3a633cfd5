"""Page that imports a workbook or CSV file in any layout: choices of each table, its stored rows, and H_V."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from dataclasses import field as dataclass_field
from typing import Final

from nicegui import run, ui

from ..._support.errors import ParameterError, SkisnowError
from ..._support.messages import Message, template
from ...campaign.importing.answers import Answers, Question
from ...campaign.importing.columns import ColumnChoice, number_columns
from ...campaign.importing.proposal import Proposal
from ...campaign.importing.rows import ImportedTable
from ...campaign.importing.sections import Section
from ...campaign.importing.sheets import FROM_NOTES, KINDS
from ...campaign.problems import Problem
from ...campaign.reading.headings import units_for
from ..elements import (
    Outcome,
    Words,
    add_head,
    add_items,
    button,
    choice,
    error_sentence,
    field,
    folded,
    heading,
    page_frame,
    sentence,
)
from ..settings import BUILD_S, Lab
from ..transfer import FileImports, try_import
from ..uploads import BOUNDS, confined
from ..words import TABLES, label, number_text, said

PATH: Final = "/import/{id_}"
HERE: Final = "/"
NONE: Final = "-"
LEFT_OUT: Final = Message("excluded")
TEXT: Final = Message("kept as text")
IS_OPEN: Final = "(event) => emit(event.target.open)"
_SHOWN_ROWS: Final = 4
_READABLE: Final = 6  # characters of a number with five digits and a decimal sign
QUESTIONS: Final = {
    "table": template("Which table begins in row {row} of the sheet {sheet}?"),
    "column": template("Which column is {heading} ({table})?"),
    "unit": template("Which unit have the numbers below {heading} ({table})?"),
    "site": template("Which site is the sheet {key}?"),
    "tool": template("Tool with lengths and unit, such as ski 200 x 62 mm {key}"),
    "plate": template("Length of the blade with unit, such as 100 mm {key}"),
    "row": template("Leave out row {row} of the sheet {sheet}?"),
    "ignore": template("Leave out {place} of the sheet {sheet}?"),
    "decimal": template("Which decimal mark do the numbers have?"),
    "thousands": template("Which mark separates the thousands?"),
    "fill-down": template("Fill blank names and angles from the row above?"),
    "hidden": template("Import hidden rows, columns and sheets?"),
    "struck": template("Import rows that are struck through?"),
}
"""Question of each option of the command, or of each key of --cells."""


def add_page(lab: Lab) -> None:
    """Add the page that imports a workbook or table in any layout."""
    imports = FileImports(lab)

    @ui.page(PATH, response_timeout=BUILD_S)
    async def import_file(id_: str) -> None:
        name = imports.name(id_)
        with page_frame(Message("Import a file"), here=HERE):
            sentence(Message("{file}: check the proposal, answer the questions, then store the campaign.", file=name))
            page = _ImportPage(imports, id_)
        await page.draw()


@dataclass
class _ImportPage:
    """Content of the page for one uploaded file, with the answers so far."""

    imports: FileImports
    id_: str
    answers: Answers = dataclass_field(default_factory=Answers)
    proposal: Proposal | None = None
    _open: set[str] = dataclass_field(default_factory=set)
    """Tables whose layout is shown."""

    def __post_init__(self) -> None:
        templates = self.imports.templates()
        if templates:
            options = {"": said(Message("none")), **templates}
            choice(Message("Template"), options, "").on_value_change(self._use_template)
        with ui.element("div").classes("acts"):
            self._store = button(Message("Store the campaign"), self._keep_campaign, "main", once=True)
            self._status = Outcome()
        self._tables = ui.element("div").classes("importing")
        with ui.element("div").classes("acts"):
            self._name = field(Message("Name of the template"), "")
            button(Message("Save the answers as a template"), self._save_template, "small")

    async def draw(self) -> None:
        """Compute the proposal with the current answers, and show it."""
        name, data = self.imports.content(self.id_)
        try:
            tried = await run.io_bound(confined, BOUNDS, try_import, name, data, self.answers)
        except SkisnowError as error:
            self._status.say(error_sentence(error), bad=True)
            self._store.set_enabled(False)
            return
        if tried is not None:  # otherwise the server ends
            self._show_proposal(*tried)

    def _show_proposal(self, proposal: Proposal, hardness: tuple[str, float] | None) -> None:
        """Show questions, errors and tables of a proposal; it can be stored only without open ones."""
        self.proposal = proposal
        self._tables.clear()
        with self._tables:
            # one answer is for all tables with the same heading
            questions = {(question.option, question.key): question for question in proposal.questions[::-1]}
            if questions:
                heading(Message("Questions"))
                for question in reversed(questions.values()):
                    self._add_question(question)
            asked_problems = [question.problem for question in proposal.questions]
            if problems := [problem for problem in proposal.problems if problem not in asked_problems]:
                heading(Message("Errors"))
                with ui.element("ul").classes("errors"):
                    add_items(problem.message for problem in problems)
            for table in proposal.tables:
                self._table(table, proposal.tables)
                if table.rows:
                    _show_rows(table)
        self._store.set_enabled(not proposal.problems)
        if proposal.problems:
            count = len(questions) + len(problems)
            self._status.say(Message("Not ready: {count} open questions or errors.", count=count), bad=True)
        elif hardness is not None:
            series, value = hardness
            self._status.say(Message("H_V of {series}: {value:.3f} N/mm³", series=series, value=value))
        else:
            self._status.say(Message("Ready."))

    def _add_question(self, question: Question) -> None:
        """Add a card with a question and a button, menu or field for its answer."""
        words = _question_words(question)
        with ui.element("div").classes("card ask"):
            if question.choices:
                sentence(words)
            sentence(_place_words(question.problem), "quiet")
            if question.option == "ignore":
                button(words, lambda: self._answer(question.option, question.key, "yes"))
            elif question.choices:
                options = {text: _choice_words(text) for text in question.choices}
                made = choice(Message("Answer"), options, None)
                made.on_value_change(lambda event: self._answer(question.option, question.key, event.value))
                if question.proposed:
                    proposal = Message("Proposal: {text}", text=_choice_words(question.proposed))
                    button(proposal, lambda: self._answer(question.option, question.key, question.proposed), "small")
            else:
                typed = field(words, question.proposed)
                with ui.element("div").classes("acts"):
                    button(Message("Use this"), lambda: self._answer(question.option, question.key, str(typed.value)))

    def _table(self, table: ImportedTable, tables: Sequence[ImportedTable]) -> None:
        """Add the choices for a table: a column for each heading, its site, and a folded section of `_layout`."""
        kind = table.form.name
        heading(Message("{place}: {table}", place=table.section.key, table=said(TABLES[table.form.file])), 3)
        options = {name: label(name) for name in table.form.known} | {NONE: LEFT_OUT}
        with ui.element("div").classes("inputs"):
            for column in table.columns:
                own = options if column.column in options else {column.column: TEXT, **options}
                made = choice(_with_unit(column), {key: str(text) for key, text in own.items()}, column.column or NONE)
                key = f"{kind}.{column.heading}"
                made.on_value_change(lambda event, key=key: self._answer("column", key, event.value))
            self._site(table, tables)
        words = Message("Kind of table, row of the headings, units and tool")
        key = table.section.key
        with folded(words, is_open=key in self._open) as layout, ui.element("div").classes("inputs"):
            self._layout(table, kind)
        layout.on(
            "toggle", lambda event: (self._open.add if event.args else self._open.discard)(key), js_handler=IS_OPEN
        )

    def _layout(self, table: ImportedTable, kind: str) -> None:
        """Add choices that override a table in the file: kind, row of the headings, units, and tool or plate."""
        section = table.section
        kinds = {name: TABLES[f"{name}.csv"] for name in KINDS} | {NONE: LEFT_OUT}
        made = choice(Message("Kind of table"), kinds, kind)
        made.on_value_change(lambda event: self._answer("table", section.key, event.value))
        row = field(Message("Row of the headings"), str(section.header + 1), numeric=True)
        row.on("blur", lambda: self._move_headings(section, kind, str(row.value).strip()))
        for column in table.columns:
            if column.column in number_columns(table.form):
                answer = self.answers.of_heading("unit", kind, column.heading)
                unit = column.unit.name if column.unit is not None else answer
                units = dict.fromkeys((*filter(None, (unit,)), *units_for(column.column).split(", ")))
                made = choice(Message("Unit of {heading}", heading=column.heading), list(units), unit or None)
                key = f"{kind}.{column.heading}"
                made.on_value_change(lambda event, key=key: self._answer("unit", key, event.value))
        for name in ("tool", "plate"):
            if name in table.form.names and (answer := getattr(self.answers, name).get("")):
                self._add_typed_answer(label(name), answer, name, "")

    def _add_typed_answer(self, words: str, text: str, option: str, key: str) -> None:
        """Add a text field; when it is left with another text, this becomes the answer of an option for a key."""
        typed = field(words, text)
        typed.on("blur", lambda: self._answer(option, key, str(typed.value)) if typed.value != text else None)

    async def _move_headings(self, section: Section, kind: str, row: str) -> None:
        """Use another row of the sheet, counted from 1, as the headings of a table."""
        if row.isdecimal() and int(row) != section.header + 1:
            self.answers = self.answers.with_("table", section.key, NONE)
            await self._answer("table", f"{section.sheet.name}:{int(row)}", kind)

    def _site(self, table: ImportedTable, tables: Sequence[ImportedTable]) -> None:
        """Add a field for the site of a sheet or table, if the table has no column for it."""
        sheet = table.section.sheet.name
        if any(column.column == "site" for column in table.columns) or not table.rows:
            return
        site = table.rows[0].cells["site"]
        on_sheet = [other for other in tables if other.section.sheet.name == sheet and other.rows]
        differ = any(other.rows[0].cells.get("site") != site for other in on_sheet)
        key = table.section.key if differ else sheet
        self._add_typed_answer(Message("Site of the sheet {sheet}", sheet=key), site, "site", key)

    async def _answer(self, option: str, key: str, value: str) -> None:
        """Add an answer, and read the file again."""
        self.answers = self.answers.with_(option, key, value)
        self._status.say(Message("Reading the file again …"))
        await self.draw()

    async def _use_template(self, event: object) -> None:
        """Use the answers of the chosen campaign, or none, and read the file again."""
        chosen = str(getattr(event, "value", ""))
        self.answers = self.imports.template_answers(chosen) if chosen else Answers()
        await self.draw()

    def _save_template(self) -> None:
        """Save the answers as a template under the typed name; rejects a proposal with open questions."""
        self.imports.save_template(str(self._name.value), self._ready_files())
        self._status.say(Message("Template saved for the next campaign: {name}", name=self._name.value))

    def _ready_files(self) -> Mapping[str, bytes]:
        """Files of the campaign; rejects a proposal with open questions or errors."""
        if self.proposal is None or self.proposal.problems:
            raise ParameterError("Answer the questions first.").tag("not_ready")
        return self.proposal.files

    async def _keep_campaign(self) -> None:
        """Store the imported campaign and show it on the page of campaigns."""
        added = await run.io_bound(self.imports.store, self.id_, self._ready_files())
        if added is not None:
            ui.navigate.to(f"/?added={added}")


def _with_unit(column: ColumnChoice) -> str:
    """Heading with the unit of its numbers, and the unit in which they are stored if it is another one."""
    if column.unit is None:
        return column.heading
    stored, unit = units_for(column.column).split(", ")[0], column.unit.name
    fields = {"heading": column.heading, "unit": unit}
    if unit == stored:
        return Message("{heading}, in {unit}", **fields)
    return Message("{heading}, {unit} to {stored}", **fields, stored=stored)


def _place_words(problem: Problem) -> str:
    """Place of a problem in the imported file, with the text there."""
    value = problem.value or ""
    if problem.row is None:
        return value
    return Message("{sheet}, row {row}: {value}", sheet=problem.file, row=problem.row, value=value)


def _question_words(question: Question) -> Message:
    """Question about a heading, unit, table, site, row or cell of an imported file, for the page."""
    key, option = question.key, question.option
    if option in {"column", "unit"}:
        kind, _, heading = key.partition(".")
        return Message(QUESTIONS[option], heading=heading, table=TABLES[f"{kind}.csv"])
    sheet, _, place = key.rpartition(":" if option == "table" else "!")
    kind = "row" if option == "ignore" and place.isdecimal() else key if option == "cells" else option
    return Message(QUESTIONS[kind], key=key, sheet=sheet, row=place, place=place)


def _choice_words(text: str) -> str:
    """Text of an answer: yes, no, left out, a table or a column."""
    words = {"yes": Message("yes"), "no": Message("no"), NONE: LEFT_OUT}
    return said(words[text] if text in words else TABLES.get(f"{text}.csv", label(text)))


def _show_rows(table: ImportedTable) -> None:
    """Add to the page a table of the first rows that an import will store, with long numbers cut to five digits."""
    present = dict.fromkeys(name for row in table.rows[:_SHOWN_ROWS] for name in row.cells)
    numbers = number_columns(table.form)
    names = sorted(present, key=lambda name: name in {"time", *FROM_NOTES})  # measured numbers first
    count = len(table.rows)
    place, file = table.section.key, table.form.file
    words = Message("{place}: {count} rows, stored as {file}", place=place, count=count, file=file)
    with ui.element("div").classes("table"), ui.element("table"):
        with ui.element("caption"):
            Words(words)
        add_head(label(name) for name in names)
        with ui.element("tbody"):
            for row in table.rows[:_SHOWN_ROWS]:
                with ui.element("tr"):
                    for name in names:
                        with ui.element("td"):
                            text = row.cells.get(name, "")
                            ui.label(number_text(_five_digits(text)) if name in numbers else text)


def _five_digits(number: str) -> str:
    """Text of a number rounded to five digits, but without an exponent; the stored one keeps all its digits.

    >>> _five_digits("294.1995"), _five_digits("22.50"), _five_digits("1250000")
    ('294.2', '22.50', '1250000')
    """
    shown = f"{float(number):.5g}" if len(number) > _READABLE else number
    return number if "e" in shown else shown
