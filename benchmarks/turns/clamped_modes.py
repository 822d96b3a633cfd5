"""First clamped frequencies of our ski: what a peer's model must have before its time means anything."""

from __future__ import annotations

from typing import Any, Final, TypeAlias

import numpy as np
import numpy.typing as npt
from scipy.linalg import eigh
from tests.ski.beam.dense import dense

from skisnow.ski.beam import clamped
from skisnow.ski.ski import Ski

FloatArray: TypeAlias = npt.NDArray[np.float64]

CLAMP_LENGTH: Final = 0.3
"""Of the ski of the scenario (m)."""
ELEMENTS: Final = 40
TWIST: Final = 2
"""Place of the twist among a node's unknowns."""


def first_frequencies(ski: Ski) -> tuple[float, float]:
    """Of bending and of torsion of the ski, held over `CLAMP_LENGTH` (Hz)."""
    model = clamped(ski, CLAMP_LENGTH, ELEMENTS)
    stiffness, mass = dense(model.stiffness), dense(model.mass)
    twist = np.arange(model.size) % 3 == TWIST
    return first_frequency(stiffness, mass, ~twist), first_frequency(stiffness, mass, twist)


def first_frequency(stiffness: FloatArray, mass: FloatArray, part: npt.NDArray[Any]) -> float:
    """Lowest frequency of K u = ω² M u in part of the unknowns (Hz)."""
    inside = np.ix_(part, part)
    lowest = eigh(stiffness[inside], mass[inside], eigvals_only=True, subset_by_index=[0, 0])[0]
    return float(np.sqrt(lowest) / (2.0 * np.pi))
