"""Screening of single experiments: their quality flags, which never delete; some exclude by default.

The flags of `NEED_HARDNESS` are set where hardness is estimated.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Final, TypeAlias

import numpy as np

from .._support.arrays import BoolArray, FloatArray, IntArray
from .._support.messages import Message
from .._support.units import MM
from ..geometry import GeometryForm, in_form
from .problems import (
    CREEP_SHARE,
    CREEP_STEPS,
    FEWEST_LOADS,
    NEED_HARDNESS,
    QUALITY_FLAGS,
    RESOLUTIONS,
    Problem,
    QualityFlag,
    with_sheet_name,
)
from .reading.table_forms import PENETRATION, SHEAR
from .records import Campaign, PenetrationTests, UnloadingReadings

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

    campaign: the campaign; without penetration tests the masks are empty.
    geometry: form of the ski piece, ``"extended"`` or ``"paper"``; it decides on ``beyond_tool``.
    Returns: for each code but those of `NEED_HARDNESS`, in the order of `QUALITY_FLAGS`, a mask over the experiments.
    """
    tests = campaign.penetration
    if tests is None:
        return {code: np.zeros(0, dtype=np.bool_) for code in QUALITY_FLAGS if code not in NEED_HARDNESS}
    largest_depth = tests.penetration_depth[reading_at_largest_load(tests)]
    deepest = np.maximum.reduceat(tests.penetration_depth, tests.first[:-1]) if len(tests) else np.zeros(0)
    unloaded = np.zeros(0, dtype=np.int64) if tests.unloading is None else tests.unloading.series_of_reading
    return {
        "cancelled": _is_filled(tests.cancelled),
        "too_few_loads": np.diff(tests.first) < FEWEST_LOADS,
        "loads_not_rising": _any_step(tests, _step(tests.load) <= 0),
        "depth_shrinks": _any_step(tests, _step(tests.penetration_depth) < 0),
        "zero_depth": largest_depth == 0,
        "beyond_tool": deepest > maximum_depths(campaign, tests, geometry) * (1 + _ROUNDING),
        "below_resolution": _is_below_resolution(largest_depth, campaign.gauge_resolution),
        "creeps": _any_reading(tests.series_of_reading, find_creep(campaign, tests), len(tests)),
        **{
            code: _any_reading(unloaded, bad, len(tests))
            for code, bad in find_implausible_unloading(campaign, tests).items()
        },
    }


def _any_reading(series: IntArray, bad: BoolArray, count: int) -> BoolArray:
    """True (count,) for series with at least one of the bad readings (n,), given the series of each reading."""
    flagged = np.zeros(count, dtype=np.bool_)
    flagged[series[bad]] = True
    return flagged


def screen_shear(campaign: Campaign) -> dict[str, BoolArray]:
    """Flag the shear tests: masks over them for ``cancelled``, ``zero_depth`` and ``below_resolution``."""
    tests = campaign.shear
    depth = tests.penetration_depth if tests is not None else np.zeros(0)
    return {
        "cancelled": _is_filled(tests.cancelled if tests is not None else ()),
        "zero_depth": depth == 0,
        "below_resolution": _is_below_resolution(depth, campaign.gauge_resolution),
    }


def _is_filled(reasons: tuple[str, ...]) -> BoolArray:
    return np.fromiter(map(bool, reasons), dtype=np.bool_, count=len(reasons))


def _step(values: FloatArray) -> FloatArray:
    """Difference from the previous reading; infinite for the first reading of the file."""
    return np.diff(values, prepend=-np.inf)


def _any_step(tests: PenetrationTests, bad: BoolArray) -> BoolArray:
    """True (m,) for series with a bad reading (n,) after their first one."""
    within = bad.copy()
    within[tests.first[:-1]] = False  # a step from one series into the next
    counts = np.bincount(tests.series_of_reading[within], minlength=len(tests))
    return counts > 0


def _is_below_resolution(depth: FloatArray, resolution: float | None) -> BoolArray:
    if resolution is None:
        return np.zeros(len(depth), dtype=np.bool_)
    return depth < RESOLUTIONS * resolution * (1 - _ROUNDING)


def reading_at_largest_load(tests: PenetrationTests) -> IntArray:
    """Index into ``tests.load`` of each experiment's reading under its largest load, the last one of equal loads."""
    peak = np.maximum.reduceat(tests.load, tests.first[:-1]) if len(tests) else np.zeros(0)
    at_peak = np.flatnonzero(tests.load == np.repeat(peak, np.diff(tests.first)))
    last = np.zeros(len(tests), dtype=np.int64)
    last[tests.series_of_reading[at_peak]] = at_peak  # of repeated indices the last assignment stays
    return last


