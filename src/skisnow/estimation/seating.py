"""Seating: the offset of the depth zero of each series, and its effect on the hardness of Eqn 1.

If the tool touches the snow at a gauge reading δ instead of 0, all depths of the series are δ too large: at H_V =
10 N/mm³ and 45° a seating of 0.1 mm on 0.7 mm of depth already moves H_V by a third. Often the largest systematic
error.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from .._support.display import ShownFields

if TYPE_CHECKING:
    from .campaign_model import CampaignModel
    from .readings import Readings

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True, repr=False)
class Seating(ShownFields):
    """Depth zero of m series: the tool touched at gauge reading ``offset``; true depth = reading - offset.

    Attributes
    ----------
    offset, interval
        δ (m) and its 95 % interval (m, 2), from `campaign_model`; NaN with fewer than two readings in contact.
    hardness_change
        Relative change of the largest-load H_V when δ is subtracted from its depth; NaN where no depth remains.
    """

    offset: FloatArray
    interval: FloatArray
    hardness_change: FloatArray


def seating(readings: Readings, model: CampaignModel) -> Seating:
    """Offset of each series, and the change of H_V of Eqn 1."""
    return Seating(model.offset, model.offset_interval, _hardness_change(readings, model.offset))


def _hardness_change(readings: Readings, offset: FloatArray) -> FloatArray:
    """V(e₇)/V(e₇ - δ) - 1: how the hardness of Eqn 1 moves when δ is taken off the depth."""
    depth = readings.penetration_depth[readings.largest]
    left = depth - offset
    corrected = readings.volume_of_series(np.where(left > 0, left, 0.0))
    volume = readings.displaced_volume[readings.largest]
    return np.divide(volume, corrected, out=np.full(volume.shape, np.nan), where=(left > 0) & (corrected > 0)) - 1.0
