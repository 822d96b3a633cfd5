"""A run as run.nc (NetCDF-3, CF conventions), as a pandas DataFrame and as an xarray Dataset."""

from __future__ import annotations

import io
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from importlib.metadata import version
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from scipy.io import netcdf_file

from ..._support.arrays import FloatArray
from ..._support.environment import import_extra
from ..._support.messages import Message
from ..._support.staging import write_file
from ...scenario.keys import SCENARIO_KEYS, in_sections, scenario_values
from ...simulation.run import GIVEN, LOST, STORED, Run
from ...simulation.run_tables import track_columns, track_table

if TYPE_CHECKING:
    from pathlib import Path

    from pandas import DataFrame
    from xarray import Dataset

CONVENTIONS: Final = "CF-1.11"
MISSING: Final = 9.969209968386869e36  # fill value of the NetCDF library for missing doubles
SKI_NAMES: Final = ("left", "right")
_LETTERS: Final = 5


def write_run_file(
    run: Run, values: Mapping[str, Any], path: str | Path, *, provenance: Mapping[str, Any] | None = None
) -> None:
    """Write a run as a complete NetCDF-3 file.

    values: keys of the scenario with their values as in summary.json, for the global attribute ``scenario``; the
        attribute ``scenario_keys`` has their meanings and units.
    path: Path of the file; an existing file is replaced.
    provenance: global attribute ``provenance`` as in summary.json (default: the program's version).
    Raises OutputError: the file cannot be written.

    All numbers are SI doubles, angles in radians. A value that is not finite, such as the turn radius of a straight
    path, is missing: ``_FillValue``.
    """
    memory = io.BytesIO()
    file = netcdf_file(memory, "w", version=2)  # 64-bit offsets: long runs pass 2 GB
    _write_attributes(file, run, values, provenance or {"versions": {"skisnow": version("skisnow")}})
    sizes = {TIME: len(run.time), SKI: len(SKI_NAMES), STATION: len(run.skis.station), PIECE: len(run.groove.width)}
    for name, size in (sizes | {"space_axis": 3, "sledge_axis": 3, "letter": _LETTERS}).items():
        file.createDimension(name, size)
    named: Any = file.createVariable("ski_name", "c", (SKI, "letter"))
    named.long_name = b"which ski"
    named[:] = np.array([list(name.ljust(_LETTERS)) for name in SKI_NAMES], dtype="S1")
    for variable in variables_of(run):
        _write_variable(file, variable, run)
    file.flush()
    content = memory.getvalue()
    file.close()
    write_file(path, content)


def _write_attributes(file: Any, run: Run, values: Mapping[str, Any], provenance: Mapping[str, Any]) -> None:
    """Write texts and numbers of a run as attributes of the netCDF file; missing numbers are left out."""
    texts = {
        "Conventions": CONVENTIONS,
        "title": "Simulated run of a sledge on two flexible skis on snow",
        "source": f"skisnow {version('skisnow')}, forward dynamics",
        "outcome": run.outcome,
        "remedy": run.remedy,
        "scenario": json.dumps(values, allow_nan=False, ensure_ascii=False),
        "boots": run.boots_by or "stay where the sledge has them",
        "laws": json.dumps(run.given_laws, ensure_ascii=False),
        "scenario_keys": json.dumps({name: key.described for name, key in SCENARIO_KEYS.items()}, ensure_ascii=False),
        "provenance": json.dumps(provenance, allow_nan=False, ensure_ascii=False),
        "comment": "x down the fall line, y to the left of it, z out of the snow; on a measured profile x is "
        "horizontal and z vertical. Heading 0 is the fall line; heading and turn radius are positive to the left.",
    }
    numbers: dict[str, float | None] = {
        "run_length_m": run.run_length,
        "simulated_s": run.simulated_s,
        "wall_s": run.wall_s,
        "energy_balance_error": run.energy_balance_error,
        **{f"solver_{name}": value for name, value in run.numbers.items()},
    }
    for name, text in texts.items():
        setattr(file, name, text.encode("utf-8"))
    for name, number in numbers.items():
        if number is not None:
            setattr(file, name, np.float64(number))
    for name, count in (("steps", run.steps), ("rejected_steps", run.rejected_steps)):
        setattr(file, name, np.int32(count))


