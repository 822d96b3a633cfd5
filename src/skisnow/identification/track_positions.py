"""Residuals of tracks: where the simulated sledge is at the times that were measured, and how fast."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final, Protocol

import numpy as np
import numpy.typing as npt

from .._support.errors import ParameterError
from .._support.processes.kept_rows import Row
from ..track.solution import inexact_sentence
from ..track.track import Track
from .problem import Fit, Kind, Values, values_of_run
from .simulations import RunTask, limit_of, nudged_tasks

FloatArray = npt.NDArray[np.float64]

NOMINAL_SD: Final = 0.1
"""Standard deviation (m) where none is stated and none can be estimated: it cancels, or only weighs tracks alike."""
LEAST_SD: Final = 1e-3
"""(m): below it a track without noise would be weighed by rounding."""
LONGEST_INTERVAL: Final = 0.3
"""Time (s) between points above which differences show the path and not its noise (assumption: 3 m at 10 m/s)."""
FEWEST_FOR_NOISE: Final = 8
FAR: Final = 20.0
"""A track that begins farther from the start than this (m) and than its own length is of another place (assumption)."""
NEAR: Final = 1.0
"""(m) A track that begins farther off is warned of where its start is not looked for (modelling assumption)."""
_THIRD_DIFFERENCES: Final = math.sqrt(20.0)  # 1 + 9 + 9 + 1
_MEDIAN_OF_NORMAL: Final = 0.6744897501960817
_OUTLIER: Final = 5.0


class Simulate(Protocol):
    """Runs tasks, in their order."""

    def __call__(self, tasks: Sequence[RunTask]) -> list[Row]:
        """Rows of all tasks."""


@dataclass(frozen=True, slots=True, eq=False)
class Measured:
    """The points of a track that are used.

    Attributes
    ----------
    name
        Name of the track.
    time, place, sd
        (m,) s from its first point, (m, 2) m and their standard deviations (m).
    speed, speed_sd
        (m,) m/s along the path, NaN where not recorded with an accuracy, or over the ground alone.
    stated
        Whether all of `sd` is what the receiver states.
    left_out
        How many points are not used.
    inexact
        A warning where not all points are as exact as most.
    """

    name: str
    time: FloatArray
    place: FloatArray
    sd: FloatArray
    speed: FloatArray
    speed_sd: FloatArray
    stated: bool
    left_out: int
    inexact: str | None = None

    @property
    def length(self) -> float:
        """Of the line through the points (m)."""
        return float(np.sum(np.hypot(*np.diff(self.place, axis=0).T)))


def measured(track: Track) -> Measured:
    """The usable points of a track in the slope's frame.

    Raises
    ------
    ParameterError
        There is none.
    """
    use = track.usable
    if not use.any():
        raise ParameterError(f"{track.name} has no point that can be used: {dict(track.flagged) or 'no places'}")
    time, place = track.time[use], track.place[use, :2]
    given = None if track.place_sd is None else track.place_sd[use, :2]
    stated = given is not None and bool(np.all(np.isfinite(given) & (given > 0.0)))
    sd = given if stated and given is not None else np.full_like(place, estimated_noise(time, place))
    speed, speed_sd = np.full(len(time), np.nan), np.full(len(time), np.nan)
    if stated and track.speed_sd is not None:
        along = path_speed(track)[use]
        known = np.isfinite(along) & (track.speed_sd[use] > 0.0)
        speed[known], speed_sd[known] = along[known], track.speed_sd[use][known]
    inexact = None if track.solution is None else inexact_sentence(track.name, track.solution[use])
    return Measured(track.name, time, place, sd, speed, speed_sd, stated, int(np.sum(~use)), inexact)


def path_speed(track: Track) -> FloatArray:
    """Speed along the path (n,): a receiver's speed over the ground lacks the vertical part, its velocity has it."""
    if track.velocity is not None:
        return np.asarray(np.linalg.norm(track.velocity, axis=1))
    return np.full(len(track), np.nan) if "over the ground" in track.speed_kind else track.speed


