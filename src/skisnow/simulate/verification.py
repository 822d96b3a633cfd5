"""How exact a run is: the same run computed finer, one choice of the solver at a time, and how far its end moves."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Final, TypeAlias

import numpy as np

from ..former_names import formerly
from ..json_number import json_number
from ..scenario import Scenario, Solver
from ..scenario.keys import SCENARIO_KEYS
from ..shown import Facts, Shown, amount
from ..units import CM
from .run import Outcome, Run

Simulate: TypeAlias = Callable[[Scenario], Run]
FINER: Final = 2.0
"""By how much each choice is refined."""


@dataclass(frozen=True, slots=True, repr=False)
class Refinement(Shown):
    """What one finer choice changed.

    Attributes
    ----------
    key
        Of the scenario, such as "solver.elements".
    was, now
        Its value in force and the finer one, in the unit that the key names.
    end_moves
        Distance between the ends of both runs (m); None where one of them is not finite.
    outcome
        Of the finer run.

    See Also
    --------
    skisnow.verify
    """

    key: str
    was: float
    now: float
    end_moves: float | None
    outcome: Outcome

    def _facts(self) -> Facts:
        moves = amount(None if self.end_moves is None else self.end_moves / CM, "cm")
        return Facts(f"{self.key} {amount(self.was)} to {amount(self.now)}: the end moves by {moves}, {self.outcome}")


def refined_solvers(run: Run) -> dict[str, Solver]:
    """Solvers that are finer in one choice each, by the scenario's key.

    A run with control of the error gets half the tolerance, one with a fixed step half the step; twice the elements,
    half the spacing of the snow's lines, and half the tolerance of the groove.
    """
    solver = run.scenario.solver
    shorter, stricter = replace(solver, step=solver.step / FINER), replace(solver, tolerance=solver.tolerance / FINER)
    return {
        **({"solver.step_ms": shorter} if solver.fixed else {"solver.tolerance_mm": stricter}),
        "solver.elements": replace(solver, elements=round(run.numbers["elements"] * FINER)),
        "solver.line_spacing_mm": replace(solver, line_spacing=run.numbers["line_spacing_m"] / FINER),
        "solver.groove_tolerance": replace(solver, groove_tolerance=solver.groove_tolerance / FINER),
    }


def verify(run: Run, simulate: Simulate | None = None) -> tuple[Refinement, ...]:
    """Repeat a run, finer in one choice at a time, and see how far its end moves.

    Parameters
    ----------
    run
        The run.
    simulate
        What computes a scenario, called in the order of `refined_solvers`; left out: `skisnow.simulate`.

    Returns
    -------
    tuple
        One entry for each choice. Where a repetition is interrupted, those before it.

    See Also
    --------
    skisnow.simulate : the run.

    References
    ----------
    The page docs/validation/simulated-turn.md.
    """
    found: list[Refinement] = []
    again = simulate or _plainly()
    for key, solver in refined_solvers(run).items():
        finer = again(replace(run.scenario, solver=solver))
        if finer.outcome == "interrupted":
            break
        found.append(Refinement(key, _in_force(run, key), _chosen(solver, key), _distance(run, finer), finer.outcome))
    return tuple(found)


def _plainly() -> Simulate:
    from .simulated_run import simulate  # which loads the compiled core

    return simulate


verified = formerly("verified", verify)


def verification_dict(refinements: tuple[Refinement, ...]) -> dict[str, dict[str, Any]]:
    """The entry ``verification`` of summary.json: under each key what was refined and how far the end moved."""
    return {
        each.key: {
            "was": each.was,
            "now": each.now,
            "end_moves_cm": None if each.end_moves is None else each.end_moves / CM,
            "outcome": each.outcome,
        }
        for each in refinements
    }


def _in_force(run: Run, key: str) -> float:
    numbers = run.numbers
    chosen = replace(
        run.scenario.solver,
        elements=round(numbers["elements"]),
        line_spacing=numbers["line_spacing_m"],
    )
    return _chosen(chosen, key)


def _chosen(solver: Solver, key: str) -> float:
    quantity = SCENARIO_KEYS[key]
    value: float = quantity.in_unit(getattr(solver, quantity.field))
    return value


def _distance(run: Run, finer: Run) -> float | None:
    return json_number(float(np.linalg.norm(run.place[-1] - finer.place[-1])))
