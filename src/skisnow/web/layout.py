"""The frame that every page stands in: navigation, title, one column of content."""

from __future__ import annotations

import json
from contextlib import contextmanager
from html import escape
from importlib import import_module
from typing import TYPE_CHECKING
from urllib.parse import quote

from nicegui import ui

from .._support.language import languages
from .elements import Words, named
from .language import language_of, said
from .pages import PAGES

if TYPE_CHECKING:
    from collections.abc import Iterator

STYLES = "/lab.css"
SCRIPT = "/lab.js"
KEEPING = "/kept.js"
CONNECTED = "lab.connected()"
LANGUAGE = "/language"
SAID_BY_SCRIPT = {
    "lost": "The lab does not answer. What is shown as stored is stored. The fields open again by themselves.",
    "before": "Typed before and not stored:",
    "meanwhile": "Typed meanwhile and not used:",
    "refused": "not stored",
}
CONNECTING = "Connecting to the lab. The fields open as soon as it answers."


@contextmanager
def framed(title: str, *, here: str = "", ahead: bool = False, keeps: bool = False) -> Iterator[None]:
    """Put what follows into the frame of the lab. Fields and buttons are open while the browser is connected.

    Parameters
    ----------
    title
        Heading of the page, and with the lab's name the title of its window.
    here
        ``PATH`` of the page in the navigation that this one belongs to.
    ahead
        What is typed before the page is connected goes into the field that the page then puts the focus in.
    keeps
        What is typed and not stored yet is there again when the page is loaded anew; so it is where ``ahead``.
    """
    ui.page_title(f"{said(title)} · skisnow")
    ui.add_head_html(f'<link rel="stylesheet" href="{STYLES}">')
    ui.add_head_html(f'<script src="{KEEPING}"{" data-keeps" if keeps or ahead else ""}></script>')
    ui.add_head_html(_script(ahead=ahead))
    client = ui.context.client
    client.run_javascript(CONNECTED)  # before all else that the page has to say: no focus goes into a closed field
    client.on_connect(lambda: client.run_javascript(CONNECTED))
    with ui.element("a").props('href="#content"').classes("skip"):
        Words("Skip to the content")
    with ui.element("header").classes("lab-head"):
        Words("skisnow").classes("lab-name")
        with named(ui.element("nav"), "Pages"):
            for name in PAGES:
                _link(name, here)
        _other_language()
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


def _script(*, ahead: bool) -> str:
    """The element of the browser's side, with what that says in the language of the page."""
    words = escape(json.dumps({key: said(text) for key, text in SAID_BY_SCRIPT.items()}, ensure_ascii=False))
    further = f'data-language="{language_of()}" data-words="{words}"{" data-ahead" if ahead else ""}'
    return f'<script src="{SCRIPT}" {further}></script>'


def _other_language() -> None:
    """A link for each language that the page is not in; it leads back here."""
    request = ui.context.client.request
    back = quote(request.url.path + (f"?{request.url.query}" if request.url.query else ""), safe="")
    for code, name in languages().items():
        if code != language_of():
            link = ui.link(code.upper(), f"{LANGUAGE}/{code}?back={back}").classes("language")
            link.props(f'hreflang={code} lang={code} title="{name}"').props["aria-label"] = name


def _link(name: str, here: str) -> None:
    page = import_module(f".pages.{name}", __package__)
    link = ui.link(said(page.TITLE), page.PATH)
    if here == page.PATH:
        link.props('aria-current="page"')


def heading(text: str, level: int = 2) -> None:
    """A heading of the page's outline."""
    with ui.element(f"h{level}"):
        Words(text)


def sentence(text: str, kind: str = "") -> ui.label:
    """A sentence of its own; ``kind`` is a class of the stylesheet: quiet, good, bad."""
    return Words(text).classes(f"sentence {kind}".strip())
