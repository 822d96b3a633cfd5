"""Files that belong together: written to a hidden folder, then moved, so that old and new never mix.

All files are written to a hidden folder inside the target. When it is complete, a plan is written next to it; only then
are the old files removed and the new ones moved. At the next start (`prepare_folder`) the remains of a killed process
are completed if there is a plan, and deleted otherwise. Each process locks its hidden folder.
"""

from __future__ import annotations

import contextlib
import os
import re
import shutil
import sys
import tempfile
import time
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path, PurePath
from typing import Final

from .errors import OutputError, ParameterError

_PREFIX: Final = ".skisnow-"
_HIDDEN: Final = re.compile(r"\.(skisnow|report|run)-[a-z0-9_]{8}")
_FILES: Final = "files"
_PLAN: Final = "plan"
_CLEARED: Final = "cleared"
_A_DAY_S: Final = 86_400.0
_MOST_STALE: Final = 10_000


@dataclass(slots=True)
class Stage:
    """Hidden folder whose files replace those of the target folder when all are written.

    path: hidden folder to fill.
    stale: relative paths of files that an earlier run may have left in the target; they are removed from it.
    """

    path: Path
    stale: list[str] = field(default_factory=list)


@contextmanager
def staged(folder: Path, *, last: str) -> Iterator[Stage]:
    """Yield a stage whose files are moved into a folder at the end of the block; an error before changes nothing.

    Files of an earlier run are replaced, others are not.
    last: name of the file whose presence shows that all others are complete: removed first, moved last.
    """
    try:
        with _lock_folder(folder):
            hidden = Path(tempfile.mkdtemp(prefix=_PREFIX, dir=folder))
            lock = _locked(hidden)  # None where the system has no locks
        (hidden / _FILES).mkdir()
    except OSError as error:
        raise cannot_write(folder, error) from error
    stage = Stage(hidden / _FILES)
    try:
        yield stage
        _require_own(folder, last, [*stage.stale, *_list_files(stage.path)])
        write_file(hidden / _PLAN, "\n".join((last, *stage.stale)))
        try:
            _replace_files(hidden)
        except KeyboardInterrupt:
            _replace_files(hidden)  # it takes a moment, and half of it would be no run at all
            raise
    except OSError as error:
        raise cannot_write(folder, error) from error
    finally:
        if not (hidden / _PLAN).exists():
            shutil.rmtree(hidden, ignore_errors=True)
        if lock is not None:
            os.close(lock)


def prepare_folder(folder: Path) -> list[str]:
    """Prepare a folder for writing; returns a sentence about each completed or removed stage of a killed process."""
    require_writable(folder)
    try:
        with _lock_folder(folder):
            left = sorted(path for path in folder.iterdir() if _HIDDEN.fullmatch(path.name) and path.is_dir())
            return [sentence for hidden in left if (sentence := _finish_or_remove(hidden))]
    except OSError as error:
        raise cannot_write(folder, error) from error


def _finish_or_remove(hidden: Path) -> str | None:
    """Complete or remove the stage of a killed process; returns a sentence about it, None if its process still runs."""
    lock = _locked(hidden)
    if lock is None and not _is_old(hidden):
        return None
    try:
        if not (hidden / _PLAN).is_file():
            return f"{hidden} was left by a process that was killed; it is removed"
        _replace_files(hidden)
        return f"{hidden.parent}: the files that a killed process had not yet moved are in place now"
    finally:
        shutil.rmtree(hidden, ignore_errors=True)
        if lock is not None:
            os.close(lock)


def _replace_files(hidden: Path) -> None:
    """Remove all old files, then move the new ones into place; after an interruption it can be repeated."""
    folder, stage = hidden.parent, hidden / _FILES
    try:
        last, *stale = (hidden / _PLAN).read_text(encoding="utf-8").split("\n")
        _require_inside((last, *stale))
    except ValueError as error:
        raise OSError(f"the plan of a killed process is damaged; remove {hidden} and write again") from error
    new = _list_files(stage)
    if not (hidden / _CLEARED).exists():
        for name in (Path(last), *map(Path, stale), *new):
            (folder / name).unlink(missing_ok=True)
        (hidden / _CLEARED).touch()
    for name in sorted(new, key=lambda name: (name == Path(last), name)):
        target = folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        (stage / name).replace(target)
    (hidden / _PLAN).unlink()


