"""Edge angle of a skier: its relation to turning, and to the force across a ski that slides sideways."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from ..scenario import Scenario
from ..scenario.skier import Skier

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


CARVING_SHARE: Final = 0.3
"""Share of the straightest carve's acceleration from which edges go over from a skid to a carve (found by trial)."""
BEYOND_LEAN: Final = math.radians(3.0)
"""Edge angle beyond the lean in a carve (rad): so that the ski holds, with the lean not known better."""
_MORE: Final = math.tan(BEYOND_LEAN)
SLOW_EDGE, BEYOND_CARVE = math.radians(60.0), math.radians(35.0)
"""Greatest edge angle of a slow carve, and of a faster one beyond its lean in balance (rad): edged by 66° at 5 m/s skis
brake by 1 m/s² more than by 45° (found by trial: two slaloms on measured slopes finish, with 66° neither does)."""


@dataclass(frozen=True, slots=True)
class Edges:
    """Map from an acceleration to the edge angle at which a carve reaches it.

    radius: radius of the sidecut (m).
    gravity: along the snow's normal (m/s²).
    softness: 2 S_f² L/H_V (N): a wedge of angle ϑ under the load N holds a side force of √(2 S_f² L tan ϑ/(H_V N))
        times that load.
    greatest: edge angle (rad).
    """

    radius: float
    gravity: float
    softness: float
    greatest: float

    @classmethod
    def of(cls, scenario: Scenario, gravity: float, skier: Skier) -> Edges:
        """Edges of a scenario's ski on the snow that its skier assumes."""
        snow, radius = ForceMap.of(scenario), scenario.ski.sidecut_radius_of_edge_line
        return cls(radius, gravity, 2.0 * snow.strength**2 * snow.length / snow.hardness, skier.greatest_edge)

    def carving_acceleration(self, speed: float) -> float:
        """Acceleration (m/s²) of a balanced carve at a speed (m/s), its lean as edge angle: sin ϑ = v²/(R_sc g)."""
        lean = math.asin(min(math.sin(self.greatest), speed**2 / (self.radius * self.gravity)))
        return speed**2 / (self.radius * math.cos(lean))

    def skidding(self, grip: float, load: float) -> float:
        """Edge angle (rad) that just holds this multiple of the load (N) of both skis sideways."""
        return math.atan(grip**2 * load / (2.0 * self.softness))

    def holding(self, load: float) -> float:
        """Largest side force of both skis over the load (N), at the edge angle of a carve in balance."""
        grip = 1.0
        for _ in range(60):  # the error halves at least
            grip = self._hold(grip, load)
        return grip

    def slips(self, grip: float, load: float) -> bool:
        """True if this multiple of the load (N) is more than a single ski would hold, edged for balance."""
        return abs(grip) > self._hold(abs(grip), load) / math.sqrt(2.0)

    def _hold(self, grip: float, load: float) -> float:
        """Largest side force over the load (N), at the edge angle that balances a side force of `grip` loads."""
        steep, rest = grip + _MORE, 1.0 - grip * _MORE  # of the tangent of a sum
        tangent = min(math.tan(self.greatest), steep / rest if rest > 0.0 else math.inf)
        return math.sqrt(2.0 * self.softness * tangent / load)

    def held(self, acceleration: float, slope: float, load: float) -> float:
        """Part of an acceleration to the left that the snow gives a carve (m/s²).

        acceleration: wanted, to the left (m/s²).
        slope: share of gravity along the slope that the skis hold in addition, to the left (m/s²).
        load: load of both skis (N).
        """
        wanted = (acceleration + slope) / self.gravity
        most = self._hold(abs(wanted), load)
        return acceleration if abs(wanted) <= most else math.copysign(most, wanted) * self.gravity - slope

    def angle(self, acceleration: float, grip: float, speed: float, load: float) -> float:
        """Edge angle (rad) for an acceleration to the left (m/s²) that needs this multiple of the load (N) sideways."""
        carving = min(math.atan(abs(grip)) + BEYOND_LEAN, self.greatest)
        skidding = min(self.skidding(grip, load), carving)
        share = abs(acceleration) * self.radius / speed**2
        x = min(1.0, max(0.0, (share - CARVING_SHARE) / (1.0 - CARVING_SHARE)))
        carved = max(carving, min(self.steepest(speed), math.acos(1.0 / max(1.0, share))))
        return math.copysign(skidding + (carved - skidding) * x * x * (3.0 - 2.0 * x), grip)

    def steepest(self, speed: float) -> float:
        """Greatest edge angle (rad) of a carve at a speed (m/s)."""
        lean = math.asin(min(1.0, speed**2 / (self.radius * self.gravity)))
        return min(self.greatest, max(SLOW_EDGE, lean + BEYOND_CARVE))
