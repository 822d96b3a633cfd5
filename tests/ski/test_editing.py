import dataclasses
import math
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.coded import raises

from skisnow._support.errors import OutputError, ParameterError, RangeWarning
from skisnow._support.units import MM
from skisnow.ski import Ski, read_ski, ski_named, ski_names, write_ski
from skisnow.ski.editing import (
    EDITED_COLUMNS,
    SIDECUT,
    SkiEdit,
    edit_stations,
    edited_ski,
    shape_parameters,
    shape_value,
    table_growth,
    values_at,
    varied_ski,
)
from skisnow.ski.ski_file import ski_of_keys

NAN = math.nan


def edited(ski: Ski, **how: dict[str, object]) -> Ski:
    return edited_ski(ski, SkiEdit(edit_stations(ski), **how), name="new", source="by hand")  # type: ignore[arg-type]


@pytest.mark.parametrize("name", ski_names())
def test_nothing_given_changes_nothing(name: str) -> None:
    ski = ski_named(name)
    nothing = {column: np.full(9, NAN) for column in EDITED_COLUMNS}
    same = edited(ski, values=nothing)  # type: ignore[arg-type]
    for attribute in EDITED_COLUMNS.values():
        # factors and ratios of exactly one, differences of exactly zero
        assert np.array_equal(getattr(same, attribute), getattr(ski, attribute)), attribute
    assert (same.name, same.source, same.mass) == ("new", "by hand", ski.mass)


def test_factors_scale_whole_curves_and_the_radius_follows() -> None:
    ski = ski_named("slalom")
    new = edited(ski, factors={"width_mm": 1.1, "EI_N_m2": 2.0, "base_height_mm": 0.5, "mass_per_length_kg_per_m": 1.5})
    assert new.width == pytest.approx(1.1 * ski.width)
    assert new.bending_stiffness == pytest.approx(2.0 * ski.bending_stiffness)
    assert np.array_equal(new.torsional_stiffness, ski.torsional_stiffness)
    assert new.base_height == pytest.approx(0.5 * ski.base_height, abs=1e-15)
    assert new.mass == pytest.approx(1.5 * ski.mass)
    # three widths: R = L² / (2 (tip + tail - 2 waist)) + small terms, so 1.1 times the widths is R / 1.1; the term that
    # is left out, half the sidecut's depth, is 17 mm of 13 m
    assert new.sidecut_radius_of_three_widths == pytest.approx(ski.sidecut_radius_of_three_widths / 1.1, rel=2e-3)


@pytest.mark.parametrize("name", ["slalom", "giant-slalom", "carver"])
def test_a_deeper_sidecut_leaves_the_waist_and_divides_the_radius(name: str) -> None:
    """The side line's curvature is that of the half widths, which the factor scales, but for slopes' second order."""
    ski = ski_named(name)
    new = edited(ski, factors={SIDECUT: 1.05})
    half = ski.sidecut_length / 2.0
    inside = np.abs(ski.station - ski.sidecut_middle) < half
    waist = ski.width[inside].min()
    assert new.width[inside].min() == waist
    assert new.width[inside] - waist == pytest.approx(1.05 * (ski.width[inside] - waist), abs=1e-12)
    assert new.sidecut_radius_of_edge_line == pytest.approx(ski.sidecut_radius_of_edge_line / 1.05, rel=2e-3)
    assert np.abs(np.diff(new.width / ski.width)).max() < 1e-3  # no step where the sidecut ends


def test_a_value_given_at_a_station_is_met_and_the_far_side_is_untouched() -> None:
    ski = ski_named("carver")
    station = edit_stations(ski)
    wanted = {column: np.full(9, NAN) for column in EDITED_COLUMNS}
    wanted["EI_N_m2"][2] = 400.0
    wanted["base_height_mm"][3] = -2.0 * MM
    new = edited(ski, values=wanted)  # type: ignore[arg-type]
    at = values_at(new, station)
    before = values_at(ski, station)
    # the tables are 2.5 mm apart and read by straight lines: a hundredth of a percent beside a smooth curve
    assert at["EI_N_m2"][2] == pytest.approx(400.0, rel=1e-4)
    assert np.delete(at["EI_N_m2"], 2) == pytest.approx(np.delete(before["EI_N_m2"], 2), rel=1e-4)
    assert at["base_height_mm"][3] == pytest.approx(-2.0 * MM, abs=1e-6)
    behind = ski.station < station[4]
    assert np.array_equal(new.bending_stiffness[behind], ski.bending_stiffness[behind])
    assert np.array_equal(new.base_height[behind], ski.base_height[behind])


def test_the_base_counts_from_the_boot_still() -> None:
    ski = ski_named("carver")
    wanted = np.full(9, NAN)
    wanted[4] = 3.0 * MM  # the station nearest to the boot
    new = edited(ski, values={"base_height_mm": wanted})
    assert float(np.interp(0.0, new.station[::-1], new.base_height[::-1])) == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize(
    ("how", "said"),
    [
        ({"factors": {"EI_N_m2": -1.0}}, "EI_N_m2 is -1;"),
        ({"values": {"GJ_N_m2": np.full(9, 0.0)}}, r"station .*GJ_N_m2 is 0\.0;"),
        ({"values": {"width_mm": np.full(9, 0.6)}}, r"width_mm is 600\.0;"),
    ],
)
def test_impossible_input_is_rejected(how: dict[str, object], said: str) -> None:
    with pytest.raises(ParameterError, match=said):
        edited(ski_named("slalom"), **how)  # type: ignore[arg-type]


