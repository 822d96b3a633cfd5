"""Frame of all pages (navigation, title, one column of content), and pages about errors."""

from __future__ import annotations

import json
import logging
import secrets
from collections.abc import Iterator
from contextlib import contextmanager
from html import escape
from importlib import import_module
from logging.handlers import RotatingFileHandler
from pathlib import Path
from typing import Final
from urllib.parse import quote

from fastapi import FastAPI
from nicegui import app, ui
from starlette.requests import Request
from starlette.responses import HTMLResponse, Response

from .._support.errors import FieldDataError, ParameterError, SkisnowError, StoreError
from .._support.messages import Message, joined, languages, translated
from .elements import Words, named
from .guard import STATUS
from .pages import PAGES
from .words import language_of, language_of_request, said

STYLES = "/lab.css"
SCRIPT = "/lab.js"
KEEPING = "/kept.js"
CONNECTED = "lab.connected()"
LANGUAGE = "/language"
SAID_BY_SCRIPT = {
    "lost": Message("The lab does not answer. What is shown as stored is stored. The fields open again by themselves."),
    "before": Message("Typed before and not stored:"),
    "meanwhile": Message("Typed meanwhile and not used:"),
    "refused": Message("not stored"),
}
CONNECTING = Message("Connecting to the lab. The fields open as soon as it answers.")


@contextmanager
def page_frame(title: str, *, here: str = "", ahead: bool = False, keeps: bool = False) -> Iterator[None]:
    """Frame of a page around the block. Fields and buttons are enabled while the browser is connected.

    title: heading of the page and title of its window.
    here: ``PATH`` of the current page in the navigation.
    ahead: True if text that is typed before the connection goes to the field with the focus.
    keeps: True if unstored text is restored when the page is loaded again; implied by ``ahead``.
    """
    ui.page_title(f"{said(title)} · skisnow")
    ui.add_head_html(f'<link rel="stylesheet" href="{STYLES}">')
    ui.add_head_html(f'<script src="{KEEPING}"{" data-keeps" if keeps or ahead else ""}></script>')
    words = escape(json.dumps({key: said(text) for key, text in SAID_BY_SCRIPT.items()}, ensure_ascii=False))
    further = f'data-language="{language_of()}" data-words="{words}"{" data-ahead" if ahead else ""}'
    ui.add_head_html(f'<script src="{SCRIPT}" {further}></script>')
    client = ui.context.client
    client.run_javascript(CONNECTED)  # first, because a disabled field cannot get the focus
    client.on_connect(lambda: client.run_javascript(CONNECTED))
    with ui.element("a").props('href="#content"').classes("skip"):
        Words(Message("Skip to the content"))
    with ui.element("header").classes("lab-head"):
        Words("skisnow").classes("lab-name")
        menu = ui.button(said(Message("Menu")), color=None).classes("menu")  # lab.js opens the navigation
        menu.props("flat no-caps aria-expanded=false aria-controls=pages")
        with named(ui.element("nav").props("id=pages"), Message("Pages")):
            for name in PAGES:
                page = import_module(f".pages.{name}", __package__)
                page_link = ui.link(said(page.TITLE), page.PATH)
                if here == page.PATH:
                    page_link.props('aria-current="page"')
        _language_links()
    with (
        ui.element("div").props('id="content"'),  # inside the framework's main
        ui.element("fieldset").classes("lab").props("disabled role=none"),
    ):
        heading(title, 1)
        yield
    with ui.element("div").classes("lab-says"):
        Words(CONNECTING).classes("connection").props("role=status")
        Words("").classes("unused").props("role=status")
    if ahead:
        client.run_javascript("lab.answered(0, true)")


def _language_links() -> None:
    """Add links to this page in the other languages."""
    request = ui.context.client.request
    back = quote(request.url.path + (f"?{request.url.query}" if request.url.query else ""), safe="")
    for code, name in languages().items():
        if code != language_of():
            link = ui.link(code.upper(), f"{LANGUAGE}/{code}?back={back}").classes("language")
            link.props(f'hreflang={code} lang={code} title="{name}"').props["aria-label"] = name


