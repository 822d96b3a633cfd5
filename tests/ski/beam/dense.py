"""Dense matrices of banded ones, and the deflection of a beam at any station."""

import numpy as np
import numpy.typing as npt

from skisnow._support.arrays import FloatArray
from skisnow.ski.beam import HALF_BANDWIDTH, ClampedSki, base_motion, beam_rows


def dense(matrix: FloatArray) -> FloatArray:
    """The banded matrix as a dense (size, size) array."""
    size, full = len(matrix), np.zeros((len(matrix), len(matrix)))
    for i in range(size):
        for j in range(max(0, i - HALF_BANDWIDTH), min(size, i + HALF_BANDWIDTH + 1)):
            full[i, j] = matrix[i, j - i + HALF_BANDWIDTH]
    return full


def beam_at(model: ClampedSki, u: FloatArray, station: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Deflection (m) and twist (rad) of the base relative to the boot at stations (m), for the unknowns u (size,)."""
    return base_motion(u, *beam_rows(model, station))
