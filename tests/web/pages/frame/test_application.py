"""The application around the pages: its own files, the token, requests that never end."""

from pathlib import Path

import pytest
from starlette.responses import Response
from starlette.types import Message, Scope

import skisnow.web
from skisnow._support.messages import Message as Text
from skisnow._support.messages import languages
from skisnow.web.guard import answer_to_token, token_page
from skisnow.web.server import _set_language

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


def test_pages_have_the_styles_of_the_lab_alone(desk: Desk) -> None:
    """A second style sheet, such as Tailwind's, would reset headings and lists."""
    page = desk.get("/carve").text
    assert "/lab.css" in page
    assert "tailwindcss" not in page
