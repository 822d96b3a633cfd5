"""Files that belong together: written to a hidden folder, then moved, so that old and new never mix.

When all files are complete in a hidden folder inside the target, the old files are removed, and only then are the new
ones moved. A process that is killed before leaves the old files, and during the moves a folder without its last file.
"""

from __future__ import annotations

import os
import shutil
import tempfile
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from .errors import OutputError, ParameterError

_PREFIX: Final = ".skisnow-"
_A_DAY_S: Final = 86_400.0


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
        with tempfile.TemporaryDirectory(prefix=_PREFIX, dir=folder, ignore_cleanup_errors=True) as hidden:
            stage = Stage(Path(hidden))
            yield stage
            new = sorted(path.relative_to(hidden) for path in stage.path.rglob("*") if path.is_file())
            old = [*map(Path, stage.stale), *new]
            others = [folder / name for name in old if (folder / name).exists()]
            was_killed = any(path != stage.path for path in folder.glob(f"{_PREFIX}*"))  # a run during its moves
            if others and not was_killed and not (folder / last).exists():
                raise OutputError(
                    "{path} is not from an earlier run and is kept. Choose another folder or move the file."
                ).tag("file_kept", path=others[0])
            for name in (Path(last), *old):
                (folder / name).unlink(missing_ok=True)
            for name in sorted(new, key=lambda name: (name == Path(last), name)):
                (folder / name).parent.mkdir(parents=True, exist_ok=True)
                (stage.path / name).replace(folder / name)
    except OSError as error:
        raise cannot_write(folder, error) from error


def prepare_folder(folder: str | Path) -> None:
    """Create a folder if needed, check that it can be written, and remove what killed processes left a day ago."""
    require_writable(folder)
    for hidden in Path(folder).glob(f"{_PREFIX}*"):
        if time.time() - hidden.stat().st_mtime > _A_DAY_S:
            shutil.rmtree(hidden, ignore_errors=True)


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
