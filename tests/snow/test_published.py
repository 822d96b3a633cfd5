"""Published relations against the numbers that their papers print."""

import math
import warnings
from pathlib import Path

import numpy as np
import pytest
from tests.coded import Coded, coded, raises

from skisnow._support.errors import ParameterError, RangeWarning
from skisnow._support.units import N_PER_MM2, N_PER_MM3
from skisnow.snow import MeasuredRange, SnowProperties, published_names, published_snow
from skisnow.snow.published import domine_2011, federolf_2006, hand_hardness, moessner_2013

LITERATURE = Path(__file__).resolve().parents[3] / "shared" / "data" / "literature"


def test_equation_13_in_radians() -> None:
    """At 90° 0.0344 N/mm² (0.0343 by the printed digits); in degrees it would be negative."""
    assert float(moessner_2013.failure_shear_stress_from_angle(math.pi / 2)) == pytest.approx(0.0344e6, rel=0.003)
    assert float(moessner_2013.failure_shear_stress_from_angle(0.0)) == pytest.approx(0.059e6)


def test_equation_14_and_domine_at_500() -> None:
    assert float(moessner_2013.failure_shear_stress_from_density(500.0)) == pytest.approx(0.108e6)
    assert float(domine_2011.failure_shear_stress_from_density(500.0)) == pytest.approx((51.35 - 11.5323) ** 2)


def test_hand_hardness_is_the_power_law_of_the_eight_pairs() -> None:
    """The coefficients minimise the sum of squares over the pairs: its gradient is 0, the rmse 0.17."""
    index, resistance_kPa = np.array(hand_hardness.PAIRS).T
    force = 1e3 * resistance_kPa * hand_hardness.TIP_AREA
    fitted = np.array([hand_hardness.index_from_resistance(1e3 * each) for each in resistance_kPa])
    residual = index - fitted
    assert np.sum(residual * fitted) == pytest.approx(0.0, abs=1e-5)
    assert np.sum(residual * fitted * np.log(force)) == pytest.approx(0.0, abs=1e-5)
    assert math.sqrt(np.mean(residual**2)) == pytest.approx(0.171, abs=0.001)
    assert math.isnan(hand_hardness.index_from_resistance(315e3))


def test_hand_hardness_of_rounded_grains_returns_the_density() -> None:
    for density in (160.0, 300.0, 448.0):
        assert 154.0 + 1.51 * hand_hardness.index_from_density(density) ** 3.15 == pytest.approx(density)
    assert all(math.isnan(hand_hardness.index_from_density(density)) for density in (100.0, 154.2, 449.0))
    codes = [hand_hardness.code_of(third / 3) for third in range(2, 19)]
    assert codes[:4] + codes[-3:] == ["F-", "F", "F+", "4F-", "K+", "I-", "I"]


def test_only_about_55_degrees_reproduces_all_six_converted_values() -> None:
    def printed(angle_deg: float) -> list[str]:
        pairs = [
            federolf_2006.converted(A, B, math.radians(angle_deg)) for A, B in federolf_2006.PRESSURE_LAWS.values()
        ]
        return [f"{value:.2g}" for pair in pairs for value in pair]

    paper = ["0.21", "0.52", "0.16", "0.086", "0.022", "0.094"]
    fitting = [angle for angle in np.arange(50.0, 60.0, 0.01) if printed(angle) == paper]
    assert (round(min(fitting), 2), round(max(fitting), 2)) == (54.98, 55.17)
    assert printed(math.degrees(federolf_2006.CONVERSION_ANGLE)) == paper


def test_printed_values_are_those_of_the_literature_table() -> None:
    if not LITERATURE.exists():
        pytest.skip("the table of literature values is not beside the repository")
    lines = (LITERATURE / "seed_paper_values.csv").read_text(encoding="utf-8").splitlines()[1:]
    values = [line.split(",")[:3] for line in lines]
    rmse = sorted(float(value) for quantity, _, value in values if quantity == "rmse")
    assert sorted(moessner_2013.PRINTED_RMSE_N.values()) == rmse
    one = {quantity: float(value) for quantity, _, value in values}
    assert (one["b0"], one["b1"]) == moessner_2013.ANGLE_TERM
    assert (one["H_V_min"], one["H_V_max"]) == moessner_2013.SNOW_HARDNESS_RANGE_N_PER_MM3
    assert (one["S_f_min"], one["S_f_max"]) == moessner_2013.FAILURE_SHEAR_STRESS_RANGE_N_PER_MM2
    assert (one["tool_length"], one["tool_width"]) == (moessner_2013.TOOL_LENGTH_MM, moessner_2013.TOOL_WIDTH_MM)


