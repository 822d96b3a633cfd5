"""The snow of an analysed campaign."""

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import stats
from tests.coded import Coded, coded, raises

from skisnow._support.errors import ParameterError
from skisnow.snow import SnowProperties, snow_from_results
from skisnow.snow.mean_snow import drawn_snows, log_normal

Row = dict[str, Any]


def penetration(value: float | None, site: str = "A", *, used: bool = True) -> Row:
    return {"experiment": "P", "site": site, "used": used, "H_V_N_per_mm3": value}


def shear(value: float | None, site: str = "A", *, used: bool = True) -> Row:
    return {"experiment": "S", "site": site, "used": used, "S_f_N_per_mm2": value}


def results_file(folder: Path, hardness: list[Row], stress: list[Row]) -> Path:
    path = folder / "results.json"
    contents = {"penetration": {"experiments": hardness}, "shear": {"experiments": stress}}
    path.write_text(json.dumps(contents), encoding="utf-8")
    return path


def test_means_and_intervals_by_hand(tmp_path: Path) -> None:
    """Three experiments: t₀.₉₇₅(2) = 4.3027. ln 0.1, ln 0.2, ln 0.4: mean ln 0.2, s = ln 2."""
    path = results_file(tmp_path, [penetration(v) for v in (0.1, 0.2, 0.4)], [shear(v) for v in (0.1, 0.2, 0.3)])
    snow = snow_from_results(path)
    assert snow.snow_hardness == pytest.approx(0.2e9)
    low, high = snow.snow_hardness_interval or (0.0, 0.0)
    factor = math.exp(4.302653 * math.log(2) / math.sqrt(3))
    assert (low, high) == pytest.approx((0.2e9 / factor, 0.2e9 * factor), rel=1e-6)
    assert snow.failure_shear_stress == pytest.approx(0.2e6)
    ratio = math.exp(4.302653 * 0.1 / math.sqrt(3) / 0.2)
    assert snow.failure_shear_stress_interval == pytest.approx((0.2e6 / ratio, 0.2e6 * ratio), rel=1e-6)


def test_intervals_cover_in_19_of_20(tmp_path: Path) -> None:
    """400 campaigns of five from known snow: 95 % of the intervals hold it; 3 % is three standard errors."""
    generator = np.random.default_rng(20)
    held = np.zeros(2)
    for _ in range(400):
        hardness = 0.2 * np.exp(0.5 * generator.standard_normal(5))
        stress = 0.2 + 0.03 * generator.standard_normal(5)
        path = results_file(tmp_path, [penetration(v) for v in hardness], [shear(v) for v in stress])
        snow = snow_from_results(path)
        assert snow.snow_hardness_interval is not None and snow.failure_shear_stress_interval is not None
        held += [
            snow.snow_hardness_interval[0] <= 0.2e9 <= snow.snow_hardness_interval[1],
            snow.failure_shear_stress_interval[0] <= 0.2e6 <= snow.failure_shear_stress_interval[1],
        ]
    assert held / 400 == pytest.approx([0.95, 0.95], abs=0.033)


def test_interval_agrees_with_scipy_and_one_experiment_has_no_interval_and_no_shear_no_stress(tmp_path: Path) -> None:
    values = [0.11, 0.23, 0.19, 0.35]
    snow = snow_from_results(results_file(tmp_path, [penetration(v) for v in values], []))
    logs = np.log(values)
    expected = stats.t.interval(0.95, 3, loc=logs.mean(), scale=stats.sem(logs))
    assert snow.snow_hardness_interval == pytest.approx(np.exp(expected) * 1e9)
    snow = snow_from_results(results_file(tmp_path, [penetration(0.2)], []))
    assert snow.snow_hardness == pytest.approx(0.2e9)
    assert snow.snow_hardness_interval is None
    assert snow.failure_shear_stress is None and snow.failure_shear_stress_interval is None


