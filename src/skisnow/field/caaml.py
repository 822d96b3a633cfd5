"""Snow pits from CAAML 6, the exchange format of avalanche services: ``.caaml``, ``.caaml.xml``.

Read are place, time, observer, layers with hand hardness and grains, densities, temperatures, penetrometer forces, and
H_V and S_f where skisnow wrote them. Everything else in a file is passed over.
"""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import TYPE_CHECKING, Final, NoReturn

import numpy as np

from ..errors import FieldDataError
from ..given import GivenError, plain_bytes, xml_tree
from ..units import CM, MM
from .problems import error
from .snow_pit import DepthTemperature, ForceProfile, LayerDensity, PlateValue, SnowLayer, SnowPit

if TYPE_CHECKING:
    from ..given import Element

MOST_BYTES: Final = 32 * 2**20
NAMESPACE: Final = re.compile(r"http://caaml\.org/Schemas/SnowProfileIACS/v6\.\d+(\.\d+)?")
OWN_NAMESPACE: Final = "urn:skisnow:caaml:1"
"""Of H_V and S_f in ``customData``."""
NIL: Final = ("", "inapplicable", "missing", "template", "unknown", "withheld", "n/a", "none")
"""Words for a value that is not there, which the standard allows in the place of any number."""
_FACTOR: Final = {"cm": CM, "mm": MM, "m": 1.0}


def read_caaml(path: str | Path) -> SnowPit:
    """Read a snow profile in CAAML 6.0 to 6.0.6.

    Returns
    -------
    SnowPit
        With depths from the surface down.

    Raises
    ------
    FieldDataError
        The file cannot be read, is no CAAML 6, declares entities, counts from the ground up without saying the height
        of the snow, or has a number that is none.
    """
    path = Path(path)
    try:
        root = xml_tree(plain_bytes(path, most_bytes=MOST_BYTES))
    except GivenError as failure:
        problem = error(
            "unreadable_file",
            path.name,
            row=failure.line,
            value=failure.what,
            allowed="a snow profile in CAAML 6",
            action="Export it again from the program that wrote it.",
        )
        raise FieldDataError([problem]) from failure
    return _Profile(path.name, root).pit()


