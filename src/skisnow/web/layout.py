"""The frame that every page stands in: navigation, title, one column of content."""

from __future__ import annotations

from contextlib import contextmanager
from importlib import import_module
from typing import TYPE_CHECKING

from nicegui import ui

from .pages import PAGES

if TYPE_CHECKING:
    from collections.abc import Iterator

STYLES = "/lab.css"
SCRIPT = "/lab.js"
KEEPING = "/kept.js"
CONNECTED = "lab.connected()"
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
    ui.page_title(f"{title} · skisnow")
    ui.add_head_html(f'<link rel="stylesheet" href="{STYLES}">')
    ui.add_head_html(f'<script src="{KEEPING}"{" data-keeps" if keeps or ahead else ""}></script>')
    ui.add_head_html(f'<script src="{SCRIPT}"{" data-ahead" if ahead else ""}></script>')
    client = ui.context.client
    client.run_javascript(CONNECTED)  # before all else that the page has to say: no focus goes into a closed field
    client.on_connect(lambda: client.run_javascript(CONNECTED))
    with ui.element("a").props('href="#content"').classes("skip"):
        ui.label("Skip to the content")
    with ui.element("header").classes("lab-head"):
        ui.label("skisnow").classes("lab-name")
        with ui.element("nav").props('aria-label="Pages"'):
            for name in PAGES:
                _link(name, here)
    with (
        ui.element("main").props('id="content"'),
        ui.element("fieldset").classes("lab").props("disabled role=none"),
    ):
        heading(title, 1)
        yield
    with ui.element("div").classes("lab-says"):
        ui.label(CONNECTING).classes("connection").props("role=status")
        ui.label("").classes("unused").props("role=status")
    if ahead:
        client.run_javascript("lab.answered(0, true)")


def _link(name: str, here: str) -> None:
    page = import_module(f".pages.{name}", __package__)
    link = ui.link(page.TITLE, page.PATH)
    if here == page.PATH:
        link.props('aria-current="page"')


def heading(text: str, level: int = 2) -> None:
    """A heading of the page's outline."""
    with ui.element(f"h{level}"):
        ui.label(text)


def sentence(text: str, kind: str = "") -> ui.label:
    """A sentence of its own; ``kind`` is a class of the stylesheet: quiet, good, bad."""
    return ui.label(text).classes(f"sentence {kind}".strip())
