"""The guard in front of every page: allowed hosts, the token and its page, security headers, size limits.

The lab is for one person on one machine. A page of another site that is open in the same browser must not reach it: not
by a form (Origin), not by a name that was made to point here (Host), not by a web socket (both).
"""

from __future__ import annotations

import asyncio
import hmac
import ipaddress
import socket
from collections.abc import Callable
from dataclasses import dataclass, field
from html import escape
from typing import Final
from urllib.parse import parse_qs, urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.requests import ClientDisconnect, Request, cookie_parser
from starlette.responses import HTMLResponse, PlainTextResponse, RedirectResponse, Response
from starlette.types import ASGIApp, Receive, Scope, Send
from starlette.types import Message as AsgiMessage

from .._support.messages import Message, translated
from .._support.user_files.text_files import natural_number
from .words import language_of_request

STATUS: Final = "skisnow.status"
"""Key in the scope of a request for the status of its answer, instead of the framework's."""
COOKIE: Final = "skisnow_lab"
_SAFE: Final = frozenset({"GET", "HEAD", "OPTIONS"})
_LOOPBACK_NAMES: Final = frozenset({"localhost", "127.0.0.1", "::1"})

# Vue compiles the components' templates in the browser and the framework's start is an inline script: both need the
# words "unsafe"; what the policy holds is that nothing is loaded from, or sent to, any other place.
CONTENT_POLICY: Final = "; ".join(
    (
        "default-src 'none'",
        "script-src 'self' 'unsafe-inline' 'unsafe-eval'",
        "style-src 'self' 'unsafe-inline'",
        "img-src 'self' data: blob:",
        "font-src 'self'",
        "connect-src 'self'",
        "media-src 'self' blob:",
        "worker-src 'self' blob:",
        "form-action 'self'",
        "base-uri 'none'",
        "frame-ancestors 'none'",
    )
)
HEADERS: Final = {
    "content-security-policy": CONTENT_POLICY,
    "x-content-type-options": "nosniff",
    "x-frame-options": "DENY",
    "referrer-policy": "same-origin",  # with none at all, browsers post our own forms as from nowhere
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
}


def is_loopback(host: str) -> bool:
    """True if a host name or address is only reachable from this machine.

    >>> [is_loopback(host) for host in ("127.0.0.1", "localhost", "::1", "0.0.0.0", "192.168.1.7")]
    [True, True, True, False, False]
    """
    address = _ip_address(host)
    return host == "localhost" or (address is not None and address.is_loopback)


def _ip_address(text: str) -> ipaddress.IPv4Address | ipaddress.IPv6Address | None:
    """IP address of a text; None if it is not one."""
    try:
        return ipaddress.ip_address(text)
    except ValueError:
        return None


@dataclass(frozen=True, slots=True)
class Access:
    """Access rules: host that the server listens on, token (None: not required), largest request body in bytes."""

    host: str
    token: str | None
    body_bytes: int
    _names: frozenset[str] = field(init=False)

    def __post_init__(self) -> None:
        own = socket.gethostname().lower()
        names = {self.host.lower(), own, f"{own}.local"} if not is_loopback(self.host) else set()
        object.__setattr__(self, "_names", _LOOPBACK_NAMES | names)

    def allows_host(self, host: str) -> bool:
        """True for a name of this machine; if others can reach it, also any IP address. ValueError if not a host."""
        name = (urlsplit(f"//{host}").hostname or "").lower()
        if name in self._names:
            return True
        return not is_loopback(self.host) and _ip_address(name) is not None

    @property
    def cookie(self) -> str:
        """Value of the cookie: a hash of the token, which stays valid after a restart."""
        return hmac.new((self.token or "").encode(), b"skisnow lab", "sha256").hexdigest()

    def has_access(self, headers: Headers) -> bool:
        """True if the request has the cookie of the token, or if no token is required."""
        if self.token is None:
            return True
        cookie = cookie_parser(headers.get("cookie", "")).get(COOKIE)  # ignores cookies of other programs
        return cookie is not None and hmac.compare_digest(cookie.encode(), self.cookie.encode())

    def is_token(self, text: str) -> bool:
        """True if a text is the token; compared in constant time."""
        return self.token is not None and hmac.compare_digest(text.encode(), self.token.encode())


