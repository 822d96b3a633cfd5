"""Fields and buttons of the forms: large, each with its name, for keyboard and gloves."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from nicegui import ui

from .language import said
from .worded import TypedField

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence


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
