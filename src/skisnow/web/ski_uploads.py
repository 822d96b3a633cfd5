"""The address that takes a measured ski in."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final
from urllib.parse import quote

from starlette.concurrency import run_in_threadpool
from starlette.datastructures import FormData, UploadFile
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response

from .._support.errors import ParameterError, SkisnowError
from .error_pages import error_sentence, plain_page
from .lab_skis import LabSkis
from .measured_ski import NAME, STIFFNESS, add_ski, ski_of_uploads

if TYPE_CHECKING:
    from fastapi import FastAPI

    from .settings import Lab

UPLOAD: Final = "/skis/add"
MOST_FILES: Final = 3


def add_ski_uploads(app: FastAPI, lab: Lab) -> None:
    """Let an application take skis in. Where a request may come from is held by the guard around it."""

    async def take_in(request: Request) -> Response:
        try:
            async with request.form(max_files=MOST_FILES, max_fields=10) as form:
                name = await run_in_threadpool(_added, lab, form)
        except (SkisnowError, OSError) as error:
            return plain_page("This was not taken in", f"Nothing was stored: {error_sentence(error)}", 400, request)
        except HTTPException:
            text = f"Nothing was stored: at most {MOST_FILES} files at once are taken in."
            return plain_page("This was not taken in", text, 400, request)
        return RedirectResponse(f"/skis?ski={quote(name, safe='')}&added=1", 303)

    app.add_api_route(UPLOAD, take_in, methods=["POST"], include_in_schema=False, response_model=None)


def _added(lab: Lab, form: FormData) -> str:
    uploads = [each for each in form.getlist("files") if isinstance(each, UploadFile) and each.filename]
    if not uploads:
        raise ParameterError("no file was chosen; choose the .toml file of a ski, or a design of MonkeyCAM")
    further = {key: str(form.get(key, "")) for key in STIFFNESS}
    texts = ski_of_uploads([(each.filename or "", each.file) for each in uploads], further, lab.limits)
    return add_ski(LabSkis(lab.runs), str(form.get(NAME, "")), texts)
