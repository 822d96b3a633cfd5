"""Addresses of a campaign's pages, requests from `lab.js` that keep typed text, and uploads by plain forms."""

from __future__ import annotations

import json
import re
import shutil
import unicodedata
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from tempfile import mkdtemp
from typing import Any, Final, TypeAlias
from urllib.parse import quote, urlencode
from weakref import WeakKeyDictionary

from fastapi import FastAPI
from nicegui import Client, ui
from nicegui.events import GenericEventArguments
from starlette.concurrency import run_in_threadpool
from starlette.datastructures import FormData, UploadFile
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response

from .._support.errors import ParameterError, SkisnowError, StoreError
from .._support.messages import Message
from .._support.staging import cannot_write
from .elements import Words, button, error_sentence, plain_page

Act: TypeAlias = Callable[[], bool | None]
ASK: Final = "() => lab.ask(emit)"
ASK_FOR_ROW: Final = "() => lab.ask(emit, 'row')"
ENTER: Final = "(event) => lab.enter(event, emit)"
DRAW_ANEW: Final = "() => lab.drawAnew(emit)"
ONWARD: Final = "(event) => lab.onward(event)"
LONGEST: Final = 200  # maximum length of a request key


@dataclass(frozen=True, slots=True)
class PageRequest:
    """Data of lab.js in an event: number of a request that waits for its outcome, its unique key, text of the field."""

    number: int | None = None
    once: str | None = None
    text: str | None = None


_NOTHING: Final = PageRequest()
_ASKED: ContextVar[PageRequest] = ContextVar("asked", default=_NOTHING)
_ANSWERS: Final = WeakKeyDictionary[Client, dict[int, bool]]()
"""Answers by page and number: a repeated request is answered again without repeating the action."""


def current_request() -> PageRequest:
    """Request of the browser whose action is running; an empty one outside of an action."""
    return _ASKED.get()


def event_handler(act: Act) -> Callable[[GenericEventArguments], None]:
    """Event handler that runs an action once per request and sends its outcome; False keeps the typed text."""
    client = ui.context.client  # the element may be deleted by the action

    def answered(event: GenericEventArguments) -> None:
        request, answers = _parse_request(event.args), _ANSWERS.setdefault(client, {})
        fine = request.number is not None and answers.get(request.number, False)
        before = _ASKED.set(request)
        try:
            if request.number is None or request.number not in answers:
                fine = act() is not False
        finally:
            _ASKED.reset(before)
            if request.number is not None:  # the page waits
                answers[request.number] = fine
                client.run_javascript(f"lab.answered({request.number}, {'true' if fine else 'false'})")
            elif request.once is not None:
                client.run_javascript(f"lab.told({json.dumps(request.once)})")

    return answered


def _parse_request(message: Any) -> PageRequest:
    """Request from the data of an event; unexpected values count as missing."""
    fields = message if isinstance(message, dict) else {}
    number, once, text = (fields.get(key) for key in ("number", "once", "text"))
    return PageRequest(
        number if isinstance(number, int) else None,
        once if isinstance(once, str) and len(once) <= LONGEST else None,
        text if isinstance(text, str) else None,
    )


def asking_button(text: str, act: Act, kind: str = "") -> ui.button:
    """Add a button whose action moves the focus, so that the page waits for it; ``kind``: main or quiet."""
    return button(text, None, kind).on("click", event_handler(act), js_handler=ASK)


def row_button(text: str, act: Act) -> ui.button:
    """Add a button whose action adds a row to a form and puts the focus on it; it stores nothing."""
    return button(text, None, "adds").on("click", event_handler(act), js_handler=ASK_FOR_ROW)


def redrawn_by(menu: ui.select) -> ui.element:
    """Add a group for fields that depend on a menu; they are disabled from a choice until they are drawn again."""
    client = ui.context.client
    menu.on("update:model-value", lambda: client.run_javascript("lab.drawn()"), js_handler=DRAW_ANEW)
    return ui.element("fieldset").classes("redrawn")


def go_on(address: str) -> None:
    """Go to another page of the lab after everything is stored; text typed meanwhile goes to that page."""
    ui.run_javascript(f"lab.leave({json.dumps(address)})")


def form(classes: str = "fields", *, sends: Act | None = None) -> ui.element:
    """Add a group for fields; Enter moves to the next empty field, and from the last one runs ``sends``."""
    made = ui.element("div").classes(classes)
    if sends is None:
        return made.on("keydown.enter", js_handler=ONWARD)
    return made.on("keydown.enter", event_handler(sends), js_handler=ENTER)


_ID: Final = re.compile(r"[0-9a-f]{4,64}")


def address(path: str, **parameters: str) -> str:
    """Address of a page with its parameters; empty ones are left out.

    >>> address("/carve", ski="a&b", other="")
    '/carve?ski=a%26b'
    """
    query = urlencode({key: value for key, value in parameters.items() if value}, quote_via=quote, safe="")
    return f"{path}?{query}" if query else path


def entry_address(id_: str, *, table: str = "", test: str = "", head: Mapping[str, str] | None = None) -> str:
    """Address of the page for entry in a campaign, or of a table and test there; ``head``: cells of a new test."""
    return address(f"/enter/{id_}", table=table, test=test, **(head or {}))


