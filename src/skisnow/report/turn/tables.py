"""Tables of the chain from a campaign to a turn: the snow, the contacts beside each other, the ensemble."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..._support.units import DEGREE, MM, N_PER_MM2, N_PER_MM3
from ..tables.table import Column, Table
from .numbers import BandShares, afterbody_depth_ratio, band_inputs, band_shares, median_radius, middle_track, used_grip

if TYPE_CHECKING:
    from ...simulation.run import Run
    from ...snow import SnowProperties
    from .chain import EnsembleRun, TurnChain


def parameters_table(snow: SnowProperties) -> Table:
    """H_V and S_f with their intervals, and k_u/H_V and u_y where they were measured with one."""
    rows = [
        ("snow hardness H_V", "N/mm³", _scaled(snow.snow_hardness, N_PER_MM3),
         _both(snow.snow_hardness_interval, N_PER_MM3)),
        ("failure shear stress S_f", "N/mm²", _scaled(snow.failure_shear_stress, N_PER_MM2),
         _both(snow.failure_shear_stress_interval, N_PER_MM2)),
    ]  # fmt: skip
    if snow.unloading_ratio_interval is not None:
        rows.append(("k_u / H_V", "", snow.unloading_ratio, snow.unloading_ratio_interval))
    if snow.shear_displacement_interval is not None:
        way = _scaled(snow.shear_displacement, MM), _both(snow.shear_displacement_interval, MM)
        rows.append(("shear displacement u_y", "mm", *way))
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


def shares_table(chain: TurnChain) -> Table:
    """What the band was drawn from, and what each input adds to its variance at the end."""
    found = band_shares(middle_track(chain.nominal), chain.ensemble)
    return Table(
        "band_inputs",
        "What the band counts, and what each of it adds to the variance of the places at its end.",
        (
            Column("key", "Input", "text"),
            Column("range", "Range", "range"),
            Column("origin", "Measured or prior, distribution and origin", "words"),
            Column("aside_percent", "Share of the offset across", "estimate", unit="%", digits=2),
            Column("ahead_percent", "Share of the offset along", "estimate", unit="%", digits=2),
        ),
        [*_inputs(chain, found), *_left(found)],
        note="Shares: first-order Sobol indices by linear regression on the logarithms of the inputs, with 95 % "
        "intervals. What is left over does not follow any input in proportion: curvature, thresholds such as an edge "
        "that loses its grip, and the interplay of inputs.",
    )


def _inputs(chain: TurnChain, found: BandShares | None) -> Iterator[tuple[Any, ...]]:
    for each in band_inputs(chain):
        yield each.key, (each.low, each.high), each.in_words, *_shares_of(each.key, found)


def _shares_of(key: str, found: BandShares | None) -> tuple[Any, Any]:
    """Of the variance across and along, in per cent with intervals; none where it does not vary."""
    if found is None or key not in found.keys:
        return (None, None), (None, None)
    place = found.keys.index(key)
    across, along = (
        (100.0 * float(each.share[place]), tuple((100.0 * each.interval[place]).tolist()))
        for each in (found.aside, found.ahead)
    )
    return across, along


def _left(found: BandShares | None) -> list[tuple[Any, ...]]:
    if found is None:
        return []
    across, along = ((100.0 * each.left, None) for each in (found.aside, found.ahead))
    return [("left over", None, "", across, along)]
