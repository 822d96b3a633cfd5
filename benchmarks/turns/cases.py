"""Which turns are run, and against which they are held."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Final

from skisnow.simulate.run import Run
from skisnow.simulate.scenario import read_scenario
from skisnow.simulate.simulated_run import simulate

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


NORMAL_REFERENCE: Final[Mapping[str, object]] = MappingProxyType(fixed(0.1))
HARD_REFERENCE: Final[Mapping[str, object]] = MappingProxyType(HARD_SNOW | fixed(0.025))
DEFAULT_STEP: Final = Case("ROS2, 0.5 ms", fixed(0.5), NORMAL_REFERENCE, "15")
FAST: Final = Case("fast mode, 1 ms", fixed(1.0, method="fast"), NORMAL_REFERENCE, "40")
LONG_STEP: Final = Case("ROS2, 1 ms", fixed(1.0), NORMAL_REFERENCE)
CASES: Final = (
    FAST,
    DEFAULT_STEP,
    LONG_STEP,
    Case("ROS2, error control (as it comes)", {}, NORMAL_REFERENCE),
    Case("H_V = 90 N/mm³, ROS2, 0.1 ms", HARD_SNOW | fixed(0.1), HARD_REFERENCE, "5"),
    Case("H_V = 90 N/mm³, ROS2, 0.25 ms", HARD_SNOW | fixed(0.25), HARD_REFERENCE),
    Case("H_V = 90 N/mm³, error control", HARD_SNOW, HARD_REFERENCE),
    Case("H_V = 90 N/mm³, ROS2, 0.5 ms: the step of soft snow", HARD_SNOW | fixed(0.5), HARD_REFERENCE),
)


@dataclass(slots=True)
class Runs:
    """Runs of the turn, of one duration; what serves as a reference is computed once."""

    duration_s: float
    _references: dict[str, Run] = field(default_factory=dict)

    def of(self, changes: Mapping[str, object]) -> Run:
        """The turn with these keys changed."""
        return simulate(read_scenario(SCENARIO, changes={**changes, "run.duration_s": self.duration_s}))

    def reference(self, changes: Mapping[str, object]) -> Run:
        """The same, kept."""
        name = repr(sorted(changes.items()))
        if name not in self._references:
            self._references[name] = self.of(changes)
        return self._references[name]
