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
"""Maximum length of a request key."""


@dataclass(frozen=True, slots=True)
class PageRequest:
    """Data that the browser sends with an event.

    Attributes
    ----------
    number
        Number of the request that the page waits for (default: it does not wait).
    once
        Key of the request, equal if it is sent again.
    text
        Text of the field, if it is sent along.
    """

    number: int | None = None
    once: str | None = None
    text: str | None = None


_NOTHING: Final = PageRequest()
_ASKED: ContextVar[PageRequest] = ContextVar("asked", default=_NOTHING)
_ANSWERS: Final = WeakKeyDictionary[Client, dict[int, bool]]()
"""Answers by page and number: a repeated request is answered again without repeating the action."""


def current_request() -> PageRequest:
    """The request that is being handled."""
    return _ASKED.get()


def answering(act: Act) -> Callable[[GenericEventArguments], None]:
    """Handler that runs an action and sends its outcome to the waiting browser.

    Parameters
    ----------
    act
        Action that returns False for a rejected input; the browser then keeps the typed text.
    """
    client = ui.context.client  # the element may be deleted by the action

    def answered(event: GenericEventArguments) -> None:
        request, answers = _parse_request(event.args), _ANSWERS.setdefault(client, {})
        fine = answers.get(request.number, False) if request.number is not None else False
        try:
            if request.number is None or request.number not in answers:
                fine = _run_action(act, request)
        finally:
            if request.number is not None:
                answers[request.number] = fine
            _send_outcome(client, request, fine=fine)

    return answered


def _run_action(act: Act, what: PageRequest) -> bool:
    before = _ASKED.set(what)
    try:
        return act() is not False
    finally:
        _ASKED.reset(before)


def _send_outcome(client: Client, what: PageRequest, *, fine: bool) -> None:
    if what.number is not None:
        client.run_javascript(f"lab.answered({what.number}, {'true' if fine else 'false'})")
    elif what.once is not None:
        client.run_javascript(f"lab.told({json.dumps(what.once)})")


def _parse_request(message: Any) -> PageRequest:
    """Request from the data of an event; unexpected values count as missing."""
    fields = message if isinstance(message, dict) else {}
    number, once, text = (fields.get(key) for key in ("number", "once", "text"))
    return PageRequest(
        number if isinstance(number, int) else None,
        once if isinstance(once, str) and len(once) <= LONGEST else None,
        text if isinstance(text, str) else None,
    )


def asking_button(text: str, act: Act, kind: str = "") -> ui.button:
    """Button whose action moves the focus; see `skisnow.web.elements.button`."""
    return button(text, None, kind).on("click", answering(act), js_handler=ASK)


def row_button(text: str, act: Act) -> ui.button:
    """Button that adds a row to a form and puts the focus on it; it stores nothing."""
    return button(text, None, "adds").on("click", answering(act), js_handler=ASK_FOR_ROW)


def redrawn_by(menu: ui.select) -> ui.element:
    """Group of fields that depend on a menu; they are disabled from a choice until they are drawn again."""
    client = ui.context.client
    menu.on("update:model-value", lambda: client.run_javascript("lab.drawn()"), js_handler=DRAW_ANEW)
    return ui.element("fieldset").classes("redrawn")


def go_on(address: str) -> None:
    """Go to another page of the lab after everything is stored; text typed meanwhile goes to that page."""
    ui.run_javascript(f"lab.leave({json.dumps(address)})")


def form(classes: str = "fields", *, sends: Act | None = None) -> ui.element:
    """Group of fields; Enter moves to the next empty field, and from the last one runs ``sends``."""
    made = ui.element("div").classes(classes)
    if sends is None:
        return made.on("keydown.enter", js_handler=ONWARD)
    return made.on("keydown.enter", answering(sends), js_handler=ENTER)
