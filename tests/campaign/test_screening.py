"""Quality flags on single experiments: each at its limit, from both sides, with the reading that it is about."""

import dataclasses
import itertools
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.present import present

from skisnow._support.messages import Message
from skisnow.campaign import (
    QUALITY_FLAGS,
    Campaign,
    PenetrationTests,
    Problem,
    ShearTests,
    flag_problems,
    screen_penetration,
    screen_shear,
)
from skisnow.campaign.problems import lines_of, warning
from skisnow.campaign.records import UnloadingReadings
from skisnow.campaign.screening import reading_at_largest_load
from skisnow.geometry import Disc, GeometryForm, LyingCylinder, SkiPiece

Series = list[tuple[float, float]]  # load in N, depth in mm
TOOLS = {"ski": SkiPiece(0.2, 0.062), "disc": Disc(0.06), "roll": LyingCylinder(0.05, 0.1)}
GOOD: Series = [(70.5, 1.0), (140.5, 2.0), (210.5, 3.0)]
CODES = [
    "cancelled", "too_few_loads", "loads_not_rising", "depth_shrinks", "zero_depth", "beyond_tool", "below_resolution",
    "creeps", "unloading_not_falling", "unloading_sinks",
]  # fmt: skip


def campaign_of(
    *series: Series, tool: str = "ski", angle_deg: float = 30.0, resolution_mm: float | None = 0.01
) -> Campaign:
    readings = [reading for each in series for reading in each]
    count = len(series)
    tests = PenetrationTests(
        experiment=tuple(f"P{index}" for index in range(count)),
        site=("s",) * count,
        tool=(tool,) * count,
        spot=("",) * count,
        edge_angle=np.full(count, math.radians(angle_deg)),
        snow_density=np.full(count, np.nan),
        drop_cone_depth=np.full(count, np.nan),
        cancelled=("",) * count,
        first=np.cumsum([0, *map(len, series)]),
        load=np.array([load for load, _ in readings]),
        penetration_depth=np.array([depth for _, depth in readings]) * 1e-3,
        row=np.arange(len(readings)) + 2,
    )
    return Campaign(
        name="c", place="", observers=(), folder=Path(),
        gauge_resolution=None if resolution_mm is None else resolution_mm * 1e-3, load_uncertainty=None,
        moment_uncertainty=None, lever_arm_uncertainty=None, load_steps=(), tools=TOOLS, plates={"b": 0.2},
        excluding=frozenset(code for code, flag in QUALITY_FLAGS.items() if flag.excludes_by_default),
        penetration=tests, shear=None, density=None, drop_cone=None, problems=(), file_hashes={},
    )  # fmt: skip


def shear_campaign(depth_mm: list[float], cancelled: list[str], resolution_mm: float | None = 0.01) -> Campaign:
    count = len(depth_mm)
    ones = np.ones(count)
    tests = ShearTests(
        experiment=tuple(f"S{index}" for index in range(count)), site=("s",) * count, plate=("b",) * count,
        spot=("",) * count, edge_angle=ones, penetration_depth=np.array(depth_mm) * 1e-3, lever_arm=ones, moment=ones,
        snow_density=ones, drop_cone_depth=ones, cancelled=tuple(cancelled), row=np.arange(count) + 2,
    )  # fmt: skip
    return dataclasses.replace(campaign_of(GOOD, resolution_mm=resolution_mm), penetration=None, shear=tests)


def flagged(campaign: Campaign, index: int = 0, geometry: GeometryForm = "extended") -> list[str]:
    masks = screen_penetration(campaign, geometry=geometry)
    assert list(masks) == CODES
    return [code for code, mask in masks.items() if mask[index]]


def test_the_flags_and_their_default() -> None:
    assert sorted(QUALITY_FLAGS) == sorted([*CODES, "layered", "rebound_unresolved", "hardness_outlier"])
    assert [code for code, flag in QUALITY_FLAGS.items() if flag.excludes_by_default] == CODES[:5]
    assert all(flag.code == code and flag.sentence.endswith(".") for code, flag in QUALITY_FLAGS.items())


