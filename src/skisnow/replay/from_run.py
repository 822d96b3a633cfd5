"""Replay of a run in memory."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
import numpy.typing as npt

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.messages import Message, outcome_words
from .._support.units import DEGREE, N_PER_MM2, N_PER_MM3
from ..scenario import Plane, Profile, Terrain
from ..scenario.terrain import Slope
from ..simulation.run import Run
from ..simulation.run_summary import feet_and_tips
from ..ski import Ski
from ..skier.anthropometry import height_of
from ..track.course import Course, MovingPoint, passages
from .replay import (
    Replay,
    ReplayBoots,
    ReplayGroove,
    ReplaySkier,
    ReplaySkis,
    ReplayTerrain,
    ReplayTrack,
    groove_times,
    quaternions,
    rotation_of,
)
from .skier import drawn_joints

_AROUND: Final = 30.0
"""Distance around a run with measured heights (m); beyond it the slope is a plane."""
_STEP: Final = 0.5
"""Minimum distance of the heights (m)."""
_MOST_PLACES: Final = 40_000
"""Maximum number of heights, so that a replay stays below a megabyte."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Setting:
    """Values of a run that do not change over time, and its boots.

    slope, ski: as in the scenario.
    line_spacing: distance of the computed lines of snow along the path (m).
    edge_angle, stance_width, centre_of_mass_height: sizes of the sledge (rad, m, m).
    course: course in the scenario's axes, for its gates.
    body: height (m) and weight (N) of the skier's body; None for a sledge without a skier.
    boots: moving boots (default: fixed on the sledge).
    facts: lines of name and value for the reader.
    """

    slope: Slope
    ski: Ski
    edge_angle: float
    stance_width: float
    centre_of_mass_height: float
    line_spacing: float
    facts: tuple[tuple[str, str], ...]
    course: Course | None = None
    body: tuple[float, float] | None = None
    boots: ReplayBoots | None = None


def replay_of_run(
    run: Run, *, title: str = "A simulated run", track: ReplayTrack | None = None, gates: npt.ArrayLike | None = None
) -> Replay:
    """Build the replay of a simulated run in memory.

    run: result of `skisnow.simulate`.
    title: title for the reader.
    track: measured track in the run's axes.
    gates: x and y of the gates' poles (m), shape (g, 2), alternately red and blue (default: the turning poles of the
        run's course).
    Raises ParameterError: the run has no row of time, or the gates are not pairs of finite numbers.
    """
    setting = _setting_of_run(run)
    replay = assemble_replay(_arrays(run), setting, title=title, track=track)
    return replay if gates is None else replace(replay, gates=_gates(gates, setting.slope), gate_times=None)


def _arrays(run: Run) -> dict[str, FloatArray]:
    """Arrays of a run with the names of run.nc; the components of a vector are one array."""
    skis, groove = run.skis, run.groove
    centre = run.place if run.boots is None else run.boots.centre_of_mass
    return {
        "time": run.time, "place": run.place, "attitude": run.attitude, "speed": run.speed, "heading": run.heading,
        "velocity": run.velocity, "centre": centre,
        "turn_radius": run.turn_radius, "depth": skis.depth, "ski": skis.track, "station": skis.station,
        "bending": skis.bending, "twist": skis.twist, "edge_depth": skis.edge_depth,
        "force_per_length": skis.force_per_length, "snow_force": skis.force, "normal_force": skis.normal_force,
        "groove": groove.middle, "groove_left": groove.left,
        "groove_width": groove.width, "groove_depth": groove.depth, "groove_residual_depth": groove.residual_depth,
    }  # fmt: skip


def _setting_of_run(run: Run) -> Setting:
    """Values of a run that do not change over time, and its boots, None without them."""
    scenario = run.scenario
    contact, sledge = scenario.contact, scenario.sledge
    stress = contact.snow.failure_shear_stress
    facts = facts_of(
        outcome=run.outcome,
        hardness=contact.snow.snow_hardness / N_PER_MM3,
        stress=None if stress is None else stress / N_PER_MM2,
        ratio=contact.unloading_ratio,
        ski=scenario.ski.name,
        edge_angle=None if scenario.skier else sledge.edge_angle / DEGREE,
    )
    return Setting(
        slope=scenario.slope,
        ski=scenario.ski,
        edge_angle=sledge.edge_angle,
        stance_width=sledge.stance_width,
        centre_of_mass_height=sledge.centre_of_mass[1],
        line_spacing=run.numbers["line_spacing_m"],
        facts=facts,
        course=scenario.course,
        body=(height_of(sledge.mass, sledge.inertia[0]), sledge.mass * scenario.gravity) if scenario.skier else None,
        boots=None if run.boots is None or run.boots_by is None else moving_boots(run.boots.place, run.boots.axes),
    )


