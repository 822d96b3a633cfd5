"""A new campaign as one workbook: a sheet for the description, and one for each table."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any, Final

from ..reading.sheet_description import CAMPAIGN, COLUMNS, PLATES, TOOLS
from .description import LENGTH_MM, WIDTH_MM, keys_with_values
from .tables import PLATE, PLATE_LENGTH_MM, TEMPLATES, TOOL

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

_WIDEST: Final = 60


def workbook_bytes(name: str) -> bytes:
    """The .xlsx file of a new campaign; what stands in a column is said in a note at its heading."""
    from openpyxl import Workbook

    book = Workbook()
    book.remove(book.active)
    described = [
        (key, _cell(value), quantity.unit, quantity.meaning) for key, value, quantity in keys_with_values(name)
    ]
    _fill(book.create_sheet(CAMPAIGN), ("key", "value", "unit", "meaning"), [*described, _OBSERVERS])
    _fill(
        book.create_sheet(TOOLS),
        ("name", "shape", "length_mm", "width_mm", "diameter_mm", "radius_mm"),
        [(TOOL, "ski", LENGTH_MM, WIDTH_MM)],
    )
    _fill(book.create_sheet(PLATES), ("name", "length_mm"), [(PLATE, PLATE_LENGTH_MM)])
    for template in TEMPLATES:
        sheet = book.create_sheet(template.form.file.removesuffix(".csv"))
        _fill(sheet, tuple(template.example), [tuple(template.example.values())], notes=dict(template.explained()))
    _fill(book.create_sheet(COLUMNS), ("heading", "column", "table"), [])
    stream = io.BytesIO()
    book.save(stream)
    return stream.getvalue()


_OBSERVERS: Final = ("observers", "", "", "who; several are parted by semicolons")


def _cell(text: str) -> str | float:
    try:
        return float(text)
    except ValueError:
        return text


def _fill(
    sheet: Any, header: Sequence[str], rows: Iterable[Sequence[str | float]], *, notes: dict[str, str] | None = None
) -> None:
    from openpyxl.comments import Comment
    from openpyxl.styles import Font
    from openpyxl.utils import get_column_letter

    every = [tuple(header), *rows]
    for row in every:
        sheet.append([None if cell == "" else cell for cell in row])
    for place, name in enumerate(header, start=1):
        head = sheet.cell(1, place)
        head.font = Font(bold=True)
        if notes and notes.get(name):
            head.comment = Comment(notes[name], "skisnow", height=90, width=300)
        longest = max(len(str(row[place - 1])) for row in every if len(row) >= place)
        sheet.column_dimensions[get_column_letter(place)].width = min(longest, _WIDEST) + 3
    sheet.freeze_panes = "A2"
