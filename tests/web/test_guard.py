"""Whose requests the lab answers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import pytest

pytest.importorskip("nicegui", reason="the web lab is not installed")

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import PlainTextResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.types import Message, Scope
from starlette.websockets import WebSocket

from skisnow.web.guard import COOKIE, Access, Guard, is_loopback

from .finished import finished

HOST = "127.0.0.1:8765"
OWN = {"origin": f"http://{HOST}"}


async def body_size(request: Request) -> Response:
    return PlainTextResponse(str(len(await request.body())))


async def talk(socket: WebSocket) -> None:
    await socket.accept()
    await socket.close()


@dataclass(frozen=True)
class Answer:
    status: int
    headers: dict[str, str]
    text: str


class Client:
    """Asks the guard as a server would hand requests to it."""

    def __init__(self, *, host: str = "127.0.0.1", token: str | None = None, body_bytes: int = 1000) -> None:
        routes = [Route("/", body_size, methods=["GET", "POST", "DELETE"]), WebSocketRoute("/talk", talk)]
        self._app = Guard(Starlette(routes=routes), Access(host, token, body_bytes))

    def ask(self, method: str = "GET", path: str = "/", body: Sequence[bytes] = (), /, **headers: str) -> Answer:
        given = {"host": HOST, **headers}
        waiting: list[Message] = [
            {"type": "http.request", "body": piece, "more_body": index + 1 < len(body)}
            for index, piece in enumerate(body or (b"",))
        ]
        start, *rest = self._run({"type": "http", "method": method}, path, given, waiting)
        told = {name.decode(): value.decode() for name, value in start["headers"]}
        return Answer(start["status"], told, b"".join(each.get("body", b"") for each in rest).decode())

    def post(self, *body: bytes, path: str = "/", **headers: str) -> Answer:
        size = {"content-length": str(sum(map(len, body)))}
        return self.ask("POST", path, body, **{**size, **headers})

    def is_spoken_to(self, **headers: str) -> bool:
        sent = self._run({"type": "websocket"}, "/talk", {"host": HOST, **headers}, [{"type": "websocket.connect"}])
        return sent[0]["type"] == "websocket.accept"

    def _run(self, kind: Scope, path: str, headers: dict[str, str], waiting: list[Message]) -> list[Message]:
        raw = [(name.encode(), value.encode()) for name, value in headers.items()]
        scope = {**kind, "path": path, "raw_path": path.encode(), "query_string": b"", "headers": raw, "scheme": "http"}
        sent: list[Message] = []

        async def receive() -> Message:
            return waiting.pop(0)

        async def send(message: Message) -> None:
            sent.append(message)

        finished(self._app(scope, receive, send))
        return sent


@pytest.mark.parametrize(
    "headers",
    [
        {"origin": "http://evil.example"},
        {"origin": "http://127.0.0.1:9999"},
        {"origin": "null"},
        {"origin": "http://127.0.0.1:8765.evil.example"},
        {},
    ],
)
def test_what_other_sites_send_is_refused(headers: dict[str, str]) -> None:
    lab = Client()
    assert lab.post(b"x", **headers).status == 403
    assert lab.ask("DELETE", **headers).status == 403
    assert not lab.is_spoken_to(**headers)


@pytest.mark.parametrize(
    "host", ["evil.example", "evil.example:8765", "192.168.1.7:8765", "127.0.0.1.evil.example", ""]
)
def test_other_names_for_this_machine_are_refused(host: str) -> None:
    """A name that was made to point here (rebinding): its Origin would agree with its Host."""
    lab = Client()
    assert lab.ask(host=host).status == 421
    assert lab.post(b"x", host=host, origin=f"http://{host}").status == 421
    assert not lab.is_spoken_to(host=host, origin=f"http://{host}")


def test_without_the_token_nothing_is_answered() -> None:
    lab = Client(token="snow in may")
    asked = lab.ask()
    assert asked.status == 401
    assert "Token" in asked.text
    assert not lab.is_spoken_to(**OWN)
    assert lab.post(b"token=snow+in+june", path="/token", **OWN).status == 403
    assert lab.ask(cookie=f"{COOKIE}=").status == 401
    assert lab.ask(cookie=f"{COOKIE}=snow in may").status == 401


def test_the_token_lets_in_by_a_cookie_that_scripts_and_other_sites_do_not_get() -> None:
    lab = Client(token="snow in may")
    answer = lab.post(b"token=snow+in+may", path="/token", **OWN)
    assert answer.status == 303
    cookie = answer.headers["set-cookie"]
    assert "httponly" in cookie.lower()
    assert "samesite=strict" in cookie.lower()
    assert "snow in may" not in cookie
    own = cookie.split(";")[0]
    assert lab.ask(cookie=own).status == 200
    assert lab.is_spoken_to(cookie=own, **OWN)
    assert Client(token="another").ask(cookie=own).status == 401


def test_the_token_is_not_taken_from_another_site() -> None:
    lab = Client(token="snow in may")
    assert lab.post(b"token=snow+in+may", path="/token", origin="http://evil.example").status == 403


def test_what_counts_as_loopback() -> None:
    assert [is_loopback(host) for host in ("127.0.0.1", "127.9.9.9", "::1", "localhost")] == [True] * 4
    assert not any(is_loopback(host) for host in ("0.0.0.0", "::", "192.168.0.1", "example.org"))


@pytest.mark.parametrize("headers", [{"host": "["}, {"host": "[::1"}, {"origin": "http://["}, {"origin": "http://[x]"}])
def test_what_is_no_address_is_a_bad_request(headers: dict[str, str]) -> None:
    for lab in (Client(), Client(token="snow in may")):
        assert lab.ask(**headers).status == 400
        assert lab.post(b"x", **{**OWN, **headers}).status == 400
        assert not lab.is_spoken_to(**{**OWN, **headers})


def test_too_many_tries_are_told_when_to_try_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("skisnow.web.guard._WAIT_S", 0.0)
    lab = Client(token="snow in may")
    wrong = [lab.post(b"token=snow+in+june", path="/token", **OWN).status for _ in range(10)]
    assert wrong == [403] * 10
    right = lab.post(b"token=snow+in+may", path="/token", **OWN)
    assert right.status == 429
    assert 1 <= int(right.headers["retry-after"]) <= 60
    assert "set-cookie" not in right.headers
