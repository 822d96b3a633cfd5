"""Errors say what is wrong, and a long list its beginning."""

import pytest

from skisnow._support.errors import FieldDataError, ParameterError, RangeWarning, SkisnowError


@pytest.mark.parametrize("count", [0, 1, 20])
def test_up_to_twenty_problems_all_stand_in_the_message(count: int) -> None:
    error = FieldDataError([f"problem {number}" for number in range(count)])
    assert str(error).splitlines() == [f"problem {number}" for number in range(count)]
    assert error.problems == tuple(f"problem {number}" for number in range(count))


def test_of_more_the_first_stand_there_and_the_others_are_counted() -> None:
    error = FieldDataError(list(range(23)))
    assert str(error).splitlines() == [*map(str, range(20)), "… and 3 more problems"]
    assert len(error.problems) == 23


def test_kinds_are_caught_as_what_python_calls_them() -> None:
    assert issubclass(ParameterError, ValueError)
    assert issubclass(ParameterError, SkisnowError)
    assert issubclass(RangeWarning, UserWarning)
