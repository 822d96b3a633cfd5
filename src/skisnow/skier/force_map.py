"""Force across a ski that slides sideways: c S_f √(2 L N tan ϑ/H_V), and the edge angle that gives a force."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..scenario import Scenario

LEAST_LOAD = 20.0
"""Load of a ski (N) below which its edge tells nothing (modelling assumption)."""


@dataclass(frozen=True, slots=True)
class ForceMap:
    """Model of ski and snow that a skier assumes.

    hardness: H_V (N/m³).
    strength: S_f (N/m²).
    length: running length of the ski (m).
    """

    hardness: float
    strength: float
    length: float

    @classmethod
    def of(cls, scenario: Scenario) -> ForceMap:
        """Values of a scenario: the skier's assumed ones, or those of the snow where they are 0."""
        snow, skier = scenario.contact.snow, scenario.skier
        assert skier is not None
        return cls(
            skier.assumed_hardness or snow.snow_hardness,
            skier.assumed_strength or snow.failure_shear_stress or 0.0,
            scenario.ski.running_length,
        )

    def force(self, edge: float, load: float) -> float:
        """Force (N) across a ski with an edge angle (rad) under a load (N), by the formula with c = 1."""
        steep = math.tan(min(abs(edge), 1.5))
        return self.strength * math.sqrt(2.0 * self.length * max(load, 0.0) * steep / self.hardness)

    def edge(self, force: float, loads: tuple[float, ...], grip: float) -> float:
        """Edge angle (rad) at which skis under these loads (N) hold a force (N) together, with the grip c."""
        held = grip * max(self.strength, 1.0) * sum(math.sqrt(max(load, LEAST_LOAD)) for load in loads)
        return math.atan((force / held) ** 2 * self.hardness / (2.0 * self.length))