def heading(text: str, level: int = 2) -> None:
    """Add a heading."""
    with ui.element(f"h{level}"):
        Words(text)


def sentence(text: str, kind: str = "") -> ui.label:
    """Add a paragraph; ``kind``: class of the style sheet (quiet, good, bad)."""
    return Words(text).classes(f"sentence {kind}".strip())


LOG: Final = logging.getLogger("skisnow.web")
LOG_BYTES: Final = 2_000_000

_PLAIN: Final = """<!doctype html><html lang="{language}"><meta charset="utf-8"><title>{title} · skisnow</title>
<meta name="viewport" content="width=device-width, initial-scale=1"><link rel="stylesheet" href="/lab.css">
<body><main class="lab"><h1>{title}</h1><p>{said}</p><p><a href="{address}">{back}</a></p></main></body></html>"""


def log_to(path: Path) -> None:
    """Write errors to this log file; one older file is kept."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handler = RotatingFileHandler(path, maxBytes=LOG_BYTES, backupCount=1, encoding="utf-8")
    handler.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(message)s"))
    LOG.addHandler(handler)
    LOG.setLevel(logging.INFO)
    LOG.propagate = False


def log_error(error: BaseException) -> str:
    """Write an error to the log; returns its reference."""
    reference = secrets.token_hex(4)
    LOG.error("reference %s", reference, exc_info=error)
    return reference


def error_sentence(error: BaseException) -> str:
    """Sentence of an error: the message of skisnow's errors, a reference to the log for others."""
    if isinstance(error, FieldDataError):
        return Message("The campaign cannot be used as it is: {error}", error=joined(error.sentences, "\n"))
    if isinstance(error, SkisnowError):
        return error.message
    return Message(
        "Something went wrong that should not. What was shown as stored is stored. Reference: {reference}.",
        reference=log_error(error),
    )


def add_error_pages(outer: FastAPI) -> None:
    """Replace the error pages and messages of the frameworks, which would show the exception."""
    app._exception_handlers.clear()  # its only handler prints traces to the terminal
    app.on_exception(_notify)
    app.on_page_exception(_error_page)
    for application in (app, outer):
        application.add_exception_handler(404, _not_found_answer)
        application.add_exception_handler(Exception, _error_answer)


def _notify(error: Exception) -> None:
    sentence_ = error_sentence(error)
    try:
        ui.notify(said(sentence_), type="negative", multi_line=True, timeout=0, close_button=said(Message("Close")))
    except RuntimeError:  # outside of a page
        LOG.info("not shown on a page: %s", sentence_)


def _error_page(error: Exception) -> None:
    if isinstance(error, StoreError | ParameterError):
        ui.context.client.request.scope[STATUS] = 404
    with page_frame(Message("This page cannot be shown")):
        sentence(error_sentence(error), "bad")


def plain_page(title: str, sentence: str, status: int, request: Request, form: str = "") -> Response:
    """Page without scripts in the language of the request: title, sentence, and a link to the form or the campaigns."""
    language = language_of_request(request)
    shown = {
        "title": title,
        "said": sentence,
        "back": Message("Back to the form") if form else Message("To the campaigns"),
    }
    words = {name: escape(translated(text, language)) for name, text in shown.items()}
    return HTMLResponse(_PLAIN.format(language=language, address=form or "/", **words), status)


async def _not_found_answer(request: Request, _: Exception) -> Response:
    return plain_page(Message("No such page"), Message("The lab has no page at this address."), 404, request)


async def _error_answer(request: Request, error: Exception) -> Response:
    if isinstance(error, SkisnowError):  # shown by the page
        words = error_sentence(error)
    else:
        words = Message("Something went wrong. Reference: {log_error}.", log_error=log_error(error))
    return plain_page(Message("This cannot be shown"), words, 500, request)
