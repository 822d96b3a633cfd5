"""What the program asks of the machine: complete files, memory, further packages, certificates."""

import gc
import math
import shutil
import ssl
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from skisnow._support.environment import load_certificate, needed, paused_collector
from skisnow._support.errors import OutputError, ParameterError
from skisnow._support.messages import Message
from skisnow._support.staging import place_to_write, require_writable, write_file
from tests.coded import raises


def test_text_and_bytes(tmp_path: Path) -> None:
    write_file(tmp_path / "new" / "a.txt", "ϑ\n")
    assert (tmp_path / "new" / "a.txt").read_bytes() == "ϑ\n".encode()
    write_file(tmp_path / "new" / "a.txt", b"\x00")
    assert (tmp_path / "new" / "a.txt").read_bytes() == b"\x00"
    assert [path.name for path in (tmp_path / "new").iterdir()] == ["a.txt"]


def test_a_full_disk_leaves_what_was_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target = tmp_path / "a.txt"
    target.write_text("before", encoding="utf-8")

    def full(_handle: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    with raises(OutputError, "cannot_write", reason="No space left on device"):
        write_file(target, "after")
    assert target.read_text(encoding="utf-8") == "before"
    assert [path.name for path in tmp_path.iterdir()] == ["a.txt"]


def test_an_interruption_leaves_no_part_of_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(_handle: int) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("os.fsync", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write_file(tmp_path / "a.txt", "text")
    assert list(tmp_path.iterdir()) == []


def test_whoever_may_enter_the_folder_may_read_the_file(tmp_path: Path) -> None:
    write_file(tmp_path / "a.txt", "text")
    assert (tmp_path / "a.txt").stat().st_mode & 0o777 == 0o644


def test_a_file_filled_by_its_name_has_a_hidden_one_until_it_is_whole(tmp_path: Path) -> None:
    with place_to_write(tmp_path / "a.nc") as place:
        assert place.parent == tmp_path
        assert place.name.startswith(".a.nc.")
        assert place.name.endswith(".partial")
        place.write_bytes(b"whole")
        assert not (tmp_path / "a.nc").exists()
    assert [path.name for path in tmp_path.iterdir()] == ["a.nc"]
    assert (tmp_path / "a.nc").read_bytes() == b"whole"


def test_folders_above_a_file_are_made_and_nothing_stays_open(tmp_path: Path) -> None:
    opened = Path("/proc/self/fd")
    before = len(list(opened.iterdir())) if opened.is_dir() else 0
    for number in range(5):
        write_file(tmp_path / "far" / "away" / f"{number}.txt", "text")
    assert len(list((tmp_path / "far" / "away").iterdir())) == 5
    assert (len(list(opened.iterdir())) if opened.is_dir() else 0) == before


def test_a_folder_is_tried_before_long_work(tmp_path: Path) -> None:
    require_writable(tmp_path / "new" / "folder")
    assert list((tmp_path / "new" / "folder").iterdir()) == []
    (tmp_path / "file").write_text("", encoding="utf-8")
    with raises(OutputError, "cannot_write"):
        require_writable(tmp_path / "file")


@pytest.fixture(autouse=True)
def _as_before() -> Iterator[None]:
    yield
    gc.enable()


def test_it_rests_and_works_again_even_after_an_error() -> None:
    with paused_collector():
        assert not gc.isenabled()
    assert gc.isenabled()

    def failed() -> None:
        with paused_collector():
            raise ValueError

    with pytest.raises(ValueError):
        failed()
    assert gc.isenabled()


def test_one_that_rested_before_continues_resting() -> None:
    gc.disable()
    with paused_collector():
        pass
    assert not gc.isenabled()


def test_a_package_that_is_there_is_given() -> None:
    assert needed("math", extra="none", what=Message("nothing")) is math


def test_a_missing_one_is_named_with_its_extra_and_what_else_can_be_done() -> None:
    with raises(ParameterError, "package_missing", module="skisnow_nowhere", extra="far") as caught:
        needed("skisnow_nowhere", extra="far", what=Message("A far thing"), instead=Message("Or stay here."))
    assert str(caught.value) == (
        "A far thing needs skisnow_nowhere, which cannot be loaded (No module named 'skisnow_nowhere'). "
        "Install it: pip install 'skisnow[far]'. Or stay here."
    )


OPENSSL = shutil.which("openssl")
needs_openssl = pytest.mark.skipif(OPENSSL is None, reason="openssl is not there, which makes the certificates")


def made(folder: Path, *key: str) -> tuple[Path, Path]:
    """A certificate and its private key."""
    cert, own = folder / "cert.pem", folder / "key.pem"
    words = ["req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-subj", "/CN=skisnow", *key]
    subprocess.run([str(OPENSSL), *words, "-keyout", own, "-out", cert], check=True, capture_output=True)
    return cert, own


@needs_openssl
def test_a_certificate_and_its_key_in_two_files_and_in_one(tmp_path: Path) -> None:
    cert, key = made(tmp_path, "-nodes")
    both = tmp_path / "both.pem"
    both.write_bytes(cert.read_bytes() + key.read_bytes())
    for files in ((cert, key), (both,)):
        load_certificate(ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER), *files)
    with pytest.raises(ssl.SSLError):
        load_certificate(ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER), cert)


@needs_openssl
def test_a_key_with_a_password_is_rejected(tmp_path: Path) -> None:
    cert, key = made(tmp_path, "-passout", "pass:secret")
    with pytest.raises(ValueError, match="password"):
        load_certificate(ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER), cert, key)