@pytest.mark.parametrize(
    ("series", "codes"),
    [
        (GOOD, []),
        (GOOD[:2], ["too_few_loads"]),
        ([(70.5, 1.0), (140.5, 2.0), (140.5, 3.0)], ["loads_not_rising"]),
        ([(70.5, 1.0), (140.5, 2.0), (140.0, 3.0)], ["loads_not_rising"]),
        ([(70.5, 1.0), (140.5, 2.0), (210.5, 2.0)], []),
        ([(70.5, 1.0), (140.5, 2.0), (210.5, 1.99)], ["depth_shrinks"]),
        ([(70.5, 0.0), (140.5, 0.0), (210.5, 0.0)], ["zero_depth", "below_resolution"]),
        ([(70.5, 0.0), (140.5, 0.0), (210.5, 0.05)], []),
        ([(70.5, 0.0), (140.5, 0.0), (210.5, 0.04)], ["below_resolution"]),
        (
            [(70.5, 1.0), (210.5, 0.0), (140.5, 2.0)],
            ["loads_not_rising", "depth_shrinks", "zero_depth", "below_resolution"],
        ),
    ],
)
def test_flags_of_one_series(series: Series, codes: list[str]) -> None:
    assert flagged(campaign_of(series)) == codes


def test_neighbouring_series_do_not_touch_each_other() -> None:
    """A step down from one series to the next is not one; the flag stays with its own series."""
    campaign = campaign_of(GOOD, [(70.5, 1.0), (60.5, 2.0), (210.5, 1.5)], GOOD)
    assert [flagged(campaign, index) for index in range(3)] == [[], ["loads_not_rising", "depth_shrinks"], []]


@pytest.mark.parametrize("step_mm", [0.01, 0.02, 0.05, 0.1, 0.03, 0.7])
def test_five_resolutions_are_enough(step_mm: float) -> None:
    series = [(1.0, 0.0), (2.0, 0.0), (3.0, round(5 * step_mm, 6))]
    assert flagged(campaign_of(series, resolution_mm=step_mm)) == []
    series[2] = (3.0, round(5 * step_mm, 6) * (1 - 1e-6))
    assert flagged(campaign_of(series, resolution_mm=step_mm)) == ["below_resolution"]
    assert flagged(campaign_of(series, resolution_mm=None)) == []


@pytest.mark.parametrize(
    ("tool", "angle_deg", "geometry", "limit_mm"),
    [
        ("ski", 30.0, "extended", 62.0),
        ("ski", 30.0, "paper", 31.0),  # 62 sin 30°
        ("ski", 0.0, "paper", 62.0),
        ("disc", 0.0, "extended", 60.0),
        ("roll", 0.0, "paper", 50.0),
    ],
)
def test_beyond_the_tool(tool: str, angle_deg: float, geometry: GeometryForm, limit_mm: float) -> None:
    for depth, codes in ((limit_mm, []), (limit_mm * 1.001, ["beyond_tool"])):
        series = [(70.5, 1.0), (140.5, 2.0), (210.5, depth)]
        assert flagged(campaign_of(series, tool=tool, angle_deg=angle_deg), geometry=geometry) == codes


def test_cancelled_and_the_order_of_experiments() -> None:
    campaign = campaign_of(GOOD, GOOD, GOOD[:1])
    tests = dataclasses.replace(present(campaign.penetration), cancelled=("", "fell over", ""))
    masks = screen_penetration(dataclasses.replace(campaign, penetration=tests))
    assert masks["cancelled"].tolist() == [False, True, False]
    assert masks["too_few_loads"].tolist() == [False, False, True]


def test_shear_flags() -> None:
    campaign = shear_campaign([5.0, 0.0, 0.05, 0.049], ["", "", "rain", ""])
    masks = screen_shear(campaign)
    assert {code: mask.tolist() for code, mask in masks.items()} == {
        "cancelled": [False, False, True, False],
        "zero_depth": [False, True, False, False],
        "below_resolution": [False, True, False, True],
    }
    assert not screen_shear(shear_campaign([0.001], [""], None))["below_resolution"].any()


