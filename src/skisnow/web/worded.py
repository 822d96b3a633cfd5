"""Elements of the pages that show words: each shows them in the language of its page."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nicegui import ui

from ..report.translated import translated_html
from .language import language_of, said

if TYPE_CHECKING:
    from collections.abc import Set
    from typing import TypeVar

    Shown = TypeVar("Shown", bound=ui.element)


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


def html_words(html: str, names: Set[str] = frozenset()) -> ui.html:
    """HTML of the reports, in which all that users wrote is escaped, in the language of the page.

    Parameters
    ----------
    html
        In English.
    names
        What users wrote and is no word of ours.
    """
    return ui.html(translated_html(html, language_of(), names=names), sanitize=False)
