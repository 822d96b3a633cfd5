from __future__ import annotations

import dataclasses
import warnings
from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.coded import raises

from skisnow._support.errors import OutputError, RangeWarning
from skisnow.ski import Ski, read_ski, ski_named, ski_names, write_ski

if TYPE_CHECKING:
    from pathlib import Path


def require_same(read: Ski, written: Ski) -> None:
    for field in dataclasses.fields(Ski):
        before, after = getattr(written, field.name), getattr(read, field.name)
        if field.name in ("base", "keys"):
            assert after is None  # the table has the numbers themselves
        elif isinstance(before, str):
            assert after == before, field.name
        else:
            # 15 digits are written; millimetres and back cost one more
            scale = float(np.max(np.abs(before)))
            assert np.shape(after) == np.shape(before), field.name
            assert after == pytest.approx(before, abs=2e-14 * max(scale, 1e-3)), field.name


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
    with raises(OutputError, "cannot_write"):
        write_ski(ski_named("carver"), tmp_path / "carver.csv")
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), n=st.integers(750, 900), bevel=st.floats(0.0, 0.08), middle=st.floats(-0.1, 0.1))
def test_any_table_survives(
    tmp_path_factory: pytest.TempPathFactory, seed: int, n: int, bevel: float, middle: float
) -> None:
    random = np.random.default_rng(seed)
    inner = np.linspace(0.8, -0.8, n)[1:-1] + random.uniform(-1e-4, 1e-4, n - 2)  # uneven, still falling and dense
    station = np.concatenate([[0.8], inner, [-0.8]])
    base_height = random.uniform(-0.02, 0.02, n)
    ski = Ski(
        name="any",
        source="drawn",
        station=station,
        width=0.07 + 0.03 * (station - middle) ** 2 + random.uniform(0.0, 1e-6, n),
        base_height=base_height - np.interp(0.0, station[::-1], base_height[::-1]),
        bending_stiffness=random.uniform(5.0, 5000.0, n),
        torsional_stiffness=random.uniform(2.0, 5000.0, n),
        mass_per_length=random.uniform(0.1, 10.0, n),
        running_length=1.3,
        sidecut_length=1.4,
        base_bevel=bevel,
        sidecut_middle=middle,
    )
    path = tmp_path_factory.mktemp("ski") / "any.toml"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)  # of bevels below a tenth of a degree
        write_ski(ski, path)
        require_same(read_ski(path), ski)
