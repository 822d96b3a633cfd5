"""A run as run.nc (NetCDF-3, CF conventions), as a pandas DataFrame and as an xarray Dataset."""

from __future__ import annotations

import io
import json
from importlib.metadata import version
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from scipy.io import netcdf_file

from ..._support.messages import Message
from ..._support.optional_packages import needed
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
"""The value that the NetCDF library keeps for doubles that are not there."""
SKI_NAMES: Final = ("left", "right")
_LETTERS: Final = 5


def write_run_file(
    run: Run, values: Mapping[str, Any], path: str | Path, *, provenance: Mapping[str, Any] | None = None
) -> None:
    """Write a run as NetCDF-3, in one piece.

    Parameters
    ----------
    run
        What `skisnow.simulate` gave.
    values
        The scenario's keys with their values, as they stand in summary.json: the global attribute ``scenario``. What
        each key means, with its unit, stands in ``scenario_keys``.
    path
        Of the file, which is replaced where it exists.
    provenance
        As in summary.json: the global attribute ``provenance``; left out: only the program's version.

    Raises
    ------
    OutputError
        The file cannot be written.

    Notes
    -----
    All numbers are SI doubles, angles in radians. What is not finite (the turn radius of a straight path) is missing:
    ``_FillValue``.
    """
    memory = io.BytesIO()
    file = netcdf_file(memory, "w", version=2)  # 64-bit offsets: long runs pass 2 GB
    _attributes(file, run, values, provenance or {"versions": {"skisnow": version("skisnow")}})
    _dimensions(file, run)
    _names(file)
    for variable in variables_of(run):
        _write(file, variable, run)
    file.flush()
    content = memory.getvalue()
    file.close()
    write_file(path, content)


def _attributes(file: Any, run: Run, values: Mapping[str, Any], provenance: Mapping[str, Any]) -> None:
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


def _dimensions(file: Any, run: Run) -> None:
    sizes = {TIME: len(run.time), SKI: len(SKI_NAMES), STATION: len(run.skis.station), PIECE: len(run.groove.width)}
    for name, size in (sizes | {"space_axis": 3, "sledge_axis": 3, "letter": _LETTERS}).items():
        file.createDimension(name, size)


def _names(file: Any) -> None:
    variable = file.createVariable("ski_name", "c", (SKI, "letter"))
    variable.long_name = b"which ski"
    variable[:] = np.array([list(name.ljust(_LETTERS)) for name in SKI_NAMES], dtype="S1")


def _write(file: Any, variable: RunVariable, run: Run) -> None:
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
    """The rows of track.csv; see `Run.to_dataframe`."""
    pandas = needed("pandas", extra="pandas", what=Message("A run as a DataFrame"))
    return pandas.DataFrame(track_table(run), columns=list(track_columns(run)))


def run_dataset(run: Run) -> Dataset:
    """Every variable of run.nc with its unit and meaning; see `Run.to_xarray`."""
    xarray = needed("xarray", extra="xarray", what=Message("A run as a Dataset"))
    stored = variables_of(run)
    coordinates = {each.name for each in stored if (each.name,) == each.dimensions}
    variables = {each.name: _variable(each, run) for each in stored}
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


def _variable(variable: RunVariable, run: Run) -> tuple[tuple[str, ...], Any, dict[str, str]]:
    values = np.asarray(variable.values(run), dtype=float)
    finite = np.where(np.isfinite(values), values, np.nan)  # as in run.nc: the radius of a straight path is missing
    return variable.dimensions, finite, {"units": variable.units, "long_name": variable.meaning}
