"""Laws that nobody but these tests knows."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from skisnow._support.arrays import FloatArray
from skisnow.forces.penetration import PointLaw
from skisnow.forces.shear import ShearLaw


@dataclass(frozen=True)
class Power(PointLaw):
    """p = a εⁿ; from ε_max down along a line that is `unloading_ratio` times as steep as the chord, to nothing."""

    factor: float
    exponent: float
    unloading_ratio: float = 1.0

    def virgin(self, depth: FloatArray) -> FloatArray:
        return self.factor * np.maximum(depth, 0.0) ** self.exponent

    def stress(self, depth: npt.ArrayLike, deepest: npt.ArrayLike) -> FloatArray:
        reached = self.deepest_after(depth, deepest)
        share = np.divide(depth, reached, out=np.zeros_like(reached), where=reached > 0.0)
        return np.maximum(self.virgin(reached) * (1.0 - self.unloading_ratio * (1.0 - share)), 0.0)

    def residual_depth(self, deepest: npt.ArrayLike) -> FloatArray:
        return np.asarray(deepest, float) * (1.0 - 1.0 / self.unloading_ratio)

    def stored_energy(self, depth: npt.ArrayLike, deepest: npt.ArrayLike) -> FloatArray:
        return np.zeros(np.broadcast_shapes(np.shape(depth), np.shape(deepest)))  # a carve asks for none

    def lost_energy(self, deepest: npt.ArrayLike) -> FloatArray:
        return np.zeros(np.shape(deepest))


@dataclass(frozen=True)
class Deepening(ShearLaw):
    """S_f grows from one at the surface by as much with each `doubling` (m) of depth."""

    at_surface: float
    doubling: float

    def _stress(self, depth: FloatArray, angle: FloatArray) -> FloatArray:  # noqa: ARG002
        return self.at_surface * (1.0 + depth / self.doubling)


@dataclass(frozen=True)
class Pushing(Deepening):
    """The same with a thrust, a share of the strength."""

    share: float = 0.3

    def thrust_force(
        self, edge_depth: npt.ArrayLike, edge_length: npt.ArrayLike, edge_angle: npt.ArrayLike
    ) -> FloatArray:
        return self.share * self.failure_force(edge_depth, edge_length, edge_angle)
