"""Words for keys that may be looked for: found, guessed, and refused with the reason."""

from __future__ import annotations

import pytest

from skisnow._support.errors import ParameterError
from skisnow.scenario.keys import FREE_KEYS, free_key, free_keys, short_name
from tests.coded import Coded, coded, raises


@pytest.mark.parametrize(
    ("word", "key"),
    [
        ("start.x_m", "start.x_m"),
        ("x_m", "start.x_m"),
        ("start.x", "start.x_m"),
        (" x ", "start.x_m"),
        ("mu_1", "friction.mu_1_s_per_m"),
    ],
)
def test_with_and_without_section_and_unit(word: str, key: str) -> None:
    assert free_key(word) == key


@pytest.mark.parametrize(
    ("word", "told"),
    [
        ("x_ms", coded("unknown_name", word="x_ms")),
        ("MASS", "unknown_name"),
        ("speeds", "unknown_name"),
        ("step", coded("not_free", key="solver.step_ms")),
        ("inertia", coded("not_free", key="sledge.inertia_kg_m2")),
        ("ski.name", coded("not_free", key="ski.name")),
        ("mu_0@ ", coded("missing", word="mu_0@ ", own="mu_0", each="each")),
        ("mu_0, mass, friction.mu_0", coded("repeated", key="friction.mu_0")),
    ],
)
def test_what_is_no_key_to_look_for(word: str, told: str | Coded) -> None:
    with raises(ParameterError, told):
        free_keys(word)


def test_where_nothing_is_near_all_are_told() -> None:
    with pytest.raises(ParameterError) as refused:
        free_key("quark")
    told = str(refused.value).partition("There are ")[2].split(", ")
    assert [free_key(word) for word in told] == list(FREE_KEYS)
    assert told == [short_name(key) for key in FREE_KEYS]


def test_a_key_of_one_run_may_stand_beside_that_of_another() -> None:
    listed = ["mu_0@first", "mu_0 @ second", "", "speed@each"]
    keys = ("friction.mu_0@first", "friction.mu_0@second", "start.speed_m_per_s@each")
    assert free_keys(listed) == free_keys(",".join(listed)) == keys
