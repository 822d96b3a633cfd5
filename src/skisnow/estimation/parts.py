"""Results of each kind of experiment: the parts of an `Analysis`; seating of each series.

Seating: if the tool touches the snow at a gauge reading δ instead of 0, all depths of the series are δ too large: at
H_V = 10 N/mm³ and 45° a seating of 0.1 mm on 0.7 mm of depth already moves H_V by a third. Often the largest systematic
error.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .._support.arrays import FloatArray
from .._support.display import Facts, Shown, ShownFields, amount, field_facts
from .campaign_model import CampaignModel
from .comparisons import SiteValue
from .errors_in_depth import FittedHardness, VolumeFactor
from .hardness import Hardness
from .layering import GrowingHardness
from .model_choice import NestedRows
from .models import Model, ModelFit
from .readings import Readings
from .screening import Screened
from .shear import ShearDisplacement, ShearStress
from .unloading import SiteUnloading, Unloading

if TYPE_CHECKING:
    from .._support.arrays import FloatArray
    from .campaign_model import CampaignModel
    from .readings import Readings


@dataclass(frozen=True, repr=False)
class ModelTable(Shown):
    """The nine fitted rows with bootstrap intervals of a0, a1, b0, b1 by model ((4, 2) each); none where withheld."""

    fits: tuple[ModelFit, ...]
    intervals: dict[Model, FloatArray]

    def _facts(self) -> Facts:
        rows = tuple((fit.model.id, f"rmse {amount(fit.rmse, 'N')}") for fit in self.fits)
        return Facts(f"of {len(rows)} rows", rows)


@dataclass(frozen=True, repr=False)
class PenetrationAnalysis(Shown):
    """Results of the penetration experiments; arrays run over all m experiments, the table over the used ones.

    ``model`` is the campaign's model, ``hardness`` Eqn 1 of each definition by its symbol, ``fitted`` the hardness from
    all readings of a series, ``growing`` a hardness that grows with depth, ``unloading`` the estimates from readings
    while discs were taken off. ``table``, ``errors_in_depth``, ``volume_factor`` and ``selected`` are None where no
    experiment is used, ``selected`` also with too few series; ``warnings`` report this, and contain those of
    `fit_warnings`.
    """

    screened: Screened
    readings: Readings
    model: CampaignModel
    hardness: dict[str, Hardness]
    seating: Seating
    fitted: FittedHardness
    growing: GrowingHardness
    site_growth: tuple[SiteValue, ...]
    unloading: Unloading
    site_unloading: tuple[SiteUnloading, ...]
    table: ModelTable | None = None
    nested: tuple[NestedRows, ...] = ()
    selected: ModelFit | None = None
    errors_in_depth: ModelTable | None = None
    volume_factor: VolumeFactor | None = None
    warnings: tuple[str, ...] = ()

    def _facts(self) -> Facts:
        return field_facts(self, {}, title=used_of(self.screened))


@dataclass(frozen=True, repr=False)
class ShearAnalysis(Shown):
    """Results of the shear experiments, over all experiments."""

    screened: Screened
    stress: ShearStress
    displacement: ShearDisplacement
    site_displacement: tuple[SiteValue, ...]

    def _facts(self) -> Facts:
        return Facts(used_of(self.screened))


def used_of(screened: Screened) -> str:
    """Number of used experiments, in words."""
    return f"{int(screened.used.sum())} of {len(screened.used)} experiments used"


@dataclass(frozen=True, slots=True, repr=False)
class Seating(ShownFields):
    """Depth zero of m series: the tool touched at gauge reading ``offset``; true depth = reading - offset.

    Attributes
    ----------
    offset, interval
        δ (m) and its 95 % interval (m, 2), from `campaign_model`; NaN with fewer than two readings in contact.
    hardness_change
        Relative change of the largest-load H_V when δ is subtracted from its depth; NaN where no depth remains.
    """

    offset: FloatArray
    interval: FloatArray
    hardness_change: FloatArray


def seating(readings: Readings, model: CampaignModel) -> Seating:
    """Offset of each series, and the change of H_V of Eqn 1."""
    return Seating(model.offset, model.offset_interval, _hardness_change(readings, model.offset))


def _hardness_change(readings: Readings, offset: FloatArray) -> FloatArray:
    """V(e₇)/V(e₇ - δ) - 1: how the hardness of Eqn 1 moves when δ is taken off the depth."""
    depth = readings.penetration_depth[readings.largest]
    left = depth - offset
    corrected = readings.volume_of_series(np.where(left > 0, left, 0.0))
    volume = readings.displaced_volume[readings.largest]
    return np.divide(volume, corrected, out=np.full(volume.shape, np.nan), where=(left > 0) & (corrected > 0)) - 1.0
