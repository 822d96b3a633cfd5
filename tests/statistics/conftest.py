"""Certified data of the NIST Statistical Reference Datasets, where they are next to this repository."""

import csv
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

from skisnow._support.arrays import FloatArray

FOLDER = Path(__file__).resolve().parents[3] / "shared" / "data" / "regression"


class NistFile:
    """A .dat file of NIST: lines of text, numbers of the certified part, rows of data."""

    def __init__(self, path: Path) -> None:
        self.lines = path.read_text(encoding="ascii").splitlines()

    def numbers_after(self, label: str) -> list[float]:
        """All numbers behind the first occurrence of a label in its line."""
        line = next(line for line in self.lines if label in line)
        return [float(word) for word in re.findall(r"[-+]?\d+\.?\d*(?:E[-+]\d+)?", line.split(label, 1)[1])]

    @property
    def data(self) -> FloatArray:
        start = max(i for i, line in enumerate(self.lines) if line.startswith("Data:")) + 1
        return np.array([[float(word) for word in line.split()] for line in self.lines[start:] if line.strip()])


def _present(name: str) -> Path:
    path = FOLDER / name
    if not path.exists():
        pytest.skip(f"certified data {name} are not next to this repository")
    return path


@pytest.fixture
def nist() -> Callable[[str], NistFile]:
    return lambda name: NistFile(_present(f"{name}.dat"))


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
