"""Screening of single experiments: their quality flags, which never delete; some exclude by default.

The flags of `NEED_HARDNESS` are set where hardness is estimated.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Final

import numpy as np

from .._support.arrays import BoolArray, FloatArray, IntArray
from .._support.messages import Message, template
from .._support.units import MM
from ..geometry import GeometryForm, in_form
from . import problems
from .problems import QUALITY_FLAGS, Problem, with_sheet_name
from .reading.table_forms import PENETRATION, SHEAR
from .records import Campaign, PenetrationTests

_ROUNDING: Final = 1e-9  # relative; limits and readings come from decimal millimetres


def screen_penetration(campaign: Campaign, *, geometry: GeometryForm = "extended") -> dict[str, BoolArray]:
    """Quality flags of the penetration series, without those of `NEED_HARDNESS`.

    campaign: the campaign; without penetration tests the masks are empty.
    geometry: form of the ski piece, ``"extended"`` or ``"paper"``; it decides on ``beyond_tool``.
    Returns: mask over the experiments for each code, in the order of `QUALITY_FLAGS`.
    """
    tests = campaign.penetration
    if tests is None:
        return {code: np.zeros(0, dtype=np.bool_) for code in QUALITY_FLAGS if code not in problems.NEED_HARDNESS}
    series = tests.series_of_reading
    unloaded = np.zeros(0, dtype=np.int64) if tests.unloading is None else tests.unloading.series_of_reading
    masks = {}
    for code, bad in _bad_readings(campaign, tests, geometry).items():
        masks[code] = np.zeros(len(tests), dtype=np.bool_)
        masks[code][(unloaded if code in _OF_UNLOADING else series)[bad]] = True
    return masks


def _bad_readings(campaign: Campaign, tests: PenetrationTests, geometry: GeometryForm) -> dict[str, BoolArray]:
    """Masks over the readings (n,) that cause a flag, by code; those of `_OF_UNLOADING` are over unloading readings."""
    series, depth, starts = tests.series_of_reading, tests.penetration_depth, tests.first[:-1]
    begins, largest = (np.zeros(len(depth), dtype=np.bool_) for _ in range(2))
    begins[starts] = True
    largest[reading_at_largest_load(tests)] = True
    deepest = np.maximum.reduceat(depth, starts) if len(tests) else np.zeros(0)
    limit = maximum_depths(campaign, tests, geometry) * (1 + _ROUNDING)
    return {
        "cancelled": begins & (np.array(tests.cancelled, dtype=object) != "")[series],
        "too_few_loads": begins & (np.diff(tests.first) < problems.FEWEST_LOADS)[series],
        "loads_not_rising": ~begins & (np.diff(tests.load, prepend=0.0) <= 0),
        "depth_shrinks": ~begins & (np.diff(depth, prepend=0.0) < 0),
        "zero_depth": largest & (depth == 0),
        "beyond_tool": (depth == deepest[series]) & (depth > limit[series]),
        "below_resolution": largest & (depth < _smallest_usable_depth(campaign) * (1 - _ROUNDING)),
        "creeps": _creeping_readings(campaign, tests),
        **_implausible_unloading(campaign, tests),
    }


def screen_shear(campaign: Campaign) -> dict[str, BoolArray]:
    """Quality flags of the shear tests: masks over them for ``cancelled``, ``zero_depth``, ``below_resolution``."""
    tests = campaign.shear
    depth = tests.penetration_depth if tests is not None else np.zeros(0)
    reasons: tuple[str, ...] = tests.cancelled if tests is not None else ()
    return {
        "cancelled": np.array(reasons, dtype=object) != "",
        "zero_depth": depth == 0,
        "below_resolution": depth < _smallest_usable_depth(campaign) * (1 - _ROUNDING),
    }


def _smallest_usable_depth(campaign: Campaign) -> float:
    """Smallest depth (m) that the gauge resolves well enough; 0 if its step is not stated."""
    return problems.RESOLUTIONS * (campaign.gauge_resolution or 0.0)


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


def _creeping_readings(campaign: Campaign, tests: PenetrationTests) -> BoolArray:
    """True for readings whose depth grew under constant load by more than `CREEP_STEPS` and `CREEP_SHARE` allow."""
    if tests.depth_after is None:
        return np.zeros(len(tests.load), dtype=np.bool_)
    step = problems.CREEP_STEPS * (campaign.gauge_resolution or 0.0)
    limit = np.maximum(step, problems.CREEP_SHARE * tests.penetration_depth) * (1 + _ROUNDING)
    return np.asarray(np.nan_to_num(tests.depth_after - tests.penetration_depth) > limit)


def _implausible_unloading(campaign: Campaign, tests: PenetrationTests) -> dict[str, BoolArray]:
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


_ALLOWED: Final = {
    "cancelled": template("a blank status"),
    "too_few_loads": template("at least {fewest_loads} load steps"),
    "loads_not_rising": template("more than the {load_before:.10g} N of the reading before"),
    "depth_shrinks": template("at least the {depth_before:.10g} mm of the reading before"),
    "zero_depth": template("a depth above 0 mm"),
    "beyond_tool": template("at most {limit:.10g} mm for the tool {tool!r} at this edge angle"),
    "below_resolution": template("at least {resolutions:g} steps of the gauge, {smallest_depth:.10g} mm"),
    "layered": template("depths that grow with the load as F = H_V V has it"),
    "creeps": template("at most {creep_steps:g} steps of the gauge or {creep_share:.0%} more than {depth:.10g} mm"),
    "unloading_not_falling": template("less than the load of the reading before"),
    "unloading_sinks": template("at most the depth of the reading before and one step of the gauge"),
    "rebound_unresolved": template(
        "a rebound that is large compared with the step of the gauge and the scatter of the readings"
    ),
    "hardness_outlier": template("a logarithm of the hardness nearer to its site's median"),
}
"""Values of an experiment without the flag, by code."""
_COLUMNS: Final = {
    **dict.fromkeys(("too_few_loads", "loads_not_rising", "unloading_not_falling"), "load_N"),
    "cancelled": "status",
    "creeps": "depth_after_mm",
    "hardness_outlier": None,
}
"""Column that causes a flag, if it is not that of the depth."""
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
    flags: list[Problem] = []
    if campaign.penetration is not None:
        flags += _penetration_problems(campaign, campaign.penetration, masks_penetration, geometry)
    if (tests := campaign.shear) is not None:
        for index, code in _flagged_experiments(masks_shear):
            value = tests.cancelled[index] if code == "cancelled" else _number(tests.penetration_depth[index] / MM)
            flags.append(_flag(campaign, code, SHEAR.file, int(tests.row[index]), tests.experiment[index], value))
    return [with_sheet_name(flag, campaign.places) for flag in flags]


def _flagged_experiments(masks: Mapping[str, BoolArray]) -> Iterator[tuple[int, str]]:
    """Index of an experiment and code of a flag, for every flag that applies."""
    codes = [code for code in QUALITY_FLAGS if code in masks]
    if codes:
        for index, which in np.argwhere(np.stack([masks[code] for code in codes], axis=1)).tolist():
            yield index, codes[which]


def _number(value: float) -> Message:
    """Message of a number, so that it gets the decimal sign of the language in which a problem is shown."""
    return Message("{value:.10g}", value=value)


def _penetration_problems(
    campaign: Campaign, tests: PenetrationTests, masks: Mapping[str, BoolArray], geometry: GeometryForm
) -> Iterator[Problem]:
    """Problems of penetration experiments, each at the first reading that causes the flag."""
    bad, largest = _bad_readings(campaign, tests, geometry), reading_at_largest_load(tests)
    limit = maximum_depths(campaign, tests, geometry)
    for index, code in _flagged_experiments(masks):
        readings = tests.unloading if code in _OF_UNLOADING and tests.unloading is not None else tests
        first, end = readings.first[index : index + 2].tolist()
        if code in bad:
            reading = first + int(np.argmax(bad[code][first:end]))
        else:
            reading = end - 1 if code == "rebound_unresolved" else int(largest[index])
        load, depth = readings.load, readings.penetration_depth
        value = {"cancelled": tests.cancelled[index], "too_few_loads": str(end - first)}.get(code)
        if value is None and code in bad:
            lengths = tests.depth_after if code == "creeps" and tests.depth_after is not None else depth
            value = _number(load[reading] if _COLUMNS.get(code) == "load_N" else lengths[reading] / MM)
        yield _flag(
            campaign,
            code,
            PENETRATION.file,
            int(readings.row[reading]),
            tests.experiment[index],
            value,
            load_before=load[reading - 1],
            depth_before=depth[reading - 1] / MM,
            depth=depth[reading] / MM,
            limit=limit[index] / MM,
            tool=tests.tool[index],
        )


def _flag(
    campaign: Campaign, code: str, file: str, row: int, experiment: str, value: str | None, **fields: object
) -> Problem:
    """Problem of severity ``flag`` for an experiment; `fields` fill the template of the allowed values."""
    action = Message("The experiment is only flagged and included in the estimates; look at it.")
    if code in campaign.excluding:
        action = Message("The experiment is kept and counted, but not included in the estimates.")
    allowed = Message(
        _ALLOWED[code],
        fewest_loads=problems.FEWEST_LOADS,
        resolutions=problems.RESOLUTIONS,
        smallest_depth=_smallest_usable_depth(campaign) / MM,
        creep_steps=problems.CREEP_STEPS,
        creep_share=problems.CREEP_SHARE,
        **fields,
    )
    column = _COLUMNS.get(code, "depth_mm")
    return Problem(
        "flag", code, file, row=row, column=column, experiment=experiment, value=value, allowed=allowed, action=action
    )
