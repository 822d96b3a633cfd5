"""The lab as an ASGI application, and its server: sockets, addresses, and time limits for slow connections."""

from __future__ import annotations

import asyncio
import inspect
import io
import ipaddress
import logging
import socket
import ssl
from dataclasses import dataclass
from functools import partial, wraps
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, cast

import ifaddr
import segno
import uvicorn
from fastapi import FastAPI
from nicegui import app as pages_app
from nicegui import core, ui
from starlette.responses import FileResponse, RedirectResponse, Response

from .._support.environment import load_certificate
from .._support.errors import ParameterError
from .._support.messages import languages
from .elements import KEEPING, LANGUAGE, LOG, SCRIPT, STYLES, add_error_pages, log_to
from .guard import Access, Guard, is_loopback
from .pages import INNER, PAGES
from .replay_addresses import FIRST_SCRIPT
from .settings import PING_EVERY_S, PING_WAIT_S, RECONNECT_S
from .ski_editor import add_ski_uploads
from .transfer import add_transfer
from .words import COOKIE

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from starlette.types import ASGIApp
    from uvicorn.protocols.http.h11_impl import H11Protocol as _Protocol

    from .settings import Lab
else:
    from uvicorn.protocols.http.auto import AutoHTTPProtocol as _Protocol


def require_allowed(host: str, token: str | None) -> None:
    """Reject a host that other machines can reach without a token.

    Raises ParameterError: the host is not this machine's loopback address and there is no token, or the token is blank.
    """
    if token is not None and not token.strip():
        raise ParameterError("the token is blank; use one that is hard to guess, or remove --token").tag("blank_token")
    if token is None and not is_loopback(host):
        raise ParameterError(
            "on {host} other machines could open the lab; add --token with a word that is hard to guess, or remove "
            "--host"
        ).tag("no_token", host=host)


@dataclass(frozen=True, slots=True)
class Certificate:
    """PEM files of a certificate and its private key (default: in the same file)."""

    file: Path
    key: Path | None = None

    def __post_init__(self) -> None:
        try:
            load_certificate(ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER), self.file, self.key)
        except (OSError, ssl.SSLError, ValueError) as error:
            raise ParameterError(
                "{file}: no certificate with its private key can be read ({error}); give a PEM file with both, or "
                "the key's file with --certificate-key"
            ).tag("cannot_read", file=self.file, error=error) from error


def serve(
    lab: Lab,
    *,
    host: str,
    port: int,
    token: str | None,
    tell: Callable[[str], object],
    certificate: Certificate | None = None,
) -> None:
    """Serve the lab until it is interrupted.

    host, port: address to listen on; port 0 selects a free port.
    tell: function that is called with the address when the server is ready, then with further lines on an open host.
    certificate: certificate for an encrypted connection (default: not encrypted).
    Raises ParameterError: see `require_allowed`.
    Raises OSError: the port is in use.
    """
    require_allowed(host, token)
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    with socket.create_server((host, port), family=family) as listener:
        app = lab_application(lab, host=host, token=token)
        config = uvicorn.Config(
            app,
            log_level="critical",
            access_log=False,
            server_header=False,
            ws_max_size=4_000_000,
            ws_ping_interval=None,  # the sockets of the pages have a heartbeat with a longer limit
            http=TimeLimitedProtocol,
            lifespan="on",
            ssl_certfile=None if certificate is None else certificate.file,
            ssl_keyfile=None if certificate is None else certificate.key,
        )

        def begun() -> None:
            secure = certificate is not None
            addresses = lab_addresses(host, listener.getsockname()[1], secure=secure)
            tell(addresses[0])
            if not is_loopback(host):
                for line in lines_for_others(addresses, secure=secure):
                    tell(line)

        _AnnouncingServer(config, begun).run(sockets=[listener])


class _AnnouncingServer(uvicorn.Server):
    """Server that calls a function when it is ready."""

    def __init__(self, config: uvicorn.Config, begun: Callable[[], object]) -> None:
        super().__init__(config)
        self._begun = begun

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        await super().startup(sockets)
        if self.started:
            self._begun()


ALL_ADDRESSES: Final = ("0.0.0.0", "::")  # hosts that mean all addresses of this machine
IN_CLEAR: Final = (
    "The traffic is not encrypted, nor is the token: anybody in the same network can read both. Use "
    "a private network, such as this machine's hotspot, or give --certificate."
)
ENCRYPTED: Final = "The traffic is encrypted. A browser asks once whether it may trust a self-signed certificate."


def lab_addresses(host: str, port: int, *, secure: bool, own: Iterable[str] | None = None) -> list[str]:
    """Addresses at which others can open the lab, those of private networks first.

    host, port: host and port that the server listens on.
    own: addresses of this machine (default: those of its adapters).

    >>> lab_addresses("0.0.0.0", 8765, secure=False, own=["127.0.0.1", "93.184.216.34", "192.168.1.7"])
    ['http://192.168.1.7:8765/', 'http://93.184.216.34:8765/']
    >>> lab_addresses("127.0.0.1", 80, secure=True)
    ['https://127.0.0.1:80/']
    """
    hosts = [host]
    if host in ALL_ADDRESSES:
        addresses = _adapters(host) if own is None else own
        others = [address for address in addresses if not ipaddress.ip_address(address).is_loopback]
        hosts = sorted(others, key=lambda address: not ipaddress.ip_address(address).is_private) or ["127.0.0.1"]
    scheme = "https" if secure else "http"
    return [f"{scheme}://{f'[{address}]' if ':' in address else address}:{port}/" for address in hosts]


