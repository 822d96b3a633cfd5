"""Lengths of a degree on WGS84 by the textbook's series, apart from any formula of the package."""

import math


def north(latitude_deg: float) -> float:
    """Metres in a degree of latitude at height 0 (series of the meridian's radius, good to a centimetre)."""
    angle = math.radians(latitude_deg)
    return 111132.954 - 559.822 * math.cos(2 * angle) + 1.175 * math.cos(4 * angle)


def east(latitude_deg: float) -> float:
    """Metres in a degree of longitude at height 0 (series of the parallel's radius, good to a centimetre)."""
    angle = math.radians(latitude_deg)
    return 111412.84 * math.cos(angle) - 93.5 * math.cos(3 * angle) + 0.118 * math.cos(5 * angle)
