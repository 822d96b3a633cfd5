"""A run as run.nc (NetCDF-3, CF conventions), as a pandas DataFrame and as an xarray Dataset."""

from __future__ import annotations

import io
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib.metadata import version
from typing import TYPE_CHECKING, Any, Final, TypeAlias

import numpy as np
import numpy.typing as npt
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
MISSING: Final = 9.969209968386869e36
"""Fill value of the NetCDF library for missing doubles."""
SKI_NAMES: Final = ("left", "right")
_LETTERS: Final = 5


def write_run_file(
    run: Run, values: Mapping[str, Any], path: str | Path, *, provenance: Mapping[str, Any] | None = None
) -> None:
    """Write a run as a complete NetCDF-3 file.

    run: result of `skisnow.simulate`.
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
    _write_ski_names(file)
    for variable in variables_of(run):
        _write_variable(file, variable, run)
    file.flush()
    content = memory.getvalue()
    file.close()
    write_file(path, content)


def _write_attributes(file: Any, run: Run, values: Mapping[str, Any], provenance: Mapping[str, Any]) -> None:
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


def _write_ski_names(file: Any) -> None:
    """Write the labels "left" and "right" of the dimension of skis."""
    variable = file.createVariable("ski_name", "c", (SKI, "letter"))
    variable.long_name = b"which ski"
    variable[:] = np.array([list(name.ljust(_LETTERS)) for name in SKI_NAMES], dtype="S1")


def _write_variable(file: Any, variable: RunVariable, run: Run) -> None:
    written = file.createVariable(variable.name, "d", variable.dimensions)
    values = np.asarray(variable.values(run), dtype=float)
    written[:] = np.where(np.isfinite(values), values, MISSING)
    texts = {"units": variable.units, "long_name": variable.meaning, "axis": variable.axis}
    if SKI in variable.dimensions:
        texts["coordinates"] = f"{variable.coordinates} ski_name".strip()
    else:
        texts["coordinates"] = variable.coordinates
    if variable.axis == "Z":
        texts["positive"] = "up"
    for name, text in texts.items():
        if text:
            setattr(written, name, text.encode("utf-8"))
    if variable.name not in (TIME, STATION):  # coordinates of a dimension may not be missing
        written._FillValue = np.float64(MISSING)


def run_dataframe(run: Run) -> DataFrame:
    """DataFrame with the rows of track.csv; see `Run.to_dataframe`."""
    pandas = import_extra("pandas", extra="pandas", what=Message("A run as a DataFrame"))
    return pandas.DataFrame(track_table(run), columns=list(track_columns(run)))


def run_dataset(run: Run) -> Dataset:
    """Dataset with the variables of run.nc, their units and meanings; see `Run.to_xarray`."""
    xarray = import_extra("xarray", extra="xarray", what=Message("A run as a Dataset"))
    stored = variables_of(run)
    coordinates = {variable.name for variable in stored if (variable.name,) == variable.dimensions}
    variables = {variable.name: _data_variable(variable, run) for variable in stored}
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


def _data_variable(variable: RunVariable, run: Run) -> tuple[tuple[str, ...], Any, dict[str, str]]:
    values = np.asarray(variable.values(run), dtype=float)
    finite = np.where(np.isfinite(values), values, np.nan)  # as in run.nc: the radius of a straight path is missing
    return variable.dimensions, finite, {"units": variable.units, "long_name": variable.meaning}


Values: TypeAlias = Callable[["Run"], npt.ArrayLike]

TIME, SKI, STATION, PIECE = "time", "ski", "station", "piece"


@dataclass(frozen=True, slots=True)
class RunVariable:
    """One variable of run.nc.

    name, dimensions, units: as in the file; units are SI in the notation of UDUNITS, angles in rad.
    meaning: its long_name.
    values: function that returns the array of a run in this unit.
    axis: "T", "X", "Y" or "Z" of a coordinate, otherwise empty.
    coordinates: names of the variables with its place in space.
    """

    name: str
    dimensions: tuple[str, ...]
    units: str
    meaning: str
    values: Values
    axis: str = ""
    coordinates: str = ""


_PATH: Final = "x y z"
_EDGE: Final = "ski_x ski_y ski_z"
_GROOVE: Final = "groove_x groove_y groove_z"


def _vector_variables(
    stem: str,
    dimensions: tuple[str, ...],
    units: str,
    meaning: str,
    values: Callable[[Run], FloatArray],
    **further: str,
) -> list[RunVariable]:
    """Variables of the components x, y and z of a vector."""

    def part(place: int) -> Values:
        return lambda run: values(run)[..., place]

    return [
        RunVariable(stem.format(name), dimensions, units, meaning.format(name), part(place), **further)
        for place, name in enumerate("xyz")
    ]


def _energy_variables() -> list[RunVariable]:
    def of(name: str) -> Values:
        """Function that takes this energy from a run."""
        return lambda run: run.energies[name]

    stored = {
        "kinetic": "kinetic energy",
        "potential": "potential energy in the field of gravity",
        "elastic_ski": "elastic energy of both skis",
        "elastic_snow": "elastic energy of the snow: of pressure, of the shear at the edges, of friction that sticks",
        "delayed_snow": "energy stored in the delayed depth of the snow under the skis",
    }
    lost = {
        "penetration": "work lost to the grooves in the snow since the start",
        "shear": "work lost to side-slip of the skis since the start",
        "friction": "work lost to glide friction since the start",
        "drag": "work lost to air drag since the start",
        "damping": "work lost to damping of the skis since the start",
        "snow_damping": "work lost to damping and delayed depth of the snow since the start",
    }
    variables = [RunVariable(f"{name}_energy", (TIME,), "J", stored[name], of(name)) for name in STORED]
    variables += [RunVariable(f"lost_{name}", (TIME,), "J", lost[name], of(name)) for name in LOST]
    supplied = {
        "boots": "work given since the start by what moves the boots",
        "push": "work given since the start by a push on the body",
    }
    return variables + [
        RunVariable(f"given_{name}", (TIME,), "J", supplied[name], _energy_over_time(name)) for name in GIVEN
    ]


def _energy_over_time(name: str) -> Values:
    return lambda run: run.energies.get(name, np.zeros(len(run.time)))


def _boot_variables() -> list[RunVariable]:
    place = "middle of the boot's sole at the level of the base: {}"
    variables = _vector_variables("boot_{}", (TIME, SKI), "m", place, lambda run: _boots(run, "place"))
    angles = ("edge_angle", "pitch", "heading")
    meanings = ("edge angle, positive: left edge down", "pitch, positive: tip up", "heading, positive to the left")
    for i, (name, meaning) in enumerate(zip(angles, meanings, strict=True)):
        variables.append(RunVariable(f"boot_{name}", (TIME, SKI), "rad", f"of the boot: {meaning}", _part("angles", i)))
    for what, unit in (("force", "N"), ("moment", "N m")):
        for i, axis in enumerate("xyz"):
            meaning = f"{what} of the ski on its boot, in space: {axis}"
            variables.append(RunVariable(f"boot_{what}_{axis}", (TIME, SKI), unit, meaning, _part(what, i)))
        for i, axis in enumerate(("ahead", "left", "up")):
            meaning = f"{what} of the ski on its boot, in the boot's axes: {axis}"
            variables.append(RunVariable(f"boot_{what}_{axis}", (TIME, SKI), unit, meaning, _part(f"own_{what}", i)))
    return variables


def _boots(run: Run, name: str) -> FloatArray:
    """A quantity of the boots (n, 2, 3); NaN for a run without boots."""
    if run.boots is None:
        return np.full((len(run.time), 2, 3), np.nan)
    return np.asarray(getattr(run.boots, name))


def _part(name: str, axis: int) -> Values:
    """Function that returns one component of a quantity of the boots."""
    return lambda run: _boots(run, name)[..., axis]


def _along_skis() -> list[RunVariable]:
    named: list[tuple[str, str, str, Values]] = [
        ("edge_depth", "m", "depth of the edge that is down below the undisturbed surface; negative: above it",
         lambda run: run.skis.edge_depth),
        ("force_per_length", "N m-1", "normal force of the snow on the ski per length",
         lambda run: run.skis.force_per_length),
        ("shear_per_length", "N m-1", "force of the snow on the ski across its edge, per length, positive to the left",
         lambda run: run.skis.shear_per_length),
        ("bending", "m", "deflection of the base away from the snow, against the boot", lambda run: run.skis.bending),
        ("twist", "rad", "growth of the edge angle against that at the boot", lambda run: run.skis.twist),
    ]  # fmt: skip
    return [
        RunVariable(name, (TIME, SKI, STATION), units, meaning, values, coordinates=_EDGE)
        for name, units, meaning, values in named
    ]


def _snow_forces() -> list[RunVariable]:
    total = "total force of the snow on the ski, in space (normal force, shear and friction): {}"
    return [
        *_vector_variables("snow_force_{}", (TIME, SKI), "N", total, lambda run: run.skis.force),
        RunVariable("total_force", (TIME, SKI), "N", "magnitude of the total force of the snow on the ski",
                    lambda run: run.skis.total_force),
        RunVariable("normal_force", (TIME, SKI), "N", "its part along the snow's normal",
                    lambda run: run.skis.normal_force),
    ]  # fmt: skip


def _coordinate_variables() -> list[RunVariable]:
    down = (
        "place of the middle between the boots: {}, of x down the fall line (or horizontal, on a profile), y left, z up"
    )
    edge = "loaded edge under the boot, on the snow surface: {}"
    return [
        RunVariable("time", (TIME,), "s", "time since the start", lambda run: run.time, axis="T"),
        RunVariable("station", (STATION,), "m", "place along the ski from the boot, positive forward, tip to tail",
                    lambda run: run.skis.station),
        *(_axis_variable(variable) for variable in _vector_variables("{}", (TIME,), "m", down, lambda run: run.place)),
        *_vector_variables("ski_{}", (TIME, SKI), "m", edge, lambda run: run.skis.track),
        *_vector_variables("groove_{}", (PIECE,), "m", "middle of a piece of groove, on the undisturbed surface: {}",
                lambda run: run.groove.middle),
    ]  # fmt: skip


def _axis_variable(variable: RunVariable) -> RunVariable:
    return RunVariable(
        variable.name, variable.dimensions, variable.units, variable.meaning, variable.values, variable.name.upper()
    )


def _over_time() -> list[RunVariable]:
    turned = "path's turn radius, positive to the left; missing where the path is straight"
    return [
        *_vector_variables("velocity_{}", (TIME,), "m s-1", "velocity of the middle between the boots: {}",
                lambda run: run.velocity, coordinates=_PATH),
        RunVariable("speed", (TIME,), "m s-1", "speed of the middle between the boots", lambda run: run.speed,
                    coordinates=_PATH),
        RunVariable("heading", (TIME,), "rad", "heading of the skis from the fall line, positive to the left",
                    lambda run: run.heading, coordinates=_PATH),
        RunVariable("turn_radius", (TIME,), "m", turned, lambda run: run.turn_radius, coordinates=_PATH),
        RunVariable("attitude", (TIME, "space_axis", "sledge_axis"), "1",
                    "rotation matrix from the sledge's axes (forward, left, up) to those of space (x, y, z)",
                    lambda run: run.attitude),
        RunVariable("depth", (TIME, SKI), "m",
                    "depth of the loaded edge under the boot below the undisturbed surface; negative: above it",
                    lambda run: run.skis.depth, coordinates=_EDGE),
    ]  # fmt: skip


def _groove_variables() -> list[RunVariable]:
    return [
        *_vector_variables("groove_left_{}", (PIECE,), "1", "unit vector along the piece, to the left: {}",
                lambda run: run.groove.left, coordinates=_GROOVE),
        RunVariable("groove_width", (PIECE,), "m", "width of the piece, across the path",
                    lambda run: run.groove.width, coordinates=_GROOVE),
        RunVariable("groove_depth", (PIECE,), "m", "deepest that the snow was pushed", lambda run: run.groove.depth,
                    coordinates=_GROOVE),
        RunVariable("groove_residual_depth", (PIECE,), "m", "permanent (residual) groove depth",
                    lambda run: run.groove.residual_depth, coordinates=_GROOVE),
    ]  # fmt: skip


RUN_VARIABLES: Final = (
    *_coordinate_variables(), *_over_time(), *_along_skis(), *_snow_forces(), *_boot_variables(), *_energy_variables(),
    *_groove_variables(),
)  # fmt: skip
"""Variables of run.nc except the names of the skis, in the order of the file."""


def _balance_variables() -> tuple[RunVariable, ...]:
    def of(name: str) -> Values:
        """Function that takes this quantity of the balance from a run."""
        return lambda run: getattr(run.balance, name)

    leans = {
        "lean": "lean of the line from the boots' middle to the centre of mass, positive to the left",
        "pressure_lean": "lean of the line from the centre of pressure to the centre of mass, positive to the left",
        "balanced_lean": "lean in balance with speed and path radius of the centre of mass, positive to the left",
        "rolling_lean": "the same with what the body's roll and the rise of its centre of mass take",
        "angulation": "mean edge angle of the boots less the lean",
    }
    lengths = {
        "leg": "length from the boots' middle to the centre of mass",
        "pressure": "centre of pressure from the boots' middle, to the left",
    }
    centre = "centre of mass of the body: {}"
    return (
        *(RunVariable(name, (TIME,), "rad", meaning, of(name)) for name, meaning in leans.items()),
        *(RunVariable(name, (TIME,), "m", meaning, of(name)) for name, meaning in lengths.items()),
        RunVariable("load", (TIME, SKI), "N", "force of the ski on its boot along the snow's normal", of("load")),
        *_vector_variables("centre_{}", (TIME,), "m", centre, _centre_of_mass),
    )


def _centre_of_mass(run: Run) -> FloatArray:
    return np.full((len(run.time), 3), np.nan) if run.boots is None else run.boots.centre_of_mass


SKIER_VARIABLES: Final = _balance_variables()
"""Further variables of a run with a skier."""


def variables_of(run: Run) -> tuple[RunVariable, ...]:
    """Variables of a run's file except the names of the skis."""
    return RUN_VARIABLES if run.scenario.skier is None else (*RUN_VARIABLES, *SKIER_VARIABLES)
