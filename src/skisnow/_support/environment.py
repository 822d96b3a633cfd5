"""Environment of the process: optional packages, certificates, and the collector of reference cycles."""

from __future__ import annotations

import gc
import ssl
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from typing import Any

from .errors import ParameterError
from .messages import Message, joined


def import_extra(module: str, *, extra: str, what: Message, instead: Message | None = None) -> Any:
    """Import a module of an optional package; a ParameterError that names skisnow's extra to install if it is missing.

    what: work that needs the package, a noun phrase for the message.
    instead: sentence with another way, appended to the message.
    """
    try:
        return import_module(module)
    except ImportError as error:
        problem = Message(
            "{what} needs {module}, which cannot be loaded ({error}). Install it: pip install 'skisnow[{extra}]'.",
            what=what,
            module=module,
            error=error,
            extra=extra,
        )
        raise ParameterError(joined([problem, instead]) if instead else problem).tag("package_missing") from error


@contextmanager
def paused_collector() -> Iterator[None]:
    """Pause Python's cyclic garbage collector in the block: it is slow with millions of cells of a large campaign."""
    running = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if running:
            gc.enable()


def load_certificate(context: ssl.SSLContext, file: str | Path, key: str | Path | None = None) -> None:
    """Load a certificate and its private key, which may be in the same file, into the context of a connection.

    Raises OSError, ssl.SSLError or ValueError: the files cannot be read, or the key has a password: OpenSSL would ask
        for it on the terminal.
    """
    context.load_cert_chain(file, key, password=_reject_password)


def _reject_password() -> str:
    """Password callback of OpenSSL: raise ValueError instead of asking on the terminal."""
    raise ValueError("the private key has a password")
