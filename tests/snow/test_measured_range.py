"""The warning outside a measured range."""

import warnings

import numpy as np
import pytest

from skisnow._support.errors import RangeWarning
from skisnow.snow import MeasuredRange

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
