"""Results of each kind of experiment: the parts of an `Analysis`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .._support.display import Facts, Shown, amount, field_facts
from .campaign_model import CampaignModel
from .errors_in_depth import FittedHardness
from .hardness import Hardness
from .layering import GrowingHardness, SiteGrowth
from .model_choice import NestedRows
from .models import Model, ModelFit
from .readings import Readings
from .screening import Screened
from .seating import Seating
from .shear import ShearDisplacement, ShearStress, SiteDisplacement
from .unloading import SiteUnloading, Unloading
from .volume_factor import VolumeFactor

FloatArray = npt.NDArray[np.float64]


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
    site_growth: tuple[SiteGrowth, ...]
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
    site_displacement: tuple[SiteDisplacement, ...]

    def _facts(self) -> Facts:
        return Facts(used_of(self.screened))


def used_of(screened: Screened) -> str:
    """How many of the experiments take part, in words."""
    return f"{int(screened.used.sum())} of {len(screened.used)} experiments used"
