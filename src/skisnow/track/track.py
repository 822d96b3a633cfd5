"""Tracks: places at times, with accuracies and quality flags."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from datetime import datetime
from typing import Literal, TypeAlias

import numpy as np

from .._support.arrays import BoolArray, FloatArray
from .._support.display import Facts, Shown, amount, ends
from .._support.errors import ParameterError
from .flags import FLAGS, SolutionArray
from .projection import GeodeticPoint, place_from_origin

Axes: TypeAlias = Literal["file", "east_north_up", "slope"]


@dataclass(frozen=True, eq=False, repr=False)
class Track(Shown):
    """Points in the order of their file; doubtful points stay and are flagged.

    Attributes
    ----------
    name
        Name for messages and figures (default: the name of the file).
    time : (n,) s
        Time from the first point, on the time scale of the file.
    place : (n, 3) m
        Places in the track's frame; NaN for a missing height or place.
    speed : (n,) m/s
        Recorded speed; NaN if missing.
    velocity : (n, 3) m/s or None
        Recorded velocity in the track's frame; NaN if missing (a course over ground has no vertical component).
    place_sd : (n, 3) m or None
        Standard deviation of each coordinate stated by the receiver; NaN if missing.
    speed_sd : (n,) m/s or None
        Standard deviation of the speed stated by the receiver.
    solution : (n,) of "fixed", "float", "code", "", or None
        Kind of solution of each place, see `skisnow.track.flags`; None if unknown.
    odometer : (n,) m or None
        Distance recorded by the device.
    start : datetime or None
        Date and time of the first point, with the zone of the file; None without a date.
    time_scale
        ``"UTC"``, ``"GPS"``, ``"JST"``, ``"local"`` (of the file, without a date or zone).
    frame
        Description of the axes: those of a slope, or the local projection with its origin.
    flags
        Code of each quality flag to (n,) bool: True for flagged points.
    axes
        Meaning of x, y and z: ``"file"`` (local metres of the file), ``"east_north_up"``, or ``"slope"``.
    slope_angle : rad or None
        Inclination of the plane of x and y, if the axes are those of a slope; 0 if z is vertical; None if unknown.
    origin
        Origin of the axes on the ellipsoid; None for local metres.
    first_time : s
        Time of the first point in the file if its times are in seconds, otherwise 0.
    speed_kind
        Description of the speed: along the path, over the ground, or unknown.
    further_columns
        Columns of the file that were not read, by name.
    left_out
        Kind of record to number: records that are not used, such as sentences with a wrong checksum and points before
        the first fix.
    notes
        Sentences on how the file was read.

    See Also
    --------
    skisnow.read_track
    skisnow.track_summary
    """

    name: str
    time: FloatArray
    place: FloatArray
    speed: FloatArray
    time_scale: str
    frame: str
    velocity: FloatArray | None = None
    place_sd: FloatArray | None = None
    speed_sd: FloatArray | None = None
    solution: SolutionArray | None = None
    odometer: FloatArray | None = None
    start: datetime | None = None
    flags: Mapping[str, BoolArray] = field(default_factory=dict)
    axes: Axes = "file"
    slope_angle: float | None = None
    origin: GeodeticPoint | None = None
    first_time: float = 0.0
    speed_kind: str = "as recorded"
    further_columns: tuple[str, ...] = ()
    left_out: Mapping[str, int] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.time)

    def _facts(self) -> Facts:
        flagged = ", ".join(f"{count} {code}" for code, count in self.flagged.items())
        duration = float(self.time[-1] - self.time[0]) if len(self.time) else 0.0
        rows = (
            ("points", f"{len(self)} in {amount(duration, 's')}{f', flagged: {flagged}' if flagged else ''}"),
            *((f"{axis}", ends(self.place[:, k], "m")) for k, axis in enumerate("xyz")),
            ("speed", f"{ends(self.speed, 'm/s')} ({self.speed_kind})"),
            ("start", "no date" if self.start is None else f"{self.start} ({self.time_scale})"),
            ("frame", self.frame),
        )
        return Facts(repr(self.name), rows)

    @property
    def flagged(self) -> dict[str, int]:
        """Number of points with each flag, without flags of no point."""
        return {code: int(np.sum(where)) for code, where in self.flags.items() if np.any(where)}

    def at_origin(self, origin: GeodeticPoint) -> Track:
        """The same track in east, north, up from another origin.

        Velocities and standard deviations stay: the axes of two origins 1 km apart differ by 0.009°.

        Raises
        ------
        ParameterError
            The track is in local metres, and its position on the ellipsoid is unknown.
        """
        if self.axes != "east_north_up" or self.origin is None:
            raise ParameterError(
                "the track {name} is in local metres ({frame}), not in east, north and up from an origin. Read it "
                "from a file with latitude and longitude.",
                code="no_origin",
                name=self.name,
                frame=self.frame,
            )
        frame = self.frame.replace(str(self.origin), str(origin))
        return replace(self, place=place_from_origin(self.place, self.origin, origin), origin=origin, frame=frame)

    @property
    def usable(self) -> BoolArray:
        """(n,) bool: points with a horizontal place and without a flag that excludes."""
        usable = np.asarray(np.isfinite(self.place[:, :2]).all(axis=1))
        for code, where in self.flags.items():
            if code in FLAGS and FLAGS[code].excludes:
                usable &= ~where
        return usable
