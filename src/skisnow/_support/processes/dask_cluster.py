"""Workers on other computers, by a Dask scheduler that runs."""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import suppress
from typing import Any, Final

from ..environment import import_extra
from ..errors import ParameterError, SkisnowError
from ..messages import Message
from .crews import LOST, LOST_WORKERS, Crew, ExecutorCrew, PointFunction

_NOT_LOADED: Final = ("Can't get attribute", "deserializ")
"""Texts of Python and Dask where a function is not there."""
WAIT_S: Final = 30.0
"""Time-out (s) for the answer of a scheduler."""
AWAY_S: Final = 10.0
"""Time (s) that a scheduler may be unreachable during the work."""
CHUNK_S: Final = 1.0
"""Work (s) that is handed over at once (from one piece to the next a worker takes some 10 ms, and
some 50 where its cores are wanted by others)."""
COUNTED_EVERY_S: Final = 1.0
"""Interval (s) between counts of the workers, which come and go."""


def require_scheduler(address: str) -> None:
    """Reject an address without ``://``, and a missing Dask, before the work begins; nothing is connected."""
    if "://" not in address:
        raise ParameterError(
            "The scheduler is {scheduler!r}. It must be an address such as tcp://host:8786, threads or processes."
        ).tag("unknown_executor", scheduler=address)
    _distributed()


def is_plain(address: str) -> bool:
    """True if data travel unencrypted, and any client that reaches the scheduler can run programs."""
    return not address.startswith(("tls://", "wss://"))


def crew_of_scheduler(address: str, function: PointFunction) -> Crew:
    """Workers of a scheduler; at the end the connection is closed. Certificates are those of Dask's configuration."""
    require_scheduler(address)
    try:
        client = _distributed().Client(address, timeout=WAIT_S, name="skisnow")
    except (OSError, ValueError, TypeError) as error:
        raise SkisnowError(_no_answer_message(address, error)).tag("no_scheduler") from error
    return DaskCrew(function, client, client.close)


def _no_answer_message(address: str, error: Exception) -> Message:
    if not is_plain(address):
        return Message(
            "No connection to the scheduler at {address} ({error}). It uses certificates. Check that it runs, and that "
            "Dask's configuration (distributed.comm.tls) names the same authority, and a certificate with its key.",
            address=address,
            error=error,
        )
    return Message(
        "No scheduler answers at {address} ({error}). Start one with `dask scheduler`, and workers with "
        "`dask worker`; both print their address.",
        address=address,
        error=error,
    )


class DaskCrew(ExecutorCrew):
    """Workers of a Dask client. The scheduler repeats the chunk of a lost worker on another one."""

    chunk_s = CHUNK_S

    def __init__(self, function: PointFunction, client: Any, close: Callable[[], None] | None = None) -> None:
        super().__init__(function, client.get_executor(pure=False), self._threads, close)
        self._client = client
        self._counted, self._at, self._last_seen = 1, -COUNTED_EVERY_S, time.monotonic()

    def _threads(self) -> int:
        if time.monotonic() - self._at > COUNTED_EVERY_S:
            with suppress(Exception):  # it does not answer: `require_alive` says so after a while
                self._counted = sum(self._client.nthreads(callback_timeout=COUNTED_EVERY_S).values())
            self._at = time.monotonic()
        return self._counted

    def require_alive(self) -> None:
        """Raise an error if the scheduler is gone for long; a short interruption is tolerated."""
        if self._client.status == "running":
            self._last_seen = time.monotonic()
        elif time.monotonic() - self._last_seen > AWAY_S or self._client.status == "closed":
            raise SkisnowError(LOST_WORKERS).tag(LOST)

    def explain(self, error: Exception) -> Message | None:
        """Explanation of an error of Dask."""
        if isinstance(error, ImportError) or any(word in str(error) for word in _NOT_LOADED):
            return Message(
                "A worker cannot load the computation ({error}). Install the same skisnow there.", error=error
            )
        if type(error).__module__.startswith("distributed"):
            return Message("Dask gave up: {kind}: {error}.", kind=type(error).__name__, error=error)
        return super().explain(error)


def _distributed() -> Any:
    return import_extra("distributed", extra="dask", what=Message("A scheduler"))