def test_only_used_rows_of_the_site_count_and_a_site_that_is_not_there(tmp_path: Path) -> None:
    rows = [penetration(0.2), penetration(0.9, used=False), penetration(None), penetration(0.5, "B")]
    path = results_file(tmp_path, rows, [shear(0.1), shear(0.4, used=False), shear(None), shear(0.3, "B")])
    snow = snow_from_results(path, site="A")
    assert snow.snow_hardness == pytest.approx(0.2e9)
    assert snow.failure_shear_stress == pytest.approx(0.1e6)
    assert snow.source == f"{path}, site A: 1 penetration and 1 shear experiments"
    both = snow_from_results(path)
    assert both.snow_hardness == pytest.approx(math.sqrt(0.1) * 1e9)
    assert both.failure_shear_stress == pytest.approx(0.2e6)
    path = results_file(tmp_path, [penetration(0.2, "B"), penetration(0.2, "A")], [])
    with raises(ParameterError, "no_data", site="C"):
        snow_from_results(path, site="C")


def test_shear_alone_is_no_snow(tmp_path: Path) -> None:
    with raises(ParameterError, "no_data"):
        snow_from_results(results_file(tmp_path, [], [shear(0.2)]))


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with raises(ParameterError, "wrong_kind"):
        snow_from_results(tmp_path / "absent.json")
    with raises(ParameterError, "wrong_kind"):
        snow_from_results(tmp_path)


@pytest.mark.parametrize(
    ("contents", "told"),
    [
        (b"", "wrong_kind"),
        (b"experiment,site\n", "wrong_kind"),
        (b"\xff\xfe\x00", "wrong_kind"),
        (b"[]", "missing"),
        (b'{"outcome": "finished"}', "missing"),
        (b'{"penetration": {}, "shear": {}}', coded("wrong_kind", part="penetration")),
        (b'{"penetration": {"experiments": [1]}, "shear": {}}', coded("wrong_kind", part="penetration")),
        (b'{"penetration": null, "shear": {}}', coded("wrong_kind", part="penetration")),
        (
            b'{"penetration": {"experiments": [{"used": true, "site": "A", "H_V_N_per_mm3": "hard"}]}, "shear": {}}',
            coded("wrong_kind", part="penetration"),
        ),
        (b'{"penetration": {"experiments": []}, "shear": {"experiments": [{}]}}', coded("wrong_kind", part="shear")),
    ],
)
def test_what_is_no_results_file_is_named(tmp_path: Path, contents: bytes, told: str | Coded) -> None:
    path = tmp_path / "results.json"
    path.write_bytes(contents)
    with raises(ParameterError, told) as caught:
        snow_from_results(path)
    assert str(path) in str(caught.value) and "skisnow analyse" in str(caught.value)


@pytest.mark.parametrize("hardness", [0.0, -0.2])
def test_a_hardness_without_logarithm_is_reported(tmp_path: Path, hardness: float) -> None:
    with raises(ParameterError, "out_of_range"):
        snow_from_results(results_file(tmp_path, [penetration(0.2), penetration(hardness)], []))


def test_shear_tests_without_any_moment_give_no_strength(tmp_path: Path) -> None:
    with raises(ParameterError, "out_of_range"):
        snow_from_results(results_file(tmp_path, [penetration(0.2)], [shear(0.0), shear(0.0)]))
    one = snow_from_results(results_file(tmp_path, [penetration(0.2)], [shear(0.0), shear(0.2)]))
    assert one.failure_shear_stress == pytest.approx(0.1e6)


@pytest.mark.parametrize(("hardness", "stress"), [(0.9e-9, 0.1), (1.1e9, 0.1), (0.1, 1.1e9)])
def test_numbers_that_no_snow_has_are_rejected(tmp_path: Path, hardness: float, stress: float) -> None:
    with raises(ParameterError, "out_of_range"):
        snow_from_results(results_file(tmp_path, [penetration(hardness)], [shear(stress)]))


@pytest.mark.parametrize("value", [1e-9, 1e9])
def test_the_ends_of_what_is_taken_belong_to_it(tmp_path: Path, value: float) -> None:
    snow = snow_from_results(results_file(tmp_path, [penetration(value)], [shear(value)]))
    assert (snow.snow_hardness, snow.failure_shear_stress) == pytest.approx((value * 1e9, value * 1e6))


