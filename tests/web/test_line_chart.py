"""What is sent to a chart: values as short as a screen can show, nothing where nothing is known."""

import math

import pytest

pytest.importorskip("nicegui", reason="the web lab is not installed")

from skisnow.web.line_chart import _short


@pytest.mark.parametrize(
    ("values", "sent"),
    [
        ([12345.6789, -1.23456], [12346.0, -1.0]),
        ([0.0123456789, 0.001], [0.012346, 0.001]),
        ([1.0, None, math.inf, 0.123456], [1.0, None, None, 0.1235]),
        ([0.0, -0.0, None, math.nan], [0.0, 0.0, None, None]),
        ([None, math.inf], [None, None]),
        ([], []),
    ],
)
def test_five_digits_of_the_largest(values: list[float | None], sent: list[float | None]) -> None:
    assert _short(values) == sent
