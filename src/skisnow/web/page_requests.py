"""Requests from `lab.js`, which keeps typed text in the browser until the server's answer."""

from __future__ import annotations

import json
from contextvars import ContextVar
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final
from weakref import WeakKeyDictionary

from nicegui import Client, ui

from .elements import button

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import TypeAlias

    from nicegui.events import GenericEventArguments

    Act: TypeAlias = Callable[[], bool | None]

ASK: Final = "() => lab.ask(emit)"
ASK_FOR_ROW: Final = "() => lab.ask(emit, 'row')"
ENTER: Final = "(event) => lab.enter(event, emit)"
DRAW_ANEW: Final = "() => lab.drawAnew(emit)"
ONWARD: Final = "(event) => lab.onward(event)"
LONGEST: Final = 200
"""Of a number that the browser gives to what it sends."""


@dataclass(frozen=True, slots=True)
class PageRequest:
    """What the browser says of what it sends.

    Attributes
    ----------
    number
        Of the question that the page waits for; None where nobody waits.
    once
        What tells a thing that is sent again from a new one.
    text
        What is typed in the field, where it is sent along.
    """

    number: int | None = None
    once: str | None = None
    text: str | None = None


_NOTHING: Final = PageRequest()
_ASKED: ContextVar[PageRequest] = ContextVar("asked", default=_NOTHING)
_ANSWERS: Final = WeakKeyDictionary[Client, dict[int, bool]]()
"""Of each page the answers to its questions: what was asked again is answered again, and not done again."""


def asked() -> PageRequest:
    """What is being answered now."""
    return _ASKED.get()


def answering(act: Act) -> Callable[[GenericEventArguments], None]:
    """Tell the browser, where it waits for an act, when that is done.

    Parameters
    ----------
    act
        Gives False where it refused what it was given: what was typed on is then shown, and goes nowhere.
    """
    client = ui.context.client  # the place that asked may be gone when the act is done

    def answered(event: GenericEventArguments) -> None:
        what, known = _asked_of(event.args), _ANSWERS.setdefault(client, {})
        fine = known.get(what.number, False) if what.number is not None else False
        try:
            if what.number is None or what.number not in known:
                fine = _done(act, what)
        finally:
            if what.number is not None:
                known[what.number] = fine
            _tell(client, what, fine=fine)

    return answered


def _done(act: Act, what: PageRequest) -> bool:
    before = _ASKED.set(what)
    try:
        return act() is not False
    finally:
        _ASKED.reset(before)


def _tell(client: Client, what: PageRequest, *, fine: bool) -> None:
    if what.number is not None:
        client.run_javascript(f"lab.answered({what.number}, {'true' if fine else 'false'})")
    elif what.once is not None:
        client.run_javascript(f"lab.told({json.dumps(what.once)})")


def _asked_of(said: Any) -> PageRequest:
    """What came from the browser; anything else than expected counts as not said."""
    given = said if isinstance(said, dict) else {}
    number, once, text = (given.get(key) for key in ("number", "once", "text"))
    return PageRequest(
        number if isinstance(number, int) else None,
        once if isinstance(once, str) and len(once) <= LONGEST else None,
        text if isinstance(text, str) else None,
    )


def asking_button(text: str, act: Act, kind: str = "") -> ui.button:
    """A button whose answer puts the focus somewhere; see `skisnow.web.elements.button`."""
    return button(text, None, kind).on("click", answering(act), js_handler=ASK)


def row_button(text: str, act: Act) -> ui.button:
    """A button that adds a row to a form, stores nothing, and puts the focus into the row."""
    return button(text, None, "adds").on("click", answering(act), js_handler=ASK_FOR_ROW)


def redrawn_by(menu: ui.select) -> ui.element:
    """A group of fields that another choice in a menu draws anew; it is closed from the choice until that is done."""
    client = ui.context.client
    menu.on("update:model-value", lambda: client.run_javascript("lab.drawn()"), js_handler=DRAW_ANEW)
    return ui.element("fieldset").classes("redrawn")


def go_on(address: str) -> None:
    """Leave the page, on which all is stored, for another one of the lab; what is typed meanwhile goes there."""
    ui.run_javascript(f"lab.leave({json.dumps(address)})")


def form(classes: str = "fields", *, sends: Act | None = None) -> ui.element:
    """A group of fields in which Enter goes on to the next empty one and from the last one sends, where it sends."""
    made = ui.element("div").classes(classes)
    if sends is None:
        return made.on("keydown.enter", js_handler=ONWARD)
    return made.on("keydown.enter", answering(sends), js_handler=ENTER)
