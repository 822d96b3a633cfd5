"""Snow pits from CAAML 5 and 6, the exchange format of avalanche services: ``.caaml``, ``.caaml.xml``.

skisnow reads place, time, observer, layers with hand hardness and grains, densities, temperatures, forces of
penetrometers, and H_V and S_f if skisnow wrote the file. Everything else is ignored. Each quantity is converted from
the unit in its ``uom``; an unknown unit is an error. Version 5 gives units at the profile (``uomDensity``), version 6
at each value, and some quantities have another place.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Final, NoReturn

import numpy as np

from .._support.errors import FieldDataError
from .._support.messages import Message
from .._support.spreadsheet_text import number
from .._support.units import CM, DEGREE, MM, ZERO_CELSIUS
from .._support.user_files.text_files import ContentError, plain_bytes
from .._support.user_files.xml_elements import Element, xml_tree
from ..parameters.quantity import LARGEST
from .problems import error
from .snow_pit import DepthTemperature, ForceProfile, LayerDensity, PlateValue, SnowLayer, SnowPit

MOST_BYTES: Final = 32 * 2**20
NAMESPACE: Final = re.compile(
    r"http://(www\.)?caaml\.org/"
    r"(Schemas/SnowProfileIACS/v6\.\d+(\.\d+)?|Schemas/V5\.0/Profiles/Snow[Pp]rofileIACS|v5\.0/Snow[Pp]rofile/IACS)"
)
OWN_NAMESPACE: Final = "urn:skisnow:caaml:1"
"""Namespace of H_V and S_f in ``customData``."""
LIGHTEST: Final = 5.0
"""In kg/m³; a smaller median is another unit (assumption): the lightest new snow has about 10."""
_SLACK: Final = 0.05
"""In m: how far a layer may end above the surface or below the ground: heights are measured at another place."""
_DEEPEST: Final = 100.0
_DENSITIES: Final = (0.0, 1000.0)
_TEMPERATURES: Final = (-90.0, 5.0)
"""Limits in m, kg/m³ and °C with some reserve for the measurement; numbers outside are in another unit or slips."""
NIL: Final = ("", "inapplicable", "missing", "template", "unknown", "withheld", "n/a", "none")
"""Words for a missing value, which the standard allows instead of any number."""
_UNIT_OF_PROFILE: Final = {"snowTemp": "uomTemp"}
"""Attributes of a profile with the unit of its values, if they are not called ``uom`` and the value's name."""


def read_caaml(path: str | Path) -> SnowPit:
    """Read a snow profile in CAAML 5.0 or 6.0 to 6.0.6.

    Returns: snow pit with depths from the surface down.
    Raises FieldDataError: the file cannot be read, is not CAAML 5 or 6, declares entities, gives heights from the
        ground without the snow height, or has an invalid number or unit.
    """
    path = Path(path)
    try:
        root = xml_tree(plain_bytes(path, most_bytes=MOST_BYTES))
    except ContentError as failure:
        allowed = Message("a snow profile in CAAML 5 or 6")
        action = Message("Export it again from the program that wrote it.")
        problem = error(
            "unreadable_file", path.name, row=failure.line, value=failure.what, allowed=allowed, action=action
        )
        raise FieldDataError([problem]) from failure
    return _Profile(path.name, root).pit()


_OBSERVER_PATHS: Final = (
    ("Person", "name"),
    ("Operation", "contactPerson", "name"),
    ("Operation", "contactPerson", "Person", "name"),
    ("Operation", "name"),
)
"""Elements with the name of the observing person or organisation, below the source of the observation."""