def estimated_noise(time: FloatArray, place: FloatArray) -> float:
    """Standard deviation (m) of the noise of a track's coordinates, from their third differences.

    Third differences of white noise have √20 times its standard deviation; of a carved path at 10 Hz they are
    millimetres. Their median takes no notice of a few bad points.
    """
    interval = float(np.median(np.diff(time))) if len(time) > 1 else math.inf
    if len(time) < FEWEST_FOR_NOISE or interval > LONGEST_INTERVAL:
        return NOMINAL_SD
    third = np.diff(place, n=3, axis=0)
    return max(float(np.median(np.abs(third))) / _MEDIAN_OF_NORMAL / _THIRD_DIFFERENCES, LEAST_SD)


def first_motion(track: Measured) -> dict[str, float]:
    """Start keys as the first half second of a track shows them."""
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
    """Tracks, and what simulates them.

    Attributes
    ----------
    tracks
        Measured data.
    simulate
        Runs tasks.
    fixed
        Values of keys in every run, such as the snow's numbers where one of them is looked for.
    starts
        Values of ``start.…`` keys by run, where a run has its own.
    scenario_values
        Of the scenario, for a look at whether the run that is found is near the limit of grip; empty: no look.
    """

    tracks: tuple[Measured, ...]
    simulate: Simulate
    fixed: Mapping[str, float] = field(default_factory=dict)
    starts: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    scenario_values: Mapping[str, float] = field(default_factory=dict)

    @property
    def kind(self) -> Kind:
        """Tracks."""
        return "track"

    @property
    def runs(self) -> tuple[str, ...]:
        """Names of the tracks."""
        return tuple(track.name for track in self.tracks)

    def depends_on(self, key: str) -> bool:  # noqa: ARG002 - of one run as of another
        """A run depends on every key."""
        return True

    @property
    def points(self) -> int:
        """Times at which a place was measured."""
        return sum(len(track.time) for track in self.tracks)

    @property
    def nuisances(self) -> int:
        """None."""
        return 0

    @property
    def accuracy_is_stated(self) -> bool:
        """Whether all tracks state theirs."""
        return all(track.stated for track in self.tracks)

    @property
    def series(self) -> tuple[int, ...]:
        """X of each track, y of it, speeds of it."""
        return tuple(
            length
            for track in self.tracks
            for length in (len(track.time), len(track.time), int(np.sum(np.isfinite(track.speed))))
            if length
        )

    def residuals(self, many: Sequence[Values]) -> list[FloatArray | None]:
        """Of the quick runs of a search."""
        return self._residuals(many, final=False)

    def final_residuals(self, many: Sequence[Values]) -> list[FloatArray | None]:
        """Of runs with the scenario's own solver."""
        return self._residuals(many, final=True)

    def fits(self, values: Values) -> tuple[Fit, ...]:
        """x, y and speed over time."""
        found = []
        for track, row in zip(self.tracks, self.simulate(self._tasks(values, final=True)), strict=True):
            if "x_m" not in row:
                continue
            fitted = np.column_stack([row["x_m"], row["y_m"], row["speed_m_per_s"]])
            found.append(
                Fit(
                    name=track.name, kind="track", along=track.time, labels=("x (m)", "y (m)", "speed (m/s)"),
                    measured=np.column_stack([track.place, track.speed]), fitted=fitted,
                    sd=np.column_stack([track.sd, track.speed_sd]),
                )
            )  # fmt: skip
        return tuple(found)

    def warnings(self, values: Values) -> tuple[str, ...]:
        """Points left out, a run that ends early, a track that begins elsewhere, points far off, the limit of grip."""
        found = []
        rows = self.simulate(self._tasks(values, final=True))
        for track, row in zip(self.tracks, rows, strict=True):
            if track.left_out:
                found.append(f"{track.name}: {track.left_out} points are marked as unusable and were left out")
            if track.inexact:
                found.append(track.inexact)
            found += _warned(track, row)
        return (*found, *self._near_limit(values))

    def _near_limit(self, values: Values) -> list[str]:
        """Sentences on runs that are near the limit of grip; Ctrl-C ends the look and keeps what was identified."""
        if not self.scenario_values:
            return []
        tasks = self._tasks(values, final=False)
        nudged = [nudged_tasks(task, self.scenario_values) for task in tasks]
        try:
            own = self.simulate(tasks)
            rows = iter(self.simulate([task for each in nudged for pair in each.values() for task in pair]))
        except KeyboardInterrupt:
            return ["whether the run is near the limit of grip was not looked at: interrupted"]
        found = [{key: [next(rows) for _ in pair] for key, pair in each.items()} for each in nudged]
        return [
            f"{track.name}: {text}"
            for track, first, others in zip(self.tracks, own, found, strict=True)
            for text in limit_of(first, others)
        ]

    def _residuals(self, many: Sequence[Values], *, final: bool) -> list[FloatArray | None]:
        tasks = [self._tasks(values, final=final) for values in many]
        rows = iter(self.simulate([task for each in tasks for task in each]))
        return [_joined([_residual(track, next(rows)) for track in self.tracks]) for _ in many]

    def _tasks(self, values: Values, *, final: bool) -> list[RunTask]:
        return [
            RunTask({**self.fixed, **self.starts.get(track.name, {}), **values_of_run(values, track.name)}, i, final)
            for i, track in enumerate(self.tracks)
        ]


