"""What comes over the pages' sockets and is none of their messages leaves a line in the log and no trace."""

from __future__ import annotations

import inspect
import logging
from functools import wraps
from typing import TYPE_CHECKING, Any, Final

from nicegui import core

from .error_pages import LOG

if TYPE_CHECKING:
    from collections.abc import Callable

_LIBRARIES: Final = ("engineio.server", "socketio.server")


def answer_quietly() -> None:
    """Put a net under every handler of the framework, and let its libraries write single lines into the log."""
    handlers: dict[str, Callable[..., Any]] = core.sio.handlers["/"]
    for name, handler in handlers.items():
        if not hasattr(handler, "__wrapped__"):
            handlers[name] = _quiet(name, handler)
    for library in _LIBRARIES:
        logger = logging.getLogger(library)
        logger.handlers = [_OneLine()]
        logger.propagate = False


def _quiet(name: str, handler: Callable[..., Any]) -> Callable[..., Any]:
    """What the framework's own pages send never raises here: what pages do with it is caught behind it."""

    @wraps(handler)
    async def answered(*given: Any) -> Any:
        try:
            answer = handler(*given)
            return await answer if inspect.isawaitable(answer) else answer
        except Exception as error:  # whatever a stranger sends
            if type(error).__module__ == "socketio.exceptions":  # the framework's own refusal, which its page waits for
                raise
            LOG.info("a socket sent a malformed %s (%s)", name, type(error).__name__)
        if name == "connect":
            raise ConnectionRefusedError
        return None

    return answered


class _OneLine(logging.Handler):
    """Writes what a library reports into the lab's log, in one line."""

    def emit(self, record: logging.LogRecord) -> None:
        kind = record.exc_info[0].__name__ if record.exc_info and record.exc_info[0] else ""
        said = " ".join(record.getMessage().split())[:200]
        LOG.info("%s: %s %s", record.name, said, kind)
