"""A core that is older than its sources does not run."""

from __future__ import annotations

import shutil
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
    edited = copied / "pressure_kernels.hpp"
    edited.write_text(edited.read_text(encoding="utf-8").replace("0.5 * width", "1.5 * width", 1), encoding="utf-8")
    with pytest.raises(ImportError, match=r"older than its sources in .*core: build it with"):
        require_current(core.SOURCE_HASH, copied)
    edited.unlink()
    assert fingerprint(copied) != core.SOURCE_HASH


def test_without_sources_there_is_nothing_to_compare(tmp_path: Path) -> None:
    require_current("anything", tmp_path)
    (tmp_path / "a.cpp").touch()
    with pytest.raises(ImportError, match="older than its sources"):
        require_current("anything", tmp_path)
