"""Result of a comparison of two tracks and its JSON; the offset in time between their clocks."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any, Final, Literal, TypeAlias

import numpy as np
from scipy.optimize import minimize_scalar

from .._support.errors import FitError
from .._support.messages import Message
from .._support.units import DEGREE, Facts, Shown, amount
from ..track.track import Axes, Track
from .alignment import LEAST_SHARE, PLACES, Motion
from .distances import DistanceStatistics, OffsetSeries, Polyline

Json = dict[str, Any]
SCHEMA_VERSION: Final = 1
KINDS: Final = ("nearest", "arc_length", "time")
"""The three distances."""
MEANS: Final = (
    "The mean and the root mean square are integrals over the measured track's length, shares are of the whole "
    "measured track's length"
)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Distances(Shown):
    """Distances by one of the three definitions.

    definition: definition in words.
    apart: offsets along the measured track; None if they cannot be computed.
    numbers: largest, mean and rms distance (m); None if nothing can be compared.
    reason: reason for missing numbers.
    """

    definition: str
    apart: OffsetSeries | None
    numbers: DistanceStatistics | None
    reason: Message | None = None

    def _repr_facts(self) -> Facts:
        return Facts(self.in_words)

    @property
    def in_words(self) -> str:
        """Largest, mean and rms distance, or the reason why they are missing."""
        if self.numbers is None:
            return f"none: {self.reason}"
        largest, mean, rms = (amount(value, "m") for value in (self.numbers.max, self.numbers.mean, self.numbers.rms))
        return f"largest {largest}, mean {mean}, rms {rms}"


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class FittedOffsets(Shown):
    """Fitted offsets of the simulated track, and the comparison without them.

    what: Names of the fitted offsets: start, heading, time.
    moved: Displacement (m) of the first point, (2,) or (3,).
    turned: Rotation (rad) about the vertical through the first point, positive to the left.
    turned_error: Half of the 95 % interval of `turned` (rad); 0 if no heading was fitted, None if `rival` has another
        heading.
    later: Fitted change (s) of the simulated track's time relative to the measured one's.
    undetermined: Number of undetermined directions; the track was not moved along them.
    rms: Root mean square (m) of the minimised nearest distances; None if only the time was fitted.
    rival: Another motion that fits nearly as well, or None.
    before: Comparison without the fit.
    slope_angle: Inclination (rad) by which a track was rotated onto the map before the fit; None if it was not.
    azimuth: Compass direction (rad, clockwise from north) of x of the track in the slope's axes, if there is one.
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

    def _repr_facts(self) -> Facts:
        """Title with the fitted offsets: places (m), angle (°) and time (s)."""
        turned = f"{amount(self.turned / DEGREE, '°')} turned, {amount(self.later, 's')} later"
        return Facts(
            f"{', '.join(self.what)}: moved by {', '.join(amount(value, 'm') for value in self.moved)}, {turned}"
        )


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Comparison(Shown):
    """Comparison of two tracks.

    Attributes
    ----------
    simulated, measured
        The compared lines in two or three dimensions, the simulated one after a fitted motion.
    names
        Names of the simulated and the measured track.
    seen
        Description of the dimensions: in space, or from above with the reason.
    nearest, arc_length, time
        The three distances.
    largest_from_simulated : m or None
        Largest distance in the other direction, from places of the simulated track to the nearest of the measured one;
        it is much larger than the other if the simulated track makes a detour.
    axes
        Axes of the measured track.
    fitted
        Fitted offsets; None without a fit.
    warnings
        Sentences.
    in_one_frame
        True if both tracks have the same frame; otherwise the distances are meaningless.
    known_to : m
        Accuracy of the places of the less accurate track.

    See Also
    --------
    skisnow.compare
    """

    simulated: Polyline
    measured: Polyline
    names: tuple[str, str]
    seen: Message
    nearest: Distances
    arc_length: Distances
    time: Distances
    largest_from_simulated: float | None
    axes: Axes = "file"
    fitted: FittedOffsets | None = None
    warnings: tuple[Message, ...] = ()
    in_one_frame: bool = True
    known_to: float = 0.0

    def _repr_facts(self) -> Facts:
        """Title with the names of both tracks, and rows with distances, fitted offsets and warnings."""
        length = amount(self.measured.length, "m")
        rows = (
            ("seen", self.seen),
            ("measured", f"{length} long"),
            ("nearest", self.nearest.in_words),
            ("arc length", self.arc_length.in_words),
            ("time", self.time.in_words),
            ("fitted", "nothing" if self.fitted is None else self.fitted._repr_facts().title),
            ("warnings", str(len(self.warnings))),
        )
        return Facts(f"of {self.names[0]!r} with {self.names[1]!r}", rows)

    @property
    def dimensions(self) -> int:
        """2: from above, 3: in space."""
        return self.measured.place.shape[1]


def comparison_dict(comparison: Comparison) -> Json:
    """JSON of ``skisnow compare --json``: unrounded numbers with their definitions; null with a reason if missing."""
    fitted = comparison.fitted
    return {
        "schema_version": SCHEMA_VERSION,
        **_distances_of_each_kind(comparison),
        "simulated": {"name": comparison.names[0], "length_m": comparison.simulated.length},
        "measured": {"name": comparison.names[1], "length_m": comparison.measured.length},
        "dimensions": comparison.dimensions,
        "seen": comparison.seen,
        "means": MEANS,
        "largest_from_simulated_m": comparison.largest_from_simulated,
        "fitted": None if fitted is None else _fitted_dict(fitted),
        "in_one_frame": comparison.in_one_frame,
        "known_to_m": comparison.known_to,
        "warnings": list(comparison.warnings),
    }