@pytest.mark.parametrize(
    ("hardness", "stress"), [(0.0, 1.0), (-1.0, 1.0), (math.nan, 1.0), (1.0, 0.0), (math.inf, 1.0)]
)
def test_a_snow_needs_values_above_zero(hardness: float, stress: float) -> None:
    with pytest.raises(ParameterError, match="above 0"):
        SnowProperties(hardness, stress, "a test")


def test_printed_rmse() -> None:
    """Table of the paper, model by model."""
    rmse = [140.0, 58.4, 53.6, 207.0, 75.2, 54.8, 53.8, 54.9, 56.1]
    assert list(moessner_2013.PRINTED_RMSE_N.values()) == rmse


@pytest.mark.parametrize(
    ("name", "hardness", "stress", "source"),
    [
        ("race-piste", "0.21", "0.52", "Federolf"),
        ("recreational-piste", "0.16", "0.086", "Federolf"),
        ("spring-snow", "0.022", "0.094", "Federolf"),
        ("fresh-snow", "0.04", "0.04", "paired by us"),
        ("glacier", "90", "0.3", "paired by us"),
    ],
)
def test_values_are_the_printed_ones(name: str, hardness: str, stress: str, source: str) -> None:
    snow = published_snow(name)
    assert snow.failure_shear_stress is not None
    assert f"{snow.snow_hardness / N_PER_MM3:.2g}" == hardness
    assert f"{snow.failure_shear_stress / N_PER_MM2:.2g}" == stress
    assert source in snow.source and "2013" in snow.source
    assert snow.snow_hardness_interval is None and snow.failure_shear_stress_interval is None


def test_all_names() -> None:
    assert published_names() == ("race-piste", "recreational-piste", "spring-snow", "fresh-snow", "glacier")


@pytest.mark.parametrize(
    ("misspelt", "nearest"),
    [
        ("race-pist", coded("unknown_name", similar="race-piste")),
        ("Glacier", coded("unknown_name", similar="glacier")),
        ("spring snow", coded("unknown_name", similar="spring-snow")),
        ("fresh", coded("unknown_name", name="fresh", similar="fresh-snow")),
    ],
)
def test_a_misspelt_name_is_reported_the_nearest_and_all(misspelt: str, nearest: str | Coded) -> None:
    with raises(ParameterError, nearest) as caught:
        published_snow(misspelt)
    assert all(name in str(caught.value) for name in published_names())


def test_a_name_like_none_is_reported_all() -> None:
    with raises(ParameterError, "unknown_name", name="xyz", problem="no published snow is named 'xyz'."):
        published_snow("xyz")


RANGE = MeasuredRange("edge angle", 0.0, 2.0, "°", 0.5, "Somebody 1999")


def test_the_message_gives_relation_value_range_and_source() -> None:
    with pytest.warns(RangeWarning) as caught:
        RANGE.warn_outside(3.0, "A law")
    assert str(caught[0].message) == (
        "A law: edge angle 6 ° is outside the 0 to 4 ° that were measured (Somebody 1999); computed all the same"
    )


@pytest.mark.parametrize("inside", [0.0, 2.0, [0.5, 1.0], [], np.nan, [[np.nan, 1.0]]])
def test_inside_and_at_the_ends_it_is_silent(inside: object) -> None:
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        RANGE.warn_outside(np.asarray(inside), "A law")
    assert warned == []


@pytest.mark.parametrize(("values", "farthest"), [([2.5, 4.0, 3.0], "8"), ([-3.0, 4.5], "-6"), ([-2.0, 5.0], "10")])
def test_one_warning_for_an_array_names_the_farthest(values: list[float], farthest: str) -> None:
    with pytest.warns(RangeWarning, match=f"edge angle {farthest} °") as caught:
        RANGE.warn_outside(values, "A law")
    assert len(caught) == 1


def test_it_is_a_user_warning() -> None:
    assert issubclass(RangeWarning, UserWarning)
