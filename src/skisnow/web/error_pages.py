"""What a person sees when something went wrong: a sentence and a reference. The log file has the rest."""

from __future__ import annotations

import logging
import secrets
from html import escape
from logging.handlers import RotatingFileHandler
from typing import TYPE_CHECKING, Final

from nicegui import app, ui
from starlette.responses import HTMLResponse, Response

from .._support.errors import FieldDataError, ParameterError, SkisnowError, StoreError
from .._support.language import catalogue
from .guard import STATUS
from .language import language_of_request, said
from .layout import framed, sentence

if TYPE_CHECKING:
    from pathlib import Path

    from fastapi import FastAPI
    from starlette.requests import Request

LOG: Final = logging.getLogger("skisnow.web")
LOG_BYTES: Final = 2_000_000

_PLAIN: Final = """<!doctype html><html lang="{language}"><meta charset="utf-8"><title>{title} · skisnow</title>
<meta name="viewport" content="width=device-width, initial-scale=1"><link rel="stylesheet" href="/lab.css">
<body><main class="lab"><h1>{title}</h1><p>{said}</p><p><a href="/">{back}</a></p></main></body></html>"""


def log_to(path: Path) -> None:
    """Let what went wrong be written to this file, of which the last two are kept."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handler = RotatingFileHandler(path, maxBytes=LOG_BYTES, backupCount=1, encoding="utf-8")
    handler.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(message)s"))
    LOG.addHandler(handler)
    LOG.setLevel(logging.INFO)
    LOG.propagate = False


def reported(error: BaseException) -> str:
    """Write an error to the log; the reference that finds it there."""
    reference = secrets.token_hex(4)
    LOG.error("reference %s", reference, exc_info=error)
    return reference


def error_sentence(error: BaseException) -> str:
    """An error as a sentence: our own errors say what to do, all others get a reference into the log."""
    if isinstance(error, FieldDataError):
        return f"The campaign cannot be used as it is: {error}"
    if isinstance(error, SkisnowError):
        return str(error)
    return f"Something went wrong that should not. What was shown as stored is stored. Reference: {reported(error)}."


def add_error_pages(outer: FastAPI) -> None:
    """Replace the frameworks' error pages and messages, which would show the exception; ``outer`` holds all else."""
    app._exception_handlers.clear()  # the only one writes traces to the terminal
    app.on_exception(_notified)
    app.on_page_exception(_page)
    for each in (app, outer):
        each.add_exception_handler(404, _not_found)
        each.add_exception_handler(Exception, _failed)


def _notified(error: Exception) -> None:
    told = error_sentence(error)
    try:
        ui.notify(said(told), type="negative", multi_line=True, timeout=0, close_button=said("Close"))
    except RuntimeError:  # no page belongs to what failed
        LOG.info("not shown on a page: %s", told)


def _page(error: Exception) -> None:
    if isinstance(error, StoreError | ParameterError):
        ui.context.client.request.scope[STATUS] = 404
    with framed("This page cannot be shown"):
        sentence(error_sentence(error), "bad")


def plain_page(title: str, sentence: str, status: int, request: Request) -> Response:
    """A page without any script, in the language of the request: a title, a sentence, the way back."""
    language = language_of_request(request)
    shown = {"title": title, "said": sentence, "back": "To the campaigns"}
    words = {name: escape(catalogue(language).translated(text)) for name, text in shown.items()}
    return HTMLResponse(_PLAIN.format(language=language, **words), status)


async def _not_found(request: Request, _: Exception) -> Response:
    return plain_page("No such page", "The lab has no page at this address.", 404, request)


async def _failed(request: Request, error: Exception) -> Response:
    if isinstance(error, SkisnowError):  # the page itself says it
        return plain_page("This cannot be shown", error_sentence(error), 500, request)
    return plain_page("This cannot be shown", f"Something went wrong. Reference: {reported(error)}.", 500, request)
