"""Physical constants and limits, each with its source."""

from typing import Final

STANDARD_GRAVITY: Final = 9.81
"""Acceleration of gravity in m/s² (modelling assumption: the value the skiing literature computes with)."""

ICE_DENSITY: Final = 917.0
"""Density of ice at 0 °C in kg/m³ (Mössner and others 2013, introduction): no snow is denser."""

ZERO_CELSIUS: Final = 273.15
"""0 °C in K (exact: the definition of the degree Celsius)."""

CONFIDENCE: Final = 0.95
"""Coverage that every interval of this package claims."""
