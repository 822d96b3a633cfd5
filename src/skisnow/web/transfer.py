"""Campaigns into the lab and out of it: uploads by a form, exports as zip files."""

from __future__ import annotations

import io
import shutil
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Final

from starlette.concurrency import run_in_threadpool
from starlette.datastructures import UploadFile
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response

from .._support.errors import ParameterError, SkisnowError, StoreError
from ..campaign.reading import READ_FILES, FilesInMemory
from ..campaign.store import Journals, campaign_files, corrected_files, export_corrected, export_entered, replayed
from .error_pages import error_sentence, plain_page
from .page_addresses import required_id
from .subprocesses import BOUNDS, confined
from .uploads import add_uploaded, files_below, write_zip

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from fastapi import FastAPI

    from ..campaign.store import ReplayedCampaign, ReplayedTest
    from .settings import Lab

IMPORT: Final = "/import"


def add_transfer(app: FastAPI, lab: Lab) -> None:
    """Add the addresses that take campaigns in and give them out."""

    async def take_in(request: Request) -> Response:
        try:
            async with request.form(max_files=lab.limits.files, max_fields=10) as form:
                uploads = [item for item in form.getlist("files") if isinstance(item, UploadFile) and item.filename]
                added = await run_in_threadpool(_added, lab, uploads)
        except (SkisnowError, OSError) as error:
            return plain_page("This was not taken in", f"Nothing was stored: {error_sentence(error)}", 400, request)
        except HTTPException:
            text = f"Nothing was stored: at most {lab.limits.files} files at once are taken in."
            return plain_page("This was not taken in", text, 400, request)
        return RedirectResponse(f"/?added={added}", 303)

    async def entry(request: Request, id_: str) -> Response:
        return await _packed(lambda folder: write_entry(lab, id_, folder), id_, request)

    async def kept(request: Request, id_: str) -> Response:
        return await _packed(lambda folder: write_kept(lab, id_, folder), id_, request)

    app.add_api_route(IMPORT, take_in, methods=["POST"], response_model=None)
    app.add_api_route("/export/entry/{id_}.zip", entry, response_model=None)
    app.add_api_route("/export/kept/{id_}.zip", kept, response_model=None)


def _added(lab: Lab, uploads: Sequence[UploadFile]) -> str:
    if not uploads:
        raise ParameterError("no file was chosen; choose the files of a campaign, its folder, or a zip of it")
    with TemporaryDirectory(prefix="skisnow-upload-") as name:
        names = [upload.filename or "" for upload in uploads]
        for number, upload in enumerate(uploads):
            with (Path(name) / str(number)).open("xb") as file:
                shutil.copyfileobj(upload.file, file)
        return confined(BOUNDS, add_uploaded, lab.store.path, name, names, lab.limits)


async def _packed(write: Writing, id_: str, request: Request) -> Response:
    try:
        content = await run_in_threadpool(_zip, write)
    except StoreError as error:
        return plain_page("This cannot be exported", error_sentence(error), 404, request)
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
    """The files of a campaign that is being entered, as they are now."""
    return replayed_in_memory(replayed(Journals(lab.store).entries(required_id(id_))))


def replayed_in_memory(campaign: ReplayedCampaign, *, of: Iterable[ReplayedTest] | None = None) -> FilesInMemory:
    """What `write_campaign` would write into a folder."""
    return FilesInMemory({name: text.encode("utf-8") for name, text in campaign_files(campaign, of=of).items()})


def kept_files(lab: Lab, id_: str) -> FilesInMemory:
    """What a kept campaign is read from: its own files, and what was corrected since."""
    stored, files = lab.store.contents(required_id(id_), READ_FILES)
    corrected = corrected_files(files, Journals(lab.store).corrections(stored.id))
    return FilesInMemory(corrected, tuple(file.path for file in stored.files if _is_other(file.path)))


def _is_other(path: str) -> bool:
    return "/" not in path and path not in READ_FILES


def write_entry(lab: Lab, id_: str, folder: Path) -> None:
    """Write a campaign that is being entered into a new folder."""
    export_entered(lab.store, required_id(id_), folder)


def write_kept(lab: Lab, id_: str, folder: Path) -> None:
    """Write a kept campaign into a new folder: its files as they came in, and what was corrected since."""
    export_corrected(lab.store, required_id(id_), folder)


if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import TypeAlias

    Writing: TypeAlias = Callable[[Path], None]