def facts_of(
    *, outcome: str, hardness: float, stress: float | None, ratio: float, ski: str, edge_angle: float | None
) -> tuple[tuple[str, str], ...]:
    """Names and texts shown with a replay; H_V in N/mm³, S_f in N/mm², edge angle in degrees, None if a skier edges."""
    skis = Message("{ski}, edged by the skier", ski=ski)
    if edge_angle is not None:
        skis = Message("{ski}, edge angle {edge_angle:.3g}°", ski=ski, edge_angle=edge_angle)
    return (
        (Message("Outcome"), outcome_words(outcome)),
        ("H_V", Message("{hardness:.3g} N/mm³", hardness=hardness)),
        ("S_f", Message("not given") if stress is None else Message("{stress:.3g} N/mm²", stress=stress)),
        ("k_u / H_V", Message("{ratio:g}", ratio=ratio)),
        (Message("Skis"), skis),
    )


def assemble_replay(
    arrays: Mapping[str, FloatArray], setting: Setting, *, title: str, track: ReplayTrack | None = None
) -> Replay:
    """Build a replay from a run's setting and arrays, named as in run.nc, but one array for the parts of a vector."""
    if not len(arrays["time"]):
        raise ParameterError("{run} has no moment to show: it ended before it began").tag("no_data", run=title)
    with np.errstate(divide="ignore"):
        curvature = 1.0 / arrays["turn_radius"]
    slope, course = setting.slope, setting.course
    profile = None
    if isinstance(slope, Profile):  # points every 0.25 m
        start, end = slope.ends
        x = np.linspace(start, end, max(2, int(np.ceil((end - start) / 0.25)) + 1))
        profile = np.column_stack([x, slope.heights(x)])
    if track is not None:  # the height of the snow instead of missing heights
        points = np.array(track.place, dtype=float)
        points[:, 2] = np.where(np.isfinite(points[:, 2]), points[:, 2], _heights(slope, points))
        track = replace(track, place=points)
    skier = None
    if setting.body is not None and (boots := setting.boots) is not None:
        height, weight = setting.body
        axes = boots.place, _boot_axes(boots).swapaxes(-1, -2)
        joints = drawn_joints(height, arrays["place"], arrays["attitude"], axes, arrays["centre"])
        skier = ReplaySkier(height=height, weight=weight, joints=joints)
    return Replay(
        title=title,
        facts=setting.facts,
        tilt=slope.angle if isinstance(slope, Plane) else 0.0,
        profile=profile,
        terrain=_terrain(slope, arrays["place"]) if isinstance(slope, Terrain) else None,
        centre_of_mass_height=setting.centre_of_mass_height,
        time=arrays["time"],
        place=arrays["place"],
        attitude=quaternions(arrays["attitude"]),
        speed=arrays["speed"],
        curvature=np.nan_to_num(curvature),
        heading=arrays["heading"],
        depth=arrays["depth"],
        skis=_skis_of_arrays(arrays, setting),
        groove=_groove(arrays, setting.line_spacing),
        track=track,
        gates=None if course is None else _gates([gate.turning for gate in course.gates], slope),
        gate_times=None if course is None or len(arrays["time"]) < 2 else _gate_times(course, arrays, setting),
        skier=skier,
    )


def _gate_times(course: Course, arrays: Mapping[str, FloatArray], setting: Setting) -> FloatArray:
    """Time from the first moment to each gate as in gates.csv (s); NaN for a gate that was not crossed."""
    time, place = arrays["time"], arrays["place"]
    if setting.boots is not None:
        feet, ahead = setting.boots.place, _boot_axes(setting.boots)[..., 0]
    else:
        side = 0.5 * setting.stance_width * arrays["attitude"][:, :, 1]
        feet, ahead = np.stack([place + side, place - side], axis=1), arrays["attitude"][:, None, :, 0]
    tips = feet + float(setting.ski.station[0]) * ahead
    middle = MovingPoint(time, place[:, :2], arrays["velocity"][:, :2])
    result = passages(course, middle, feet_and_tips(time, feet, tips))
    return np.array([np.nan if gate_time is None else gate_time - result.start_time for gate_time in result.times])