def _joined(parts: Sequence[FloatArray | None]) -> FloatArray | None:
    known = [part for part in parts if part is not None]
    return np.concatenate(known) if len(known) == len(parts) else None


def _residual(track: Measured, row: Row) -> FloatArray | None:
    if "x_m" not in row:
        return None
    place = np.column_stack([row["x_m"], row["y_m"]])
    known = np.isfinite(track.speed)
    speed = (np.array(row["speed_m_per_s"])[known] - track.speed[known]) / track.speed_sd[known]
    away = (place - track.place) / track.sd
    return np.concatenate([away[:, 0], away[:, 1], speed])


def _warned(track: Measured, row: Row) -> list[str]:
    if "x_m" not in row:
        return [f"{track.name}: no run can be simulated with these values: {row.get('reason', '')}"]
    found = []
    if row["outcome"] == "energy_open":
        found.append(
            f"{track.name}: the balance of energy of the simulated run stays open by more than 0.5 %: what was found "
            "rests on a run that is not to be trusted. Take smaller steps, or the error control"
        )
    if row["reached"] < len(track.time):
        found.append(
            f"{track.name}: the simulated run ends early ({row['outcome'].replace('_', ' ')}); "
            f"{len(track.time) - row['reached']} points lie behind its end, where it was taken to go on straight"
        )
    residual = _residual(track, row)
    if residual is not None:
        spread = float(np.median(np.abs(residual))) / _MEDIAN_OF_NORMAL
        far = int(np.sum(np.abs(residual) > _OUTLIER * max(spread, 1e-12)))
        if far:
            found.append(
                f"{track.name}: {far} of {len(residual)} residuals are beyond {_OUTLIER:g} times the usual: bad "
                "points, or a stretch where the model does not hold; look at the figure of residuals"
            )
    return found


def require_near(track: Measured, start: tuple[float, float], *, start_is_free: bool) -> str | None:
    """Refuse a track of another place; a sentence where it begins somewhat off and the start is not looked for.

    Raises
    ------
    ParameterError
        It begins farther from the start than it is long.
    """
    away = math.hypot(track.place[0, 0] - start[0], track.place[0, 1] - start[1])
    if away > max(FAR, track.length):
        raise ParameterError(
            f"{track.name} begins {_distance(away)} from the scenario's start (x = {start[0]:g} m, y = {start[1]:g} m) "
            f"and is {_distance(track.length)} long: it is of another place, or in another frame. Give x down the fall "
            "line and y to the left in m, from the slope's own origin, or set start.x_m and start.y_m"
        )
    if away > NEAR and not start_is_free:
        return (
            f"{track.name} begins {away:.2g} m from the scenario's start, which is not looked for: free start.x_m and "
            "start.y_m, or set them"
        )
    return None


def _distance(metres: float) -> str:
    return f"{metres / 1000.0:.4g} km" if metres >= 10_000.0 else f"{metres:.3g} m"