def maximum_depths(campaign: Campaign, tests: PenetrationTests, geometry: GeometryForm) -> FloatArray:
    """Depth (m) up to which the shape of each experiment's tool is valid."""
    limit = np.full(len(tests), np.inf)
    names = np.array(tests.tool, dtype=object)
    for name, tool in campaign.tools.items():
        of_tool = np.flatnonzero(names == name)
        limit[of_tool] = in_form(tool, geometry).maximum_depth(tests.edge_angle[of_tool])
    return limit


def find_creep(campaign: Campaign, tests: PenetrationTests) -> BoolArray:
    """True for readings whose depth grew under constant load by more than `CREEP_STEPS` and `CREEP_SHARE` allow."""
    if tests.depth_after is None:
        return np.zeros(len(tests.load), dtype=np.bool_)
    step = CREEP_STEPS * (campaign.gauge_resolution or 0.0)
    limit = np.maximum(step, CREEP_SHARE * tests.penetration_depth) * (1 + _ROUNDING)
    return np.asarray(np.nan_to_num(tests.depth_after - tests.penetration_depth) > limit)


def find_implausible_unloading(campaign: Campaign, tests: PenetrationTests) -> dict[str, BoolArray]:
    """Masks over the readings of the unloading, for ``unloading_not_falling`` and ``unloading_sinks``.

    The first reading of a series can repeat the one under its largest load. One step of the gauge does not count as
    sinking.
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


_UNFLAGGED_STATUS = Message("a blank status")
_UNFLAGGED_ZERO = Message("a depth above 0 mm")
_OF_UNLOADING = ("unloading_not_falling", "unloading_sinks", "rebound_unresolved")


def flag_problems(
    campaign: Campaign,
    masks_penetration: Mapping[str, BoolArray],
    masks_shear: Mapping[str, BoolArray],
    *,
    geometry: GeometryForm = "extended",
) -> list[Problem]:
    """List every quality flag as a problem of severity ``flag``.

    campaign: the campaign that was screened.
    masks_penetration, masks_shear: masks by code over the experiments, from screening or with further codes of
        `QUALITY_FLAGS`.
    geometry: form of the ski piece in the screening.
    Returns: problems of penetration before shear, in the order of the file, then of `QUALITY_FLAGS`.
    """
    problems: list[Problem] = []
    if campaign.penetration is not None:
        flagged = _FlaggedReadings(campaign, campaign.penetration, geometry)
        problems += [flagged.problem(index, code) for index, code in _flagged_experiments(masks_penetration)]
    if campaign.shear is not None:
        problems += [_shear_problem(campaign, index, code) for index, code in _flagged_experiments(masks_shear)]
    return [with_sheet_name(problem, campaign.places) for problem in problems]


def _flagged_experiments(masks: Mapping[str, BoolArray]) -> Iterator[tuple[int, str]]:
    codes = [code for code in QUALITY_FLAGS if code in masks]
    if codes:
        for index, which in np.argwhere(np.stack([masks[code] for code in codes], axis=1)).tolist():
            yield index, codes[which]


def _resolution_limit(campaign: Campaign) -> Message:
    step = 0.0 if campaign.gauge_resolution is None else campaign.gauge_resolution
    return Message(
        "at least {count:g} steps of the gauge, {depth:.10g} mm", count=RESOLUTIONS, depth=RESOLUTIONS * step / MM
    )


def _number(value: float) -> Message:
    """The value, with the decimal sign of the language in which a problem is shown."""
    return Message("{value:.10g}", value=value)


def _shear_problem(campaign: Campaign, index: int, code: str) -> Problem:
    tests = campaign.shear
    assert tests is not None
    depth = _number(tests.penetration_depth[index] / MM)
    cause = {
        "cancelled": ("status", tests.cancelled[index], _UNFLAGGED_STATUS),
        "zero_depth": ("depth_mm", depth, _UNFLAGGED_ZERO),
        "below_resolution": ("depth_mm", depth, _resolution_limit(campaign)),
    }[code]
    return _flag(campaign, code, SHEAR.file, int(tests.row[index]), tests.experiment[index], *cause)


def _flag(
    campaign: Campaign, code: str, file: str, row: int, name: str, column: str | None, value: str | None, allowed: str
) -> Problem:
    action = (
        Message("The experiment is kept and counted, but not included in the estimates.")
        if code in campaign.excluding
        else Message("The experiment is only flagged and included in the estimates; look at it.")
    )
    return Problem(
        "flag", code, file, row=row, column=column, experiment=name, value=value, allowed=allowed, action=action
    )


_Cause: TypeAlias = tuple[int, str | None, str | None, str]
"""Index of the reading that causes a flag, column, value (None without one of them), and the allowed values."""


class _FlaggedReadings:
    """Problems of penetration experiments, each at the reading that causes a flag."""

    def __init__(self, campaign: Campaign, tests: PenetrationTests, geometry: GeometryForm) -> None:
        self._campaign = campaign
        self._tests = tests
        self._largest = reading_at_largest_load(tests)
        self._limit = maximum_depths(campaign, tests, geometry)

    def problem(self, index: int, code: str) -> Problem:
        """One flag as a problem."""
        in_unloading = code in _OF_UNLOADING
        cause = self._unloading_cause(index, code) if in_unloading else self._cause(index, code)
        reading, column, value, allowed = cause
        row = int((self._unloading if in_unloading else self._tests).row[reading])
        return _flag(self._campaign, code, PENETRATION.file, row, self._tests.experiment[index], column, value, allowed)

    def _cause(self, index: int, code: str) -> _Cause:
        tests, largest = self._tests, int(self._largest[index])
        first, end = tests.first[index : index + 2].tolist()
        load, depth = tests.load[first:end], tests.penetration_depth[first:end]
        reading, column, value = largest, "depth_mm", self._depth(largest)
        match code:
            case "cancelled":
                return first, "status", tests.cancelled[index], _UNFLAGGED_STATUS
            case "too_few_loads":
                reading, column, value = first, "load_N", str(end - first)
                allowed = Message("at least {count} load steps", count=FEWEST_LOADS)
            case "zero_depth":
                allowed = _UNFLAGGED_ZERO
            case "below_resolution":
                allowed = _resolution_limit(self._campaign)
            case "layered":
                allowed = Message("depths that grow with the load as F = H_V V has it")
                return reading, column, None, allowed
            case "loads_not_rising":
                reading = first + 1 + int(np.flatnonzero(np.diff(load) <= 0)[0])
                column, value = "load_N", _number(tests.load[reading])
                before = tests.load[reading - 1]
                allowed = Message("more than the {load:.10g} N of the reading before", load=before)
            case "depth_shrinks":
                reading = first + 1 + int(np.flatnonzero(np.diff(depth) < 0)[0])
                value = self._depth(reading)
                allowed = Message("at least the {depth} mm of the reading before", depth=self._depth(reading - 1))
            case "beyond_tool":
                reading = first + int(np.argmax(depth))
                value = self._depth(reading)
                allowed = Message(
                    "at most {limit:.10g} mm for the tool {tool!r} at this edge angle",
                    limit=self._limit[index] / MM,
                    tool=tests.tool[index],
                )
            case "creeps":
                assert tests.depth_after is not None
                reading = first + int(np.flatnonzero(find_creep(self._campaign, tests)[first:end])[0])
                column, value = "depth_after_mm", _number(tests.depth_after[reading] / MM)
                allowed = Message(
                    "at most {creep_steps:g} steps of the gauge or {creep_share:.0%} more than {depth} mm",
                    creep_steps=CREEP_STEPS,
                    creep_share=CREEP_SHARE,
                    depth=self._depth(reading),
                )
            case _:  # hardness_outlier
                return reading, None, None, Message("a logarithm of the hardness nearer to its site's median")
        return reading, column, value, allowed

    def _unloading_cause(self, index: int, code: str) -> _Cause:
        unloading = self._unloading
        if code == "rebound_unresolved":
            allowed = Message(
                "a rebound that is large compared with the step of the gauge and the scatter of the readings"
            )
            return int(unloading.first[index + 1]) - 1, "depth_mm", None, allowed
        own = unloading.series_of_reading == index
        reading = int(np.flatnonzero(find_implausible_unloading(self._campaign, self._tests)[code] & own)[0])
        if code == "unloading_not_falling":
            allowed = Message("less than the load of the reading before")
            return reading, "load_N", _number(unloading.load[reading]), allowed
        allowed = Message("at most the depth of the reading before and one step of the gauge")
        return reading, "depth_mm", _number(unloading.penetration_depth[reading] / MM), allowed

    def _depth(self, reading: int) -> str:
        """Depth in mm, without the unit."""
        return _number(self._tests.penetration_depth[reading] / MM)

    @property
    def _unloading(self) -> UnloadingReadings:
        assert self._tests.unloading is not None
        return self._tests.unloading
