"""A replay from run.nc, the file that a simulated run leaves."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeAlias

import numpy as np
import numpy.typing as npt
from scipy.io import netcdf_file

from ..errors import ParameterError, SkisnowError
from ..given import GivenError, json_value
from ..scenario import Plane, Profile, read_profile
from ..ski import read_ski, ski_named
from ..units import DEGREE
from .of_run import Setting, assembled, facts_of, no_replay_on_grid, require_still

if TYPE_CHECKING:
    from ..ski import Ski
    from .replay import Replay, ReplayTrack

FloatArray: TypeAlias = npt.NDArray[np.float64]

_DAMAGE: Final = (TypeError, ValueError, LookupError, AttributeError, ArithmeticError, AssertionError, MemoryError)
RUN_FILE: Final = "run.nc"
_PLAIN: Final = (
    "time", "speed", "heading", "turn_radius", "depth", "station", "bending", "twist", "edge_depth",
    "force_per_length", "attitude", "groove_width", "groove_depth", "groove_residual_depth",
)  # fmt: skip
_VECTORS: Final = {"place": "{}", "ski": "ski_{}", "groove": "groove_{}", "groove_left": "groove_left_{}"}


def replay_of_file(
    path: str | Path, *, title: str | None = None, ski: Ski | None = None, track: ReplayTrack | None = None
) -> Replay:
    """The replay of a run that was written.

    Parameters
    ----------
    path
        Of run.nc, or of the folder that it lies in.
    title
        What the reader sees; left out: the folder's name.
    ski
        The skis' shape; left out, it is read from where the scenario says.
    track
        A measured track in the run's axes, shown beside.

    Raises
    ------
    ParameterError
        The file cannot be read or is no run, or a ski or profile that its scenario names is not there any more.
    """
    path = Path(path)
    path = path / RUN_FILE if path.is_dir() else path
    try:
        with netcdf_file(path, "r", mmap=False) as file:
            content: Any = file  # its attributes are those of the file
            arrays, values = _arrays(content), _scenario(content)
            boots = getattr(content, "boots", b"").decode("utf-8")
            require_still(boots if boots.startswith("moved") else None)
            outcome, spacing = content.outcome.decode("utf-8"), float(content.solver_line_spacing_m)
        setting = _setting(path, values, outcome, spacing, ski)
        return assembled(arrays, setting, title=title or path.resolve().parent.name, track=track)
    except GivenError as error:
        raise ParameterError(f"{path} is no run.nc of skisnow: {error} Simulate it again with --out") from error
    except SkisnowError:
        raise
    except OSError as error:
        raise ParameterError(f"{path} cannot be read: {error.strerror or error}. Check the path") from error
    except _DAMAGE as error:
        raise ParameterError(f"{path} is no run.nc of skisnow ({error}). Simulate it again with --out") from error


def _arrays(file: Any) -> dict[str, FloatArray]:
    plain = {name: _values(file, name) for name in _PLAIN}
    vectors = {
        name: np.stack([_values(file, pattern.format(axis)) for axis in "xyz"], axis=-1)
        for name, pattern in _VECTORS.items()
    }
    return plain | vectors


def _scenario(file: Any) -> dict[str, Any]:
    """Its values under full names."""
    sections = json_value(file.scenario.decode("utf-8"))
    return {f"{section}.{key}": value for section, table in sections.items() for key, value in table.items()}


def _values(file: Any, name: str) -> FloatArray:
    """What is missing is infinite: only the turn radius of a straight path is."""
    variable = file.variables[name]
    values = np.array(variable[:], dtype=float)
    missing = getattr(variable, "_FillValue", None)
    return values if missing is None else np.where(values == missing, np.inf, values)


def _setting(path: Path, values: dict[str, Any], outcome: str, spacing: float, ski: Ski | None) -> Setting:
    ski = ski or _ski(path, values)
    edge_angle = values["sledge.edge_angle_deg"]
    return Setting(
        slope=_slope(path, values),
        ski=ski,
        edge_angle=edge_angle * DEGREE,
        stance_width=values["sledge.stance_width_m"],
        centre_of_mass_height=values["sledge.centre_of_mass_height_m"],
        line_spacing=spacing,
        facts=facts_of(
            outcome=outcome,
            hardness=values["snow.H_V_N_per_mm3"],
            stress=values["snow.S_f_N_per_mm2"],
            ratio=values["snow.unloading_ratio"],
            ski=ski.name,
            edge_angle=edge_angle,
        ),
    )


def _ski(path: Path, values: dict[str, Any]) -> Ski:
    if values.get("ski.file") is None:
        return ski_named(values["ski.name"])
    return read_ski(_found(path, values["ski.file"], "ski"))


def _slope(path: Path, values: dict[str, Any]) -> Plane | Profile:
    if values["slope.kind"] == "plane":
        return Plane(values["slope.angle_deg"] * DEGREE)
    if values["slope.kind"] == "grid":
        raise no_replay_on_grid()
    return read_profile(_found(path, values["slope.profile"], "profile"), gap=values["slope.profile_gap"] or "error")


def _found(path: Path, named: str, what: str) -> Path:
    """A file as the scenario names it, from the current folder or from the run's."""
    for place in (Path(named), path.parent / named, path.parent.parent / named):
        if place.is_file():
            return place
    raise ParameterError(
        f"{path} was simulated with the {what} of {named}, which is not there any more; its shape is needed to draw "
        f"the run. Put it into {path.parent}"
    )
