"""Snow as the force laws need it, with where its numbers come from."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias

from ..errors import ParameterError
from ..units import N_PER_MM2, N_PER_MM3

Interval: TypeAlias = tuple[float, float]


@dataclass(frozen=True, slots=True)
class SnowProperties:
    """Contact parameters of one snow, in SI.

    Attributes
    ----------
    snow_hardness
        H_V (N/m³); 0.04-90 N/mm³ on ski slopes (Mössner and others 2013).
    failure_shear_stress
        S_f (N/m²), or None where it was not measured; 0.04-0.40 N/mm² on ski slopes (ibid.).
    source
        Where the numbers come from, in words.
    snow_hardness_interval, failure_shear_stress_interval
        95 % intervals of the values as means of this snow, or None.
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


def snow_from_results(path: str | Path, *, site: str | None = None) -> SnowProperties:
    """Read the snow of an analysed campaign from its results.json.

    H_V is the geometric mean over the used penetration experiments, S_f the mean over the used shear experiments, of
    one site or of all. No interval is attached: the scatter between experiments is in the file itself.

    Raises
    ------
    ParameterError
        The file holds no used penetration experiment of that site; the message names the sites it has.
    """
    results: dict[str, Any] = json.loads(Path(path).read_text(encoding="utf-8"))
    hardness = _used(results["penetration"]["experiments"], "H_V_N_per_mm3", site)
    stress = _used(results["shear"]["experiments"], "S_f_N_per_mm2", site)
    if not hardness:
        sites = sorted({row["site"] for row in results["penetration"]["experiments"] if row["used"]})
        raise ParameterError(f"{path} has no used penetration experiment of site {site!r}; it has {sites}")
    H_V = math.exp(math.fsum(map(math.log, hardness)) / len(hardness))
    return SnowProperties(
        snow_hardness=H_V * N_PER_MM3,
        failure_shear_stress=math.fsum(stress) / len(stress) * N_PER_MM2 if stress else None,
        source=f"{path}, {'all sites' if site is None else 'site ' + site}: {len(hardness)} penetration and "
        f"{len(stress)} shear experiments",
    )


def _used(rows: list[dict[str, Any]], key: str, site: str | None) -> list[float]:
    return [row[key] for row in rows if row["used"] and row[key] is not None and site in (None, row["site"])]
