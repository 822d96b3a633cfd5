"""The list of campaigns."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from nicegui import ui

from ..layout import framed, sentence

if TYPE_CHECKING:
    from ..settings import Lab

PATH: Final = "/"
TITLE: Final = "Campaigns"


def add_page(lab: Lab) -> None:
    """Add the page to the application."""

    @ui.page(PATH)
    def campaigns() -> None:
        with framed("Campaigns", here=PATH):
            for stored in lab.store.list():
                sentence(stored.name)
