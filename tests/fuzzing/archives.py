"""Mutations of zip files: one member changed and packed again, or the archive itself."""

import io
import zipfile
from collections.abc import Callable, Sequence
from random import Random
from typing import Final

from .binaries import BINARY
from .texts import Mutation

_NAMES: Final = (
    "", "/", "../x", "/x", "a/../../x", "C:\\x", "a\\b", "x\0y", "a" * 300, "a/" * 40 + "b", "CON", "é", "x/", ".",
    "..",
)  # fmt: skip


def members(rng: Random, data: bytes, change: Callable[[Random, str, bytes], bytes]) -> bytes:
    """Change one member; if the file is not an archive, change its bytes."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            contents = [(each.filename, archive.read(each)) for each in archive.infolist()]
    except Exception:  # whatever an earlier mutation has made of it
        return rng.choice(BINARY)(rng, data)
    if not contents:
        return data
    at = rng.randrange(len(contents))
    name, content = contents[at]
    how = rng.randrange(12)
    if how == 0:
        contents[at] = (rng.choice(_NAMES), content)
    elif how == 1:
        del contents[at]
    elif how == 2:
        contents.append((name, content))
    elif how == 3:
        contents[at] = (name, bytes(rng.choice((1_000_000, 30_000_000))))
    else:
        contents[at] = (name, change(rng, name, content))
    return _packed(contents)


def _packed(contents: Sequence[tuple[str, bytes]]) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        written: set[str] = set()
        for name, content in contents:
            info = zipfile.ZipInfo("x")
            info.filename, info.compress_type = name, zipfile.ZIP_DEFLATED
            if name in written:
                archive.NameToInfo.pop(name, None)
            archive.writestr(info, content)
            written.add(name)
    return stream.getvalue()


def archive(change: Callable[[Random, str, bytes], bytes]) -> tuple[Mutation, ...]:
    """Mutations of archives whose members a function changes."""

    def member(rng: Random, data: bytes) -> bytes:
        return members(rng, data, change)

    return (member, member, member, member, *BINARY[-3:])
