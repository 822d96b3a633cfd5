"""A replay from a run."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import numpy.typing as npt

from ..errors import ParameterError
from ..scenario import Plane, Terrain
from ..units import DEGREE, N_PER_MM2, N_PER_MM3
from .groove_times import groove_times
from .quaternions import quaternions
from .replay import Replay, ReplayGroove, ReplaySkis, ReplayTrack

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ..scenario import Profile
    from ..simulate.run import Run
    from ..ski import Ski

FloatArray: TypeAlias = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Setting:
    """What a run took place with.

    Attributes
    ----------
    slope, ski
        As in the scenario.
    line_spacing
        Of the snow's lines along the path (m).
    edge_angle, stance_width, centre_of_mass_height
        Of the sledge (rad, m, m).
    facts
        Lines of name and value for the reader.
    """

    slope: Plane | Profile
    ski: Ski
    edge_angle: float
    stance_width: float
    centre_of_mass_height: float
    line_spacing: float
    facts: tuple[tuple[str, str], ...]


def replay_of_run(
    run: Run,
    *,
    title: str = "A simulated run",
    track: ReplayTrack | None = None,
    gates: npt.ArrayLike | None = None,
) -> Replay:
    """The replay of a run.

    Parameters
    ----------
    run
        What `skisnow.simulate` gave.
    title
        What the reader sees.
    track
        A measured track in the run's axes, shown beside.
    gates
        (g, 2) x and y of the poles of gates (m), red and blue by turns; they stand on the snow.

    Raises
    ------
    ParameterError
        The run has not even a first moment, its boots move, the gates are no pairs of finite numbers, or it went over
        a grid, whose surface a replay cannot show.
    """
    require_still(run.boots_by)
    setting = _setting(run)
    found = assembled(_arrays(run), setting, title=title, track=track)
    return found if gates is None else replace(found, gates=_gates(gates, setting.slope))


def require_still(boots_by: str | None) -> None:
    """Refuse a run whose boots move: the replay draws skis where the sledge has them."""
    if boots_by is not None:
        raise ParameterError(
            f"the boots of this run are {boots_by}, and a replay shows skis that stay where the sledge has them. Take "
            "the figures of the report, or the boots' poses in run.nc"
        )


def _arrays(run: Run) -> dict[str, FloatArray]:
    """Under the names of run.nc, vectors in one."""
    skis, groove = run.skis, run.groove
    return {
        "time": run.time, "place": run.place, "attitude": run.attitude, "speed": run.speed, "heading": run.heading,
        "turn_radius": run.turn_radius, "depth": skis.depth, "ski": skis.track, "station": skis.station,
        "bending": skis.bending, "twist": skis.twist, "edge_depth": skis.edge_depth,
        "force_per_length": skis.force_per_length, "groove": groove.middle, "groove_left": groove.left,
        "groove_width": groove.width, "groove_depth": groove.depth, "groove_residual_depth": groove.residual_depth,
    }  # fmt: skip


def _setting(run: Run) -> Setting:
    scenario = run.scenario
    if isinstance(scenario.slope, Terrain):
        raise no_replay_on_grid()
    contact, sledge = scenario.contact, scenario.sledge
    stress = contact.snow.failure_shear_stress
    facts = facts_of(
        outcome=run.outcome,
        hardness=contact.snow.snow_hardness / N_PER_MM3,
        stress=None if stress is None else stress / N_PER_MM2,
        ratio=contact.unloading_ratio,
        ski=scenario.ski.name,
        edge_angle=sledge.edge_angle / DEGREE,
    )
    return Setting(
        slope=scenario.slope,
        ski=scenario.ski,
        edge_angle=sledge.edge_angle,
        stance_width=sledge.stance_width,
        centre_of_mass_height=sledge.centre_of_mass[1],
        line_spacing=run.numbers["line_spacing_m"],
        facts=facts,
    )


def no_replay_on_grid() -> ParameterError:
    """Why a run over a grid has no replay."""
    return ParameterError(
        'a replay shows planes and profiles; this run went over a grid (slope.kind = "grid"). Its track from above, '
        "depths and forces stand in the run's report"
    )


def facts_of(
    *, outcome: str, hardness: float, stress: float | None, ratio: float, ski: str, edge_angle: float
) -> tuple[tuple[str, str], ...]:
    """Lines for the reader; hardness H_V in N/mm³, stress S_f in N/mm², edge angle in degrees."""
    return (
        ("Outcome", outcome.replace("_", " ")),
        ("H_V", f"{hardness:.3g} N/mm³"),
        ("S_f", "not given" if stress is None else f"{stress:.3g} N/mm²"),
        ("k_u / H_V", f"{ratio:g}"),
        ("Skis", f"{ski}, edge angle {edge_angle:.3g}°"),
    )


def assembled(
    arrays: Mapping[str, FloatArray], setting: Setting, *, title: str, track: ReplayTrack | None = None
) -> Replay:
    """A replay from a run's arrays, named as in run.nc with vectors in one, and its setting."""
    if not len(arrays["time"]):
        raise ParameterError(f"{title} has no moment to show: it ended before it began")
    with np.errstate(divide="ignore"):
        curvature = 1.0 / arrays["turn_radius"]
    return Replay(
        title=title,
        facts=setting.facts,
        tilt=setting.slope.angle if isinstance(setting.slope, Plane) else 0.0,
        profile=None if isinstance(setting.slope, Plane) else _profile(setting.slope),
        centre_of_mass_height=setting.centre_of_mass_height,
        time=arrays["time"],
        place=arrays["place"],
        attitude=quaternions(arrays["attitude"]),
        speed=arrays["speed"],
        curvature=np.nan_to_num(curvature),
        heading=arrays["heading"],
        depth=arrays["depth"],
        skis=_skis(arrays, setting),
        groove=_groove(arrays, setting.line_spacing),
        track=None if track is None else _on_the_snow(track, setting.slope),
    )


