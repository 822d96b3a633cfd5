"""The server of the lab: its socket, its addresses, and time limits for slow connections."""

from __future__ import annotations

import asyncio
import io
import ipaddress
import socket
import ssl
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, cast

import ifaddr
import segno
import uvicorn

from .._support.certificates import load_certificate
from .._support.errors import ParameterError
from .application import lab_application
from .guard import is_loopback

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator
    from pathlib import Path

    from uvicorn.protocols.http.h11_impl import H11Protocol as _Protocol

    from .settings import Lab
else:
    from uvicorn.protocols.http.auto import AutoHTTPProtocol as _Protocol


def require_allowed(host: str, token: str | None) -> None:
    """Refuse to listen where others can come in without a token.

    Raises
    ------
    ParameterError
        The host is not this machine's loopback address and there is no token, or the token is blank.
    """
    if token is not None and not token.strip():
        raise ParameterError("the token is blank; give one that is hard to guess, or leave --token out")
    if token is None and not is_loopback(host):
        raise ParameterError(
            f"on {host} other machines could open the lab; add --token with a word that is hard to guess, "
            "or leave --host out"
        )


@dataclass(frozen=True, slots=True)
class Certificate:
    """PEM files of a certificate and of its private key; ``key`` None: it stands in the same file."""

    file: Path
    key: Path | None = None

    def __post_init__(self) -> None:
        try:
            load_certificate(ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER), self.file, self.key)
        except (OSError, ssl.SSLError, ValueError) as error:
            raise ParameterError(
                f"{self.file}: no certificate with its private key can be read ({error}); give a PEM file with both, "
                "or the key's file with --certificate-key"
            ) from error


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

    Parameters
    ----------
    lab
        What the pages work with.
    host, port
        Where to listen; port 0 takes a free one.
    token
        See `require_allowed`.
    tell
        Called with the address as soon as requests are answered, then with further lines where others may come.
    certificate
        With which what goes between the machines is encrypted; None: it is not.

    Raises
    ------
    ParameterError
        See `require_allowed`.
    OSError
        The port is taken.
    """
    require_allowed(host, token)
    with _listening(host, port) as listener:
        app = lab_application(lab, host=host, token=token)
        config = uvicorn.Config(
            app,
            log_level="critical",
            access_log=False,
            server_header=False,
            ws_max_size=4_000_000,
            ws_ping_interval=None,  # the pages' sockets have a heartbeat of their own, which is more patient
            http=PatientToAPoint,
            lifespan="on",
            ssl_certfile=None if certificate is None else certificate.file,
            ssl_keyfile=None if certificate is None else certificate.key,
        )

        def begun() -> None:
            secure = certificate is not None
            addresses = lab_addresses(host, listener.getsockname()[1], secure=secure)
            tell(addresses[0])
            if not is_loopback(host):
                for line in for_others(addresses, secure=secure):
                    tell(line)

        _Announced(config, begun).run(sockets=[listener])


def _listening(host: str, port: int) -> socket.socket:
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    return socket.create_server((host, port), family=family)


class _Announced(uvicorn.Server):
    """A server that says when it has begun to answer."""

    def __init__(self, config: uvicorn.Config, begun: Callable[[], object]) -> None:
        super().__init__(config)
        self._begun = begun

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        await super().startup(sockets)
        if self.started:
            self._begun()


EVERY: Final = ("0.0.0.0", "::")
"""Hosts that stand for all addresses of this machine."""
IN_CLEAR: Final = (
    "What goes between the machines is not encrypted, the token neither: anybody in the same network can read it. Use "
    "a network of your own, such as this machine's hotspot, or give --certificate."
)
ENCRYPTED: Final = (
    "What goes between the machines is encrypted. A browser asks once whether it may trust a certificate of your own."
)


def lab_addresses(host: str, port: int, *, secure: bool, own: Iterable[str] | None = None) -> list[str]:
    """The addresses that others can open the lab at, those of home and office networks first.

    Parameters
    ----------
    host, port
        That it listens on.
    secure
        Whether it has a certificate.
    own
        Addresses of this machine; those of its adapters where they are not given.

    Examples
    --------
    >>> lab_addresses("0.0.0.0", 8765, secure=False, own=["127.0.0.1", "93.184.216.34", "192.168.1.7"])
    ['http://192.168.1.7:8765/', 'http://93.184.216.34:8765/']
    >>> lab_addresses("127.0.0.1", 80, secure=True)
    ['https://127.0.0.1:80/']
    """
    hosts = [host]
    if host in EVERY:
        known = _adapters(host) if own is None else own
        others = [each for each in known if not ipaddress.ip_address(each).is_loopback]
        hosts = sorted(others, key=lambda each: not ipaddress.ip_address(each).is_private) or ["127.0.0.1"]
    scheme = "https" if secure else "http"
    return [f"{scheme}://{f'[{each}]' if ':' in each else each}:{port}/" for each in hosts]


def _adapters(host: str) -> Iterator[str]:
    """Addresses of this machine, those that need no name of an adapter with them."""
    for adapter in ifaddr.get_adapters():
        for each in adapter.ips:
            if each.is_IPv4:
                yield str(each.ip)
            elif host == "::" and not ipaddress.ip_address(each.ip[0]).is_link_local:
                yield each.ip[0]


def for_others(addresses: list[str], *, secure: bool) -> Iterator[str]:
    """Lines for whoever carries a phone: further addresses, a code for its camera, what is encrypted."""
    yield from (f"also: {address}" for address in addresses[1:])
    drawn = io.StringIO()
    segno.make(addresses[0], error="m").terminal(drawn, compact=True, border=2)
    yield drawn.getvalue().rstrip()
    yield f"With a phone in the same network: point its camera at the code, or open {addresses[0]}"
    yield ENCRYPTED if secure else IN_CLEAR


HEAD_S: Final = 20.0
"""For the head of a request, from the connection or from its first byte on (modelling assumption)."""
BODY_S: Final = 120.0
"""For the next piece of a body (modelling assumption): a phone that sleeps while it sends."""
HEAD_BYTES: Final = 65_536


class PatientToAPoint(_Protocol):
    """The server's protocol with an end to its patience; the times are attributes, so that a test can wait for them."""

    head_s = HEAD_S
    body_s = BODY_S

    def __init__(self, *given: Any, **named: Any) -> None:
        super().__init__(*given, **named)
        self._closing: asyncio.TimerHandle | None = None
        self._head_bytes = 0

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Begin to wait for a request."""
        super().connection_made(cast("asyncio.Transport", transport))
        self._wait(self.head_s)

    def data_received(self, data: bytes) -> None:
        """Wait on, from the beginning where a request began."""
        was_waiting = self._is_waiting()
        super().data_received(data)
        if self.transport.get_protocol() is not self:  # a web socket by now
            self._wait(None)
        elif not self._is_waiting():
            self._head_bytes = 0
            self._wait(self.body_s if self._is_in_body() else None)
        else:
            self._head_bytes += len(data)
            if self._head_bytes > HEAD_BYTES:
                self.transport.close()
            elif not was_waiting or self._closing is None:
                self._wait(self.head_s)

    def on_response_complete(self) -> None:
        """Wait for the next request on this connection; half of it may be here already."""
        super().on_response_complete()
        if not self.transport.is_closing():
            self._wait(self.head_s)

    def connection_lost(self, exc: Exception | None) -> None:
        """Wait for nothing any more."""
        self._wait(None)
        super().connection_lost(exc)

    def _is_waiting(self) -> bool:
        """Whether no request is being answered or taken in."""
        # typed as never None, which it is until the first request
        return self.cycle is None or bool(self.cycle.response_complete)  # type: ignore[redundant-expr]

    def _is_in_body(self) -> bool:
        return self.cycle is not None and bool(self.cycle.more_body)  # type: ignore[redundant-expr]

    def _wait(self, seconds: float | None) -> None:
        if self._closing is not None:
            self._closing.cancel()
        loop = asyncio.get_running_loop()
        self._closing = None if seconds is None else loop.call_later(seconds, self.transport.close)
