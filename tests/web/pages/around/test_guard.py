"""Requests that the lab guards, and work in other processes."""

import hashlib
import hmac
import logging
import socket
import ssl
from collections.abc import Callable, Iterator
from logging.handlers import RotatingFileHandler
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import pytest
from starlette.datastructures import Headers
from starlette.requests import Request
from starlette.types import Message

from skisnow._support.errors import FieldDataError, OutputError, ParameterError, StoreError
from skisnow.web import elements, server, uploads
from skisnow.web.campaign_analysis import AnalysisCache
from skisnow.web.elements import _error_answer, _notify, error_sentence, log_error, log_to, plain_page
from skisnow.web.guard import CONTENT_POLICY, COOKIE, Access, Guard
from skisnow.web.server import (
    ENCRYPTED,
    IN_CLEAR,
    Certificate,
    lab_addresses,
    lines_for_others,
    require_allowed,
    serve,
)
from skisnow.web.uploads import Bounds
from tests.coded import raises

from ..desk import Desk
from .shared import greeting, raising

HOST = "127.0.0.1:8765"


class Asked:
    """The guard's answer to a request."""

    def __init__(self, desk: Desk, *, token: str | None = None, body_bytes: int = 100, host: str = "127.0.0.1") -> None:
        self._desk = desk
        self.guard = Guard(greeting, Access(host, token, body_bytes))
        self.received = 0

    def send(self, kind: str, path: str = "/", method: str = "GET", *body: bytes, **headers: str) -> list[Message]:
        given = {"host": HOST, **{name.replace("_", "-"): value for name, value in headers.items()}}
        raw = [(name.encode(), value.encode()) for name, value in given.items()]
        scope = {"type": kind, "method": method, "path": path, "headers": raw, "query_string": b"", "client": ("a", 1)}
        waiting: Iterator[Message] = iter(
            [{"type": "http.request", "body": each, "more_body": True} for each in body]
            + [{"type": "http.request", "body": b"", "more_body": False}]
        )
        sent: list[Message] = []

        async def receive() -> Message:
            self.received += 1
            return next(waiting)

        async def send(message: Message) -> None:
            sent.append(message)

        self._desk.wait(cast(Any, self.guard(scope, receive, send)))
        return sent

    def status(self, path: str = "/", method: str = "GET", *body: bytes, **headers: str) -> tuple[int, str]:
        start, *rest = self.send("http", path, method, *body, **headers)
        return start["status"], b"".join(each["body"] for each in rest).decode()


OWN = {"origin": f"http://{HOST}"}
FOREIGN, TOO_MUCH, OTHER_HOST, NO_ADDRESS = 403, 413, 421, 400


@pytest.mark.parametrize(
    ("method", "headers", "answer"),
    [
        ("GET", {}, 200),
        ("HEAD", {}, 200),
        ("OPTIONS", {}, 200),
        ("GET", OWN, 200),
        ("POST", OWN, 200),
        ("POST", {}, FOREIGN),
        ("PUT", {}, FOREIGN),
        ("GET", {"origin": "http://127.0.0.1"}, FOREIGN),
        ("POST", {"origin": "http://127.0.0.1"}, FOREIGN),
        ("GET", {"host": "evil.example"}, OTHER_HOST),
        ("GET", {"host": "LOCALHOST:8765"}, 200),
        ("GET", {"host": "[::1]:8765"}, 200),
        ("DELETE", {}, FOREIGN),
        *(("POST", {"origin": f"http://{name}"}, FOREIGN) for name in ("127.0.0.1:9999", f"{HOST}.evil.example")),
        ("POST", {"origin": "null"}, FOREIGN),
        *(
            ("POST", {"host": name, "origin": f"http://{name}"}, OTHER_HOST)  # a name that was made to point here
            for name in ("evil.example:8765", "192.168.1.7:8765", "127.0.0.1.evil.example", "")
        ),
        ("GET", {"host": "["}, NO_ADDRESS),
        ("POST", {**OWN, "host": "[::1"}, NO_ADDRESS),
        *(("POST", {"origin": origin}, NO_ADDRESS) for origin in ("http://[", "http://[x]")),
        ("GET", {"content_length": "100"}, 200),
        *(("GET", {"content_length": size}, TOO_MUCH) for size in ("101", "1e1", "-1", "x", "1" * 5000)),
    ],
)
def test_requests_that_the_guard_answers(desk: Desk, method: str, headers: dict[str, str], answer: int) -> None:
    assert Asked(desk).status("/", method, **headers)[0] == answer
    if answer in (FOREIGN, OTHER_HOST, NO_ADDRESS):
        assert Asked(desk).send("websocket", **headers)[0]["type"] != "websocket.accept"
    if answer == NO_ADDRESS:
        assert Asked(desk, token="snow").status("/", method, **headers)[0] == NO_ADDRESS


