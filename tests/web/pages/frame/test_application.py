"""The application around the pages: its own files, the token, requests that never end."""

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any
from unittest.mock import Mock

import pytest
import uvicorn
from starlette.responses import Response
from starlette.types import Message, Receive, Scope, Send
from uvicorn.server import ServerState

import skisnow.web
from skisnow._support.messages import Message as Text
from skisnow._support.messages import languages
from skisnow.web.guard import Tries, answer_to_token, token_page
from skisnow.web.server import TimeLimitedProtocol, _set_language

from ...finished import finished
from ..desk import Desk

HERE = Path(skisnow.web.__file__).parent


@pytest.mark.parametrize(
    ("path", "kind"), [("/lab.css", "text/css"), ("/lab.js", "text/javascript"), ("/kept.js", "text/javascript")]
)
def test_own_files_are_requested_again(desk: Desk, path: str, kind: str) -> None:
    answer = desk.get(path)
    assert answer.status_code == 200
    assert answer.headers["content-type"].startswith(kind)
    assert answer.headers["cache-control"] == "no-cache"
    assert answer.content == (HERE / path[1:]).read_bytes()


@pytest.mark.parametrize(
    ("back", "place"),
    [
        ("/skis?ski=a", "/skis?ski=a"),
        ("//evil.example", "/"),
        ("/\\evil.example", "/"),
        ("https://evil.example", "/"),
        ("", "/"),
    ],
)
def test_a_language_is_kept_and_leads_back_to_a_page_of_the_lab(back: str, place: str) -> None:
    answer = _set_language("de", back)
    assert (answer.status_code, answer.headers["location"]) == (303, place)
    parts = answer.headers["set-cookie"].split("; ")
    assert parts[0] == "skisnow-language=de"
    assert sorted(parts[1:]) == ["HttpOnly", "Max-Age=31536000", "Path=/", "SameSite=lax"]
    assert all(code in _set_language(code).headers["set-cookie"] for code in languages())
    assert "set-cookie" not in _set_language("xx").headers


def scope_of(language: str = "en", scheme: str = "http") -> Scope:
    headers = [(b"accept-language", language.encode())]
    return {"type": "http", "method": "POST", "path": "/token", "headers": headers, "scheme": scheme}


def answered(*messages: Message, scope: Scope | None = None, token: str = "snow in may") -> Response:
    """The answer of the token's page to a body."""
    waiting = list(messages)

    async def receive() -> Message:
        return waiting.pop(0)

    return finished(
        answer_to_token(scope or scope_of(), receive, lambda text: text == token, ("the-cookie", "its-value"))
    )


def body(text: bytes, *, more: bool = False) -> Message:
    return {"type": "http.request", "body": text, "more_body": more}


