"""The lab on a group's store: the server is set up by the lines of the documentation, and entries stay."""

from __future__ import annotations

import csv
import io
import os
import re
import shlex
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from skisnow.campaign.store import Journals, Store, campaign_files, replay_journal
from skisnow.campaign.store.replayed import Description, description_text

from ..campaign.store.postgresql_server import Server, run, started, why_there_is_none
from .conftest import Served, killed_and_started_again
from .test_day import PLATE, SERIES, TOOL, VALUES, enter_series

if TYPE_CHECKING:
    from playwright.sync_api import Page

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
            timeout=60,
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
        id_ = Journals(store).begin(description_text(Description(VALUES, [TOOL], [PLATE])))
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
def test_nobody_comes_in_unencrypted_or_with_another_password(
    group_server: Server, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
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
