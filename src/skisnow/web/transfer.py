"""Import and export of campaigns: forms, waiting uploads with their templates, and zip files."""

from __future__ import annotations

import secrets
import shutil
from collections.abc import Mapping
from functools import partial
from pathlib import Path, PurePath
from tempfile import TemporaryDirectory
from typing import IO, Final

from fastapi import FastAPI
from starlette.concurrency import run_in_threadpool
from starlette.datastructures import FormData
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response

from .._support.errors import ParameterError, StoreError
from .._support.messages import Message
from ..campaign.importing.answers import (
    TEMPLATES,
    Answers,
    parse_template,
    read_template,
    save_template,
    saved_templates,
)
from ..campaign.importing.folder import RECORD, write_import
from ..campaign.importing.proposal import Proposal, propose
from ..campaign.reading.campaign import READ_FILES, campaign_of_files
from ..campaign.reading.campaign_file import CAMPAIGN_FILE
from ..campaign.reading.campaign_files import FilesInMemory
from ..campaign.store import Journals, campaign_files, corrected_files, export_corrected, export_entered, replay_journal
from ..estimation.result_rows import first_hardness
from .elements import error_sentence, plain_page
from .page_requests import add_upload, required_id, uploaded_files
from .settings import Lab
from .uploads import BOUNDS, add_uploaded, confined, zip_download, zip_of_campaign

IMPORT: Final = "/import"


def add_transfer(app: FastAPI, lab: Lab) -> None:
    """Add the addresses that import uploaded campaigns and export stored ones as zip files."""

    def store(form: FormData) -> str:
        missing = Message("no file was chosen; choose the files of a campaign, its folder, or a zip of it")
        uploads = uploaded_files(form, "files", missing)
        try:
            with TemporaryDirectory(prefix="skisnow-upload-") as folder:
                for number, upload in enumerate(uploads):
                    with (Path(folder) / str(number)).open("xb") as file:
                        shutil.copyfileobj(upload.file, file)
                names = [upload.filename or "" for upload in uploads]  # they are unpacked in another process
                return f"/?added={confined(BOUNDS, add_uploaded, lab.store.path, folder, names, lab.limits)}"
        except ParameterError as error:
            name = uploads[0].filename or ""
            if error.code != "no_campaign" or len(uploads) > 1 or not name.lower().endswith(ENDINGS):
                raise
        uploads[0].file.seek(0)
        return f"{IMPORT}/{FileImports(lab).keep(name, uploads[0].file)}"

    async def export(request: Request, kind: str, id_: str) -> Response:
        if kind not in ("entry", "kept"):
            raise HTTPException(404)
        try:
            content = await run_in_threadpool(zip_of_campaign, partial(write_campaign, lab, kind, id_))
        except StoreError as error:
            return plain_page(Message("This cannot be exported"), error_sentence(error), 404, request)
        return zip_download(content, f"campaign-{required_id(id_)}.zip")

    too_many = Message("Nothing was stored: at most {files} files at once can be imported.", files=lab.limits.files)
    add_upload(app, IMPORT, store, max_files=lab.limits.files, too_many=too_many)
    app.add_api_route("/export/{kind}/{id_}.zip", export, response_model=None)


def files_in_memory(lab: Lab, kind: str, id_: str) -> FilesInMemory:
    """Current files of an entered campaign (kind ``entry``), or of an imported one (kept) with its corrections."""
    if kind == "entry":
        texts = campaign_files(replay_journal(Journals(lab.store).entries(required_id(id_))))
        return FilesInMemory({name: text.encode("utf-8") for name, text in texts.items()})
    stored, files = lab.store.contents(required_id(id_), READ_FILES)
    corrected = corrected_files(files, Journals(lab.store).corrections(stored.id))
    others = (file.path for file in stored.files if "/" not in file.path and file.path not in READ_FILES)
    return FilesInMemory(corrected, tuple(others))


def write_campaign(lab: Lab, kind: str, id_: str, folder: Path) -> None:
    """Write an entered campaign (kind ``entry``), or an imported one with its corrections, to a new folder."""
    (export_entered if kind == "entry" else export_corrected)(lab.store, required_id(id_), folder)


FOLDER: Final = "imports"
_SAVED: Final = "saved:"  # before the name of a saved template, to distinguish it from ids of campaigns
ENDINGS: Final = (".xlsx", ".xlsm", ".csv", ".txt", ".tsv")


def try_import(name: str, data: bytes, answers: Answers) -> tuple[Proposal, tuple[str, float] | None]:
    """Proposal of an import; with name and H_V (N/mm³) of one series if the proposal has no problems, else None."""
    proposal = propose(name, data, answers)
    return proposal, first_hardness(campaign_of_files(proposal.files)) if proposal.files else None


class FileImports:
    """Uploaded files that wait for their import as campaigns, each in a folder of the lab, and import templates."""

    def __init__(self, lab: Lab) -> None:
        self._lab = lab
        self._folder = lab.runs / FOLDER

    def keep(self, name: str, content: IO[bytes]) -> str:
        """Store an uploaded file with its name for an import; returns the id of the new import."""
        id_ = secrets.token_hex(6)
        place = self._folder / id_
        place.mkdir(parents=True)
        with (place / "content").open("xb") as file:
            shutil.copyfileobj(content, file)
        (place / "name").write_text(PurePath(name.replace("\\", "/")).name, encoding="utf-8")
        return id_

    def name(self, id_: str) -> str:
        """Name of an uploaded file. Raises ParameterError: no such upload waits."""
        place = self._folder / required_id(id_) / "name"
        if not place.is_file():
            raise ParameterError("This upload was imported already. Choose the file again.").tag("no_upload")
        return place.read_text(encoding="utf-8")

    def content(self, id_: str) -> tuple[str, bytes]:
        """Name and bytes of an uploaded file. Raises ParameterError: no such upload waits."""
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
        """Names of the saved templates, then of imported campaigns, newest first, by their value in a menu."""
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
        """Folder of the lab's templates for imports."""
        return self._lab.runs.parent / TEMPLATES

    def template_answers(self, id_: str) -> Answers:
        """Answers to the questions of an import, from a saved template or an earlier imported campaign."""
        if id_.startswith(_SAVED):
            return read_template(id_.removeprefix(_SAVED), named=self._templates)
        stored, files = self._lab.store.contents(required_id(id_), {CAMPAIGN_FILE})
        return parse_template(files[CAMPAIGN_FILE].decode(), stored.name)
