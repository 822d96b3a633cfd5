"""Input of strangers to the lab's socket: half requests, malformed messages, addresses of nothing."""

from __future__ import annotations

import asyncio
import http.client
import json
import socket
from collections.abc import Iterator
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

import pytest

from .conftest import MISSING, Served
from .finished import finished

if "nicegui" in MISSING:
    pytest.skip("the web lab is not installed", allow_module_level=True)

import uvicorn

from skisnow.web.server import HEAD_BYTES, TimeLimitedProtocol

if TYPE_CHECKING:
    from starlette.types import Receive, Scope, Send


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    """One server for all questions here, none of which changes anything; its errors are read."""
    made = Served(tmp_path_factory.mktemp("lab") / "store.sqlite3").start()
    yield made
    made.kill()


def asked(lab: Served, path: str, body: str | None = None) -> tuple[int, str]:
    parts = urlsplit(lab.address)
    connection = http.client.HTTPConnection(parts.hostname or "", parts.port, timeout=30)
    own = {"Origin": lab.address.rstrip("/"), "Content-Type": "text/plain;charset=UTF-8"}
    connection.request("GET" if body is None else "POST", path, body=body, headers=own)
    answer = connection.getresponse()
    found = answer.status, answer.read().decode()
    connection.close()
    return found


MESSAGES = (
    '42["event"]',
    '42["event",{}]',
    '42["event",{"client_id":[]}]',
    '42["event",7,8,9]',
    '42["handshake",{}]',
    '42["javascript_response",null]',
    '42["ack",{"client_id":1}]',
    '42["log",{}]',
    "42[]",
    '42{"a":1}',
    "4",
    "49",
    "451-",
)


def test_malformed_messages_leave_a_line_each_and_no_trace(lab: Served, capfd: pytest.CaptureFixture[str]) -> None:
    opened = "/_nicegui_ws/socket.io/?EIO=4&transport=polling"
    session = json.loads(asked(lab, opened)[1][1:])["sid"]
    for message in ("40", *MESSAGES):
        asked(lab, f"{opened}&sid={session}", message)
    nobody = json.loads(asked(lab, f"{opened}&implicit_handshake=true")[1][1:])["sid"]
    asked(lab, f"{opened}&sid={nobody}", "40")
    assert asked(lab, "/")[0] == 200
    log = (lab.store.parent / "lab" / "lab.log").read_text(encoding="utf-8")
    for kind in ("connect", "event"):
        assert log.count(f"malformed {kind} (KeyError)") == 1
    assert "Traceback" not in log
    assert "Traceback" not in capfd.readouterr().err


async def greeting(_: Scope, receive: Receive, send: Send) -> None:
    while (await receive()).get("more_body"):
        pass
    await send({"type": "http.response.start", "status": 200, "headers": [(b"content-length", b"2")]})
    await send({"type": "http.response.body", "body": b"hi"})


class Hasty(TimeLimitedProtocol):
    head_s = 0.2
    body_s = 0.3


@pytest.mark.parametrize(
    "sent",
    [
        b"",
        b"GET / HT",
        b"GET / HTTP/1.1\r\nHost: x\r\n\r\nGET / HTTP/1.1\r\nHo",
        b"POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 9\r\n\r\nhalf",
        b"GET / HTTP/1.1\r\nA: " + HEAD_BYTES * b"a",
    ],
    ids=["nothing", "half a line", "a second half", "half a body", "an endless head"],
)
def test_half_a_request_is_not_waited_for(sent: bytes) -> None:
    """The end of the stream comes from the server; without it the test would wait for ever."""

    async def talk() -> bytes:
        with socket.create_server(("127.0.0.1", 0)) as listener:
            config = uvicorn.Config(
                greeting, http=Hasty, ws="none", lifespan="off", log_level="critical", timeout_keep_alive=600
            )
            server = uvicorn.Server(config)
            serving = asyncio.create_task(server.serve(sockets=[listener]))
            reader, writer = await asyncio.open_connection(*listener.getsockname())
            writer.write(sent)
            heard = await asyncio.wait_for(reader.read(), 60)
            writer.close()
            server.should_exit = True
            await serving
            return heard

    heard = finished(talk())
    assert heard.count(b"hi") == (1 if b"\r\n\r\nGET" in sent else 0)


def upload(lab: Served, path: str, name: str, content: bytes, **fields: str) -> tuple[int, str]:
    parts = urlsplit(lab.address)
    connection = http.client.HTTPConnection(parts.hostname or "", parts.port, timeout=300)
    texts = "".join(
        f'--cut\r\nContent-Disposition: form-data; name="{key}"\r\n\r\n{text}\r\n' for key, text in fields.items()
    )
    head = f'--cut\r\nContent-Disposition: form-data; name="file{"s" if path == "/import" else ""}"; filename="{name}"'
    body = texts.encode() + head.encode() + b"\r\n\r\n" + content + b"\r\n--cut--\r\n"
    own = {"Origin": lab.address.rstrip("/"), "Content-Type": "multipart/form-data; boundary=cut"}
    connection.request("POST", path, body=body, headers=own)
    answer = connection.getresponse()
    found = answer.status, answer.read().decode()
    connection.close()
    return found


def test_a_track_that_ends_its_reader_does_not_end_the_lab(lab: Served) -> None:
    depth = 200_000
    content = b"<?xml version='1.0'?>" + depth * b"<gpx>" + depth * b"</gpx>"
    status, _ = upload(lab, "/replay/track", "deep.gpx", content, azimuth="180")
    assert status == 400
    assert asked(lab, "/")[0] == 200


def test_a_zip_that_is_none_is_refused_by_its_reader(lab: Served) -> None:
    status, _ = upload(lab, "/import", "campaign.zip", b"PK\x03\x04 and nothing")
    assert status == 400
    assert asked(lab, "/")[0] == 200
