"""Analysis of variance: NIST's SiRstv, statsmodels' regression on groups, and the undefined cases."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.statistics import one_way_anova


def test_silicon_resistivity(nist: Callable[[str], Any], digits: Callable[..., float]) -> None:
    file = nist("SiRstv")
    instrument, resistance = file.data.T
    found = one_way_anova([resistance[instrument == k] for k in range(1, 6)])
    df_between, ss_between, _, F = file.numbers_after("Between Instrument")
    df_within, ss_within, _ = file.numbers_after("Within Instrument")
    assert (found.df_between, found.df_within) == (df_between, df_within)
    assert digits([found.ss_between, found.ss_within, found.F], [ss_between, ss_within, F]) >= 9
    assert digits(found.r2, file.numbers_after("Certified R-Squared")) >= 9
    assert digits(found.residual_sd, file.numbers_after("Standard Deviation")) >= 9


def test_p_and_unequal_groups_against_scipy() -> None:
    from scipy.stats import f_oneway

    rng = np.random.default_rng(1)
    groups = [rng.normal(mean, 1.0, size) for mean, size in ((0.0, 3), (0.5, 8), (1.0, 5))]
    peer = f_oneway(*groups)
    found = one_way_anova(groups)
    np.testing.assert_allclose([found.F, found.p], [peer.statistic, peer.pvalue], rtol=1e-11)


def test_common_digits_cost_nothing(digits: Callable[..., float]) -> None:
    groups = np.array([[0.25, 0.5, 1.0], [0.75, 1.25, 0.5]])
    assert digits(one_way_anova(list(groups + 2.0**30)).F, one_way_anova(list(groups)).F) > 14


def test_undefined() -> None:
    assert np.isnan([one_way_anova([[1.0, 2.0]]).F, one_way_anova([[1.0], [2.0]]).p]).all()
    for groups in ([], [[1.0], []], [[1.0, float("nan")], [2.0]]):
        with pytest.raises(ParameterError):
            one_way_anova(groups)


def test_a_value_that_is_no_number_is_told_with_its_group() -> None:
    with pytest.raises(ParameterError, match=r"group 2\[1\] is nan"):
        one_way_anova([[1.0, 2.0], [3.0, float("nan")], [4.0]])
