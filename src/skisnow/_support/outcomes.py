"""Words of the outcomes of runs, gates, carves and identifications, and of the sides of gates."""

from __future__ import annotations

from typing import Final

from .messages import Message

_OUTCOMES: Final = {
    "finished": Message("finished"),
    "distance_reached": Message("distance reached"),
    "end_of_slope": Message("end of slope"),
    "tipped_over": Message("tipped over"),
    "fell": Message("fell"),
    "airborne": Message("airborne"),
    "sunk": Message("sunk"),
    "missed_gate": Message("missed gate"),
    "energy_open": Message("energy open"),
    "step_too_small": Message("step too small"),
    "not_finite": Message("not finite"),
    "interrupted": Message("interrupted"),
    "converged": Message("converged"),
    "not_converged": Message("not converged"),
    "not_identifiable": Message("not identifiable"),
    "too_few_points": Message("too few points"),
    "error": Message("error"),
    "equilibrium": Message("equilibrium"),
    "slips": Message("slips"),
    "sinks": Message("sinks"),
    "bridges": Message("bridges"),
    "passed": Message("passed"),
    "straddled": Message("straddled"),
    "missed": Message("missed"),
    "backwards": Message("backwards"),
    "not_reached": Message("not reached"),
    "left": Message("left"),
    "right": Message("right"),
}


def outcome_words(outcome: str) -> str:
    """Words of the outcome of a run, a gate, a carve or an identification, or of the side of a gate."""
    return _OUTCOMES.get(outcome) or outcome.replace("_", " ")
