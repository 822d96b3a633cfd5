"""Machine code on the disk: found again, never stale, never a reason to fail."""

from __future__ import annotations

import ast
import logging
import os
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from skisnow import machine_code
from skisnow.machine_code import KERNELS, PACKAGE, compiled, keep, kept, sources_fingerprint

Damage = Callable[[bytes], bytes]
FOLDER = "0123-abc"
DAMAGES: dict[str, Damage] = {
    "empty": lambda _: b"",
    "truncated": lambda content: content[: len(content) // 2],
    "one bit flipped": lambda content: content[:99] + bytes([content[99] ^ 4]) + content[100:],
}


def tripled(x: float) -> float:
    return 3.0 * x


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Where code is kept in this test."""
    monkeypatch.setattr(machine_code, "folder", lambda: tmp_path / FOLDER)
    return tmp_path / FOLDER


def in_a_process() -> tuple[Any, int]:
    """The function compiled or loaded, as a process that begins does, and how often it had to be compiled."""
    loop = compiled(error_model="numpy")(tripled)
    assert loop(2.0) == 6.0
    return loop, sum(loop.stats.cache_misses.values())


def files_of_kernels() -> list[Path]:
    every = [PACKAGE / each for each in KERNELS]
    return [file for each in every for file in ([each] if each.suffix else sorted(each.glob("*.py")))]


def test_code_is_made_once(folder: Path) -> None:
    assert in_a_process()[1] == 1
    (file,) = folder.iterdir()
    assert in_a_process()[1] == 0
    assert list(folder.iterdir()) == [file]
    loop, _ = in_a_process()
    assert loop.stats.cache_path == str(folder)
    assert loop(2) == 6  # another type of number is another function
    assert len(list(folder.iterdir())) == 2


@pytest.mark.parametrize("damage", DAMAGES.values(), ids=DAMAGES)
def test_damaged_code_is_made_anew(damage: Damage, folder: Path, caplog: pytest.LogCaptureFixture) -> None:
    in_a_process()
    (file,) = folder.iterdir()
    whole = file.read_bytes()
    file.write_bytes(damage(whole))
    assert in_a_process()[1] == 1
    assert [str(file) in each.getMessage() for each in caplog.records] == [True]
    assert in_a_process()[1] == 0
    assert len(caplog.records) == 1


def test_whole_but_unreadable_code_is_made_anew(folder: Path, caplog: pytest.LogCaptureFixture) -> None:
    in_a_process()
    (file,) = folder.iterdir()
    keep(file, b"no pickle")
    assert in_a_process()[1] == 1
    assert len(caplog.records) == 1


def test_the_word_goes_to_standard_error(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """As in a program that sets up no logging."""
    path = folder / "a.nbc"
    keep(path, b"content")
    path.write_bytes(b"")
    handlers = logging.getLogger().handlers[:]
    try:
        logging.getLogger().handlers = []
        assert kept(path) is None
    finally:
        logging.getLogger().handlers = handlers
    told = capsys.readouterr()
    assert told.out == ""
    assert told.err == f"skisnow: kept machine code was damaged and is made anew: {path}\n"


def test_nothing_can_be_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").write_bytes(b"")
    monkeypatch.setattr(machine_code, "folder", lambda: tmp_path / "file" / FOLDER)
    assert in_a_process()[1] == 1
    assert in_a_process()[1] == 1


def test_places(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The first that can be written; a folder that goes with the process where none can."""
    closed = tmp_path / "closed"
    closed.write_bytes(b"")
    monkeypatch.setattr(machine_code, "_places", lambda: iter([closed, tmp_path / "open", tmp_path / "other"]))
    assert machine_code.place.__wrapped__() == tmp_path / "open"
    monkeypatch.setattr(machine_code, "_places", lambda: iter([closed]))
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(closed))
    last = machine_code.place.__wrapped__()
    assert last.is_dir()
    assert os.environ["NUMBA_CACHE_DIR"] == str(last)
    shutil.rmtree(last)


def test_each_file_of_loops_has_its_say(tmp_path: Path) -> None:
    """An edit of any of them finds nothing of what was kept before."""
    for place in KERNELS:
        source = PACKAGE / place
        (shutil.copy if source.suffix else shutil.copytree)(source, tmp_path / place)
    known = {sources_fingerprint(tmp_path), ""}
    assert sources_fingerprint() in known
    for file in files_of_kernels():
        copy = tmp_path / file.relative_to(PACKAGE)
        copy.write_text(copy.read_text(encoding="utf-8") + "\n", encoding="utf-8")
        assert sources_fingerprint(tmp_path) not in known
        known.add(sources_fingerprint(tmp_path))
    assert sources_fingerprint(tmp_path / "nothing") == ""


def test_no_loop_and_no_constant_of_one_lies_elsewhere() -> None:
    """Only these files compile anything, and no loop takes a name in from any other file of the program."""
    inside = files_of_kernels()
    for file in PACKAGE.rglob("*.py"):
        text = file.read_text(encoding="utf-8")
        if file not in inside:
            assert "njit" not in text, file
            assert "machine_code import compiled" not in text, file
            continue
        tree = ast.parse(text)
        foreign = {
            alias.asname or alias.name: _origin(file, node)
            for node in ast.walk(tree)
            if isinstance(node, ast.ImportFrom) and node.level
            for alias in node.names
            if _origin(file, node) not in inside
        }
        for node in ast.walk(tree):
            if isinstance(node, ast.FunctionDef) and any("compiled" in ast.unparse(d) for d in node.decorator_list):
                used = {each.id for stmt in node.body for each in ast.walk(stmt) if isinstance(each, ast.Name)}
                assert not used & set(foreign), (file, node.name, used & set(foreign))


def _origin(file: Path, node: ast.ImportFrom) -> Path:
    base = file.parents[node.level - 1].joinpath(*(node.module or "").split("."))
    return base.with_suffix(".py") if base.with_suffix(".py").exists() else base / "__init__.py"


def test_older_code_is_thrown_away(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(machine_code, "SOURCES", "abc")
    monkeypatch.setattr(machine_code, "sources_fingerprint", lambda: "abc")
    for name in ("0123-older", "4567-older", "4567-abc"):
        (folder.parent / name).mkdir()
    (folder.parent / "lock").write_bytes(b"")
    keep(folder / "a.nbc", b"content")
    assert kept(folder / "a.nbc") == b"content"
    assert {each.name for each in folder.parent.iterdir()} == {FOLDER, "4567-abc", "lock"}


def test_code_of_sources_edited_meanwhile_is_not_kept(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(machine_code, "sources_fingerprint", lambda: "another")
    in_a_process()
    assert not folder.exists()
