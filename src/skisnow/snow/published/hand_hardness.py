"""Hand hardness of snow from the penetration resistance of a SnowMicroPen, and from the density of a sample.

The hand hardness index of the international classification (Fierz and others 2009) is 1 for snow that a fist can
penetrate (F), 2 for four fingers (4F), 3 for one finger (1F), 4 for a pencil (P), 5 for a knife (K), and 6 for ice (I).

* Van Herwijnen and Pielmeier (2016, Proc. Int. Snow Science Workshop): eight pairs of index and resistance. Pairs and
  fit (least squares of the index) are those of snowmicropyn 1.4.0, the program of the instrument's makers.
* Geldsetzer and Jamieson (2000, Proc. Int. Snow Science Workshop, 121-127): ρ = 154 + 1.51 h^3.15 for dry snow of
  rounded grains, fitted to natural snow of hand hardness F- to K+. That groomed snow consists of rounded grains is an
  assumption.

Notes
-----
None was fitted to groomed snow, and none relates the index to H_V.
"""

from __future__ import annotations

import math
from typing import Final

from ..._support.messages import Message
from ..._support.units import MM

RESISTANCE_SOURCE: Final = Message("van Herwijnen and Pielmeier 2016")
PAIRS: Final = (
    (1.0, 4.9303), (1.5, 11.1914), (2.0, 17.6419), (2.5, 37.5721),
    (3.0, 49.8849), (3.5, 104.0583), (4.0, 124.8842), (5.0, 314.3845),
)  # fmt: skip
"""Hand hardness index and penetration resistance (kPa)."""
RESISTANCE_RANGE: Final = (1e3 * PAIRS[0][1], 1e3 * PAIRS[-1][1])
"""Penetration resistance of the pairs (Pa)."""
TIP_AREA: Final = 19.6 * MM**2
"""Cross-section of the tip in the fit (m²)."""
INDEX_AT_1_N, EXPONENT = 2.780171583411649, 0.341486204481987

DENSITY_SOURCE: Final = Message("Geldsetzer and Jamieson 2000, rounded grains")
INTERCEPT, SLOPE, POWER = 154.0, 1.51, 3.15
INDEX_RANGE: Final = (2 / 3, 16 / 3)
"""F- to K+."""

_CLASSES: Final = ("F", "4F", "1F", "P", "K", "I")


def index_from_resistance(resistance: float) -> float:
    """Hand hardness index from the penetration resistance (Pa), by a power law; NaN outside of the fitted `PAIRS`.

    >>> round(index_from_resistance(100e3), 2)
    3.5
    """
    if not RESISTANCE_RANGE[0] <= resistance <= RESISTANCE_RANGE[1]:
        return math.nan
    return float(INDEX_AT_1_N * (resistance * TIP_AREA) ** EXPONENT)


def index_from_density(snow_density: float) -> float:
    """Hand hardness index from the density (kg/m³) of dry snow of rounded grains; NaN outside of F- to K+.

    >>> round(index_from_density(300.0), 2), index_from_density(500.0)
    (4.27, nan)
    """
    if snow_density <= INTERCEPT:
        return math.nan
    index = ((snow_density - INTERCEPT) / SLOPE) ** (1.0 / POWER)
    return index if INDEX_RANGE[0] <= index <= INDEX_RANGE[1] else math.nan


def code_of(index: float) -> str:
    """Code of a hand hardness index, to the nearest third of a class.

    >>> code_of(3.4), code_of(4.0), code_of(4.6)
    ('1F+', 'P', 'K-')
    """
    thirds = round(3.0 * index)
    number = (thirds + 1) // 3
    return _CLASSES[number - 1] + ("-", "", "+")[thirds - 3 * number + 1]
