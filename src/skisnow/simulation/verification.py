"""Accuracy and stability of a run: repeated with finer methods, and with inputs slightly changed, one at a time."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Final, TypeAlias

import numpy as np

from .._support.messages import Message
from .._support.units import CM, Facts, Shown, amount
from .._support.user_files.json_text import json_number
from ..parameters import values_of
from ..scenario import Scenario, Solver
from ..scenario.keys import SCENARIO_KEYS
from .run import Outcome, Run

Simulate: TypeAlias = Callable[[Scenario], Run]
FINER: Final = 2.0
"""By how much each choice is refined."""
DISPLACEMENT: Final = "snow.shear_displacement_mm"
NUDGED: Final = ("start.speed_m_per_s", "sledge.edge_angle_deg", "snow.H_V_N_per_mm3", "snow.S_f_N_per_mm2")
NUDGE: Final = 1e-3
"""Share by which each of them is changed, up and down."""
NEAR: Final = 5.0
"""Times the share of the run by which its end may move for the same share of an input (modelling assumption: carves
move by once)."""


@dataclass(frozen=True, slots=True, repr=False)
class Refinement(Shown):
    """Shift of the end of a run by one finer setting or one changed input.

    Attributes
    ----------
    key
        Key of the scenario, such as "solver.elements".
    was, now
        Its value in the run and the finer one, in the unit that the key names.
    end_moves
        Distance between the ends of both runs (m); None where one of them is not finite.
    outcome
        Outcome of the finer run.

    See Also
    --------
    skisnow.verify
    """

    key: str
    was: float
    now: float
    end_moves: float | None
    outcome: Outcome

    def _repr_facts(self) -> Facts:
        """Title with the changed key, its two values and the shift of the end (cm)."""
        moves = amount(None if self.end_moves is None else self.end_moves / CM, "cm")
        return Facts(f"{self.key} {amount(self.was)} to {amount(self.now)}: the end moves by {moves}, {self.outcome}")


def refined_solvers(run: Run) -> dict[str, Solver]:
    """Solvers that are finer in one choice each, by the scenario's key.

    A run with control of the error gets half the tolerance, one with a fixed step half the step; twice the elements,
    half the spacing of the snow's lines, and half the tolerance of the groove; where the snow has a delayed depth, half
    the spacing of its places.
    """
    solver = run.scenario.solver
    nearer = replace(solver, delayed_spacing=solver.delayed_spacing / FINER)
    shorter, stricter = replace(solver, step=solver.step / FINER), replace(solver, tolerance=solver.tolerance / FINER)
    return {
        **({"solver.step_ms": shorter} if solver.fixed else {"solver.tolerance_mm": stricter}),
        "solver.elements": replace(solver, elements=round(run.numbers["elements"] * FINER)),
        "solver.line_spacing_mm": replace(solver, line_spacing=run.numbers["line_spacing_m"] / FINER),
        "solver.groove_tolerance": replace(solver, groove_tolerance=solver.groove_tolerance / FINER),
        **({"solver.delayed_spacing_mm": nearer} if run.scenario.contact.delayed_share else {}),
    }


def nudged_scenarios(run: Run) -> dict[str, tuple[Scenario, ...]]:
    """Scenarios with half of u_y, and with ±0.1 % of the inputs that a run near its limit depends on, by key.

    Half of u_y only where a scenario may have it; an input that is 0 is not nudged.
    """
    scenario = run.scenario
    scenarios: dict[str, tuple[Scenario, ...]] = {}
    displacement = _scenario_number(scenario, DISPLACEMENT)
    if displacement / FINER >= SCENARIO_KEYS[DISPLACEMENT].lowest:
        scenarios[DISPLACEMENT] = (scenario.with_(**{DISPLACEMENT: displacement / FINER}),)
    for key in NUDGED:
        value = _scenario_number(scenario, key)
        if value:
            scenarios[key] = tuple(scenario.with_(**{key: value * (1.0 + sign * NUDGE)}) for sign in (1.0, -1.0))
    return scenarios


def repetitions(run: Run) -> tuple[str, ...]:
    """Keys of the runs that `verify` makes, in their order."""
    nudged = (key for key, scenarios in nudged_scenarios(run).items() for _ in scenarios)
    return (*refined_solvers(run), *nudged)


def verify(run: Run, simulate: Simulate | None = None) -> tuple[Refinement, ...]:
    """Repeat a run, finer or with a little more or less of an input, one at a time, and see how far its end moves.

    Parameters
    ----------
    run
        The run.
    simulate
        Function that simulates a scenario, in the order of `repetitions`; default: `skisnow.simulate`, with the laws
        that the run was given in Python.

    Returns
    -------
    tuple
        One entry for each choice of the solver, for half of u_y, and for each of start speed, edge angle, H_V and S_f
        changed by ±0.1 %: the one that moves the end farther. If a repetition is interrupted, the entries before it.

    See Also
    --------
    skisnow.simulate : the run.

    References
    ----------
    The page docs/validation/simulated-turn.md.
    """
    if simulate is None:
        from .simulated_run import simulate as repeat  # which loads the compiled core

        simulate = partial(repeat, laws=run.laws, strength_along=run.strength_along)
    finer = refine(run, simulate)
    return finer if len(finer) < len(refined_solvers(run)) else (*finer, *_slightly_changed_runs(run, simulate))


def refine(run: Run, simulate: Simulate) -> tuple[Refinement, ...]:
    """Repetitions of a run with a finer solver, one setting at a time; a part of `verify`."""
    refinements: list[Refinement] = []
    numbers = run.numbers
    used = replace(run.scenario.solver, elements=round(numbers["elements"]), line_spacing=numbers["line_spacing_m"])
    for key, solver in refined_solvers(run).items():
        finer = simulate(replace(run.scenario, solver=solver))
        if finer.outcome == "interrupted":
            break
        was, now = _solver_number(used, key), _solver_number(solver, key)
        refinements.append(Refinement(key, was, now, _distance_of_ends(run, finer), finer.outcome))
    return tuple(refinements)


def _slightly_changed_runs(run: Run, simulate: Simulate) -> Iterator[Refinement]:
    """Largest shift of the run's end for each slightly changed input; stops if a run is interrupted."""
    for key, scenarios in nudged_scenarios(run).items():
        moved: list[Refinement] = []
        for scenario in scenarios:
            other = simulate(scenario)
            if other.outcome == "interrupted":
                return
            was, value = _scenario_number(run.scenario, key), _scenario_number(scenario, key)
            moved.append(Refinement(key, was, value, _distance_of_ends(run, other), other.outcome))
        yield max(moved, key=lambda refinement: math.inf if refinement.end_moves is None else refinement.end_moves)


