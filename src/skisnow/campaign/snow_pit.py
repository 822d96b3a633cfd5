"""Records of snow pits: place, time, layers, densities, temperatures, results of plate tests."""

from __future__ import annotations

from dataclasses import dataclass, field

from .._support.arrays import FloatArray
from .._support.units import CM, Facts, Shown, amount


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
        """Title with name, time, counts and snow height, for the representation."""
        height = "not known" if self.snow_height is None else amount(self.snow_height / CM, "cm")
        counts = f"{len(self.layers)} layers, {len(self.densities)} densities, {len(self.temperatures)} temperatures"
        return Facts(f"{self.name!r}, {self.time or 'no time'}: {counts}, snow height {height}")