def _write_variable(file: Any, variable: RunVariable, run: Run) -> None:
    """Write a variable of a run with its attributes; values that are not finite are marked as missing."""
    written = file.createVariable(variable.name, "d", variable.dimensions)
    values = np.asarray(variable.values(run), dtype=float)
    written[:] = np.where(np.isfinite(values), values, MISSING)
    coordinates = f"{variable.coordinates} ski_name".strip() if SKI in variable.dimensions else variable.coordinates
    texts = {"units": variable.units, "long_name": variable.meaning, "axis": variable.axis, "coordinates": coordinates}
    if variable.axis == "Z":
        texts["positive"] = "up"
    for name, text in texts.items():
        if text:
            setattr(written, name, text.encode("utf-8"))
    if variable.name not in (TIME, STATION):  # coordinates of a dimension may not be missing
        written._FillValue = np.float64(MISSING)


def run_dataframe(run: Run) -> DataFrame:
    """DataFrame of a run with the rows and columns of track.csv; needs pandas."""
    pandas = import_extra("pandas", extra="pandas", what=Message("A run as a DataFrame"))
    return pandas.DataFrame(track_table(run), columns=list(track_columns(run)))


def run_dataset(run: Run) -> Dataset:
    """Dataset of a run with the variables of run.nc, their units and meanings; needs xarray."""
    xarray = import_extra("xarray", extra="xarray", what=Message("A run as a Dataset"))
    stored = variables_of(run)
    coordinates = {variable.name for variable in stored if (variable.name,) == variable.dimensions}
    variables = {}
    for variable in stored:
        values = np.asarray(variable.values(run), dtype=float)
        finite = np.where(np.isfinite(values), values, np.nan)  # as in run.nc: the radius of a straight path is missing
        attributes = {"units": variable.units, "long_name": variable.meaning}
        variables[variable.name] = variable.dimensions, finite, attributes
    return xarray.Dataset(
        {name: value for name, value in variables.items() if name not in coordinates},
        {name: variables[name] for name in coordinates} | {SKI: list(SKI_NAMES)},
        {
            "source": f"skisnow {version('skisnow')}, forward dynamics",
            "outcome": run.outcome,
            "remedy": run.remedy,
            "scenario": json.dumps(in_sections(scenario_values(run.scenario)), ensure_ascii=False),
        },
    )


TIME, SKI, STATION, PIECE = "time", "ski", "station", "piece"


@dataclass(frozen=True, slots=True)
class RunVariable:
    """One variable of run.nc.

    name, dimensions, units: as in the file; units are SI in the notation of UDUNITS, angles in rad.
    source: attribute of a run, or attribute of one of its parts such as ``skis.depth``, with the array in this unit.
    component: index of the last axis of that array (default: the whole array).
    axis: "T", "X", "Y" or "Z" of a coordinate, otherwise empty.
    coordinates: names of the variables with its place in space.
    """

    name: str
    dimensions: tuple[str, ...]
    units: str
    meaning: str
    source: str
    component: int | None = None
    axis: str = ""
    coordinates: str = ""

    def values(self, run: Run) -> FloatArray:
        """Array of a run; NaN for the boots of a run without boots, 0 for an energy that it does not have."""
        part_name, _, name = self.source.rpartition(".")
        if part_name == "energies":
            return run.energies.get(name, np.zeros(len(run.time)))
        part = getattr(run, part_name) if part_name else run
        if part is None:
            return np.full((len(run.time), len(SKI_NAMES))[: len(self.dimensions)], np.nan)
        values = np.asarray(getattr(part, name))
        return values if self.component is None else values[..., self.component]