def test_without_a_table_the_masks_are_empty() -> None:
    assert {code: len(mask) for code, mask in screen_penetration(shear_campaign([1.0], [""])).items()} == dict.fromkeys(
        CODES, 0
    )
    assert all(len(mask) == 0 for mask in screen_shear(campaign_of(GOOD)).values())


@given(
    st.lists(st.lists(st.tuples(st.integers(1, 4), st.integers(0, 3)), min_size=1, max_size=6), min_size=1, max_size=6)
)
def test_flags_and_largest_load_against_a_plain_loop(drawn: list[list[tuple[int, int]]]) -> None:
    series = [[(float(load), float(depth)) for load, depth in each] for each in drawn]
    campaign = campaign_of(*series, resolution_mm=0.5)
    expected, start, codes = [], 0, []
    for each in series:
        best = max((load, index) for index, (load, _) in enumerate(each))[1]
        expected.append(start + best)
        start += len(each)
        steps = list(itertools.pairwise(each))
        codes.append(
            ["too_few_loads"] * (len(each) < 3)
            + ["loads_not_rising"] * any(after[0] <= before[0] for before, after in steps)
            + ["depth_shrinks"] * any(after[1] < before[1] for before, after in steps)
            + ["zero_depth"] * (each[best][1] == 0)
            + ["below_resolution"] * (each[best][1] < 2.5)
        )
    assert reading_at_largest_load(present(campaign.penetration)).tolist() == expected
    assert [flagged(campaign, index) for index in range(len(series))] == codes


@pytest.mark.parametrize(
    ("series", "row", "column", "value", "allowed"),
    [
        (GOOD[:2], 5, "load_N", "2", "at least 3"),
        ([(1.0, 1.0), (2.0, 2.0), (2.0, 3.0)], 7, "load_N", "2", " 2 N "),
        ([(1.0, 1.0), (2.0, 0.9), (3.0, 3.0)], 6, "depth_mm", "0.9", " 1 mm "),
        ([(1.0, 1.0), (2.0, 70.0), (3.0, 71.5)], 7, "depth_mm", "71.5", " 62 mm "),
        ([(1.0, 0.01), (2.0, 0.02), (3.0, 0.03)], 7, "depth_mm", "0.03", "0.05 mm"),
    ],
)
def test_a_flag_names_its_reading(series: Series, row: int, column: str, value: str, allowed: str) -> None:
    campaign = campaign_of(GOOD, series)
    (problem,) = flag_problems(campaign, screen_penetration(campaign), {})
    assert (problem.severity, problem.file, problem.experiment) == ("flag", "penetration.csv", "P1")
    assert (problem.row, problem.column, problem.value) == (row, column, value)
    assert allowed in str(problem.allowed)
    assert problem.code in QUALITY_FLAGS


def test_the_limit_named_is_that_of_the_geometry() -> None:
    campaign = campaign_of([(1.0, 1.0), (2.0, 30.0), (3.0, 31.5)])
    (problem,) = flag_problems(campaign, screen_penetration(campaign, geometry="paper"), {}, geometry="paper")
    assert problem.allowed.startswith("at most 31 mm")


def test_flags_come_by_experiment_and_say_what_follows() -> None:
    campaign = dataclasses.replace(
        shear_campaign([0.0, 1.0], ["", "rain"]), penetration=campaign_of(GOOD[:1]).penetration
    )
    problems = flag_problems(campaign, screen_penetration(campaign), screen_shear(campaign))
    assert [(each.file, each.row, each.code, each.value) for each in problems] == [
        ("penetration.csv", 2, "too_few_loads", "1"),
        ("shear.csv", 2, "zero_depth", "0"),
        ("shear.csv", 2, "below_resolution", "0"),
        ("shear.csv", 3, "cancelled", "rain"),
    ]
    assert ["not included" in each.action for each in problems] == [True, True, False, True]


