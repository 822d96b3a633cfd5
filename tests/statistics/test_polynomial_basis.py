"""The exact way back from Chebyshev polynomials to powers."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from skisnow.statistics.linear import chebyshev_columns, exact_way_back


def test_first_chebyshev_polynomials() -> None:
    # T_2 = 2 t² - 1 and T_3 = 4 t³ - 3 t with t = (x - 1)/2: T_2 = x²/2 - x - 1/2
    back = exact_way_back(3, 1.0, 2.0)
    assert [row[2] for row in back] == [Fraction(-1, 2), -1, Fraction(1, 2), 0]
    assert [row[3] for row in exact_way_back(3, 0.0, 1.0)] == [0, -3, 0, 4]


def test_columns_are_cosines_and_stay_near_one() -> None:
    x = np.linspace(1947.0, 1962.0, 16)
    columns = chebyshev_columns(x[:, None], 8)
    assert np.abs(columns.scaled[:, 1]).max() <= 1.0 + 1 / 16
    inside = np.abs(columns.scaled[:, 1]) <= 1
    angle = np.arccos(columns.scaled[inside, 1])
    np.testing.assert_allclose(columns.scaled[inside, 8], np.cos(8 * angle), atol=1e-13)