def test_a_site_may_be_named_without_the_word_site(tmp_path: Path) -> None:
    rows = [penetration(0.1, "site A"), penetration(0.4, "Site B"), penetration(0.2, "b")]
    path = results_file(tmp_path, rows, [])
    assert snow_from_results(path, site="A").snow_hardness == pytest.approx(0.1e9)
    assert snow_from_results(path, site="b").snow_hardness == pytest.approx(0.2e9)  # its own name goes before
    assert snow_from_results(path, site="B").snow_hardness == pytest.approx(0.4e9)
    with raises(ParameterError, "no_data", site="C"):
        snow_from_results(path, site="C")


SNOW = SnowProperties(
    2.0e8, 1.4e5, source="site X", snow_hardness_interval=(1.0e8, 4.0e8), failure_shear_stress_interval=(1.0e5, 1.8e5)
)


def test_the_intervals_come_back_and_a_share_of_one_half_is_the_middle_and_more_is_more() -> None:
    """Of 40,000 draws: the 2.5 % quantile of a normal is known to 0.7 % of its half-width (1.96 × 0.0134 × 0.27)."""
    snows = drawn_snows(SNOW, np.random.default_rng(1).random((40_000, 2)))
    hardness = np.array([snow.snow_hardness for snow in snows])
    stress = np.array([snow.failure_shear_stress for snow in snows])
    assert np.quantile(hardness, [0.025, 0.5, 0.975]) == pytest.approx([1.0e8, 2.0e8, 4.0e8], rel=0.04)
    assert np.quantile(stress, [0.025, 0.5, 0.975]) == pytest.approx([1.0e5, np.sqrt(1.8) * 1e5, 1.8e5], rel=0.02)
    assert abs(np.corrcoef(np.log(hardness), np.log(stress))[0, 1]) < 0.02
    assert "site X" in snows[0].source
    low, middle, high = drawn_snows(SNOW, np.array([[0.025, 0.025], [0.5, 0.5], [0.975, 0.975]]))
    assert middle.snow_hardness == pytest.approx(2.0e8)
    assert middle.failure_shear_stress == pytest.approx(np.sqrt(1.0e5 * 1.8e5), rel=1e-6)
    assert (low.snow_hardness, high.snow_hardness) == pytest.approx((1.0e8, 4.0e8))
    assert (low.failure_shear_stress, high.failure_shear_stress) == pytest.approx((1.0e5, 1.8e5), rel=1e-6)


def test_snow_without_interval_is_rejected() -> None:
    with raises(ParameterError, "no_data", quantity="S_f"):
        drawn_snows(replace(SNOW, failure_shear_stress_interval=None), np.full((3, 2), 0.5))
    with raises(ParameterError, "out_of_range", stress=0.0):
        drawn_snows(replace(SNOW, failure_shear_stress_interval=(0.0, 2.0)), np.full((3, 2), 0.5))


def test_a_value_with_an_uneven_interval_keeps_both_and_an_even_interval_is_drawn_from_as_that_of_s_f() -> None:
    """1.5 standard deviations to either side: a half of 95 % is 1.96 of them, so the ends to the power 1.5/1.96."""
    shares = np.array([0.025, 0.5, 0.975, 0.0668072013, 0.9331927987])
    expected = [6.0, 9.0, 27.0, 9.0 * (6.0 / 9.0) ** (1.5 / 1.959964), 9.0 * 3.0 ** (1.5 / 1.959964)]
    assert log_normal(9.0, (6.0, 27.0), shares) == pytest.approx(expected, rel=1e-6)
    shares = np.random.default_rng(2).random((50, 2))
    stress = [snow.failure_shear_stress for snow in drawn_snows(SNOW, shares)]
    middle = float(np.sqrt(1.0e5 * 1.8e5))
    assert log_normal(middle, (1.0e5, 1.8e5), shares[:, 1]) == pytest.approx(stress, rel=1e-12)
