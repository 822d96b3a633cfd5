"""Cells as they are typed: which may be blank, which are refused, what is written down."""

from __future__ import annotations

import pytest

from skisnow._support.language.catalogues import catalogue
from skisnow.campaign.store.stored_tables import (
    ABOVE,
    ANY_NUMBER,
    AT_LEAST,
    BETWEEN,
    BRANCH_WORD,
    EMPTY,
    FORMS,
    LONGEST_TEXT,
    NAME,
    NOT_ALLOWED,
    SHORT_LINE,
    TOO_LONG,
    CellError,
    checked_cell,
)

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
    ("file", "column", "typed", "code", "fix", "limits"),
    [
        ("penetration.csv", "experiment", "  ", "empty", NAME, ()),
        ("penetration.csv", "load_N", "", "empty", ABOVE, (0.0,)),
        ("penetration.csv", "load_N", "0", "not_allowed", ABOVE, (0.0,)),
        ("penetration.csv", "load_N", "1,234.5", "not_allowed", ABOVE, (0.0,)),
        ("penetration.csv", "load_N", "seventy", "not_allowed", ABOVE, (0.0,)),
        ("penetration.csv", "depth_mm", "-1", "not_allowed", AT_LEAST, (0.0,)),
        ("penetration.csv", "edge_angle_deg", "90", "not_allowed", BETWEEN[False, True], (0.0, 90.0)),
        ("penetration.csv", "air_temperature_C", "nan", "not_allowed", ANY_NUMBER, ()),
        ("penetration.csv", "snow_density_kg_per_m3", "918", "not_allowed", BETWEEN[True, False], (0.0, 917.0)),
        ("shear.csv", "edge_angle_deg", "91", "not_allowed", BETWEEN[True, False], (0.0, 90.0)),
        ("shear.csv", "turning_angle_deg", "361", "not_allowed", BETWEEN[False, False], (-360.0, 360.0)),
        ("penetration.csv", "remark", "x" * (LONGEST_TEXT + 1), "too_long", SHORT_LINE, (LONGEST_TEXT,)),
        ("penetration.csv", "remark", "two\nlines", "too_long", SHORT_LINE, (LONGEST_TEXT,)),
        ("penetration.csv", "branch", "sideways", "not_allowed", BRANCH_WORD, ()),
    ],
)
def test_what_is_rejected(file: str, column: str, typed: str, code: str, fix: str, limits: tuple[float, ...]) -> None:
    with pytest.raises(CellError) as raised:
        checked_cell(FORMS[file], column, typed)
    error = raised.value
    assert (error.code, error.column, error.value, error.fix) == (code, column, typed.strip(), fix)
    assert error.limits == pytest.approx(limits)


def test_each_sentence_has_a_german_one_with_the_same_fields() -> None:
    templates = (EMPTY, NOT_ALLOWED, TOO_LONG, NAME, BRANCH_WORD, SHORT_LINE, ANY_NUMBER, AT_LEAST, ABOVE)
    for template in (*templates, *BETWEEN.values()):
        fields = [f"<{number}>" for number in range(template.count("{}"))]
        german = catalogue("de").as_given(template).format(*fields)
        assert german != template.format(*fields)
        assert all(field in german for field in fields)


def test_the_longest_text_is_taken() -> None:
    assert checked_cell(PENETRATION, "remark", "x" * LONGEST_TEXT) == "x" * LONGEST_TEXT
