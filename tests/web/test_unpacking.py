"""Uploads reach their folder and nothing else."""

from __future__ import annotations

import errno
import io
import stat
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

from skisnow._support.errors import ParameterError
from skisnow.web.settings import Limits
from skisnow.web.uploads import Unpacking
from tests.coded import Coded, coded, raises

LIMITS = Limits(upload_bytes=10_000, unpacked_bytes=5_000, files=4)


def packed(files: dict[str, bytes], *, attributes: int = 0) -> io.BytesIO:
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            info = zipfile.ZipInfo(name)
            info.external_attr = attributes << 16
            info.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(info, data)
    content.seek(0)
    return content


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    place = tmp_path / "inside"
    place.mkdir()
    return place


@pytest.mark.parametrize(
    "name",
    ["../outside", "a/../../outside", "/tmp/outside", "C:/outside", "..\\outside", "a//b", "con.csv", "a\0b", ""],
)
def test_names_that_lead_elsewhere_are_refused(folder: Path, name: str) -> None:
    with raises(ParameterError, "not_taken_in"):
        Unpacking(folder, LIMITS).take(name, io.BytesIO(b"x"))
    assert not any(folder.iterdir())
    assert [path.name for path in folder.parent.iterdir()] == ["inside"]


@pytest.mark.parametrize("name", ["../outside", "/outside", "..\\outside"])
def test_a_zip_writes_nothing_outside(folder: Path, name: str) -> None:
    with raises(ParameterError, "not_taken_in"):
        Unpacking(folder, LIMITS).take_zip(packed({name: b"x"}))
    assert [path.name for path in folder.parent.iterdir()] == ["inside"]


def test_links_are_refused(folder: Path) -> None:
    with raises(ParameterError, "not_a_plain_file"):
        Unpacking(folder, LIMITS).take_zip(packed({"a": b"/etc/passwd"}, attributes=stat.S_IFLNK | 0o777))


def test_a_bomb_is_stopped_while_it_unpacks(folder: Path) -> None:
    bomb = packed({"zeros": bytes(10_000_000)})
    assert len(bomb.getvalue()) < LIMITS.upload_bytes * 2
    with raises(ParameterError, "too_large", most=5000):
        Unpacking(folder, LIMITS).take_zip(bomb)
    assert (folder / "zeros").stat().st_size <= LIMITS.unpacked_bytes


def test_a_zip_that_lies_about_its_sizes_is_no_way_around(folder: Path) -> None:
    content = packed({"zeros": bytes(100_000)}).getvalue()
    lying = content.replace((100_000).to_bytes(4, "little"), (10).to_bytes(4, "little"))
    assert lying != content
    with pytest.raises(ParameterError):
        Unpacking(folder, LIMITS).take_zip(io.BytesIO(lying))
    assert sum(path.stat().st_size for path in folder.iterdir()) <= LIMITS.unpacked_bytes


def test_limits_hold_over_several_files(folder: Path) -> None:
    unpacking = Unpacking(folder, LIMITS)
    unpacking.take("a", io.BytesIO(bytes(3000)))
    with raises(ParameterError, "too_large", most=5000):
        unpacking.take("b", io.BytesIO(bytes(3000)))


def test_two_files_of_one_name_are_refused(folder: Path) -> None:
    unpacking = Unpacking(folder, LIMITS)
    unpacking.take("a", io.BytesIO(b"first"))
    with raises(ParameterError, "same_name"):
        unpacking.take("a", io.BytesIO(b"second"))
    assert (folder / "a").read_bytes() == b"first"


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 no zip", b"x" * 500])
def test_what_is_no_zip_is_said_to_be_none(folder: Path, content: bytes) -> None:
    with raises(ParameterError, "damaged"):
        Unpacking(folder, LIMITS).take_zip(io.BytesIO(content))


def test_a_broken_member_is_said(folder: Path) -> None:
    content = bytearray(packed({"a": bytes(range(256)) * 8}).getvalue())
    content[60:80] = bytes(20)
    with raises(ParameterError, "damaged"):
        Unpacking(folder, LIMITS).take_zip(io.BytesIO(bytes(content)))


def changed(content: bytes, change: Callable[[bytearray], None]) -> io.BytesIO:
    """A zip with some bytes of its list of files changed, after the signature ``PK 1 2``."""
    data = bytearray(content)
    at = data.index(b"PK\x01\x02")
    entry = data[at:]
    change(entry)
    data[at:] = entry
    return io.BytesIO(bytes(data))


def _no_name(entry: bytearray) -> None:
    entry[28:30] = b"\0\0"
    del entry[46:53]
    end = entry.index(b"PK\x05\x06")
    entry[end + 12 : end + 16] = (46).to_bytes(4, "little")


def _set(at: int, value: bytes) -> Callable[[bytearray], None]:
    def change(entry: bytearray) -> None:
        entry[at : at + len(value)] = value

    return change


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (_set(8, b"\x01\x00"), "encrypted"),
        (_set(8, b"\x20\x00"), "damaged"),
        (_set(10, b"\x0e\x00"), "unknown_compression"),
        (_set(10, b"\x63\x00"), "unknown_compression"),
        (_set(42, b"\xff\xff\xff\xff"), "damaged"),
        (_set(46, b"inner\0/"), "damaged"),
        (lambda entry: (_set(8, b"\x00\x08")(entry), _set(46, b"\xff\xfe")(entry))[0], "damaged"),
        (_no_name, coded("not_taken_in", file="''")),
    ],
)
def test_damage_in_the_list_of_files_is_said(
    folder: Path, change: Callable[[bytearray], None], told: str | Coded
) -> None:
    content = changed(packed({"inner/a": bytes(range(256)) * 8}).getvalue(), change)
    with raises(ParameterError, told):
        Unpacking(folder, LIMITS).take_zip(content)


def test_a_list_of_millions_of_files_is_not_read(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    content = packed({f"{number:04}{'x' * 100}": b"" for number in range(60)})
    monkeypatch.setattr(zipfile, "ZipFile", None)  # not even opened
    with raises(ParameterError, "too_many_files", most=4):
        Unpacking(folder, LIMITS).take_zip(content)


def test_a_full_disk_is_not_taken_for_a_damaged_zip(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(_self: Path, _mode: str) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(Path, "open", full)
    with pytest.raises(OSError, match="No space left"):
        Unpacking(folder, LIMITS).take_zip(packed({"a": b"x"}))