def correction_address(id_: str, *, table: str = "", test: str = "") -> str:
    """Address of the page for corrections of an imported campaign, or of a table and test there."""
    return address(f"/correct/{id_}", table=table, test=test)


def analysis(kind: str, id_: str) -> str:
    """Address of the page with the analysis of a campaign; kind: entry (entered) or kept (imported)."""
    return f"/analysis/{kind}/{id_}"


def export(kind: str, id_: str) -> str:
    """Address of a campaign's zip file; kind: entry (entered) or kept (imported)."""
    return f"/export/{kind}/{id_}.zip"


def plain_stem(called: str, otherwise: str) -> str:
    """Name of a file without folder and suffix, in characters that every system allows; `otherwise` if none is left.

    >>> plain_stem("Hang 3/Übungs lauf.gpx", "track"), plain_stem("雪.csv", "course")
    ('Ubungs-lauf', 'course')
    """
    stem = PurePosixPath(called.replace("\\", "/")).name.rsplit(".", 1)[0]
    plain = unicodedata.normalize("NFKD", stem).encode("ascii", "ignore").decode()
    return re.sub(r"[^A-Za-z0-9]+", "-", plain).strip("-")[:40] or otherwise


def free_place(folder: Path, stem: str, suffix: str = "") -> Path:
    """Path in a folder that does not exist yet: this name, or with the first free number after it."""
    places = (folder / f"{stem}{end}{suffix}" for end in ("", *(f"-{number}" for number in range(2, 1000))))
    return next(place for place in places if not place.exists())


def newest_first(paths: Iterable[Path]) -> list[Path]:
    """Paths sorted by the time of their last change, the newest first."""
    return sorted(paths, key=lambda path: -path.stat().st_mtime)


@contextmanager
def hidden_folder(parent: Path) -> Iterator[Path]:
    """Yield a new hidden folder to fill and rename; otherwise it is removed. OutputError if it cannot be made."""
    try:
        parent.mkdir(parents=True, exist_ok=True)
        made = Path(mkdtemp(prefix=".partial-", dir=parent))
    except OSError as error:
        raise cannot_write(parent, error) from error
    try:
        yield made
    finally:
        shutil.rmtree(made, ignore_errors=True)


def required_id(text: str) -> str:
    """The text, an id of a campaign in an address, if it has the form of one. Raises StoreError: it has not."""
    if not _ID.fullmatch(text):
        raise StoreError("This address names no campaign; the list of campaigns names all.").tag("no_campaign")
    return text


NOT_STORED = Message("The file was rejected")
ONE_FILE = Message("Nothing was stored: import one file at a time.")


def add_upload(
    app: FastAPI,
    place: str,
    store: Callable[[FormData], str],
    *,
    max_files: int = 1,
    max_fields: int = 10,
    too_many: str = ONE_FILE,
) -> None:
    """Add an address that receives a form; the guard in front of the application checks where requests come from.

    app, place: the application, and the address: that of the page with the form, and a further part.
    store: function that stores the upload and returns the address of the next page. Its errors are shown on a page.
    max_files, max_fields: maximum numbers of files and of other fields.
    too_many: sentence for a form with more.
    """
    page = place.rpartition("/")[0] or "/"

    async def receive(request: Request) -> Response:
        try:
            async with request.form(max_files=max_files, max_fields=max_fields) as form:
                next_page = await run_in_threadpool(store, form)
        except (SkisnowError, OSError) as error:
            wrong = Message("Nothing was stored: {error}", error=error_sentence(error))
            return plain_page(NOT_STORED, wrong, 400, request, page)
        except HTTPException:
            return plain_page(NOT_STORED, too_many, 400, request, page)
        return RedirectResponse(next_page, 303)

    app.add_api_route(place, receive, methods=["POST"], include_in_schema=False, response_model=None)


def uploaded_files(form: FormData, key: str, missing: str) -> list[UploadFile]:
    """Uploaded files of a field; ParameterError with the text `missing` without any."""
    files = [file for file in form.getlist(key) if isinstance(file, UploadFile) and file.filename]
    if not files:
        raise ParameterError(missing).tag("no_file")
    return files


def upload_form(address: str) -> ui.element:
    """Add a plain form for uploads that is sent to an address."""
    return ui.element("form").props(f'method=post action="{address}" enctype="multipart/form-data"')


def labelled_input(key: str, label: str, id_: str, further: str = "") -> ui.element:
    """Add a field with its label to a plain form, by default for a text; ``further``: HTML attributes of the field."""
    with ui.element("div").classes("labelled"):
        with ui.element("label").props(f"for={id_}"):
            Words(label)
        return ui.element("input").props(f"id={id_} name={key} {further}".rstrip())


def file_input(key: str, label: str, id_: str, further: str = "") -> None:
    """Add a field for files with its label to a plain form; ``further``: HTML attributes of the field."""
    labelled_input(key, label, id_, f"type=file required {further}")


def text_input(key: str, label: str, id_: str, further: str = "") -> None:
    """Add a field for a text with its label to a plain form; ``further``: HTML attributes of the field."""
    labelled_input(key, label, id_, further).classes("act plain")


def submit_button(text: str, *, kind: str = "", address: str = "") -> None:
    """Add a button that sends a plain form (default of ``address``: that of the form)."""
    further = f' formaction="{address}"' if address else ""
    with ui.element("button").props(f"type=submit{further}").classes(f"act {kind}".strip()):
        Words(text)
