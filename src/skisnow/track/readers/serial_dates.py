"""Serial numbers of spreadsheets as times: days since 1899-12-30, or fractions of a day."""

from __future__ import annotations

from datetime import datetime, timedelta
from typing import TYPE_CHECKING, Final

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

    FloatArray = npt.NDArray[np.float64]

DAY: Final = 86_400.0
"""Seconds."""
EPOCH: Final = datetime(1899, 12, 30)
"""Day 0 of spreadsheets with the date system 1900, for all dates since March 1900."""
YEARS_1904: Final = 1462
"""Days by which day 0 of the date system 1904 is later."""
DATES: Final = (20_000.0, 80_000.0)
"""Serial numbers of the years 1954 to 2119."""
LONGEST_STEP: Final = 2e-4
"""Steps between points up to this are days, 17 s; as seconds they would be 5,000 points a second."""


def times_of_numbers(values: FloatArray) -> tuple[FloatArray, datetime | None, str | None]:
    """Seconds, the moment of the first value if the numbers are dates, and a note; numbers of seconds stay.

    Parameters
    ----------
    values : (n,)
        Numbers in a column of times.
    """
    steps = np.diff(values)
    steps = steps[steps > 0.0]
    if not len(steps) or float(np.median(steps)) > LONGEST_STEP:
        return values, None, None
    seconds = np.round(DAY * (values - values[0]), 3)
    if np.all((values >= DATES[0]) & (values <= DATES[1])):
        start = EPOCH + timedelta(milliseconds=round(float(values[0]) * DAY * 1000.0))
        note = (
            f"Times are read as serial numbers of a spreadsheet, in days since {EPOCH:%Y-%m-%d}. With the date system "
            f"1904 they are {YEARS_1904} days later."
        )
        return seconds, start, note
    if np.all((values >= 0.0) & (values < 2.0)):
        return seconds + round(float(values[0]) * DAY, 3), None, "Times are read as fractions of a day."
    return values, None, None
