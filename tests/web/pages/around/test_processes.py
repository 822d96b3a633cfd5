"""Another process for sent files, and the server."""

from __future__ import annotations

import socket
import ssl
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, cast

import pytest
import uvicorn

from skisnow._support.errors import FieldDataError, OutputError, ParameterError, SkisnowError, StoreError
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

from .shared import greeting, raising

if TYPE_CHECKING:
    from ..desk import Desk


class Ends:
    """Both ends of a pipe to a process, without one."""

    def __init__(self, answer: Any) -> None:
        self.answer = answer
        self.done: list[Any] = []
        self.process: dict[str, Any] = {}

    def get_context(self, kind: str) -> Any:
        self.done.append(kind)

        def process(**given: Any) -> Any:
            self.process = given
            return SimpleNamespace(**{name: self._noted(name) for name in ("start", "kill", "join")})

        return SimpleNamespace(Pipe=self._pipe, Process=process)

    def _pipe(self, *, duplex: bool) -> tuple[Any, Any]:
        self.done.append(duplex)
        hears = SimpleNamespace(poll=self._poll, recv=self._recv, close=self._noted("hears closed"))
        return hears, SimpleNamespace(close=self._noted("tells closed"))

    def _noted(self, name: str) -> Callable[[], None]:
        return lambda: self.done.append(name)

    def _poll(self, seconds: float) -> bool:
        self.done.append(seconds)
        return self.answer is not None

    def _recv(self) -> Any:
        if isinstance(self.answer, Exception):
            raise self.answer
        return self.answer


def in_ends(monkeypatch: pytest.MonkeyPatch, answer: Any) -> Ends:
    ends = Ends(answer)
    monkeypatch.setattr(subprocesses, "multiprocessing", ends)
    return ends


@pytest.mark.parametrize(
    ("answer", "error", "code"),
    [
        ((7, ""), None, ""),
        (None, ParameterError, "too_slow"),
        (EOFError(), ParameterError, "cannot_read"),
        ((StoreError("s", code="full"), ""), StoreError, "full"),
        ((ParameterError("p", code="so"), "a trace"), ParameterError, "so"),
    ],
)
def test_what_comes_of_another_process(
    monkeypatch: pytest.MonkeyPatch, answer: Any, error: type[SkisnowError] | None, code: str
) -> None:
    ends, logged, bounds = in_ends(monkeypatch, answer), list[Any](), Bounds(2.5, 3_999_999)
    monkeypatch.setattr(subprocesses, "_LOG", SimpleNamespace(error=lambda *what: logged.append(what)))
    if error is None:
        assert subprocesses.confined(bounds, len, "ab") == 7
    else:
        with raises(error, code) as found:
            subprocesses.confined(bounds, len, "ab")
        assert type(found.value) is error
    begun = ["spawn", False, "start", "tells closed", 2.5]
    assert ends.done == [*begun, "kill", "join", "hears closed"]
    assert (ends.process["target"], ends.process["daemon"]) == (subprocesses._run_confined, True)
    assert ends.process["args"][1:] == (bounds, len, ("ab",))
    traced = isinstance(answer, tuple) and answer[1]
    assert [what[1:] for what in logged] == ([("a trace",)] if traced else [])


class SpecialError(ParameterError):
    """An error that the other side has no class of."""


@pytest.mark.parametrize(
    ("work", "kind", "code"),
    [
        (len, int, ""),
        (raising(FieldDataError(["a", "b"], code="f")), FieldDataError, "f"),
        (raising(StoreError("s", code="s")), StoreError, "s"),
        (raising(OutputError("o", code="o")), OutputError, "o"),
        (raising(ParameterError("p", code="p")), ParameterError, "p"),
        (raising(SpecialError("q", code="q")), ParameterError, "q"),
    ],
)
def test_what_another_process_tells(
    monkeypatch: pytest.MonkeyPatch, work: Callable[..., object], kind: type, code: str
) -> None:
    done: list[Any] = []
    monkeypatch.setattr(subprocesses, "end_with_server", lambda: done.append("watched"))
    monkeypatch.setattr(subprocesses, "_set_limits", done.append)
    bounds = Bounds(2.5, 3_000_000)
    subprocesses._run_confined(cast(Any, SimpleNamespace(send=done.append)), bounds, work, ("ab",))
    assert done[:2] == ["watched", bounds]
    answer, trace = done[2]
    assert (type(answer), getattr(answer, "code", ""), trace) == (kind, code, "")


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


def test_a_process_is_bound_by_the_system(monkeypatch: pytest.MonkeyPatch) -> None:
    resource = pytest.importorskip("resource")
    held: list[Any] = []

    def held_to(kind: int, most: tuple[int, int]) -> None:
        held.append((kind, most))
        if kind != resource.RLIMIT_CORE:
            raise (ValueError if kind == resource.RLIMIT_CPU else OSError)("lower already")

    monkeypatch.setattr(resource, "setrlimit", held_to)
    subprocesses._set_limits(Bounds(2.5, 3_000_000))
    assert held == [
        (resource.RLIMIT_CPU, (3, 3)),
        (resource.RLIMIT_DATA, (3_000_000, 3_000_000)),
        (resource.RLIMIT_CORE, (0, 0)),
    ]
    bounds = (subprocesses.BOUNDS, subprocesses.SKI_BOUNDS)
    assert bounds == (Bounds(120.0, 3_000_000_000), Bounds(60.0, 3_000_000_000))


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


def test_the_address_says_which_family_is_listened_on(desk: Desk, announced: list[Any]) -> None:
    serve(desk.lab, host="127.0.0.1", port=0, token=None, tell=lambda _: None)
    assert announced[0].family == socket.AF_INET
    try:
        serve(desk.lab, host="::1", port=0, token=None, tell=lambda _: None)
    except OSError:
        pytest.skip("this machine has no IPv6")
    assert announced[1].family == socket.AF_INET6


@pytest.mark.parametrize("started", [True, False])
def test_a_server_is_announced_once_it_answers(desk: Desk, monkeypatch: pytest.MonkeyPatch, started: bool) -> None:
    heard: list[Any] = []

    async def startup(made: Any, sockets: Any = None) -> None:
        heard.append(sockets)
        made.started = started

    monkeypatch.setattr(uvicorn.Server, "startup", startup)
    made = server._AnnouncingServer(uvicorn.Config(greeting), lambda: heard.append("begun"))
    desk.wait(made.startup([7]))  # type: ignore[list-item]
    assert heard == ([[7], "begun"] if started else [[7]])


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
