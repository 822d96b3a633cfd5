"""Snow as the force laws need it, with where its numbers come from."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TypeAlias

from ..errors import ParameterError

Interval: TypeAlias = tuple[float, float]


@dataclass(frozen=True, slots=True)
class SnowProperties:
    """Contact parameters of one snow, in SI. Neither number has a default.

    Attributes
    ----------
    snow_hardness
        H_V (N/m³); 0.04-90 N/mm³ on ski slopes (Mössner and others 2013).
    failure_shear_stress
        S_f (N/m²), or None where it was not measured; 0.04-0.40 N/mm² on ski slopes (ibid.).
    source
        Where the numbers come from, in words: "given as numbers", a file and site, a publication.
    snow_hardness_interval, failure_shear_stress_interval
        95 % intervals (low, high) of the two values where they are means over experiments: of the geometric mean of
        H_V and of the mean of S_f, not of a single place on the snow. None where there are fewer than two
        experiments or the source gives none.

    Examples
    --------
    A snow with numbers of one's own: 0.2 N/mm³ and 0.35 N/mm².

    >>> from skisnow.units import N_PER_MM2, N_PER_MM3
    >>> snow = SnowProperties(0.2 * N_PER_MM3, 0.35 * N_PER_MM2, source="given as numbers")
    >>> snow.snow_hardness
    200000000.0
    """

    snow_hardness: float
    failure_shear_stress: float | None
    source: str
    snow_hardness_interval: Interval | None = None
    failure_shear_stress_interval: Interval | None = None

    def __post_init__(self) -> None:
        for name, value in (("H_V", self.snow_hardness), ("S_f", self.failure_shear_stress)):
            if value is not None and not (math.isfinite(value) and value > 0):
                raise ParameterError(f"{name} is {value!r}; a snow needs a finite value above 0")