def _distances_of_each_kind(comparison: Comparison) -> Json:
    """JSON of the distances by each definition: maximum, mean and rms in m and as shares of the track's length."""
    length, answer = comparison.measured.length, dict[str, Json]()
    for kind in KINDS:
        distances = getattr(comparison, kind)
        numbers = {} if distances.numbers is None else asdict(distances.numbers)
        metres = {name: numbers.get(name) for name in ("max", "mean", "rms")}
        answer[kind] = {
            **{f"{name}_m": value for name, value in metres.items()},
            **{f"{name}_share": None if value is None else value / length for name, value in metres.items()},
            "max_at_m": numbers.get("max_at"),
            "compared_m": numbers.get("compared", 0.0),
            "compared_share": numbers.get("compared", 0.0) / length,
            "definition": distances.definition,
            "reason": distances.reason,
        }
    return answer


def _fitted_dict(fitted: FittedOffsets) -> Json:
    """JSON of the fitted offsets, the second-best alignment (None without one), and the distances before."""
    rival = fitted.rival
    return {
        "what": list(fitted.what),
        "moved_x_m": fitted.moved[0],
        "moved_y_m": fitted.moved[1],
        "moved_z_m": fitted.moved[2] if len(fitted.moved) > 2 else None,
        "turned_deg": fitted.turned / DEGREE,
        "later_s": fitted.later,
        "turned_error_deg": _degrees(fitted.turned_error),
        "rival": rival and {
            "moved_x_m": float(rival.moved[0]),
            "moved_y_m": float(rival.moved[1]),
            "turned_deg": rival.turned / DEGREE,
            "rms_m": rival.rms,
            "compared_share": rival.share,
        },
        "slope_angle_deg": _degrees(fitted.slope_angle),
        "fall_line_azimuth_deg": _degrees(fitted.azimuth),
        "undetermined": fitted.undetermined,
        "before": _distances_of_each_kind(fitted.before),
    }  # fmt: skip


def _degrees(angle: float | None) -> float | None:
    """Angle (rad) in degrees; None for None."""
    return None if angle is None else angle / DEGREE


TimeFrom: TypeAlias = Literal["first_point", "clock"]


@dataclass(frozen=True, slots=True)
class Clock:
    """Relation of the clocks of two tracks.

    ahead: time of the simulated track minus that of the measured one (s).
    origin: description of the zero of time.
    reason: reason why the tracks have no common clock (default: they have one).
    """

    ahead: float
    origin: str
    reason: Message | None = None


def common_clock(simulated: Track, measured: Track, time_from: TimeFrom | None) -> Clock:
    """Clock for both tracks; `time_from` None: that of the files, or first points if only one has a date."""
    starts = (simulated.start, measured.start)
    first = float(simulated.time[0] - measured.time[0]) if len(simulated) and len(measured) else 0.0
    if time_from == "first_point" or (time_from is None and starts.count(None) == 1):
        return Clock(first, "each track's first point")
    if starts[0] is None and starts[1] is None:
        return Clock(measured.first_time - simulated.first_time, "zero of the seconds in both files")
    if starts[0] is None or starts[1] is None:
        reason = Message(
            "only one of them has a date; let time be counted from each track's first point, or fit the time"
        )
        return Clock(0.0, "one clock", reason)
    if simulated.time_scale != measured.time_scale or (starts[0].tzinfo is None) != (starts[1].tzinfo is None):
        reason = Message(
            "their clocks are not of one kind ({first} and {second}); let time be counted from each track's first "
            "point, or fit the time",
            first=simulated.time_scale,
            second=measured.time_scale,
        )
        return Clock(0.0, "one clock", reason)
    return Clock(first + (starts[1] - starts[0]).total_seconds(), "one clock, by the dates in both files")


def missing_time_reason(line: Polyline, name: str) -> Message | None:
    """Reason why a track has no place at each time, or None if it has."""
    if not np.isfinite(line.time).all():
        return Message("not every point of the {name} track has a time", name=name)
    backwards = bool((np.diff(line.time) < 0.0).any())
    return Message("the {name} track's time runs backwards", name=name) if backwards else None


_TIMES: Final = 401


def fit_time(simulated: Polyline, measured: Polyline) -> float:
    """Time of the simulated track minus that of the measured one (s), by least squares of distances at equal time.

    The mean square distance over the measured track's length is computed for all offsets at which at least half of the
    shorter track overlaps with the other, and then minimised from the best of them.
    """
    shorter = min(simulated.time[-1] - simulated.time[0], measured.time[-1] - measured.time[0])
    if not shorter > 0.0:
        raise FitError("the start time cannot be fitted: one of the tracks has no duration").tag("no_duration")
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
    minimum = minimize_scalar(mean_square, bounds=bounds, method="bounded", options={"xatol": 1e-9 * max(1.0, shorter)})
    return float(minimum.x)
