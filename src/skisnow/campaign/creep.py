"""Creep: a depth that goes on growing under a constant load, for which the paper cancelled a series."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from .quality_flags import CREEP_SHARE, CREEP_STEPS

if TYPE_CHECKING:
    from .records import BoolArray, Campaign, PenetrationTests

_ROUNDING: Final = 1e-9  # relative; readings come from decimal millimetres


def creeping(campaign: Campaign, tests: PenetrationTests) -> BoolArray:
    """Readings whose depth grew under a constant load by more than the limits of `CREEP_STEPS` and `CREEP_SHARE`."""
    if tests.depth_after is None:
        return np.zeros(len(tests.load), dtype=np.bool_)
    step = CREEP_STEPS * (campaign.gauge_resolution or 0.0)
    limit = np.maximum(step, CREEP_SHARE * tests.penetration_depth) * (1 + _ROUNDING)
    return np.asarray(np.nan_to_num(tests.depth_after - tests.penetration_depth) > limit)
