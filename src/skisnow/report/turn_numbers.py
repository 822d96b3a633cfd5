"""Numbers that tell turns apart: the afterbody in its groove, grip that is used, tracks that lie apart."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from ..statistics import VarianceShares, variance_shares
from ..track.nearest_place import distance_beside
from .figures.run_grip import used_share_of_skis
from .figures.track_band import FEWEST, TimedTrack, band_of, offsets

if TYPE_CHECKING:
    from ..simulation.run import Run
    from .turn_chain import EnsembleRun

FloatArray = npt.NDArray[np.float64]
MORE_THAN_INPUTS: Final = 3
"""Runs at least, more than inputs, that tell shares with an interval."""
YIELDS: Final = 0.95
"""Share of the shear strength from which a ski counts as side-slipping: short parts at its ends may have grip."""


def loaded_skis(run: Run) -> npt.NDArray[np.intp]:
    """The ski with the larger total force at each time, (n,): 0 left, 1 right."""
    return np.argmax(run.skis.total_force, axis=1)


def afterbody_depth_ratio(run: Run) -> float | None:
    """Mean edge depth of the loaded ski's contact behind the boot over that before it; the median over the second half.

    None where the ski has no contact before or behind the boot in all that time.
    """
    late = np.flatnonzero(run.time >= run.time[-1] / 2.0)
    depth = run.skis.edge_depth[late, loaded_skis(run)[late]]
    behind, before = (_mean_depth(depth[:, part]) for part in (run.skis.station < 0.0, run.skis.station > 0.0))
    ratio = behind / before
    known = ratio[np.isfinite(ratio)]
    return float(np.median(known)) if known.size else None


def _mean_depth(depth: FloatArray) -> FloatArray:
    """Mean over the stations below the surface, (n,); nan where there is none."""
    below = depth > 0.0
    count = below.sum(axis=1)
    return np.where(count > 0, np.where(below, depth, 0.0).sum(axis=1) / np.maximum(count, 1), np.nan)


def used_grip(run: Run) -> tuple[float | None, float | None]:
    """Median share of the shear strength that the loaded ski uses, and the share of time in which it side-slips."""
    share = np.take_along_axis(used_share_of_skis(run), loaded_skis(run)[:, None], axis=1)[:, 0]
    known = share[np.isfinite(share)]
    return (float(np.median(known)), float(np.mean(known >= YIELDS))) if known.size else (None, None)


def median_radius(run: Run) -> float | None:
    """Median turn radius (m) of the run where it turns; None where it never does."""
    radius = np.abs(run.turn_radius[np.isfinite(run.turn_radius)])
    return float(np.median(radius)) if radius.size else None


def maximum_distance(run: Run, reference: Run) -> float | None:
    """The farthest that a run's path goes from that of another (m) while it lies beside it; None: nowhere."""
    distance = distance_beside(run.place, reference.place)
    return float(np.nanmax(distance)) if np.isfinite(distance).any() else None


def middle_track(run: Run) -> TimedTrack:
    """The path of the middle between the boots from above."""
    return TimedTrack(run.time, run.place[:, 0], run.place[:, 1])


def band_width(nominal: TimedTrack, tracks: Sequence[TimedTrack]) -> tuple[float, float]:
    """Width of the band of 90 % of the tracks to the side, and ahead, at the last time that three runs reach (m)."""
    aside, ahead = (band_of(values[:, None])[:, 0] for values in end_offsets(nominal, tracks))
    return float(aside[4] - aside[0]), float(ahead[4] - ahead[0])


def end_offsets(nominal: TimedTrack, tracks: Sequence[TimedTrack]) -> tuple[FloatArray, FloatArray]:
    """How far each track lies to the left and ahead (m), (tracks,), at the last time that three reach; nan: ended."""
    aside, ahead = offsets(nominal, tracks)
    last = int(np.flatnonzero(np.isfinite(aside).sum(axis=0) >= FEWEST)[-1])
    return aside[:, last], ahead[:, last]


@dataclass(frozen=True, slots=True, eq=False)
class BandShares:
    """What each input of an ensemble adds to the variance at the end of the band, aside and ahead.

    Attributes
    ----------
    keys
        What varies, by the scenario's keys.
    aside, ahead
        Shares of these.
    """

    keys: tuple[str, ...]
    aside: VarianceShares
    ahead: VarianceShares


def band_shares(nominal: TimedTrack, ensemble: Sequence[EnsembleRun]) -> BandShares | None:
    """First-order Sobol shares by regression on logarithms; None with fewer than three runs more than inputs."""
    keys = [key for key in (ensemble[0].values if ensemble else ()) if len({run.values[key] for run in ensemble}) > 1]
    if not keys:
        return None
    aside, ahead = end_offsets(nominal, [run.track for run in ensemble])
    reached = np.isfinite(aside)
    if reached.sum() < len(keys) + MORE_THAN_INPUTS:
        return None
    inputs = np.log([[run.values[key] for key in keys] for run in ensemble])[reached]
    return BandShares(tuple(keys), *(variance_shares(each[reached], inputs) for each in (aside, ahead)))
