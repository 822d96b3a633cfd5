"""What stands before and beside the pages: the guard, uploads and exports, errors, other processes, the server."""

from __future__ import annotations

import errno
import hashlib
import hmac
import io
import logging
import socket
import ssl
import stat
import zipfile
from collections.abc import Callable, Iterator
from logging.handlers import RotatingFileHandler
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, cast

import pytest
import uvicorn
from starlette.datastructures import Headers
from starlette.requests import Request

from skisnow.errors import FieldDataError, OutputError, ParameterError, SkisnowError, StoreError
from skisnow.field.store import Journals, NewEntry, Store, campaign_files, replayed
from skisnow.web import addresses, confined, error_pages, server, transfer, worker
from skisnow.web.addresses import ENCRYPTED, IN_CLEAR, for_others, lab_addresses
from skisnow.web.analyses import Analyses
from skisnow.web.confined import Bounds
from skisnow.web.error_pages import _failed, _notified, error_sentence, log_to, plain_page, reported
from skisnow.web.guard import CONTENT_POLICY, COOKIE, STATUS, Access, Guard
from skisnow.web.server import Certificate, require_allowed, serve
from skisnow.web.settings import Limits
from skisnow.web.slow_requests import PatientToAPoint
from skisnow.web.unpacking import Unpacking, campaign_folder, files_below, shown, write_zip
from skisnow.web.uploaded import UNDESCRIBED, add_uploaded

if TYPE_CHECKING:
    from starlette.types import Message, Receive, Scope, Send

    from .desk import Desk

TOML = """name = "Desk"
[[tool]]
name = "ski piece"
shape = "ski"
length_mm = 200
width_mm = 62
"""
PENETRATION = "experiment,site,tool,edge_angle_deg,load_N,depth_mm\n1,A,ski piece,30,20,1.5\n1,A,ski piece,30,40,2.1\n"
FILES = {"campaign.toml": TOML.encode(), "penetration.csv": PENETRATION.encode()}
REFUSED = "<h1>This was not taken in</h1><p>Nothing was stored: "
HOST = "127.0.0.1:8765"


def packed(files: dict[str, bytes], *, method: int = zipfile.ZIP_DEFLATED, mode: int = 0) -> bytes:
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as archive:
        for name, data in files.items():
            info = zipfile.ZipInfo(name)
            info.external_attr, info.compress_type = mode << 16, method
            archive.writestr(info, data)
    return content.getvalue()


def unpacked(content: bytes) -> dict[str, bytes]:
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def raising(error: Exception) -> Callable[..., object]:
    def work(*_: object) -> object:
        raise error

    return work


# Uploads and exports


