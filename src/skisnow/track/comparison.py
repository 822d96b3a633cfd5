"""A simulated track held against a measured one: distances by nearest place, at equal arc length, at equal time."""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass, replace
from typing import Final, get_args

import numpy as np

from .._support.display import Facts, Shown, amount
from .._support.errors import ParameterError
from .._support.units import DEGREE
from .alignment import OFFSETS, Motion, fitted_motion, require_offsets
from .distances import Apart, Numbers, arc_length_apart, nearest_apart, numbers_of, time_apart
from .known_to import known_to as place_known_to
from .nearest_place import Path
from .polyline import Polyline, compared_points, polyline_of
from .slope_frame import STEEPEST, Laid, lay_for_fit
from .solution import inexact_sentence
from .time_offset import FIRST_POINTS, Clock, TimeFrom, common_clock, fitted_time, lacking_time
from .track import Axes, Track

FARTHEST: Final = 1000.0
"""Tracks that are nowhere nearer to each other (m) are not of one slope."""
_PLACED: Final = frozenset({"start", "heading"})
MOSTLY: Final = 0.9
"""Share of the measured track below which it is said that not all of it was compared."""
UNCERTAIN: Final = 2.0 * DEGREE
"""Half of the 95 % interval of a fitted heading above which a warning says so."""
DEFINITIONS: Final = {
    "nearest": "from each place of the measured track to the nearest place of the simulated one, whenever that was "
    "passed; places ahead of the simulated track's ends are left out",
    "arc_length": "between the places that both tracks reach after the same arc length from their first points, up to "
    "the length of the shorter",
    "time": "between the places where both are at the same time, counted from {origin}, while both are on their way",
}
"""What each distance is between."""
MEANS: Final = (
    "The mean and the root mean square are integrals over the measured track's length, shares are of the whole "
    "measured track's length"
)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Distances(Shown):
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

    def _facts(self) -> Facts:
        return Facts(self.in_words)

    @property
    def in_words(self) -> str:
        """Largest, mean and rms distance, or why there are none."""
        if self.numbers is None:
            return f"none: {self.reason}"
        largest, mean, rms = (amount(each, "m") for each in (self.numbers.max, self.numbers.mean, self.numbers.rms))
        return f"largest {largest}, mean {mean}, rms {rms}"


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Fitted(Shown):
    """What was fitted, by how much the simulated track was moved, and the distances before.

    Attributes
    ----------
    what
        Of start, heading, time.
    moved
        Of its first point (m), (2,) or (3,).
    turned
        About the vertical through its first point (rad), positive to the left.
    turned_error
        Half of the 95 % interval of `turned` (rad); 0 if no heading was fitted, None if `rival` has another heading.
    later
        How much later (s) the simulated track's places are looked up than before the fit.
    undetermined
        How many directions the tracks do not tell; nothing was moved along them.
    rms
        Of the nearest distances that were made least (m); None where the time alone was fitted.
    rival
        Another move that leaves the simulated track about as near; None where there is none.
    before
        The comparison without the fit.
    slope_angle
        Inclination (rad) by which a track was laid on the map before the fit; None if none was.
    azimuth
        Compass direction (rad, clockwise from north) of x of the track in the slope's axes; None without a compass.
    """

    what: tuple[str, ...]
    moved: tuple[float, ...]
    turned: float
    later: float
    undetermined: int
    rms: float | None
    rival: Motion | None
    before: Comparison
    turned_error: float | None = 0.0
    slope_angle: float | None = None
    azimuth: float | None = None

    def _facts(self) -> Facts:
        turned = f"{amount(self.turned / DEGREE, '°')} turned, {amount(self.later, 's')} later"
        return Facts(
            f"{', '.join(self.what)}: moved by {', '.join(amount(each, 'm') for each in self.moved)}, {turned}"
        )


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Comparison(Shown):
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
        Largest distance in the other direction, from places of the simulated track to the nearest of the measured one;
        much larger than the other where the simulated track makes a detour.
    axes
        What the measured track's x and y are.
    fitted
        None without a fit.
    warnings
        Sentences.
    in_one_frame
        Whether the coordinates of the two mean the same; if not, the distances say nothing.
    known_to : m
        How exactly the places of the less exact track are known, see `skisnow.track.known_to`.

    See Also
    --------
    skisnow.compare_tracks
    """

    simulated: Polyline
    measured: Polyline
    names: tuple[str, str]
    seen: str
    nearest: Distances
    arc_length: Distances
    time: Distances
    largest_from_simulated: float | None
    axes: Axes = "file"
    fitted: Fitted | None = None
    warnings: tuple[str, ...] = ()
    in_one_frame: bool = True
    known_to: float = 0.0

    def _facts(self) -> Facts:
        length = amount(self.measured.length, "m")
        rows = (
            ("seen", self.seen),
            ("measured", f"{length} long"),
            ("nearest", self.nearest.in_words),
            ("arc length", self.arc_length.in_words),
            ("time", self.time.in_words),
            ("fitted", "nothing" if self.fitted is None else self.fitted._facts().title),
            ("warnings", str(len(self.warnings))),
        )
        return Facts(f"of {self.names[0]!r} with {self.names[1]!r}", rows)

    @property
    def dimensions(self) -> int:
        """2: from above, 3: in space."""
        return self.measured.place.shape[1]


def compare_tracks(
    simulated: Track,
    measured: Track,
    *,
    fit: Collection[str] = (),
    time_from: TimeFrom | None = None,
    from_above: bool = False,
    known_to: float | None = None,
    slope_angle: float | None = None,
) -> Comparison:
    """Hold a simulated track against a measured one.

    Parameters
    ----------
    simulated, measured
        In one frame; two in degrees are compared from the measured one's origin. Points that `Track.usable` leaves out
        are left out, and counted in a warning.
    fit
        Of "start", "heading" and "time": unknown offsets of the simulated track that are fitted. Empty: none.
    time_from
        Where equal time is counted from. "clock": the dates of the files, or their seconds where neither has a date;
        "first_point": each track's own. None: the clock, but the first points where only one of them has a date.
    from_above
        Without the heights, even where both tracks have them. Where one lacks heights it is so anyway.
    known_to
        How exactly places are known (m), 0 or more; None: `skisnow.track.known_to` says it of each.
    slope_angle : rad
        Inclination of the slope that one track's x and y are on, if start and heading are fitted to a track on a map.
        None: that of the run, else that of the other track's heights.

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

    See Also
    --------
    skisnow.read_track : a measured track.
    skisnow.track_summary : what one track says by itself.

    References
    ----------
    The page docs/methods/track-distances.md.
    """
    require_offsets(fit)
    if time_from not in (None, *get_args(TimeFrom)):
        raise ParameterError(f"time is counted from first_point or clock, not from {time_from!r}")
    if known_to is not None and not (math.isfinite(known_to) and known_to >= 0.0):
        raise ParameterError(f"places are known to 0 m or more, not to {known_to!r}")
    if slope_angle is not None and not 0.0 <= slope_angle <= STEEPEST:
        raise ParameterError(f"slope_angle is {slope_angle!r} rad. Allowed: from 0 to {STEEPEST:.4g}.")
    if simulated.origin is not None and measured.origin is not None and simulated.origin != measured.origin:
        simulated = simulated.at_origin(measured.origin)
    placed, together = set(fit) >= _PLACED, _in_one_frame(simulated, measured)
    laid = lay_for_fit(simulated, measured, slope_angle) if placed else Laid(simulated, measured)
    dimensions, seen = _dimensions(laid, from_above=from_above, known=together or laid.angle is not None)
    lines = polyline_of(laid.simulated, dimensions=dimensions), polyline_of(laid.measured, dimensions=dimensions)
    clock = common_clock(simulated, measured, time_from)
    names = (simulated.name, measured.name)
    warnings = [*_warnings(simulated, measured, dimensions), *laid.warnings]
    if not together and not placed:
        warnings.append(f"{_two_frames(simulated, measured)}; their coordinates are compared as they stand")
    plain = _held(lines, clock, names, seen)
    if fit:
        plain = _with_fit(plain, set(fit), clock)
    _require_near(plain.simulated, plain.measured, names)
    fitted = plain.fitted
    if fitted is not None:
        azimuth = None if together or not placed else _azimuth(fitted, measured)
        fitted = replace(fitted, slope_angle=laid.angle, azimuth=azimuth)
    if not together and fitted is not None and placed:
        warnings.append(f"{_two_frames(simulated, measured)}; {_pointing(fitted, laid, simulated, measured)}")
    return replace(
        plain,
        fitted=fitted,
        axes=measured.axes,
        warnings=(*warnings, *_short(plain), *_rivalled(plain)),
        in_one_frame=together or placed,
        known_to=max(map(place_known_to, (simulated, measured))) if known_to is None else known_to,
    )


def _dimensions(laid: Laid, *, from_above: bool, known: bool) -> tuple[int, str]:
    if from_above:
        return 2, "from above, as asked"
    if not known:
        return 2, "from above: heights in two frames are not the same"
    for track in (laid.simulated, laid.measured):
        usable, flat = int(track.usable.sum()), int((track.usable & ~np.isfinite(track.place[:, 2])).sum())
        if flat:
            return 2, f"from above: {flat} of the {usable} points of {track.name} have no height"
    return 3, "in space, heights included"


def _held(lines: tuple[Polyline, Polyline], clock: Clock, names: tuple[str, str], seen: str) -> Comparison:
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
        time=_at_equal_time(simulated, measured, clock),
        largest_from_simulated=None if back is None else back.max,
    )


def _distances(name: str, apart: Apart | None, otherwise: str, *, origin: str = "") -> Distances:
    numbers = None if apart is None else numbers_of(apart)
    definition = DEFINITIONS[name].format(origin=origin)
    return Distances(definition, apart, numbers, None if numbers else otherwise)


def _at_equal_time(simulated: Polyline, measured: Polyline, clock: Clock) -> Distances:
    reason = clock.reason or lacking_time(simulated, "simulated") or lacking_time(measured, "measured")
    if reason:
        return _distances("time", None, reason, origin=clock.origin)
    apart = time_apart(simulated, measured, later=clock.ahead)
    if apart is None:
        begins = measured.time[0] + clock.ahead - simulated.time[0]
        reason = f"they are not on their way at one time (the measured one begins {begins:.6g} s later); {FIRST_POINTS}"
    return _distances("time", apart, reason or "the measured track stands still while both are on their way",
                      origin=clock.origin)  # fmt: skip


def _with_fit(plain: Comparison, fit: set[str], clock: Clock) -> Comparison:
    simulated, motion = plain.simulated, Motion(np.zeros(plain.dimensions), 0.0)
    if fit & {"start", "heading"}:
        motion = fitted_motion(simulated, plain.measured, start="start" in fit, heading="heading" in fit)
        simulated = motion.applied(simulated)
    later = _fitted_time(simulated, plain) - clock.ahead if "time" in fit else 0.0
    origin = f"{clock.origin}, with the fitted offset" if "time" in fit else clock.origin
    fitted_clock = Clock(clock.ahead + later, origin, None if "time" in fit else clock.reason)
    found = _held((simulated, plain.measured), fitted_clock, plain.names, plain.seen)
    what = tuple(word for word in OFFSETS if word in fit)
    fitted = Fitted(
        what=what,
        moved=tuple(float(value) for value in motion.moved),
        turned=motion.turned,
        later=later,
        undetermined=motion.undetermined,
        rms=motion.rms if math.isfinite(motion.rms) else None,
        rival=motion.rival,
        before=plain,
        turned_error=motion.turned_error,
    )
    return replace(found, fitted=fitted)


def _fitted_time(simulated: Polyline, plain: Comparison) -> float:
    reason = lacking_time(simulated, plain.names[0]) or lacking_time(plain.measured, plain.names[1])
    if reason:
        raise ParameterError(f"{reason}; leave time out of the fit")
    return fitted_time(simulated, plain.measured)


def _require_near(simulated: Polyline, measured: Polyline, names: tuple[str, str]) -> None:
    places = measured.at_arc_length(np.linspace(0.0, measured.length, 1001))
    nearest = float(Path(simulated.place).nearest(places).distance.min())
    if nearest > FARTHEST:
        raise ParameterError(
            f"{names[0]} and {names[1]} have nothing in common: they are nowhere nearer than {nearest / 1000.0:.4g} km "
            f"({FARTHEST / 1000.0:g} km is allowed). Bring both into one frame, or fit start and heading"
        )


def _warnings(simulated: Track, measured: Track, dimensions: int) -> list[str]:
    warnings = []
    for track in (simulated, measured):
        without = int((~compared_points(track, dimensions=dimensions)).sum())
        if without:
            flags = ", ".join(f"{count} {code}" for code, count in track.flagged.items()) or "without a place"
            warnings.append(f"{track.name}: {without} of {len(track)} points are left out; flagged are {flags}")
        inexact = inexact_sentence(track.name, track.solution)
        if inexact:
            warnings.append(inexact)
    return warnings


def _two_frames(simulated: Track, measured: Track) -> str:
    return f"the tracks are not in one frame ({simulated.name}: {simulated.frame}; {measured.name}: {measured.frame})"


def _azimuth(fitted: Fitted, measured: Track) -> float:
    """Compass direction (rad) of x of the track that has no compass."""
    turned = fitted.turned if measured.axes == "east_north_up" else -fitted.turned
    return (0.5 * math.pi - turned) % math.tau


def _pointing(fitted: Fitted, laid: Laid, simulated: Track, measured: Track) -> str:
    """Direction of x of the track in the slope's axes, and the inclination by which it was laid on the map."""
    name = (simulated if measured.axes == "east_north_up" else measured).name
    slope = "from above" if not laid.angle else f"on a slope of {laid.angle / DEGREE:.1f}° ({laid.source})"
    azimuth = (fitted.azimuth or 0.0) / DEGREE
    error = "other directions fit too" if fitted.turned_error is None else f"± {fitted.turned_error / DEGREE:.2g}°"
    return f"laid on the map {slope}, x of {name} points {azimuth:.1f}° from north ({error})"


