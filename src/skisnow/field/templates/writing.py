"""A new campaign on the disk."""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import TYPE_CHECKING, Final

from ...errors import OutputError
from ...files import write_file
from ...staging import staged, tidied
from ..reading.campaign import CAMPAIGN_FILES
from ..reading.campaign_file import CAMPAIGN_FILE
from .description import campaign_toml
from .tables import TEMPLATES

if TYPE_CHECKING:
    from collections.abc import Mapping

    from .tables import Template

WORKBOOK: Final = "campaign.xlsx"


def write_new_campaign(folder: str | Path, *, xlsx: bool = False) -> tuple[Path, ...]:
    """Write what a campaign is filled into.

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
        The folder holds a campaign, or cannot be written; nothing is left half-written.
    """
    folder = Path(folder)
    there = [name for name in (*CAMPAIGN_FILES, WORKBOOK) if (folder / name).exists()]
    if there:
        raise OutputError(
            f"{folder} holds a campaign already ({', '.join(there)}); nothing was written. Choose another folder."
        )
    name = folder.resolve().name.replace("\\", "").replace('"', "") or "campaign"
    contents = _workbook(name) if xlsx else _files(name)
    tidied(folder)
    with staged(folder, last=next(iter(contents))) as stage:
        for file, content in contents.items():
            write_file(stage.path / file, content)
    return tuple(folder / file for file in contents)


def _workbook(name: str) -> Mapping[str, bytes | str]:
    from .workbook import workbook_bytes

    return {WORKBOOK: workbook_bytes(name)}


def _files(name: str) -> Mapping[str, bytes | str]:
    return {CAMPAIGN_FILE: campaign_toml(name)} | {template.form.file: _csv(template) for template in TEMPLATES}


def _csv(template: Template) -> str:
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(template.example)
    cells = template.example.values()
    writer.writerow([f"{cell:g}" if isinstance(cell, float) else cell for cell in cells])
    return stream.getvalue()