def _list_files(stage: Path) -> list[Path]:
    """Paths of all files below a stage, relative to it and sorted."""
    return sorted(path.relative_to(stage) for path in stage.rglob("*") if path.is_file())


def _require_own(folder: Path, last: str, names: Iterable[str | Path]) -> None:
    """Raise an OutputError if a folder has files of these names, but not the `last` file of an earlier run."""
    others = [folder / name for name in names if (folder / name).exists()]
    if others and not (folder / last).exists():
        raise OutputError("{path} is not from an earlier run and is kept. Choose another folder or move the file.").tag(
            "file_kept", path=others[0]
        )


def _require_inside(names: Sequence[str]) -> None:
    """Raise a ValueError for a relative path that leads out of the folder or is invalid, and for too many paths."""
    if len(names) > _MOST_STALE:
        raise ValueError(len(names))
    for name in names:
        path = PurePath(name)
        if not name or "\0" in name or path.is_absolute() or ".." in path.parts or not path.name:
            raise ValueError(name)


def _is_old(hidden: Path) -> bool:
    """True on Windows, where locks are not used, for a stage without writes for a day; it counts as abandoned."""
    return sys.platform == "win32" and time.time() - hidden.stat().st_mtime > _A_DAY_S


@contextmanager
def _lock_folder(folder: Path) -> Iterator[None]:
    """Wait until no other process creates or removes a stage in the folder."""
    if sys.platform == "win32":
        yield
        return
    import fcntl

    handle = os.open(folder, os.O_RDONLY)
    try:
        with contextlib.suppress(OSError):  # a file system without locks
            fcntl.flock(handle, fcntl.LOCK_EX)
        yield
    finally:
        os.close(handle)


def _locked(hidden: Path) -> int | None:
    """File descriptor that locks a stage until it is closed; None if another process has the lock, or without locks."""
    if sys.platform == "win32":
        return None
    import fcntl

    handle = os.open(hidden, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        os.close(handle)
        return None
    return handle


def require_ending(path: str | Path, *endings: str) -> None:
    """Raise a ParameterError unless a file name has one of these endings; the case of letters does not matter."""
    if Path(path).suffix.lower() not in endings:
        raise ParameterError("{path} does not end in {ending}. Rename it.").tag(
            "wrong_ending", path=path, ending=endings[0] if len(endings) == 1 else list(endings)
        )


def write_file(path: str | Path, content: str | bytes | Iterable[bytes]) -> None:
    """Write or replace a file; text as UTF-8 with plain line ends. Bytes can come in pieces."""
    whole = content.encode("utf-8") if isinstance(content, str) else content
    with place_to_write(path) as place, place.open("wb") as file:
        file.writelines([whole] if isinstance(whole, bytes) else whole)


@contextmanager
def place_to_write(path: str | Path) -> Iterator[Path]:
    """Yield the path of an empty temporary file, which is renamed to `path` if the block succeeds, else deleted."""
    path = Path(path)
    temporary: Path | None = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(prefix=f".{path.name}.", suffix=".partial", dir=path.parent)
        os.close(handle)
        temporary = Path(name)
        yield temporary
        with temporary.open("r+b") as file:
            os.fsync(file.fileno())
        temporary.chmod(0o644)
        temporary.replace(path)
        temporary = None
    except OSError as error:
        raise cannot_write(path, error) from error
    finally:
        if temporary is not None:  # an error, or an interruption at any moment
            temporary.unlink(missing_ok=True)


def require_writable(folder: str | Path) -> None:
    """Create a folder if needed and write a trial file, so that long work does not fail at its end."""
    try:
        Path(folder).mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise cannot_write(folder, error) from error


def cannot_write(path: str | Path, error: OSError) -> OutputError:
    """Error for a place that cannot be written, with the system's reason."""
    reason = error.strerror or error
    return OutputError("{path} cannot be written: {reason}. Choose another place or free some space.").tag(
        "cannot_write", path=path, reason=reason
    )
