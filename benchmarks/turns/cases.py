"""Which turns are run, and against which they are held."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Final
from unittest.mock import patch

from skisnow.contact.snow_field import PART_ALONG
from skisnow.scenario import load_scenario
from skisnow.simulation import run_setup
from skisnow.simulation.run import Run
from skisnow.simulation.simulated_run import simulate

SCENARIO: Final = "carved-46m"
HARD_SNOW: Final = {"snow.H_V_N_per_mm3": 90, "snow.S_f_N_per_mm2": 10}
"""The hardest snow measured; S_f lies beyond everything measured, so that an edge this shallow carves."""


@dataclass(frozen=True, slots=True)
class Case:
    """One way to run the turn.

    Attributes
    ----------
    name
        In the table.
    changes
        Keys of the scenario.
    reference
        Keys of the run that its end is held against.
    goal
        Times real time; empty: none.
    """

    name: str
    changes: Mapping[str, object]
    reference: Mapping[str, object]
    goal: str = ""


def fixed(step_ms: float, **more: object) -> dict[str, object]:
    """Keys of a solver with a fixed step."""
    return {"solver.fixed": True, "solver.step_ms": step_ms} | {f"solver.{name}": value for name, value in more.items()}


FINE: Final[Mapping[str, object]] = MappingProxyType(
    {
        "solver.elements": 80,
        "solver.line_spacing_mm": 10.0,
        "solver.tolerance_mm": 1e-5,
        "solver.groove_tolerance": 3e-6,
    }
)
"""What a reference has: twice the elements, half the line spacing, a hundredth of the tolerance of a step and a
thirtieth of the groove's. Use it within `finer_parts`."""


def finer_parts() -> AbstractContextManager[float]:
    """A context in which the snow's history is followed over a quarter of the usual way, as a reference needs."""
    return patch.object(run_setup, "PART_ALONG", PART_ALONG / 4.0)


SOFT: Final = {"snow.H_V_N_per_mm3": 0.04}
FIRM: Final = {"snow.H_V_N_per_mm3": 1.0}
SKID: Final = FIRM | {"snow.S_f_N_per_mm2": 0.25}
SOFT_EDGE: Final = {"snow.shear_displacement_mm": 0.5}
STIFF_EDGE: Final = {"snow.shear_displacement_mm": 0.05}


def _case(name: str, goal: str, snow: Mapping[str, object], **solver: object) -> Case:
    return Case(name, {**snow, **{f"solver.{key}": value for key, value in solver.items()}}, {**snow, **FINE}, goal)


FAST: Final = _case("fast", "100", {}, method="fast")
DEFAULT: Final = _case("default", "50", {})
CASES: Final = (
    FAST,
    DEFAULT,
    _case("fast, u_y = 0.5 mm", "100", SOFT_EDGE, method="fast"),
    _case("default, u_y = 0.5 mm", "50", SOFT_EDGE),
    _case("fast, u_y = 0.05 mm", "100", STIFF_EDGE, method="fast"),
    _case("default, u_y = 0.05 mm", "50", STIFF_EDGE),
    _case("default, H_V = 0.04 N/mm³", "40", SOFT),
    _case("default, H_V = 1 N/mm³", "40", FIRM),
    _case("default, H_V = 90 N/mm³, S_f = 10 N/mm²", "8", HARD_SNOW),
    _case("default, a skid: H_V = 1 N/mm³, S_f = 0.25 N/mm²", "", SKID),
    _case("fixed steps of 1 ms", "", {}, **{"fixed": True, "step_ms": 1.0}),
)


@dataclass(slots=True)
class Runs:
    """Runs of the turn, of one duration; what serves as a reference is computed once."""

    duration_s: float
    _references: dict[str, Run] = field(default_factory=dict)

    def of(self, changes: Mapping[str, object]) -> Run:
        """The turn with these keys changed."""
        return simulate(load_scenario(SCENARIO, changes={**changes, "run.duration_s": self.duration_s}))

    def reference(self, changes: Mapping[str, object]) -> Run:
        """The same, kept."""
        name = repr(sorted(changes.items()))
        if name not in self._references:
            with finer_parts():
                self._references[name] = self.of(changes)
        return self._references[name]
