"""Fields, buttons, links and texts of the pages, in the language of the page."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from nicegui import ui

from ..report.translated import translated_html
from .language import language_of, said

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence, Set
    from typing import TypeVar

    Shown = TypeVar("Shown", bound=ui.element)

FIRST: Final = "(event) => { if (event.detail < 2) emit(kept.once()); }"
"""In the browser: the second press of a double one does nothing. Sent along: what tells it from a press of its own."""


def field(
    label: str, value: str = "", *, numeric: bool = False, wide: bool = False, optional: bool = False
) -> TypedField:
    """A field with its name above it. Numeric fields take what is typed as it is; Enter passes by an optional one."""
    made = TypedField(label, value=value).props("outlined stack-label autocomplete=off")
    made.classes("field wide" if wide else "field")
    if numeric:
        made.props("inputmode=decimal")
    if optional:
        made.props("data-optional")
    return made


def choice(label: str, options: Sequence[str] | dict[str, str], value: str | None) -> ui.select:
    """One of several; the keyboard opens it with the space bar or the arrow."""
    made = ui.select(said_options(options), label=said(label), value=value)
    return made.props("outlined stack-label").classes("field")


def said_options(options: Sequence[str] | dict[str, str]) -> dict[str, str]:
    """What is shown for each option, by its value."""
    shown = options if isinstance(options, dict) else {option: option for option in options}
    return {value: said(words) for value, words in shown.items()}


def button(text: str, act: Callable[..., Any] | None, kind: str = "", *, once: bool = False) -> ui.button:
    """A button; ``kind``: main or quiet; ``once``: what it does is done once where it is pressed twice in a row."""
    made = ui.button(said(text), on_click=None if once else act, color=None).props("no-caps unelevated")
    if once:
        made.on("click", act, js_handler=FIRST)
    return made.classes(f"act {kind}".strip())


def link(text: str, address: str, kind: str = "") -> ui.link:
    """A link as large as a button."""
    return ui.link(said(text), address).classes(f"act {kind}".strip())


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
