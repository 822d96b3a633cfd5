"""A new campaign on the disk."""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import TYPE_CHECKING, Final

from ..._support.errors import OutputError
from ..._support.staging import staged, tidied, write_file
from ..reading.campaign import CAMPAIGN_FILES
from ..reading.campaign_file import CAMPAIGN_FILE
from ..reading.workbook_files import is_workbook
from .description import campaign_toml
from .tables import TEMPLATES

if TYPE_CHECKING:
    from collections.abc import Mapping

    from .tables import Template

WORKBOOK: Final = "campaign.xlsx"


def write_new_campaign(folder: str | Path, *, xlsx: bool = False) -> tuple[Path, ...]:
    """Write what a campaign is filled into; where tables lie in the folder already, campaign.toml alone.

    Parameters
    ----------
    folder
        Made where it is missing; the campaign takes its name.
    xlsx
        One workbook in place of campaign.toml and four tables.

    Returns
    -------
    The files. Each table has a row as an example, whose status keeps it out of every estimate.

    Raises
    ------
    OutputError
        The folder holds a campaign.toml, or with ``xlsx`` any table, or cannot be written; nothing is half-written.
    """
    folder = Path(folder)
    there = _there(folder)
    if CAMPAIGN_FILE in there or (there and xlsx):
        raise OutputError(
            f"{folder} holds a campaign already ({', '.join(there)}); nothing was written. Choose another folder."
        )
    name = folder.resolve().name.replace("\\", "").replace('"', "") or "campaign"
    contents = _workbook(name) if xlsx else _files(name, tables=not there)
    tidied(folder)
    with staged(folder, last=next(iter(contents))) as stage:
        for file, content in contents.items():
            write_file(stage.path / file, content)
    return tuple(folder / file for file in contents)


def _workbook(name: str) -> Mapping[str, bytes | str]:
    from .workbook import workbook_bytes

    return {WORKBOOK: workbook_bytes(name)}


def _there(folder: Path) -> list[str]:
    """What a campaign reads and the folder has: files of tables, workbooks."""
    names = sorted(path.name for path in folder.iterdir()) if folder.is_dir() else []
    return [name for name in names if name in CAMPAIGN_FILES or is_workbook(name)]


def _files(name: str, *, tables: bool) -> Mapping[str, bytes | str]:
    written = {template.form.file: _csv(template) for template in TEMPLATES} if tables else {}
    return {CAMPAIGN_FILE: campaign_toml(name)} | written


def _csv(template: Template) -> str:
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(template.example)
    cells = template.example.values()
    writer.writerow([f"{cell:g}" if isinstance(cell, float) else cell for cell in cells])
    return stream.getvalue()
