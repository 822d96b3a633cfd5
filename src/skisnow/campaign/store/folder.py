"""Folders of stored campaigns: listing, hashing, checks of paths, writing.

The store keeps path and bytes of each regular file, but no empty folders, times and permissions.
"""

from __future__ import annotations

import hashlib
import os
import re
import stat
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from tempfile import TemporaryDirectory
from typing import Final, TypeAlias

from ..._support.csv_text import UnreadableTextError, decode
from ..._support.errors import ParameterError, StoreError
from ..._support.messages import Message
from ..._support.user_files.text_files import MOST_TOML_BYTES, plain_bytes, toml_values
from ..reading.campaign_files import CampaignFiles
from ..reading.workbook_files import DESCRIPTION, unfold_workbooks

_WINDOWS_NAMES: Final = re.compile(
    r"(con|prn|aux|nul|conin\$|conout\$|com[0-9¹²³]|lpt[0-9¹²³])\s*(\..*)?", re.IGNORECASE
)
_NOT_ON_WINDOWS: Final = re.compile(r'[<>:"|?*\\\x00-\x1f]|[. ]$')


Progress: TypeAlias = Callable[[int, int], object]
"""Callback with the number of processed bytes and their total."""


def no_progress(done_bytes: int, total_bytes: int, /) -> None:
    """Do nothing: for callers who need no progress."""


@dataclass(frozen=True, slots=True)
class StoredFile:
    """A file of a campaign: path relative to its folder (parts joined by ``/``), size in bytes, SHA-256 in hex."""

    path: str
    size: int
    sha256: str


FileState: TypeAlias = tuple[int, int]
"""State of a file that must not change while it is read: size (bytes) and time of last change (ns)."""


def manifest_sha256(files: Iterable[StoredFile]) -> str:
    """SHA-256 of paths, sizes and hashes of a campaign's files, independent of their order.

    The manifest is the line ``skisnow manifest 1`` and, sorted by the bytes of the path in UTF-8, for each file
    ``SHA256 SIZE PATH`` and a zero byte.

    >>> manifest_sha256([])[:12]
    '16e12f957da4'
    """
    manifest = hashlib.sha256(b"skisnow manifest 1\n")
    for path, file in sorted((file.path.encode(), file) for file in files):
        manifest.update(f"{file.sha256} {file.size} ".encode() + path + b"\0")
    return manifest.hexdigest()


def list_files(folder: Path) -> dict[str, FileState]:
    """States (size and time of change) of all files below a folder by path, also of hidden ones.

    Raises StoreError: links, pipes and the like (all are named), names that are not text, paths that cannot be
        exported.
    Raises OSError: a folder cannot be read.
    """
    files: dict[str, FileState] = {}
    refused: list[str] = []
    waiting = [folder]
    while waiting:
        for entry in sorted(waiting.pop().iterdir()):
            path = entry.relative_to(folder).as_posix()
            state = entry.lstat()
            is_junction = getattr(entry, "is_junction", bool)()  # Windows's other link to a folder, Python ≥ 3.12
            if stat.S_ISDIR(state.st_mode) and not is_junction:
                waiting.append(entry)
            elif stat.S_ISREG(state.st_mode):
                _require_safe(path, for_windows=False)
                files[path] = state.st_size, state.st_mtime_ns
            else:
                refused.append(path)
    if refused:
        raise StoreError(
            "{folder} contains links, pipes or other special files: {paths}; replace them by the files themselves, "
            "or remove them."
        ).tag("not_a_file", folder=folder, paths=list(map(_printable, refused)))
    return files


def read_chunks(file: Path, chunk_bytes: int) -> Iterator[bytes]:
    """Read a file in pieces of `chunk_bytes` bytes; the last can be shorter."""
    with file.open("rb") as stream:
        while piece := stream.read(chunk_bytes):
            yield piece


def campaign_name(folder: Path) -> str:
    """Name from a folder's campaign.toml or its sheets if they can be read, otherwise that of the folder."""
    own = folder.resolve().name.encode(errors="replace").decode()
    place = folder / DESCRIPTION
    try:
        if place.exists():
            data = plain_bytes(place, most_bytes=MOST_TOML_BYTES)
        else:
            data = unfold_workbooks(CampaignFiles(folder)).read(DESCRIPTION) or b""
        name = toml_values(decode(data).text).get("name")
    except (OSError, ParameterError, UnreadableTextError):
        return own
    return (" ".join(name.split()) if isinstance(name, str) else "") or own