class _Profile:
    """Parser of one CAAML file; each error is a FieldDataError that names the element."""

    def __init__(self, file: str, root: Element) -> None:
        self._file = file
        self._root = root
        if root.name != "SnowProfile" or NAMESPACE.fullmatch(root.namespace) is None:
            allowed = Message("SnowProfile of CAAML 5 or 6")
            root_name = f"{root.name} of {root.namespace or 'no namespace'}"
            self._refuse("SnowProfile", root_name, allowed, Message("Export it as CAAML 6."))
        measured = root.child("snowProfileResultsOf", "SnowProfileMeasurements")
        if measured is None:
            action = Message("The file contains no profile.")
            self._refuse("snowProfileResultsOf", "nothing", Message("SnowProfileMeasurements"), action)
        self._measured = measured
        self._is_version_6 = "v6" in root.namespace
        components = measured.child("snowPackCond", "hS", "Components")
        if components is not None:
            self._snow_height = self._quantity(LENGTH, components, "height")
        else:
            self._snow_height = self._quantity(LENGTH, measured, "hS", "Components", "snowHeight")
        self._from_ground = measured.attributes.get("dir", "top down") != "top down"
        if self._from_ground and self._snow_height is None:
            action = Message("Add snowPackCond/hS, or export it top down.")
            self._refuse("SnowProfileMeasurements", "bottom up", Message("top down, or the height of the snow"), action)

    def _refuse(self, element: str, value: str, allowed: Message, action: Message) -> NoReturn:
        """Raise a FieldDataError with one problem at an element of this file."""
        raise FieldDataError(
            [error("unreadable_file", self._file, column=element, value=value, allowed=allowed, action=action)]
        )

    def pit(self) -> SnowPit:
        """Snow pit of the file, with all quantities that skisnow reads."""
        root, measured = self._root, self._measured
        place = root.child("locRef", "ObsPoint") or root.child("locRef") or root
        latitude, longitude = self._position(place)
        records = (root.child("timeRef", "recordTime"), root.child("validTime"))
        paths = (("TimeInstant", "timePosition"), ("TimePeriod", "beginPosition"))
        times = (record.text_of(*path) for record in records if record for path in paths)
        source = root.child("srcRef") or root.child("metaDataProperty", "MetaData", "srcRef")
        observers = () if source is None else (source.text_of(*path) for path in _OBSERVER_PATHS)
        return SnowPit(
            name=place.text_of("name") or root.attributes.get("id", ""),
            time=next(filter(None, times), ""),
            observer=next(filter(None, observers), ""),
            comment=root.text_of("metaData", "comment") or measured.text_of("comment"),
            country=place.text_of("country"),
            region=place.text_of("region"),
            latitude_deg=latitude,
            longitude_deg=longitude,
            elevation=self._quantity(ELEVATION, place, "validElevation", "ElevationPosition", "position"),
            aspect=self._aspect(place, "validAspect", "AspectPosition", "position"),
            slope_angle_deg=self._quantity(ANGLE, place, "validSlopeAngle", "SlopeAnglePosition", "position"),
            snow_height=self._snow_height,
            air_temperature_C=self._quantity(TEMPERATURE, measured.child("weatherCond") or measured, "airTempPres"),
            layers=tuple(self._layer(*pair) for pair in self._children_by_profile("stratProfile", "Layer")),
            densities=self._densities(),
            temperatures=tuple(self._temperature(*pair) for pair in self._children_by_profile("tempProfile", "Obs")),
            forces=tuple(self._forces(pair) for pair in measured.named("hardnessProfile")),
            snow_hardness=self._plate_value("snowHardness", SNOW_HARDNESS),
            failure_shear_stress=self._plate_value("failureShearStress", SHEAR_STRESS),
        )

    def _children_by_profile(self, profile: str, name: str) -> list[tuple[Element, Element]]:
        """Pairs of profile and child for all profiles of a name, such as "tempProfile", and children of a name."""
        return [(parent, child) for parent in self._measured.named(profile) for child in parent.named(name)]

    def _aspect(self, place: Element, *path: str) -> str:
        """Aspect of the slope at a path below an element: a compass point, or degrees as text; "" if unknown."""
        text = place.text_of(*path)
        is_number = text.replace(".", "", 1).isdecimal()
        return f"{self._quantity(ANGLE, place, *path):.10g}" if is_number else self._text_or_empty(text)

    def _position(self, place: Element) -> tuple[float, float] | tuple[None, None]:
        """Latitude and longitude; with CRS84 in version 5 the longitude comes first."""
        point = place.child("pointLocation", "Point") or place.child("Point")
        text = "" if point is None else point.text_of("pos")
        if point is None or not text:
            return None, None
        both = [self._finite("pos", number) for number in text.split()[:2]]
        if not self._is_version_6 and point.attributes.get("srsName", "").endswith("CRS84"):
            both.reverse()
        if len(both) != 2 or not (-90.0 <= both[0] <= 90.0 and -180.0 <= both[1] <= 180.0):
            self._refuse("pos", text, Message("latitude and longitude in degrees"), Message("Correct the place."))
        return both[0], both[1]

    def _layer(self, profile: Element, layer: Element) -> SnowLayer:
        """Snow layer of an element: depths (m), hand hardness (of top and bottom if both are given), grains."""
        top, thickness = self._top_and_thickness(profile, layer)
        hand, upper, lower = (
            self._text_or_empty(layer.text_of(name)) for name in ("hardness", "hardnessTop", "hardnessBottom")
        )
        return SnowLayer(
            top=top,
            thickness=thickness,
            hardness=hand or upper or lower,
            grain_form=self._text_or_empty(layer.text_of("grainFormPrimary")),
            grain_size=self._quantity(GRAIN_SIZE, layer, "grainSize", "Components", "avg", words=True),
            comment=layer.text_of("metaData", "comment") or layer.text_of("comment"),
            hardness_bottom=lower if upper and not hand else "",
        )

    def _densities(self) -> tuple[LayerDensity, ...]:
        """Densities (kg/m³) of the layers in the order of the file; rejects values and a median outside the limits."""
        densities = []
        for profile, layer in self._children_by_profile("densityProfile", "Layer"):
            top, thickness = self._top_and_thickness(profile, layer)
            density = self._required_number(DENSITY, profile, layer, "density")
            self._require_within("density", density, _DENSITIES, "kg/m³")
            densities.append(LayerDensity(top, density, thickness))
        middle = median(sample.snow_density for sample in densities) if densities else LIGHTEST
        if 0.0 < middle < LIGHTEST:
            allowed = Message("{lightest:g} kg/m³ or more", lightest=LIGHTEST)
            action = Message("If the numbers are g/cm³, state the unit gcm-3.")
            self._refuse("density", f"a median of {middle:g} kg/m³", allowed, action)
        return tuple(densities)

    def _temperature(self, profile: Element, observed: Element) -> DepthTemperature:
        """Snow temperature (°C) at a depth below the surface (m); rejects a value outside the limits."""
        depth = self._depth_below_surface("depth", self._required_number(LENGTH, profile, observed, "depth"))
        temperature = self._required_number(TEMPERATURE, profile, observed, "snowTemp")
        self._require_within("snowTemp", temperature, _TEMPERATURES, "°C")
        return DepthTemperature(depth, temperature)

    def _forces(self, profile: Element) -> ForceProfile:
        """Force (N) over depth (m) of a penetrometer, from a list of pairs or else from its layers."""
        about = profile.child("hardnessMetaData") or profile.child("MetaData") or profile
        method = self._text_or_empty(about.text_of("methodOfMeas"))
        rows = profile.text_of("Measurements", "tupleList").split()
        if not rows:
            layers = list(profile.named("Layer"))
            depths = [self._top_and_thickness(profile, layer)[0] for layer in layers]
            forces = [self._required_number(FORCE, profile, layer, "hardness") for layer in layers]
            return ForceProfile(method, np.array(depths, dtype=float), np.array(forces, dtype=float))
        pairs = [[self._finite("tupleList", number) for number in row.split(",")] for row in rows]
        if any(len(pair) != 2 for pair in pairs):
            self._refuse("tupleList", rows[0], Message("pairs of depth and force"), Message("Correct the list."))
        units = (profile.child("MeasurementComponents") or profile).attributes
        columns = [
            np.array([self._convert(kind, attribute, pair[column], units.get(attribute)) for pair in pairs])
            for column, (kind, attribute) in enumerate(((LENGTH, "uomDepth"), (FORCE, "uomHardness")))
        ]
        return ForceProfile(method, columns[0], columns[1])

    def _plate_value(self, name: str, units: CaamlUnits) -> PlateValue | None:
        """Value of skisnow's own element `name`, with its count and interval; None if it is missing."""
        custom = self._measured.child("customData", name)
        if custom is None or custom.namespace != OWN_NAMESPACE:
            return None
        unit = custom.attributes.get("uom")
        ends = [custom.attributes.get(end) for end in ("low", "high")]
        limits = [self._convert(units, name, self._finite(name, end), unit) for end in ends if end is not None]
        interval = (limits[0], limits[1]) if len(limits) == 2 else None
        count = round(self._finite(name, custom.attributes.get("n", "0")))
        return PlateValue(self._convert(units, name, self._finite(name, custom.text), unit), count, interval)

    def _top_and_thickness(self, profile: Element, layer: Element) -> tuple[float, float | None]:
        """Depth of a layer's top below the surface and its thickness (m; None if it is not stated)."""
        thickness = self._quantity(LENGTH, layer, "thickness", profile=profile)
        self._require_within("thickness", thickness or 0.0, (0.0, _DEEPEST), "m")
        top = self._required_number(LENGTH, profile, layer, "depthTop")
        if self._from_ground:
            self._require_within("thickness", thickness or 0.0, (0.0, top + _SLACK), "m")
        return self._depth_below_surface("depthTop", top), thickness

    def _depth_below_surface(self, element: str, value: float) -> float:
        """Depth from the surface (m) for a value of the profile (m), which may be a height from the ground."""
        top = (self._snow_height or 0.0) if self._from_ground else _DEEPEST
        self._require_within(element, value, (-_SLACK, top + _SLACK), "m")
        return top - value if self._from_ground else value

    def _require_within(self, element: str, value: float, limits: tuple[float, float], unit: str) -> None:
        """Reject a value outside the limits, which count as allowed; `unit` is for the error message."""
        low, high = limits
        if not low <= value <= high:
            allowed = Message("a number from {low:g} to {high:g} {unit}", low=low, high=high, unit=unit)
            self._refuse(element, f"{value:.6g} {unit}", allowed, Message("Correct the number or its unit."))

    def _required_number(self, units: CaamlUnits, profile: Element, parent: Element, name: str) -> float:
        """Number of a child element in SI; rejects a missing one."""
        value = self._quantity(units, parent, name, profile=profile)
        if value is None:
            action = Message("Give every {name} its {name_2}.", name=parent.name, name_2=name)
            self._refuse(name, "nothing", Message("a number"), action)
        return value

    def _quantity(
        self, units: CaamlUnits, parent: Element, *path: str, profile: Element | None = None, words: bool = False
    ) -> float | None:
        """Number at a path, converted to skisnow's unit; None if it is missing, or a text where `words` allows one."""
        text = parent.text_of(*path)
        if text.lower() in NIL or (words and not any(character.isdigit() for character in text)):
            return None
        name, above = path[-1], (parent.child(*path[:length]) for length in range(len(path), 0, -1))
        stated = [element.attributes.get("uom") for element in above if element is not None]
        if profile is not None:
            stated.append(profile.attributes.get(_UNIT_OF_PROFILE.get(name, f"uom{name[0].upper()}{name[1:]}")))
        unit = next((unit for unit in stated if unit is not None), None)
        return self._convert(units, name, self._finite(name, text), unit)

    def _convert(self, units: CaamlUnits, name: str, value: float, unit: str | None) -> float:
        """Value in SI; rejects an unknown unit or a number that is too large."""
        converted = units.convert(value, unit)
        if converted is None:
            allowed = Message("a unit among {sizes}", sizes=list(units.sizes))
            self._refuse(name, unit or "", allowed, Message("Correct the unit, or convert the numbers."))
        if not abs(converted) <= LARGEST:
            allowed = Message("a number to ±{largest:g} in SI", largest=LARGEST)
            self._refuse(name, f"{value:g} {unit or ''}", allowed, Message("Correct the number."))
        return converted

    def _finite(self, element: str, text: str) -> float:
        """Number of a text; rejects what is not a finite number."""
        value = number(text)
        if math.isnan(value):
            self._refuse(element, text.strip()[:80], Message("a finite number"), Message("Correct the number."))
        return value

    def _text_or_empty(self, text: str) -> str:
        """The text, or "" if it is one of the format's words for a missing value."""
        return "" if text.lower() in NIL else text


