"""The page that asks for the token, before anything else; it needs no script."""

from __future__ import annotations

import asyncio
import ipaddress
import math
import time
from collections import OrderedDict, deque
from typing import TYPE_CHECKING, Final
from urllib.parse import parse_qs

from starlette.requests import ClientDisconnect, Request
from starlette.responses import HTMLResponse, RedirectResponse, Response

from .._support.language import catalogue
from .language import language_of_request

if TYPE_CHECKING:
    from collections.abc import Callable

    from starlette.types import Receive, Scope

TOKEN_PATH: Final = "/token"
_LONGEST: Final = 2000
_WAIT_S: Final = 0.5
"""After a wrong token, so that guessing takes long (modelling assumption)."""
TRIES: Final = 10
WITHIN_S: Final = 60.0
"""An address may try so many tokens in so many seconds (modelling assumption)."""
_MOST_ADDRESSES: Final = 10_000

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


class Tries:
    """The tries of the last minute, by address. Right ones count, too: nobody needs ten in a minute."""

    def __init__(self, now: Callable[[], float] = time.monotonic) -> None:
        self._now = now
        self._of = OrderedDict[str, deque[float]]()

    def wait_s(self, address: str) -> float:
        """Count a try; how long its address must wait (s), 0 where it may be looked at."""
        now, times = self._now(), self._of.setdefault(_network(address), deque())
        self._of.move_to_end(_network(address))
        while len(self._of) > _MOST_ADDRESSES:
            self._of.popitem(last=False)
        while times and times[0] <= now - WITHIN_S:
            times.popleft()
        if len(times) >= TRIES:
            return times[0] + WITHIN_S - now
        times.append(now)
        return 0.0


def _network(address: str) -> str:
    """What one person has: an address, or of IPv6 the 64 bits that a network has."""
    try:
        known = ipaddress.ip_address(address)
    except ValueError:
        return address
    return address if known.version == 4 else str(ipaddress.ip_network((int(known) >> 64 << 64, 64)))


def token_page(
    scope: Scope, status: int, sentence: str = "The lab asks for the token that it was started with."
) -> Response:
    """The form, with a sentence above it, in the language of the request."""
    language = language_of_request(Request(scope))
    shown = {"said": sentence, "token": "Token", "open": "Open the lab"}
    words = {name: catalogue(language).translated(text) for name, text in shown.items()}
    page = _PAGE.format(language=language, path=TOKEN_PATH, **words)
    return HTMLResponse(page, status, headers={"cache-control": "no-store"})


def too_many_tries(scope: Scope, wait_s: float) -> Response:
    """The form, with how long to wait."""
    seconds = math.ceil(wait_s)
    answer = token_page(scope, 429, f"Those were {TRIES} tries in a minute. Wait {seconds} seconds, then try again.")
    answer.headers["retry-after"] = str(seconds)
    return answer


async def answer_to_token(
    scope: Scope, receive: Receive, is_token: Callable[[str], bool], cookie: tuple[str, str]
) -> Response:
    """Let in with a cookie, or ask again."""
    body = b""
    try:
        async for piece in Request(scope, receive).stream():
            body += piece
            if len(body) > _LONGEST:
                return token_page(scope, 413, "This is too long for a token.")
    except ClientDisconnect:
        return Response(status_code=400)
    said = parse_qs(body.decode("utf-8", "replace")).get("token", [""])[0]
    if not is_token(said):
        await asyncio.sleep(_WAIT_S)
        return token_page(scope, 403, "This is not the token.")
    answer = RedirectResponse("/", 303)
    answer.set_cookie(*cookie, httponly=True, samesite="strict", path="/", secure=scope.get("scheme") == "https")
    return answer