_PATH: Final = "x y z"
_EDGE: Final = "ski_x ski_y ski_z"
_GROOVE: Final = "groove_x groove_y groove_z"
_AT_BOOT: Final = (TIME, SKI)
_ALONG_SKI: Final = (TIME, SKI, STATION)


def _vector(
    stem: str, dimensions: tuple[str, ...], units: str, meaning: str, source: str, *,
    names: Sequence[str] = "xyz", **further: str,
) -> list[RunVariable]:  # fmt: skip
    """Variables of run.nc for the components of a vector, named `stem` with each of `names`."""
    return [
        RunVariable(stem.format(name), dimensions, units, meaning.format(name), source, component, **further)
        for component, name in enumerate(names)
    ]


def _scalars(
    stem: str, dimensions: tuple[str, ...], source: str, rows: Sequence[tuple[str, str, str]], coordinates: str = ""
) -> list[RunVariable]:
    """Variables of run.nc for several numbers of one part of a run; `rows`: name, unit and meaning of each."""
    return [
        RunVariable(stem.format(name), dimensions, units, meaning, f"{source}.{name}", coordinates=coordinates)
        for name, units, meaning in rows
    ]


_ENERGIES: Final = {
    "kinetic": "kinetic energy",
    "potential": "potential energy in the field of gravity",
    "elastic_ski": "elastic energy of both skis",
    "elastic_snow": "elastic energy of the snow: of pressure, of the shear at the edges, of friction that sticks",
    "delayed_snow": "energy stored in the delayed depth of the snow under the skis",
    "penetration": "work lost to the grooves in the snow since the start",
    "shear": "work lost to side-slip of the skis since the start",
    "friction": "work lost to glide friction since the start",
    "drag": "work lost to air drag since the start",
    "damping": "work lost to damping of the skis since the start",
    "snow_damping": "work lost to damping and delayed depth of the snow since the start",
    "boots": "work given since the start by what moves the boots",
    "push": "work given since the start by a push on the body",
}
_OWN: Final = ("ahead", "left", "up")

