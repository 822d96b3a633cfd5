"""A run as run.nc (NetCDF-3, CF conventions), as a pandas DataFrame and as an xarray Dataset."""

from __future__ import annotations

import io
import json
from importlib.metadata import version
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from scipy.io import netcdf_file

from ..._support.environment import needed
from ..._support.messages import Message
from ..._support.staging import write_file
from ...scenario.keys import SCENARIO_KEYS, in_sections, scenario_values
from ...simulation.run_tables import track_columns, track_table
from .variables import PIECE, SKI, STATION, TIME, variables_of

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from pandas import DataFrame
    from xarray import Dataset

    from ...simulation.run import Run
    from .variables import RunVariable


CONVENTIONS: Final = "CF-1.11"
MISSING: Final = 9.969209968386869e36
"""Fill value of the NetCDF library for missing doubles."""
SKI_NAMES: Final = ("left", "right")
_LETTERS: Final = 5


def write_run_file(
    run: Run, values: Mapping[str, Any], path: str | Path, *, provenance: Mapping[str, Any] | None = None
) -> None:
    """Write a run as a complete NetCDF-3 file.

    Parameters
    ----------
    run
        Result of `skisnow.simulate`.
    values
        Keys of the scenario with their values as in summary.json, for the global attribute ``scenario``; the attribute
        ``scenario_keys`` has their meanings and units.
    path
        Path of the file; an existing file is replaced.
    provenance
        Global attribute ``provenance`` as in summary.json (default: the program's version).

    Raises
    ------
    OutputError
        The file cannot be written.

    Notes
    -----
    All numbers are SI doubles, angles in radians. A value that is not finite, such as the turn radius of a straight
    path, is missing: ``_FillValue``.
    """
    memory = io.BytesIO()
    file = netcdf_file(memory, "w", version=2)  # 64-bit offsets: long runs pass 2 GB
    _write_attributes(file, run, values, provenance or {"versions": {"skisnow": version("skisnow")}})
    _create_dimensions(file, run)
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


def _create_dimensions(file: Any, run: Run) -> None:
    sizes = {TIME: len(run.time), SKI: len(SKI_NAMES), STATION: len(run.skis.station), PIECE: len(run.groove.width)}
    for name, size in (sizes | {"space_axis": 3, "sledge_axis": 3, "letter": _LETTERS}).items():
        file.createDimension(name, size)


def _write_ski_names(file: Any) -> None:
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
    pandas = needed("pandas", extra="pandas", what=Message("A run as a DataFrame"))
    return pandas.DataFrame(track_table(run), columns=list(track_columns(run)))


def run_dataset(run: Run) -> Dataset:
    """Dataset with the variables of run.nc, their units and meanings; see `Run.to_xarray`."""
    xarray = needed("xarray", extra="xarray", what=Message("A run as a Dataset"))
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
