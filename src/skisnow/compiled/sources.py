"""A fingerprint of the compiled core's sources; a program of its own, since the build asks for it too."""

from __future__ import annotations

import hashlib
import sys
from pathlib import Path


def fingerprint(folder: Path) -> str:
    """Hash of names and contents of all C++ files in a folder."""
    digest = hashlib.sha256()
    for path in sorted((*folder.glob("*.cpp"), *folder.glob("*.hpp"), *folder.glob("*.h"))):
        digest.update(f"{path.name}\0".encode() + path.read_bytes().replace(b"\r\n", b"\n") + b"\0")
    return digest.hexdigest()[:16]


if __name__ == "__main__":
    print(fingerprint(Path(sys.argv[1])))
