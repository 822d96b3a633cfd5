from __future__ import annotations

import pytest
from tests.coded import Coded, coded, raises

from skisnow._support.errors import ParameterError
from skisnow.ski.layout import layout_of_lengths


def test_boot_position_moves_everything_backwards() -> None:
    """A boot 30 mm in front of the middle sees the middle 30 mm behind itself."""
    layout = layout_of_lengths(
        length=1.6, running_length=1.4, sidecut_length=1.46, tail_overhang=0.02, boot_position=0.03
    )
    assert layout.middle == -0.03
    assert layout.tail == pytest.approx(-0.03 - 0.73 - 0.02)
    assert layout.tip == pytest.approx(-0.03 + 0.73 + 0.12)
    assert layout.contact_points == pytest.approx((0.67, -0.73))


@pytest.mark.parametrize(
    ("lengths", "named"),
    [
        ({"running_length": 1.7}, coded("contradiction", name="running_length", length=1700.0)),
        ({"sidecut_length": 1.59}, coded("contradiction", name="sidecut_length", length=1590.0)),
        ({"running_length": 0.0}, coded("out_of_range", name="running_length", length=0.0)),
        ({"sidecut_length": float("nan")}, coded("out_of_range", name="sidecut_length")),
    ],
)
def test_lengths_that_do_not_fit(lengths: dict[str, float], named: str | Coded) -> None:
    with raises(ParameterError, named):
        layout_of_lengths(**{"length": 1.6, "running_length": 1.4, "sidecut_length": 1.46, **lengths})
