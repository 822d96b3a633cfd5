"""Unknown start and heading between two tracks, fitted by least squares of the nearest distances.

The simulated track is moved as it is: no scaling, no reflection, no bending.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass, replace
from typing import Final, Literal, TypeAlias, get_args

import numpy as np
from scipy.special import stdtrit

from .._support.arrays import BoolArray, FloatArray
from .._support.errors import FitError, ParameterError
from .._support.units import CONFIDENCE, DEGREE
from .distances import EXACTNESS, Polyline, polyline
from .nearest_place import NearestPlaces, Path

Offset: TypeAlias = Literal["start", "heading", "time"]
OFFSETS: Final[tuple[Offset, ...]] = get_args(Offset)
"""Unknown offsets: place of the first point, direction (rotation about the vertical there), time."""
PLACES: Final = 2048
"""Number of equal steps of the measured track in sums of squares, which approximate integrals over its length."""
COARSENING: Final = 8
"""Step between the places used in the first iterations from each start, which makes them faster by this factor."""
LEAST_SHARE: Final = 0.5
"""Smallest share of the places, or of the shorter time, that must be compared, so that a fit cannot separate tracks."""
HEADINGS: Final = 8
"""Number of equally spaced headings with which a search for a heading begins."""
SHIFTS: Final = 17
"""Number of offsets in arc length with which a search begins: the measured track can begin later or end earlier."""
REFINED: Final = 6
"""Number of the best coarse solutions that are refined with all places."""
CHORDS: Final = 64
"""Number of chords of a track for the overlays; noise hardly changes their length."""
REPORTED_RIVAL: Final = 2.0
"""A second solution whose score is within this factor of the best is reported."""
_DIFFERENT: Final = 5.0 * DEGREE
"""Two solutions differ if their headings differ by more, or an end of the track by more than this times its length."""
DETERMINED: Final = 1e-3
"""Smallest singular value of a determined direction, relative to the largest."""
_IMPROVEMENT: Final = 0.995
_ROUNDS: Final = 100
_SETTLED: Final = 1e-10
_ACCEPTED: Final = 1e-5
"""Largest step (relative to the length) of a search that only moves single places over the ends back and forth."""
_OSCILLATION: Final = 10
"""A step that is not shorter than one this many steps before indicates an oscillation."""


@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """Rigid motion of the simulated track onto the measured one.

    moved: (d,) m, displacement of its first point.
    turned: rotation (rad) about the vertical through its first point, positive to the left.
    undetermined: number of undetermined directions, such as along two straight lines; the track is not moved along
        them.
    rms: root mean square of the remaining nearest distances (m); infinite if the steps do not settle.
    share: share of the measured track that is compared.
    turned_error: half of the 95 % interval of `turned` (rad), at most π; 0 if no heading was fitted, None if `rival`
        has another heading.
    rival: the best different solution, if it is about as good.
    """

    moved: FloatArray
    turned: float
    undetermined: int = 0
    rms: float = math.inf
    share: float = 0.0
    turned_error: float | None = 0.0
    rival: Motion | None = None

    def applied(self, line: Polyline) -> Polyline:
        """The line moved by `moved` and rotated by `turned` about its first point; its times stay."""
        start = line.place[0]
        return polyline((line.place - start) @ _turn(self.turned, len(start)).T + start + self.moved, line.time)


def _turn(angle: float, dimensions: int) -> FloatArray:
    """Matrix of the rotation by an angle (rad) in the plane of x and y."""
    matrix = np.eye(dimensions)
    matrix[:2, :2] = [[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]]
    return matrix


def require_offsets(fit: Collection[str]) -> None:
    """Check that all offsets are among `OFFSETS`."""
    wrong = [word for word in fit if word not in OFFSETS]
    if wrong:
        raise ParameterError("{value!r} cannot be fitted as an offset; {allowed} are").tag(
            "unknown_offset", value=wrong[0], allowed=list(OFFSETS)
        )


def fit_motion(simulated: Polyline, measured: Polyline, *, start: bool, heading: bool) -> Motion:
    """Motion that minimises the mean square of the nearest distance over the measured track's length.

    Gauss–Newton steps with new nearest places after each step. Places beyond the ends of the simulated track are
    ignored in a step. The search begins with the unmoved tracks, with overlays at `SHIFTS` offsets in arc length and,
    for a heading, in `HEADINGS` directions. The solution has the lowest `_score`. Solutions in which the tracks run in
    opposite directions are used only if there is no other.
    """
    path = Path(simulated.place)
    places = measured.at_arc_length(np.linspace(0.0, measured.length, PLACES + 1))

    def score(motion: Motion) -> float:
        return _score(motion, measured.length)

    begins = start_motions(simulated, measured, start=start, heading=heading)
    coarse = [_iterate(path, places[::COARSENING], motion, start=start, heading=heading) for motion in begins]
    aligned = [
        motion for motion in coarse if math.isfinite(motion.rms) and _same_direction(path, places[::COARSENING], motion)
    ]
    refined: list[Motion] = []
    for motion in sorted(aligned or coarse, key=score):
        if len(refined) < REFINED and all(_differ(motion, other, simulated) for other in refined):
            refined.append(motion)
    solutions = [_iterate(path, places, motion, start=start, heading=heading) for motion in refined]
    answers = [motion for motion in solutions if math.isfinite(motion.rms)]
    if not answers:
        raise FitError(
            "start and heading cannot be fitted: less than {share:g} % of the measured track then overlaps the "
            "simulated one, or the steps do not converge. Compare the tracks without a fit"
        ).tag("no_alignment", share=100 * LEAST_SHARE)
    answers = [motion for motion in answers if _same_direction(path, places, motion)] or answers
    best = answers[0]
    for motion in answers[1:]:
        if score(motion) < _IMPROVEMENT * score(best):
            best = motion
    if best.undetermined:
        unmoved = _iterate(path, places, coarse[0], start=start, heading=heading)
        if unmoved.rms <= best.rms + EXACTNESS * measured.length and not _differ(unmoved, best, simulated):
            best = unmoved  # nothing is moved along what the tracks do not determine
    others = [motion for motion in answers if _differ(motion, best, simulated)]
    rival = min(others, key=score, default=None)
    error: float | None = _heading_error(path, measured, best, start=start) if heading else 0.0
    if rival is None or score(rival) >= REPORTED_RIVAL * score(best):
        return replace(best, turned_error=error)
    if heading and abs(math.remainder(rival.turned - best.turned, math.tau)) > _DIFFERENT:
        error = None  # the likelihood has several maxima
    return replace(best, turned_error=error, rival=rival)


def _score(motion: Motion, length: float) -> float:
    """Geometric mean distance (m) over the whole measured track; lower is better.

    Places that are not compared count with the length of the track. This is the likelihood of normally distributed
    distances where both tracks run, and of a uniform distribution over the track elsewhere.
    """
    if not math.isfinite(motion.rms):
        return math.inf
    return float((motion.rms + EXACTNESS * length) ** motion.share * length ** (1.0 - motion.share))


def _differ(one: Motion, other: Motion, line: Polyline) -> bool:
    """True if two solutions put the track at different places; undetermined directions are ignored."""
    if abs(math.remainder(one.turned - other.turned, math.tau)) > _DIFFERENT:
        return True
    ends = (motion.applied(line).place[[0, -1]] for motion in (one, other))
    apart = float(np.linalg.norm(np.subtract(*ends), axis=1).max())
    return not (one.undetermined or other.undetermined) and apart > _DIFFERENT * line.length


def _same_direction(path: Path, places: FloatArray, motion: Motion) -> bool:
    """True if both tracks run in the same direction on most of the measured one."""
    local, places_nearby = _nearest_places(path, places, motion)
    step = np.diff(local, axis=0)
    return float(np.sign((step * places_nearby.direction[1:]).sum(axis=1)).mean()) >= 0.0


def start_motions(simulated: Polyline, measured: Polyline, *, start: bool, heading: bool) -> list[Motion]:
    """First guesses of the motion, from which the Gauss–Newton steps of `fit_motion` begin."""
    lines = _chords(simulated), _chords(measured)
    overlap = LEAST_SHARE * min(line.length for line in lines)
    shifts = np.linspace(overlap - lines[1].length, lines[0].length - overlap, SHIFTS).tolist() if start else []
    begins = [Motion(np.zeros(simulated.place.shape[1]), 0.0)]
    begins += [_overlay(lines, start=start, heading=heading, shift=float(shift)) for shift in (0.0, *shifts)]
    if heading:
        angles = np.linspace(0.0, 2.0 * math.pi, HEADINGS, endpoint=False) + begins[1].turned
        begins += [_overlay(lines, start=start, heading=True, turned=float(angle)) for angle in angles[1:]]
    return begins


def _chords(line: Polyline) -> Polyline:
    """Line through places at equal steps of arc length."""
    at = np.linspace(0.0, line.length, CHORDS + 1)
    return polyline(line.at_arc_length(at), np.interp(at, line.arc_length, line.time))


def _overlay(
    lines: tuple[Polyline, Polyline], *, start: bool, heading: bool, turned: float | None = None, shift: float = 0.0
) -> Motion:
    """Motion that minimises the distances of places at equal arc length (Kabsch, about the vertical).

    With an angle (rad), the heading is that angle. The measured track begins ``shift`` (m) after the simulated one.
    """
    first, last = max(0.0, shift), min(lines[0].length, lines[1].length + shift)
    share, origin = np.linspace(first, last, CHORDS + 1), lines[0].place[0]
    own, other = lines[0].at_arc_length(share) - origin, lines[1].at_arc_length(share - shift) - origin
    centre = (own.mean(axis=0), other.mean(axis=0)) if start else (np.zeros_like(origin), np.zeros_like(origin))
    a, b = (own - centre[0])[:, :2], (other - centre[1])[:, :2]
    if turned is None:
        twist = float((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum())
        turned = math.atan2(twist, float((a * b).sum())) if heading else 0.0
    return Motion(centre[1] - _turn(turned, len(origin)) @ centre[0], turned)


def _iterate(path: Path, places: FloatArray, motion: Motion, *, start: bool, heading: bool) -> Motion:
    """Solution from one start, with its rms distance (infinite if the steps do not converge) and share."""
    sizes, pace = [math.inf], 1.0
    for _ in range(_ROUNDS):
        local, nearest = _nearest_places(path, places, motion)
        inside = ~nearest.beyond
        if inside.mean() < LEAST_SHARE:
            return replace(motion, rms=math.inf)  # a beginning may be an answer among fewer places
        matrix, rest = _equations(path, local, nearest, inside, motion, start=start, heading=heading)
        left, values, right = np.linalg.svd(matrix, full_matrices=False)
        determined = values > DETERMINED * math.sqrt(matrix.shape[0])  # the shortest least-squares step
        step = pace * (right[determined].T @ ((left.T @ rest)[determined] / values[determined]))
        moved = step[: places.shape[1]] if start else np.zeros(places.shape[1])
        turned = float(step[-1]) / path.length if heading else 0.0
        motion = Motion(motion.moved + moved, motion.turned + turned, int((~determined).sum()))
        sizes.append(float(np.linalg.norm(step)) / path.length)
        to_and_fro = sizes[-1] >= min(sizes[:-_OSCILLATION], default=math.inf)
        if sizes[-1] < _SETTLED or (sizes[-1] < _ACCEPTED and to_and_fro):
            break
        pace *= 0.5 if to_and_fro else 1.0
    if sizes[-1] > _ACCEPTED:
        return motion
    nearest = _nearest_places(path, places, motion)[1]
    inside = ~nearest.beyond
    rms = math.sqrt(float(np.mean(nearest.distance[inside] ** 2))) if inside.any() else math.inf
    return replace(motion, turned=math.remainder(motion.turned, math.tau), rms=rms, share=float(inside.mean()))


def _nearest_places(path: Path, places: FloatArray, motion: Motion) -> tuple[FloatArray, NearestPlaces]:
    """Measured places in the frame of the unmoved simulated track, and its nearest places."""
    local = (places - path.first - motion.moved) @ _turn(motion.turned, places.shape[1]) + path.first
    return local, path.nearest(local)


def _equations(
    path: Path, local: FloatArray, nearest: NearestPlaces, inside: BoolArray, motion: Motion,
    *, start: bool, heading: bool,
) -> tuple[FloatArray, FloatArray]:  # fmt: skip
    """Matrix and right side of the linear equations for a step; only offsets across the simulated track count."""
    turn = _turn(motion.turned, local.shape[1])
    along, arm, apart = (
        values[inside] @ turn.T for values in (nearest.direction, nearest.foot - path.first, nearest.foot - local)
    )
    dimensions = local.shape[1]
    columns = [np.broadcast_to(axis, along.shape) for axis in np.eye(dimensions)] if start else []
    if heading:
        swing = np.zeros_like(arm)
        swing[:, 0], swing[:, 1] = -arm[:, 1] / path.length, arm[:, 0] / path.length
        columns.append(swing)
    across = np.stack([_across(column, along).ravel() for column in columns], axis=1)
    return across, -_across(apart, along).ravel()


def _heading_error(path: Path, measured: Polyline, motion: Motion, *, start: bool) -> float:
    """Half of the 95 % interval of the heading (rad), at most π, from the errors of the measured points.

    The fit is linear in the errors across the path: turned = Σ gᵢ εᵢ over the points, each weighted by its share of the
    length. With equal variances σ² = Σ r²/(n (d - 1) - parameters) and the correlation ρ of the residuals of
    neighbouring points, the variance is σ² Σ gᵢ² (1 + ρ)/(1 - ρ): that of an autoregressive error whose influence
    changes slowly (Bartlett 1935, doi 10.2307/2342284). The interval uses Student's t.
    """
    local, nearest = _nearest_places(path, measured.place, motion)
    inside = ~nearest.beyond
    matrix, rest = _equations(path, local, nearest, inside, motion, start=start, heading=True)
    dimensions = local.shape[1]
    freedom = int(inside.sum()) * (dimensions - 1) - matrix.shape[1]
    if freedom < 1:
        return math.pi
    steps = np.diff(measured.arc_length, prepend=0.0, append=measured.length)
    root = np.sqrt(np.repeat((steps[1:] + steps[:-1])[inside] / (2.0 * measured.length), dimensions))
    left, values, right = np.linalg.svd(root[:, None] * matrix, full_matrices=False)
    influence = root * (left @ (right[:, -1] / np.maximum(values, EXACTNESS)))
    squares, residuals = float((rest**2).sum()), rest.reshape(-1, dimensions)
    neighbours = float((residuals[1:] * residuals[:-1]).sum()) / squares if squares > 0.0 else 0.0
    correlation = min(max(neighbours, 0.0), 0.95)
    variance = float(rest @ rest) / freedom * float(influence @ influence)
    variance *= (1.0 + correlation) / (1.0 - correlation)
    half = float(stdtrit(freedom, 0.5 + CONFIDENCE / 2.0)) * math.sqrt(variance)
    cut_turns = abs(float(influence @ rest))  # shift of a fit to the points alone: chords cut the turns
    return min((half + cut_turns) / path.length, math.pi)


def _across(vectors: FloatArray, along: FloatArray) -> FloatArray:
    """Parts of vectors (n, d) perpendicular to the unit vectors ``along`` (n, d)."""
    return vectors - (vectors * along).sum(axis=1, keepdims=True) * along
