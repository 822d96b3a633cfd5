"""Uploads reach their folder and nothing else."""

from __future__ import annotations

import io
import stat
import zipfile
from pathlib import Path

import pytest

from skisnow.errors import ParameterError
from skisnow.web.settings import Limits
from skisnow.web.unpacking import Unpacking, campaign_folder, files_below, write_zip

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


def test_a_campaign_comes_back_as_it_was(folder: Path) -> None:
    files = {"day/campaign.toml": b"a = 1\r\n", "day/notes/one.txt": bytes(range(256))}
    Unpacking(folder, LIMITS).take_zip(packed(files))
    assert campaign_folder(folder) == folder / "day"
    again = io.BytesIO()
    write_zip(files_below(folder / "day", under="day"), again)
    with zipfile.ZipFile(again) as archive:
        assert {name: archive.read(name) for name in archive.namelist()} == files


@pytest.mark.parametrize(
    "name",
    ["../outside", "a/../../outside", "/tmp/outside", "C:/outside", "..\\outside", "a//b", "con.csv", "a\0b", ""],
)
def test_names_that_lead_elsewhere_are_refused(folder: Path, name: str) -> None:
    with pytest.raises(ParameterError, match="is not taken in"):
        Unpacking(folder, LIMITS).take(name, io.BytesIO(b"x"))
    assert not any(folder.iterdir())
    assert [path.name for path in folder.parent.iterdir()] == ["inside"]


@pytest.mark.parametrize("name", ["../outside", "/outside", "..\\outside"])
def test_a_zip_writes_nothing_outside(folder: Path, name: str) -> None:
    with pytest.raises(ParameterError, match="is not taken in"):
        Unpacking(folder, LIMITS).take_zip(packed({name: b"x"}))
    assert [path.name for path in folder.parent.iterdir()] == ["inside"]


def test_links_are_refused(folder: Path) -> None:
    with pytest.raises(ParameterError, match="link"):
        Unpacking(folder, LIMITS).take_zip(packed({"a": b"/etc/passwd"}, attributes=stat.S_IFLNK | 0o777))


def test_a_bomb_is_stopped_while_it_unpacks(folder: Path) -> None:
    bomb = packed({"zeros": bytes(10_000_000)})
    assert len(bomb.getvalue()) < LIMITS.upload_bytes * 2
    with pytest.raises(ParameterError, match="more than 5000 bytes"):
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
    with pytest.raises(ParameterError, match="more than 5000 bytes"):
        unpacking.take("b", io.BytesIO(bytes(3000)))


def test_no_more_files_than_allowed(folder: Path) -> None:
    with pytest.raises(ParameterError, match="more than 4 files"):
        Unpacking(folder, LIMITS).take_zip(packed({str(number): b"" for number in range(5)}))
    assert not any(folder.iterdir())


def test_two_files_of_one_name_are_refused(folder: Path) -> None:
    unpacking = Unpacking(folder, LIMITS)
    unpacking.take("a", io.BytesIO(b"first"))
    with pytest.raises(ParameterError, match="two files"):
        unpacking.take("a", io.BytesIO(b"second"))
    assert (folder / "a").read_bytes() == b"first"


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 no zip", b"x" * 500])
def test_what_is_no_zip_is_said_to_be_none(folder: Path, content: bytes) -> None:
    with pytest.raises(ParameterError, match="zip file is damaged"):
        Unpacking(folder, LIMITS).take_zip(io.BytesIO(content))


def test_a_broken_member_is_said(folder: Path) -> None:
    content = bytearray(packed({"a": bytes(range(256)) * 8}).getvalue())
    content[60:80] = bytes(20)
    with pytest.raises(ParameterError, match="zip file is damaged"):
        Unpacking(folder, LIMITS).take_zip(io.BytesIO(bytes(content)))


@pytest.mark.parametrize(("flag", "refused"), [(0x001, True), (0x009, True), (0x800, False), (0x002, False)])
def test_an_encrypted_member_is_refused_and_no_other_flag(folder: Path, flag: int, refused: bool) -> None:
    """Bit 0 of the flags says that a member is encrypted; bit 11 that its name is UTF-8, bit 1 how it was packed."""
    content = bytearray(packed({"a.csv": b"1,2\n"}).getvalue())
    for signature, offset in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        place = content.index(signature) + offset
        content[place : place + 2] = flag.to_bytes(2, "little")
    taking = Unpacking(folder, LIMITS)
    if refused:
        with pytest.raises(ParameterError, match="encrypted; pack it without a password"):
            taking.take_zip(io.BytesIO(bytes(content)))
        assert not any(folder.iterdir())
    else:
        taking.take_zip(io.BytesIO(bytes(content)))
        assert (folder / "a.csv").read_bytes() == b"1,2\n"
