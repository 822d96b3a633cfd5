"""Files that belong together: never parts of two writings, wherever a process is killed."""

import os
import signal
from pathlib import Path
from threading import Thread

import pytest

from skisnow._support.errors import OutputError
from skisnow._support.staging import prepare_folder, staged
from tests.coded import raises

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
