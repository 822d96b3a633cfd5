"""Fields, buttons, links and texts of the pages, in the language of the page."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from html import escape
from typing import Any, Final, TypeVar

from nicegui import ui

from ..report.formatting import SYMBOL
from .words import said

AnyElement = TypeVar("AnyElement", bound=ui.element)

FIRST: Final = "(event) => { if (event.detail < 2) emit(kept.once()); }"
"""JavaScript handler that ignores the second click of a double click and sends the key of the request."""


def field(
    label: str, value: str = "", *, numeric: bool = False, wide: bool = False, optional: bool = False
) -> TypedField:
    """Text field with its label above it; the Enter key skips an optional one."""
    made = TypedField(label, value=value).props("outlined stack-label autocomplete=off")
    made.classes("field wide" if wide else "field")
    if numeric:
        made.props("inputmode=decimal")
    if optional:
        made.props("data-optional")
    return made


def choice(label: str, options: Sequence[str] | Mapping[str, str], value: str | list[str] | None) -> ui.select:
    """Menu with options as texts by value; several can be chosen if ``value`` is a list."""
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
    """Button; ``kind``: main or quiet; ``once``: a double click counts once."""
    made = ui.button(said(text), on_click=None if once else act, color=None).props("no-caps unelevated")
    if once:
        made.on("click", act, js_handler=FIRST)
    return made.classes(f"act {kind}".strip())


def link(text: str, address: str, kind: str = "") -> ui.link:
    """Link with the size of a button."""
    return ui.link(said(text), address).classes(f"act {kind}".strip())


class Words(ui.label):
    """Label in the language of the page, with subscripts in symbols such as H_V; ``text`` stays English."""

    def _text_to_model_text(self, text: str) -> None:
        shown = said(text, self.client)
        is_markup = "innerHTML" in self._props or SYMBOL.search(shown)  # the page would stay blank without it again
        if is_markup:
            self._props["innerHTML"] = SYMBOL.sub(_SUBSCRIPT, escape(shown, quote=False))
        super()._text_to_model_text("" if is_markup else shown)


_SUBSCRIPT: Final = r'<i>\1</i><span class="under">_</span><sub>\2</sub>'
"""The underscore has no width; it is there for copied text and screen readers."""


class TypedField(ui.input):
    """Text field of one line with a label in the language of the page."""

    def __init__(self, label: str = "", *, value: str = "") -> None:
        super().__init__(said(label) or None, value=value)
        _show_symbols(self, label)


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
    """Give an element a name for screen readers."""
    element.props["aria-label"] = said(name, element.client)
    return element


def add_items(items: Iterable[str], add: Callable[[str], object] = Words) -> None:
    """Add the items of a list, each by a function that adds its text."""
    for item in items:
        with ui.element("li"):
            add(item)


def add_head(columns: Iterable[str]) -> None:
    """Add the row of headings of a table."""
    with ui.element("thead"), ui.element("tr"):
        for words in columns:
            with ui.element("th").props("scope=col"):
                Words(words)


def folded(words: str, *, is_open: bool = False) -> ui.element:
    """Section that the reader can open, with its title; ``is_open`` at first."""
    with ui.element("details").props("open" if is_open else "") as made, ui.element("summary"):
        Words(words)
    return made


def html_words(html: str) -> ui.html:
    """HTML of the reports in the language of the page, in which text from users is escaped."""
    return ui.html(html, sanitize=False)
