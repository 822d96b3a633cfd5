"""Estimates of each penetration series: the campaign's model, the hardness, and the unloading."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from .._support.display import ShownFields
from .campaign_model import DEFAULT_PRIORS, CampaignModel
from .hardness import DEFINITIONS, Hardness, hardness, hardness_at_largest_load
from .readings import ReadingUncertainty
from .spread_groups import fit_in_groups
from .unloading import Unloading, unloading

if TYPE_CHECKING:
    from ..campaign.records import Campaign, PenetrationTests
    from .readings import Readings

BoolArray = npt.NDArray[np.bool_]


@dataclass(frozen=True, repr=False)
class SeriesEstimates(ShownFields):
    """Estimates of m series: the model, the hardness of each definition by its symbol, and the unloading."""

    model: CampaignModel
    hardness: dict[str, Hardness]
    unloading: Unloading


def reading_uncertainty(campaign: Campaign) -> ReadingUncertainty:
    """Standard uncertainties of a reading that the campaign states; 0 where it does not."""
    return ReadingUncertainty(campaign.depth_uncertainty or 0.0, campaign.load_uncertainty or 0.0)


def series_estimates(
    campaign: Campaign,
    tests: PenetrationTests,
    readings: Readings,
    *,
    counts: BoolArray | None = None,
    not_falling: BoolArray | None = None,
) -> SeriesEstimates:
    """Estimates of all series.

    Parameters
    ----------
    campaign, tests, readings
        The campaign, its penetration tests, and their readings.
    counts
        Mask of the series that the spreads are estimated from (default: all).
    not_falling
        Mask of the series whose unloading is omitted (default: none).
    """
    priors = DEFAULT_PRIORS if campaign.seating is None else replace(DEFAULT_PRIORS, seating=campaign.seating)
    model = fit_in_groups(
        readings,
        hardness_at_largest_load(readings, DEFINITIONS["H_V"]),
        reading_uncertainty(campaign),
        labels={"site": tests.site, "tool": tests.tool},
        counts=counts,
        priors=priors,
    )
    H = {symbol: hardness(readings, definition, model) for symbol, definition in DEFINITIONS.items()}
    bad = np.zeros(len(tests), dtype=np.bool_) if not_falling is None else not_falling
    return SeriesEstimates(model, H, unloading(tests, readings, H["H_V"], model, bad))
