"""Import of campaigns by a form, and export as zip files."""

from __future__ import annotations

import io
import shutil
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Final

from starlette.concurrency import run_in_threadpool
from starlette.datastructures import FormData, UploadFile
from starlette.requests import Request
from starlette.responses import Response

from .._support.errors import ParameterError, StoreError
from .._support.messages import Message
from ..campaign.reading import READ_FILES, FilesInMemory
from ..campaign.store import Journals, campaign_files, corrected_files, export_corrected, export_entered, replay_journal
from .file_imports import ENDINGS, FileImports
from .layout import error_sentence, plain_page
from .page_addresses import required_id
from .subprocesses import BOUNDS, confined
from .upload_forms import add_upload, uploaded_files
from .uploads import add_uploaded, files_below, write_zip

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fastapi import FastAPI

    from .settings import Lab

IMPORT: Final = "/import"


def add_transfer(app: FastAPI, lab: Lab) -> None:
    """Add the addresses for import and export of campaigns."""

    def store(form: FormData) -> str:
        missing = Message("no file was chosen; choose the files of a campaign, its folder, or a zip of it")
        uploads = uploaded_files(form, "files", missing)
        try:
            return f"/?added={_add_campaign(lab, uploads)}"
        except ParameterError as error:
            name = uploads[0].filename or ""
            if error.code != "no_campaign" or len(uploads) > 1 or not name.lower().endswith(ENDINGS):
                raise
        uploads[0].file.seek(0)
        return f"{IMPORT}/{FileImports(lab).keep(name, uploads[0].file)}"

    async def entry(request: Request, id_: str) -> Response:
        return await _zip_answer(lambda folder: write_entry(lab, id_, folder), id_, request)

    async def kept(request: Request, id_: str) -> Response:
        return await _zip_answer(lambda folder: write_kept(lab, id_, folder), id_, request)

    too_many = Message("Nothing was stored: at most {files} files at once can be imported.", files=lab.limits.files)
    add_upload(app, IMPORT, store, max_files=lab.limits.files, too_many=too_many)
    app.add_api_route("/export/entry/{id_}.zip", entry, response_model=None)
    app.add_api_route("/export/kept/{id_}.zip", kept, response_model=None)


def _add_campaign(lab: Lab, uploads: Sequence[UploadFile]) -> str:
    with TemporaryDirectory(prefix="skisnow-upload-") as name:
        names = [upload.filename or "" for upload in uploads]
        for number, upload in enumerate(uploads):
            with (Path(name) / str(number)).open("xb") as file:
                shutil.copyfileobj(upload.file, file)
        return confined(BOUNDS, add_uploaded, lab.store.path, name, names, lab.limits)


async def _zip_answer(write: Writing, id_: str, request: Request) -> Response:
    try:
        content = await run_in_threadpool(_zip, write)
    except StoreError as error:
        return plain_page(Message("This cannot be exported"), error_sentence(error), 404, request)
    headers = {"content-disposition": f'attachment; filename="campaign-{required_id(id_)}.zip"'}
    return Response(content, media_type="application/zip", headers=headers)


def _zip(write: Writing) -> bytes:
    packed = io.BytesIO()
    with TemporaryDirectory(prefix="skisnow-export-") as name:
        folder = Path(name) / "campaign"
        write(folder)
        write_zip(files_below(folder, under=folder.name), packed)
    return packed.getvalue()


def entry_files(lab: Lab, id_: str) -> FilesInMemory:
    """Files of an entered campaign in its current state."""
    files = campaign_files(replay_journal(Journals(lab.store).entries(required_id(id_))))
    return FilesInMemory({name: text.encode("utf-8") for name, text in files.items()})


def kept_files(lab: Lab, id_: str) -> FilesInMemory:
    """Files of an imported campaign with its corrections."""
    stored, files = lab.store.contents(required_id(id_), READ_FILES)
    corrected = corrected_files(files, Journals(lab.store).corrections(stored.id))
    return FilesInMemory(corrected, tuple(file.path for file in stored.files if _is_other(file.path)))


def _is_other(path: str) -> bool:
    return "/" not in path and path not in READ_FILES


def write_entry(lab: Lab, id_: str, folder: Path) -> None:
    """Write an entered campaign to a new folder."""
    export_entered(lab.store, required_id(id_), folder)


def write_kept(lab: Lab, id_: str, folder: Path) -> None:
    """Write an imported campaign to a new folder: unchanged files, and the corrections."""
    export_corrected(lab.store, required_id(id_), folder)


if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import TypeAlias

    Writing: TypeAlias = Callable[[Path], None]
