"""Files that are written and read, and stages of several files."""

import gc
import math
import os
import shutil
import signal
import ssl
import subprocess
from collections.abc import Iterator
from pathlib import Path
from threading import Thread

import pytest

from skisnow._support.environment import import_extra, load_certificate, paused_collector
from skisnow._support.errors import OutputError, ParameterError
from skisnow._support.messages import Message
from skisnow._support.staging import place_to_write, prepare_folder, require_writable, staged, write_file
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
    before = open_files()
    for number in range(5):
        write_file(tmp_path / "far" / "away" / f"{number}.txt", "text")
    assert len(list((tmp_path / "far" / "away").iterdir())) == 5
    assert open_files() == before


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
    assert import_extra("math", extra="none", what=Message("nothing")) is math


def test_a_missing_one_is_named_with_its_extra_and_what_else_can_be_done() -> None:
    with raises(ParameterError, "package_missing", module="skisnow_nowhere", extra="far") as caught:
        import_extra("skisnow_nowhere", extra="far", what=Message("A far thing"), instead=Message("Or stay here."))
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


# Files that belong together: never parts of two writings, wherever a process is killed


OLD = {"summary": "old", "track": "old", "figures/a": "old", "figures/b": "old"}
NEW = {"summary": "new", "track": "new", "figures/a": "new", "page": "new"}
OWN = {"notes": "the user's"}


def write(folder: Path, files: dict[str, str]) -> None:
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")


def seen(folder: Path) -> dict[str, str]:
    """The folders that a user sees: no hidden ones."""
    files = (path for path in folder.rglob("*") if path.is_file())
    return {
        name: path.read_text(encoding="utf-8")
        for path in files
        if not (name := path.relative_to(folder).as_posix()).startswith(".")
    }


def replace_old_by_new(folder: Path) -> None:
    with staged(folder, last="summary") as stage:
        stage.stale.append("figures/b")
        write(stage.path, NEW)


def test_new_files_take_the_place_of_old_ones(tmp_path: Path) -> None:
    write(tmp_path, OLD | OWN)
    replace_old_by_new(tmp_path)
    assert seen(tmp_path) == NEW | OWN
    assert prepare_folder(tmp_path) == []


@pytest.mark.parametrize("name", ["track", "figures/b"])
def test_a_file_that_no_earlier_run_wrote_is_kept(tmp_path: Path, name: str) -> None:
    write(tmp_path, {name: "own"})
    with raises(OutputError, "file_kept"):
        replace_old_by_new(tmp_path)
    assert seen(tmp_path) == {name: "own"}


def test_an_error_before_the_end_leaves_the_old_ones(tmp_path: Path) -> None:
    write(tmp_path, OLD)
    with pytest.raises(ZeroDivisionError), staged(tmp_path, last="summary") as stage:
        write(stage.path, NEW)
        raise ZeroDivisionError
    assert seen(tmp_path) == OLD
    assert list(tmp_path.glob(".*")) == []


def killed_at(folder: Path, step: int) -> bool:
    """Replace old by new in a process that is killed before its n-th change of the folder; whether it was."""
    child = os.fork()
    if child == 0:
        left = step

        def counted(name: str) -> None:
            original = getattr(Path, name)

            def change(*given: object, **named: object) -> object:
                nonlocal left
                left -= 1
                if left < 0:
                    os.kill(os.getpid(), signal.SIGKILL)
                return original(*given, **named)

            setattr(Path, name, change)

        for name in ("unlink", "replace", "mkdir", "touch"):
            counted(name)
        try:
            replace_old_by_new(folder)
        finally:
            os._exit(0)
    _, status = os.waitpid(child, 0)
    return os.WIFSIGNALED(status)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
