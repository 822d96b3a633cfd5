"""A simulated track held against a measured one: distances by nearest place, at equal arc length, at equal time."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace
from typing import Final, Literal, TypeAlias

import numpy as np

from ..errors import ParameterError
from .alignment import fitted_motion, fitted_time, require_offsets
from .apart import Apart, Numbers, numbers_of
from .nearest_place import Path
from .polyline import Polyline, known_points, polyline_of
from .three_distances import arc_length_apart, nearest_apart, time_apart
from .track import Track

TimeFrom: TypeAlias = Literal["first_point", "clock"]
FARTHEST: Final = 1000.0
"""Tracks that are nowhere nearer to each other (m) are not of one slope."""
MOSTLY: Final = 0.9
"""Share of the measured track below which it is said that not all of it was compared."""
DEFINITIONS: Final = {
    "nearest": "from each place of the measured track to the nearest place of the simulated one, whenever that was "
    "passed; places ahead of the simulated track's ends are left out",
    "arc_length": "between the places that both tracks reach after the same way from their first points, up to the "
    "length of the shorter",
    "time": "between the places where both are at the same time, counted from {origin}, while both are on their way",
}
"""What each distance is between."""
MEANS: Final = (
    "The mean and the root mean square are integrals over the measured track's length, shares are of the whole "
    "measured track's length"
)
_ORIGIN: Final = {"first_point": "each track's first point", "clock": "one clock"}


@dataclass(frozen=True, slots=True, eq=False)
class Distances:
    """One of the three distances.

    Attributes
    ----------
    definition
        In words.
    apart
        The offsets along the measured track; None where there are none.
    numbers
        Largest, mean, rms (m); None where nothing can be compared.
    reason
        Why not.
    """

    definition: str
    apart: Apart | None
    numbers: Numbers | None
    reason: str | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Fitted:
    """What was fitted, by how much the simulated track was moved, and the distances before.

    Attributes
    ----------
    what
        Of start, heading, time.
    moved
        Of its first point (m), (2,) or (3,).
    turned
        About the vertical through its first point (rad), positive to the left.
    later
        How much later (s) the simulated track's places are looked up than before the fit.
    undetermined
        How many directions the tracks do not tell; nothing was moved along them.
    before
        The comparison without the fit.
    """

    what: tuple[str, ...]
    moved: tuple[float, ...]
    turned: float
    later: float
    undetermined: int
    before: Comparison


@dataclass(frozen=True, slots=True, eq=False)
class Comparison:
    """Two tracks held against each other.

    Attributes
    ----------
    simulated, measured
        As they were compared: in two or three dimensions, the simulated one moved where that was fitted.
    names
        Of the simulated and the measured track.
    seen
        In words: in space, or from above and why.
    nearest, arc_length, time
        The three distances.
    largest_from_simulated : m or None
        Largest distance the other way round, from places of the simulated track to the nearest of the measured one;
        much larger than the other where the simulated track makes a detour.
    fitted
        None without a fit.
    warnings
        Sentences.
    """

    simulated: Polyline
    measured: Polyline
    names: tuple[str, str]
    seen: str
    nearest: Distances
    arc_length: Distances
    time: Distances
    largest_from_simulated: float | None
    fitted: Fitted | None = None
    warnings: tuple[str, ...] = ()

    @property
    def dimensions(self) -> int:
        """2: from above, 3: in space."""
        return self.measured.place.shape[1]


def compared(
    simulated: Track,
    measured: Track,
    *,
    fit: Collection[str] = (),
    time_from: TimeFrom | None = None,
    from_above: bool = False,
) -> Comparison:
    """Hold a simulated track against a measured one.

    Parameters
    ----------
    simulated, measured
        In one frame. Points without a place are left out and counted in a warning; marked points take part.
    fit
        Of "start", "heading" and "time": unknown offsets of the simulated track that are fitted. Empty: none.
    time_from
        Where equal time is counted from; None: the clock where both tracks have a date, else each one's first point.
    from_above
        Without the heights, even where both tracks have them. Where one lacks heights it is so anyway.

    Returns
    -------
    Comparison
        Its numbers do not depend on how densely a path of straight pieces is sampled.

    Raises
    ------
    ParameterError
        A track has no two places, the tracks are nowhere within 1 km, or a word is not one of those above.
    FitError
        The offsets cannot be fitted.
    """
    require_offsets(fit)
    if time_from not in (None, "first_point", "clock"):
        raise ParameterError(f"time is counted from first_point or clock, not from {time_from!r}")
    dimensions, seen = _dimensions(simulated, measured, from_above=from_above)
    lines = polyline_of(simulated, dimensions=dimensions), polyline_of(measured, dimensions=dimensions)
    ahead, origin, reason = _clock(simulated, measured, time_from)
    names = (simulated.name, measured.name)
    told = _warnings(simulated, measured, dimensions)
    plain = _held(lines, ahead, origin, reason, names, seen)
    if fit:
        plain = _with_fit(plain, set(fit), ahead, origin, reason)
    _require_near(plain.simulated, plain.measured, names)
    return replace(plain, warnings=(*told, *_short(plain)))


def _dimensions(simulated: Track, measured: Track, *, from_above: bool) -> tuple[int, str]:
    if from_above:
        return 2, "from above, as asked"
    for track in (simulated, measured):
        lacking = int((known_points(track, dimensions=2) & ~known_points(track, dimensions=3)).sum())
        if lacking:
            return 2, f"from above: {lacking} of the {len(track)} points of {track.name} have no height"
    return 3, "in space, heights included"


def _clock(
    simulated: Track, measured: Track, time_from: TimeFrom | None
) -> tuple[float, TimeFrom, str | None]:  # fmt: skip
    """The simulated track's time less the measured one's at one moment (s), what that counts from, or why not."""
    dated = simulated.start is not None and measured.start is not None
    if time_from == "first_point" or (time_from is None and not dated):
        return 0.0, "first_point", None
    if simulated.start is None or measured.start is None:
        return 0.0, "clock", "not both tracks have a date; let time be counted from each one's first point"
    aware = [track.start is not None and track.start.tzinfo is not None for track in (simulated, measured)]
    if simulated.time_scale != measured.time_scale or aware[0] != aware[1]:
        scales = f"{simulated.time_scale} and {measured.time_scale}"
        return 0.0, "clock", f"their clocks are not of one kind ({scales}); let time be counted from the first points"
    return (measured.start - simulated.start).total_seconds(), "clock", None


def _held(
    lines: tuple[Polyline, Polyline], ahead: float, origin: TimeFrom, reason: str | None, names: tuple[str, str],
    seen: str,
) -> Comparison:  # fmt: skip
    simulated, measured = lines
    apart = nearest_apart(Path(simulated.place), measured)
    back = numbers_of(nearest_apart(Path(measured.place), simulated))
    return Comparison(
        simulated=simulated,
        measured=measured,
        names=names,
        seen=seen,
        nearest=_distances(
            "nearest", apart, "all of the measured track lies ahead of the simulated one's ends: nothing is beside it"
        ),
        arc_length=_distances("arc_length", arc_length_apart(simulated, measured), "neither has a length"),
        time=_at_equal_time(simulated, measured, ahead, origin, reason),
        largest_from_simulated=None if back is None else back.max,
    )


def _distances(name: str, apart: Apart | None, otherwise: str, *, origin: TimeFrom = "first_point") -> Distances:
    numbers = None if apart is None else numbers_of(apart)
    definition = DEFINITIONS[name].format(origin=_ORIGIN[origin])
    return Distances(definition, apart, numbers, None if numbers else otherwise)


def _at_equal_time(
    simulated: Polyline, measured: Polyline, ahead: float, origin: TimeFrom, reason: str | None
) -> Distances:
    for line, name in ((simulated, "simulated"), (measured, "measured")):
        if not np.isfinite(line.time).all():
            reason = reason or f"not every point of the {name} track has a time"
        elif (np.diff(line.time) < 0.0).any():
            reason = reason or f"the {name} track's time runs backwards"
    if reason:
        return _distances("time", None, reason, origin=origin)
    apart = time_apart(simulated, measured, later=ahead)
    idle = "the tracks are not on their way at one time" if apart is None else "the measured track stands still then"
    return _distances("time", apart, idle, origin=origin)


def _with_fit(plain: Comparison, fit: set[str], ahead: float, origin: TimeFrom, reason: str | None) -> Comparison:
    simulated, moved, turned, left = plain.simulated, np.zeros(plain.dimensions), 0.0, 0
    if fit & {"start", "heading"}:
        motion = fitted_motion(simulated, plain.measured, start="start" in fit, heading="heading" in fit)
        simulated, moved, turned, left = motion.applied(simulated), motion.moved, motion.turned, motion.undetermined
    later = 0.0
    if "time" in fit:
        later = _fitted_time(simulated, plain, ahead)
        reason = None
    found = _held((simulated, plain.measured), ahead + later, origin, reason, plain.names, plain.seen)
    what = tuple(sorted(fit, key=("start", "heading", "time").index))
    moved_m = tuple(float(value) for value in moved)
    return replace(found, fitted=Fitted(what, moved_m, turned, later, left, plain))


def _fitted_time(simulated: Polyline, plain: Comparison, ahead: float) -> float:
    for line, name in zip((simulated, plain.measured), plain.names, strict=True):
        if not np.isfinite(line.time).all() or (np.diff(line.time) < 0.0).any():
            raise ParameterError(f"{name}: its times are missing or run backwards; leave time out of the fit")
    return fitted_time(simulated, plain.measured) - ahead


def _require_near(simulated: Polyline, measured: Polyline, names: tuple[str, str]) -> None:
    places = measured.at_way(np.linspace(0.0, measured.length, 1001))
    nearest = float(Path(simulated.place).nearest(places).distance.min())
    if nearest > FARTHEST:
        raise ParameterError(
            f"{names[0]} and {names[1]} have nothing in common: they are nowhere nearer than {nearest / 1000.0:.4g} km, "
            f"{FARTHEST / 1000.0:g} km is allowed. Bring both into one frame, or fit start and heading"
        )


def _warnings(simulated: Track, measured: Track, dimensions: int) -> list[str]:
    told = []
    for track in (simulated, measured):
        without = int((~known_points(track, dimensions=dimensions)).sum())
        if without:
            told.append(f"{track.name}: {without} of {len(track)} points have no place and are left out")
        if track.marked:
            marks = ", ".join(f"{count} {code}" for code, count in track.marked.items())
            told.append(f"{track.name}: marked points take part as they are ({marks})")
    if simulated.frame != measured.frame:
        told.append(
            f"the frames are told apart: {simulated.name} in {simulated.frame}, {measured.name} in {measured.frame}; "
            "the coordinates are compared as they stand"
        )
    return told


def _short(found: Comparison) -> list[str]:
    told = []
    for name in ("nearest", "arc_length", "time"):
        numbers = getattr(found, name).numbers
        if numbers is not None and numbers.compared < MOSTLY * found.measured.length:
            told.append(
                f"{name.replace('_', ' ')}: only {numbers.compared:.4g} of the {found.measured.length:.4g} m of the "
                "measured track could be compared"
            )
    return told
