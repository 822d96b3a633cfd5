"""Snow by the name of a publication."""

import pytest
from tests.coded import Coded, coded, raises

from skisnow._support.errors import ParameterError
from skisnow._support.units import N_PER_MM2, N_PER_MM3
from skisnow.snow import published_names, published_snow


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
def test_a_misspelt_name_is_told_the_nearest_and_all(misspelt: str, nearest: str | Coded) -> None:
    with raises(ParameterError, nearest) as caught:
        published_snow(misspelt)
    assert all(name in str(caught.value) for name in published_names())


def test_a_name_like_none_is_told_all() -> None:
    with raises(ParameterError, "unknown_name", name="xyz", problem="no published snow is named 'xyz'."):
        published_snow("xyz")
