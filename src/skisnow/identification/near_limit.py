"""Whether the run that was found is near the limit of grip: a thousandth of an input moves its end by far more."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from .._support.processes.kept_rows import Row
from ..simulation.verification import NUDGE, NUDGED, limit_sentences
from .run_simulation import RunTask

_SNOW: Final = ("snow.H_V_N_per_mm3", "snow.S_f_N_per_mm2")


def nudged_tasks(task: RunTask, values: Mapping[str, float]) -> dict[str, tuple[RunTask, ...]]:
    """A quick run with a thousandth more and one with a thousandth less of each input, by key.

    Parameters
    ----------
    task
        Of the run that was found.
    values
        The scenario's, where the task has none. One that is 0 is not nudged.
    """
    base = {**{key: values[key] for key in _SNOW}, **task.values}  # numbers: a published snow is none any more
    found: dict[str, tuple[RunTask, ...]] = {}
    for key in NUDGED:
        own = base.get(key, values[key])
        if own:
            each = ({**base, key: own * (1.0 + sign * NUDGE)} for sign in (1.0, -1.0))
            found[key] = tuple(RunTask(nudged, task.run, final=False) for nudged in each)
    return found


def limit_of(own: Row, nudged: Mapping[str, Sequence[Row]]) -> tuple[str, ...]:
    """The sentence of `simulate --verify`, from the ends of the run that was found and of the nudged ones."""
    if "x_m" not in own or len(own["x_m"]) < 2:
        return ()
    length = float(np.sum(np.hypot(np.diff(own["x_m"]), np.diff(own["y_m"]))))
    moves = {key: max((_apart(own, row) for row in rows), default=0.0) for key, rows in nudged.items()}
    return limit_sentences(moves, length)


def _apart(own: Row, other: Row) -> float:
    """Distance (m) of the ends; 0 where the other run is none."""
    if "x_m" not in other:
        return 0.0
    return float(np.hypot(other["x_m"][-1] - own["x_m"][-1], other["y_m"][-1] - own["y_m"][-1]))
