"""Connections that send no whole request are closed after a while; a browser needs milliseconds."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any, Final, cast

if TYPE_CHECKING:
    from uvicorn.protocols.http.h11_impl import H11Protocol as _Protocol
else:
    from uvicorn.protocols.http.auto import AutoHTTPProtocol as _Protocol

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