def _in_one_frame(simulated: Track, measured: Track) -> bool:
    return (simulated.axes == "east_north_up") == (measured.axes == "east_north_up")


def _short(found: Comparison) -> list[str]:
    warnings = []
    for name in ("nearest", "arc_length", "time"):
        numbers = getattr(found, name).numbers
        if numbers is not None and numbers.compared < MOSTLY * found.measured.length:
            warnings.append(
                f"{name.replace('_', ' ')}: only {numbers.compared:.4g} of the {found.measured.length:.4g} m of the "
                "measured track could be compared"
            )
    return warnings


def _rivalled(found: Comparison) -> list[str]:
    """Warnings of a heading that the tracks hardly determine, and of another place at which they are about as near."""
    fitted, warnings = found.fitted, []
    if fitted is None:
        return []
    if fitted.turned_error is not None and fitted.turned_error > UNCERTAIN:
        warnings.append(
            f"the fitted heading is uncertain: ± {fitted.turned_error / DEGREE:.2g}° (95 %). Give the direction in "
            "which the slope falls, or compare a longer stretch"
        )
    if fitted.rival is not None:
        rival = fitted.rival
        other, chosen = (f"{each.turned / DEGREE:.0f}°" for each in (rival, fitted))
        there, here = (" and ".join(f"{each:.1f}" for each in one.moved[:2]) for one in (rival, fitted))
        rms, own = amount(rival.rms, "m"), amount(fitted.rms, "m")
        interval = " The heading has no interval." if fitted.turned_error is None else ""
        warnings.append(
            f"the place of the simulated track is uncertain: moved by {there} m and turned by {other}, instead of "
            f"{here} m and {chosen}, it is about as near (rms {rms} instead of {own}, {100 * rival.share:.0f} % "
            f"compared).{interval} Give the direction in which the slope falls, or compare a longer stretch"
        )
    return warnings
