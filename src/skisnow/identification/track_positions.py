"""Residuals of tracks: places and speeds of the simulated sledge at the measured times."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.messages import Message, outcome_words, template
from .._support.processes.kept_rows import Row
from ..track.track import Track, inexact_sentence
from .problem import Fit, Kind, Values, run_values
from .simulations import RunTask, grip_limit_sentences

NOMINAL_SD: Final = 0.1
"""Standard deviation (m) if it is not stated and cannot be estimated; it cancels, or gives tracks equal weights."""
LEAST_SD: Final = 1e-3
"""Smallest estimated standard deviation (m), so that rounding does not weight a track without noise."""
LONGEST_INTERVAL: Final = 0.3
"""Longest time (s) between points for an estimate of the noise (assumption: 3 m at 10 m/s show the path instead)."""
FEWEST_FOR_NOISE: Final = 8
FARTHEST_START: Final = 20.0
"""A track is rejected if it begins farther from the start than this distance (m) and than its length."""
NEAR_START: Final = 1.0
"""Distance (m) between track and start above which a warning is given if the start is not free."""
_THIRD_DIFFERENCES: Final = math.sqrt(20.0)  # 1 + 9 + 9 + 1
_MEDIAN_OF_NORMAL: Final = 0.6744897501960817
_OUTLIER: Final = 5.0


@dataclass(frozen=True, slots=True, eq=False)
class TrackPoints:
    """The usable points of a track.

    time, place, sd: times (m,) in s from the first point, places (m, 2) in m, and their standard deviations (m).
    speed, speed_sd: speeds along the path (m,) in m/s; NaN if recorded without accuracy, or only over the ground.
    stated: True if the receiver states all of `sd`.
    left_out: number of points that are not used.
    inexact: warning if some points are less accurate than most (optional).
    """

    name: str
    time: FloatArray
    place: FloatArray
    sd: FloatArray
    speed: FloatArray
    speed_sd: FloatArray
    stated: bool
    left_out: int
    inexact: Message | None = None

    @property
    def length(self) -> float:
        """Length of the line through the points (m)."""
        return float(np.sum(np.hypot(*np.diff(self.place, axis=0).T)))


def track_points(track: Track) -> TrackPoints:
    """Select the usable points of a track in the slope's frame."""
    use = track.usable
    if not use.any():
        without_places = template("{name} has no point that can be used: no places")
        problem = template("{name} has no point that can be used: {flags}") if track.flagged else without_places
        raise ParameterError(problem).tag("no_data", name=track.name, flags=str(dict(track.flagged)))
    time, place = track.time[use], track.place[use, :2]
    stated_sd = None if track.place_sd is None else track.place_sd[use, :2]
    stated = stated_sd is not None and bool(np.all(np.isfinite(stated_sd) & (stated_sd > 0.0)))
    sd = stated_sd if stated and stated_sd is not None else np.full_like(place, estimated_noise(time, place))
    speed, speed_sd = np.full(len(time), np.nan), np.full(len(time), np.nan)
    if stated and track.speed_sd is not None:
        over_ground = track.velocity is None and "over the ground" in track.speed_kind
        along_path = track.speed if track.velocity is None else np.linalg.norm(track.velocity, axis=1)
        path_speeds = np.full(len(time), np.nan) if over_ground else along_path[use]
        usable_speed = np.isfinite(path_speeds) & (track.speed_sd[use] > 0.0)
        speed[usable_speed], speed_sd[usable_speed] = path_speeds[usable_speed], track.speed_sd[use][usable_speed]
    inexact = None if track.solution is None else inexact_sentence(track.name, track.solution[use])
    return TrackPoints(track.name, time, place, sd, speed, speed_sd, stated, int(np.sum(~use)), inexact)


def estimated_noise(time: FloatArray, place: FloatArray) -> float:
    """Standard deviation (m) of the noise of a track's coordinates, estimated from their third differences.

    Third differences of white noise have √20 times its standard deviation; those of a carved path at 10 Hz are a few
    millimetres. Their median is robust against a few bad points.
    """
    interval = float(np.median(np.diff(time))) if len(time) > 1 else math.inf
    if len(time) < FEWEST_FOR_NOISE or interval > LONGEST_INTERVAL:
        return NOMINAL_SD
    third = np.diff(place, n=3, axis=0)
    return max(float(np.median(np.abs(third))) / _MEDIAN_OF_NORMAL / _THIRD_DIFFERENCES, LEAST_SD)