def _adapters(host: str) -> Iterator[str]:
    """Yield the host, or for all adapters the addresses of this machine without link-local ones."""
    for adapter in ifaddr.get_adapters():
        for ip in adapter.ips:
            if ip.is_IPv4:
                yield str(ip.ip)
            elif host == "::" and not ipaddress.ip_address(ip.ip[0]).is_link_local:
                yield ip.ip[0]


def lines_for_others(addresses: list[str], *, secure: bool) -> Iterator[str]:
    """Yield lines about the access from other machines: addresses, a QR code, and if the connection is encrypted."""
    yield from (f"also: {address}" for address in addresses[1:])
    drawn = io.StringIO()
    segno.make(addresses[0], error="m").terminal(drawn, compact=True, border=2)
    yield drawn.getvalue().rstrip()
    yield f"With a phone in the same network: point its camera at the code, or open {addresses[0]}"
    yield ENCRYPTED if secure else IN_CLEAR


HEAD_S: Final = 20.0  # maximum time for the head of a request (s), from the connection or the first byte
BODY_S: Final = 120.0  # maximum time for the next part of a body (s)
HEAD_BYTES: Final = 65_536


class TimeLimitedProtocol(_Protocol):
    """HTTP protocol that closes slow connections; its limits are attributes, so that tests can shorten them."""

    head_s = HEAD_S
    body_s = BODY_S

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self._closing: asyncio.TimerHandle | None = None
        self._head_bytes = 0

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Start the time limit of a request."""
        super().connection_made(cast("asyncio.Transport", transport))
        self._limit_time(self.head_s)

    def data_received(self, data: bytes) -> None:
        """Restart the time limit for a new request or a part of a body."""
        was_waiting = self._is_waiting()
        super().data_received(data)
        if self.transport.get_protocol() is not self:  # the connection became a web socket
            self._limit_time(None)
        elif not self._is_waiting():
            self._head_bytes = 0
            self._limit_time(self.body_s if self.cycle.more_body else None)
        else:
            self._head_bytes += len(data)
            if self._head_bytes > HEAD_BYTES:
                self.transport.close()
            elif not was_waiting or self._closing is None:
                self._limit_time(self.head_s)

    def on_response_complete(self) -> None:
        """Start the time limit of the next request on this connection."""
        super().on_response_complete()
        if not self.transport.is_closing():
            self._limit_time(self.head_s)

    def connection_lost(self, exc: Exception | None) -> None:
        """Stop the time limit."""
        self._limit_time(None)
        super().connection_lost(exc)

    def _is_waiting(self) -> bool:
        """True if no request is being received or answered."""
        # None until the first request, unlike its type
        return self.cycle is None or bool(self.cycle.response_complete)  # type: ignore[redundant-expr]

    def _limit_time(self, seconds: float | None) -> None:
        if self._closing is not None:
            self._closing.cancel()
        loop = asyncio.get_running_loop()
        self._closing = None if seconds is None else loop.call_later(seconds, self.transport.close)


LOG_FILE: Final = "lab.log"
KEPT_S: Final = 365 * 24 * 3600
_HERE: Final = Path(__file__).parent


def lab_application(lab: Lab, *, host: str, token: str | None) -> ASGIApp:
    """ASGI application with the pages of a lab behind the guard. NiceGUI has one set of pages per process.

    host: host that the server listens on; it determines the allowed Host headers.
    token: token that browsers must send (default on a loopback host: None).
    """
    log_to(lab.runs / LOG_FILE)
    outer = FastAPI(openapi_url=None, docs_url=None, redoc_url=None)
    for place in (STYLES, SCRIPT, FIRST_SCRIPT, KEEPING):
        outer.add_api_route(place, partial(_asset_response, place), include_in_schema=False, response_model=None)
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
    # the bar has no accessible name; the page shows the status
    pages_app.config.quasar_config["loadingBar"] = {"skipHijack": True}
    return Guard(outer, Access(host, token, lab.limits.upload_bytes))


def _set_language(code: str, back: str = "/") -> Response:
    """Set the cookie of a language, and redirect to the page where it was chosen."""
    place = back if back.startswith("/") and not back.startswith(("//", "/\\")) else "/"
    answer = RedirectResponse(place, 303)
    if code in languages():
        answer.set_cookie(COOKIE, code, max_age=KEPT_S, samesite="lax", path="/", httponly=True)
    return answer


def _asset_response(place: str) -> FileResponse:
    kind = "text/css" if place == STYLES else "text/javascript"
    return FileResponse(_HERE / place.removeprefix("/"), media_type=kind, headers={"cache-control": "no-cache"})


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
    """Wrap a socket handler: malformed messages are logged instead of raised; pages catch their own errors."""

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
