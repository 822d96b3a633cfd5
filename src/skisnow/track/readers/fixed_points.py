"""Points of a recording that have a fix, and those between them.

Before the first fix and after the last one, receivers write clocks and places of their own. Such points give neither
path nor time nor date. They are left out and counted.
"""

from __future__ import annotations

from dataclasses import replace
from datetime import timedelta
from typing import TYPE_CHECKING, Any, Final

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

    from .recording import Recording

    BoolArray = npt.NDArray[np.bool_]
    FloatArray = npt.NDArray[np.float64]

BEFORE: Final = "points before the first fix"
AFTER: Final = "points after the last fix"
OUT_OF_ORDER: Final = "points without a fix whose time is not between the points with a fix around them"
_ARRAYS: Final = ("time", "place", "speed", "velocity", "place_sd", "speed_sd", "odometer", "fix", "solution",
                  "segment", "not_finite")  # fmt: skip


def fixed_points(recording: Recording, fix: BoolArray) -> tuple[Recording, BoolArray]:
    """The recording from its first to its last point with a fix, and the fix of its points.

    Parameters
    ----------
    recording
        As read.
    fix : (n,) bool
        True for points with a fix; at least one is.
    """
    numbers = np.flatnonzero(fix)
    first, last = int(numbers[0]), int(numbers[-1])
    inside = np.zeros(len(fix), dtype=bool)
    inside[first : last + 1] = True
    ordered = fix | _between_neighbours(recording.time, fix)
    counts = {
        BEFORE: first,
        AFTER: len(fix) - 1 - last,
        OUT_OF_ORDER: int(np.count_nonzero(inside & ~ordered)),
    }
    left_out = dict(recording.left_out)
    for words, count in counts.items():
        left_out[words] = left_out.get(words, 0) + count
    kept = inside & ordered
    return _taken(recording, kept, left_out), fix[kept]


def _between_neighbours(time: FloatArray, fix: BoolArray) -> BoolArray:
    """True for points whose time is between those of the points with a fix before and after them."""
    known = np.where(fix, time, np.nan)
    numbers = np.arange(len(time))
    before = np.maximum.accumulate(np.where(fix, numbers, -1))
    after = np.minimum.accumulate(np.where(fix, numbers, len(time))[::-1])[::-1]
    with np.errstate(invalid="ignore"):
        return np.asarray(
            (before >= 0)
            & (after < len(time))
            & (time >= known[np.maximum(before, 0)])
            & (time <= known[np.minimum(after, len(time) - 1)])
        )


def _taken(recording: Recording, kept: BoolArray, left_out: dict[str, int]) -> Recording:
    if kept.all():
        return replace(recording, left_out=left_out)
    arrays: dict[str, Any] = {}
    for name in _ARRAYS:
        values = getattr(recording, name)
        arrays[name] = None if values is None else values[kept]
    shift = float(recording.time[np.flatnonzero(kept)[0]] - recording.time[0])
    return replace(
        recording,
        **arrays,
        places_in_file=[where for where, is_kept in zip(recording.places_in_file, kept, strict=True) if is_kept],
        start=None if recording.start is None else recording.start + timedelta(seconds=shift),
        first_time=recording.first_time if recording.start is not None else recording.first_time + shift,
        left_out=left_out,
    )
