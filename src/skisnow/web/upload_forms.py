"""Uploads by plain HTML forms: the form on a page, and the address that receives it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nicegui import ui
from starlette.concurrency import run_in_threadpool
from starlette.datastructures import FormData, UploadFile
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response

from .._support.errors import ParameterError, SkisnowError
from .._support.messages import Message
from .elements import Words
from .layout import error_sentence, plain_page

if TYPE_CHECKING:
    from collections.abc import Callable

    from fastapi import FastAPI

NOT_STORED = Message("This was not imported")
ONE_FILE = Message("Nothing was stored: import one file at a time.")


def add_upload(
    app: FastAPI,
    address: str,
    store: Callable[[FormData], str],
    *,
    max_files: int = 1,
    max_fields: int = 10,
    too_many: str = ONE_FILE,
) -> None:
    """Add an address that receives a form; the guard in front of the application checks where requests come from.

    Parameters
    ----------
    app, address
        The application, and the address.
    store
        Function that stores the upload and returns the address of the next page. Its errors are shown on a page.
    max_files, max_fields
        Maximum numbers of files and of other fields.
    too_many
        Sentence for a form with more.
    """

    async def receive(request: Request) -> Response:
        try:
            async with request.form(max_files=max_files, max_fields=max_fields) as form:
                place = await run_in_threadpool(store, form)
        except (SkisnowError, OSError) as error:
            return plain_page(
                NOT_STORED, Message("Nothing was stored: {error}", error=error_sentence(error)), 400, request
            )
        except HTTPException:
            return plain_page(NOT_STORED, too_many, 400, request)
        return RedirectResponse(place, 303)

    app.add_api_route(address, receive, methods=["POST"], include_in_schema=False, response_model=None)


def uploaded_files(form: FormData, key: str, missing: str) -> list[UploadFile]:
    """Uploaded files of a field; ParameterError with the text `missing` without any."""
    files = [file for file in form.getlist(key) if isinstance(file, UploadFile) and file.filename]
    if not files:
        raise ParameterError(missing, code="no_file")
    return files


def upload_form(address: str) -> ui.element:
    """Form that is sent to an address."""
    return ui.element("form").props(f'method=post action="{address}" enctype="multipart/form-data"')


def file_input(key: str, label: str, id_: str, further: str = "") -> None:
    """Field for files with its label; ``further`` properties of the field."""
    _labelled(id_, label)
    ui.element("input").props(f"type=file id={id_} name={key} required {further}".rstrip())


def text_input(key: str, label: str, id_: str, further: str = "") -> None:
    """Field for a text with its label; ``further`` properties of the field."""
    _labelled(id_, label)
    ui.element("input").props(f"id={id_} name={key} {further}".rstrip()).classes("act plain")


def _labelled(id_: str, label: str) -> None:
    with ui.element("label").props(f"for={id_}"):
        Words(label)


def submit_button(text: str, *, kind: str = "", address: str = "") -> None:
    """Button that sends the form, to another ``address`` than the form's if it is given."""
    further = f' formaction="{address}"' if address else ""
    with ui.element("button").props(f"type=submit{further}").classes(f"act {kind}".strip()):
        Words(text)
