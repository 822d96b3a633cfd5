"""Cells to numbers: what Python would take for a number and people do not."""

from __future__ import annotations

import math
from decimal import Decimal

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skisnow.campaign.problems import error
from skisnow.campaign.reading.columns import decimal_mark, is_number, number, numbers

GOOD = {"1": 1.0, "-2.5": -2.5, "+.5": 0.5, "3.": 3.0, "1e3": 1000.0, "2.5E-1": 0.25, " 7.5\u00a0": 7.5, "007": 7.0}
BAD = [
    "",
    " ",
    "nan",
    "NaN",
    "inf",
    "-Infinity",
    "1_000",
    "1 000",
    "١",
    "1,5",
    "1.2.3",
    "0x10",
    "12 mm",
    "1e999",
    "e5",
    ".",
]


@pytest.mark.parametrize("with_bad", [False, True])
def test_points(with_bad: bool) -> None:
    """The whole column at once and cell by cell give the same."""
    for cell, value in GOOD.items():
        found = numbers([cell, "abc" if with_bad else "1"], ".")
        assert found[0] == value == number(cell, ".")


@pytest.mark.parametrize("cell", BAD)
def test_no_numbers(cell: str) -> None:
    for others in (["1.5"], ["1.5", ""], ["x"]):
        found = numbers([cell, *others], ".")
        assert math.isnan(found[0])
    assert numbers(["1.5", cell], ".")[0] == 1.5
    assert math.isnan(number(cell, "."))


def test_decimal_commas_take_no_points() -> None:
    np.testing.assert_array_equal(numbers(["1,5", "2", "-,25", "1e2"], ","), [1.5, 2.0, -0.25, 100.0])
    np.testing.assert_array_equal(numbers(["1,5", "1.5", "1,2,3", ""], ","), [1.5, np.nan, np.nan, np.nan])


@given(st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=1), st.sampled_from(".,"))
def test_every_float_comes_back(values: list[float], mark: str) -> None:
    cells = [repr(value).replace(".", mark) for value in values]
    assert numbers(cells, mark).tolist() == values


@pytest.mark.parametrize(
    ("groups", "separator", "mark"),
    [
        ([], ";", "."),
        ([["1", "2"]], ";", "."),
        ([["1,5", "2"]], ";", ","),
        ([["1,5", "2,5", "1.234"]], ";", ","),
        ([["1.5", "2.5", "1,5"]], ";", "."),
        ([["1,5", "1.5"]], ";", ","),
        ([["1,5", "1.5"]], ",", "."),
        ([["1", "2"], ["1,5"], ["1.5", "2.5"]], "\t", ","),
        ([["a, b", "1.2.3", "x.y"]], ";", "."),
        ([["ca. 5", "0,25"]], ",", ","),
    ],
)
def test_decimal_mark(groups: list[list[str]], separator: str, mark: str) -> None:
    assert decimal_mark(groups, separator=separator) == mark


def test_a_long_cell_is_refused_after_one_pass() -> None:
    for cell in ("1" * 1_000_000 + "x", "1" * 1_000_000, "." * 1_000_000, "1e" + "1" * 1_000_000 + "e"):
        assert not is_number(cell, ".")  # with backtracking this would take hours
        assert math.isnan(number(cell))


def test_every_number_in_double_precision_can_be_written_in_full() -> None:
    longest = format(Decimal(-math.nextafter(2.0**-1022, 0.0)), "f")
    assert len(longest) == 1077
    assert number(longest) == -math.nextafter(2.0**-1022, 0.0)


@pytest.mark.parametrize("length", [200, 201, 30_000])
def test_a_long_cell_is_kept_and_its_sentence_is_short(length: int) -> None:
    cell = "9" * length
    problem = error("not_a_number", "shear.csv", row=3, column="depth_mm", value=cell, allowed="a number", action="")
    assert problem.value == cell
    assert str(problem).count("9") == 200
    assert ("…" in str(problem)) is (length > 200)
