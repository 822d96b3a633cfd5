"""scikit-build-core, which builds the compiled core; without a C++ compiler it takes the one in Zig's wheel."""

from __future__ import annotations

import base64
import hashlib
import os
import shutil
import stat
import sys
import tempfile
import zipfile
from pathlib import Path
from typing import Any

import messages
from scikit_build_core import build as scikit

build_sdist = scikit.build_sdist
get_requires_for_build_sdist = scikit.get_requires_for_build_sdist
Settings = dict[str, Any] | None

SOURCES = Path(__file__).resolve().parents[1] / "src"
ZIG = "ziglang>=0.13,<0.18"
# Zig builds for the processor it runs on unless told so; a wheel may go to another
TOOLS = {"CXX": "c++ -mcpu=baseline", "CMAKE_AR": "ar", "CMAKE_RANLIB": "ranlib"}


def _has_compiler() -> bool:
    return bool(os.environ.get("CXX")) or any(shutil.which(name) for name in ("c++", "g++", "clang++", "cl"))


def get_requires_for_build_wheel(config_settings: Settings = None) -> list[str]:
    """What the build needs besides scikit-build-core and nanobind."""
    return [*scikit.get_requires_for_build_wheel(config_settings), *([] if _has_compiler() else [ZIG])]


get_requires_for_build_editable = get_requires_for_build_wheel


def _use_zig(folder: Path) -> None:
    """Programs in a folder that call Zig's; CMake wants the name of one file for each tool."""
    for name, tool in TOOLS.items():
        program = folder / f"zig-{tool.split()[0]}"
        program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m ziglang {tool} "$@"\n', encoding="utf-8")
        program.chmod(program.stat().st_mode | stat.S_IXUSR)
        if name == "CXX":
            os.environ["CXX"] = str(program)
        else:
            os.environ["CMAKE_ARGS"] = f"{os.environ.get('CMAKE_ARGS', '')} -D{name}={program}".strip()


def build_wheel(wheel_directory: str, config_settings: Settings = None, metadata_directory: str | None = None) -> str:
    """Build a wheel."""
    messages.compile_changed()
    with tempfile.TemporaryDirectory() as folder:
        if not _has_compiler():
            _use_zig(Path(folder))
        return scikit.build_wheel(wheel_directory, config_settings, metadata_directory)


def build_editable(
    wheel_directory: str, config_settings: Settings = None, metadata_directory: str | None = None
) -> str:
    """Build what an editable installation takes: the source folder on Python's path, the compiled module in it.

    Whoever puts another folder before it on the path runs that other folder's code, as with any module.
    """
    with tempfile.TemporaryDirectory() as folder:
        name = build_wheel(folder, config_settings, metadata_directory)
        with zipfile.ZipFile(Path(folder) / name) as built:
            kept = {each: built.read(each) for each in built.namelist() if ".dist-info/" in each}
            for each in built.namelist():
                if Path(each).name.startswith(("_core.", "libskisnow_contact.", "skisnow_contact.dll")):
                    _put(SOURCES / each, built.read(each))
    kept["skisnow.pth"] = f"{SOURCES}\n".encode()
    (record,) = (each for each in kept if each.endswith("/RECORD"))
    kept[record] = "".join(f"{each},,\n" if each == record else _recorded(each, kept[each]) for each in kept).encode()
    with zipfile.ZipFile(Path(wheel_directory) / name, "w") as wheel:
        for each, content in kept.items():
            wheel.writestr(each, content)
    return name


def _put(path: Path, content: bytes) -> None:
    """Take the place of a file that a running program may have open."""
    beside = path.with_name(f"{path.name}.new")
    beside.write_bytes(content)
    beside.replace(path)


def _recorded(name: str, content: bytes) -> str:
    digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(content)}\n"
