"""A core that is older than its sources does not run."""

from __future__ import annotations

import importlib
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import skisnow.compiled
from skisnow.compiled import core, require_current
from skisnow.compiled.sources import fingerprint

SOURCES = Path(skisnow.compiled.__file__).parents[2] / "core"


@pytest.mark.skipif(not SOURCES.is_dir(), reason="an installed package has no C++ sources")
def test_an_edited_source_is_refused(tmp_path: Path) -> None:
    copied = Path(shutil.copytree(SOURCES, tmp_path / "core"))
    require_current(core.SOURCE_HASH, copied)
    edited = copied / "contact" / "pressure_kernels.hpp"
    edited.write_text(edited.read_text(encoding="utf-8").replace("0.5 * width", "1.5 * width", 1), encoding="utf-8")
    with pytest.raises(ImportError, match=r"older than its sources in .*core: build it with"):
        require_current(core.SOURCE_HASH, copied)
    edited.unlink()
    assert fingerprint(copied) != core.SOURCE_HASH


@pytest.mark.skipif(not SOURCES.is_dir(), reason="an installed package has no C++ sources")
def test_the_package_looks_when_it_is_imported(monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as edited:
        edited.setattr("skisnow.compiled.sources.fingerprint", lambda _: "another")
        with pytest.raises(ImportError, match="older than its sources"):
            importlib.reload(skisnow.compiled)
    assert importlib.reload(skisnow.compiled).core is core


def test_the_build_asks_for_the_fingerprint_by_a_program(tmp_path: Path) -> None:
    """It needs nothing of the package, which is not built yet; line ends of Windows are those of Unix."""
    program = Path(skisnow.compiled.__file__).with_name("sources.py")
    told = []
    for name, text in (("a", b"one\ntwo\n"), ("b", b"one\r\ntwo\r\n"), ("c", b"one\n")):
        (tmp_path / name).mkdir()
        (tmp_path / name / "core.cpp").write_bytes(text)
        asked = [sys.executable, "-I", str(program), str(tmp_path / name)]
        told.append(subprocess.run(asked, check=True, capture_output=True, text=True).stdout)
        assert told[-1] == f"{fingerprint(tmp_path / name)}\n"
    assert told[0] == told[1] != told[2]


def test_without_sources_there_is_nothing_to_compare(tmp_path: Path) -> None:
    require_current("anything", tmp_path)
    (tmp_path / "a.cpp").touch()
    with pytest.raises(ImportError, match="older than its sources"):
        require_current("anything", tmp_path)
