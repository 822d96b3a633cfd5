"""The lab as an ASGI application, with its sockets."""

from __future__ import annotations

import inspect
import logging
from functools import wraps
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from fastapi import FastAPI
from nicegui import app as pages_app
from nicegui import core, ui
from starlette.responses import FileResponse, RedirectResponse, Response

from .._support.messages import languages
from .guard import Access, Guard
from .layout import KEEPING, LANGUAGE, LOG, SCRIPT, STYLES, add_error_pages, log_to
from .pages import INNER, PAGES
from .replay_addresses import FIRST_SCRIPT
from .settings import PING_EVERY_S, PING_WAIT_S, RECONNECT_S
from .ski_uploads import add_ski_uploads
from .transfer import add_transfer
from .words import COOKIE

if TYPE_CHECKING:
    from collections.abc import Callable

    from starlette.types import ASGIApp

    from .settings import Lab

LOG_FILE: Final = "lab.log"
KEPT_S: Final = 365 * 24 * 3600
_HERE: Final = Path(__file__).parent


def lab_application(lab: Lab, *, host: str, token: str | None) -> ASGIApp:
    """ASGI application with the pages of a lab behind the guard. NiceGUI has one set of pages per process.

    Parameters
    ----------
    lab
        The lab.
    host
        Host that the server listens on; it determines the allowed Host headers.
    token
        Token that browsers must send (default on a loopback host: None).
    """
    log_to(lab.runs / LOG_FILE)
    outer = FastAPI(openapi_url=None, docs_url=None, redoc_url=None)
    outer.add_api_route(STYLES, lambda: _asset("lab.css", "text/css"), include_in_schema=False)
    outer.add_api_route(SCRIPT, lambda: _asset("lab.js", "text/javascript"), include_in_schema=False)
    outer.add_api_route(FIRST_SCRIPT, lambda: _asset("first.js", "text/javascript"), include_in_schema=False)
    outer.add_api_route(KEEPING, lambda: _asset("kept.js", "text/javascript"), include_in_schema=False)
    outer.add_api_route(LANGUAGE + "/{code}", _set_language, include_in_schema=False, response_model=None)
    add_transfer(outer, lab)
    add_ski_uploads(outer, lab)
    for name in (*PAGES, *INNER):
        import_module(f".pages.{name}", __package__).add_page(lab)
    add_error_pages(outer)
    ui.run_with(
        outer,
        title="skisnow",
        language="en-US",
        tailwind=False,
        show_welcome_message=False,
        reconnect_timeout=RECONNECT_S,
    )
    pages_app.on_startup(set_heartbeat)
    log_socket_errors()
    pages_app.config.socket_io_js_transports = ["websocket"]
    pages_app.config.quasar_config["loadingBar"] = {
        "skipHijack": True
    }  # a bar without an accessible name; the page shows the status
    return Guard(outer, Access(host, token, lab.limits.upload_bytes))


def _set_language(code: str, back: str = "/") -> Response:
    """Set the cookie of a language, and redirect to the page where it was chosen."""
    place = back if back.startswith("/") and not back.startswith(("//", "/\\")) else "/"
    answer = RedirectResponse(place, 303)
    if code in languages():
        answer.set_cookie(COOKIE, code, max_age=KEPT_S, samesite="lax", path="/", httponly=True)
    return answer


def _asset(name: str, kind: str) -> FileResponse:
    return FileResponse(_HERE / name, media_type=kind, headers={"cache-control": "no-cache"})


_LIBRARIES: Final = ("engineio.server", "socketio.server")


def log_socket_errors() -> None:
    """Catch the errors of the framework's socket handlers, and log those of its libraries in single lines."""
    handlers: dict[str, Callable[..., Any]] = core.sio.handlers["/"]
    for name, handler in handlers.items():
        if not hasattr(handler, "__wrapped__"):
            handlers[name] = _without_errors(name, handler)
    for library in _LIBRARIES:
        logger = logging.getLogger(library)
        logger.handlers = [_OneLine()]
        logger.propagate = False


def _without_errors(name: str, handler: Callable[..., Any]) -> Callable[..., Any]:
    """Handler that logs errors from malformed messages of strangers; errors of pages are caught elsewhere."""

    @wraps(handler)
    async def answered(*arguments: Any) -> Any:
        try:
            answer = handler(*arguments)
            return await answer if inspect.isawaitable(answer) else answer
        except Exception as error:  # any message of a stranger
            if type(error).__module__ == "socketio.exceptions":  # a rejection that its page waits for
                raise
            LOG.info("a socket sent a malformed %s (%s)", name, type(error).__name__)
        if name == "connect":
            raise ConnectionRefusedError
        return None

    return answered


class _OneLine(logging.Handler):
    """Log handler that writes messages of a library to the lab's log in one line."""

    def emit(self, record: logging.LogRecord) -> None:
        kind = record.exc_info[0].__name__ if record.exc_info and record.exc_info[0] else ""
        said = " ".join(record.getMessage().split())[:200]
        LOG.info("%s: %s %s", record.name, said, kind)


def set_heartbeat() -> None:
    """Set the heartbeat of the pages' sockets, after the framework has set its own at its start."""
    core.sio.eio.ping_interval = PING_EVERY_S
    core.sio.eio.ping_timeout = PING_WAIT_S
