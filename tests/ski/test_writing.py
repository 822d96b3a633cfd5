from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

import numpy as np
import pytest

from skisnow.errors import OutputError
from skisnow.ski import Ski, read_ski, ski_named, ski_names, write_ski

if TYPE_CHECKING:
    from pathlib import Path


def require_same(read: Ski, written: Ski) -> None:
    for field in dataclasses.fields(Ski):
        before, after = getattr(written, field.name), getattr(read, field.name)
        if isinstance(before, str):
            assert after == before, field.name
        else:
            # 15 digits are written; millimetres and back cost one more
            scale = float(np.max(np.abs(before)))
            assert np.shape(after) == np.shape(before), field.name
            assert after == pytest.approx(before, abs=1e-14 * max(scale, 1e-3)), field.name


@pytest.mark.parametrize("name", ski_names())
def test_written_and_read_again(tmp_path: Path, name: str) -> None:
    ski = ski_named(name)
    write_ski(ski, tmp_path / "copy.toml")
    require_same(read_ski(tmp_path / "copy.toml"), ski)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["copy.csv", "copy.toml"]


def test_every_field_survives(tmp_path: Path) -> None:
    ski = ski_named("slalom")
    moved = dataclasses.replace(
        ski,
        name='a "quoted" \\ name\nof Mössner\x7f',
        station=ski.station - 0.0313,
        base_height=ski.base_height - ski.at(0.0313).base_height,
        sidecut_middle=-0.0313,
        base_bevel=0.0123,
        edge_width=0.0019,
    )
    write_ski(moved, tmp_path / "moved.toml")
    require_same(read_ski(tmp_path / "moved.toml"), moved)


def test_source_may_be_blank(tmp_path: Path) -> None:
    write_ski(dataclasses.replace(ski_named("carver"), source=""), tmp_path / "c.toml")
    assert read_ski(tmp_path / "c.toml").source == "file c.toml"


def test_only_a_toml_file_is_written(tmp_path: Path) -> None:
    with pytest.raises(OutputError, match=r"ends in \.toml"):
        write_ski(ski_named("carver"), tmp_path / "carver.csv")
    assert not list(tmp_path.iterdir())
