"""Per penetration series: the reading under the largest load, and the depth to which its tool is what it is called."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..geometry import in_form

if TYPE_CHECKING:
    from ..geometry import GeometryForm
    from .records import Campaign, FloatArray, IntArray, PenetrationTests


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
