"""Uploads to a folder: names checked, sizes counted while they are read, nothing but plain files."""

from __future__ import annotations

import lzma
import stat
import zipfile
import zlib
from pathlib import PurePosixPath
from typing import IO, TYPE_CHECKING, Final

from ..errors import ParameterError
from ..field.store.folder import unsafe_because

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    from .settings import Limits

CHUNK_BYTES: Final = 1 << 18
_DAMAGE: Final = (
    zipfile.BadZipFile,
    zlib.error,
    lzma.LZMAError,
    EOFError,
    NotImplementedError,
    RuntimeError,
    ValueError,
)


class Unpacking:
    """Fills a folder with files of an upload, none outside of it and no more than the limits allow."""

    def __init__(self, folder: Path, limits: Limits) -> None:
        self.folder = folder
        self.limits = limits
        self._bytes = 0
        self._files = 0

    def take(self, name: str, content: IO[bytes]) -> None:
        """Write one file.

        Raises
        ------
        ParameterError
            Its name leads out of the folder or cannot be used on every system, it is there already, or it is too much.
        """
        place = self._place(name)
        self._files += 1
        if self._files > self.limits.files:
            raise ParameterError(f"more than {self.limits.files} files at once are not taken in")
        try:
            place.parent.mkdir(parents=True, exist_ok=True)
            with place.open("xb") as file:
                while piece := content.read(CHUNK_BYTES):
                    self._bytes += len(piece)
                    if self._bytes > self.limits.unpacked_bytes:
                        raise ParameterError(f"more than {self.limits.unpacked_bytes} bytes at once are not taken in")
                    file.write(piece)
        except (FileExistsError, NotADirectoryError) as error:
            raise ParameterError(f"two files of the upload are called {shown(name)}") from error

    def take_zip(self, packed: IO[bytes]) -> None:
        """Unpack a zip file; what it says about sizes is not believed but counted.

        Raises
        ------
        ParameterError
            As in `take`; it is no zip file, is damaged or encrypted, or holds links.
        """
        try:
            with zipfile.ZipFile(packed) as archive:
                members = [member for member in archive.infolist() if not member.is_dir()]
                if len(members) > self.limits.files:
                    raise ParameterError(f"more than {self.limits.files} files at once are not taken in")
                for member in members:
                    _require_plain(member)
                    with archive.open(member) as content:
                        self.take(member.filename, content)
        except (
            zipfile.BadZipFile,
            zipfile.LargeZipFile,
            EOFError,
            OSError,
            RuntimeError,
            NotImplementedError,
        ) as error:
            raise ParameterError("the zip file is damaged or of a kind that is not read") from error
        except Exception as error:
            if type(error).__module__ in ("zlib", "_lzma", "lzma"):
                raise ParameterError("the zip file is damaged") from error
            raise

    def _place(self, name: str) -> Path:
        path = name.replace("\\", "/")
        if (why := unsafe_because(path, for_windows=True)) is not None:
            raise ParameterError(f"the file {shown(name)} is not taken in: {why}")
        return self.folder.joinpath(*PurePosixPath(path).parts)


def _require_plain(member: zipfile.ZipInfo) -> None:
    kind = stat.S_IFMT(member.external_attr >> 16)
    if kind not in (0, stat.S_IFREG):
        raise ParameterError(f"{shown(member.filename)} in the zip file is a link or the like, not a plain file")
    if member.flag_bits & 1:
        raise ParameterError(f"{shown(member.filename)} in the zip file is encrypted; pack it without a password")


def shown(name: str) -> str:
    """A file's name inside a sentence: short, and nothing that does not print."""
    plain = "".join(letter if letter.isprintable() else "?" for letter in name)
    return repr(plain if len(plain) <= 80 else plain[:79] + "…")


def campaign_folder(folder: Path) -> Path:
    """Where the campaign lies in what was unpacked: the folder, or the only folder in it."""
    inside = list(folder.iterdir())
    while len(inside) == 1 and inside[0].is_dir():
        folder = inside[0]
        inside = list(folder.iterdir())
    return folder


def write_zip(files: Iterable[tuple[str, bytes]], to: IO[bytes]) -> None:
    """Pack files under their names."""
    with zipfile.ZipFile(to, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files:
            archive.writestr(name, content)


def files_below(folder: Path, *, under: str = "") -> Sequence[tuple[str, bytes]]:
    """Every file below a folder with its path as a zip has it."""
    found = sorted(path for path in folder.rglob("*") if path.is_file())
    prefix = f"{under}/" if under else ""
    return [(prefix + path.relative_to(folder).as_posix(), path.read_bytes()) for path in found]
