"""Checks of penetration series: reading under the largest load, creep, implausible readings of the unloading."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from ..geometry import in_form
from .quality_flags import CREEP_SHARE, CREEP_STEPS

if TYPE_CHECKING:
    from ..geometry import GeometryForm
    from .records import BoolArray, Campaign, FloatArray, IntArray, PenetrationTests


def reading_at_largest_load(tests: PenetrationTests) -> IntArray:
    """Find the reading under each series' largest load, the last of equals.

    Returns
    -------
    Index into ``tests.load`` and its like, one per experiment.
    """
    peak = np.maximum.reduceat(tests.load, tests.first[:-1]) if len(tests) else np.zeros(0)
    at_peak = np.flatnonzero(tests.load == np.repeat(peak, np.diff(tests.first)))
    last = np.zeros(len(tests), dtype=np.int64)
    last[tests.series_of_reading[at_peak]] = at_peak  # of repeated indices the last assignment stays
    return last


def maximum_depths(campaign: Campaign, tests: PenetrationTests, geometry: GeometryForm) -> FloatArray:
    """Depth (m) beyond which each experiment's tool, in this form, is no longer the body that its name says."""
    limit = np.full(len(tests), np.inf)
    names = np.array(tests.tool, dtype=object)
    for name, tool in campaign.tools.items():
        of_tool = np.flatnonzero(names == name)
        limit[of_tool] = in_form(tool, geometry).greatest_depth(tests.edge_angle[of_tool])
    return limit


_ROUNDING: Final = 1e-9  # relative; readings come from decimal millimetres


def creeping(campaign: Campaign, tests: PenetrationTests) -> BoolArray:
    """Readings whose depth grew under a constant load by more than the limits of `CREEP_STEPS` and `CREEP_SHARE`."""
    if tests.depth_after is None:
        return np.zeros(len(tests.load), dtype=np.bool_)
    step = CREEP_STEPS * (campaign.gauge_resolution or 0.0)
    limit = np.maximum(step, CREEP_SHARE * tests.penetration_depth) * (1 + _ROUNDING)
    return np.asarray(np.nan_to_num(tests.depth_after - tests.penetration_depth) > limit)


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