@pytest.fixture
def here(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """What was sent is read in this process; gives the limits that it was to be read with."""
    bounds: list[Any] = []

    def done(most: Any, work: Any, *what: Any) -> Any:
        bounds.append(most)
        return work(*what)

    monkeypatch.setattr(transfer, "confined", done)
    return bounds


@pytest.mark.parametrize(
    "sent",
    [
        [("campaign.toml", FILES["campaign.toml"]), ("penetration.csv", FILES["penetration.csv"])],
        [("day/campaign.toml", FILES["campaign.toml"]), ("day/penetration.csv", FILES["penetration.csv"])],
        [("Day.ZIP", packed({f"a/b/{name}": content for name, content in FILES.items()}))],
    ],
    ids=["files", "folder", "zip"],
)
def test_a_campaign_is_taken_in_as_it_is(desk: Desk, here: list[Any], sent: list[tuple[str, bytes]]) -> None:
    answer = desk.post("/import", files=[("files", each) for each in sent])
    (stored,) = desk.lab.store.list()
    assert (answer.status_code, answer.headers["location"]) == (303, f"/?added={stored.id}")
    assert stored.name == "Desk"
    assert [each.seconds for each in here] == [120.0]
    exported = desk.get(f"/export/kept/{stored.id}.zip")
    assert exported.headers["content-type"] == "application/zip"
    assert exported.headers["content-disposition"] == f'attachment; filename="campaign-{stored.id}.zip"'
    assert unpacked(exported.content) == {f"campaign/{name}": content for name, content in FILES.items()}


@pytest.mark.usefixtures("here")
@pytest.mark.parametrize(
    ("files", "told"),
    [
        (
            [("other", ("a.csv", b"x"))],
            "no file was chosen; choose the files of a campaign, its folder, or a zip of it",
        ),
        ([("files", ("a.csv", b"x"))], "there is no campaign.toml in it, nor a workbook (.xlsx) with the sheets "),
        ([("files", ("a.csv", b"x"))] * 201, "at most 200 files at once are taken in."),
        ([("files", ("a.csv", b"x"))] * 2, "two files of the upload are called &#x27;a.csv&#x27;"),
        ([("files", ("a.zip", b"x"))], "the zip file is damaged or of a kind that is not read; pack the folder again"),
    ],
)
def test_what_is_no_campaign_is_told_on_a_page(desk: Desk, files: list[Any], told: str) -> None:
    answer = desk.post("/import", files=files)
    assert answer.status_code == 400
    assert REFUSED + told in answer.text
    assert desk.lab.store.list() == ()


def test_a_form_without_files_is_told_on_a_page(desk: Desk) -> None:
    answer = desk.post("/import", data={"files": "a.csv"})
    assert answer.status_code == 400
    assert f"{REFUSED}no file was chosen" in answer.text


def test_a_campaign_that_is_being_entered_is_given_out_as_it_stands(desk: Desk) -> None:
    journals = Journals(desk.lab.store)
    id_ = journals.begin(TOML)
    cells = {
        "experiment": "1",
        "site": "A",
        "tool": "ski piece",
        "edge_angle_deg": "30",
        "load_N": "20",
        "depth_mm": "1",
    }
    entry = NewEntry(action="add", file="penetration.csv", test="1", cells=cells)
    journals.append(id_, entry, seen=journals.entries(id_)[-1].sequence)
    exported = desk.get(f"/export/entry/{id_}.zip")
    assert exported.headers["content-disposition"] == f'attachment; filename="campaign-{id_}.zip"'
    files = {name: text.encode() for name, text in campaign_files(replayed(journals.entries(id_))).items()}
    found = {name.removeprefix("campaign/"): content for name, content in unpacked(exported.content).items()}
    assert {name: found[name] for name in files} == files
    assert transfer.entry_files(desk.lab, id_).contents == files
    assert b"ski piece" in files["penetration.csv"]


@pytest.mark.parametrize("path", ["/export/kept/ffffffffffff.zip", "/export/entry/..x.zip", "/export/kept/..x.zip"])
def test_what_the_store_has_not_cannot_be_exported(desk: Desk, path: str) -> None:
    answer = desk.get(path)
    assert answer.status_code == 404
    assert "<h1>This cannot be exported</h1>" in answer.text
    assert ("ffffffffffff" in answer.text) is ("ffff" in path)


def test_files_that_no_campaign_reads_are_named_and_not_read(desk: Desk, tmp_path: Path) -> None:
    (tmp_path / "notes").mkdir()
    for name, content in {**FILES, "photo.jpg": b"x", "notes/a.txt": b"x"}.items():
        (tmp_path / name).write_bytes(content)
    id_ = desk.lab.store.add(tmp_path).id
    found = transfer.kept_files(desk.lab, id_)
    assert found.contents == FILES
    assert found.others == ("photo.jpg",)


def numbered(place: Path, *contents: bytes) -> str:
    place.mkdir()
    for number, content in enumerate(contents):
        (place / str(number)).write_bytes(content)
    return str(place)


def test_an_upload_becomes_a_campaign_of_the_store(tmp_path: Path) -> None:
    with Store.open(tmp_path / "store.sqlite3") as store:
        path = store.path
    place = numbered(
        tmp_path / "upload", packed({"day/campaign.toml": FILES["campaign.toml"]}), FILES["penetration.csv"]
    )
    id_ = add_uploaded(path, place, ["a.ZIP", "day/penetration.csv"], Limits())
    with Store.open(path) as store:
        assert [(each.id, each.name) for each in store.list()] == [(id_, "Desk")]
    for number, (content, name) in enumerate(((b"x", "penetration.csv"), (packed({}), "empty.zip"))):
        with pytest.raises(ParameterError) as found:
            add_uploaded(path, numbered(tmp_path / f"other {number}", content), [name], Limits())
        assert str(found.value) == UNDESCRIBED
    with pytest.raises(ParameterError) as found:
        add_uploaded(path, numbered(tmp_path / "book", b"x"), ["book.xlsx"], Limits())
    assert str(found.value) != UNDESCRIBED


# What is unpacked


LIMITS = Limits(upload_bytes=10_000, unpacked_bytes=5_000, files=4)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    place = tmp_path / "inside"
    place.mkdir()
    return place


def taken(folder: Path, files: dict[str, bytes], limits: Limits = LIMITS) -> dict[str, bytes]:
    """What lies in the folder when these were taken one by one."""
    unpacking = Unpacking(folder, limits)
    for name, content in files.items():
        unpacking.take(name, io.BytesIO(content))
    return dict(files_below(folder))


def test_as_many_bytes_and_files_as_allowed_are_taken(folder: Path) -> None:
    files = {"a": bytes(2000), "day/b": bytes(2000), "c": bytes(1000), "d": b""}
    assert taken(folder, files) == files


def test_a_zip_of_as_many_files_and_bytes_as_allowed_is_unpacked(folder: Path) -> None:
    files = {"a": bytes(2000), "day/b": bytes(2000), "c": bytes(1000), "d": b""}
    unpacking = Unpacking(folder, LIMITS)
    unpacking.take_zip(io.BytesIO(packed({**files, "day/": b"", "empty/": b""})))
    assert dict(files_below(folder)) == files
    with pytest.raises(ParameterError, match="more than 4 files at once are not taken in"):
        unpacking.take("e", io.BytesIO(b""))


@pytest.mark.parametrize("method", [zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED])
@pytest.mark.parametrize("mode", [0, stat.S_IFREG | 0o644, 0o644])
def test_plain_files_are_unpacked_however_they_are_packed(folder: Path, method: int, mode: int) -> None:
    Unpacking(folder, LIMITS).take_zip(io.BytesIO(packed({"a": b"1"}, method=method, mode=mode)))
    assert dict(files_below(folder)) == {"a": b"1"}


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (packed({"a": b"x"}, mode=stat.S_IFDIR), "'a' in the zip file is a link or the like, not a plain file"),
        (
            packed({"a": b"x"}, method=zipfile.ZIP_BZIP2),
            "'a' in the zip file is packed in an unusual way; choose Deflate",
        ),
        (packed({"a": bytes(5001)}), "more than 5000 bytes at once are not taken in"),
        (packed(dict.fromkeys("abcde", b"")), "more than 4 files at once are not taken in"),
        (packed({f"{'a/' * 33}b": b""}), f"the file '{'a/' * 33}b' is not taken in: it lies in more than 32 folders"),
        (packed({"b" * 300: b""}), f"the file '{'b' * 79}…' is not taken in: its name is too long"),
        (packed({"a": b"", "a/b": b""}), "two files of the upload are called 'a/b'"),
    ],
)
def test_what_a_zip_may_not_hold(folder: Path, content: bytes, told: str) -> None:
    with pytest.raises(ParameterError) as found:
        Unpacking(folder, LIMITS).take_zip(io.BytesIO(content))
    assert str(found.value) == told


