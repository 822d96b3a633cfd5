"""Certificates are loaded without asking on the terminal."""

import shutil
import ssl
import subprocess
from pathlib import Path

import pytest

from skisnow._support.environment import load_certificate

OPENSSL = shutil.which("openssl")
pytestmark = pytest.mark.skipif(OPENSSL is None, reason="openssl is not there, which makes the certificates")


def made(folder: Path, *key: str) -> tuple[Path, Path]:
    """A certificate and its private key."""
    cert, own = folder / "cert.pem", folder / "key.pem"
    words = ["req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-subj", "/CN=skisnow", *key]
    subprocess.run([str(OPENSSL), *words, "-keyout", own, "-out", cert], check=True, capture_output=True)
    return cert, own


def test_a_certificate_and_its_key_in_two_files_and_in_one(tmp_path: Path) -> None:
    cert, key = made(tmp_path, "-nodes")
    both = tmp_path / "both.pem"
    both.write_bytes(cert.read_bytes() + key.read_bytes())
    for files in ((cert, key), (both,)):
        load_certificate(ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER), *files)
    with pytest.raises(ssl.SSLError):
        load_certificate(ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER), cert)


def test_a_key_with_a_password_is_refused(tmp_path: Path) -> None:
    cert, key = made(tmp_path, "-passout", "pass:secret")
    with pytest.raises(ValueError, match="password"):
        load_certificate(ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER), cert, key)
