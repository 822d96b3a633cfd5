"""Pit densities: the real file's known counts, and refusals."""

from __future__ import annotations

import csv
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from skisnow._support.errors import FieldDataError
from skisnow.campaign.snow_pit import read_density_layers

REAL = Path(__file__).resolve().parents[3] / "shared" / "data" / "pit-density" / "pit_density.csv"
HEADER = "ID,TOP,BOTTOM,RHO,NOTES,TYPE\n"


def written(folder: Path, text: str) -> Path:
    path = folder / "pits.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_small_file(tmp_path: Path) -> None:
    text = HEADER + "1,52,49,416,-9999,R\n1,11.5,5,381.5,Ice in sample,I\n"
    layers = read_density_layers(written(tmp_path, text))
    assert layers.pit == ("1", "1")
    np.testing.assert_allclose(layers.top, [0.52, 0.115], rtol=1e-15)
    np.testing.assert_allclose(layers.bottom, [0.49, 0.05], rtol=1e-15)
    np.testing.assert_allclose(layers.thickness, [0.03, 0.065], rtol=1e-13)
    assert layers.snow_density.tolist() == [416.0, 381.5]
    assert layers.note == ("", "Ice in sample")
    assert layers.kind == ("R", "I")
    assert layers.row.tolist() == [2, 3]


def test_the_real_file() -> None:
    if not REAL.exists():
        pytest.skip("the shared pit densities are not beside this repository")
    layers = read_density_layers(REAL)
    assert len(layers) == 219
    assert len(set(layers.pit)) == 26
    with REAL.open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert sum(layers.snow_density) == pytest.approx(sum(float(row["RHO"]) for row in rows), rel=1e-12)
    assert (layers.snow_density.min(), layers.snow_density.max()) == (120.0, 494.0)
    assert Counter(layers.kind) == {"F": 88, "H": 86, "R": 36, "I": 6, "N": 3}
    assert Counter(layers.note) == {"": 213, "Ice in sample": 6}
    assert layers.row[-1] == 220
    assert np.all(layers.thickness > 0)
    assert layers.top.max() < 1.0  # metres, no centimetres


@pytest.mark.parametrize(
    ("cells", "code", "column"),
    [
        ("1,49,52,416,-9999,R", "out_of_range", "TOP"),
        ("1,49,49,416,-9999,R", "out_of_range", "TOP"),
        ("1,52,-1,416,-9999,R", "out_of_range", "BOTTOM"),
        ("1,52,49,918,-9999,R", "out_of_range", "RHO"),
        ("1,52,49,0,-9999,R", "out_of_range", "RHO"),
        ("1,52,49,heavy,-9999,R", "not_a_number", "RHO"),
        ("1,52,,416,-9999,R", "not_a_number", "BOTTOM"),
        (",52,49,416,-9999,R", "out_of_range", "ID"),
    ],
)
def test_wrong_cells_are_named(tmp_path: Path, cells: str, code: str, column: str) -> None:
    path = written(tmp_path, HEADER + "1,52,49,416,-9999,R\n" + cells + "\n")
    with pytest.raises(FieldDataError) as caught:
        read_density_layers(path)
    (problem,) = caught.value.problems
    found = (problem.code, problem.file, problem.row, problem.column)  # type: ignore[attr-defined]
    assert found == (code, "pits.csv", 3, column)


def test_a_missing_column_is_named(tmp_path: Path) -> None:
    with pytest.raises(FieldDataError, match=r"missing_column.*RHO"):
        read_density_layers(written(tmp_path, "ID,TOP,BOTTOM\n1,52,49\n"))


def test_empty_missing_and_binary_files_are_refused(tmp_path: Path) -> None:
    with pytest.raises(FieldDataError, match="empty_file"):
        read_density_layers(written(tmp_path, ""))
    with pytest.raises(FieldDataError, match=r"gone\.csv"):
        read_density_layers(tmp_path / "gone.csv")
    (tmp_path / "pits.csv").write_bytes(bytes(100))
    with pytest.raises(FieldDataError, match="unreadable_file"):
        read_density_layers(tmp_path / "pits.csv")