@pytest.fixture
def waits(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """For how long a wrong token is held, without waiting."""
    heard: list[float] = []

    async def slept(seconds: float) -> None:
        heard.append(seconds)

    monkeypatch.setattr("skisnow.web.guard.asyncio.sleep", slept)
    return heard


def test_the_right_token_is_let_in_at_once(waits: list[float]) -> None:
    answer = answered(body(b"token=snow", more=True), body(b"+in+may"))
    assert (answer.status_code, answer.headers["location"], waits) == (303, "/", [])
    parts = answer.headers["set-cookie"].split("; ")
    assert sorted(parts) == ["HttpOnly", "Path=/", "SameSite=strict", "the-cookie=its-value"]
    assert answered(body(b"token=snow+in+may&token=x")).status_code == 303  # the first one counts
    secure = answered(body(b"token=snow+in+may"), scope=scope_of(scheme="https"))
    assert "; Secure" in secure.headers["set-cookie"]


@pytest.mark.parametrize("text", [b"token=snow", b"", b"other=snow+in+may", b"token=\xff"])
def test_a_wrong_token_is_held_a_while(waits: list[float], text: bytes) -> None:
    answer = answered(body(text))
    assert (answer.status_code, waits) == (403, [0.5])
    assert "set-cookie" not in answer.headers


def text_of(answer: Response) -> str:
    return bytes(answer.body).decode()


@pytest.mark.parametrize(("size", "status"), [(2000, 403), (2001, 413)])
def test_a_body_that_is_too_long_for_a_token_is_not_read_on(waits: list[float], size: int, status: int) -> None:
    assert answered(body(b"x" * 1000, more=True), body(b"x" * (size - 1000))).status_code == status
    assert len(waits) == (1 if status == 403 else 0)


def test_the_form_of_the_token_in_both_languages() -> None:
    answer = token_page(scope_of(), 401)
    page = text_of(answer)
    assert (answer.status_code, answer.headers["cache-control"]) == (401, "no-store")
    for part in ('<html lang="en">', '<p role="status">', 'action="/token"', '<label for="token">'):
        assert part in page
    german = text_of(token_page(scope_of("de"), 403, Text("This is not the token.")))
    assert '<html lang="de">' in german and "This is" not in german


def test_tries_are_forgotten_after_a_minute_each() -> None:
    clock = [0.0]
    tries = Tries(lambda: clock[0])
    for second in range(10):
        clock[0] = float(second)
        assert tries.wait_s("a") == 0.0
    assert [tries.wait_s("a"), tries.wait_s("a")] == [51.0, 51.0]
    clock[0] = 59.5
    assert tries.wait_s("a") == 0.5
    clock[0] = 60.0
    assert (tries.wait_s("a"), tries.wait_s("a")) == (0.0, 1.0)  # the first one is a minute old
    clock[0] = 130.0
    assert [tries.wait_s("a") for _ in range(11)] == [0.0] * 10 + [60.0]
    assert Tries().wait_s("a") == 0.0


def test_networks_have_tries_of_their_own() -> None:
    tries = Tries(lambda: 0.0)
    assert [tries.wait_s(f"2001:db8::{i:x}:1") for i in range(10)] == [0.0] * 10
    assert tries.wait_s("2001:db8:0:0:1:1:1:1") == 60.0
    assert tries.wait_s("2001:db8:0:1::") == 0.0
    assert [tries.wait_s("no address") for _ in range(11)] == [0.0] * 10 + [60.0]
    assert tries.wait_s("another") == 0.0


async def hi(_: Scope, receive: Receive, send: Send) -> None:
    while (await receive()).get("more_body"):
        pass
    await send({"type": "http.response.start", "status": 200, "headers": [(b"content-length", b"2")]})
    await send({"type": "http.response.body", "body": b"hi"})


class Patience:
    """The server's end of a simulated connection, with its timers."""

    def __init__(self) -> None:
        self.wire = Mock(spec=asyncio.Transport)
        self.wire.is_closing.side_effect = lambda: self.wire.close.called
        self.wire.get_extra_info.return_value = None
        self.state = ServerState()
        self.timers: list[tuple[float, Mock]] = []
        loop = asyncio.get_running_loop()
        later = loop.call_later

        def call_later(seconds: float, act: Callable[..., Any], *given: Any, **named: Any) -> Any:
            if act != self.wire.close:
                return later(seconds, act, *given, **named)
            self.timers.append((seconds, Mock()))
            return self.timers[-1][1]

        vars(loop)["call_later"] = call_later
        config = uvicorn.Config(hi, ws="none", lifespan="off", log_level="critical")
        config.load()
        self.protocol = TimeLimitedProtocol(config, self.state, {})
        self.wire.get_protocol.return_value = self.protocol
        self.protocol.connection_made(self.wire)

    @property
    def waits(self) -> list[float]:
        return [seconds for seconds, timer in self.timers if not timer.cancel.called]

    async def hears(self, data: bytes) -> list[float]:
        """How long it waits for a message."""
        self.protocol.data_received(data)
        return self.waits

    async def answers(self, count: int) -> None:
        """Wait until so many answers are there."""
        while b"".join(bytes(call.args[0]) for call in self.wire.write.call_args_list).count(b"hi") < count:
            await asyncio.sleep(0)


@asynccontextmanager
async def patience() -> AsyncIterator[Patience]:
    made = Patience()
    yield made
    made.protocol.connection_lost(None)
    assert made.waits == []
    assert made.state.connections == set()


GET = b"GET / HTTP/1.1\r\nHost: x\r\n\r\n"
POST = b"POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 9\r\n\r\n"


def test_a_head_has_twenty_seconds_from_its_connection_or_the_answer_before() -> None:
    async def talk() -> None:
        async with patience() as server:
            assert server.waits == [20.0]
            assert await server.hears(GET[:5]) == [20.0]
            assert len(server.timers) == 1  # not from the beginning: that would have no end
            assert await server.hears(GET[5:]) == []
            await server.answers(1)
            assert server.waits == [20.0]
            assert await server.hears(GET + GET[:5]) == []
            await server.answers(2)
            assert server.waits == [20.0]
            assert len(server.timers) == 3

    finished(talk())


def test_each_piece_of_a_body_has_two_minutes() -> None:
    async def talk() -> None:
        async with patience() as server:
            assert await server.hears(POST) == [120.0]
            before = len(server.timers)
            assert await server.hears(b"1234") == [120.0]
            assert len(server.timers) == before + 1
            assert await server.hears(b"56789") == []
            await server.answers(1)
            assert server.waits == [20.0]

    finished(talk())


def test_a_head_without_an_end_is_cut_off_and_each_request_is_counted_by_itself() -> None:
    async def talk() -> None:
        async with patience() as server:
            for number in (1, 2):
                start = b"GET / HTTP/1.1\r\nHost: x\r\nA: "
                await server.hears(start)
                await server.hears(b"a" * (65_536 - len(start)))
                assert not server.wire.close.called
                assert await server.hears(b"\r\n\r\n") == []
                await server.answers(number)
            await server.hears(b"GET / HTTP/1.1\r\nA: ")
            await server.hears(b"a" * (65_536 - 19))
            assert not server.wire.close.called
            await server.hears(b"a")
            assert server.wire.close.called

    finished(talk())


def test_pages_have_the_styles_of_the_lab_alone(desk: Desk) -> None:
    """A second style sheet, such as Tailwind's, would reset headings and lists."""
    page = desk.get("/carve").text
    assert "/lab.css" in page
    assert "tailwindcss" not in page
