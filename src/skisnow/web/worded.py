"""Elements of the pages that show words: each shows them in the language of its page."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from markupsafe import escape
from nicegui import ui

from .language import said

if TYPE_CHECKING:
    from typing import TypeVar

    Shown = TypeVar("Shown", bound=ui.element)

LONGEST: Final = 3000
"""Of a sentence in HTML (letters); what is longer is a table."""
_BETWEEN_TAGS: Final = re.compile(r">([^<>]*[^<>\s][^<>]*)<")
_LABELLED: Final = re.compile(r'aria-label="([^"]*)"')


class Words(ui.label):
    """A label; ``text`` stays as it was said, in English."""

    def _text_to_model_text(self, text: str) -> None:
        super()._text_to_model_text(said(text, self.client))


class TypedField(ui.input):
    """A field of one line; what is wrong with it is said in the language of the page."""

    def __init__(self, label: str = "", *, value: str = "") -> None:
        super().__init__(said(label) or None, value=value)

    @property
    def error(self) -> str | None:
        """What is wrong with what stands there, as it was said."""
        return self._error

    @error.setter
    def error(self, error: str | None) -> None:
        self._error = error
        self._props["error"] = None if error is None else True
        self._props["error-message"] = None if error is None else said(error, self.client)


def named(element: Shown, name: str) -> Shown:
    """Give an element the name that a screen reader says."""
    element.props["aria-label"] = said(name, element.client)
    return element


def html_words(html: str) -> ui.html:
    """HTML of the reports, in which all that users wrote is escaped: what stands between its tags is translated."""
    whole = said(html) if len(html) < LONGEST else html
    if whole == html:
        whole = _BETWEEN_TAGS.sub(lambda found: f">{_kept_blanks(found[1])}<", f">{html}<")[1:-1]
        whole = _LABELLED.sub(lambda found: f'aria-label="{escape(said(found[1]))}"', whole)
    return ui.html(whole, sanitize=False)


def _kept_blanks(text: str) -> str:
    inner = text.strip()
    return text.replace(inner, said(inner))
