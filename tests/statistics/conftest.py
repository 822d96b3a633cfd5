"""Certified data of the NIST Statistical Reference Datasets, where they are next to this repository."""

import csv
from collections.abc import Callable
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

FOLDER = Path(__file__).resolve().parents[3] / "shared" / "data" / "regression"


def _present(name: str) -> Path:
    path = FOLDER / name
    if not path.exists():
        pytest.skip(f"certified data {name} are not next to this repository")
    return path


@pytest.fixture
def table() -> Callable[[str], list[list[str]]]:
    """Rows of a CSV file of the certified data, header first."""

    def read(name: str) -> list[list[str]]:
        with _present(name).open(encoding="ascii", newline="") as file:
            return list(csv.reader(file))

    return read


@pytest.fixture
def digits() -> Callable[[npt.ArrayLike, npt.ArrayLike], float]:
    """Fewest significant digits in which found values agree with certified ones."""

    def count(found: npt.ArrayLike, certified: npt.ArrayLike) -> float:
        truth = np.asarray(certified, dtype=float)
        error = np.max(np.abs(np.asarray(found, dtype=float) - truth) / np.abs(truth))
        return float(-np.log10(max(float(error), 1e-16)))

    return count
