"""An offset between two tracks that nobody knows, fitted by least squares: start, heading, start time.

Start and heading come from the nearest distances, the time from those at equal time. The simulated track is moved as
it is: no scaling, no reflection, no bending.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass, replace
from typing import Final, Literal, TypeAlias, get_args

import numpy as np
import numpy.typing as npt
from scipy.optimize import minimize_scalar

from ..errors import FitError, ParameterError
from ..units import DEGREE
from .nearest_place import NearestPlaces, Path
from .polyline import Polyline, polyline
from .three_distances import EXACTNESS

FloatArray = npt.NDArray[np.float64]

Offset: TypeAlias = Literal["start", "heading", "time"]
OFFSETS: Final[tuple[Offset, ...]] = get_args(Offset)
"""What may be unknown: the place of the first point, the direction (turned about the vertical there), the time."""
PLACES: Final = 2048
"""Equal steps of the measured track over which squares are summed: the sum stands for an integral over its length."""
ROUGHLY: Final = 8
"""Each beginning is followed with every so many places first, which takes so much less time, and then with all."""
LEAST_SHARE: Final = 0.5
"""Of the places, or of the shorter time, that must stay in the comparison: a fit may not slide a track out of sight."""
HEADINGS: Final = 8
"""Directions at equal angles from which a heading is sought: fewer miss turns that look alike from near by."""
RIVAL: Final = 2.0
"""A second answer whose rms distance is within this factor of the best is told."""
_ANOTHER: Final = 5.0 * DEGREE
"""Answers turned by more, or that move an end of the track by more than this times its length, are two."""
DETERMINED: Final = 1e-3
"""Directions whose singular value is below this part of the largest are left as they are, and said."""
_BETTER: Final = 0.99
_ROUNDS: Final = 100
_SETTLED: Final = 1e-10
_GOOD_ENOUGH: Final = 1e-5
"""Steps (in parts of the length) that go on below this only pass single places over the ends to and fro."""
_TO_AND_FRO: Final = 10
"""They do where one is as long as one of so many before it."""
_TIMES: Final = 401


@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """How the simulated track is moved onto the measured one.

    Attributes
    ----------
    moved : (d,) m
        Of its first point.
    turned
        About the vertical through its first point (rad), positive to the left.
    undetermined
        How many directions the tracks do not tell, such as along two straight lines; nothing was moved along them.
    rms
        Of the nearest distances it leaves (m); infinite where it is no answer.
    rival
        The best answer that is turned otherwise, where it is about as good.
    """

    moved: FloatArray
    turned: float
    undetermined: int = 0
    rms: float = math.inf
    rival: Motion | None = None

    def applied(self, line: Polyline) -> Polyline:
        """The whole track, moved."""
        start = line.place[0]
        return polyline((line.place - start) @ _turn(self.turned, len(start)).T + start + self.moved, line.time)


def _turn(angle: float, dimensions: int) -> FloatArray:
    matrix = np.eye(dimensions)
    matrix[:2, :2] = [[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]]
    return matrix


def require_offsets(fit: Collection[str]) -> None:
    """Refuse what is none of `OFFSETS`.

    Raises
    ------
    ParameterError
        Names them.
    """
    wrong = [word for word in fit if word not in OFFSETS]
    if wrong:
        raise ParameterError(f"{wrong[0]!r} is no offset that can be fitted; {', '.join(OFFSETS)} are")


def fitted_motion(simulated: Polyline, measured: Polyline, *, start: bool, heading: bool) -> Motion:
    """Least squares of the nearest distance over the measured track's length.

    Gauss–Newton steps with the nearest places found anew each time. Places beyond the ends of the simulated track take
    no part. Begun with the tracks as they lie, with the best overlay at equal arc length and, for a heading, in
    `HEADINGS` directions. An answer counts only where it is better than those before, by mean square over the share of
    places that take part; one in which the simulated track runs against the measured one only where there is no other.

    Raises
    ------
    FitError
        No beginning leads to an answer in which half of the measured track has something beside it.
    """
    path = Path(simulated.place)
    places = measured.at_arc_length(np.linspace(0.0, measured.length, PLACES + 1))
    begins = [Motion(np.zeros(places.shape[1]), 0.0)]
    for ends in (None, (simulated.length, measured.length)):
        begins.append(_overlay(simulated, measured, start=start, heading=heading, ends=ends))
    if heading:
        angles = np.linspace(0.0, 2.0 * math.pi, HEADINGS, endpoint=False) + begins[-1].turned
        begins += [_overlay(simulated, measured, start=start, heading=True, turned=float(each)) for each in angles[1:]]
    settled = begins
    for some in (places[::ROUGHLY], places):
        settled = [_settled(path, some, each, start=start, heading=heading) for each in settled]
    answers = [each for each in settled if math.isfinite(each.rms)]
    if not answers:
        raise FitError(
            f"start and heading cannot be fitted: less than {100 * LEAST_SHARE:g} % of the measured track then has the "
            "simulated one beside it, or the steps do not settle. Look at both tracks without a fit"
        )
    answers = [each for each in answers if _runs_along(path, places, each)] or answers
    exact = (EXACTNESS * measured.length) ** 2
    best = answers[0]
    for each in answers[1:]:
        if each.rms**2 + exact < _BETTER * best.rms**2:
            best = each
    others = [each for each in answers if _is_another(each, best, simulated)]
    rival = min(others, key=lambda each: each.rms, default=None)
    return replace(best, rival=rival if rival is not None and rival.rms < RIVAL * best.rms + exact**0.5 else None)


def _is_another(one: Motion, other: Motion, line: Polyline) -> bool:
    """Whether two answers lay the track elsewhere; along what the tracks do not tell they may differ."""
    if abs(math.remainder(one.turned - other.turned, math.tau)) > _ANOTHER:
        return True
    ends = (each.applied(line).place[[0, -1]] for each in (one, other))
    apart = float(np.linalg.norm(np.subtract(*ends), axis=1).max())
    return not (one.undetermined or other.undetermined) and apart > _ANOTHER * line.length


def _runs_along(path: Path, places: FloatArray, motion: Motion) -> bool:
    """Whether both tracks run the same way, on most of the measured one."""
    local, found = _seen(path, places, motion)
    step = np.diff(local, axis=0)
    return float(np.sign((step * found.direction[1:]).sum(axis=1)).mean()) >= 0.0


def _overlay(
    simulated: Polyline, measured: Polyline, *, start: bool, heading: bool, turned: float | None = None,
    ends: tuple[float, float] | None = None,
) -> Motion:  # fmt: skip
    """Turned and moved so that places at equal arc length are as near as they can be (Kabsch, about the vertical).

    With an angle (rad) moved alone, that far turned. With ends, places at equal shares of these lengths (m): noise may
    make one track longer than its way.
    """
    shorter = min(simulated.length, measured.length)
    share, origin = np.linspace(0.0, 1.0, PLACES + 1), simulated.place[0]
    own, other = (
        line.at_arc_length(end * share) - origin
        for line, end in zip((simulated, measured), ends or (shorter, shorter), strict=True)
    )
    centre = (own.mean(axis=0), other.mean(axis=0)) if start else (np.zeros_like(origin), np.zeros_like(origin))
    a, b = (own - centre[0])[:, :2], (other - centre[1])[:, :2]
    if turned is None:
        twist = float((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum())
        turned = math.atan2(twist, float((a * b).sum())) if heading else 0.0
    return Motion(centre[1] - _turn(turned, len(origin)) @ centre[0], turned)


def _settled(path: Path, places: FloatArray, motion: Motion, *, start: bool, heading: bool) -> Motion:
    """The answer from one beginning; its mean square is over the share of places, and infinite without an answer."""
    sizes = [math.inf]
    for _ in range(_ROUNDS):
        local, found = _seen(path, places, motion)
        inside = ~found.beyond
        if inside.mean() < LEAST_SHARE:
            return replace(motion, rms=math.inf)  # a beginning may be an answer among fewer places
        matrix, rest = _equations(path, local, found, inside, motion, start=start, heading=heading)
        step, undetermined = _least_norm(matrix, rest)
        moved = step[: places.shape[1]] if start else np.zeros(places.shape[1])
        turned = float(step[-1]) / path.length if heading else 0.0
        motion = Motion(motion.moved + moved, motion.turned + turned, undetermined)
        sizes.append(float(np.linalg.norm(step)) / path.length)
        no_shorter = sizes[-1] >= min(sizes[:-_TO_AND_FRO], default=math.inf)
        if sizes[-1] < _SETTLED or (sizes[-1] < _GOOD_ENOUGH and no_shorter):
            break
    if sizes[-1] > _GOOD_ENOUGH:
        return motion
    found = _seen(path, places, motion)[1]
    inside = ~found.beyond
    square = float(np.mean(found.distance[inside] ** 2) / inside.mean()) if inside.any() else math.inf
    return replace(motion, turned=math.remainder(motion.turned, math.tau), rms=math.sqrt(square))


def _seen(path: Path, places: FloatArray, motion: Motion) -> tuple[FloatArray, NearestPlaces]:
    """The measured places as the unmoved simulated track sees them, with its nearest places."""
    local = (places - path.first - motion.moved) @ _turn(motion.turned, places.shape[1]) + path.first
    return local, path.nearest(local)


def _equations(
    path: Path, local: FloatArray, found: NearestPlaces, inside: npt.NDArray[np.bool_], motion: Motion,
    *, start: bool, heading: bool,
) -> tuple[FloatArray, FloatArray]:  # fmt: skip
    """Linear equations for a step, across the simulated track: along it the nearest place gives way."""
    turn = _turn(motion.turned, local.shape[1])
    along, arm, apart = (
        values[inside] @ turn.T for values in (found.direction, found.foot - path.first, found.foot - local)
    )
    dimensions = local.shape[1]
    columns = [np.broadcast_to(axis, along.shape) for axis in np.eye(dimensions)] if start else []
    if heading:
        swing = np.zeros_like(arm)
        swing[:, 0], swing[:, 1] = -arm[:, 1] / path.length, arm[:, 0] / path.length
        columns.append(swing)
    across = np.stack([_across(column, along).ravel() for column in columns], axis=1)
    return across, -_across(apart, along).ravel()


def _across(vectors: FloatArray, along: FloatArray) -> FloatArray:
    return vectors - (vectors * along).sum(axis=1, keepdims=True) * along


def _least_norm(matrix: FloatArray, rest: FloatArray) -> tuple[FloatArray, int]:
    """The shortest step of least squares, and how many directions it leaves alone."""
    left, values, right = np.linalg.svd(matrix, full_matrices=False)
    kept = values > DETERMINED * math.sqrt(matrix.shape[0])
    return right[kept].T @ ((left.T @ rest)[kept] / values[kept]), int((~kept).sum())


def fitted_time(simulated: Polyline, measured: Polyline) -> float:
    """By how much the simulated track's time is ahead of the measured one's (s): least squares at equal time.

    The mean square distance over the measured track's length is looked at over all times at which at least half of the
    shorter track has a moment in common with the other, then minimised from the best of them.

    Raises
    ------
    FitError
        One of the tracks has no duration.
    """
    shorter = min(simulated.time[-1] - simulated.time[0], measured.time[-1] - measured.time[0])
    if not shorter > 0.0:
        raise FitError("the start time cannot be fitted: one of the tracks has no duration")
    least = simulated.time[0] - measured.time[-1] + LEAST_SHARE * shorter
    most = simulated.time[-1] - measured.time[0] - LEAST_SHARE * shorter
    arc_length = np.linspace(0.0, measured.length, PLACES + 1)
    time, places = np.interp(arc_length, measured.arc_length, measured.time), measured.at_arc_length(arc_length)

    def mean_square(later: float) -> float:
        at = time + later
        common = (at >= simulated.time[0]) & (at <= simulated.time[-1])
        apart = simulated.at_time(at[common]) - places[common]
        return float((apart**2).sum(axis=1).mean()) if common.any() else math.inf

    tried = np.linspace(least, most, _TIMES)
    best = float(tried[int(np.argmin([mean_square(float(later)) for later in tried]))])
    step = (most - least) / (_TIMES - 1)
    bounds = (max(least, best - step), min(most, best + step))
    found = minimize_scalar(mean_square, bounds=bounds, method="bounded", options={"xatol": 1e-9 * max(1.0, shorter)})
    return float(found.x)
