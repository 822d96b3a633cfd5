"""Tools and blades of an import: of notes, or answers such as "ski 200 x 62 mm"."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from ..._support.messages import Message
from ..problems import error
from .notes import PLATE, TOOL, Note, length_mm, stated_plates, stated_tools
from .questions import Question, ask

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from ..problems import Problem
    from .answers import Answers
    from .rows import ImportedTable

TOOL_FORM: Final = "ski 200 x 62 mm"
PLATE_FORM: Final = "100 mm"
_CYLINDER: Final = re.compile(
    r"cylinder\s+r?\s*(\d+(?:[.,]\d+)?)\s*[x×]\s*(\d+(?:[.,]\d+)?)\s*(mm|cm|m)", re.IGNORECASE
)


@dataclass(frozen=True, slots=True)
class ToolText:
    """A tool of campaign.toml: its name, and its other keys with values."""

    name: str
    keys: tuple[tuple[str, str], ...]


PlateText = ToolText


def parse_tool(name: str, text: str) -> ToolText | None:
    """Tool of a text; None for any other text.

    >>> parse_tool("", "ski 20 x 6,2 cm").keys
    (('shape', '"ski"'), ('length_mm', '200'), ('width_mm', '62'))
    """
    if match := TOOL.fullmatch(text.strip()):
        lengths = length_mm(match[2], match[3] or match[5]), length_mm(match[4], match[5])
        keys: tuple[tuple[str, str], ...] = (
            ("shape", '"ski"'),
            ("length_mm", f"{lengths[0]:g}"),
            ("width_mm", f"{lengths[1]:g}"),
        )
    elif match := re.fullmatch(r"disc\s+(\d+(?:[.,]\d+)?)\s*(mm|cm|m)", text.strip()):
        keys = (("shape", '"disc"'), ("diameter_mm", f"{length_mm(match[1], match[2]):g}"))
    elif match := _CYLINDER.fullmatch(text.strip()):
        radius, width = (length_mm(match[each], match[3]) for each in (1, 2))
        keys = (("shape", '"cylinder"'), ("radius_mm", f"{radius:g}"), ("width_mm", f"{width:g}"))
    else:
        return None
    return ToolText(name or text.strip(), keys)


def parse_plate(name: str, text: str) -> PlateText | None:
    """Blade of a text such as "100 mm"; None for any other text."""
    match = PLATE.fullmatch(text.strip())
    return ToolText(name or text.strip(), (("length_mm", f"{length_mm(match[2], match[3]):g}"),)) if match else None


def tools_of(
    tables: Sequence[ImportedTable], answers: Answers, notes: Sequence[Note], open_: list[Question | Problem]
) -> Mapping[tuple[str, str], ToolText]:
    """Tools by sheet and by the name in the table, "" without a name."""
    return _described("tool", tables, answers.tool, notes, (stated_tools, parse_tool, TOOL_FORM), open_)


def plates_of(
    tables: Sequence[ImportedTable], answers: Answers, notes: Sequence[Note], open_: list[Question | Problem]
) -> Mapping[tuple[str, str], PlateText]:
    """Blades, likewise."""
    return _described("plate", tables, answers.plate, notes, (stated_plates, parse_plate, PLATE_FORM), open_)


def _described(
    kind: str,
    tables: Sequence[ImportedTable],
    answers: Mapping[str, str],
    notes: Sequence[Note],
    reading: tuple[Callable[[Sequence[Note]], set[str]], Callable[[str, str], ToolText | None], str],
    open_: list[Question | Problem],
) -> dict[tuple[str, str], ToolText]:
    stated_in, parse, form = reading
    with_tables = {table.section.sheet.name for table in tables}
    described: dict[tuple[str, str], ToolText] = {}
    for table in tables:
        if kind not in table.form.names:
            continue
        sheet = table.section.sheet.name
        stated = stated_in([note for note in notes if note.sheet == sheet or note.sheet not in with_tables])
        for name in dict.fromkeys(row.cells.get(kind, "") for row in table.rows) or [""]:
            if (sheet, name) in described:
                continue
            texts = ({answers[name]} if name in answers else set()) | (set() if name else stated)
            tools = {parse(name, text) for text in texts}
            if len(tools) == 1 and (tool := tools.pop()) is not None:
                described[sheet, name] = tool
            elif name in answers and parse(name, answers[name]) is None:
                open_.append(_bad_answer(kind, table.section.key, answers[name], form))
            elif not any(isinstance(each, Question) and (each.option, each.key) == (kind, name) for each in open_):
                value = ", ".join(sorted(filter(None, texts))) or name or None
                open_.append(ask(kind, name, table.section, value=value, proposed=form))
    return described


def _bad_answer(kind: str, place: str, value: str, form: str) -> Problem:
    return error(
        "bad_answer",
        place,
        column=kind,
        value=value,
        allowed=Message("lengths with a unit, such as {form}", form=form),
        action=Message("Correct --{option}.", option=kind),
    )
