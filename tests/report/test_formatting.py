"""Numbers as they are printed."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from skisnow.report.formatting import p_equals, significant, whole


@pytest.mark.parametrize(
    ("value", "digits", "expected"),
    [
        (0.21, 3, "0.210"),
        (56.14, 3, "56.1"),
        (56.14, 4, "56.14"),
        (1652.0, 3, "1652"),
        (999.96, 4, "1000"),
        (0.0009996, 3, "0.00100"),
        (-0.0123, 3, "−0.0123"),
        (0.0, 3, "0"),
        (1.234e-5, 3, "1.23×10⁻⁵"),
        (-1.5e9, 2, "−1.5×10⁹"),
        (None, 3, "–"),
    ],
)
def test_significant(value: float | None, digits: int, expected: str) -> None:
    assert significant(value, digits) == expected


@given(value=st.floats(-1e12, 1e12, allow_nan=False), digits=st.integers(2, 6))
def test_printed_is_the_value_to_its_digits(value: float, digits: int) -> None:
    """Half a unit of the last digit, for any magnitude."""
    printed = float(significant(value, digits, style="plain"))
    assert abs(printed - value) <= 0.5000001 * 10.0 ** (1 - digits) * abs(value) * 10.0


def test_p_values() -> None:
    assert p_equals(0.00012, style="plain") == "p < 0.001"
    assert p_equals(0.0503, style="plain") == "p = 0.050"
    assert p_equals(0.52) == "p\u00a0=\u00a00.52"


def test_counts_are_grouped_from_five_digits() -> None:
    assert (whole(1652), whole(143000)) == ("1652", "143\u202f000")
