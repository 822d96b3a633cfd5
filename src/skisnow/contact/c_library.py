"""Path of the contact as a library for programs in C."""

from __future__ import annotations

import ctypes
import os
from pathlib import Path
from typing import Final

from .. import compiled

NAMES: Final = ("libskisnow_contact.so", "libskisnow_contact.dylib", "skisnow_contact.dll")
"""Name of the library on Linux, macOS and Windows."""
HEADER: Final = "skisnow_contact.h"


def c_library() -> Path:
    """Path of the shared library, for a linker or for ``dlopen``.

    Raises
    ------
    FileNotFoundError
        The installed package does not contain it.
    ImportError
        In a checkout: it was built from other sources than the checkout contains.
    """
    path = _first_existing(*(_FOLDER / name for name in NAMES))
    sources = ctypes.CDLL(os.fspath(path)).skisnow_contact_sources
    sources.restype = ctypes.c_char_p
    compiled.require_current(sources().decode(), compiled.SOURCES)
    return path


def c_header() -> Path:
    """Path of the C header of the library, which describes the arguments and results of each function.

    Raises
    ------
    FileNotFoundError
        The installed package does not contain it.
    """
    return _first_existing(_FOLDER / HEADER, compiled.SOURCES / "bindings" / HEADER)


_FOLDER: Final = Path(compiled.__file__).parent


def _first_existing(*paths: Path) -> Path:
    """First of the paths that is a file; FileNotFoundError if there is none."""
    for path in paths:
        if path.is_file():
            return path
    raise FileNotFoundError(f"{paths[0].name} is not beside the compiled core; {compiled.REMEDY}")
