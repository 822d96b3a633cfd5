"""A fingerprint of the compiled core's sources; a separate program, since the build runs it too."""

from __future__ import annotations

import hashlib
import sys
from pathlib import Path

SUFFIXES = {".cpp", ".hpp", ".h"}


def fingerprint(folder: Path) -> str:
    """Hash of names and contents of all C++ files in a folder and its subfolders."""
    digest = hashlib.sha256()
    paths = {path.relative_to(folder).as_posix(): path for path in folder.rglob("*") if path.suffix in SUFFIXES}
    for name, path in sorted(paths.items()):
        digest.update(f"{name}\0".encode() + path.read_bytes().replace(b"\r\n", b"\n") + b"\0")
    return digest.hexdigest()[:16]


if __name__ == "__main__":
    print(fingerprint(Path(sys.argv[1])))