def require_same(read: Ski, written: Ski) -> None:
    for field in dataclasses.fields(Ski):
        before, after = getattr(written, field.name), getattr(read, field.name)
        if field.name in ("base", "keys"):
            assert after is None  # the table has the numbers themselves
        elif isinstance(before, str):
            assert after == before, field.name
        else:
            # 15 digits are written; millimetres and back cost one more
            scale = float(np.max(np.abs(before)))
            assert np.shape(after) == np.shape(before), field.name
            assert after == pytest.approx(before, abs=2e-14 * max(scale, 1e-3)), field.name


@pytest.mark.parametrize("name", ski_names())
def test_written_and_read_again(tmp_path: Path, name: str) -> None:
    ski = ski_named(name)
    write_ski(ski, tmp_path / "copy.toml")
    require_same(read_ski(tmp_path / "copy.toml"), ski)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["copy.csv", "copy.toml"]


def test_every_field_survives(tmp_path: Path) -> None:
    ski = ski_named("slalom")
    moved = dataclasses.replace(
        ski, name='a "quoted" \\ name\nof Mössner\x7f', station=ski.station - 0.0313,
        base_height=ski.base_height - ski.at(0.0313).base_height, sidecut_middle=-0.0313, base_bevel=0.0123,
        edge_width=0.0019,
    )  # fmt: skip
    write_ski(moved, tmp_path / "moved.toml")
    require_same(read_ski(tmp_path / "moved.toml"), moved)


def test_source_may_be_blank(tmp_path: Path) -> None:
    write_ski(dataclasses.replace(ski_named("carver"), source=""), tmp_path / "c.toml")
    assert read_ski(tmp_path / "c.toml").source == "file c.toml"


def test_only_a_toml_file_is_written(tmp_path: Path) -> None:
    with raises(OutputError, "cannot_write"):
        write_ski(ski_named("carver"), tmp_path / "carver.csv")
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), n=st.integers(750, 900), bevel=st.floats(0.0, 0.08), middle=st.floats(-0.1, 0.1))
def test_any_table_survives(
    tmp_path_factory: pytest.TempPathFactory, seed: int, n: int, bevel: float, middle: float
) -> None:
    random = np.random.default_rng(seed)
    inner = np.linspace(0.8, -0.8, n)[1:-1] + random.uniform(-1e-4, 1e-4, n - 2)  # uneven, still falling and dense
    station = np.concatenate([[0.8], inner, [-0.8]])
    base_height = random.uniform(-0.02, 0.02, n)
    ski = Ski(
        name="any",
        source="drawn",
        station=station,
        width=0.07 + 0.03 * (station - middle) ** 2 + random.uniform(0.0, 1e-6, n),
        base_height=base_height - np.interp(0.0, station[::-1], base_height[::-1]),
        bending_stiffness=random.uniform(5.0, 5000.0, n),
        torsional_stiffness=random.uniform(2.0, 5000.0, n),
        mass_per_length=random.uniform(0.1, 10.0, n),
        running_length=1.3,
        sidecut_length=1.4,
        base_bevel=bevel,
        sidecut_middle=middle,
    )
    path = tmp_path_factory.mktemp("ski") / "any.toml"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)  # of bevels below a tenth of a degree
        write_ski(ski, path)
        require_same(read_ski(path), ski)


def test_growth_with_each_key_is_that_of_differences() -> None:
    keys: dict[str, Any] = dict(read_ski("slalom").keys or {}) | {
        "tip_end_width_mm": 30.0, "tail_overhang_mm": 22.0, "boot_position_mm": 11.0, "camber_rounding_mm": 90.0,
        "shovel_height_mm": 55.0, "tail_height_mm": 12.0, "tip_rocker_length_mm": 60.0, "tip_rocker_height_mm": 1.0,
        "tail_rocker_length_mm": 40.0, "tail_rocker_height_mm": 0.7, "base_bevel_deg": 0.5, "edge_width_mm": 1.8,
        "side_edge_deg": 88.0, "edge_radius_mm": 0.3,
        "stiffness_station_mm": [700, 320, 20, -310, -690], "EI_N_m2": [110, 240, 430, 260, 120],
    }  # fmt: skip
    plain = {key: value for key, value in keys.items() if key not in ("tip_end_width_mm", "stiffness_station_mm")}
    for each in (keys, plain):
        ski = ski_of_keys(each)
        for name in (name for name in shape_parameters(ski) if name.startswith("ski.")):
            h = 1e-5 * max(abs(shape_value(ski, name)), 10.0)
            ends = [varied_ski(ski, name, side * h) for side in (1.0, -1.0)]
            growth = table_growth(ski, name)
            for row, table in enumerate(("station", *EDITED_COLUMNS.values())):
                differences = (getattr(ends[0], table) - getattr(ends[1], table)) / (2.0 * h)
                size = np.max(np.abs(getattr(ski, table))) / max(abs(shape_value(ski, name)), 10.0)
                assert growth.tables[row] == pytest.approx(differences, abs=1e-6 * size), (name, table)
            numbers = [
                (getattr(ends[0], key) - getattr(ends[1], key)) / (2.0 * h)
                for key in ("running_length", "base_bevel", "edge_width", "side_edge", "edge_radius")
            ]
            assert growth.numbers == pytest.approx(numbers, abs=1e-12)
