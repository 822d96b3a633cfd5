"""Files in and out: uploads, zips, exports."""

import errno
import io
import stat
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from skisnow._support.errors import ParameterError
from skisnow.campaign.store import Journals, NewEntry, Store, campaign_files, replay_journal
from skisnow.web import transfer
from skisnow.web.settings import Limits
from skisnow.web.uploads import UNDESCRIBED, Unpacking, add_uploaded, campaign_folder, files_below
from tests.coded import Coded, coded, raises

from ...campaign_texts import DESK
from ..desk import Desk, in_this_process

TOML = DESK
PENETRATION = "experiment,site,tool,edge_angle_deg,load_N,depth_mm\n1,A,ski piece,30,20,1.5\n1,A,ski piece,30,40,2.1\n"
FILES = {"campaign.toml": TOML.encode(), "penetration.csv": PENETRATION.encode()}


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


@pytest.fixture
def here(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """Read sent files in this process; gives limits, work and its arguments."""
    return in_this_process(monkeypatch, "transfer")


@pytest.mark.parametrize(
    "sent",
    [
        [("campaign.toml", FILES["campaign.toml"]), ("penetration.csv", FILES["penetration.csv"])],
        [("day/campaign.toml", FILES["campaign.toml"]), ("day/penetration.csv", FILES["penetration.csv"])],
        [("Day.ZIP", packed({f"a/b/{name}": content for name, content in FILES.items()}))],
    ],
    ids=["files", "folder", "zip"],
)
def test_a_campaign_is_imported_as_it_is(desk: Desk, here: list[Any], sent: list[tuple[str, bytes]]) -> None:
    answer = desk.post("/import", files=[("files", each) for each in sent])
    (stored,) = desk.lab.store.list()
    assert (answer.status_code, answer.headers["location"]) == (303, f"/?added={stored.id}")
    assert stored.name == "Desk"
    assert [bounds.seconds for bounds, *_ in here] == [120.0]
    exported = desk.get(f"/export/kept/{stored.id}.zip")
    assert exported.headers["content-type"] == "application/zip"
    assert exported.headers["content-disposition"] == f'attachment; filename="campaign-{stored.id}.zip"'
    assert unpacked(exported.content) == {f"campaign/{name}": content for name, content in FILES.items()}


@pytest.mark.usefixtures("here")
@pytest.mark.parametrize(
    ("form", "code"),
    [
        ({"files": [("other", ("a.csv", b"x"))]}, "no_file"),
        ({"files": [("files", ("a.dat", b"x"))]}, "no_campaign"),
        ({"files": [("files", ("a.csv", b"x"))] * 201}, ""),
        ({"files": [("files", ("a.csv", b"x"))] * 2}, "same_name"),
        ({"files": [("files", ("a.zip", b"x"))]}, "damaged"),
        ({"data": {"files": "a.csv"}}, "no_file"),
    ],
)
def test_an_invalid_campaign_is_rejected(desk: Desk, form: dict[str, Any], code: str) -> None:
    assert desk.post("/import", **form).status_code == 400
    assert desk.code == code
    assert desk.lab.store.list() == ()


def test_a_campaign_that_is_being_entered_is_given_out_as_it_stands(desk: Desk) -> None:
    journals = Journals(desk.lab.store)
    id_ = journals.begin(TOML)
    cells = {
        "experiment": "1", "site": "A", "tool": "ski piece", "edge_angle_deg": "30", "load_N": "20", "depth_mm": "1",
    }  # fmt: skip
    entry = NewEntry(action="add", file="penetration.csv", test="1", cells=cells)
    journals.append(id_, entry, seen=journals.entries(id_)[-1].sequence)
    exported = desk.get(f"/export/entry/{id_}.zip")
    assert exported.headers["content-disposition"] == f'attachment; filename="campaign-{id_}.zip"'
    files = {name: text.encode() for name, text in campaign_files(replay_journal(journals.entries(id_))).items()}
    found = {name.removeprefix("campaign/"): content for name, content in unpacked(exported.content).items()}
    assert {name: found[name] for name in files} == files
    assert transfer.files_in_memory(desk.lab, "entry", id_).contents == files
    assert b"ski piece" in files["penetration.csv"]


@pytest.mark.parametrize(
    ("id_", "code"), [("kept/ffffffffffff", "unknown_id"), ("entry/..x", "no_campaign"), ("kept/..x", "no_campaign")]
)
def test_what_the_store_has_not_cannot_be_exported(desk: Desk, id_: str, code: str) -> None:
    assert desk.get(f"/export/{id_}.zip").status_code == 404
    assert desk.code == code


def test_files_that_no_campaign_reads_are_named_and_not_read(desk: Desk, tmp_path: Path) -> None:
    (tmp_path / "notes").mkdir()
    for name, content in {**FILES, "photo.jpg": b"x", "notes/a.txt": b"x"}.items():
        (tmp_path / name).write_bytes(content)
    id_ = desk.lab.store.add(tmp_path).id
    found = transfer.files_in_memory(desk.lab, "kept", id_)
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


LIMITS = Limits(upload_bytes=10_000, unpacked_bytes=5_000, files=4)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    place = tmp_path / "inside"
    place.mkdir()
    return place


def test_a_zip_of_as_many_files_and_bytes_as_allowed_is_unpacked(folder: Path) -> None:
    files = {"a": bytes(2000), "day/b": bytes(2000), "c": bytes(1000), "d": b""}
    unpacking = Unpacking(folder, LIMITS)
    unpacking.take_zip(io.BytesIO(packed({**files, "day/": b"", "empty/": b""})))
    assert dict(files_below(folder)) == files
    with raises(ParameterError, "too_many_files", most=4):
        unpacking.take("e", io.BytesIO(b""))


@pytest.mark.parametrize("method", [zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED])
@pytest.mark.parametrize("mode", [0, stat.S_IFREG | 0o644, 0o644])
def test_plain_files_are_unpacked_however_they_are_packed(folder: Path, method: int, mode: int) -> None:
    Unpacking(folder, LIMITS).take_zip(io.BytesIO(packed({"a": b"1"}, method=method, mode=mode)))
    assert dict(files_below(folder)) == {"a": b"1"}


def changed(content: bytes, change: Callable[[bytearray], None]) -> bytes:
    """A zip with some bytes of its list of files changed, after the signature ``PK 1 2``."""
    data = bytearray(content)
    at = data.index(b"PK\x01\x02")
    entry = data[at:]
    change(entry)
    data[at:] = entry
    return bytes(data)


def _no_name(entry: bytearray) -> None:
    entry[28:30] = b"\0\0"
    del entry[46:53]
    end = entry.index(b"PK\x05\x06")
    entry[end + 12 : end + 16] = (46).to_bytes(4, "little")


def _set(at: int, value: bytes) -> Callable[[bytearray], None]:
    def change(entry: bytearray) -> None:
        entry[at : at + len(value)] = value

    return change


INNER = packed({"inner/a": bytes(range(256)) * 8})
BOMB = packed({"zeros": bytes(10_000_000)})
LYING = packed({"zeros": bytes(100_000)}).replace((100_000).to_bytes(4, "little"), (10).to_bytes(4, "little"))
FORBIDDEN: dict[str, tuple[bytes, str | Coded]] = {
    "a folder": (packed({"a": b"x"}, mode=stat.S_IFDIR), "damaged"),
    "a link": (packed({"a": b"/etc/passwd"}, mode=stat.S_IFLNK | 0o777), "damaged"),
    "nothing": (b"", "damaged"),
    "no zip": (b"PK\x03\x04 no zip", "damaged"),
    "letters": (b"x" * 500, "damaged"),
    "bzip2": (packed({"a": b"x"}, method=zipfile.ZIP_BZIP2), "damaged"),
    "a byte too much": (packed({"a": bytes(5001)}), "too_large"),
    "a bomb": (BOMB, coded("too_large", most=5000)),
    "other sizes than stated": (LYING, "damaged"),
    "a file too much": (packed(dict.fromkeys("abcde", b"")), "too_many_files"),
    "a name twice": (packed({"a": b"", "a/b": b""}), "same_name"),
    "a broken file": (INNER[:60] + bytes(20) + INNER[80:], "damaged"),
    **{name: (packed({name: b"x"}), "not_taken_in") for name in ("../outside", "/outside", "..\\outside")},
    "encrypted": (changed(INNER, _set(8, b"\x01\x00")), "damaged"),
    "patched": (changed(INNER, _set(8, b"\x20\x00")), "damaged"),
    "lzma": (changed(INNER, _set(10, b"\x0e\x00")), "damaged"),
    "an unknown method": (changed(INNER, _set(10, b"\x63\x00")), "damaged"),
    "elsewhere": (changed(INNER, _set(42, b"\xff\xff\xff\xff")), "damaged"),
    "a zero in a name": (changed(INNER, _set(46, b"inner\0/")), "damaged"),
    "no UTF-8": (changed(changed(INNER, _set(8, b"\x00\x08")), _set(46, b"\xff\xfe")), "damaged"),
    "no name": (changed(INNER, _no_name), coded("not_taken_in", file="''")),
}


@pytest.mark.parametrize(("content", "told"), FORBIDDEN.values(), ids=FORBIDDEN)
def test_forbidden_contents_of_a_zip_are_rejected(folder: Path, content: bytes, told: str | Coded) -> None:
    """Nothing is written outside, and no more than is allowed."""
    with raises(ParameterError, told):
        Unpacking(folder, LIMITS).take_zip(io.BytesIO(content))
    assert [path.name for path in folder.parent.iterdir()] == ["inside"]
    assert sum(path.stat().st_size for path in folder.rglob("*") if path.is_file()) <= LIMITS.unpacked_bytes


def test_the_campaign_lies_in_the_only_folder_within_the_only_folder(folder: Path) -> None:
    (folder / "a" / "b").mkdir(parents=True)
    (folder / "a" / "b" / "campaign.toml").touch()
    assert campaign_folder(folder) == folder / "a" / "b"
    (folder / "a" / "c").touch()
    assert campaign_folder(folder) == folder / "a"
    (folder / "d").mkdir()
    assert campaign_folder(folder) == folder


@pytest.mark.parametrize(
    "name",
    ["../outside", "a/../../outside", "/tmp/outside", "C:/outside", "..\\outside", "a//b", "con.csv", "a\0b", ""],
)
def test_names_that_lead_elsewhere_are_rejected(folder: Path, name: str) -> None:
    with raises(ParameterError, "not_taken_in"):
        Unpacking(folder, LIMITS).take(name, io.BytesIO(b"x"))
    assert not any(folder.iterdir())
    assert [path.name for path in folder.parent.iterdir()] == ["inside"]


def test_limits_hold_over_several_files(folder: Path) -> None:
    unpacking = Unpacking(folder, LIMITS)
    unpacking.take("a", io.BytesIO(bytes(3000)))
    with raises(ParameterError, "too_large", most=5000):
        unpacking.take("b", io.BytesIO(bytes(3000)))


def test_two_files_of_one_name_are_rejected(folder: Path) -> None:
    unpacking = Unpacking(folder, LIMITS)
    unpacking.take("a", io.BytesIO(b"first"))
    with raises(ParameterError, "same_name"):
        unpacking.take("a", io.BytesIO(b"second"))
    assert (folder / "a").read_bytes() == b"first"


def test_a_full_disk_is_not_taken_for_a_damaged_zip(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(_self: Path, _mode: str) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(Path, "open", full)
    with pytest.raises(OSError, match="No space left"):
        Unpacking(folder, LIMITS).take_zip(io.BytesIO(packed({"a": b"x"})))
