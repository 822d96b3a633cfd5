"""Cases of the benchmark of the skier: slope, gates, speed and nominal snow."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt
from scipy.stats import qmc

from skisnow import Course, Gate, Profile, Scenario, load_scenario

FloatArray: TypeAlias = npt.NDArray[np.float64]

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
class Hybrid(Case):
    """Gates on the nominal snow, through which turns carve behind the fall line; `keys` of the skier."""

    keys: tuple[tuple[str, float], ...] = ()

    def scenario(self, start: Start) -> Scenario:
        """From one start, of which speed and place count."""
        base = Case.scenario(self, replace(start, hardness=1.0, strength=1.0))
        return base.with_(carves=True, brakes_to_m_per_s=4.0, **dict(self.keys))


@dataclass(frozen=True, slots=True)
class Straight:
    """Straight down 10° of race piste over a profile of heights above it; attributes like those of `Case`."""

    name: str
    speed: float
    over: Callable[[FloatArray], FloatArray]
    duration: float
    gates: int = 0

    def scenario(self, start: Start) -> Scenario:
        """From one start, 5 m before the profile."""
        hardness, strength = RACE
        base = load_scenario(
            "skier-10deg",
            changes={
                "solver.method": "fast",
                "snow.H_V_N_per_mm3": hardness * start.hardness,
                "snow.S_f_N_per_mm2": strength * start.strength,
                "skier.assumed_H_V_N_per_mm3": hardness,
                "skier.assumed_S_f_N_per_mm2": strength,
                "skier.first_turn_s": 100.0,
                "run.duration_s": self.duration,
            },
        )
        x = np.arange(-10.0, 100.0, 0.1)
        slope = Profile(x, self.over(x) - x * math.tan(math.radians(10.0)))
        begins = replace(base.start, x=-5.0, y=start.aside, speed=self.speed * start.speed)
        return base.with_(slope=slope, start=begins)


def rolls(x: FloatArray) -> FloatArray:
    """Heights (m) of five rolls, 0.5 m from trough to crest and 10 m long."""
    return np.where((x > 0.0) & (x < 50.0), 0.25 * (1.0 - np.cos(0.2 * math.pi * x)), 0.0)


def kicker(x: FloatArray) -> FloatArray:
    """Heights (m) of a kicker, 4 m long and 1 m high: an arc up to a third of slope, a plane, and a fall of 2 m."""
    rising = np.where(x < 2.0, x**2 / 12.0, (x - 1.0) / 3.0)
    return np.clip(np.where(x < 4.0, np.where(x < 0.0, 0.0, rising), (6.0 - x) / 2.0), 0.0, 1.0)


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


CASES: Final[tuple[Case | Straight, ...]] = (
    *(Case(f"slalom 10 m, {slope}°", slope, 10.0, 3.0, 5.5) for slope in (10, 15, 19)),
    *(Case(f"slalom 13 m, {slope}°", slope, 13.0, 3.0, 7.5) for slope in (10, 15, 19)),
    Case("slalom 13 m, 15°, hard", 15, 13.0, 3.0, 7.5, HARD),
    Case("slalom 13 m, 25°", 25, 13.0, 3.0, 9.0),
    *(Case(f"giant slalom 25 m, {slope}°", slope, 25.0, 6.0, 11.0) for slope in (15, 19)),
    *(
        Case(f"linked turns, {slope}°", slope, 13.0, 3.0, speed, gates=60, duration=60.0)
        for slope, speed in ((15, 7.0), (20, 8.0), (25, 9.0))
    ),
    Straight("five rolls, 10°", 6.0, rolls, 8.0),
    Straight("kicker, 10°", 8.0, kicker, 4.0),
)

_CLOSE: Final = (("pole_clearance_m", 0.5),)
HYBRID: Final = (
    Hybrid("one turn, 13 m, 15°", 15, 13.0, 3.0, 6.5, gates=2, duration=2.6, keys=_CLOSE),
    Hybrid("one turn, 13 m, 19°", 19, 13.0, 3.0, 7.0, gates=2, duration=2.6, keys=_CLOSE),
    Hybrid("one turn, giant slalom 25 m, 15°", 15, 25.0, 6.0, 11.0, gates=2, duration=3.6, ski="giant-slalom"),
    Hybrid("20 gates, 16 m, 10°", 10, 16.0, 4.5, 6.0, keys=(("greatest_slip_deg", 38.0),)),
    Hybrid("20 gates, 26 m, 15°", 15, 26.0, 18.0, 7.0, keys=(("greatest_slip_deg", 50.0), ("least_slip_deg", 28.0))),
)
"""Turns that carve behind the fall line, on the race piste. Runs of one turn last up to behind the edge
change."""


def starts(count: int, seed: int) -> list[Start]:
    """From one Sobol sequence: speed ±10 %, ±0.3 m, H_V by 0.5 to 2, S_f by 0.7 to 1.4 (log-uniform)."""
    rows = qmc.Sobol(4, seed=seed).random(2 ** math.ceil(math.log2(max(count, 2))))[:count]
    return [Start(0.9 + 0.2 * a, -0.3 + 0.6 * b, 0.5 * 4.0**c, 0.7 * 2.0**d) for a, b, c, d in rows.tolist()]
