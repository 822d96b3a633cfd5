"""Tables of the chain from a campaign to a turn: the snow, the contacts beside each other, the ensemble."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ...units import DEGREE, MM, N_PER_MM2, N_PER_MM3
from ..table import Column, Table
from ..turn_numbers import afterbody_depth_ratio, median_radius, used_grip

if TYPE_CHECKING:
    from ...simulate.run import Run
    from ...snow import SnowProperties
    from ..turn_chain import EnsembleRun


def parameters_table(snow: SnowProperties) -> Table:
    """H_V and S_f with their intervals."""
    rows = [
        ("snow hardness H_V", "N/mm³", _scaled(snow.snow_hardness, N_PER_MM3),
         _both(snow.snow_hardness_interval, N_PER_MM3)),
        ("failure shear stress S_f", "N/mm²", _scaled(snow.failure_shear_stress, N_PER_MM2),
         _both(snow.failure_shear_stress_interval, N_PER_MM2)),
    ]  # fmt: skip
    return Table(
        "parameters",
        "The snow of the site, with 95 % intervals of the means.",
        (
            Column("parameter", "Parameter", "words"),
            Column("unit", "Unit", "text"),
            Column("value", "Value"),
            Column("interval", "95 % interval", "interval"),
        ),
        rows,
    )


def _scaled(value: float | None, unit: float) -> float | None:
    return None if value is None else value / unit


def _both(interval: tuple[float, float] | None, unit: float) -> tuple[float, float] | None:
    return None if interval is None else (interval[0] / unit, interval[1] / unit)


def contacts_table(runs: Mapping[str, Run]) -> Table:
    """One row for each contact."""
    return Table(
        "contacts",
        "The turn with each contact.",
        (
            Column("contact", "Contact", "words"),
            Column("outcome", "Outcome", "text"),
            Column("run_length_m", "Distance travelled", unit="m"),
            Column("end_speed_m_per_s", "Speed at the end", unit="m/s"),
            Column("turned_deg", "Change of heading", unit="°"),
            Column("turn_radius_m", "Median radius", unit="m"),
            Column("depth_mm", "Maximum edge depth", unit="mm"),
            Column("afterbody_depth_ratio", "Afterbody / forebody"),
            Column("grip", "Grip utilisation"),
            Column("slides", "Share of time side-slipping"),
        ),
        [_contact(name, run) for name, run in runs.items()],
        note="Afterbody / forebody: edge-depth ratio, the mean edge depth of the contact behind the boot over that "
        "before it, of the more heavily loaded (outer) ski, median over the second half. Grip utilisation: side force "
        "over the shear capacity S_f ∫ e ds of that ski, median over the run; it side-slips where that is above 0.95.",
    )


def _contact(name: str, run: Run) -> tuple[Any, ...]:
    heading = np.unwrap(run.heading)
    return (
        name,
        run.outcome.replace("_", " "),
        run.run_length,
        float(run.speed[-1]),
        float(heading[-1] - heading[0]) / DEGREE,
        median_radius(run),
        float(np.nanmax(run.skis.edge_depth)) / MM,
        afterbody_depth_ratio(run),
        *used_grip(run),
    )


def ensemble_table(ensemble: Sequence[EnsembleRun]) -> Table:
    """How the runs ended, and the range of the snow that was drawn."""
    counts = Counter(run.outcome for run in ensemble)
    rows = []
    for outcome, count in counts.most_common():
        those = [run for run in ensemble if run.outcome == outcome]
        hardness = [run.snow.snow_hardness / N_PER_MM3 for run in those]
        stress = [(run.snow.failure_shear_stress or 0.0) / N_PER_MM2 for run in those]
        rows.append((outcome.replace("_", " "), count, (min(hardness), max(hardness)), (min(stress), max(stress))))
    return Table(
        "ensemble",
        "How the runs of the ensemble ended, and the snow that was drawn for them.",
        (
            Column("outcome", "Outcome", "text"),
            Column("runs", "Runs", "count"),
            Column("H_V_N_per_mm3", "H_V", "range", unit="N/mm³"),
            Column("S_f_N_per_mm2", "S_f", "range", unit="N/mm²"),
        ),
        rows,
    )
