"""Tables of a run: scenario, forces on the skis, energies, verification, gates."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, Final, TypeAlias

import numpy as np
import numpy.typing as npt

from ...scenario.keys import SCENARIO_KEYS
from ...simulation.run import OPEN_SHARE
from ...track.course.gates_table import COLUMNS, gate_rows
from ..formatting import significant
from ..table import Column, Table
from .time_figures import grip_utilisation, gross_grip_utilisation

if TYPE_CHECKING:
    from ...simulation.run import Run
    from ...track.course import CourseResult

FloatArray: TypeAlias = npt.NDArray[np.float64]

Json = Mapping[str, Any]

_STORED: Final = (
    ("kinetic_J", "kinetic"),
    ("potential_J", "potential"),
    ("elastic_ski_J", "elastic, in the skis"),
    ("elastic_snow_J", "elastic, in the snow"),
    ("delayed_snow_J", "stored in the delayed depth of the snow"),
)
_OVER: Final = (
    "which is the kinetic energy at the start, all losses and the largest fall in potential energy. Losses contain no "
    "stored energy."
)
_LOST: Final = (
    ("lost_penetration_J", "lost to the grooves"),
    ("lost_shear_J", "lost to side-slip"),
    ("lost_friction_J", "lost to friction"),
    ("lost_drag_J", "lost to air drag"),
    ("lost_damping_J", "lost to damping of the skis"),
    ("lost_snow_damping_J", "lost to damping and delayed depth of the snow"),
)
_GIVEN: Final = (
    ("given_boots_J", "given by what moves the boots"),
    ("given_push_J", "given by a push"),
)


def scenario_table(values: Json) -> Table:
    """Table of the scenario's keys with value, unit and meaning.

    Parameters
    ----------
    values
        Values by full name, ``section.key``, or in sections as in a scenario file.
    """
    return Table(
        "scenario",
        "The scenario: every key with the value in force; a dash: not given.",
        (
            Column("key", "Key", "text"),
            Column("value", "Value", "text"),
            Column("unit", "Unit", "text"),
            Column("meaning", "Meaning", "text"),
        ),
        [(name, _text(value), *_unit_and_meaning(name)) for name, value in by_full_name(values)],
    )


def by_full_name(values: Json) -> Iterator[tuple[str, Any]]:
    """Full names ``section.key`` with their values, also for values in sections.

    >>> list(by_full_name({"run": {"duration_s": 5.0}, "snow.site": "A"}))
    [('run.duration_s', 5.0), ('snow.site', 'A')]
    """
    for name, value in values.items():
        if isinstance(value, Mapping):
            yield from ((f"{name}.{key}", cell) for key, cell in value.items())
        else:
            yield name, value


def _unit_and_meaning(name: str) -> tuple[str, str]:
    key = SCENARIO_KEYS.get(name)
    return ("", "") if key is None else (key.unit, key.meaning)


def _text(value: Any) -> str | None:
    """A value as in a scenario file, with ten significant digits."""
    if value is None:
        return None
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list | tuple):
        return f"[{', '.join(str(_text(item)) for item in value)}]"
    return f"{value:.10g}" if isinstance(value, int | float) else str(value)


def skis_table(run: Run) -> Table:
    """Table with total force, normal force and grip utilisation of each ski."""
    histories = run.skis.total_force, run.skis.normal_force, grip_utilisation(run), gross_grip_utilisation(run)
    rows = [
        (name, *(value for each in histories for value in _middle_and_high(each[:, ski])))
        for ski, name in enumerate(("left ski", "right ski"))
    ]
    return Table(
        "skis",
        "Force of the snow on each ski, and its grip utilisation: median and 95 % quantile over time.",
        (
            Column("ski", "Ski", "words"),
            Column("total_force_N", "Total force", unit="N"),
            Column("total_force_p95_N", "95 %", unit="N"),
            Column("normal_force_N", "Normal force", unit="N"),
            Column("normal_force_p95_N", "95 %", unit="N"),
            Column("grip_utilisation", "Grip utilisation"),
            Column("grip_utilisation_p95", "95 %"),
            Column("gross_grip_utilisation", "Gross"),
            Column("gross_grip_utilisation_p95", "95 %"),
        ),
        rows,
        note="Total force: normal force, shear and friction as one vector. Grip utilisation: side force over shear "
        "capacity; at 1 the ski side-slips. Gross: sum of the sizes of the shear along the edge over the capacity.",
    )


def _middle_and_high(values: FloatArray) -> tuple[float | None, float | None]:
    finite = values[np.isfinite(values)]
    return (float(np.median(finite)), float(np.quantile(finite, 0.95))) if finite.size else (None, None)


def energies_table(summary: Json) -> Table:
    """Table of the energies at the start and the end, and of the losses."""
    energies = summary["energies"]
    rows: list[tuple[Any, ...]] = [
        (label, *_change(energies[f"{key.removesuffix('_J')}_start_J"], energies[key])) for key, label in _STORED
    ]
    rows += [(label, None, energies[key], energies[key]) for key, label in _LOST]
    rows += [(label, None, energies[key], -energies[key]) for key, label in _GIVEN if energies.get(key)]
    error = summary["energy_balance_error"]
    note = (
        "No energy was exchanged."
        if error is None
        else f"The energy residual is {significant(100.0 * error, 2)} % of the energy exchanged, {_OVER}"
        if error > OPEN_SHARE
        else f"The changes add up to 0 within {significant(100.0 * error, 2)} % of the energy exchanged, {_OVER}"
    )
    return Table(
        "energies",
        "Energies and losses.",
        (
            Column("energy", "Energy", "words"),
            Column("start_J", "Start", unit="J", digits=4),
            Column("end_J", "End", unit="J", digits=4),
            Column("change_J", "Change", unit="J", digits=4),
        ),
        rows,
        note=note,
    )


def _change(start: float | None, end: float | None) -> tuple[float | None, float | None, float | None]:
    """Start, end and change of an energy; None for values that are not finite."""
    return start, end, None if start is None or end is None else end - start


def verification_table(verification: Json) -> Table:
    """Table of the displacements of the end for one changed choice of the solver or input at a time.

    Parameters
    ----------
    verification
        Contents of `skisnow.simulation.verification.verification_dict`.
    """
    return Table(
        "verification",
        "The same run with one choice of the solver finer, or one input another, at a time, and how far its end moves.",
        (
            Column("key", "Key", "text"),
            Column("was", "Was"),
            Column("now", "Again with"),
            Column("end_moves_cm", "End moves by", unit="cm"),
            Column("outcome", "Outcome", "text"),
        ),
        [
            (name, row["was"], row["now"], row["end_moves_cm"], row["outcome"].replace("_", " "))
            for name, row in verification.items()
        ],
    )


def gates_table(result: CourseResult) -> Table:
    """Table with a row for each gate, times and poles with two decimals."""
    rows = [tuple(_words(row[name]) for name in COLUMNS) for row in gate_rows(result)]
    fault = result.fault
    return Table(
        "gates",
        f"{result.passed} of {len(result.passages)} gates passed.",
        (
            Column("gate", "Gate", "text"),
            Column("side", "Side", "text"),
            Column("outcome", "Outcome", "text"),
            Column("time_s", "Time", "hundredths", unit="s"),
            Column("split_s", "From the gate before", "hundredths", unit="s"),
            Column("speed_m_per_s", "Speed", unit="m/s"),
            Column("clearance_m", "From the pole", unit="m"),
            Column("x_m", "Turning pole x", "hundredths", unit="m"),
            Column("y_m", "y", "hundredths", unit="m"),
        ),
        rows,
        note="" if fault is None else f"{fault.words[0].upper()}{fault.words[1:]}.",
    )


def _words(cell: object) -> object:
    return cell.replace("_", " ") if isinstance(cell, str) else cell