RUN_VARIABLES: Final = (
    RunVariable("time", (TIME,), "s", "time since the start", "time", axis="T"),
    RunVariable("station", (STATION,), "m", "place along the ski from the boot, positive forward, tip to tail",
                "skis.station"),
    *(replace(part, axis=part.name.upper()) for part in _vector(
        "{}", (TIME,), "m", "place of the middle between the boots: {}, of x down the fall line (or horizontal, on a "
        "profile), y left, z up", "place")),
    *_vector("ski_{}", _AT_BOOT, "m", "loaded edge under the boot, on the snow surface: {}", "skis.track"),
    *_vector("groove_{}", (PIECE,), "m", "middle of a piece of groove, on the undisturbed surface: {}",
             "groove.middle"),
    *_vector("velocity_{}", (TIME,), "m s-1", "velocity of the middle between the boots: {}", "velocity",
             coordinates=_PATH),
    RunVariable("speed", (TIME,), "m s-1", "speed of the middle between the boots", "speed", coordinates=_PATH),
    RunVariable("heading", (TIME,), "rad", "heading of the skis from the fall line, positive to the left",
                "heading", coordinates=_PATH),
    RunVariable("turn_radius", (TIME,), "m",
                "path's turn radius, positive to the left; missing where the path is straight", "turn_radius",
                coordinates=_PATH),
    RunVariable("attitude", (TIME, "space_axis", "sledge_axis"), "1",
                "rotation matrix from the sledge's axes (forward, left, up) to those of space (x, y, z)",
                "attitude"),
    RunVariable("depth", _AT_BOOT, "m",
                "depth of the loaded edge under the boot below the undisturbed surface; negative: above it",
                "skis.depth", coordinates=_EDGE),
    *_scalars("{}", _ALONG_SKI, "skis", (
        ("edge_depth", "m", "depth of the edge that is down below the undisturbed surface; negative: above it"),
        ("force_per_length", "N m-1", "normal force of the snow on the ski per length"),
        ("shear_per_length", "N m-1", "force of the snow on the ski across its edge, per length, positive to the left"),
        ("bending", "m", "deflection of the base away from the snow, against the boot"),
        ("twist", "rad", "growth of the edge angle against that at the boot"),
    ), coordinates=_EDGE),
    *_vector("snow_force_{}", _AT_BOOT, "N",
             "total force of the snow on the ski, in space (normal force, shear and friction): {}", "skis.force"),
    RunVariable("total_force", _AT_BOOT, "N", "magnitude of the total force of the snow on the ski",
                "skis.total_force"),
    RunVariable("normal_force", _AT_BOOT, "N", "its part along the snow's normal", "skis.normal_force"),
    *_vector("boot_{}", _AT_BOOT, "m", "middle of the boot's sole at the level of the base: {}", "boots.place"),
    RunVariable("boot_edge_angle", _AT_BOOT, "rad", "of the boot: edge angle, positive: left edge down",
                "boots.angles", 0),
    RunVariable("boot_pitch", _AT_BOOT, "rad", "of the boot: pitch, positive: tip up", "boots.angles", 1),
    RunVariable("boot_heading", _AT_BOOT, "rad", "of the boot: heading, positive to the left", "boots.angles", 2),
    *_vector("boot_force_{}", _AT_BOOT, "N", "force of the ski on its boot, in space: {}", "boots.force"),
    *_vector("boot_force_{}", _AT_BOOT, "N", "force of the ski on its boot, in the boot's axes: {}",
             "boots.own_force", names=_OWN),
    *_vector("boot_moment_{}", _AT_BOOT, "N m", "moment of the ski on its boot, in space: {}", "boots.moment"),
    *_vector("boot_moment_{}", _AT_BOOT, "N m", "moment of the ski on its boot, in the boot's axes: {}",
             "boots.own_moment", names=_OWN),
    *(RunVariable(stem.format(name), (TIME,), "J", _ENERGIES[name], f"energies.{name}")
      for stem, names in (("{}_energy", STORED), ("lost_{}", LOST), ("given_{}", GIVEN)) for name in names),
    *_vector("groove_left_{}", (PIECE,), "1", "unit vector along the piece, to the left: {}", "groove.left",
             coordinates=_GROOVE),
    *_scalars("groove_{}", (PIECE,), "groove", (
        ("width", "m", "width of the piece, across the path"),
        ("depth", "m", "deepest that the snow was pushed"),
        ("residual_depth", "m", "permanent (residual) groove depth"),
    ), coordinates=_GROOVE),
)  # fmt: skip
"""Variables of run.nc except the names of the skis, in the order of the file."""
SKIER_VARIABLES: Final = (
    *_scalars("{}", (TIME,), "balance", (
        ("lean", "rad", "lean of the line from the boots' middle to the centre of mass, positive to the left"),
        ("pressure_lean", "rad",
         "lean of the line from the centre of pressure to the centre of mass, positive to the left"),
        ("balanced_lean", "rad",
         "lean in balance with speed and path radius of the centre of mass, positive to the left"),
        ("rolling_lean", "rad", "the same with what the body's roll and the rise of its centre of mass take"),
        ("angulation", "rad", "mean edge angle of the boots less the lean"),
        ("leg", "m", "length from the boots' middle to the centre of mass"),
        ("pressure", "m", "centre of pressure from the boots' middle, to the left"),
    )),
    RunVariable("load", _AT_BOOT, "N", "force of the ski on its boot along the snow's normal", "balance.load"),
    *_vector("centre_{}", (TIME,), "m", "centre of mass of the body: {}", "boots.centre_of_mass"),
)  # fmt: skip
"""Further variables of a run with a skier."""


def variables_of(run: Run) -> tuple[RunVariable, ...]:
    """Variables of a run's file except the names of the skis."""
    return RUN_VARIABLES if run.scenario.skier is None else (*RUN_VARIABLES, *SKIER_VARIABLES)
