"""A campaign as NetCDF-3 with CF conventions, for xarray, MATLAB and other readers of labelled arrays.

All numbers are SI. Each table has its own dimension; readings are a contiguous ragged array (CF 9.3.3): ``row_size`` of
an experiment is the number of its consecutive readings.
"""

from __future__ import annotations

import io
import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any, Final, cast

import numpy as np
import numpy.typing as npt
from scipy.io import netcdf_file

from .._support.arrays import IntArray
from .._support.staging import write_file
from ..campaign import Campaign
from ..campaign.records import PenetrationTests, ShearTests

CONVENTIONS: Final = "CF-1.11"
MISSING: Final = 9.969209968386869e36
"""Default fill value of the NetCDF library for doubles."""


@dataclass(frozen=True, slots=True)
class _Variable:
    """A column: name, dimension, values (numbers, whole numbers or texts), unit and meaning.

    `sample_of`: for a ``row_size``, the dimension of the readings that it counts; otherwise empty.
    """

    name: str
    dimension: str
    values: npt.NDArray[Any] | Sequence[str]
    units: str
    meaning: str
    sample_of: str = ""


def write_campaign_netcdf(campaign: Campaign, path: str | Path) -> None:
    """Write the readings of a campaign, corrections applied, as NetCDF-3.

    campaign: from `skisnow.read_campaign`.
    path: Path of the file; an existing file is replaced.
    """
    memory = io.BytesIO()
    file = netcdf_file(memory, "w", version=2)
    for name, text in _global_attributes(campaign).items():
        setattr(file, name, text.encode("utf-8"))
    for variable in _variables(campaign):
        if variable.dimension not in file.dimensions:
            file.createDimension(variable.dimension, len(variable.values))
        _write_variable(file, variable)
    file.flush()
    content = memory.getvalue()
    file.close()
    write_file(path, content)


def _global_attributes(campaign: Campaign) -> dict[str, str]:
    """Attributes of the file: title, place, observers, tools, stated uncertainties, and hashes of the files."""
    tools = {name: {"shape": type(tool).__name__, **asdict(cast("Any", tool))} for name, tool in campaign.tools.items()}
    stated = {
        "gauge_resolution_m": campaign.gauge_resolution,
        "load_uncertainty_N": campaign.load_uncertainty,
        "moment_uncertainty_Nm": campaign.moment_uncertainty,
        "lever_arm_uncertainty_m": campaign.lever_arm_uncertainty,
        "seating_m": campaign.seating,
        "pole_stiffness_Nm_per_rad": campaign.pole_stiffness,
    }
    return {
        "Conventions": CONVENTIONS,
        "title": campaign.name,
        "source": f"field campaign, read by skisnow {version('skisnow')}",
        "place": campaign.place,
        "observers": ", ".join(campaign.observers),
        "tools": json.dumps(tools, ensure_ascii=False),
        "plate_lengths_m": json.dumps(dict(campaign.plates), ensure_ascii=False),
        "stated": json.dumps({name: value for name, value in stated.items() if value is not None}),
        "file_sha256": json.dumps(dict(campaign.file_hashes), ensure_ascii=False),
    }


def _variables(campaign: Campaign) -> Iterator[_Variable]:
    """Columns of all tables of a campaign."""
    if campaign.penetration is not None:
        yield from _penetration_variables(campaign.penetration)
    if campaign.shear is not None:
        yield from _shear_variables(campaign.shear)
    if (samples := campaign.density) is not None:
        of = "density_sample"
        yield from _text_variables(of, name=samples.sample, site=samples.site, cancelled=samples.cancelled)
        yield _Variable(f"{of}_snow_density", of, samples.snow_density, "kg m-3", "density of the snow")
        yield _Variable(f"{of}_depth", of, samples.sample_depth, "m", "depth of the middle below the snow surface")
        yield _Variable(f"{of}_thickness", of, samples.sample_thickness, "m", "vertical extent")
        yield _Variable(f"{of}_row", of, samples.row, "1", "line of the file")
        yield from _further(of, samples.further)
    if (tests := campaign.drop_cone) is not None:
        of = "drop_cone_repeat"
        yield from _text_variables(of, test=tests.test, repeat=tests.repeat, site=tests.site, cancelled=tests.cancelled)
        yield _Variable(f"{of}_depth", of, tests.drop_cone_depth, "m", "depth of the drop cone; larger is softer")
        yield _Variable(f"{of}_row", of, tests.row, "1", "line of the file")
        yield from _further(of, tests.further)


