"""The lab as an ASGI application."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Final

from fastapi import FastAPI
from nicegui import app as pages_app
from nicegui import ui
from starlette.responses import FileResponse, RedirectResponse, Response

from .._support.language import languages
from .error_pages import add_error_pages, log_to
from .guard import Access, Guard
from .language import COOKIE
from .layout import KEEPING, LANGUAGE, SCRIPT, STYLES
from .pages import INNER, PAGES
from .patience import RECONNECT_S, use_heartbeat
from .ski_uploads import add_ski_uploads
from .socket_events import answer_quietly
from .transfer import add_transfer

if TYPE_CHECKING:
    from starlette.types import ASGIApp

    from .settings import Lab

LOG_FILE: Final = "lab.log"
KEPT_S: Final = 365 * 24 * 3600
_HERE: Final = Path(__file__).parent


def lab_application(lab: Lab, *, host: str, token: str | None) -> ASGIApp:
    """Put the pages of a lab together, behind their guard. The framework holds pages per process: one lab in each.

    Parameters
    ----------
    lab
        What the pages work with.
    host
        That the lab listens on: what a request may name as Host follows from it.
    token
        Asked for before anything else; None where only this machine can come in.
    """
    log_to(lab.runs / LOG_FILE)
    outer = FastAPI(openapi_url=None, docs_url=None, redoc_url=None)
    outer.add_api_route(STYLES, lambda: _own("lab.css", "text/css"), include_in_schema=False)
    outer.add_api_route(SCRIPT, lambda: _own("lab.js", "text/javascript"), include_in_schema=False)
    outer.add_api_route(KEEPING, lambda: _own("kept.js", "text/javascript"), include_in_schema=False)
    outer.add_api_route(LANGUAGE + "/{code}", _chosen, include_in_schema=False, response_model=None)
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
    pages_app.on_startup(use_heartbeat)
    answer_quietly()
    pages_app.config.socket_io_js_transports = ["websocket"]
    pages_app.config.quasar_config["loadingBar"] = {
        "skipHijack": True
    }  # a bar without a name, where the page says more
    return Guard(outer, Access(host, token, lab.limits.upload_bytes))


def _chosen(code: str, back: str = "/") -> Response:
    """Keep the language that was chosen, and go back to the page that it was chosen on."""
    place = back if back.startswith("/") and not back.startswith(("//", "/\\")) else "/"
    answer = RedirectResponse(place, 303)
    if code in languages():
        answer.set_cookie(COOKIE, code, max_age=KEPT_S, samesite="lax", path="/", httponly=True)
    return answer


def _own(name: str, kind: str) -> FileResponse:
    return FileResponse(_HERE / name, media_type=kind, headers={"cache-control": "no-cache"})
