"""Snow in layers at one place: hard snow under soft, snow of finite depth, or a measured profile."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np
import numpy.typing as npt

from ..._support.arrays import FloatArray
from ..._support.errors import ParameterError
from ..parameter_checks import ABOVE_ZERO, NOT_BELOW_ZERO
from .law import DeepeningPoint


@dataclass(frozen=True, slots=True)
class LayeredPoint(DeepeningPoint):
    """p = H_V ε (1 + γ' ε) down to the depth d of the upper layer, below it grows by H_2 with the depth.

    * Virgin loading, ε ≥ ε_max: p = q(ε) = H_V ε (1 + γ' ε) to d, then q(d) + H_2 (ε - d); ε_max becomes ε.
    * Below, ε < ε_max: p = max(0, q(ε_max) - k_u (ε_max - ε)), k_u = unloading_ratio · (steepest q' up to ε_max).

    Attributes
    ----------
    snow_hardness
        H_V (N/m³) at the surface.
    unloading_ratio
        k_u over the steepest growth of the pressure so far, ≥ 1 and finite.
    layer_depth
        d (m), > 0: where the lower layer begins.
    lower_hardness
        H_2 (N/m³), > 0: growth of the pressure in the lower layer. Ground under snow: far above H_V.
    hardness_growth
        γ' (1/m), ≥ 0: growth of the hardness with depth in the upper layer, γ/e₇ of a campaign.

    See Also
    --------
    skisnow.forces.penetration.HypoplasticPoint

    Notes
    -----
    Range: none is known. Equal layers give `HypoplasticPoint`. The upper part is the law by which a campaign estimates
    growing hardness; that the lower layer adds to the pressure at its top is our choice. A crust that breaks is not
    described: the pressure never falls with depth. Source: Mössner and others (2013) for H_V; the layers are ours.

    References
    ----------
    Mössner, Innerhofer, Schindelwig, Kaps, Schretter and Nachbauer (2013), "Measurement of mechanical properties of
    snow for simulation of skiing", J. Glaciol.

    Examples
    --------
    0.1 N/mm³ on 1 N/mm³ from 5 mm on: 0.5 N/mm² at the border, 2.5 N/mm² 2 mm below it.

    >>> snow = LayeredPoint(0.1e9, 10.0, layer_depth=5e-3, lower_hardness=1e9)
    >>> [round(float(p)) for p in snow.stress([0.002, 0.005, 0.007], 0.0)]
    [200000, 500000, 2500000]
    """

    snow_hardness: Annotated[float, ABOVE_ZERO]
    unloading_ratio: float
    layer_depth: Annotated[float, ABOVE_ZERO]
    lower_hardness: Annotated[float, ABOVE_ZERO]
    hardness_growth: Annotated[float, NOT_BELOW_ZERO] = 0.0

    @property
    def bends(self) -> tuple[float, ...]:
        """Depth (m) above 0 at which the stress of first loading bends: the border of the layers."""
        return (self.layer_depth,)

    def _loading(self, deepest: npt.ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Pressure q (N/m²), work ∫q dε (J/m²) and k_u (N/m³) at maximum depths (m)."""
        deepest = np.maximum(np.asarray(deepest, float), 0.0)
        top, hardness, growth = np.minimum(deepest, self.layer_depth), self.snow_hardness, self.hardness_growth
        below = deepest - top
        at_top = hardness * top * (1.0 + growth * top)
        work = hardness * top**2 * (0.5 + growth * top / 3.0) + below * (at_top + 0.5 * self.lower_hardness * below)
        steepest = hardness * (1.0 + 2.0 * growth * top)
        steepest = np.where(below > 0.0, np.maximum(steepest, self.lower_hardness), steepest)
        unloading: FloatArray = self.unloading_ratio * steepest
        return np.asarray(at_top + self.lower_hardness * below), np.asarray(work), unloading


@dataclass(frozen=True, slots=True)
class ProfilePoint(DeepeningPoint):
    """Snow in layers: from the top of a layer on, the pressure of virgin snow grows with its share of H_V.

    Attributes
    ----------
    snow_hardness
        H_V (N/m³) of share 1.
    unloading_ratio
        k_u over the steepest growth of the pressure so far, ≥ 1 and finite.
    tops
        Depths (m) at which the layers begin, rising from 0.
    shares
        Hardness of each layer over H_V, > 0.

    See Also
    --------
    skisnow.forces.penetration.LayeredPoint

    Notes
    -----
    Range: none is known. Equal shares give `HypoplasticPoint`, two layers `LayeredPoint`. A crust that breaks is not
    described. Source: Mössner and others (2013) for H_V; that layers add up is ours (modelling assumption).

    References
    ----------
    Mössner, Innerhofer, Schindelwig, Kaps, Schretter and Nachbauer (2013), "Measurement of mechanical properties of
    snow for simulation of skiing", J. Glaciol.

    Examples
    --------
    >>> snow = ProfilePoint(0.1e9, 10.0, (0.0, 0.005), (1.0, 10.0))
    >>> [round(float(p)) for p in snow.stress([0.002, 0.005, 0.007], 0.0)]
    [200000, 500000, 2500000]
    """

    snow_hardness: Annotated[float, ABOVE_ZERO]
    unloading_ratio: float
    tops: tuple[float, ...]
    shares: Annotated[tuple[float, ...], ABOVE_ZERO]

    def _check_further(self) -> None:
        """Reject layers whose tops do not rise from 0, or that are not as many as the shares."""
        DeepeningPoint._check_further(self)
        if len(self.tops) != len(self.shares) or self.tops[0] != 0.0 or np.any(np.diff(self.tops) <= 0.0):
            raise ParameterError(
                "ProfilePoint: tops are {tops}; they must rise from 0, one for each of {count} shares"
            ).tag("out_of_order", tops=self.tops, count=len(self.shares))

    @property
    def bends(self) -> tuple[float, ...]:
        """Depths (m) above 0 at which the stress of first loading bends: the borders of the layers."""
        return self.tops[1:]

    def _loading(self, deepest: npt.ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Pressure q (N/m²), work ∫q dε (J/m²) and k_u (N/m³) at maximum depths (m)."""
        deepest = np.maximum(np.asarray(deepest, float), 0.0)
        tops, growth = np.array(self.tops), self.snow_hardness * np.array(self.shares)
        thick = np.diff(tops)
        at_top = np.concatenate([[0.0], np.cumsum(growth[:-1] * thick)])
        work = np.concatenate([[0.0], np.cumsum((at_top[:-1] + 0.5 * growth[:-1] * thick) * thick)])
        layer = np.maximum(np.searchsorted(tops, deepest, side="left") - 1, 0)
        below = deepest - tops[layer]
        steepest = np.maximum.accumulate(growth)[layer]
        loaded: FloatArray = np.asarray(at_top[layer] + growth[layer] * below)
        spent: FloatArray = np.asarray(work[layer] + (at_top[layer] + 0.5 * growth[layer] * below) * below)
        return loaded, spent, np.asarray(self.unloading_ratio * steepest)