def _profile(slope: Profile) -> FloatArray:
    """The slope's points, every 0.25 m so that its curve is seen."""
    start, end = slope.ends
    x = np.linspace(start, end, max(2, int(np.ceil((end - start) / 0.25)) + 1))
    return np.column_stack([x, slope.heights(x)])


def _gates(places: npt.ArrayLike, slope: Plane | Profile) -> FloatArray:
    """Feet of poles on the snow."""
    found = np.asarray(places, dtype=float)
    if found.ndim != 2 or found.shape[1] != 2 or not np.isfinite(found).all():
        raise ParameterError(f"gates are pairs of x and y in m; given is an array of shape {found.shape}")
    return np.column_stack([found, _heights(slope, found[:, 0])])


def _heights(slope: Plane | Profile, x: FloatArray) -> FloatArray:
    return np.zeros(len(x)) if isinstance(slope, Plane) else slope.heights(x)


def _on_the_snow(track: ReplayTrack, slope: Plane | Profile) -> ReplayTrack:
    """A height that was not measured is that of the snow."""
    place = np.array(track.place, dtype=float)
    place[:, 2] = np.where(np.isfinite(place[:, 2]), place[:, 2], _heights(slope, place[:, 0]))
    return ReplayTrack(name=track.name, place=place, time=track.time)


def _skis(arrays: Mapping[str, FloatArray], setting: Setting) -> ReplaySkis:
    ski, station = setting.ski, arrays["station"]
    at = ski.at(np.clip(station, float(ski.station[-1]), float(ski.station[0])))
    side = setting.stance_width / 2.0
    return ReplaySkis(
        station=station,
        half_width=at.width / 2.0,
        base_height=at.base_height,
        middle=np.array([[0.0, side, 0.0], [0.0, -side, 0.0]]),
        edge_angle=setting.edge_angle,
        bending=arrays["bending"],
        twist=arrays["twist"],
        edge_depth=arrays["edge_depth"],
        force_per_length=arrays["force_per_length"],
    )


def _groove(arrays: Mapping[str, FloatArray], spacing: float) -> ReplayGroove:
    """Pieces in the order in which they were made."""
    when, ski = groove_times(arrays["groove"], arrays["time"], arrays["ski"])
    order = np.argsort(when, kind="stable")
    return ReplayGroove(
        middle=arrays["groove"][order],
        left=arrays["groove_left"][order],
        width=arrays["groove_width"][order],
        depth=arrays["groove_depth"][order],
        residual_depth=arrays["groove_residual_depth"][order],
        time=when[order],
        ski=ski[order],
        spacing=spacing,
    )
