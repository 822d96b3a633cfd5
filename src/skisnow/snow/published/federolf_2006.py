"""Federolf, JeanRichard, Fauve, Lüthi, Rhyner and Dual (2006), Cold Reg. Sci. Technol. 46: a base pressed into snow.

They report the mean pressure normal to the ski base, p = A e + B, for three snows. Mössner and others (2013) convert
it: A = H_V cos²ϑ / 2 and B = S_f sin²ϑ.

Notes
-----
The 2013 paper does not print the edge angle it converted with. Only 54.98° to 55.17° reproduces all six of its printed
values; 55° is used here.
"""

from __future__ import annotations

import math
from typing import Final

from ..._support.messages import Message
from ..._support.units import N_PER_MM2, N_PER_MM3
from ..properties import SnowProperties

SOURCE: Final = Message("Federolf and others 2006, converted as in Mössner and others 2013 at 55°")
CONVERSION_ANGLE: Final = math.radians(55.0)
"""Edge angle ϑ of the conversion (rad): inferred, see Notes."""

NAMES: Final = {
    "race-piste": Message("well-prepared race piste"),
    "recreational-piste": Message("compact recreational piste"),
    "spring-snow": Message("spring snow"),
}
"""The paper's snow by the name that `skisnow.snow.from_results` takes."""

PRESSURE_LAWS: Final = {
    "race-piste": (0.034, 0.35),
    "recreational-piste": (0.026, 0.058),
    "spring-snow": (0.0036, 0.063),
}
"""A (N/mm³) and B (N/mm²) of p = A e + B by the same names."""


def converted(pressure_slope: float, pressure_offset: float, edge_angle: float) -> tuple[float, float]:
    """Convert p = A e + B to H_V = 2 A / cos²ϑ and S_f = B / sin²ϑ, in the same units; ϑ in rad, 0 < ϑ < π/2.

    >>> H_V, S_f = converted(0.034, 0.35, math.radians(55))
    >>> round(H_V, 2), round(S_f, 2)
    (0.21, 0.52)
    """
    return 2.0 * pressure_slope / math.cos(edge_angle) ** 2, pressure_offset / math.sin(edge_angle) ** 2


def named_snows() -> dict[str, SnowProperties]:
    """The three snows by the names of `skisnow.snow.from_results`, converted at 55°."""
    by_name: dict[str, SnowProperties] = {}
    for name, law in PRESSURE_LAWS.items():
        H_V, S_f = converted(*law, CONVERSION_ANGLE)
        source = Message("{source}: {snow}", source=SOURCE, snow=NAMES[name])
        by_name[name] = SnowProperties(H_V * N_PER_MM3, S_f * N_PER_MM2, source)
    return by_name
