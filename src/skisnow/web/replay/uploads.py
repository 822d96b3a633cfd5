"""The address that takes a measured track in."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final
from urllib.parse import quote

from starlette.concurrency import run_in_threadpool
from starlette.datastructures import FormData, UploadFile
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response

from ..._support.errors import ParameterError, SkisnowError
from ..confined import BOUNDS, confined
from ..error_pages import error_sentence, plain_page
from .tracks import Placing, number_of, points_of_track

if TYPE_CHECKING:
    from fastapi import FastAPI

    from .tracks import TrackFolders

UPLOAD: Final = "/replay/track"
_BACK: Final = "/replay"


def add_uploads(app: FastAPI, tracks: TrackFolders) -> None:
    """Let an application take tracks in. Where a request may come from is held by the guard around it."""

    async def take_in(request: Request) -> Response:
        try:
            async with request.form(max_files=1, max_fields=4) as form:
                name, _ = await run_in_threadpool(_kept, tracks, form)
        except (SkisnowError, OSError) as error:
            return plain_page("This was not taken in", f"Nothing was stored: {error_sentence(error)}", 400, request)
        except HTTPException:
            text = "Nothing was stored: one file at a time is taken in."
            return plain_page("This was not taken in", text, 400, request)
        return RedirectResponse(f"{_BACK}?track={quote(name, safe='')}", 303)

    app.add_api_route(UPLOAD, take_in, methods=["POST"], include_in_schema=False, response_model=None)


def _kept(tracks: TrackFolders, form: FormData) -> tuple[str, int]:
    upload = form.get("file")
    if not isinstance(upload, UploadFile) or not upload.filename:
        raise ParameterError("no file was chosen; choose the file of a track")
    azimuth = number_of(str(form.get("azimuth", "")), "the direction of the fall line")
    start = number_of(str(form.get("start", "")), "the time at the first point")
    placing = Placing(upload.filename[:200], azimuth, start or 0.0)
    return tracks.keep(upload.file, placing, count=lambda *what: confined(BOUNDS, points_of_track, *what))
