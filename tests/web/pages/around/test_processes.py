"""Another process for sent files, and the server."""

from __future__ import annotations

import ssl
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, cast

import pytest

from skisnow._support.errors import ParameterError
from skisnow.web import server, subprocesses
from skisnow.web.server import (
    ENCRYPTED,
    IN_CLEAR,
    Certificate,
    TimeLimitedProtocol,
    lab_addresses,
    lines_for_others,
    require_allowed,
    serve,
)
from skisnow.web.subprocesses import Bounds
from tests.coded import raises

from .shared import raising

if TYPE_CHECKING:
    from ..desk import Desk


def test_an_unforeseen_error_of_another_process_has_a_trace(monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[Any] = []
    monkeypatch.setattr(subprocesses, "end_with_server", lambda: None)
    monkeypatch.setattr(subprocesses, "_set_limits", lambda _: None)
    for letters in (1, 9000):
        work = raising(ValueError("x" * letters))
        subprocesses._run_confined(cast(Any, SimpleNamespace(send=told.append)), Bounds(2.5, 3_000_000), work, ())
    assert [(type(error), error.code) for error, _ in told] == [(ParameterError, "cannot_read")] * 2
    assert told[0][1].startswith("Traceback") and told[0][1].endswith("ValueError: x\n")
    assert len(told[1][1]) == 4000 and told[1][1].endswith("xx\n")


def test_a_process_ends_with_its_server(monkeypatch: pytest.MonkeyPatch) -> None:
    done: list[Any] = []

    def thread(*, target: Callable[[], None], daemon: bool) -> Any:
        done.append(daemon)
        return SimpleNamespace(start=target)

    parent = SimpleNamespace(sentinel=7)
    monkeypatch.setattr(subprocesses, "threading", SimpleNamespace(Thread=thread))
    monkeypatch.setattr(subprocesses, "multiprocessing", SimpleNamespace(parent_process=lambda: parent))
    monkeypatch.setattr(subprocesses, "os", SimpleNamespace(_exit=lambda code: done.append(f"ends with {code}")))
    signals = SimpleNamespace(signal=lambda *what: done.append(what), SIGINT="ctrl-c", SIG_IGN="left out")
    monkeypatch.setattr(subprocesses, "signal", signals)
    monkeypatch.setattr(subprocesses, "wait", done.append)
    subprocesses.end_with_server()
    assert done == [("ctrl-c", "left out"), True, [7], "ends with 1"]


@pytest.mark.parametrize(
    ("host", "token", "code"),
    [
        ("127.0.0.1", None, ""),
        ("localhost", None, ""),
        ("0.0.0.0", "snow", ""),
        ("127.0.0.1", "snow", ""),
        ("0.0.0.0", None, "no_token"),
        ("127.0.0.1", " ", "blank_token"),
    ],
)
def test_where_others_can_come_in_there_is_a_token(host: str, token: str | None, code: str) -> None:
    if not code:
        require_allowed(host, token)
        return
    with raises(ParameterError, code):
        require_allowed(host, token)


class Announced:
    """A server that answers at once, and ends."""

    made: list[Any] = []  # noqa: RUF012

    def __init__(self, config: Any, begun: Callable[[], object]) -> None:
        self.config, self.begun, self.sockets = config, begun, list[Any]()
        self.made.append(self)

    def run(self, sockets: list[Any]) -> None:
        self.family, self.place = sockets[0].family, sockets[0].getsockname()
        self.begun()


@pytest.fixture
def announced(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """Servers that were begun; the application is what it was asked with."""
    monkeypatch.setattr(Announced, "made", [])
    monkeypatch.setattr(server, "_AnnouncingServer", Announced)
    monkeypatch.setattr(server, "lab_application", lambda *what, **named: (*what, *named.values()))
    return Announced.made


def test_the_lab_is_served_to_this_machine(desk: Desk, announced: list[Any]) -> None:
    told: list[str] = []
    serve(desk.lab, host="127.0.0.1", port=0, token=None, tell=told.append)
    (found,) = announced
    assert told == [f"http://127.0.0.1:{found.place[1]}/"]
    assert found.place[1] > 0
    config = found.config
    assert config.app == (desk.lab, "127.0.0.1", None)
    assert (config.log_level, config.access_log, config.server_header) == ("critical", False, False)
    assert (config.ws_max_size, config.ws_ping_interval, config.lifespan) == (4_000_000, None, "on")
    assert config.http is TimeLimitedProtocol
    assert (config.ssl_certfile, config.ssl_keyfile) == (None, None)
    with pytest.raises(ParameterError):
        serve(desk.lab, host="0.0.0.0", port=0, token=None, tell=told.append)
    assert len(announced) == 1


def test_whoever_lets_others_in_is_told_how_they_come(
    desk: Desk, announced: list[Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[str] = []
    secure = SimpleNamespace(file=Path("a.pem"), key=Path("b.pem"))
    monkeypatch.setattr(server, "_adapters", lambda _: ["192.168.1.7", "10.0.0.2"])
    for certificate in (None, secure):
        serve(desk.lab, host="0.0.0.0", port=0, token="snow", tell=told.append, certificate=cast(Any, certificate))
    for found, scheme, last in zip(announced, ("http", "https"), (IN_CLEAR, ENCRYPTED), strict=True):
        port = found.place[1]
        assert told[:2] == [f"{scheme}://192.168.1.7:{port}/", f"also: {scheme}://10.0.0.2:{port}/"]
        assert f"{scheme}://192.168.1.7:{port}/" in told[3]
        assert told[4] == last
        del told[:5]
    assert told == []
    assert (announced[1].config.ssl_certfile, announced[1].config.ssl_keyfile) == (secure.file, secure.key)


def test_a_certificate_is_read_before_anything_is_served(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    given: list[Any] = []
    monkeypatch.setattr(server, "load_certificate", lambda context, *what: given.append((context.protocol, *what)))
    Certificate(tmp_path / "a.pem", tmp_path / "b.pem")
    Certificate(tmp_path / "a.pem")
    kind = ssl.PROTOCOL_TLS_SERVER
    assert given == [(kind, tmp_path / "a.pem", tmp_path / "b.pem"), (kind, tmp_path / "a.pem", None)]
    for error in (OSError("o"), ValueError("v"), ssl.SSLError("s")):
        monkeypatch.setattr(server, "load_certificate", raising(error))
        with raises(ParameterError, "cannot_read"):
            Certificate(tmp_path / "a.pem")


@pytest.mark.parametrize(
    ("host", "own", "expected"),
    [
        ("0.0.0.0", ["127.0.0.1", "93.184.216.34", "10.0.0.2"], ["http://10.0.0.2:80/", "http://93.184.216.34:80/"]),
        ("0.0.0.0", ["127.0.0.1"], ["http://127.0.0.1:80/"]),
        ("::", ["::1", "fd00::1", "10.0.0.2"], ["http://[fd00::1]:80/", "http://10.0.0.2:80/"]),
        ("lab.example", ["10.0.0.2"], ["http://lab.example:80/"]),
        ("::1", None, ["http://[::1]:80/"]),
    ],
)
def test_addresses_that_others_can_open(host: str, own: list[str] | None, expected: list[str]) -> None:
    assert lab_addresses(host, 80, secure=False, own=own) == expected
    secure = [each.replace("http:", "https:") for each in expected]
    assert lab_addresses(host, 80, secure=True, own=own) == secure


@pytest.mark.parametrize(
    ("host", "expected"), [("0.0.0.0", ["10.0.0.2", "192.168.1.7"]), ("::", ["10.0.0.2", "fd00::1", "192.168.1.7"])]
)
def test_addresses_of_this_machine_need_no_name_of_an_adapter(
    monkeypatch: pytest.MonkeyPatch, host: str, expected: list[str]
) -> None:
    def of(*ips: tuple[Any, bool]) -> Any:
        return SimpleNamespace(ips=[SimpleNamespace(ip=ip, is_IPv4=old) for ip, old in ips])

    adapters = [
        of(("10.0.0.2", True), (("fe80::1", 0, 2), False)),
        of((("fd00::1", 0, 0), False), ("192.168.1.7", True)),
    ]
    monkeypatch.setattr(server, "ifaddr", SimpleNamespace(get_adapters=lambda: adapters))
    assert list(server._adapters(host)) == expected
    found = {each.split("//")[1] for each in lab_addresses(host, 80, secure=False)}
    assert found == {f"[{each}]:80/" if ":" in each else f"{each}:80/" for each in expected}


def test_a_phone_is_shown_the_way() -> None:
    """A code of 25 modules with an edge of 2, two rows to a line."""
    lines = list(lines_for_others(["http://10.0.0.2:80/", "http://10.0.0.3:80/"], secure=True))
    assert lines[0] == "also: http://10.0.0.3:80/"
    code = lines[1].splitlines()
    assert {len(line) for line in code} == {29} and len(code) == 15
    assert "http://10.0.0.2:80/" in lines[2]
    assert lines[3] == ENCRYPTED
    assert list(lines_for_others(["http://10.0.0.2:80/"], secure=False))[-1] == IN_CLEAR
