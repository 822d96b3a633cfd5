"""What a replay shows: a run's motion, its skis' shape and load, the groove and the slope, as plain arrays."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, TypeAlias

import numpy as np
import numpy.typing as npt

from .._support.errors import ParameterError

if TYPE_CHECKING:
    from ..track.track import Track

FloatArray: TypeAlias = npt.NDArray[np.float64]

FEWEST_POINTS: Final = 2
SKI_NAMES: Final = ("left", "right")


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ReplayBoots:
    """Boots that move against the sledge: place (n, 2, 3) in space (m), and (n, 2, 4) unit quaternion w, x, y, z.

    The quaternion turns x ahead, y left across the base and z off it into space.
    """

    place: FloatArray
    attitude: FloatArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ReplaySkier:
    """A skier in place of a sledge: the body's height (m), and its joints as they are drawn.

    `joints` is (n, 17, 3) from the middle between the boots in the body's own axes (m), in the order of
    `skisnow.replay.skier.JOINTS`.
    """

    height: float
    joints: FloatArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ReplayTerrain:
    """A slope of measured heights around a run.

    Attributes
    ----------
    x, y
        (p,) and (q,) evenly rising places (m).
    height
        (p, q) of the snow there (m), straight between.
    grade
        Mean dz/dx and dz/dy: beyond the places the snow is drawn going on so.
    """

    x: FloatArray
    y: FloatArray
    height: FloatArray
    grade: tuple[float, float]

    def heights(self, x: npt.ArrayLike, y: npt.ArrayLike) -> FloatArray:
        """Heights (m) of the drawn snow at places x, y (m)."""
        (u, i, within_x), (v, j, within_y) = _cell(self.x, x), _cell(self.y, y)
        below, above = ((1.0 - v) * self.height[k, j] + v * self.height[k, j + 1] for k in (i, i + 1))
        near = (1.0 - u) * below + u * above
        beyond_x, beyond_y = np.asarray(x, dtype=float) - within_x, np.asarray(y, dtype=float) - within_y
        return np.asarray(near + self.grade[0] * beyond_x + self.grade[1] * beyond_y)


def _cell(places: FloatArray, at: npt.ArrayLike) -> tuple[FloatArray, npt.NDArray[np.int64], FloatArray]:
    """Share of the way to the next place, number of the place, and where one is, held within the ends."""
    within = np.clip(np.asarray(at, dtype=float), places[0], places[-1])
    number = np.clip(np.searchsorted(places, within, side="right") - 1, 0, len(places) - 2)
    share = (within - places[number]) / (places[number + 1] - places[number])
    return share, number, within


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ReplaySkis:
    """Two equal skis on a sledge; station (m) tip to tail, index of histories: time, ski (0 left, 1 right), station.

    Attributes
    ----------
    station, half_width, base_height
        (m,) from the boot, half from edge to edge, height of the unloaded base above that at the boot (m).
    middle
        (2, 3) of each ski's boot in the sledge's frame (m).
    edge_angle
        Of both against the sledge, positive: left edge down (rad).
    bending, twist
        (n, 2, m) deflection of the base away from the snow (m), growth of the edge angle (rad), against the boot.
    edge_depth
        (n, 2, m) of the edge that is down below the undisturbed surface; negative: above it (m).
    force_per_length
        (n, 2, m) normal force of the snow per length (N/m).
    force
        (n, 2, 3) total force of the snow in space: normal force, shear and friction (N).
    normal_force
        (n, 2) part of it along the snow's normal (N).
    boots
        Where they move, they say where the skis are; None: middle and edge angle do.
    """

    station: FloatArray
    half_width: FloatArray
    base_height: FloatArray
    middle: FloatArray
    edge_angle: float
    bending: FloatArray
    twist: FloatArray
    edge_depth: FloatArray
    force_per_length: FloatArray
    force: FloatArray
    normal_force: FloatArray
    boots: ReplayBoots | None = None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ReplayGroove:
    """Pieces of groove, each a short line across the path.

    Attributes
    ----------
    middle, left
        (k, 3) on the undisturbed surface (m), and the unit vector along the piece to the left.
    width, depth, residual_depth
        (k,) across, deepest that the snow was pushed, depth that stays (m).
    time
        (k,) when the boot passed it (s): the boot carries the load and cuts deepest.
    ski
        (k,) which one made it: 0 left, 1 right.
    spacing
        Between pieces along the path (m): as far as each one reaches.
    """

    middle: FloatArray
    left: FloatArray
    width: FloatArray
    depth: FloatArray
    residual_depth: FloatArray
    time: FloatArray
    ski: npt.NDArray[np.int64]
    spacing: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ReplayTrack:
    """A measured track in the run's axes: name, place (t, 3) in m, time (t,) in s on the run's clock or None."""

    name: str
    place: FloatArray
    time: FloatArray | None = None


def measured_track(track: Track, *, starts_at: float = 0.0) -> ReplayTrack:
    """A measured track to stand beside a run; points without a place are left out.

    Parameters
    ----------
    track
        In the run's axes: x down the fall line, y left, z out of the snow.
    starts_at
        Time of the run (s) at its first point.

    Raises
    ------
    ParameterError
        Its axes are east, north and up, or fewer than two of its points have a place.
    """
    if track.axes == "east_north_up":
        raise ParameterError(
            f"{track.name} is in east, north and up; a run is in the axes of the slope. Turn it with slope_frame first"
        )
    placed = np.isfinite(track.place[:, :2]).all(axis=1)
    if placed.sum() < FEWEST_POINTS:
        raise ParameterError(f"{track.name} has {placed.sum()} points with a place; a line needs {FEWEST_POINTS}")
    return ReplayTrack(name=track.name, place=track.place[placed], time=track.time[placed] + starts_at)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Replay:
    """A run as it is shown. SI, radians.

    Attributes
    ----------
    title, facts
        In words: what it is, and lines of name and value for the reader.
    tilt
        Angle of the shown plane's x axis below the horizontal (rad): a plane's inclination; 0 on a profile and a
        terrain, whose axes are horizontal and vertical.
    profile
        (p, 2) distance and height of a measured slope (m), or None.
    terrain
        Measured heights over the place, or None; without it and a profile the slope is the plane z = 0.
    centre_of_mass_height
        Above the bases (m).
    time
        (n,) (s).
    place, attitude
        (n, 3) of the middle between the boots (m), (n, 4) unit quaternion w, x, y, z from the sledge's frame to space.
    speed, curvature, heading
        (n,) in m/s; 1/turn radius, positive left (1/m); from the fall line, positive left (rad).
    depth
        (n, 2) of the loaded edge under the boot below the undisturbed surface (m).
    skis, groove
        Their shape and load, and what they left.
    track
        A measured one beside, or None.
    gates
        (g, 3) feet of the poles of gates on the snow (m), one gate after the other, or None.
    gate_times
        (g,) from the run's first moment to each of them (s), NaN where its line was not crossed; None: not known.
    skier
        Where the run has one, or None.
    """

    title: str
    facts: tuple[tuple[str, str], ...]
    tilt: float
    profile: FloatArray | None
    centre_of_mass_height: float
    time: FloatArray
    place: FloatArray
    attitude: FloatArray
    speed: FloatArray
    curvature: FloatArray
    heading: FloatArray
    depth: FloatArray
    skis: ReplaySkis
    groove: ReplayGroove
    track: ReplayTrack | None = None
    gates: FloatArray | None = None
    gate_times: FloatArray | None = None
    terrain: ReplayTerrain | None = None
    skier: ReplaySkier | None = None