def test_files_within_as_many_folders_as_allowed_are_taken(folder: Path) -> None:
    name = f"{'a/' * 32}b"
    assert taken(folder, {name: b"x"}) == {name: b"x"}
    assert taken(folder, {"day\\c.csv": b"y"}) == {name: b"x", "day/c.csv": b"y"}


def test_a_long_comment_of_a_zip_is_read_past(folder: Path) -> None:
    """The list of files is looked for in what may follow it at most."""
    content = io.BytesIO(packed({"a": b"1"}))
    with zipfile.ZipFile(content, "a") as archive:
        archive.comment = b"c" * 0xFFFF
    Unpacking(folder, LIMITS).take_zip(content)
    assert dict(files_below(folder)) == {"a": b"1"}


def test_a_list_of_files_is_read_up_to_two_thousand_bytes_for_each(folder: Path) -> None:
    def listed(size: int) -> io.BytesIO:
        content = bytearray(packed({"a": b"1"}))
        at = content.rindex(b"PK\5\6") + 12
        content[at : at + 4] = size.to_bytes(4, "little")
        return io.BytesIO(bytes(content))

    with pytest.raises(ParameterError, match="more than 4 files at once are not taken in"):
        Unpacking(folder, LIMITS).take_zip(listed(8001))
    with pytest.raises(ParameterError, match="the zip file is damaged"):
        Unpacking(folder, LIMITS).take_zip(listed(8000))


