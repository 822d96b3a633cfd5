"""Tables of a run: scenario, forces on the skis, energies, verification, gates."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

import numpy as np

from ..._support.arrays import FloatArray
from ..._support.messages import Message, outcome_words
from ...scenario.keys import SCENARIO_KEYS
from ...simulation.run import LOST, OPEN_SHARE, STORED, Run
from ...track.course import CourseResult
from ...track.course.gates_table import COLUMNS, gate_rows
from ..formatting import significant
from ..table import Column, Table
from .time_figures import ENERGY_STYLES, grip_utilisation, gross_grip_utilisation
from .track_figure import SKIS

Json = Mapping[str, Any]

_GIVEN: Final = {
    "given_boots_J": Message("from the motion of the boots"),
    "given_push_J": Message("given by a push"),
}


def scenario_table(values: Json) -> Table:
    """Table of the scenario's keys with value, unit and meaning; ``values`` in sections as in a scenario file."""
    return Table(
        "scenario",
        Message("The scenario: every key with the value in force; a dash: not given."),
        (
            Column("key", Message("Key"), "text"),
            Column("value", Message("Value"), "text"),
            Column("unit", Message("Unit"), "text"),
            Column("meaning", Message("Meaning"), "text"),
        ),
        [
            (f"{section}.{name}", _text(value), key.unit if key else "", Message(key.meaning) if key else "")
            for section, table in values.items()
            for name, value in table.items()
            for key in [SCENARIO_KEYS.get(f"{section}.{name}")]
        ],
    )


def _text(value: Any) -> str | None:
    """A value as in a scenario file, with ten significant digits."""
    if value is None:
        return None
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list | tuple):
        are_numbers = all(isinstance(cell, int | float) and not isinstance(cell, bool) for cell in value)
        return Message("{values:.10g}", values=tuple(value)) if are_numbers else str(list(value))
    return Message("{value:.10g}", value=value) if isinstance(value, int | float) else str(value)


def skis_table(run: Run) -> Table:
    """Table with total force, normal force and grip utilisation of each ski."""
    histories = run.skis.total_force, run.skis.normal_force, grip_utilisation(run), gross_grip_utilisation(run)
    rows = [(name, *(value for each in histories for value in _quantiles(each[:, i]))) for i, name in enumerate(SKIS)]
    return Table(
        "skis",
        Message("Force of the snow on each ski, and its grip utilisation: median and 95 % quantile over time."),
        (
            Column("ski", Message("Ski"), "words"),
            Column("total_force_N", Message("Total force"), unit="N"),
            Column("total_force_p95_N", "95 %", unit="N"),
            Column("normal_force_N", Message("Normal force"), unit="N"),
            Column("normal_force_p95_N", "95 %", unit="N"),
            Column("grip_utilisation", Message("Grip utilisation")),
            Column("grip_utilisation_p95", "95 %"),
            Column("gross_grip_utilisation", Message("Gross")),
            Column("gross_grip_utilisation_p95", "95 %"),
        ),
        rows,
        note=Message(
            "Total force: normal force, shear and friction as one vector. Grip utilisation: side force over shear "
            "capacity; at 1 the ski side-slips. Gross: sum of the sizes of the shear along the edge over the capacity."
        ),
    )


def _quantiles(values: FloatArray) -> list[float | None]:
    """Median and 95 % quantile of the finite values; two None without any."""
    finite = values[np.isfinite(values)]
    return np.quantile(finite, [0.5, 0.95]).tolist() if finite.size else [None, None]


def energies_table(summary: Json) -> Table:
    """Table of the energies at the start and the end, and of the losses."""
    energies = summary["energies"]
    rows: list[tuple[Any, ...]] = []
    for name in STORED:
        start, end = energies[f"{name}_start_J"], energies[f"{name}_J"]
        change = None if start is None or end is None else end - start
        rows.append((ENERGY_STYLES[name][1], start, end, change))
    rows += [(ENERGY_STYLES[name][1], None, energies[f"lost_{name}_J"], energies[f"lost_{name}_J"]) for name in LOST]
    rows += [(label, None, energies[key], -energies[key]) for key, label in _GIVEN.items() if energies.get(key)]
    error = summary["energy_balance_error"]
    share = significant(None if error is None else 100.0 * error, 2)
    if error is None:
        note = Message("No energy was exchanged.")
    elif error > OPEN_SHARE:
        note = Message(
            "The energy residual is {share} % of the energy exchanged, which is the kinetic energy at the start, all "
            "losses and the largest fall in potential energy. Losses contain no stored energy.",
            share=share,
        )
    else:
        note = Message(
            "The changes add up to 0 within {share} % of the energy exchanged, which is the kinetic energy at the "
            "start, all losses and the largest fall in potential energy. Losses contain no stored energy.",
            share=share,
        )
    return Table(
        "energies",
        Message("Energies and losses."),
        (
            Column("energy", Message("Energy"), "words"),
            Column("start_J", Message("Start"), unit="J", digits=4),
            Column("end_J", Message("End"), unit="J", digits=4),
            Column("change_J", Message("Change"), unit="J", digits=4),
        ),
        rows,
        note=note,
    )


def verification_table(verification: Json) -> Table:
    """Table of the displacements of the end for one changed choice of the solver or input at a time.

    verification: contents of `skisnow.simulation.verification.verification_dict`.
    """
    return Table(
        "verification",
        Message(
            "The same run with one choice of the solver finer, or one input another, at a time, and how far its end "
            "moves."
        ),
        (
            Column("key", Message("Key"), "text"),
            Column("was", Message("Was")),
            Column("now", Message("Again with")),
            Column("end_moves_cm", Message("End moves by"), unit="cm"),
            Column("outcome", Message("Outcome"), "text"),
        ),
        [
            (name, row["was"], row["now"], row["end_moves_cm"], outcome_words(row["outcome"]))
            for name, row in verification.items()
        ],
    )


def gates_table(result: CourseResult) -> Table:
    """Outcome, time, speed and distance from the pole of each gate, a row each; the first fault as a note."""
    rows = [
        tuple(outcome_words(row[name]) if name in ("side", "outcome") else row[name] for name in COLUMNS)
        for row in gate_rows(result)
    ]
    fault = result.fault
    return Table(
        "gates",
        Message("{passed} of {n_passages} gates passed.", passed=result.passed, n_passages=len(result.passages)),
        (
            Column("gate", Message("Gate"), "text"),
            Column("side", Message("Side"), "text"),
            Column("outcome", Message("Outcome"), "text"),
            Column("time_s", Message("Time"), "hundredths", unit="s"),
            Column("split_s", Message("From the gate before"), "hundredths", unit="s"),
            Column("speed_m_per_s", Message("Speed"), unit="m/s"),
            Column("clearance_m", Message("From the pole"), unit="m"),
            Column("x_m", Message("Turning pole x"), "hundredths", unit="m"),
            Column("y_m", "y", "hundredths", unit="m"),
        ),
        rows,
        note="" if fault is None else fault.words,
    )