class Guard:
    """ASGI application that passes only the lab's own requests to another one."""

    def __init__(self, app: ASGIApp, access: Access) -> None:
        self.app = app
        self.access = access

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer, reject or pass on a request."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        headers, is_socket = Headers(scope=scope), scope["type"] == "websocket"
        answer = self._refusing_response(scope, headers)
        if answer is None and not self.access.has_access(headers):
            if is_socket:
                answer = Response(status_code=401)
            elif scope["method"] == "POST" and scope["path"] == TOKEN_PATH:
                answer = await answer_to_token(scope, receive, self.access.is_token, (COOKIE, self.access.cookie))
            else:
                answer = token_page(scope, 401)
        if is_socket and answer is not None:
            await receive()
            await send({"type": "websocket.close", "code": 1008})
        elif is_socket:
            await self.app(scope, receive, send)
        elif answer is not None:
            await answer(scope, receive, _add_headers(send, scope))
        else:
            await self.app(scope, _limit_body(receive, self.access.body_bytes), _add_headers(send, scope))

    def _refusing_response(self, scope: Scope, headers: Headers) -> Response | None:
        """Response that rejects a request of another host or site, or one that is too large; otherwise None."""
        host, origin = headers.get("host", ""), headers.get("origin")
        try:
            is_own, sent_by = self.access.allows_host(host), None if origin is None else urlsplit(origin).netloc
        except ValueError:  # such as "["
            return PlainTextResponse("The Host or the Origin of this request is not an address.", 400)
        if not is_own:
            return PlainTextResponse("This address is not one of the lab's.", 421)
        needs_origin = scope["type"] == "websocket" or scope["method"] not in _SAFE
        if (origin is None and needs_origin) or (origin is not None and sent_by != host):
            return PlainTextResponse("Rejected: the request comes from another site.", 403)
        size = natural_number(headers.get("content-length", "0"))
        if size is None or size > self.access.body_bytes:
            return PlainTextResponse("This is more than the lab takes in at once.", 413)
        return None


def _add_headers(send: Send, scope: Scope) -> Send:
    """Wrap `send`: answers get missing security headers and the status in `STATUS`, where the framework answers 500."""

    async def sent(message: AsgiMessage) -> None:
        if message["type"] == "http.response.start":
            message["status"] = scope.get(STATUS, message["status"])
            headers = MutableHeaders(scope=message)
            for name, value in HEADERS.items():
                headers.setdefault(name, value)
        await send(message)

    return sent


def _limit_body(receive: Receive, most_bytes: int) -> Receive:
    """Wrap `receive`: the bytes of a request's body are counted, and the client is disconnected beyond the limit."""
    taken = 0

    async def received() -> AsgiMessage:
        nonlocal taken
        message = await receive()
        taken += len(message.get("body", b""))
        return message if taken <= most_bytes else {"type": "http.disconnect"}

    return received


TOKEN_PATH: Final = "/token"
_LONGEST: Final = 2000
_WAIT_S: Final = 0.5  # delay after a wrong token (s) against guessing

_PAGE: Final = """<!doctype html><html lang="{language}"><meta charset="utf-8"><title>{token} · skisnow</title>
<meta name="viewport" content="width=device-width, initial-scale=1">
<style>body{{font:20px/1.5 system-ui,sans-serif;color:#111;background:#fff;max-width:28rem;margin:3rem auto;
padding:0 1rem}}
input,button{{font:inherit;width:100%;box-sizing:border-box;min-height:56px;margin:.4rem 0;padding:.4rem .8rem;
border:2px solid #333;border-radius:6px}}button{{background:#0b4f8a;color:#fff;border-color:#0b4f8a}}
</style><main><h1>skisnow</h1><p role="status">{said}</p><form method="post" action="{path}">
<label for="token">{token}</label>
<input id="token" name="token" type="password" autocomplete="current-password" autofocus>
<button>{open}</button></form></main></html>"""


def token_page(
    scope: Scope, status: int, sentence: str = Message("The lab requires the token that it was started with.")
) -> Response:
    """Page with the form for the token and a sentence above it, in the language of the request."""
    language = language_of_request(Request(scope))
    shown = {"said": sentence, "token": Message("Token"), "open": Message("Open the lab")}
    words = {name: escape(translated(text, language)) for name, text in shown.items()}
    page = _PAGE.format(language=language, path=TOKEN_PATH, **words)
    return HTMLResponse(page, status, headers={"cache-control": "no-store"})


async def answer_to_token(
    scope: Scope, receive: Receive, is_token: Callable[[str], bool], cookie: tuple[str, str]
) -> Response:
    """Answer to a sent token: a redirect with the cookie, or the form again."""
    body = b""
    try:
        async for piece in Request(scope, receive).stream():
            body += piece
            if len(body) > _LONGEST:
                return token_page(scope, 413, Message("This is too long for a token."))
    except ClientDisconnect:
        return Response(status_code=400)
    token = parse_qs(body.decode("utf-8", "replace")).get("token", [""])[0]
    if not is_token(token):
        await asyncio.sleep(_WAIT_S)
        return token_page(scope, 403, Message("This is not the token."))
    answer = RedirectResponse("/", 303)
    answer.set_cookie(*cookie, httponly=True, samesite="strict", path="/", secure=scope.get("scheme") == "https")
    return answer
