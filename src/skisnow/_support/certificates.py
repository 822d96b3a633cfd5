"""Certificates in PEM files, read without a word on the terminal."""

from __future__ import annotations

import ssl
from pathlib import Path


def load_certificate(context: ssl.SSLContext, file: str | Path, key: str | Path | None = None) -> None:
    """Load a certificate and its private key, which may be in the same file.

    Raises
    ------
    OSError, ssl.SSLError, ValueError
        They cannot be read, or the key has a password: OpenSSL would ask for it on the terminal.
    """
    context.load_cert_chain(file, key, password=_no_password)


def _no_password() -> str:
    raise ValueError("the private key has a password")
