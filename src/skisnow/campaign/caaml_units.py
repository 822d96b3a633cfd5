"""Units of the quantities of CAAML, as programs write them into ``uom``."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from .._support.units import CM, DEGREE, MM, ZERO_CELSIUS

if TYPE_CHECKING:
    from collections.abc import Mapping

_FOOT: Final = 0.3048
_INCH: Final = 0.0254
_FAHRENHEIT: Final = 5.0 / 9.0
_MEANINGLESS: Final = re.compile(r"[\s^*·]")


@dataclass(frozen=True, slots=True)
class CaamlUnits:
    """Units of one kind of quantity.

    Attributes
    ----------
    standard
        Unit of a value without ``uom``: that of the CAAML standard.
    sizes
        Shift and factor of each unit: the result is (value + shift) × factor.
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


def _alike(factor: float, *names: str) -> dict[str, tuple[float, float]]:
    return dict.fromkeys(names, (0.0, factor))


_LENGTHS: Final = {
    **_alike(MM, "mm"),
    **_alike(CM, "cm"),
    **_alike(1.0, "m"),
    **_alike(1e3, "km"),
    **_alike(_INCH, "in", "inch"),
    **_alike(_FOOT, "ft", "feet"),
}
LENGTH: Final = CaamlUnits("cm", _LENGTHS)
ELEVATION: Final = CaamlUnits("m", _LENGTHS)
GRAIN_SIZE: Final = CaamlUnits("mm", _LENGTHS)
TEMPERATURE: Final = CaamlUnits(
    "degC",
    {
        **dict.fromkeys(("degC", "C", "°C", "Cel"), (0.0, 1.0)),
        **dict.fromkeys(("degF", "F", "°F"), (-32.0, _FAHRENHEIT)),
        **dict.fromkeys(("K", "degK"), (-ZERO_CELSIUS, 1.0)),
    },
)
DENSITY: Final = CaamlUnits(
    "kgm-3", {**_alike(1.0, "kgm-3", "kg/m3", "kg/m³"), **_alike(1e3, "gcm-3", "g/cm3", "g/cm³", "kgl-1", "kg/l")}
)
FORCE: Final = CaamlUnits("N", {**_alike(1.0, "N"), **_alike(1e3, "kN"), **_alike(1e-3, "mN")})
ANGLE: Final = CaamlUnits("deg", {**_alike(1.0, "deg", "°"), **_alike(1.0 / DEGREE, "rad")})
SNOW_HARDNESS: Final = CaamlUnits("Nmm-3", _alike(1.0, "Nmm-3"))
SHEAR_STRESS: Final = CaamlUnits("Nmm-2", _alike(1.0, "Nmm-2"))