def test_a_body_without_its_size_is_cut_off_beyond_the_limit(desk: Desk) -> None:
    lab = Asked(desk)
    assert lab.status("/", "POST", b"x" * 60, b"x" * 40, **OWN) == (200, "100")
    assert lab.send("http", "/", "POST", b"x" * 60, b"x" * 41, **OWN) == [{"type": "disconnected"}]


def test_every_answer_has_the_headers_and_a_stricter_policy_stays(desk: Desk) -> None:
    lab = Asked(desk)
    expected = {
        "content-security-policy": CONTENT_POLICY,
        "x-content-type-options": "nosniff",
        "x-frame-options": "DENY",
        "referrer-policy": "same-origin",
        "cross-origin-opener-policy": "same-origin",
        "cross-origin-resource-policy": "same-origin",
    }
    for headers in ({}, {"host": "evil.example"}):
        start = lab.send("http", **headers)[0]
        found = {name.decode(): value.decode() for name, value in start["headers"]}
        assert {name: found[name] for name in expected} == expected
    assert dict(lab.send("http", "/own")[0]["headers"])[b"content-security-policy"] == b"own"
    assert lab.status("/status")[0] == 404
    assert "default-src 'none'" in CONTENT_POLICY
    assert not {"http:", "https:", "*"} & set(CONTENT_POLICY.replace(";", " ").split())


def test_a_socket_of_another_site_is_closed(desk: Desk) -> None:
    lab = Asked(desk)
    assert lab.send("websocket", **OWN) == [{"type": "websocket.accept"}]
    assert lab.received == 0
    for headers in ({}, {"origin": "http://evil.example"}):
        assert lab.send("websocket", **headers) == [{"type": "websocket.close", "code": 1008}]
    assert lab.received == 2
    assert Asked(desk, token="snow").send("websocket", **OWN) == [{"type": "websocket.close", "code": 1008}]
    assert lab.send("lifespan", host="evil.example") == [{"type": "lifespan.startup.complete"}]


def test_the_token_is_requested_until_the_cookie_is_there(desk: Desk) -> None:
    lab, cookie = Asked(desk, token="snow"), hmac.new(b"snow", b"skisnow lab", hashlib.sha256).hexdigest()
    for path, method in (("/", "GET"), ("/token", "GET"), ("/", "POST")):
        assert lab.status(path, method, **OWN)[0] == 401
    assert lab.status(cookie=f"{COOKIE}={cookie}") == (200, "0")
    assert lab.send("websocket", cookie=f"a=b; {COOKIE}={cookie}", **OWN) == [{"type": "websocket.accept"}]
    assert lab.status(cookie=f"{COOKIE}=wrong")[0] == 401
    start = lab.send("http", "/token", "POST", b"token=snow", **OWN)[0]
    assert start["status"] == 303
    assert dict(start["headers"])[b"set-cookie"].startswith(f"{COOKIE}={cookie};".encode())
    assert lab.status("/token", "POST", b"token=snow", origin="http://evil.example")[0] == FOREIGN


