"""Damaged files of each kind give a result or an error in words."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.given.fuzz import KINDS, Kind, broken

each_kind = pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name)


@each_kind
def test_sound_file_is_read(kind: Kind, tmp_path: Path) -> None:
    (tmp_path / kind.name).write_bytes(kind.sound)
    kind.read(tmp_path / kind.name)


@each_kind
def test_damaged_files(kind: Kind, tmp_path: Path) -> None:
    assert broken(kind, tmp_path, seed=1, number=40) == []


@pytest.mark.slow
@each_kind
def test_many_damaged_files(kind: Kind, tmp_path: Path) -> None:
    assert broken(kind, tmp_path, seed=2, number=3000) == []