class _Profile:
    """One file: finds and converts, and refuses by the names of its elements."""

    def __init__(self, file: str, root: Element) -> None:
        self._file = file
        self._root = root
        if root.name != "SnowProfile" or NAMESPACE.fullmatch(root.namespace) is None:
            found = f"{root.name} of {root.namespace or 'no namespace'}"
            self._refuse("SnowProfile", found, "SnowProfile of CAAML 6", "Export it as CAAML 6.")
        measured = root.child("snowProfileResultsOf", "SnowProfileMeasurements")
        if measured is None:
            self._refuse("snowProfileResultsOf", "nothing", "SnowProfileMeasurements", "The file holds no profile.")
        self._measured = measured
        height = self._height()
        self._from_ground = measured.attributes.get("dir", "top down") != "top down"
        if self._from_ground and height is None:
            action = "Add snowPackCond/hS, or export it top down."
            self._refuse("SnowProfileMeasurements", "bottom up", "top down, or the height of the snow", action)
        self._snow_height = height

    def _refuse(self, element: str, value: str, allowed: str, action: str) -> NoReturn:
        raise FieldDataError(
            [error("unreadable_file", self._file, column=element, value=value, allowed=allowed, action=action)]
        )

    def pit(self) -> SnowPit:
        """Everything that is read."""
        root, place = self._root, self._root.child("locRef")
        place = root if place is None else place
        latitude, longitude = self._position(place)
        return SnowPit(
            name=place.text_of("name") or root.attributes.get("id", ""),
            time=root.text_of("timeRef", "recordTime", "TimeInstant", "timePosition")
            or root.text_of("timeRef", "recordTime", "TimePeriod", "beginPosition"),
            observer=self._observer(),
            comment=root.text_of("metaData", "comment"),
            country=place.text_of("country"),
            region=place.text_of("region"),
            latitude_deg=latitude,
            longitude_deg=longitude,
            elevation=self._number(place, "validElevation", "ElevationPosition", "position"),
            aspect=self._word(place.text_of("validAspect", "AspectPosition", "position")),
            slope_angle_deg=self._number(place, "validSlopeAngle", "SlopeAnglePosition", "position"),
            snow_height=self._snow_height,
            air_temperature_C=self._number(self._measured, "weatherCond", "airTempPres"),
            layers=tuple(self._layer(each) for each in self._of("stratProfile", "Layer")),
            densities=tuple(self._density(each) for each in self._of("densityProfile", "Layer")),
            temperatures=tuple(self._temperature(each) for each in self._of("tempProfile", "Obs")),
            forces=tuple(self._forces(each) for each in self._measured.every("hardnessProfile")),
            snow_hardness=self._plate_value("snowHardness"),
            failure_shear_stress=self._plate_value("failureShearStress"),
        )

    def _of(self, profile: str, name: str) -> list[Element]:
        """The layers or observations of all profiles of a kind that hold them one by one."""
        return [each for found in self._measured.every(profile) for each in found.every(name)]

    def _height(self) -> float | None:
        pack = self._measured.child("snowPackCond", "hS", "Components")
        return None if pack is None else self._length(pack, "height")

    def _observer(self) -> str:
        source = self._root.child("srcRef")
        if source is None:
            return ""
        paths = (("Person", "name"), ("Operation", "contactPerson", "name"), ("Operation", "name"))
        return next(filter(None, (source.text_of(*path) for path in paths)), "")

    def _position(self, place: Element) -> tuple[float, float] | tuple[None, None]:
        text = place.text_of("pointLocation", "Point", "pos")
        if not text:
            return None, None
        both = [self._finite("pos", each) for each in text.split()[:2]]
        if len(both) != 2 or not (-90.0 <= both[0] <= 90.0 and -180.0 <= both[1] <= 180.0):
            self._refuse("pos", text, "latitude and longitude in degrees", "Correct the place.")
        return both[0], both[1]

    def _layer(self, layer: Element) -> SnowLayer:
        top, thickness = self._top_and_thickness(layer)
        hand, upper, lower = (self._word(layer.text_of(name)) for name in ("hardness", "hardnessTop", "hardnessBottom"))
        size = layer.child("grainSize")
        average = None if size is None else self._number(size, "Components", "avg", words=True)
        return SnowLayer(
            top=top,
            thickness=thickness,
            hardness=hand or upper or lower,
            grain_form=self._word(layer.text_of("grainFormPrimary")),
            grain_size=None if average is None else average * MM,
            comment=layer.text_of("metaData", "comment"),
            hardness_bottom=lower if upper and not hand else "",
        )

    def _density(self, layer: Element) -> LayerDensity:
        top, thickness = self._top_and_thickness(layer)
        return LayerDensity(top, self._required(layer, "density"), thickness)

    def _temperature(self, observed: Element) -> DepthTemperature:
        depth = self._required_length(observed, "depth")
        return DepthTemperature(self._down(depth), self._required(observed, "snowTemp"))

    def _forces(self, profile: Element) -> ForceProfile:
        method = self._word(profile.text_of("hardnessMetaData", "methodOfMeas"))
        rows = profile.text_of("Measurements", "tupleList").split()
        pairs = [[self._finite("tupleList", number) for number in row.split(",")] for row in rows]
        if any(len(pair) != 2 for pair in pairs):
            self._refuse("tupleList", rows[0], "pairs of depth and force", "Correct the list.")
        table = np.array(pairs, dtype=float).reshape(-1, 2)
        if not rows:
            layers = list(profile.every("Layer"))
            depths = np.array([self._top_and_thickness(each)[0] for each in layers], dtype=float)
            return ForceProfile(method, depths, np.array([self._required(each, "hardness") for each in layers]))
        return ForceProfile(method, table[:, 0] * CM, table[:, 1])

    def _plate_value(self, name: str) -> PlateValue | None:
        custom = self._measured.child("customData", name)
        if custom is None or custom.namespace != OWN_NAMESPACE:
            return None
        ends = [custom.attributes.get(end) for end in ("low", "high")]
        known = [self._finite(name, each) for each in ends if each is not None]
        interval = (known[0], known[1]) if len(known) == 2 else None
        count = round(self._finite(name, custom.attributes.get("n", "0")))
        return PlateValue(self._finite(name, custom.text), count, interval)

    def _top_and_thickness(self, layer: Element) -> tuple[float, float | None]:
        return self._down(self._required_length(layer, "depthTop")), self._length(layer, "thickness")

    def _down(self, value: float) -> float:
        """A depth from the surface, whichever way the profile counts."""
        return (self._snow_height or 0.0) - value if self._from_ground else value

    def _length(self, parent: Element, name: str) -> float | None:
        value, found = self._number(parent, name), parent.child(name)
        if value is None or found is None:
            return None
        unit = found.attributes.get("uom", "cm")
        if unit not in _FACTOR:
            self._refuse(name, unit, f"a unit among {', '.join(_FACTOR)}", "Correct the unit.")
        return value * _FACTOR[unit]

    def _required_length(self, parent: Element, name: str) -> float:
        value = self._length(parent, name)
        if value is None:
            self._refuse(name, "nothing", "a length", f"Give every {parent.name} its {name}.")
        return value

    def _required(self, parent: Element, name: str) -> float:
        value = self._number(parent, name)
        if value is None:
            self._refuse(name, "nothing", "a number", f"Give every {parent.name} its {name}.")
        return value

    def _number(self, parent: Element, *path: str, words: bool = False) -> float | None:
        text = parent.text_of(*path)
        if text.lower() in NIL or (words and not any(character.isdigit() for character in text)):
            return None
        return self._finite(path[-1], text)

    def _finite(self, element: str, text: str) -> float:
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            self._refuse(element, text.strip()[:80], "a finite number", "Correct the number.")
        return value

    def _word(self, text: str) -> str:
        return "" if text.lower() in NIL else text