@pytest.mark.parametrize("other", ["a/b=1", "user[theme]=dark", '{"a": 1}', "é=é", "=", ";"])
def test_a_cookie_of_another_program_on_the_machine_keeps_nobody_out(other: str) -> None:
    access = Access("127.0.0.1", "snow", 1)
    for cookies in (f"{other}; {COOKIE}={access.cookie}", f"{COOKIE}={access.cookie}; {other}"):
        assert access.has_access(Headers(raw=[(b"cookie", cookies.encode("latin-1"))]))


def test_names_of_this_machine_are_known_where_others_may_come(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(socket, "gethostname", lambda: "Hut")
    alone, shared = Access("127.0.0.1", None, 1), Access("Lab.Example", "snow", 1)
    names = ("hut", "HUT.local:80", "lab.example:8765", "192.168.1.7", "[fe80::1]:80", "localhost", "127.0.0.1", "::1")
    assert [shared.allows_host(name) for name in names[:7]] == [True] * 7
    assert [alone.allows_host(name) for name in names[:7]] == [False] * 5 + [True] * 2
    assert not shared.allows_host("evil.example")
    assert not shared.allows_host("")
    assert shared.cookie != Access("Lab.Example", "ice", 1).cookie


@pytest.fixture
def log(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A separate log file."""
    made = logging.getLogger("skisnow.test-of-what-is-guarded")
    monkeypatch.setattr(elements, "LOG", made)
    log_to(tmp_path / "new" / "lab.log")
    yield tmp_path / "new" / "lab.log"
    for handler in made.handlers[:]:
        handler.close()
        made.removeHandler(handler)


def test_the_log_keeps_its_last_two_files(log: Path) -> None:
    (handler,) = (each for each in elements.LOG.handlers if isinstance(each, RotatingFileHandler))
    assert (handler.maxBytes, handler.backupCount, handler.encoding) == (2_000_000, 1, "utf-8")
    assert (elements.LOG.level, elements.LOG.propagate) == (logging.INFO, False)
    reference = log_error(ValueError("ü"))
    assert len(reference) == 8
    line, *trace = log.read_text(encoding="utf-8").splitlines()
    assert line.endswith(f" ERROR reference {reference}")
    assert trace == ["ValueError: ü"]
    log_to(log)  # the folder is there


def test_an_error_is_reported_in_the_corner_of_its_page(desk: Desk) -> None:
    page = desk.open("/replay")
    desk.do(lambda: _notify(StoreError("full.")), page.client)
    page.told("notify ")
    (said,) = (each for each in page.scripts if each.startswith("notify "))
    for part in ("'message': 'full.'", "'type': 'negative'", "'multiLine': True", "'timeout': 0"):
        assert part in said


@pytest.mark.parametrize(
    ("error", "status"),
    [(StoreError("a"), 404), (ParameterError("b"), 404), (OutputError("c"), 500), (ValueError("secret"), 500)],
)
def test_a_page_with_an_error_has_its_reason(
    desk: Desk, monkeypatch: pytest.MonkeyPatch, error: Exception, status: int
) -> None:
    monkeypatch.setattr(AnalysisCache, "cached", raising(error))
    answer = desk.get("/analysis/kept/ffff")
    assert answer.status_code == status
    assert "secret" not in answer.text
    assert desk.failures == [error]
    desk.failures.clear()


def test_there_is_no_page_at_a_wrong_address(desk: Desk) -> None:
    for path in ("/nowhere", "/export/kept", "/docs", "/redoc", "/openapi.json"):
        answer = desk.get(path)
        assert answer.status_code == 404
        assert '<a href="/">' in answer.text
    assert '<html lang="de">' in desk.get("/nowhere", "de").text


def test_an_answer_that_failed_says_what_it_may(desk: Desk, log: Path) -> None:
    request = Request({"type": "http", "headers": []})
    said = desk.wait(_error_answer(request, StoreError("it is <full>")))
    assert said.status_code == 500
    assert "&lt;full&gt;" in bytes(said.body).decode()
    other = desk.wait(_error_answer(request, ValueError("secret")))
    text = bytes(other.body).decode()
    assert other.status_code == 500
    assert "secret" not in text and "secret" in log.read_text(encoding="utf-8")
    assert plain_page("a", "b", 418, request).status_code == 418
    assert error_sentence(FieldDataError(["it is so"])).endswith(" it is so")


def test_an_unforeseen_error_of_another_process_has_a_trace(monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[Any] = []
    monkeypatch.setattr(uploads, "end_with_server", lambda: None)
    monkeypatch.setattr(uploads, "_set_limits", lambda _: None)
    for letters in (1, 9000):
        work = raising(ValueError("x" * letters))
        uploads._run_confined(cast(Any, SimpleNamespace(send=told.append)), Bounds(2.5, 3_000_000), work, ())
    assert [(type(error), error.code) for error, _ in told] == [(ParameterError, "cannot_read")] * 2
    assert told[0][1].startswith("Traceback") and told[0][1].endswith("ValueError: x\n")
    assert len(told[1][1]) == 4000 and told[1][1].endswith("xx\n")


def test_a_process_ends_with_its_server(monkeypatch: pytest.MonkeyPatch) -> None:
    done: list[Any] = []

    def thread(*, target: Callable[[], None], daemon: bool) -> Any:
        done.append(daemon)
        return SimpleNamespace(start=target)

    parent = SimpleNamespace(sentinel=7)
    monkeypatch.setattr(uploads, "threading", SimpleNamespace(Thread=thread))
    monkeypatch.setattr(uploads, "multiprocessing", SimpleNamespace(parent_process=lambda: parent))
    monkeypatch.setattr(uploads, "os", SimpleNamespace(_exit=lambda code: done.append(f"ends with {code}")))
    signals = SimpleNamespace(signal=lambda *what: done.append(what), SIGINT="ctrl-c", SIG_IGN="left out")
    monkeypatch.setattr(uploads, "signal", signals)
    monkeypatch.setattr(uploads, "wait", done.append)
    uploads.end_with_server()
    assert done == [("ctrl-c", "left out"), True, [7], "ends with 1"]


@pytest.mark.parametrize(
    ("host", "token", "code"),
    [
        ("127.0.0.1", None, ""),
        ("localhost", None, ""),
        ("0.0.0.0", "snow", ""),
        ("127.0.0.1", "snow", ""),
        *((host, None, "no_token") for host in ("0.0.0.0", "::", "192.0.2.1")),
        ("127.0.0.1", " ", "blank_token"),
    ],
)
def test_serving_others_requires_a_token(host: str, token: str | None, code: str) -> None:
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
    assert (config.ssl_certfile, config.ssl_keyfile) == (None, None)
    with pytest.raises(ParameterError):
        serve(desk.lab, host="0.0.0.0", port=0, token=None, tell=told.append)
    assert len(announced) == 1


def test_serving_others_prints_their_address(desk: Desk, announced: list[Any], monkeypatch: pytest.MonkeyPatch) -> None:
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
def test_addresses_without_name_of_an_adapter(monkeypatch: pytest.MonkeyPatch, host: str, expected: list[str]) -> None:
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


def test_the_address_for_a_phone_is_shown() -> None:
    """A code of 25 modules with an edge of 2, two rows to a line."""
    lines = list(lines_for_others(["http://10.0.0.2:80/", "http://10.0.0.3:80/"], secure=True))
    assert lines[0] == "also: http://10.0.0.3:80/"
    code = lines[1].splitlines()
    assert {len(line) for line in code} == {29} and len(code) == 15
    assert "http://10.0.0.2:80/" in lines[2]
    assert lines[3] == ENCRYPTED
    assert list(lines_for_others(["http://10.0.0.2:80/"], secure=False))[-1] == IN_CLEAR
