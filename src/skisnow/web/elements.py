"""Elements of the pages in their language, the frame of all pages, and pages about errors."""

from __future__ import annotations

import json
import logging
import secrets
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from html import escape
from importlib import import_module
from logging.handlers import RotatingFileHandler
from pathlib import Path
from typing import Any, Final, TypeVar
from urllib.parse import quote

from fastapi import FastAPI
from nicegui import app, ui
from starlette.requests import Request
from starlette.responses import HTMLResponse, Response

from .._support.errors import FieldDataError, ParameterError, SkisnowError, StoreError
from .._support.messages import Message, joined, languages, translated
from ..report.formatting import SYMBOL
from .guard import STATUS
from .pages import PAGES
from .words import language_of, language_of_request, said

AnyElement = TypeVar("AnyElement", bound=ui.element)

FIRST: Final = "(event) => { if (event.detail < 2) emit(kept.once()); }"
"""JavaScript handler that ignores the second click of a double click and sends the key of the request."""


def field(
    label: str, value: str = "", *, numeric: bool = False, wide: bool = False, optional: bool = False
) -> ui.input:
    """Add a text field with its label above it; the Enter key skips an `optional` one."""
    made = ui.input(said(label), value=value).props("outlined stack-label autocomplete=off")
    _show_symbols(made, label)
    made.classes("field wide" if wide else "field")
    if numeric:
        made.props("inputmode=decimal")
    if optional:
        made.props("data-optional")
    return made


def choice(label: str, options: Sequence[str] | Mapping[str, str], value: str | list[str] | None) -> ui.select:
    """Add a menu with options as texts by value; several can be chosen if ``value`` is a list."""
    made = ui.select(option_texts(options), label=said(label), value=value, multiple=isinstance(value, list))
    _show_symbols(made, label)
    return made.props("outlined stack-label").classes("field")


def _show_symbols(made: ui.element, label: str) -> None:
    """Show the symbols of a label, such as H_V, with subscripts; the name for screen readers stays."""
    if SYMBOL.search(label):
        with made.add_slot("label"):
            Words(label).props("aria-hidden=true")


def option_texts(options: Sequence[str] | Mapping[str, str]) -> dict[str, str]:
    """Texts of options in the language of the page, by value."""
    shown = options if isinstance(options, Mapping) else {option: option for option in options}
    return {value: said(words) for value, words in shown.items()}


def button(text: str, act: Callable[..., Any] | None, kind: str = "", *, once: bool = False) -> ui.button:
    """Add a button that calls `act`; ``kind``: main or quiet; ``once``: a double click counts once."""
    made = ui.button(said(text), on_click=None if once else act, color=None).props("no-caps unelevated")
    if once:
        made.on("click", act, js_handler=FIRST)
    return made.classes(f"act {kind}".strip())


def link(text: str, address: str, kind: str = "") -> ui.link:
    """Add a link that looks like a button, in the language of the page; ``kind``: main or small."""
    return ui.link(said(text), address).classes(f"act {kind}".strip())


class Words(ui.label):
    """Label in the language of the page, with subscripts in symbols such as H_V; ``text`` stays English."""

    def _text_to_model_text(self, text: str) -> None:
        """Show a text in the page's language, as HTML if it contains symbols with subscripts."""
        shown = said(text, self.client)
        is_markup = "innerHTML" in self._props or SYMBOL.search(shown)  # the page would stay blank without it again
        if is_markup:
            self._props["innerHTML"] = SYMBOL.sub(_SUBSCRIPT, escape(shown, quote=False))
        super()._text_to_model_text("" if is_markup else shown)


_SUBSCRIPT: Final = r'<i>\1</i><span class="under">_</span><sub>\2</sub>'
"""The underscore has no width; it is there for copied text and screen readers."""


class Outcome(Words):
    """Outcome of an action in one line, which screen readers announce."""

    def __init__(self, text: str = "") -> None:
        super().__init__(text)
        self.classes("status").props("role=status")

    def say(self, text: str, *, bad: bool = False) -> None:
        """Show a text, marked as good or bad."""
        self.set_text(text)
        self.classes(add="bad" if bad else "good", remove="good" if bad else "bad")


class StatusLine(ui.element):
    """Outcome of the last action, with a list of problems; screen readers announce it."""

    def __init__(self) -> None:
        super().__init__("div")
        self.props("role=status aria-live=polite")
        with self:
            self._outcome = Words("").classes("status")
            self._problems = ui.element("ul").classes("refusals")

    def say(self, text: str, kind: str = "good", items: Sequence[str] = ()) -> None:
        """Show a text, given in English, and items, given in the language of the page."""
        self._outcome.set_text(text)
        self._outcome.classes(remove="good bad", add=kind)
        self._problems.clear()
        with self._problems:
            add_items(items, ui.label)


def named(element: AnyElement, name: str) -> AnyElement:
    """Set the name of an element for screen readers; returns the element."""
    element.props["aria-label"] = said(name, element.client)
    return element


def add_items(items: Iterable[str], add: Callable[[str], object] = Words) -> None:
    """Add one list item per text, filled by `add`."""
    for item in items:
        with ui.element("li"):
            add(item)


def add_head(columns: Iterable[str]) -> None:
    """Add a table's head with one heading per column, in the language of the page."""
    with ui.element("thead"), ui.element("tr"):
        for words in columns:
            with ui.element("th").props("scope=col"):
                Words(words)


def folded(words: str, *, is_open: bool = False) -> ui.element:
    """Add a section with a title that the reader can open; ``is_open``: it is open at first."""
    with ui.element("details").props("open" if is_open else "") as made, ui.element("summary"):
        Words(words)
    return made


def html_words(html: str) -> ui.html:
    """Add HTML of the reports as it is; text from users must already be escaped in it."""
    return ui.html(html, sanitize=False)


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
    """Add links that show this page in each other language."""
    request = ui.context.client.request
    back = quote(request.url.path + (f"?{request.url.query}" if request.url.query else ""), safe="")
    for code, name in languages().items():
        if code != language_of():
            link = ui.link(code.upper(), f"{LANGUAGE}/{code}?back={back}").classes("language")
            link.props(f'hreflang={code} lang={code} title="{name}"').props["aria-label"] = name


def heading(text: str, level: int = 2) -> None:
    """Add a heading of a level from 1 to 6, in the language of the page."""
    with ui.element(f"h{level}"):
        Words(text)


def sentence(text: str, kind: str = "") -> ui.label:
    """Add a paragraph with a text; ``kind``: class of the style sheet (quiet, good, bad)."""
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
    """Notify the user of an error; outside of a page it is only logged."""
    sentence_ = error_sentence(error)
    try:
        ui.notify(said(sentence_), type="negative", multi_line=True, timeout=0, close_button=said(Message("Close")))
    except RuntimeError:  # outside of a page
        LOG.info("not shown on a page: %s", sentence_)


def _error_page(error: Exception) -> None:
    """Draw a page with the error's text; a wrong address or id gets status 404."""
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
    """Response 404: the lab has no page at this address."""
    return plain_page(Message("No such page"), Message("The lab has no page at this address."), 404, request)


async def _error_answer(request: Request, error: Exception) -> Response:
    """Response 500 with the error's text; an unexpected error is logged and shown by its reference."""
    if isinstance(error, SkisnowError):  # shown by the page
        words = error_sentence(error)
    else:
        words = Message("Something went wrong. Reference: {log_error}.", log_error=log_error(error))
    return plain_page(Message("This cannot be shown"), words, 500, request)
