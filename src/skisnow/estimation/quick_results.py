"""Quick results: each experiment's row of results.json, without the fits over all of them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from .hardness import DEFINITIONS, ReadingUncertainty, hardness, hardness_at_largest_load
from .readings import readings_of
from .results import penetration_experiments, shear_experiments, without_nan
from .screening import screened_both
from .shear_displacement import shear_displacement
from .shear_stress import shear_stress
from .unloading import NOT_FALLING, unloading

if TYPE_CHECKING:
    from ..campaign.records import Campaign
    from ..geometry import GeometryForm
    from .results import Json
    from .screening import Screened

FloatArray = npt.NDArray[np.float64]


def experiment_results(
    campaign: Campaign, *, geometry: GeometryForm = "extended", screened: tuple[Screened, Screened] | None = None
) -> Json:
    """The experiments of a campaign as results.json has them, without its model table and regressions.

    Parameters
    ----------
    campaign
        As it is now; it may be unfinished.
    geometry
        As in `skisnow.estimation.analyse`.
    screened
        What `screened_both` gives, where that is at hand.

    Returns
    -------
    ``{"penetration": {"experiments": [...]}, "shear": {"experiments": [...]}}``, number for number as in results.json.
    """
    penetration, shear = [], []
    pressed, cut = screened or screened_both(campaign, geometry=geometry)
    if (tests := campaign.penetration) is not None:
        readings = readings_of(tests, campaign.tools, geometry=geometry)
        uncertainty = ReadingUncertainty(campaign.depth_uncertainty or 0.0, campaign.load_uncertainty or 0.0)
        found = {symbol: hardness(readings, definition, uncertainty) for symbol, definition in DEFINITIONS.items()}
        back = unloading(tests, readings, found["H_V"], uncertainty, pressed.flags[NOT_FALLING])
        penetration = penetration_experiments(tests, pressed, found, back)
    if (sheared := campaign.shear) is not None:
        shear = shear_experiments(sheared, cut, shear_stress(campaign, sheared), shear_displacement(campaign, sheared))
    answer: Json = without_nan({"penetration": {"experiments": penetration}, "shear": {"experiments": shear}})
    return answer


def experiment_hardness(campaign: Campaign, *, geometry: GeometryForm = "extended") -> FloatArray:
    """H_V of each penetration experiment (N/m³), NaN where there is none; (m,)."""
    if campaign.penetration is None:
        return np.zeros(0)
    readings = readings_of(campaign.penetration, campaign.tools, geometry=geometry)
    return hardness_at_largest_load(readings, DEFINITIONS["H_V"])
