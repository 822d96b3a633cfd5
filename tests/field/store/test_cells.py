"""Cells as they are typed: which may be blank, which are refused, what is written down."""

from __future__ import annotations

import pytest

from skisnow.errors import ParameterError
from skisnow.field.store.cells import FORMS, LONGEST_TEXT, checked_cell

PENETRATION = FORMS["penetration.csv"]


@pytest.mark.parametrize(
    ("column", "typed", "written"),
    [
        ("experiment", " P1 ", "P1"),
        ("spot", "", ""),
        ("remark", "", ""),
        ("snow_density_kg_per_m3", "350", "350"),
        ("snow_density_kg_per_m3", " ", ""),
        ("load_N", "70.5", "70.5"),
        ("load_N", "70,5", "70.5"),
        ("load_N", "70", "70"),
    ],
)
def test_what_is_written_down(column: str, typed: str, written: str) -> None:
    assert checked_cell(PENETRATION, column, typed) == written


@pytest.mark.parametrize(
    ("column", "typed", "why"),
    [
        ("experiment", "  ", "experiment is blank"),
        ("load_N", "", "it is blank"),
        ("load_N", "0", "'0' stands there"),
        ("load_N", "1,234.5", "stands there"),
        ("load_N", "seventy", "stands there"),
        ("snow_density_kg_per_m3", "918", "above 0 to 917"),
        ("remark", "x" * (LONGEST_TEXT + 1), "at most 200 letters"),
        ("remark", "two\nlines", "one line"),
    ],
)
def test_what_is_refused(column: str, typed: str, why: str) -> None:
    with pytest.raises(ParameterError, match=why):
        checked_cell(PENETRATION, column, typed)


def test_the_longest_text_is_taken() -> None:
    assert checked_cell(PENETRATION, "remark", "x" * LONGEST_TEXT) == "x" * LONGEST_TEXT