def _boot_axes(boots: ReplayBoots) -> FloatArray:
    """Axes of both boots in space at each time, (n, 2, 3, 3): ahead, left and off the base as columns."""
    turns = rotation_of(boots.attitude.reshape(-1, 4))
    return np.asarray(turns.as_matrix().reshape(*boots.attitude.shape[:2], 3, 3))


def _terrain(slope: Terrain, path: FloatArray) -> ReplayTerrain:
    """Grid of heights of a slope around the path (n, 3) of a run, with at most about `_MOST_PLACES` places."""
    surface = slope.surface
    low, high = (path[:, :2].min(axis=0) - _AROUND, path[:, :2].max(axis=0) + _AROUND)
    step = max(_STEP, float(np.sqrt(np.prod(high - low) / _MOST_PLACES)))
    x, y = (low[axis] + step * np.arange(int(np.ceil((high[axis] - low[axis]) / step)) + 1) for axis in (0, 1))
    height = np.array([surface.heights(row_x, y) for row_x in x])
    terms = np.column_stack([np.ones(height.size), np.repeat(x - x.mean(), len(y)), np.tile(y - y.mean(), len(x))])
    plane = np.linalg.lstsq(terms, height.ravel(), rcond=None)[0]
    return ReplayTerrain(x=x, y=y, height=height, grade=(float(plane[1]), float(plane[2])))


def moving_boots(place: FloatArray, axes: FloatArray) -> ReplayBoots:
    """Boots from their places (n, 2, 3) in m and axes (n, 2, 3, 3) as rows: ahead, left across the base, off it."""
    turns = [quaternions(axes[:, boot].swapaxes(-1, -2)) for boot in range(axes.shape[1])]
    return ReplayBoots(place=place, attitude=np.stack(turns, axis=1))


def _gates(places: npt.ArrayLike, slope: Slope) -> FloatArray:
    """Places of the gates' poles on the snow (m), shape (g, 3), from their x and y."""
    points = np.asarray(places, dtype=float)
    if points.ndim != 2 or points.shape[1] != 2 or not np.isfinite(points).all():
        raise ParameterError("gates are pairs of x and y in m; given is an array of shape {shape}").tag(
            "wrong_shape", shape=points.shape
        )
    return np.column_stack([points, _heights(slope, points)])


def _heights(slope: Slope, place: FloatArray) -> FloatArray:
    """Heights (k,) of the snow at places whose first two numbers are x and y (k, 2 or 3)."""
    if isinstance(slope, Terrain):
        return slope.surface.heights(place[:, 0], place[:, 1])
    return np.zeros(len(place)) if isinstance(slope, Plane) else slope.heights(place[:, 0])


def _skis_of_arrays(arrays: Mapping[str, FloatArray], setting: Setting) -> ReplaySkis:
    """Skis of a replay from histories by name, with the ski's shape at their stations."""
    ski, station, side = setting.ski, arrays["station"], setting.stance_width / 2.0
    at = ski.at(np.clip(station, float(ski.station[-1]), float(ski.station[0])))
    histories = ("bending", "twist", "edge_depth", "force_per_length", "normal_force")
    return ReplaySkis(
        station=station,
        half_width=at.width / 2.0,
        base_height=at.base_height,
        middle=np.array([[0.0, side, 0.0], [0.0, -side, 0.0]]),
        edge_angle=setting.edge_angle,
        force=arrays["snow_force"],
        boots=setting.boots,
        **{name: arrays[name] for name in histories},
    )


def _groove(arrays: Mapping[str, FloatArray], spacing: float) -> ReplayGroove:
    """Pieces of groove with the times when a boot passed them, in the order of these times."""
    when, ski = groove_times(arrays["groove"], arrays["time"], arrays["ski"])
    order = np.argsort(when, kind="stable")
    columns = {name: arrays[f"groove_{name}"][order] for name in ("left", "width", "depth", "residual_depth")}
    return ReplayGroove(middle=arrays["groove"][order], time=when[order], ski=ski[order], spacing=spacing, **columns)
