"""Uploaded workbooks and CSV files that wait for an import, and their templates."""

from __future__ import annotations

import secrets
import shutil
from dataclasses import dataclass
from pathlib import Path, PurePath
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Final

from .._support.errors import ParameterError
from ..campaign.importing import (
    RECORD,
    TEMPLATES,
    Answers,
    Proposal,
    parse_template,
    propose,
    read_template,
    save_template,
    saved_templates,
    write_import,
)
from ..campaign.reading.campaign import campaign_of_files
from ..campaign.reading.campaign_file import CAMPAIGN_FILE
from ..estimation.result_rows import first_hardness
from .page_addresses import required_id

if TYPE_CHECKING:
    from collections.abc import Mapping
    from typing import IO

    from .settings import Lab

FOLDER: Final = "imports"
_SAVED: Final = "saved:"
"""Before the name of a saved template, to distinguish it from ids of campaigns."""
ENDINGS: Final = (".xlsx", ".xlsm", ".csv", ".txt", ".tsv")


@dataclass(frozen=True, slots=True)
class TriedImport:
    """A proposal, with name and H_V (N/mm³) of one series once it is complete."""

    proposal: Proposal
    hardness: tuple[str, float] | None


def try_import(name: str, data: bytes, answers: Answers) -> TriedImport:
    """Propose an import, and compute H_V of one series."""
    proposal = propose(name, data, answers)
    return TriedImport(proposal, first_hardness(campaign_of_files(proposal.files)) if proposal.files else None)


class FileImports:
    """Uploads that wait for their import, each in a folder of the lab."""

    def __init__(self, lab: Lab) -> None:
        self._lab = lab
        self._folder = lab.runs / FOLDER

    def keep(self, name: str, content: IO[bytes]) -> str:
        """Keep an uploaded file; returns its id."""
        id_ = secrets.token_hex(6)
        place = self._folder / id_
        place.mkdir(parents=True)
        with (place / "content").open("xb") as file:
            shutil.copyfileobj(content, file)
        (place / "name").write_text(PurePath(name.replace("\\", "/")).name, encoding="utf-8")
        return id_

    def name(self, id_: str) -> str:
        """Name of an uploaded file.

        Raises
        ------
        ParameterError
            No such upload waits.
        """
        place = self._folder / required_id(id_) / "name"
        if not place.is_file():
            raise ParameterError("This upload was imported already. Choose the file again.", code="no_upload")
        return place.read_text(encoding="utf-8")

    def content(self, id_: str) -> tuple[str, bytes]:
        """Name and bytes of an uploaded file; ParameterError as `name`."""
        return self.name(id_), (self._folder / required_id(id_) / "content").read_bytes()

    def store(self, id_: str, files: Mapping[str, bytes]) -> str:
        """Store a campaign and forget its upload; returns the id of the campaign."""
        with TemporaryDirectory(prefix="skisnow-import-") as name:
            folder = Path(name) / PurePath(self.name(id_)).stem
            write_import(files, folder)
            added = self._lab.store.add(folder).id
        shutil.rmtree(self._folder / required_id(id_))
        return added

    def templates(self) -> dict[str, str]:
        """Saved templates, then the campaigns with a template, the newest first: names by choice."""
        stored = reversed(self._lab.store.list())
        campaigns = {
            campaign.id: campaign.name for campaign in stored if any(file.path == RECORD for file in campaign.files)
        }
        return {f"{_SAVED}{name}": name for name in saved_templates(self._templates)} | campaigns

    def save_template(self, name: str, files: Mapping[str, bytes]) -> None:
        """Save the mapping of an import under a name; ParameterError for a name that cannot be used."""
        save_template(name.strip(), files[CAMPAIGN_FILE], folder=self._templates)

    @property
    def _templates(self) -> Path:
        return self._lab.runs.parent / TEMPLATES

    def template(self, id_: str) -> Answers:
        """Answers of a saved template or of an imported campaign."""
        if id_.startswith(_SAVED):
            return read_template(id_.removeprefix(_SAVED), named=self._templates)
        stored, files = self._lab.store.contents(required_id(id_), {CAMPAIGN_FILE})
        return parse_template(files[CAMPAIGN_FILE].decode(), stored.name)
