"""A new campaign: a folder of files or one workbook, with an example row in each table.

No estimate counts the example rows: their status cancels them.
"""

from __future__ import annotations

import io
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from .._support.errors import OutputError
from .._support.spreadsheet_text import csv_text, is_number
from .._support.staging import prepare_folder, staged, write_file
from ..parameters import Quantity
from ..snow.published import moessner_2013
from .reading.campaign import CAMPAIGN_FILES
from .reading.campaign_file import CAMPAIGN_FILE, CAMPAIGN_KEYS
from .reading.table_forms import DENSITY, DROP_CONE, PENETRATION, SHEAR, TableForm, allowed_words
from .reading.workbook_files import CAMPAIGN, COLUMNS, PLATES, TOOLS, is_workbook
from .reference import design

EXAMPLE_STATUS: Final = "example: write over or delete this row"
"""A status cancels the experiment: the example is in no estimate even where it is left standing."""
TOOL: Final = design.TOOL
LENGTH_MM, WIDTH_MM = moessner_2013.TOOL_LENGTH_MM, moessner_2013.TOOL_WIDTH_MM
PLATE: Final = design.PLATE
PLATE_LENGTH_MM: Final = design.PLATE_LENGTH * 1e3


@dataclass(frozen=True, slots=True)
class Template:
    """Template of a table of a new campaign: its columns, and the cells of an example row by column."""

    form: TableForm
    example: Mapping[str, str | float]

    def explanations(self) -> Iterator[tuple[str, str]]:
        """Columns of the example, each with its meaning, allowed numbers and unit; "" if there is none."""
        numbers = {
            quantity.name: f"{quantity.meaning}; {allowed_words(quantity)} in {quantity.unit}"
            for quantity in self.form.numbers
        }
        yield from ((name, numbers.get(name) or WORDS.get(name, "")) for name in self.example)


WORDS: Final = {
    "experiment": "one name for all rows of an experiment, in their order",
    "sample": "a name for each sample",
    "test": "one name for all repeats of a test",
    "site": "where; sites are compared with each other",
    "spot": "may be blank: a spot of the site, which pairs penetration and shear tests",
    "tool": "a tool that the campaign describes",
    "plate": "a plate that the campaign describes",
    "repeat": "which repeat of the test",
    "time": "may be blank: day and time, such as 2026-11-23T09:10 or 23.11.2026 09:10",
    "status": "blank; a word cancels the experiment and says why",
    "remark": "may be blank",
}
_LAST: Final = {"time": "2026-11-23T09:10", "status": EXAMPLE_STATUS, "remark": ""}

TEMPLATES: Final = (
    Template(
        PENETRATION,
        {
            "experiment": "P1", "site": "site A", "spot": "1", "tool": TOOL, "edge_angle_deg": 30.0,
            "load_N": design.LOADS[0], "depth_mm": 1.25, **_LAST,
        },
    ),
    Template(
        SHEAR,
        {
            "experiment": "S1", "site": "site A", "spot": "1", "plate": PLATE, "edge_angle_deg": 90.0,
            "depth_mm": 5.5, "lever_arm_mm": 250.0, "moment_Nm": 12.25, **_LAST,
        },
    ),
    Template(DENSITY, {"sample": "D1", "site": "site A", "snow_density_kg_per_m3": 420.0, **_LAST}),
    Template(DROP_CONE, {"test": "C1", "site": "site A", "repeat": "1", "drop_cone_depth_mm": 13.5, **_LAST}),
)  # fmt: skip


def keys_with_values(name: str) -> Iterator[tuple[str, str, Quantity]]:
    """Key, default text and quantity of each value that campaign.toml of a new campaign with this name lists."""
    loads = "; ".join(f"{load:g}" for load in design.LOADS)
    cells = {"name": name, "gauge_resolution_mm": "0.01", "load_steps_N": loads}
    yield from ((key, cells.get(key, ""), quantity) for key, quantity in CAMPAIGN_KEYS.items())


def campaign_toml(name: str) -> str:
    """Text of campaign.toml of a new campaign: keys to fill in, and explanations of all columns as comments."""
    keys = "".join(_toml_line(*entry) for entry in keys_with_values(name))
    tables = "".join(
        f"# {template.form.file}\n" + "".join(f"#   {column}: {words}\n" for column, words in template.explanations())
        for template in TEMPLATES
    )
    return f"""\
# A campaign to be filled in: this file, and one row as an example in each table. Keys and columns carry their units.
# The status of the example rows keeps them out of every estimate; write over them or delete them.
{keys}
# Tables that have other headings: map each to a column (skisnow check proposes it)
# columns."Kantwinkel [°]" = "edge_angle_deg"

[[tool]]
name = "{TOOL}"
shape = "ski"       # or "disc" with diameter_mm, or "cylinder" with radius_mm and width_mm
length_mm = {LENGTH_MM:g}
width_mm = {WIDTH_MM:g}

[[plate]]
name = "{PLATE}"
length_mm = {PLATE_LENGTH_MM:g}

{tables}"""


