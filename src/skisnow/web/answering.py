"""The server's side of `lab.js`, which holds in the browser what is typed while an answer is on its way."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from nicegui import ui

from .fields import button

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import TypeAlias

    from nicegui.events import GenericEventArguments

    Act: TypeAlias = Callable[[], bool | None]

ASK: Final = "() => lab.ask(emit)"
ENTER: Final = "(event) => lab.enter(event, emit)"
ONWARD: Final = "(event) => lab.onward(event)"


def answering(act: Act) -> Callable[[GenericEventArguments], None]:
    """Tell the browser, where it waits for an act, when that is done.

    Parameters
    ----------
    act
        Gives False where it refused what it was given: what was typed on is then shown, and goes nowhere.
    """
    client = ui.context.client  # the place that asked may be gone when the act is done

    def answered(asked: GenericEventArguments) -> None:
        fine = False
        try:
            fine = act() is not False
        finally:
            if isinstance(asked.args, int):  # the question's number; nobody waits where there is none
                client.run_javascript(f"lab.answered({asked.args}, {'true' if fine else 'false'})")

    return answered


def asking_button(text: str, act: Act, kind: str = "") -> ui.button:
    """A button whose answer puts the focus somewhere; see `skisnow.web.fields.button`."""
    return button(text, None, kind).on("click", answering(act), js_handler=ASK)


def form(classes: str = "fields", *, sends: Act | None = None) -> ui.element:
    """A group of fields in which Enter goes on to the next empty one and from the last one sends, where it sends."""
    made = ui.element("div").classes(classes)
    if sends is None:
        return made.on("keydown.enter", js_handler=ONWARD)
    return made.on("keydown.enter", answering(sends), js_handler=ENTER)
