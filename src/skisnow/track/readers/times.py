"""Times of points: time stamps shared by several points, and serial numbers of spreadsheets.

Devices that record at 5 to 25 Hz write whole seconds or tenths of a second in some formats. The points of one stamp
are spread over the time until the next one. Points that were recorded twice also share a stamp: there the place does
not advance from one point of a stamp to the next, and the stamps stay.
"""

from __future__ import annotations

from datetime import datetime, timedelta
from typing import TYPE_CHECKING, Final

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

    BoolArray = npt.NDArray[np.bool_]
    FloatArray = npt.NDArray[np.float64]
    IntArray = npt.NDArray[np.int64]


LEAST_SHARE: Final = 0.3
"""Smallest share of points that do not begin a stamp in a file with rounded stamps (modelling assumption)."""
LEAST_ADVANCE: Final = 0.5
"""Smallest share of the path within stamps, relative to an even motion, of advancing points (modelling assumption)."""
_EVEN: Final = 1.01
"""Steps between stamps up to this many units count as one unit: no stamp is missing."""


def spread_times(time: FloatArray, place: FloatArray) -> tuple[FloatArray, BoolArray]:
    """Times with the points of each stamp spread until the next stamp, and which points were moved.

    Parameters
    ----------
    time : (n,) s
        Never falling.
    place : (n, 2) m
        Horizontal places, NaN if unknown.

    Returns
    -------
    tuple
        Times (n,) (s), and (n,) bool. Without rounded stamps: the times given, and no point.

    Examples
    --------
    >>> place = np.column_stack([np.arange(6.0), np.zeros(6)])
    >>> spread_times(np.array([0.0, 1.0, 1.0, 2.0, 2.0, 3.0]), place)[0].round(9).tolist()
    [0.5, 1.0, 1.5, 2.0, 2.5, 3.0]
    """
    unmoved = time, np.zeros(len(time), dtype=bool)
    begins = np.r_[True, np.diff(time) > 0.0] if len(time) else np.zeros(0, dtype=bool)
    if np.count_nonzero(begins) < 2 or np.count_nonzero(~begins) < LEAST_SHARE * len(time):
        return unmoved
    if _advance(place, begins) < LEAST_ADVANCE:
        return unmoved
    first = np.flatnonzero(begins)
    unit = float(np.median(np.diff(time[first])))
    spread = time.copy()
    missing = np.flatnonzero(np.diff(time[first]) > _EVEN * unit) + 1
    count = float(np.median(np.diff(np.append(first, len(time)))))
    for block in np.split(np.arange(len(first)), missing):
        begin = int(first[block[0]])
        end = int(first[block[-1] + 1]) if block[-1] + 1 < len(first) else len(time)
        spread[begin:end] = _block_times(time[first[block]], first[block] - begin, end - begin, (unit, count))
    return np.maximum.accumulate(spread), spread != time


def _advance(place: FloatArray, begins: BoolArray) -> float:
    """Length of the path within stamps relative to its expected share; infinite if nothing moves."""
    steps = np.hypot(*np.diff(place, axis=0).T)
    finite = np.isfinite(steps)
    whole = float(np.sum(steps[finite]))
    if not 0.0 < whole < np.inf:
        return 0.0
    within = finite & ~begins[1:]
    if not within.any():
        return 0.0
    return float(np.sum(steps[within])) / whole / (np.count_nonzero(within) / np.count_nonzero(finite))


def _block_times(stamps: FloatArray, first: IntArray, size: int, usual: tuple[float, float]) -> FloatArray:
    """Times of the points of consecutive stamps: at an even rate if all stamps agree with one, else stamp by stamp.

    Parameters
    ----------
    stamps, first : (m,)
        Stamps (s), and the number of the first point of each.
    size
        Number of points.
    usual
        Unit of the stamps (s), and the usual number of points in a stamp.
    """
    unit, count = usual
    step = unit / count
    if len(stamps) > 2:
        step = float(np.polyfit(first[1:], stamps[1:], 1)[0])
    even = step * np.arange(size)
    crossings = stamps[1:] - even[first[1:]] if len(stamps) > 1 else np.array([stamps[0] + unit - step * size])
    if np.ptp(crossings) <= max(1.5 * step, 1e-6 * unit):
        return np.asarray(even + float(np.max(crossings)))
    times = np.empty(size)
    ends = np.append(first[1:], size)
    for stamp, begin, end in zip(stamps, first, ends, strict=True):
        points = end - begin
        own = unit / points if begin > 0 and end < size else min(step, unit / points)
        shift = unit - own * points if begin == 0 else 0.0
        times[begin:end] = stamp + shift + own * np.arange(points)
    return times


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


def convert_serial_dates(values: FloatArray) -> tuple[FloatArray, datetime | None, str | None]:
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