def _toml_line(key: str, cell: str, quantity: Quantity) -> str:
    """Commented TOML line of a key; without a value the key itself is a comment."""
    about = f"# {quantity.meaning}{f' ({quantity.unit})' if quantity.unit else ''}\n"
    if quantity.kind == "text":
        return f'{about}{key} = "{cell}"\n'
    if quantity.kind == "numbers":
        return f"{about}{key} = [{cell.replace(';', ',')}]\n"
    return f"{about}{key} = {cell}\n" if cell else f"{about}# {key} =\n"


def workbook_bytes(name: str) -> bytes:
    """The .xlsx file of a new campaign; notes at the headings explain the columns."""
    from openpyxl import Workbook

    book = Workbook()
    book.remove(book.active)
    described = [
        (key, float(value) if is_number(value, ".") else value, quantity.unit, quantity.meaning)
        for key, value, quantity in keys_with_values(name)
    ]
    observers = ("observers", "", "", "who; several are parted by semicolons")
    _fill_sheet(book.create_sheet(CAMPAIGN), ("key", "value", "unit", "meaning"), [*described, observers])
    _fill_sheet(
        book.create_sheet(TOOLS),
        ("name", "shape", "length_mm", "width_mm", "diameter_mm", "radius_mm"),
        [(TOOL, "ski", LENGTH_MM, WIDTH_MM)],
    )
    _fill_sheet(book.create_sheet(PLATES), ("name", "length_mm"), [(PLATE, PLATE_LENGTH_MM)])
    for template in TEMPLATES:
        sheet = book.create_sheet(template.form.name)
        _fill_sheet(
            sheet, tuple(template.example), [tuple(template.example.values())], notes=dict(template.explanations())
        )
    _fill_sheet(book.create_sheet(COLUMNS), ("heading", "column", "table"), [])
    stream = io.BytesIO()
    book.save(stream)
    return stream.getvalue()


def _fill_sheet(
    sheet: Any, header: Sequence[str], rows: Iterable[Sequence[str | float]], *, notes: dict[str, str] | None = None
) -> None:
    """Write a header and rows into a sheet, with notes as comments on the header, and freeze the header."""
    from openpyxl.comments import Comment

    for row in (header, *rows):
        sheet.append([None if cell == "" else cell for cell in row])
    for place, name in enumerate(header, start=1):
        if notes and notes.get(name):
            sheet.cell(1, place).comment = Comment(notes[name], "skisnow", height=90, width=300)
    sheet.freeze_panes = "A2"


WORKBOOK: Final = "campaign.xlsx"


def write_new_campaign(folder: str | Path, *, xlsx: bool = False) -> tuple[Path, ...]:
    """Write a template of a campaign; in a folder with tables only campaign.toml.

    folder: folder, created if necessary; its name is that of the campaign.
    xlsx: True for a workbook instead of campaign.toml and four tables.
    Returns paths of the files. Each table has an example row, whose status excludes it from all estimates.
    Raises OutputError: the folder has a campaign.toml, or with ``xlsx`` any table, or cannot be written; nothing is
        written then.
    """
    folder = Path(folder)
    names = sorted(path.name for path in folder.iterdir()) if folder.is_dir() else []
    there = [name for name in names if name in CAMPAIGN_FILES or is_workbook(name)]
    if CAMPAIGN_FILE in there or (there and xlsx):
        raise OutputError(
            "{folder} already contains a campaign ({there}); nothing was written. Choose another folder."
        ).tag("holds_campaign_already", folder=folder, there=list(there))
    name = folder.resolve().name.replace("\\", "").replace('"', "") or "campaign"
    contents: dict[str, bytes | str] = (
        {WORKBOOK: workbook_bytes(name)} if xlsx else {CAMPAIGN_FILE: campaign_toml(name)}
    )
    if not xlsx and not there:
        for template in TEMPLATES:
            cells = [f"{cell:g}" if isinstance(cell, float) else cell for cell in template.example.values()]
            contents[template.form.file] = csv_text([template.example, cells])
    prepare_folder(folder)
    with staged(folder, last=next(iter(contents))) as stage:
        for file, content in contents.items():
            write_file(stage.path / file, content)
    return tuple(folder / file for file in contents)