def first_motion(track: TrackPoints) -> dict[str, float]:
    """Values of the start keys, estimated from the first half second of a track."""
    early = track.time <= track.time[0] + max(0.5, float(track.time[min(3, len(track.time) - 1)] - track.time[0]))
    time, place = track.time[early] - track.time[0], track.place[early]
    if len(time) < 2:
        return {}
    slope, first = np.polyfit(time, place, min(1, len(time) - 1))
    velocity = np.asarray(slope)
    return {
        "start.x_m": float(first[0]),
        "start.y_m": float(first[1]),
        "start.speed_m_per_s": float(np.hypot(*velocity)),
        "start.heading_deg": math.degrees(math.atan2(velocity[1], velocity[0])),
    }


@dataclass(slots=True)
class TrackPositions:
    """Measured tracks and their simulation.

    simulate: simulates tasks; returns their rows in order.
    fixed: values of keys in every run, such as both numbers of the snow if one of them is free.
    starts: values of ``start.…`` keys for single runs, by run.
    scenario_values: values of the scenario, used to check whether the result is near the limit of grip (default: no
        check).
    """

    tracks: tuple[TrackPoints, ...]
    simulate: Callable[[Sequence[RunTask]], list[Row]]
    fixed: Mapping[str, float] = field(default_factory=dict)
    starts: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    scenario_values: Mapping[str, float] = field(default_factory=dict)
    kind: Kind = field(default="track", init=False)
    used_keys: tuple[str, ...] | None = field(default=None, init=False)
    points: int = field(init=False)
    nuisances: int = field(default=0, init=False)
    accuracy_is_stated: bool = field(init=False)
    series: tuple[int, ...] = field(init=False)

    def __post_init__(self) -> None:
        self.points = sum(len(track.time) for track in self.tracks)
        self.accuracy_is_stated = all(track.stated for track in self.tracks)
        # x, y and speeds of each track
        of_tracks = ((track.time, track.time, track.speed[np.isfinite(track.speed)]) for track in self.tracks)
        self.series = tuple(len(values) for columns in of_tracks for values in columns if len(values))

    def residuals(self, many: Sequence[Values], *, final: bool = False) -> list[FloatArray | None]:
        """Residuals of the fast runs of a search, or of runs with the scenario's solver."""
        tasks = [self._run_tasks(values, final=final) for values in many]
        rows = iter(self.simulate([task for batch in tasks for task in batch]))
        parts = [[_track_residuals(track, next(rows)) for track in self.tracks] for _ in many]
        computed = [[part for part in of_set if part is not None] for of_set in parts]
        return [np.concatenate(of_set) if len(of_set) == len(self.tracks) else None for of_set in computed]

    def fits(self, values: Values) -> tuple[Fit, ...]:
        """Measured and simulated x, y and speed over time."""
        rows = self.simulate(self._run_tasks(values, final=True))
        return tuple(
            Fit(
                name=track.name, kind="track", along=track.time, labels=("x (m)", "y (m)", "speed (m/s)"),
                measured=np.column_stack([track.place, track.speed]),
                fitted=np.column_stack([row["x_m"], row["y_m"], row["speed_m_per_s"]]),
                sd=np.column_stack([track.sd, track.speed_sd]),
            )
            for track, row in zip(self.tracks, rows, strict=True) if "x_m" in row
        )  # fmt: skip

    def warnings(self, values: Values) -> tuple[Message, ...]:
        """Warnings: unused points, a run that ends early, outliers, a run near the limit of grip."""
        warnings: list[Message] = []
        rows = self.simulate(self._run_tasks(values, final=True))
        for track, row in zip(self.tracks, rows, strict=True):
            if track.left_out:
                warnings.append(
                    Message(
                        "{name}: {points} points are marked as unusable and were left out",
                        name=track.name,
                        points=track.left_out,
                    )
                )
            if track.inexact:
                warnings.append(track.inexact)
            warnings += _result_warnings(track, row)
        return (*warnings, *self._near_limit(values))

    def _near_limit(self, values: Values) -> list[Message]:
        """Warnings of runs near the limit of grip; Ctrl-C ends this check and keeps the identified values."""
        if not self.scenario_values:
            return []
        try:
            return [
                Message("{name}: {text}", name=track.name, text=text)
                for track, task in zip(self.tracks, self._run_tasks(values, final=False), strict=True)
                for text in grip_limit_sentences(task, self.scenario_values, self.simulate)
            ]
        except KeyboardInterrupt:
            return [Message("whether the run is near the limit of grip was not checked: interrupted")]

    def _run_tasks(self, values: Values, *, final: bool) -> list[RunTask]:
        """One task for each track, with its values; `final`: at the accuracy of a final run."""
        return [
            RunTask({**self.fixed, **self.starts.get(track.name, {}), **run_values(values, track.name)}, i, final)
            for i, track in enumerate(self.tracks)
        ]


