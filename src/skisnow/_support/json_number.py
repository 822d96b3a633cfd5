"""Numbers for JSON, which has none for what is not finite."""

from __future__ import annotations

import math


def json_number(value: float | None) -> float | None:
    """The number, or None in place of what JSON has no number for.

    >>> json_number(2), json_number(math.inf), json_number(math.nan), json_number(None)
    (2.0, None, None, None)
    """
    return None if value is None or not math.isfinite(value) else float(value)
