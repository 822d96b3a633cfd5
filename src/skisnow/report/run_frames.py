"""A run for pandas and xarray, which are loaded here and nowhere else."""

from __future__ import annotations

import json
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

import numpy as np

from .._support.optional_packages import needed
from ..scenario.keys import in_sections, scenario_values
from ..simulation.track_table import track_columns, track_table
from .run_file import SKI_NAMES
from .run_variables import SKI, variables_of

if TYPE_CHECKING:
    from pandas import DataFrame
    from xarray import Dataset

    from ..simulation.run import Run
    from .run_variables import RunVariable


def run_dataframe(run: Run) -> DataFrame:
    """The rows of track.csv; see `Run.to_dataframe`."""
    pandas = needed("pandas", extra="pandas", what="a table of a run as a DataFrame")
    return pandas.DataFrame(track_table(run), columns=list(track_columns(run)))


def run_dataset(run: Run) -> Dataset:
    """Every variable of run.nc with its unit and meaning; see `Run.to_xarray`."""
    xarray = needed("xarray", extra="xarray", what="a run as a Dataset")
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
