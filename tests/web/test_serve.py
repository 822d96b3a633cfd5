"""The lab as a command, on this machine and on a server."""

import csv
import http.client
import io
import os
import re
import shlex
import shutil
import ssl
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import urlsplit

import pytest

from skisnow.campaign.store import Journals, Store, campaign_files, replay_journal
from skisnow.campaign.store.replayed import description_text
from skisnow.cli import main
from tests.present import present

from ..campaign.store.postgresql_server import Server, run, started, why_there_is_none
from .browser_types import Page
from .conftest import Served, killed_and_started_again
from .test_day import PLATE, SERIES, TOOL, VALUES, enter_series


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


PAGE = Path(__file__).parents[2] / "docs" / "how-to" / "store.md"
PASSWORD = "a:word with \\ in it"


def line_of_page(begin: str) -> str:
    """The one line of code that begins with these words."""
    (line,) = re.findall(rf"(?m)^    ({re.escape(begin)}.*)$", PAGE.read_text(encoding="utf-8"))
    return str(line)


def set_up(server: Server) -> None:
    """From the page: the commands of the user postgres; who may come in from the network, encrypted."""
    reached = {"PGHOST": str(server.folder), "PGPORT": str(server.port), "PGUSER": "postgres"}
    for begin in ("createuser", "createdb"):
        words = shlex.split(line_of_page(f"sudo -u postgres {begin}"))[4:]
        subprocess.run(
            [server.programs / begin, *words],
            input=f"{PASSWORD}\n{PASSWORD}\n",
            env={**os.environ, **reached},
            start_new_session=True,  # without a terminal the password is read from here
            text=True,
            check=True,
            timeout=300,
        )
    hosts = line_of_page("hostssl campaigns").replace("192.0.2.0/24", "127.0.0.1/32")
    (server.folder / "data" / "pg_hba.conf").write_text(f"local all all trust\n{hosts}\n", encoding="utf-8")


@pytest.fixture
def group_server() -> Iterator[Server]:
    """A separate server that speaks TLS, as Debian's does."""
    if (why := why_there_is_none()) is not None:
        pytest.skip(why)
    if shutil.which("openssl") is None:
        pytest.skip("openssl, which makes the server's certificate, is not installed")
    with started() as server:
        data = server.folder / "data"
        certificate = ["req", "-new", "-x509", "-nodes", "-days", "36500", "-subj", "/CN=localhost"]
        run(data, "openssl", *certificate, "-out", data / "server.crt", "-keyout", data / "server.key")
        run(data, "chmod", "600", data / "server.key")
        set_up(server)
        server.execute("ALTER SYSTEM SET ssl = on", "SELECT pg_reload_conf()")
        yield server


def password_file(folder: Path, server: Server) -> Path:
    """A ~/.pgpass with the line of the page."""
    colon = PASSWORD.replace("\\", "\\\\").replace(":", "\\:")
    line = line_of_page("snow.example.org:").replace("PASSWORD", colon)
    place = folder / "pgpass"
    place.write_text(line.replace("snow.example.org:5432", f"127.0.0.1:{server.port}") + "\n", encoding="utf-8")
    place.chmod(0o600)
    return place


@pytest.mark.slow
def test_what_was_entered_in_a_lab_on_a_server_outlives_the_lab(
    page: Page, group_server: Server, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PGPASSFILE", str(password_file(tmp_path, group_server)))
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))  # runs stay on this machine
    address = f"postgresql://snow@127.0.0.1:{group_server.port}/campaigns"
    with Store.open(address) as store:
        id_ = Journals(store).begin(description_text(VALUES, [TOOL], [PLATE]))
    lab = Served(tmp_path / "none.sqlite3", as_command=True, further=("--store", address)).start()
    try:
        page.goto(f"{lab.address}enter/{id_}")
        page.get_by_role("heading", name="New series").wait_for()
        enter_series(page, "1")
        killed_and_started_again(page, lab)
        page.get_by_role("heading", name="Series 1").wait_for()
    finally:
        lab.kill()
    assert not (tmp_path / "none.sqlite3").exists()
    with Store.open(address) as other:
        table = campaign_files(replay_journal(Journals(other).entries(id_)))["penetration.csv"]
    depths = [float(row["depth_mm"]) for row in csv.DictReader(io.StringIO(table))]
    assert depths == [float(depth.replace(",", ".")) for depth in SERIES["1"][1]]


@pytest.mark.slow
def test_encryption_and_password_needed(group_server: Server, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from skisnow._support.errors import StoreError

    monkeypatch.setenv("PGPASSFILE", str(password_file(tmp_path, group_server)))
    address = f"postgresql://snow@127.0.0.1:{group_server.port}/campaigns"
    Store.open(f"{address}?sslmode=require").close()
    with pytest.raises(StoreError):
        Store.open(f"{address}?sslmode=disable")
    with pytest.raises(StoreError):
        Store.open(f"{address}?sslmode=verify-full&sslrootcert={tmp_path / 'pgpass'}")
    monkeypatch.setenv("PGPASSFILE", str(tmp_path / "none"))
    monkeypatch.setenv("PGPASSWORD", "another")
    with pytest.raises(StoreError):
        Store.open(address)