def limit_warnings(run: Run, refinements: Iterable[Refinement]) -> tuple[str, ...]:
    """A sentence where a thousandth of an input moves the end by more than five thousandths of the run."""
    return limit_sentences({refinement.key: refinement.end_moves or 0.0 for refinement in refinements}, run.run_length)


def limit_sentences(moves: Mapping[str, float], length: float) -> tuple[Message, ...]:
    """Warning of `limit_warnings` from the shifts (m) of the end by key and the run's length (m); () if none."""
    worst = max((key for key in moves if key in NUDGED), key=lambda key: moves[key], default=None)
    if worst is None or not moves[worst] > NEAR * NUDGE * length:
        return ()
    return (
        Message(
            "near the limit of grip: the end moves {move:.2g} m for {change:g} % of {key}. A run there shows a "
            "possible end and does not predict it: look at many, over what the inputs leave open",
            move=moves[worst],
            change=100.0 * NUDGE,
            key=worst,
        ),
    )


def verification_dict(refinements: tuple[Refinement, ...]) -> dict[str, dict[str, Any]]:
    """The entry ``verification`` of summary.json: under each key the refinement and the shift of the end."""
    return {
        refinement.key: {
            "was": refinement.was,
            "now": refinement.now,
            "end_moves_cm": None if refinement.end_moves is None else refinement.end_moves / CM,
            "outcome": refinement.outcome,
        }
        for refinement in refinements
    }


def _scenario_number(scenario: Scenario, key: str) -> float:
    """Number of a scenario's key, in the key's unit."""
    return float(values_of(scenario)[key])


def _solver_number(solver: Solver, key: str) -> float:
    """Number of a solver's setting, in its key's unit."""
    quantity = SCENARIO_KEYS[key]
    value: float = quantity.in_unit(getattr(solver, quantity.field))
    return value


def _distance_of_ends(run: Run, finer: Run) -> float | None:
    """Distance (m) between the last places of two runs; None if it is not finite."""
    return json_number(float(np.linalg.norm(run.place[-1] - finer.place[-1])))
