"""Files in and out: uploads, zips, exports."""

from __future__ import annotations

import io
import stat
import zipfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from skisnow._support.errors import ParameterError
from skisnow.campaign.store import Journals, NewEntry, Store, campaign_files, replay_journal
from skisnow.web import transfer
from skisnow.web.settings import Limits
from skisnow.web.uploads import UNDESCRIBED, Unpacking, add_uploaded, campaign_folder, files_below, shown, write_zip
from tests.coded import raises

from ...campaign_texts import DESK
from ..desk import in_this_process
from .shared import raising

if TYPE_CHECKING:
    from ..desk import Desk

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
def test_a_campaign_is_taken_in_as_it_is(desk: Desk, here: list[Any], sent: list[tuple[str, bytes]]) -> None:
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
def test_what_is_no_campaign_is_refused(desk: Desk, form: dict[str, Any], code: str) -> None:
    assert desk.post("/import", **form).status_code == 400
    assert desk.code == code
    assert desk.lab.store.list() == ()


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
    files = {name: text.encode() for name, text in campaign_files(replay_journal(journals.entries(id_))).items()}
    found = {name.removeprefix("campaign/"): content for name, content in unpacked(exported.content).items()}
    assert {name: found[name] for name in files} == files
    assert transfer.entry_files(desk.lab, id_).contents == files
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


LIMITS = Limits(upload_bytes=10_000, unpacked_bytes=5_000, files=4)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    place = tmp_path / "inside"
    place.mkdir()
    return place


def taken(folder: Path, files: dict[str, bytes], limits: Limits = LIMITS) -> dict[str, bytes]:
    """Contents of the folder when these were taken one by one."""
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
    with raises(ParameterError, "too_many_files", most=4):
        unpacking.take("e", io.BytesIO(b""))


@pytest.mark.parametrize("method", [zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED])
@pytest.mark.parametrize("mode", [0, stat.S_IFREG | 0o644, 0o644])
def test_plain_files_are_unpacked_however_they_are_packed(folder: Path, method: int, mode: int) -> None:
    Unpacking(folder, LIMITS).take_zip(io.BytesIO(packed({"a": b"1"}, method=method, mode=mode)))
    assert dict(files_below(folder)) == {"a": b"1"}


@pytest.mark.parametrize(
    ("content", "code"),
    [
        (packed({"a": b"x"}, mode=stat.S_IFDIR), "not_a_plain_file"),
        (packed({"a": b"x"}, method=zipfile.ZIP_BZIP2), "unknown_compression"),
        (packed({"a": bytes(5001)}), "too_large"),
        (packed(dict.fromkeys("abcde", b"")), "too_many_files"),
        (packed({f"{'a/' * 33}b": b""}), "too_deep"),
        (packed({"b" * 300: b""}), "name_too_long"),
        (packed({"a": b"", "a/b": b""}), "same_name"),
    ],
)
def test_what_a_zip_may_not_hold(folder: Path, content: bytes, code: str) -> None:
    with pytest.raises(ParameterError) as found:
        Unpacking(folder, LIMITS).take_zip(io.BytesIO(content))
    assert found.value.code == code


def test_files_within_as_many_folders_as_allowed_are_taken(folder: Path) -> None:
    name = f"{'a/' * 32}b"
    assert taken(folder, {name: b"x"}) == {name: b"x"}
    assert taken(folder, {"day\\c.csv": b"y"}) == {name: b"x", "day/c.csv": b"y"}


def test_a_long_comment_of_a_zip_is_read_past(folder: Path) -> None:
    """The list of files is searched in what may follow it at most."""
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

    with raises(ParameterError, "too_many_files", most=4):
        Unpacking(folder, LIMITS).take_zip(listed(8001))
    with raises(ParameterError, "damaged"):
        Unpacking(folder, LIMITS).take_zip(listed(8000))


def test_of_a_large_zip_its_end_alone_is_looked_at_first(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The record at its end has 22 bytes, and a comment of at most 65535."""
    read: list[int] = []

    class Counted(io.BytesIO):
        def read(self, size: int | None = -1, /) -> bytes:
            read.append(len(found := super().read(size)))
            return found

    monkeypatch.setattr(zipfile, "ZipFile", raising(zipfile.BadZipFile("not now")))
    with raises(ParameterError, "damaged"):
        Unpacking(folder, LIMITS).take_zip(Counted(bytes(100_000) + b"PK\5\6" + bytes(18)))
    assert read == [22 + 65535]


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