def _penetration_variables(tests: PenetrationTests) -> Iterator[_Variable]:
    """Variables of the penetration tests: one row for each test, then for each reading, also of unloading."""
    of, reading = "penetration_test", "penetration_reading"
    yield from _text_variables(
        of, name=tests.experiment, site=tests.site, tool=tests.tool, spot=tests.spot, cancelled=tests.cancelled
    )
    yield _Variable(f"{of}_edge_angle", of, tests.edge_angle, "rad", "angle between the base and the snow surface")
    yield _Variable(f"{of}_snow_density", of, tests.snow_density, "kg m-3", "density of the snow at the experiment")
    yield _Variable(f"{of}_drop_cone_depth", of, tests.drop_cone_depth, "m", "drop-cone depth at the experiment")
    yield _row_size_variable(of, reading, tests.first)
    yield _Variable(f"{reading}_load", reading, tests.load, "N", "load normal to the snow surface")
    yield _Variable(f"{reading}_depth", reading, tests.penetration_depth, "m", "depth below the snow surface")
    if tests.depth_after is not None:
        yield _Variable(f"{reading}_depth_after", reading, tests.depth_after, "m", "depth after waiting under the load")
    yield _Variable(f"{reading}_row", reading, tests.row, "1", "line of the file")
    yield from _further(reading, tests.further)
    if tests.unloading is not None:
        left = "unloading_reading"
        yield _row_size_variable(of, left, tests.unloading.first)
        yield _Variable(f"{left}_load", left, tests.unloading.load, "N", "load that is left while discs are taken off")
        yield _Variable(f"{left}_depth", left, tests.unloading.penetration_depth, "m", "depth below the snow surface")
        yield _Variable(f"{left}_row", left, tests.unloading.row, "1", "line of the file")


def _shear_variables(tests: ShearTests) -> Iterator[_Variable]:
    """Variables of the shear tests: one row for each test, then for each reading of turning, if there are any."""
    of = "shear_test"
    yield from _text_variables(
        of, name=tests.experiment, site=tests.site, plate=tests.plate, spot=tests.spot, cancelled=tests.cancelled
    )
    yield _Variable(f"{of}_edge_angle", of, tests.edge_angle, "rad", "angle between the plate and the snow surface")
    yield _Variable(f"{of}_depth", of, tests.penetration_depth, "m", "depth of the plate's edge")
    yield _Variable(f"{of}_lever_arm", of, tests.lever_arm, "m", "from the pole's axis to the middle of the plate")
    yield _Variable(f"{of}_moment", of, tests.moment, "N m", "largest moment on the pole")
    yield _Variable(f"{of}_snow_density", of, tests.snow_density, "kg m-3", "density of the snow at the experiment")
    yield _Variable(f"{of}_drop_cone_depth", of, tests.drop_cone_depth, "m", "drop-cone depth at the experiment")
    yield _Variable(f"{of}_row", of, tests.row, "1", "line of the file")
    yield from _further(of, tests.further)
    if tests.turning is not None:
        reading = "turning_reading"
        yield _row_size_variable(of, reading, tests.turning.first)
        yield _Variable(f"{reading}_angle", reading, tests.turning.turning_angle, "rad", "turning angle of the device")
        yield _Variable(f"{reading}_moment", reading, tests.turning.moment, "N m", "moment on the pole")


def _text_variables(dimension: str, **columns: Sequence[str]) -> Iterator[_Variable]:
    """Text variables of a dimension, each named after its column."""
    for name, values in columns.items():
        meaning = "reason why the experiment does not count" if name == "cancelled" else name
        yield _Variable(f"{dimension}_{name}", dimension, values, "", meaning)


def _row_size_variable(dimension: str, reading: str, first: IntArray) -> _Variable:
    """Variable with the number of readings of each experiment, from the indices of the first ones."""
    name = f"{reading}_row_size"
    return _Variable(name, dimension, np.diff(first), "1", "number of readings of the experiment", sample_of=reading)


def _further(dimension: str, columns: Mapping[str, Sequence[str]]) -> Iterator[_Variable]:
    """Text columns of a table that skisnow does not interpret."""
    for number, (heading, cells) in enumerate(columns.items(), start=1):
        yield _Variable(f"{dimension}_further_{number}", dimension, cells, "", heading)


def _write_variable(file: Any, variable: _Variable) -> None:
    """Write a variable to a NetCDF file: numbers (NaN as MISSING) or texts in UTF-8, with meaning and unit."""
    values = variable.values
    if isinstance(values, np.ndarray):
        whole = np.issubdtype(values.dtype, np.integer)
        written = file.createVariable(variable.name, "i" if whole else "d", (variable.dimension,))
        written[:] = values if whole else np.where(np.isfinite(values), values, MISSING)
        if not whole:
            written._FillValue = np.float64(MISSING)
    else:
        encoded = [text.encode("utf-8") for text in values]
        length = max(1, *map(len, encoded)) if encoded else 1
        letters = f"letter_{length}"
        if letters not in file.dimensions:
            file.createDimension(letters, length)
        written = file.createVariable(variable.name, "c", (variable.dimension, letters))
        written[:] = np.frombuffer(b"".join(text.ljust(length, b"\0") for text in encoded), "S1").reshape(-1, length)
        written._Encoding = b"utf-8"
    written.long_name = variable.meaning.encode("utf-8")
    if variable.name.endswith("_snow_density"):  # CF names no other of these quantities
        written.standard_name = b"snow_density"
    if variable.units:
        written.units = variable.units.encode("ascii")
    if variable.sample_of:
        written.sample_dimension = variable.sample_of.encode("ascii")