def _track_residuals(track: TrackPoints, row: Row) -> FloatArray | None:
    """Differences in x, y and speed, divided by their standard deviations; None if no run could be simulated."""
    if "x_m" not in row:
        return None
    place = np.column_stack([row["x_m"], row["y_m"]])
    has_speed = np.isfinite(track.speed)
    speed = (np.array(row["speed_m_per_s"])[has_speed] - track.speed[has_speed]) / track.speed_sd[has_speed]
    away = (place - track.place) / track.sd
    return np.concatenate([away[:, 0], away[:, 1], speed])


def _result_warnings(track: TrackPoints, row: Row) -> Iterator[Message]:
    """Warnings of a failed run, an open energy balance, an early end, and outliers."""
    if "x_m" not in row:
        yield Message(
            "{name}: no run can be simulated with these values: {reason}",
            name=track.name,
            reason=row.get("reason", ""),
        )
        return
    if row["outcome"] == "energy_open":
        yield Message(
            "{name}: the balance of energy of the simulated run stays open by more than 0.5 %: what was found rests on "
            "a run that is not to be trusted. Take smaller steps, or the error control",
            name=track.name,
        )
    if row["reached"] < len(track.time):
        yield Message(
            "{name}: the simulated run ends early ({outcome}); {points} points lie behind its end, where it was taken "
            "to go on straight",
            name=track.name,
            outcome=outcome_words(row["outcome"]),
            points=len(track.time) - row["reached"],
        )
    residual = _track_residuals(track, row)
    if residual is not None:
        spread = float(np.median(np.abs(residual))) / _MEDIAN_OF_NORMAL
        far = int(np.sum(np.abs(residual) > _OUTLIER * max(spread, 1e-12)))
        if far:
            yield Message(
                "{name}: {far} of {count} residuals are beyond {factor:g} times the usual: bad points, or a stretch "
                "where the model does not hold; look at the figure of residuals",
                name=track.name,
                far=far,
                count=len(residual),
                factor=_OUTLIER,
            )


def require_near(track: TrackPoints, start: tuple[float, float], *, start_is_free: bool) -> Message | None:
    """Check the distance between a track's first point and the start; return a warning if the fixed start is off."""
    away = math.hypot(track.place[0, 0] - start[0], track.place[0, 1] - start[1])
    if away > max(FARTHEST_START, track.length):
        distance, length = _distance_text(away), _distance_text(track.length)
        raise ParameterError(
            "{name} begins {distance} from the scenario's start (x = {start_x:g} m, y = {start_y:g} m) and is "
            "{length} long: it is of another place, or in another frame. Give x down the fall line and y to the left "
            "in m, from the slope's own origin, or set start.x_m and start.y_m"
        ).tag("other_place", name=track.name, distance=distance, start_x=start[0], start_y=start[1], length=length)
    if away > NEAR_START and not start_is_free:
        return Message(
            "{name} begins {distance:.2g} m from the scenario's start, which is not free. Free start.x_m and "
            "start.y_m, or set them",
            name=track.name,
            distance=away,
        )
    return None


def _distance_text(metres: float) -> Message:
    """Distance (m) as a text in m, or in km from 10 km."""
    if metres >= 10_000.0:
        return Message("{distance:.4g} km", distance=metres / 1000.0)
    return Message("{distance:.3g} m", distance=metres)
