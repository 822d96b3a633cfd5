"""The used experiments as columns, with the snow they were made on: what regressions and comparisons start from.

Columns carry their unit in their name, because the regressions are done in the units that the paper prints.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from .._support.display import ShownFields
from .._support.units import MM, N_PER_MM2, N_PER_MM3

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ..campaign.records import Campaign, PenetrationTests, ShearTests
    from .snow_micro_pen import SnowMicroPenAnalysis

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]

HARDNESS_KEY = "H_V_N_per_mm3"
STRESS_KEY = "S_f_N_per_mm2"
ANGLE_KEY = "edge_angle_rad"
DENSITY_KEY = "snow_density_kg_per_m3"
DROP_CONE_KEY = "drop_cone_depth_mm"
PEN_FORCE_KEY = "smp_mean_force_N"
PEN_DENSITY_KEY = "smp_snow_density_kg_per_m3"


@dataclass(frozen=True, repr=False)
class Observations(ShownFields):
    """Columns of one kind of experiment (NaN: not known), the site and the spot (``""``: none) of each."""

    columns: Mapping[str, FloatArray]
    site: tuple[str, ...]
    spot: tuple[str, ...]

    def known(self, key: str) -> tuple[FloatArray, tuple[str, ...]]:
        """The known values of a column and their sites."""
        finite = np.isfinite(self.columns[key])
        return self.columns[key][finite], tuple(self.site[i] for i in np.flatnonzero(finite).tolist())


def penetration_observations(
    campaign: Campaign, hardness: FloatArray, used: BoolArray, pen: SnowMicroPenAnalysis | None = None
) -> Observations:
    """The used penetration experiments; ``hardness`` is H_V of all of them in N/m³, ``pen`` what recordings say."""
    keys = (HARDNESS_KEY, ANGLE_KEY, DENSITY_KEY, DROP_CONE_KEY)
    tests = campaign.penetration
    if tests is None:
        return _nothing(*keys, *((PEN_FORCE_KEY, PEN_DENSITY_KEY) if pen else ()))
    own = {HARDNESS_KEY: hardness / N_PER_MM3}
    if pen is not None:
        own[PEN_FORCE_KEY] = pen.at(tests.site, tests.spot, pen.mean_force)
        own[PEN_DENSITY_KEY] = pen.at(tests.site, tests.spot, pen.snow_density)
    return _observations(campaign, tests, own, used)


def shear_observations(campaign: Campaign, stress: FloatArray, used: BoolArray) -> Observations:
    """The used shear experiments; ``stress`` is S_f of all of them in N/m²."""
    if campaign.shear is None:
        return _nothing(STRESS_KEY, ANGLE_KEY, DENSITY_KEY, DROP_CONE_KEY)
    return _observations(campaign, campaign.shear, {STRESS_KEY: stress / N_PER_MM2}, used)


def spot_observations(penetration: Observations, shear: Observations) -> Observations:
    """One point for each spot with both: geometric mean of H_V and mean of S_f over its used experiments."""
    hardness = _by_spot(penetration, np.log(penetration.columns[HARDNESS_KEY]))
    stress = _by_spot(shear, shear.columns[STRESS_KEY])
    both = [key for key in hardness if key in stress]
    return Observations(
        {
            HARDNESS_KEY: np.array([np.exp(hardness[key]) for key in both]),
            STRESS_KEY: np.array([stress[key] for key in both]),
        },
        tuple(site for site, _ in both),
        tuple(spot for _, spot in both),
    )


def _observations(
    campaign: Campaign, tests: PenetrationTests | ShearTests, own: dict[str, FloatArray], used: BoolArray
) -> Observations:
    density = campaign.density.site_means() if campaign.density else {}
    cone = campaign.drop_cone.site_means() if campaign.drop_cone else {}
    columns = own | {
        ANGLE_KEY: tests.edge_angle,
        DENSITY_KEY: _own_or_site(tests.snow_density, tests.site, density),
        DROP_CONE_KEY: _own_or_site(tests.drop_cone_depth, tests.site, cone) / MM,
    }
    chosen = np.flatnonzero(used).tolist()
    return Observations(
        {key: column[used] for key, column in columns.items()},
        tuple(tests.site[i] for i in chosen),
        tuple(tests.spot[i] for i in chosen),
    )


def _own_or_site(own: FloatArray, site: tuple[str, ...], means: Mapping[str, float]) -> FloatArray:
    """An experiment's own value wins; else its site's mean; else NaN: it takes no part."""
    of_site = np.array([means.get(name, np.nan) for name in site])
    return np.where(np.isfinite(own), own, of_site)


def _by_spot(data: Observations, values: FloatArray) -> dict[tuple[str, str], float]:
    collected: dict[tuple[str, str], list[float]] = {}
    for site, spot, value in zip(data.site, data.spot, values.tolist(), strict=True):
        if spot:
            collected.setdefault((site, spot), []).append(value)
    return {key: float(np.mean(found)) for key, found in collected.items()}


def _nothing(*keys: str) -> Observations:
    return Observations({key: np.zeros(0) for key in keys}, (), ())
