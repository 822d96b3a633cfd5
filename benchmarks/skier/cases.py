"""Cases of the benchmark of the skier: slope, gates, speed and nominal snow."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Final

from scipy.stats import qmc

from skisnow import Course, Gate, Scenario, load_scenario

RACE, HARD = (0.21, 0.52), (1.0, 0.52)
"""H_V (N/mm³) and S_f (N/mm²) of a race piste, and of harder snow."""
ACROSS: Final = 0.4
"""How far beyond a pole the start's line is laid out (m)."""


@dataclass(frozen=True, slots=True)
class Case:
    """Gates on a plane.

    Attributes
    ----------
    name
        In the table.
    slope
        (°).
    down, across
        Between gates (m).
    speed
        At the start, and the one braked to (m/s).
    snow
        Nominal H_V and S_f.
    gates
        How many.
    duration
        (s).
    ski
        Of the catalogue.
    """

    name: str
    slope: float
    down: float
    across: float
    speed: float
    snow: tuple[float, float] = RACE
    gates: int = 20
    duration: float = 120.0
    ski: str = "slalom"

    def scenario(self, start: Start) -> Scenario:
        """From one start, at the edge change before the first gate, along the line."""
        half = 0.5 * self.across
        gates = tuple(
            Gate(
                name=str(i + 1),
                turning=((i + 0.5) * self.down, -half if i % 2 else half),
                side="right" if i % 2 else "left",
            )
            for i in range(self.gates)
        )
        hardness, strength = self.snow
        base = load_scenario(
            "slalom-15deg",
            changes={
                "solver.method": "fast",
                "slope.angle_deg": self.slope,
                "ski.name": self.ski,
                "snow.H_V_N_per_mm3": hardness * start.hardness,
                "snow.S_f_N_per_mm2": strength * start.strength,
                "skier.assumed_H_V_N_per_mm3": hardness,
                "skier.assumed_S_f_N_per_mm2": strength,
                "skier.brakes_to_m_per_s": self.speed,
                "run.duration_s": self.duration,
            },
        )
        heading = math.atan((half + ACROSS) * math.pi / self.down)
        begins = replace(base.start, x=0.0, y=start.aside, heading=heading, speed=self.speed * start.speed)
        return base.with_(course=Course(gates=gates), start=begins)


@dataclass(frozen=True, slots=True)
class Start:
    """A disturbed start: speed, H_V and S_f over the nominal ones, and how far it is beside the line (m)."""

    speed: float = 1.0
    aside: float = 0.0
    hardness: float = 1.0
    strength: float = 1.0

    @property
    def force(self) -> float:
        """Force of a skid over that on the nominal snow."""
        return self.strength / math.sqrt(self.hardness)


CASES: Final = (
    *(Case(f"slalom 10 m, {slope}°", slope, 10.0, 3.0, 5.5) for slope in (10, 15, 19)),
    *(Case(f"slalom 13 m, {slope}°", slope, 13.0, 3.0, 7.5) for slope in (10, 15, 19)),
    Case("slalom 13 m, 15°, hard", 15, 13.0, 3.0, 7.5, HARD),
    Case("slalom 13 m, 25°", 25, 13.0, 3.0, 9.0),
    *(Case(f"giant slalom 25 m, {slope}°", slope, 25.0, 6.0, 11.0) for slope in (15, 19)),
    *(
        Case(f"linked turns, {slope}°", slope, 13.0, 3.0, speed, gates=60, duration=60.0)
        for slope, speed in ((15, 7.0), (20, 8.0), (25, 9.0))
    ),
)


def starts(count: int, seed: int) -> list[Start]:
    """From one Sobol sequence: speed ±10 %, ±0.3 m, H_V by 0.5 to 2, S_f by 0.7 to 1.4 (log-uniform)."""
    rows = qmc.Sobol(4, seed=seed).random(2 ** math.ceil(math.log2(max(count, 2))))[:count]
    return [Start(0.9 + 0.2 * a, -0.3 + 0.6 * b, 0.5 * 4.0**c, 0.7 * 2.0**d) for a, b, c, d in rows.tolist()]
