"""Parameters, the words of --free, and the section [identify]."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from skisnow._support.errors import ParameterError
from skisnow.identification.parameter import Parameter, parameter_table
from skisnow.scenario import scenario_file, scenario_text
from skisnow.scenario.identify_section import given_parameters
from skisnow.scenario.keys import FREE_KEYS, free_key, free_keys, short_name
from skisnow.scenario.reading import load_input

from ..error_codes import raises_code

VALUES = scenario_file("carved-46m").values


@pytest.mark.parametrize("key", FREE_KEYS)
def test_every_key_is_found_by_its_short_name_alone(key: str) -> None:
    assert free_key(key) == free_key(short_name(key)) == free_key(key.partition(".")[2]) == key


@pytest.mark.parametrize(
    ("word", "told"),
    [
        ("mu_O", "friction.mu_0"),
        ("dragarea", "drag.drag_area_m2"),
        ("sf", "snow.S_f_N_per_mm2"),
        ("quark", "There are"),
        ("step", r"solver\.step_ms"),
        ("inertia", "a whole table"),
        ("ski.name", "a text"),
    ],
)
def test_unknown_words_are_refused_with_near_ones(word: str, told: str) -> None:
    with pytest.raises(ParameterError, match=told):
        free_key(word)


def test_a_key_named_twice_is_refused() -> None:
    with pytest.raises(ParameterError, match="named twice"):
        free_keys("mu_0, friction.mu_0")


def test_bounds_that_exclude_the_start_are_refused() -> None:
    section = given_parameters({"mu_0": {"lower": 0.02, "upper": 0.3}})
    with raises_code(ParameterError, "start_outside_bounds"):
        parameter_table(["friction.mu_0"], VALUES, section)


@pytest.mark.parametrize(
    ("table", "told"),
    [
        ({"mu_0": {"begin": 0.1}}, "start"),
        ({"mu_0": {"prior_mean": 0.1}}, "prior_sd"),
        ({"mu_0": {"prior_mean": 0.1, "prior_sd": 0.0}}, "above 0"),
        ({"mu_0": {"lower": 0.3, "upper": 0.2}}, "below upper"),
        ({"mu_0": {"upper": True}}, "upper is True"),
        ({"mu_0": 0.3}, "must be a table"),
        ({"muu_0": {"upper": 0.3}}, "friction.mu_0"),
        ({"S_f": {"lower": -1.0}}, "allowed is above 0"),
    ],
)
def test_what_is_wrong_in_the_section_is_named(table: dict[str, object], told: str) -> None:
    with pytest.raises(ParameterError, match=told):
        parameter_table(["friction.mu_0", "snow.S_f_N_per_mm2"], VALUES, given_parameters(table))


def test_start_bounds_and_prior_come_from_the_section(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    section = (
        '[identify."snow.S_f_N_per_mm2"]\nstart = 0.3\nlower = 0.1\nupper = 1.0\nprior_mean = 0.4\nprior_sd = 0.05\n'
    )
    path.write_text(scenario_text("carved-46m") + section, encoding="utf-8")
    given = load_input(path)
    (found,) = parameter_table(["snow.S_f_N_per_mm2"], VALUES, given_parameters(given.identify))
    assert (found.start, found.lower, found.upper, found.prior_mean, found.prior_sd) == (0.3, 0.1, 1.0, 0.4, 0.05)
    assert found.prior_residual(0.5) == pytest.approx(2.0)
    assert given.changed({"friction.mu_0": 0.02}).identify == given.identify
    assert scenario_file(path).scenario.contact.snow.failure_shear_stress == 0.5e6  # a run does not heed it


def test_a_section_that_is_no_table_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text("identify = 3\n" + scenario_text("carved-46m"), encoding="utf-8")
    with pytest.raises(ParameterError, match="identify is 3"):
        load_input(path)


def test_logarithmic_parameters_count_in_factors() -> None:
    hardness = Parameter(
        key="snow.H_V_N_per_mm3", name="H_V", start=0.2, lower=0.02, upper=2.0, size=2.0, logarithmic=True
    )
    assert hardness.scaled(0.2 * math.e) == pytest.approx(0.5)
    assert hardness.value(-0.5) == pytest.approx(0.2 / math.e)
    assert hardness.slope(0.4) == pytest.approx(0.8)
    assert hardness.value(100.0) == 2.0


def test_every_key_that_has_a_value_can_be_looked_for() -> None:
    for key in FREE_KEYS:
        if VALUES[key] is not None:
            (found,) = parameter_table([key], VALUES, {})
            assert found.lower <= found.start <= found.upper
