"""The server under the lab: one process, one socket, its address given when it answers."""

from __future__ import annotations

import socket
import ssl
from dataclasses import dataclass
from typing import TYPE_CHECKING

import uvicorn

from .._support.certificates import load_certificate
from .._support.errors import ParameterError
from .addresses import for_others, lab_addresses
from .application import lab_application
from .guard import is_loopback
from .slow_requests import PatientToAPoint

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from .settings import Lab


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