def test_of_a_large_zip_its_end_alone_is_looked_at_first(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The record at its end has 22 bytes, and a comment of at most 65535."""
    read: list[int] = []

    class Counted(io.BytesIO):
        def read(self, size: int | None = -1, /) -> bytes:
            read.append(len(found := super().read(size)))
            return found

    monkeypatch.setattr(zipfile, "ZipFile", raising(zipfile.BadZipFile("not now")))
    with pytest.raises(ParameterError, match="the zip file is damaged"):
        Unpacking(folder, LIMITS).take_zip(Counted(bytes(100_000) + b"PK\5\6" + bytes(18)))
    assert read == [22 + 65535]


@pytest.mark.parametrize("name", ["con.csv", "a:b", "../a", "/a", "a//b"])
def test_a_name_that_some_system_has_not_is_refused(folder: Path, name: str) -> None:
    with pytest.raises(ParameterError) as found:
        taken(folder, {name: b"x"})
    assert str(found.value).startswith(f"the file '{name}' is not taken in: ")
    assert list(folder.iterdir()) == []


def test_the_campaign_lies_in_the_only_folder_within_the_only_folder(folder: Path) -> None:
    (folder / "a" / "b").mkdir(parents=True)
    (folder / "a" / "b" / "campaign.toml").touch()
    assert campaign_folder(folder) == folder / "a" / "b"
    (folder / "a" / "c").touch()
    assert campaign_folder(folder) == folder / "a"
    (folder / "d").mkdir()
    assert campaign_folder(folder) == folder


def test_files_are_packed_by_name(folder: Path) -> None:
    taken(folder, {"b/c": b"1" * 1000, "a": b"2"})
    assert files_below(folder, under="day") == [("day/a", b"2"), ("day/b/c", b"1" * 1000)]
    content = io.BytesIO()
    write_zip(files_below(folder), content)
    assert unpacked(content.getvalue()) == {"a": b"2", "b/c": b"1" * 1000}
    assert len(content.getvalue()) < 500


def test_a_name_in_a_sentence_is_short_and_prints() -> None:
    assert shown("a\tb") == "'a?b'"
    assert shown("a" * 80) == repr("a" * 80)
    assert shown("a" * 81) == repr("a" * 79 + "…")


def test_a_full_disk_is_not_taken_for_a_name_that_is_too_long(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Path, "open", raising(OSError(errno.ENOSPC, "No space left on device")))
    with pytest.raises(OSError, match="No space left"):
        Unpacking(folder, LIMITS).take("a", io.BytesIO(b"x"))


# The guard


async def greeting(scope: Scope, receive: Receive, send: Send) -> None:
    """Answers with the size of the body; with a policy and a status of its own where the path asks for them."""
    if scope["type"] == "lifespan":
        await send({"type": "lifespan.startup.complete"})
        return
    if scope["type"] == "websocket":
        await send({"type": "websocket.accept"})
        return
    size, more = 0, True
    while more:
        message = await receive()
        size, more = size + len(message.get("body", b"")), message.get("more_body", False)
        if message["type"] == "http.disconnect":
            await send({"type": "disconnected"})
            return
    headers = [(b"content-security-policy", b"own")] if scope["path"] == "/own" else []
    if scope["path"] == "/status":
        scope[STATUS] = 404
    await send({"type": "http.response.start", "status": 200, "headers": headers})
    await send({"type": "http.response.body", "body": str(size).encode()})


class Asked:
    """What the guard sends to a request."""

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
FOREIGN = (403, "Asked for by another site: refused.")
TOO_MUCH = (413, "This is more than the lab takes in at once.")


@pytest.mark.parametrize(
    ("method", "headers", "answer"),
    [
        ("GET", {}, (200, "0")),
        ("HEAD", {}, (200, "0")),
        ("OPTIONS", {}, (200, "0")),
        ("GET", OWN, (200, "0")),
        ("POST", OWN, (200, "0")),
        ("POST", {}, FOREIGN),
        ("PUT", {}, FOREIGN),
        ("GET", {"origin": "http://127.0.0.1"}, FOREIGN),
        ("POST", {"origin": "http://127.0.0.1"}, FOREIGN),
        ("GET", {"host": "evil.example"}, (421, "This address is not one of the lab's.")),
        ("GET", {"host": "LOCALHOST:8765"}, (200, "0")),
        ("GET", {"host": "[::1]:8765"}, (200, "0")),
        ("GET", {"host": "["}, (400, "The Host or the Origin of this request is no address.")),
        ("GET", {"content_length": "100"}, (200, "0")),
        ("GET", {"content_length": "101"}, TOO_MUCH),
        ("GET", {"content_length": "1e1"}, TOO_MUCH),
    ],
)
def test_who_is_answered(desk: Desk, method: str, headers: dict[str, str], answer: tuple[int, str]) -> None:
    assert Asked(desk).status("/", method, **headers) == answer


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
    assert CONTENT_POLICY.split("; ")[0] == "default-src 'none'"


def test_a_socket_of_another_site_is_closed(desk: Desk) -> None:
    lab = Asked(desk)
    assert lab.send("websocket", **OWN) == [{"type": "websocket.accept"}]
    assert lab.received == 0
    for headers in ({}, {"origin": "http://evil.example"}):
        assert lab.send("websocket", **headers) == [{"type": "websocket.close", "code": 1008}]
    assert lab.received == 2
    assert Asked(desk, token="snow").send("websocket", **OWN) == [{"type": "websocket.close", "code": 1008}]
    assert lab.send("lifespan", host="evil.example") == [{"type": "lifespan.startup.complete"}]


def test_the_token_is_asked_for_until_the_cookie_is_there(desk: Desk) -> None:
    lab, cookie = Asked(desk, token="snow"), hmac.new(b"snow", b"skisnow lab", hashlib.sha256).hexdigest()
    for path, method in (("/", "GET"), ("/token", "GET"), ("/", "POST")):
        status, text = lab.status(path, method, **OWN)
        assert (status, "The lab asks for the token that it was started with." in text) == (401, True)
    assert lab.status(cookie=f"{COOKIE}={cookie}") == (200, "0")
    assert lab.send("websocket", cookie=f"a=b; {COOKIE}={cookie}", **OWN) == [{"type": "websocket.accept"}]
    assert lab.status(cookie=f"{COOKIE}=wrong")[0] == 401
    start = lab.send("http", "/token", "POST", b"token=snow", **OWN)[0]
    assert start["status"] == 303
    assert dict(start["headers"])[b"set-cookie"].startswith(f"{COOKIE}={cookie};".encode())
    lab.guard.tries.wait_s = lambda address: 7.2 if address == "a" else 0.0  # type: ignore[method-assign]
    assert lab.send("http", "/token", "POST", b"token=snow", **OWN)[0]["status"] == 429


def test_what_lets_in() -> None:
    alone, shared = Access("127.0.0.1", None, 1), Access("0.0.0.0", "snow", 1)
    assert alone.is_let_in(Headers({}))
    assert not alone.is_token("")
    assert (shared.is_token("snow"), shared.is_token("Snow"), shared.is_token("")) == (True, False, False)
    for cookie in ("", f"{COOKIE}=ü", "other=1", f"{COOKIE}=", "\x00=;;", "a/b=1"):
        assert shared.is_let_in(Headers(raw=[(b"cookie", cookie.encode("latin-1"))])) is False
    assert shared.is_let_in(Headers({"cookie": f"{COOKIE}={shared.cookie}"}))


@pytest.mark.parametrize("other", ["a/b=1", "user[theme]=dark", '{"a": 1}', "é=é", "=", ";"])
def test_a_cookie_of_another_program_on_the_machine_keeps_nobody_out(other: str) -> None:
    access = Access("127.0.0.1", "snow", 1)
    for cookies in (f"{other}; {COOKIE}={access.cookie}", f"{COOKIE}={access.cookie}; {other}"):
        assert access.is_let_in(Headers(raw=[(b"cookie", cookies.encode("latin-1"))]))


def test_names_of_this_machine_are_known_where_others_may_come(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(socket, "gethostname", lambda: "Hut")
    alone, shared = Access("127.0.0.1", None, 1), Access("Lab.Example", "snow", 1)
    names = ("hut", "HUT.local:80", "lab.example:8765", "192.168.1.7", "[fe80::1]:80", "localhost", "127.0.0.1", "::1")
    assert [shared.knows(name) for name in names[:7]] == [True] * 7
    assert [alone.knows(name) for name in names[:7]] == [False] * 5 + [True] * 2
    assert not shared.knows("evil.example")
    assert not shared.knows("")
    assert shared.cookie != Access("Lab.Example", "ice", 1).cookie


# Errors


@pytest.fixture
def log(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A log file of its own."""
    made = logging.getLogger("skisnow.test-of-what-is-guarded")
    monkeypatch.setattr(error_pages, "LOG", made)
    log_to(tmp_path / "new" / "lab.log")
    yield tmp_path / "new" / "lab.log"
    for handler in made.handlers[:]:
        handler.close()
        made.removeHandler(handler)


def test_the_log_keeps_its_last_two_files(log: Path) -> None:
    (handler,) = (each for each in error_pages.LOG.handlers if isinstance(each, RotatingFileHandler))
    assert (handler.maxBytes, handler.backupCount, handler.encoding) == (2_000_000, 1, "utf-8")
    assert (error_pages.LOG.level, error_pages.LOG.propagate) == (logging.INFO, False)
    reference = reported(ValueError("ü"))
    assert len(reference) == 8
    line, *trace = log.read_text(encoding="utf-8").splitlines()
    assert line.endswith(f" ERROR reference {reference}")
    assert trace == ["ValueError: ü"]
    log_to(log)  # the folder is there


def test_an_error_is_said_in_the_corner_of_its_page(desk: Desk) -> None:
    page = desk.open("/replay")
    desk.do(lambda: _notified(StoreError("The disk is full.")), page.client)
    page.told("notify ")
    told = page.scripts[-1]
    for part in ("'message': 'The disk is full.'", "'type': 'negative'", "'multiLine': True", "'timeout': 0"):
        assert part in told
    assert "'closeBtn': 'Close'" in told


@pytest.mark.parametrize(
    ("error", "status", "told"),
    [
        (StoreError("it is not there"), 404, "it is not there"),
        (ParameterError("it cannot be"), 404, "it cannot be"),
        (OutputError("it is full"), 500, "it is full"),
        (ValueError("secret"), 500, "Something went wrong that should not. What was shown as stored is stored. Refer"),
    ],
)
def test_a_page_that_cannot_be_shown_says_why(
    desk: Desk, monkeypatch: pytest.MonkeyPatch, error: Exception, status: int, told: str
) -> None:
    def known(*_: object) -> None:
        raise error

    monkeypatch.setattr(Analyses, "known", known)
    answer = desk.get("/analysis/kept/ffff")
    assert answer.status_code == status
    assert told in answer.text and "This page cannot be shown" in answer.text
    assert "secret" not in answer.text
    assert desk.failures == [error]
    desk.failures.clear()


def test_there_is_no_page_at_a_wrong_address(desk: Desk) -> None:
    for path in ("/nowhere", "/export/kept"):
        answer = desk.get(path)
        assert answer.status_code == 404
        assert "<h1>No such page</h1><p>The lab has no page at this address.</p>" in answer.text
        assert '<a href="/">To the campaigns</a>' in answer.text
        assert "<title>No such page · skisnow</title>" in answer.text
    assert '<html lang="de">' in desk.get("/nowhere", "de").text
    assert "<h1>No such page</h1>" not in desk.get("/nowhere", "de").text


def test_an_answer_that_failed_says_what_it_may(desk: Desk, log: Path) -> None:
    request = Request({"type": "http", "headers": []})
    said = desk.wait(_failed(request, StoreError("it is <full>")))
    assert said.status_code == 500
    assert "<h1>This cannot be shown</h1><p>it is &lt;full&gt;</p>" in bytes(said.body).decode()
    other = desk.wait(_failed(request, ValueError("secret")))
    text = bytes(other.body).decode()
    assert other.status_code == 500
    assert "<h1>This cannot be shown</h1><p>Something went wrong. Reference: " in text
    assert "secret" not in text and "secret" in log.read_text(encoding="utf-8")
    assert plain_page("a", "b", 418, request).status_code == 418
    assert error_sentence(FieldDataError(["it is so"])) == "The campaign cannot be used as it is: it is so"


# Another process


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
    monkeypatch.setattr(confined, "multiprocessing", ends)
    return ends


ENDED = "reading it failed: it is damaged, nested too deep, or takes more than 2.5 s and 3 MB; check the file"


@pytest.mark.parametrize(
    ("answer", "error", "told"),
    [
        ((None, 7, ""), None, ""),
        (None, ParameterError, "it was not read within 2.5 s; give less of it, or check the file"),
        (EOFError(), ParameterError, ENDED),
        ((StoreError, "it is full", ""), StoreError, "it is full"),
        ((ParameterError, "it is so", "a trace"), ParameterError, "it is so"),
    ],
)
def test_what_comes_of_another_process(
    monkeypatch: pytest.MonkeyPatch, answer: Any, error: type[SkisnowError] | None, told: str
) -> None:
    ends, logged, bounds = in_ends(monkeypatch, answer), list[Any](), Bounds(2.5, 3_999_999)
    monkeypatch.setattr(confined, "_LOG", SimpleNamespace(error=lambda *what: logged.append(what)))
    if error is None:
        assert confined.confined(bounds, len, "ab") == 7
    else:
        with pytest.raises(error) as found:
            confined.confined(bounds, len, "ab")
        assert (type(found.value), str(found.value)) == (error, told)
    begun = ["spawn", False, "start", "tells closed", 2.5]
    assert ends.done == [*begun, "kill", "join", "hears closed"]
    assert (ends.process["target"], ends.process["daemon"]) == (confined._work, True)
    assert ends.process["args"][1:] == (bounds, len, ("ab",))
    traced = isinstance(answer, tuple) and answer[2]
    assert logged == ([("an upload could not be read: %s", "a trace")] if traced else [])


class SpecialError(ParameterError):
    """An error that the other side has no class of."""


@pytest.mark.parametrize(
    ("work", "told"),
    [
        (len, (None, 2, "")),
        (raising(FieldDataError(["a", "b"])), (FieldDataError, ["a\nb"], "")),
        (raising(StoreError("s")), (StoreError, "s", "")),
        (raising(OutputError("o")), (OutputError, "o", "")),
        (raising(ParameterError("p")), (ParameterError, "p", "")),
        (raising(SpecialError("q")), (ParameterError, "q", "")),
    ],
)
def test_what_another_process_tells(monkeypatch: pytest.MonkeyPatch, work: Callable[..., object], told: Any) -> None:
    done: list[Any] = []
    monkeypatch.setattr(confined, "end_with_the_server", lambda: done.append("watched"))
    monkeypatch.setattr(confined, "_bind", done.append)
    bounds = Bounds(2.5, 3_000_000)
    confined._work(cast(Any, SimpleNamespace(send=done.append)), bounds, work, ("ab",))
    assert done == ["watched", bounds, told]


def test_an_unforeseen_error_of_another_process_has_a_trace(monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[Any] = []
    monkeypatch.setattr(confined, "end_with_the_server", lambda: None)
    monkeypatch.setattr(confined, "_bind", lambda _: None)
    for letters in (1, 9000):
        work = raising(ValueError("x" * letters))
        confined._work(cast(Any, SimpleNamespace(send=told.append)), Bounds(2.5, 3_000_000), work, ())
    assert [each[:2] for each in told] == [(ParameterError, ENDED)] * 2
    assert told[0][2].startswith("Traceback") and told[0][2].endswith("ValueError: x\n")
    assert len(told[1][2]) == 4000 and told[1][2].endswith("xx\n")


def test_a_process_is_bound_by_the_system(monkeypatch: pytest.MonkeyPatch) -> None:
    resource = pytest.importorskip("resource")
    held: list[Any] = []

    def held_to(kind: int, most: tuple[int, int]) -> None:
        held.append((kind, most))
        if kind != resource.RLIMIT_CORE:
            raise (ValueError if kind == resource.RLIMIT_CPU else OSError)("lower already")

    monkeypatch.setattr(resource, "setrlimit", held_to)
    confined._bind(Bounds(2.5, 3_000_000))
    assert held == [
        (resource.RLIMIT_CPU, (3, 3)),
        (resource.RLIMIT_DATA, (3_000_000, 3_000_000)),
        (resource.RLIMIT_CORE, (0, 0)),
    ]
    bounds = (confined.BOUNDS, confined.OF_A_SKI)
    assert bounds == (Bounds(120.0, 3_000_000_000), Bounds(60.0, 3_000_000_000))


def test_a_process_ends_with_its_server(monkeypatch: pytest.MonkeyPatch) -> None:
    done: list[Any] = []

    def thread(*, target: Callable[[], None], daemon: bool) -> Any:
        done.append(daemon)
        return SimpleNamespace(start=target)

    parent = SimpleNamespace(sentinel=7)
    monkeypatch.setattr(worker, "threading", SimpleNamespace(Thread=thread))
    monkeypatch.setattr(worker, "multiprocessing", SimpleNamespace(parent_process=lambda: parent))
    monkeypatch.setattr(worker, "os", SimpleNamespace(_exit=lambda code: done.append(f"ends with {code}")))
    signals = SimpleNamespace(signal=lambda *what: done.append(what), SIGINT="ctrl-c", SIG_IGN="left out")
    monkeypatch.setattr(worker, "signal", signals)
    monkeypatch.setattr(worker, "wait", done.append)
    worker.end_with_the_server()
    assert done == [("ctrl-c", "left out"), True, [7], "ends with 1"]


# The server


@pytest.mark.parametrize(
    ("host", "token", "told"),
    [
        ("127.0.0.1", None, ""),
        ("localhost", None, ""),
        ("0.0.0.0", "snow", ""),
        ("127.0.0.1", "snow", ""),
        (
            "0.0.0.0",
            None,
            "on 0.0.0.0 other machines could open the lab; add --token with a word that is hard to guess, ",
        ),
        ("127.0.0.1", " ", "the token is blank; give one that is hard to guess, or leave --token out"),
    ],
)
def test_where_others_can_come_in_there_is_a_token(host: str, token: str | None, told: str) -> None:
    if not told:
        require_allowed(host, token)
        return
    with pytest.raises(ParameterError) as found:
        require_allowed(host, token)
    assert str(found.value).startswith(told)


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
    monkeypatch.setattr(server, "_Announced", Announced)
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
    assert config.http is PatientToAPoint
    assert (config.ssl_certfile, config.ssl_keyfile) == (None, None)
    with pytest.raises(ParameterError):
        serve(desk.lab, host="0.0.0.0", port=0, token=None, tell=told.append)
    assert len(announced) == 1


def test_whoever_lets_others_in_is_told_how_they_come(
    desk: Desk, announced: list[Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[str] = []
    secure = SimpleNamespace(file=Path("a.pem"), key=Path("b.pem"))
    monkeypatch.setattr(addresses, "_adapters", lambda _: ["192.168.1.7", "10.0.0.2"])
    for certificate in (None, secure):
        serve(desk.lab, host="0.0.0.0", port=0, token="snow", tell=told.append, certificate=cast(Any, certificate))
    for found, scheme, last in zip(announced, ("http", "https"), (IN_CLEAR, ENCRYPTED), strict=True):
        port = found.place[1]
        assert told[:2] == [f"{scheme}://192.168.1.7:{port}/", f"also: {scheme}://10.0.0.2:{port}/"]
        phone = (
            f"With a phone in the same network: point its camera at the code, or open {scheme}://192.168.1.7:{port}/"
        )
        assert told[3:5] == [phone, last]
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
    made = server._Announced(uvicorn.Config(greeting), lambda: heard.append("begun"))
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
        with pytest.raises(ParameterError) as found:
            Certificate(tmp_path / "a.pem")
        told = f"{tmp_path / 'a.pem'}: no certificate with its private key can be read ("
        assert str(found.value).startswith(told)
        assert str(found.value).endswith("give a PEM file with both, or the key's file with --certificate-key")


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
    ("host", "expected"),
    [("0.0.0.0", ["10.0.0.2", "192.168.1.7"]), ("::", ["10.0.0.2", "fd00::1", "192.168.1.7"])],
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
    monkeypatch.setattr(addresses, "ifaddr", SimpleNamespace(get_adapters=lambda: adapters))
    assert list(addresses._adapters(host)) == expected
    found = {each.split("//")[1] for each in lab_addresses(host, 80, secure=False)}
    assert found == {f"[{each}]:80/" if ":" in each else f"{each}:80/" for each in expected}


def test_a_phone_is_shown_the_way() -> None:
    """A code of 25 modules with an edge of 2, two rows to a line."""
    lines = list(for_others(["http://10.0.0.2:80/", "http://10.0.0.3:80/"], secure=True))
    assert lines[0] == "also: http://10.0.0.3:80/"
    code = lines[1].splitlines()
    assert {len(line) for line in code} == {29} and len(code) == 15
    assert lines[2:] == [
        "With a phone in the same network: point its camera at the code, or open http://10.0.0.2:80/",
        "What goes between the machines is encrypted. A browser asks once whether it may trust a certificate of your "
        "own.",
    ]
    assert list(for_others(["http://10.0.0.2:80/"], secure=False))[-1] == IN_CLEAR
