"""Numbers typed into a field."""

from __future__ import annotations

import math

from .._support.errors import ParameterError


def typed_number(what: str, text: str) -> float:
    """A finite number, with a point or a comma, and any minus that a keyboard writes.

    Raises
    ------
    ParameterError
        It is none; the sentence begins with `what`.
    """
    try:
        value = float(text.strip().replace(",", ".").replace("−", "-"))
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise ParameterError(f"{what}: {text.strip()!r} is no number. Correct it")
    return value
