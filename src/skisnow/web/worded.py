"""Elements of the pages that show words: each shows them in the language of its page."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nicegui import ui

from ..report.translated import translated_html
from .language import language_of, said

if TYPE_CHECKING:
    from collections.abc import Sequence, Set
    from typing import TypeVar

    Shown = TypeVar("Shown", bound=ui.element)


class Words(ui.label):
    """A label; ``text`` stays as it was said, in English."""

    def _text_to_model_text(self, text: str) -> None:
        super()._text_to_model_text(said(text, self.client))


class TypedField(ui.input):
    """A field of one line."""

    def __init__(self, label: str = "", *, value: str = "") -> None:
        super().__init__(said(label) or None, value=value)


class StatusLine(ui.element):
    """The outcome of the last action, with a list where there are several problems; screen readers announce it."""

    def __init__(self) -> None:
        super().__init__("div")
        self.props("role=status aria-live=polite")
        with self:
            self._outcome = Words("").classes("status")
            self._problems = ui.element("ul").classes("refusals")

    def say(self, text: str, kind: str = "good", items: Sequence[str] = ()) -> None:
        """Show a text in English, and below it items that are in the language of the page already."""
        self._outcome.set_text(text)
        self._outcome.classes(remove="good bad", add=kind)
        self._problems.clear()
        with self._problems:
            for item in items:
                with ui.element("li"):
                    ui.label(item)


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
