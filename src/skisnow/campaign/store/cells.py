"""Cells as they are typed: the text that a table holds, or an error whose sentences are templates with fields."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from ..._support.errors import ParameterError
from ..reading.cell_values import number
from ..reading.heading_units import UnitConversion
from ..reading.table_forms import BRANCH, BRANCHES, TABLES

if TYPE_CHECKING:
    from ...parameters import Quantity
    from ..reading.table_forms import TableForm

FORMS: Final = {form.file: form for form in TABLES}
"""What each table must and may have, by its file."""
LONGEST_TEXT: Final = 200

EMPTY: Final = "{} is empty."
NOT_ALLOWED: Final = "{}: “{}” is not allowed."
TOO_LONG: Final = "{} is too long, or has several lines."
_PROBLEMS: Final = {"empty": EMPTY, "not_allowed": NOT_ALLOWED, "too_long": TOO_LONG}
NAME: Final = "Enter a name."
BRANCH_WORD: Final = "Enter loading or unloading, or leave it empty."
SHORT_LINE: Final = "Enter one line of at most {} characters."
ANY_NUMBER: Final = "Enter a number."
AT_LEAST: Final = "Enter a number of {} or more."
ABOVE: Final = "Enter a number above {}."
BETWEEN: Final = {
    (False, False): "Enter a number from {} to {}.",
    (False, True): "Enter a number from {} to below {}.",
    (True, False): "Enter a number above {} and up to {}.",
    (True, True): "Enter a number above {} and below {}.",
}
"""By whether the lowest and the highest number are excluded."""


class CellError(ParameterError):
    """A typed cell is rejected. The message has two sentences, each with its own template.

    Attributes
    ----------
    code
        empty, not_allowed or too_long.
    column, value
        Name of the column, and the typed text.
    problem, fix
        Template of each sentence; the fields of the first are `column` and `value`, those of the second `limits`.
    limits
        Numbers that limit what is allowed, in the unit of the text.
    """

    def __init__(self, code: str, column: str, value: str, fix: str, limits: tuple[float, ...] = ()) -> None:
        self.column, self.value = column, value
        self.problem, self.fix, self.limits = _PROBLEMS[code], fix, limits
        text = f"{self.problem.format(column, value)} {fix.format(*(f'{limit:g}' for limit in limits))}"
        super().__init__(text, code=code)


def checked_cell(form: TableForm, column: str, typed: str, *, conversion: UnitConversion | None = None) -> str:
    """The text of a cell as a table holds it: without blanks around it, a number with a decimal point.

    Parameters
    ----------
    form, column, typed
        Table, name of the column, and the text.
    conversion
        From the unit of the text to that of the column (default: it has the unit of the column).

    Raises
    ------
    CellError
        An empty name, a text that is too long, a text that is not a number, a number outside its range.

    >>> checked_cell(FORMS["penetration.csv"], "depth_mm", " 2,50 ")
    '2.50'
    """
    text = typed.strip()
    rule = next((rule for rule in form.numbers if rule.name == column), None)
    if rule is not None:
        return _number_cell(rule, text, conversion or UnitConversion(column))
    if column == BRANCH and text.casefold() not in BRANCHES:
        raise CellError("not_allowed", column, text, BRANCH_WORD)
    if not text and column in form.names:
        raise CellError("empty", column, text, NAME)
    if len(text) > LONGEST_TEXT or not all(letter.isprintable() for letter in text):
        raise CellError("too_long", column, text, SHORT_LINE, (LONGEST_TEXT,))
    return text


def _number_cell(rule: Quantity, text: str, conversion: UnitConversion) -> str:
    if not text and not rule.needed:
        return ""
    mark = "," if "," in text and "." not in text else "."
    value = number(text, mark)
    if math.isnan(value) or bool(rule.outside(conversion.convert(np.array([value])))[0]):
        fix, limits = _number_fix(rule)
        in_its_unit = tuple(conversion.revert(limit) for limit in limits)
        raise CellError("not_allowed" if text else "empty", rule.name, text, fix, in_its_unit)
    return text.replace(",", ".")


def _number_fix(rule: Quantity) -> tuple[str, tuple[float, ...]]:
    """Template and limits of the sentence that says which numbers are allowed."""
    if rule.highest < math.inf:
        return BETWEEN[rule.above, rule.below], (rule.lowest, rule.highest)
    if rule.lowest > -math.inf:
        return (ABOVE if rule.above else AT_LEAST), (rule.lowest,)
    return ANY_NUMBER, ()