_MEANINGLESS: Final = re.compile(r"[\s^*·]")


@dataclass(frozen=True, slots=True)
class CaamlUnits:
    """Units of CAAML for one kind of quantity, and their conversion.

    standard: unit of a value without the attribute ``uom``, by the CAAML standard.
    sizes: shift and factor of each unit: the result is (value + shift) × factor.
    """

    standard: str
    sizes: Mapping[str, tuple[float, float]]

    def convert(self, value: float, unit: str | None) -> float | None:
        """Value in m, °C, kg/m³, N or degrees; None if the unit is unknown.

        >>> TEMPERATURE.convert(23.0, "degF"), LENGTH.convert(2.0, None), LENGTH.convert(2.0, "furlong")
        (-5.0, 0.02, None)
        """
        size = self.sizes.get(self.standard if unit is None else _MEANINGLESS.sub("", unit))
        return None if size is None else (value + size[0]) * size[1]


def _proportional(factor: float, *units: str) -> dict[str, tuple[float, float]]:
    """Shift (0) and factor of each of these units, for `CaamlUnits.sizes`."""
    return dict.fromkeys(units, (0.0, factor))


_LENGTHS: Final = {
    **_proportional(MM, "mm"),
    **_proportional(CM, "cm"),
    **_proportional(1.0, "m"),
    **_proportional(1e3, "km"),
    **_proportional(0.0254, "in", "inch"),
    **_proportional(0.3048, "ft", "feet"),
}
LENGTH: Final = CaamlUnits("cm", _LENGTHS)
ELEVATION: Final = CaamlUnits("m", _LENGTHS)
GRAIN_SIZE: Final = CaamlUnits("mm", _LENGTHS)
TEMPERATURE: Final = CaamlUnits(
    "degC",
    {
        **dict.fromkeys(("degC", "C", "°C", "Cel"), (0.0, 1.0)),
        **dict.fromkeys(("degF", "F", "°F"), (-32.0, 5.0 / 9.0)),
        **dict.fromkeys(("K", "degK"), (-ZERO_CELSIUS, 1.0)),
    },
)
DENSITY: Final = CaamlUnits(
    "kgm-3",
    {**_proportional(1.0, "kgm-3", "kg/m3", "kg/m³"), **_proportional(1e3, "gcm-3", "g/cm3", "g/cm³", "kgl-1", "kg/l")},
)
FORCE: Final = CaamlUnits("N", {**_proportional(1.0, "N"), **_proportional(1e3, "kN"), **_proportional(1e-3, "mN")})
ANGLE: Final = CaamlUnits("deg", {**_proportional(1.0, "deg", "°"), **_proportional(1.0 / DEGREE, "rad")})
SNOW_HARDNESS: Final = CaamlUnits("Nmm-3", _proportional(1.0, "Nmm-3"))
SHEAR_STRESS: Final = CaamlUnits("Nmm-2", _proportional(1.0, "Nmm-2"))
