"""Cells as they are typed, checked before they are written down: one sentence for what is wrong, or the cell's text."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from ...errors import ParameterError
from ..reading.number_cells import number
from ..reading.table_forms import BRANCH, BRANCHES, TABLES, allowed_words

if TYPE_CHECKING:
    from ...inputs import Quantity
    from ..reading.table_forms import TableForm

FORMS: Final = {form.file: form for form in TABLES}
"""What each table must and may have, by its file."""
LONGEST_TEXT: Final = 200


def checked_cell(form: TableForm, column: str, typed: str) -> str:
    """The text of a cell as a table holds it: without blanks around it, a number with a decimal point.

    Raises
    ------
    ParameterError
        A name that must not be blank, a text that is too long, what is no number, a number outside its range.

    >>> checked_cell(FORMS["penetration.csv"], "depth_mm", " 2,50 ")
    '2.50'
    """
    text = typed.strip()
    rule = next((rule for rule in form.numbers if rule.name == column), None)
    if rule is not None:
        return _number_cell(rule, text)
    if column == BRANCH and text.casefold() not in BRANCHES:
        raise ParameterError(f"{column} is {' or '.join(filter(None, BRANCHES))}, or blank; {text!r} stands there")
    if not text and column in form.names:
        raise ParameterError(f"{column} is blank; give it a name")
    if len(text) > LONGEST_TEXT or not all(letter.isprintable() for letter in text):
        raise ParameterError(f"{column} is one line of at most {LONGEST_TEXT} letters")
    return text


def _number_cell(rule: Quantity, text: str) -> str:
    if not text and not rule.needed:
        return ""
    mark = "," if "," in text and "." not in text else "."
    value = number(text, mark)
    if math.isnan(value) or bool(rule.outside(np.array([value]))[0]):
        found = f"{text!r} stands there" if text else "it is blank"
        raise ParameterError(f"{rule.name} is {allowed_words(rule)}; {found}")
    return text.replace(",", ".")
