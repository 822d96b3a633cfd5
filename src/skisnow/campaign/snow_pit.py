"""Records of snow pits: place, time, layers, densities, temperatures, results of plate tests; CSV of pit densities."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import numpy as np

from .._support.arrays import FloatArray, IntArray
from .._support.errors import FieldDataError
from .._support.messages import Message
from .._support.units import CM, ICE_DENSITY, Facts, Shown, amount
from ..parameters import Quantity
from .problems import Problem, error
from .reading.campaign_files import CampaignFiles, RawFiles
from .reading.columns import Table
from .reading.table_forms import TableForm
from .reading.tables import read_table


@dataclass(frozen=True, slots=True)
class SnowLayer:
    """A layer: depth of its top from the surface (m), thickness (m) or None, hand hardness, grain form and size.

    ``hardness`` and ``grain_form`` are codes of the International Classification for Seasonal Snow on the Ground, such
    as ``P+`` and ``RGsr``, or ``""``; ``hardness_bottom`` is a different hardness at the bottom of the layer.
    ``grain_size`` is in m, or None.
    """

    top: float
    thickness: float | None = None
    hardness: str = ""
    grain_form: str = ""
    grain_size: float | None = None
    comment: str = ""
    hardness_bottom: str = ""


@dataclass(frozen=True, slots=True)
class LayerDensity:
    """Density ρ (kg/m³) from a depth (m) on, over a thickness (m) or None."""

    top: float
    snow_density: float
    thickness: float | None = None


@dataclass(frozen=True, slots=True)
class DepthTemperature:
    """Temperature of the snow (°C) at a depth (m)."""

    depth: float
    temperature_C: float


@dataclass(frozen=True, slots=True)
class ForceProfile:
    """Force of a penetrometer (N) at depths from the surface (m); ``method`` as CAAML names the instrument."""

    method: str
    depth: FloatArray = field(repr=False)
    force: FloatArray = field(repr=False)


@dataclass(frozen=True, slots=True)
class PlateValue:
    """H_V or S_f of the pit's site: mean and 95 % interval in the unit of its name, over n experiments."""

    value: float
    n: int
    interval: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True, repr=False)
class SnowPit(Shown):
    """A snow pit. Depths count from the surface down; unknown values are None, ``""`` or empty.

    name: name of the pit or site.
    time: day, or day and time with or without an offset, in ISO 8601; ``""`` if unknown.
    observer, comment, country, region: texts; the country as two letters of ISO 3166.
    latitude_deg, longitude_deg: WGS 84.
    elevation: elevation above sea level (m).
    aspect: N, NE, …, or degrees, as text.
    slope_angle_deg: inclination.
    snow_height: height of the snow on the ground (m).
    layers, densities, temperatures, forces: from the top down, as observed.
    snow_hardness, failure_shear_stress: H_V (N/mm³) and S_f (N/mm²) of plate tests.
    """

    name: str
    time: str = ""
    observer: str = ""
    comment: str = ""
    country: str = ""
    region: str = ""
    latitude_deg: float | None = None
    longitude_deg: float | None = None
    elevation: float | None = None
    aspect: str = ""
    slope_angle_deg: float | None = None
    snow_height: float | None = None
    air_temperature_C: float | None = None
    layers: tuple[SnowLayer, ...] = ()
    densities: tuple[LayerDensity, ...] = ()
    temperatures: tuple[DepthTemperature, ...] = ()
    forces: tuple[ForceProfile, ...] = ()
    snow_hardness: PlateValue | None = None
    failure_shear_stress: PlateValue | None = None

    def _repr_facts(self) -> Facts:
        height = "not known" if self.snow_height is None else amount(self.snow_height / CM, "cm")
        counts = f"{len(self.layers)} layers, {len(self.densities)} densities, {len(self.temperatures)} temperatures"
        return Facts(f"{self.name!r}, {self.time or 'no time'}: {counts}, snow height {height}")


_NO_NOTE: Final = "-9999"


@dataclass(frozen=True, slots=True)
class DensityLayers:
    """Density samples of snow pits, in the order of the file.

    pit: name of the pit.
    top, bottom: limits of the layer, heights above the ground or ice below the snow (m); top > bottom.
    snow_density: ρ in kg/m³.
    note: the column NOTES, or ``""``.
    kind: kind of snow in the file, or ``""``.
    row: line of the file; the header is line 1.
    problems: warnings of reading, such as unknown columns.
    """

    pit: tuple[str, ...]
    top: FloatArray
    bottom: FloatArray
    snow_density: FloatArray
    note: tuple[str, ...]
    kind: tuple[str, ...]
    row: IntArray
    problems: tuple[Problem, ...] = field(default=(), repr=False)

    def __len__(self) -> int:
        """Count the samples."""
        return len(self.pit)

    @property
    def thickness(self) -> FloatArray:
        """Thickness of each layer (m)."""
        return self.top - self.bottom


def read_density_layers(path: Path) -> DensityLayers:
    """Read a CSV of pit densities.

    Raises FieldDataError: the file has errors; the exception has all problems with their rows and columns.
    """
    path = Path(path)
    files = RawFiles(CampaignFiles(path.parent))
    table = read_table(_layers_form(path.name), files)
    if path.name in files.absent:
        allowed, action = Message("a file of this name"), Message("Check the file's name and folder.")
        files.problems.append(error("unreadable_file", path.name, allowed=allowed, action=action))
    if table is not None and not table.absent:
        files.problems.extend(_layers_upside_down(table))
    errors = [problem for problem in files.problems if problem.severity == "error"]
    if errors or table is None:
        raise FieldDataError(errors)
    notes = table.names["NOTES"].cells()
    return DensityLayers(
        pit=table.names["ID"].cells(),
        top=table.numbers["TOP"] * CM,
        bottom=table.numbers["BOTTOM"] * CM,
        snow_density=table.numbers["RHO"],
        note=tuple("" if note == _NO_NOTE else note for note in notes),
        kind=table.names["TYPE"].cells(),
        row=table.row,
        problems=tuple(files.problems),
    )


def _layers_form(file: str) -> TableForm:
    return TableForm(
        file=file,
        key="ID",
        names=("ID",),
        numbers=(
            Quantity("TOP", "height of the layer's top, cm", lowest=0.0, above=True),
            Quantity("BOTTOM", "height of its bottom, cm", lowest=0.0),
            Quantity("RHO", "density, kg/m³", lowest=0.0, above=True, highest=ICE_DENSITY),
        ),
        optional=("NOTES", "TYPE"),
    )


def _layers_upside_down(table: Table) -> Iterator[Problem]:
    top, bottom = table.numbers["TOP"], table.numbers["BOTTOM"]
    for row in np.flatnonzero(top <= bottom).tolist():
        allowed = Message("a height above the layer's BOTTOM, {bottom:g} cm", bottom=bottom[row])
        action = Message("Heights count upwards; exchange the two if the file counts from the surface down.")
        yield table.error(row, "out_of_range", "TOP", f"{top[row]:g}", allowed, action)
