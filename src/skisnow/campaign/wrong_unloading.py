"""Readings of the unloading that cannot be: a load that does not fall, a tool that goes deeper under less."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from .largest_load import reading_at_largest_load

if TYPE_CHECKING:
    from .records import BoolArray, Campaign, PenetrationTests

_ROUNDING: Final = 1e-9  # relative; readings come from decimal millimetres


def wrong_unloading(campaign: Campaign, tests: PenetrationTests) -> dict[str, BoolArray]:
    """For ``unloading_not_falling`` and ``unloading_sinks`` a mask over the readings of the unloading.

    The first reading of a series may repeat the one under its largest load; a step of the gauge is no sinking.
    """
    if tests.unloading is None:
        return dict.fromkeys(("unloading_not_falling", "unloading_sinks"), np.zeros(0, dtype=np.bool_))
    unloading = tests.unloading
    largest = reading_at_largest_load(tests)[unloading.series_of_reading]
    begins = np.diff(unloading.series_of_reading, prepend=-1) > 0
    load_before = np.where(begins, tests.load[largest], np.roll(unloading.load, 1))
    depth_before = np.where(begins, tests.penetration_depth[largest], np.roll(unloading.penetration_depth, 1))
    step = (campaign.gauge_resolution or 0.0) * (1 + _ROUNDING)
    return {
        "unloading_not_falling": (unloading.load > load_before) | (~begins & (unloading.load == load_before)),
        "unloading_sinks": unloading.penetration_depth - depth_before > step,
    }