def test_a_kill_at_any_step_leaves_no_parts_of_two(tmp_path: Path) -> None:
    kept, finished = 0, 0
    for step in range(100):
        folder = tmp_path / str(step)
        write(folder, OLD | OWN)
        was_killed = killed_at(folder, step)
        found = seen(folder)
        assert len(set(found.values())) <= 2, found  # the user's own, and those of one writing
        assert found["notes"] == "the user's"
        assert "summary" not in found or found in (OLD | OWN, NEW | OWN)
        said = prepare_folder(folder)
        assert len(said) == was_killed
        assert list(folder.glob(".*")) == []
        assert seen(folder) in (OLD | OWN, NEW | OWN)
        kept += was_killed and seen(folder) == OLD | OWN
        finished += was_killed and seen(folder) == NEW | OWN
        if not was_killed:
            break
    assert kept > 0
    assert finished > 5


def test_folders_that_an_earlier_version_left_are_removed(tmp_path: Path) -> None:
    for name in (".report-ab12_xyz", ".run-00000000"):
        (tmp_path / name / "figures").mkdir(parents=True)
    (tmp_path / ".report-of-mine").mkdir()
    assert sorted(prepare_folder(tmp_path)) == [
        f"{tmp_path / '.report-ab12_xyz'} was left by a process that was killed; it is removed",
        f"{tmp_path / '.run-00000000'} was left by a process that was killed; it is removed",
    ]
    assert [path.name for path in tmp_path.iterdir()] == [".report-of-mine"]


def test_what_another_process_is_writing_stays(tmp_path: Path) -> None:
    with staged(tmp_path, last="summary") as stage:
        write(stage.path, NEW)
        assert prepare_folder(tmp_path) == []
    assert seen(tmp_path) == NEW


def open_files() -> int:
    """Of this process, where the system tells."""
    place = Path("/proc/self/fd")
    return len(list(place.iterdir())) if place.is_dir() else 0


def test_no_file_stays_open(tmp_path: Path) -> None:
    before = open_files()
    for _ in range(3):
        replace_old_by_new(tmp_path)
        (tmp_path / ".run-00000000").mkdir()
        assert len(prepare_folder(tmp_path)) == 1
    assert open_files() == before


def test_what_cannot_be_taken_away_is_left_for_the_next_time(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def kept(*_given: object, **_named: object) -> None:
        raise PermissionError

    with monkeypatch.context() as patched:
        patched.setattr(os, "rmdir", kept)
        replace_old_by_new(tmp_path)
    assert seen(tmp_path) == NEW
    assert len(list(tmp_path.glob(".skisnow-*"))) == 1
    assert len(prepare_folder(tmp_path)) == 1
    assert list(tmp_path.glob(".*")) == []


def test_a_stage_is_made_by_one_process_at_a_time(tmp_path: Path) -> None:
    fcntl = pytest.importorskip("fcntl", reason="locks of files are those of Unix")
    other = os.open(tmp_path, os.O_RDONLY)
    fcntl.flock(other, fcntl.LOCK_EX)
    waiting = Thread(target=replace_old_by_new, args=(tmp_path,))
    waiting.start()
    waiting.join(0.2)
    assert waiting.is_alive()
    assert seen(tmp_path) == {}
    os.close(other)
    waiting.join()
    assert seen(tmp_path) == NEW


def test_an_interrupt_while_files_are_moved_waits_for_the_last(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write(tmp_path, OLD)
    original, moved = Path.replace, []

    def replace(self: Path, target: Path) -> Path:
        moved.append(target.name)
        if target.name == "page" and moved.count("page") == 1:
            raise KeyboardInterrupt
        return original(self, target)

    monkeypatch.setattr(Path, "replace", replace)
    with pytest.raises(KeyboardInterrupt):
        replace_old_by_new(tmp_path)
    assert seen(tmp_path) == NEW


def test_an_invalid_place_is_rejected(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with raises(OutputError, "cannot_write"):
        prepare_folder(tmp_path / "file")
    with raises(OutputError, "cannot_write"), staged(tmp_path / "absent", last="x"):
        pass
