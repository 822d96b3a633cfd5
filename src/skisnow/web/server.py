"""The lab as an ASGI application, and its server: sockets and addresses."""

from __future__ import annotations

import io
import ipaddress
import socket
import ssl
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Final

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
from .._support.processes.starting import load_for_workers
from .elements import KEEPING, LANGUAGE, SCRIPT, STYLES, add_error_pages, log_to
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

    from .settings import Lab


def require_allowed(host: str, token: str | None) -> None:
    """Raise a ParameterError for a host that other machines can reach without a token, and for a blank token."""
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
            load_for_workers()  # the first upload finds them ready

        _AnnouncingServer(config, begun).run(sockets=[listener])


class _AnnouncingServer(uvicorn.Server):
    """Server that calls a function when it is ready."""

    def __init__(self, config: uvicorn.Config, begun: Callable[[], object]) -> None:
        super().__init__(config)
        self._begun = begun

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Start the server, then call the function `begun` if it listens."""
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
    """Response with a style sheet or script, which the browser must check again."""
    kind = "text/css" if place == STYLES else "text/javascript"
    return FileResponse(_HERE / place.removeprefix("/"), media_type=kind, headers={"cache-control": "no-cache"})


def set_heartbeat() -> None:
    """Set the heartbeat of the pages' sockets, after the framework has set its own at its start."""
    core.sio.eio.ping_interval = PING_EVERY_S
    core.sio.eio.ping_timeout = PING_WAIT_S
