"""Whole numbers in a text of unknown length, such as a header of a request or the name of a test."""

from __future__ import annotations

from typing import Final

MOST_DIGITS: Final = 18
"""Of a number that fits into 64 bits. Python itself rejects texts of more than 4,300 digits with a ValueError."""


def natural_number(text: str) -> int | None:
    """Whole number of 0 or more; None if the text is anything else than 1 to 18 decimal digits.

    >>> natural_number("42"), natural_number("-1"), natural_number("9" * 5000)
    (42, None, None)
    """
    return int(text) if len(text) <= MOST_DIGITS and text.isdecimal() else None
