"""The lab as a command."""

import http.client
import shutil
import ssl
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import urlsplit

import pytest

from skisnow.cli import main
from tests.present import present

from .conftest import Served


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    """One server for all questions here, none of which changes anything."""
    lab = Served(tmp_path_factory.mktemp("lab") / "store.sqlite3", as_command=True).start()
    yield lab
    lab.kill()


def asked(
    served: Served, path: str, *, method: str = "GET", body: str | None = None, **headers: str
) -> tuple[int, dict[str, str], str]:
    parts = urlsplit(served.address)
    connection = http.client.HTTPConnection(present(parts.hostname), parts.port, timeout=300)
    connection.request(method, path, body=body, headers=headers)
    answer = connection.getresponse()
    found = answer.status, {name.lower(): value for name, value in answer.getheaders()}, answer.read().decode()
    connection.close()
    return found


def test_the_first_line_is_the_address_of_this_machine_alone(served: Served) -> None:
    parts = urlsplit(served.address)
    assert (parts.scheme, parts.hostname) == ("http", "127.0.0.1")
    status, headers, text = asked(served, "/")
    assert status == 200 and "skisnow" in text
    assert "default-src 'none'" in headers["content-security-policy"]
    assert asked(served, "/import", method="POST", Origin="http://evil.example")[0] == 403
    assert asked(served, "/", Host="evil.example")[0] == 421


@pytest.fixture
def unserved(monkeypatch: pytest.MonkeyPatch) -> None:
    """Serving fails the test."""
    monkeypatch.setattr("skisnow.web.server.serve", lambda *_, **__: pytest.fail("it is served"))


@pytest.mark.usefixtures("unserved")
def test_another_host_needs_a_token(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["serve", "--host", "0.0.0.0", "--store", str(tmp_path / "s.sqlite3")]) == 1
    out, err = capsys.readouterr()
    assert out == "" and "add --token" in err and "Traceback" not in err


def test_a_port_that_is_taken_is_reported(served: Served, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    port = str(urlsplit(served.address).port)
    assert main(["serve", "--port", port, "--store", str(tmp_path / "other.sqlite3")]) == 1
    err = capsys.readouterr().err
    assert "Traceback" not in err and "in use" in err


@pytest.mark.usefixtures("unserved")
def test_a_certificate_that_is_none_is_reported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    broken = tmp_path / "lab.pem"
    broken.write_text("no certificate")
    assert main(["serve", "--certificate", str(broken), "--store", str(tmp_path / "s.sqlite3")]) == 1
    err = capsys.readouterr().err
    assert "lab.pem" in err and "Traceback" not in err
    assert main(["serve", "--certificate-key", str(broken), "--store", str(tmp_path / "s.sqlite3")]) == 1
    assert "goes with --certificate" in capsys.readouterr().err


@pytest.mark.slow
def test_a_lab_with_a_certificate_is_encrypted(tmp_path: Path) -> None:
    pem, key = tmp_path / "lab.pem", tmp_path / "key.pem"
    openssl = shutil.which("openssl")
    if openssl is None:
        pytest.skip("there is no openssl on this machine to make a certificate with")
    made = [openssl, "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-keyout", str(key), "-out", str(pem)]
    subprocess.run([*made, "-days", "1", "-subj", "/CN=localhost"], check=True, capture_output=True)
    words = ["--port", "0", "--store", str(tmp_path / "s.sqlite3"), "--certificate", str(pem)]
    lab = subprocess.Popen(
        [sys.executable, "-m", "skisnow", "serve", *words, "--certificate-key", str(key)],
        stdout=subprocess.PIPE,
        text=True,
    )
    try:
        parts = urlsplit(present(lab.stdout).readline().strip())
        assert parts.scheme == "https" and parts.hostname is not None
        trusted = ssl.create_default_context(cafile=str(pem))
        trusted.check_hostname = False  # the certificate is that of a name, the address is asked
        connection = http.client.HTTPSConnection(parts.hostname, parts.port, timeout=300, context=trusted)
        connection.request("GET", "/")
        assert connection.getresponse().status == 200
        connection.close()
    finally:
        lab.kill()
        lab.communicate()


def test_a_store_that_broke_is_reported_in_a_sentence(tmp_path: Path) -> None:
    lab = Served(tmp_path / "store.sqlite3").start()
    try:
        for name in ("store.sqlite3-wal", "store.sqlite3-shm"):
            (tmp_path / name).unlink(missing_ok=True)
        lab.store.write_bytes(bytes(8192))
        status, _, text = asked(lab, "/export/kept/abcd.zip")
    finally:
        lab.kill()
    assert status == 404
    assert "Traceback" not in text
