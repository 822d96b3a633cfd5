"""Replay of a run from run.nc, with checks of its numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import numpy as np
from scipy.io import netcdf_file

from .._support.arrays import FloatArray
from .._support.errors import ParameterError, SkisnowError, require_range
from .._support.units import DEGREE
from .._support.user_files.json_text import json_value
from .._support.user_files.text_files import ContentError
from ..geometry.vectors import axes_of
from ..scenario import Plane, read_profile, read_terrain
from ..scenario.keys import SCENARIO_KEYS
from ..scenario.scenario import course_on_slope
from ..scenario.terrain import Slope
from ..ski import Ski, read_ski, ski_named
from ..skier.anthropometry import height_of
from ..track.course import Course, read_course
from .from_run import Setting, assemble_replay, facts_of, moving_boots
from .replay import Replay, ReplayBoots, ReplayTrack

_DAMAGE: Final = (
    TypeError, ValueError, LookupError, AttributeError, ArithmeticError, AssertionError, MemoryError,
    SyntaxError,  # of a damaged name of a type
)  # fmt: skip
_SHORTEST_STEP: Final = 1e-9
"""Time (s) between two moments below which they are damaged."""
RUN_FILE: Final = "run.nc"
_PLAIN: Final = (
    "time", "speed", "heading", "turn_radius", "depth", "station", "bending", "twist", "edge_depth",
    "force_per_length", "normal_force", "attitude", "groove_width", "groove_depth", "groove_residual_depth",
)  # fmt: skip
_VECTORS: Final = ("velocity", "ski", "snow_force", "groove", "groove_left")


def replay_of_file(
    path: str | Path, *, title: str | None = None, ski: Ski | None = None, track: ReplayTrack | None = None
) -> Replay:
    """Replay of a run from its file.

    path: path of run.nc or of its folder.
    title: title for the reader (default: the folder's name).
    ski: ski of the run (default: read from the file that the scenario names).
    track: measured track in the run's axes.
    Raises ParameterError: the file cannot be read or is not a run, or a file that its scenario names is missing.
    """
    path = Path(path)
    path = path / RUN_FILE if path.is_dir() else path
    try:
        with netcdf_file(path, "r", mmap=False) as file:
            content: Any = file  # its attributes are those of the file
            names = (*_VECTORS, "centre") if "centre_x" in content.variables else _VECTORS
            arrays = {name: _values(content, name) for name in _PLAIN}
            arrays |= {name: _vectors(content, f"{name}_{{}}") for name in names} | {"place": _vectors(content, "{}")}
            sections = json_value(content.scenario.decode("utf-8"))
            values = {f"{section}.{key}": value for section, table in sections.items() for key, value in table.items()}
            boots = _boots(content)
            outcome, spacing = content.outcome.decode("utf-8"), float(content.solver_line_spacing_m)
        require_drawable(arrays)
        require_range("solver_line_spacing_m", spacing, 0.0, 1.0, above=True)
        setting = replace(_make_setting(path, values, outcome, spacing, ski), boots=boots)
        return assemble_replay(arrays, setting, title=title or path.resolve().parent.name, track=track)
    except OSError as error:
        raise ParameterError("{path} cannot be read: {error}. Check the path").tag(
            "cannot_read", path=path, error=error.strerror or error
        ) from error
    except (SkisnowError, *_DAMAGE) as error:
        if isinstance(error, SkisnowError) and str(path.parent) in str(error) and not isinstance(error, ContentError):
            raise
        raise ParameterError(
            "{path} is damaged, or it is not a run.nc of skisnow ({error}). Simulate it again with --out"
        ).tag("not_a_run", path=path, error=error) from error


def _boots(file: Any) -> ReplayBoots | None:
    """Moving boots of a run; None if they are fixed."""
    if not getattr(file, "boots", b"").decode("utf-8").startswith("moved"):
        return None
    place, angles = _vectors(file, "boot_{}"), _vectors(file, "boot_{}", ("edge_angle", "pitch", "heading"))
    require_finite({"boots": place, "angles of boots": angles})
    axes = np.array([axes_of(*map(float, row)) for row in angles.reshape(-1, 3)])
    return moving_boots(place, axes.reshape(*angles.shape, 3))


def _vectors(file: Any, pattern: str, names: Sequence[str] = "xyz") -> FloatArray:
    """Vectors (…, 3) from the variables of their components, whose names are the pattern with each of `names`."""
    return np.stack([_values(file, pattern.format(name)) for name in names], axis=-1)


def _values(file: Any, name: str) -> FloatArray:
    """Values of a variable; missing ones, which are turn radii of a straight path, are infinite."""
    variable = file.variables[name]
    values = np.array(variable[:], dtype=float)
    missing = getattr(variable, "_FillValue", None)
    return values if missing is None else np.where(values == missing, np.inf, values)


def _make_setting(path: Path, values: dict[str, Any], outcome: str, spacing: float, ski: Ski | None) -> Setting:
    """Values of a run that do not change over time, from its scenario's values; `ski` replaces the ski they name."""
    slope, file = _read_slope(path, values), scenario_value(values, "ski.file")
    if ski is None:
        ski = ski_named(needed_value(values, "ski.name")) if file is None else read_ski(_locate(path, file))
    has_skier, edge_angle = values.get("skier.steers") is not None, needed_value(values, "sledge.edge_angle_deg")
    mass, inertia = needed_value(values, "sledge.mass_kg"), needed_value(values, "sledge.inertia_kg_m2")
    body = height_of(mass, inertia[0]), mass * needed_value(values, "slope.gravity_m_per_s2")
    return Setting(
        slope=slope,
        course=_course(path, values, slope),
        ski=ski,
        edge_angle=edge_angle * DEGREE,
        stance_width=needed_value(values, "sledge.stance_width_m"),
        centre_of_mass_height=needed_value(values, "sledge.centre_of_mass_height_m"),
        line_spacing=spacing,
        facts=facts_of(
            outcome=outcome,
            hardness=needed_value(values, "snow.H_V_N_per_mm3"),
            stress=scenario_value(values, "snow.S_f_N_per_mm2"),
            ratio=needed_value(values, "snow.unloading_ratio"),
            ski=ski.name,
            edge_angle=None if has_skier else edge_angle,
        ),
        body=body if has_skier else None,
    )


def _read_slope(path: Path, values: dict[str, Any]) -> Slope:
    """Slope of a run file: a plane, a grid or a profile; files are relative to the run's path."""
    kind = needed_value(values, "slope.kind")
    if kind == "plane":
        return Plane(needed_value(values, "slope.angle_deg") * DEGREE)
    if kind == "grid":
        origin = {f"origin_{axis}": scenario_value(values, f"slope.origin_{axis}_m") or 0.0 for axis in "xy"}
        smoothing = scenario_value(values, "slope.smooth_m") or 0.0
        return read_terrain(_locate(path, needed_value(values, "slope.grid")), smoothing=smoothing, **origin)
    profile = _locate(path, needed_value(values, "slope.profile"))
    return read_profile(profile, gap=scenario_value(values, "slope.profile_gap") or "error")


def _course(path: Path, values: dict[str, Any], slope: Slope) -> Course | None:
    """Course in the scenario's axes; None without a course or its file."""
    options = {
        name.partition(".")[2]: scenario_value(values, name) for name in SCENARIO_KEYS if name.startswith("course.")
    }
    name, file = options.pop("name", None), options.pop("file", None)
    if name is None and file is None:
        return None
    try:
        place = name if name is not None else _locate(path, file)
        course = read_course(place, **{key: value for key, value in options.items() if value is not None})
    except ParameterError:
        return None
    return course_on_slope(course, slope)


def _locate(path: Path, named: str) -> Path:
    """Path of a file that the scenario names, from the current folder or that of the run."""
    for place in (Path(named), path.parent / named, path.parent.parent / named):
        if place.is_file():
            return place
    raise ParameterError(
        "{path} was simulated with {file}, which does not exist any more; it is needed to draw the run. Put it into "
        "{folder}"
    ).tag("missing_file", path=path, file=named, folder=path.parent)


LARGEST: Final = 1e9
"""Largest number of a run in SI; its square is finite in single precision."""
SMALLEST_RADIUS: Final = 1e-3
"""Smallest radius of a turn (m)."""
_ORTHOGONAL: Final = 1e-6


def require_drawable(arrays: Mapping[str, FloatArray]) -> None:
    """Raise a ParameterError if a run's arrays, named as in run.nc, cannot be drawn, such as times that do not rise."""
    require_finite(arrays)
    if np.any(np.diff(arrays["time"]) < _SHORTEST_STEP):
        raise ParameterError("time does not rise").tag("not_rising")
    if np.any(np.diff(arrays["station"]) >= 0.0):
        raise ParameterError("station does not fall from tip to tail").tag("not_falling")
    attitude = arrays["attitude"]
    product = attitude @ attitude.swapaxes(-1, -2)
    if attitude.shape[-2:] != (3, 3) or not np.allclose(product, np.eye(3), atol=_ORTHOGONAL):
        raise ParameterError("attitude is not a rotation").tag("not_a_rotation")


def require_finite(arrays: Mapping[str, FloatArray]) -> None:
    """Raise a ParameterError for arrays with numbers that are not finite or too large, or too small turn radii."""
    for name, values in arrays.items():
        # the radius of a straight path is infinite
        sound = np.abs(values) >= SMALLEST_RADIUS if name == "turn_radius" else np.abs(values) <= LARGEST
        if not sound.all():
            place = np.unravel_index(int(np.argmin(sound)), values.shape)
            raise ParameterError("{name} is {value:g} at place {place}").tag(
                "not_finite", name=name, value=values[place], place=[str(index + 1) for index in place]
            )


def scenario_value(values: Mapping[str, Any], name: str) -> Any:
    """Checked value of a run's scenario by its full key; None if the scenario lacks it."""
    value = values.get(name)
    if value is None:
        return None
    return SCENARIO_KEYS[name].in_range(value)


def needed_value(values: Mapping[str, Any], name: str) -> Any:
    """Checked value of a run's scenario by its full key; an error if the scenario lacks it."""
    value = scenario_value(values, name)
    if value is None:
        raise ParameterError("{name} is missing").tag("missing", name=name)
    return value