def unsafe_because(path: str, *, for_windows: bool) -> Message | None:
    """Reason why a relative path must not be written below a folder; None if it is safe.

    >>> unsafe_because("../passwd", for_windows=False)
    'it has a part that is empty, . or ..'
    >>> unsafe_because("day 1/shear.csv", for_windows=True) is None
    True
    >>> unsafe_because("aux.csv", for_windows=True)
    'Windows allows no such name'
    """
    parts = path.split("/")
    if path.startswith("/") or re.match("[A-Za-z]:", path):
        return Message("it is absolute or names a drive")
    if any(part in ("", ".", "..") for part in parts):
        return Message("it has a part that is empty, . or ..")
    if "\0" in path:
        return Message("it has a zero byte")
    if for_windows and any(_WINDOWS_NAMES.fullmatch(part) or _NOT_ON_WINDOWS.search(part) for part in parts):
        return Message("Windows allows no such name")
    try:
        path.encode()
    except UnicodeEncodeError:
        return Message("its name is not valid text")
    return None


def _require_safe(path: str, *, for_windows: bool) -> None:
    """Reject a path that is not safe to import or export on this system, or on Windows if `for_windows`."""
    if (why := unsafe_because(path, for_windows=for_windows)) is not None:
        raise StoreError("The file {path} cannot be imported or exported: {why}; rename it.").tag(
            "unsafe_name", path=_printable(path), why=why
        )


def _printable(path: str) -> str:
    """The path with surrogates, from undecodable bytes, as escapes."""
    return path.encode(errors="backslashreplace").decode()


@contextmanager
def new_folder(out: Path) -> Iterator[Path]:
    """Yield a temporary folder to fill, which is renamed to ``out`` after success.

    Raises StoreError: ``out`` is there already and not an empty folder.
    Raises OSError: the disk is full, read-only and so on; nothing is left behind.
    """
    out = out.resolve()
    if out.exists() and (not out.is_dir() or any(out.iterdir())):
        raise StoreError("{out} exists and is not an empty folder; name a folder that does not exist yet.").tag(
            "not_empty", out=out
        )
    out.parent.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory(dir=out.parent, prefix=f".{out.name[:40]}-") as hidden:
        filling = Path(hidden) / "campaign"  # its permissions are the usual ones, the hidden folder's are not
        filling.mkdir()
        yield filling
        for written in [filling, *filling.rglob("*")]:
            _sync_folder(written)
        if os.name == "nt" and out.exists():
            out.rmdir()
        filling.rename(out)
    _sync_folder(out.parent)


def write_file(folder: Path, file: StoredFile, pieces: Iterable[bytes]) -> None:
    """Write one file below a folder, flush it to the disk, and verify its SHA-256.

    Raises StoreError: an unsafe path, bytes that do not have the stored SHA-256, or two paths that are one on this file
        system.
    """
    _require_safe(file.path, for_windows=os.name == "nt")
    place = folder / PurePosixPath(file.path)
    place.parent.mkdir(parents=True, exist_ok=True)
    digest = hashlib.sha256()
    try:
        with place.open("xb") as stream:
            for piece in pieces:
                stream.write(piece)
                digest.update(piece)
            stream.flush()
            os.fsync(stream.fileno())
    except FileExistsError as error:
        raise StoreError(
            "{path} and another file of the campaign have the same name on this file system; export to one that "
            "distinguishes upper and lower case."
        ).tag("same_name", path=file.path) from error
    if digest.hexdigest() != file.sha256:
        raise StoreError("{path} is damaged in the store and was not written; `skisnow store verify` lists all.").tag(
            "damaged", path=file.path
        )


def checked_bytes(file: StoredFile, pieces: Iterable[bytes]) -> bytes:
    """Join pieces to the bytes of a file; StoreError if they do not have its SHA-256."""
    data = b"".join(pieces)
    if hashlib.sha256(data).hexdigest() != file.sha256:
        raise StoreError("{path} is damaged in the store and was not read; `skisnow store verify` lists all.").tag(
            "damaged", path=file.path
        )
    return data


def _sync_folder(folder: Path) -> None:
    """Flush the names of a folder's files to the disk; Windows does this automatically."""
    if os.name == "nt" or not folder.is_dir():
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def changed_files(before: Mapping[str, FileState], after: Mapping[str, FileState]) -> list[str]:
    """Paths of the files that were added, removed or changed between two listings."""
    return sorted(path for path in before.keys() | after.keys() if before.get(path) != after.get(path))
