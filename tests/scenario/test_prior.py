"""Priors of keys: their values, and what cannot be one."""

from __future__ import annotations

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.scenario.identify_section import Prior, prior_of
from tests.coded import Coded, coded, raises

SHARES = np.array([0.0, 0.5, 1.0])


def test_the_logarithm_is_even() -> None:
    prior = prior_of("unloading_ratio=2:50")
    assert prior.at(SHARES, 7.0) == pytest.approx([2.0, 10.0, 50.0])


def test_about_the_scenarios_own_value() -> None:
    prior = Prior(key="friction.mu_0", low=0.4, high=2.5, origin="", about=True)
    assert prior.at(SHARES, 0.03) == pytest.approx([0.012, 0.03, 0.075])
    assert prior.at(SHARES, 0.0) == pytest.approx([0.0, 0.0, 0.0])
    assert prior.at(SHARES, 0.8)[2] == 1.0  # what the key allows


@pytest.mark.parametrize(
    ("word", "told"),
    [
        ("unknown_name", "wrong_kind"),
        ("mu_0=1", "wrong_kind"),
        ("mu_0=a:b", "wrong_kind"),
        ("mu_0=0.2:0.1", "out_of_range"),
        ("mu_0=0:0.1", "out_of_range"),
        ("mu_0=nan:0.1", "out_of_range"),
        ("mu_0=0.1:7", coded("out_of_range", name="friction.mu_0")),
        ("mew_0=0.1:0.2", "unknown_name"),
    ],
)
def test_what_is_no_prior_is_refused_in_words(word: str, told: str | Coded) -> None:
    with raises(ParameterError, told):
        prior_of(word)
