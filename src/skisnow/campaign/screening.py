"""Screening of single experiments: their quality flags, which never delete; some exclude by default.

The flags of `NEED_HARDNESS` are set where hardness is estimated.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from .flag_problems import flag_problems
from .penetration_series import creeping, maximum_depths, reading_at_largest_load, wrong_unloading
from .quality_flags import FEWEST_LOADS, NEED_HARDNESS, QUALITY_FLAGS, RESOLUTIONS, QualityFlag

if TYPE_CHECKING:
    from ..geometry import GeometryForm
    from .records import BoolArray, Campaign, FloatArray, PenetrationTests

__all__ = [
    "QUALITY_FLAGS",
    "QualityFlag",
    "flag_problems",
    "maximum_depths",
    "reading_at_largest_load",
    "screen_penetration",
    "screen_shear",
]

_ROUNDING: Final = 1e-9  # relative; limits and readings come from decimal millimetres


def screen_penetration(campaign: Campaign, *, geometry: GeometryForm = "extended") -> dict[str, BoolArray]:
    """Flag the penetration series.

    Parameters
    ----------
    campaign
        The campaign; without penetration tests the masks are empty.
    geometry
        Form of the ski piece, ``"extended"`` or ``"paper"``; it decides on ``beyond_tool``.

    Returns
    -------
    For each code but those of `NEED_HARDNESS`, in the order of `QUALITY_FLAGS`, a mask over the experiments.
    """
    tests = campaign.penetration
    if tests is None:
        return {code: np.zeros(0, dtype=np.bool_) for code in QUALITY_FLAGS if code not in NEED_HARDNESS}
    largest_depth = tests.penetration_depth[reading_at_largest_load(tests)]
    deepest = np.maximum.reduceat(tests.penetration_depth, tests.first[:-1]) if len(tests) else np.zeros(0)
    return {
        "cancelled": _is_given(tests.cancelled),
        "too_few_loads": np.diff(tests.first) < FEWEST_LOADS,
        "loads_not_rising": _any_step(tests, _step(tests.load) <= 0),
        "depth_shrinks": _any_step(tests, _step(tests.penetration_depth) < 0),
        "zero_depth": largest_depth == 0,
        "beyond_tool": deepest > maximum_depths(campaign, tests, geometry) * (1 + _ROUNDING),
        "below_resolution": _is_below_resolution(largest_depth, campaign.gauge_resolution),
        "creeps": _any_reading(tests, creeping(campaign, tests)),
        **{code: _flagged_series(tests, bad) for code, bad in wrong_unloading(campaign, tests).items()},
    }


def _any_reading(tests: PenetrationTests, bad: BoolArray) -> BoolArray:
    found = np.zeros(len(tests), dtype=np.bool_)
    found[tests.series_of_reading[bad]] = True
    return found


def _flagged_series(tests: PenetrationTests, bad: BoolArray) -> BoolArray:
    found = np.zeros(len(tests), dtype=np.bool_)
    if tests.unloading is not None:
        found[tests.unloading.series_of_reading[bad]] = True
    return found


def screen_shear(campaign: Campaign) -> dict[str, BoolArray]:
    """Flag the shear tests: masks over them for ``cancelled``, ``zero_depth`` and ``below_resolution``."""
    tests = campaign.shear
    depth = tests.penetration_depth if tests is not None else np.zeros(0)
    return {
        "cancelled": _is_given(tests.cancelled if tests is not None else ()),
        "zero_depth": depth == 0,
        "below_resolution": _is_below_resolution(depth, campaign.gauge_resolution),
    }


def _is_given(reasons: tuple[str, ...]) -> BoolArray:
    return np.fromiter(map(bool, reasons), dtype=np.bool_, count=len(reasons))


def _step(values: FloatArray) -> FloatArray:
    """Difference to the reading before; the file's very first has none and counts as rising."""
    return np.diff(values, prepend=-np.inf)


def _any_step(tests: PenetrationTests, bad: BoolArray) -> BoolArray:
    within = bad.copy()
    within[tests.first[:-1]] = False  # a step from one series into the next
    counts = np.bincount(tests.series_of_reading[within], minlength=len(tests))
    return counts > 0


def _is_below_resolution(depth: FloatArray, resolution: float | None) -> BoolArray:
    if resolution is None:
        return np.zeros(len(depth), dtype=np.bool_)
    return depth < RESOLUTIONS * resolution * (1 - _ROUNDING)