def test_a_flag_that_was_added_is_reported_at_the_largest_load() -> None:
    campaign = campaign_of(GOOD, GOOD)
    (problem,) = flag_problems(campaign, {"hardness_outlier": np.array([False, True])}, {})
    assert (problem.code, problem.row, problem.experiment) == ("hardness_outlier", 7, "P1")


@pytest.mark.parametrize(
    ("depth", "after", "codes"),
    [
        (3.0, 3.03, []),  # 1 % of 3 mm
        (3.0, 3.031, ["creeps"]),
        (1.5, 1.52, []),  # two steps of the gauge
        (1.5, 1.521, ["creeps"]),
        (3.0, float("nan"), []),
        (3.0, 2.0, []),
    ],
)
def test_creep_beyond_the_gauge_and_a_share_of_the_depth(depth: float, after: float, codes: list[str]) -> None:
    campaign = campaign_of(GOOD, [(70.5, 0.5), (140.5, depth), (210.5, 4.0)])
    tests = present(campaign.penetration)
    add_creep = np.full(6, np.nan)
    add_creep[4] = after * 1e-3
    campaign = dataclasses.replace(campaign, penetration=dataclasses.replace(tests, depth_after=add_creep))
    masks = screen_penetration(campaign)
    assert [code for code, mask in masks.items() if mask[1]] == codes
    assert not any(mask[0] for mask in masks.values())
    problems = flag_problems(campaign, masks, {})
    assert [(each.code, each.row, each.column) for each in problems] == [("creeps", 6, "depth_after_mm")] * len(codes)


@pytest.mark.parametrize(
    ("back", "code"),
    [
        ([(140.5, 2.9), (70.5, 2.5)], None),
        ([(210.5, 3.0), (140.5, 2.9)], None),  # again under the largest load
        ([(210.5, 3.0), (210.5, 2.9)], "unloading_not_falling"),
        ([(140.5, 2.9), (150.5, 2.5)], "unloading_not_falling"),
        ([(220.5, 2.9), (70.5, 2.5)], "unloading_not_falling"),
        ([(140.5, 3.01), (70.5, 3.02)], None),  # a step of the gauge each
        ([(140.5, 3.011), (70.5, 2.5)], "unloading_sinks"),
        ([(140.5, 2.9), (70.5, 2.92)], "unloading_sinks"),
    ],
)
def test_flags_of_the_unloading(back: Series, code: str | None) -> None:
    """The series before ends under a smaller load and less deep; that does not count."""
    campaign, readings = campaign_of(GOOD, GOOD), [(70.5, 1.0), *back]
    unloading = UnloadingReadings(
        first=np.array([0, 1, 1 + len(back)]), load=np.array([load for load, _ in readings]),
        penetration_depth=np.array([depth for _, depth in readings]) * 1e-3, row=np.arange(len(readings)) + 8,
    )  # fmt: skip
    tests = dataclasses.replace(present(campaign.penetration), unloading=unloading)
    campaign = dataclasses.replace(campaign, penetration=tests)
    masks = screen_penetration(campaign)
    assert [[name for name in CODES if masks[name][index]] for index in range(2)] == [[], [code] if code else []]
    assert [problem.code for problem in flag_problems(campaign, masks, {})] == ([code] if code else [])


def repeated(count: int, column: str | None) -> list[Problem]:
    return [
        warning("odd", "a.csv", row=n + 2, column=column, value="x", allowed=Message(""), action=Message(""))
        for n in range(count)
    ]


@pytest.mark.parametrize(("column", "place"), [("load_N", "a.csv, column load_N"), (None, "a.csv")])
def test_many_problems_of_a_kind_are_counted(column: str | None, place: str) -> None:
    """Ten are shown, an eleventh alone too, and of more the number and the last row."""
    for count, shown in ((10, 10), (11, 11), (12, 11)):
        lines = lines_of(repeated(count, column))
        assert len(lines) == shown
    assert {name: str(lines[-1].fields[name]) for name in ("place", "count", "row")} == {
        "place": place, "count": "2", "row": "13",
    }  # fmt: skip
    assert len(lines_of([*repeated(12, column), *repeated(12, "other")])) == 22
