"""One turn on many snows, with all else that is not known of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from .._support.processes.batch import run_batch
from ..parameters import values_of
from ..report.figures.track_band import TimedTrack
from ..report.turn_chain import EnsembleRun
from ..report.turn_numbers import used_grip
from ..simulation.simulated_run import simulate
from ..simulation.verification import NUDGED, limit_sentences, nudged_scenarios
from ..snow.mean_snow import drawn_snows
from .priors import MEASURED

if TYPE_CHECKING:
    from .._support.processes.kept_rows import Row
    from ..scenario import Scenario
    from ..scenario.prior import Measured, Prior
    from ..simulation.run import Run

OUTPUT: Final = 0.05
"""Time (s) between the rows of a track that the band draws."""


def quickly(scenario: Scenario) -> dict[str, Any]:
    """Outcome, track and side-slip of a scenario, as JSON values: they may come back from another process."""
    run = simulate(scenario.with_(solver=replace(scenario.solver, method="fast", fixed=False, output_interval=OUTPUT)))
    time, x, y = (column.tolist() for column in (run.time, run.place[:, 0], run.place[:, 1]))
    return {"outcome": run.outcome, "track": [time, x, y], "slips": used_grip(run)[1]}


def drawn_scenarios(nominal: Scenario, inputs: Sequence[Measured | Prior], count: int, seed: int) -> list[Scenario]:
    """Scenarios drawn from the intervals of H_V and S_f and from further inputs: a Latin hypercube over all of them."""
    shares = latin_hypercube(count, 2 + len(inputs), np.random.default_rng(seed))
    snows = drawn_snows(nominal.contact.snow, shares[:, :2])
    own = values_of(nominal)
    columns = {each.key: each.at(shares[:, 2 + j], own[each.key]) for j, each in enumerate(inputs)}
    return [
        nominal.with_(snow=snow, **{key: float(values[i]) for key, values in columns.items()})
        for i, snow in enumerate(snows)
    ]


def latin_hypercube(count: int, inputs: int, generator: np.random.Generator) -> Any:
    """Shares (count, inputs): each of `count` equal slices of every input holds one, at a random place in its slice."""
    slices = generator.permuted(np.tile(np.arange(count), (inputs, 1)), axis=1).T
    return (slices + generator.random((count, inputs))) / count


def ensemble_of(
    nominal: Run, scenarios: Sequence[Scenario], inputs: Sequence[Measured | Prior], *, workers: int | None,
    progress: Callable[[str], None],
) -> tuple[list[EnsembleRun], float, tuple[str, ...]]:  # fmt: skip
    """The runs of an ensemble; how far (m) computing them quickly moves the nominal run's end; warnings of that run."""
    nudged = {key: each for key, each in nudged_scenarios(nominal).items() if key in NUDGED}
    points = [nominal.scenario, *scenarios, *(scenario for each in nudged.values() for scenario in each)]

    def tell(done: int, count: int) -> None:
        progress(f"run {done} of {count}")

    first, *rows = run_batch(points, quickly, workers=workers, progress=tell)
    moved = _apart(first, [[column[-1]] for column in nominal.place[:, :2].T])
    found = [_ensemble_run(scenario, row, inputs) for scenario, row in zip(scenarios, rows, strict=False)]
    beside = iter(rows[len(scenarios) :])
    moves = {key: max(_apart(next(beside), first["track"][1:]) for _ in each) for key, each in nudged.items()}
    return found, moved, limit_sentences(moves, nominal.run_length)


def _ensemble_run(scenario: Scenario, row: Row, inputs: Sequence[Measured | Prior]) -> EnsembleRun:
    values = values_of(scenario)
    return EnsembleRun(
        snow=scenario.contact.snow,
        outcome=row["outcome"],
        track=TimedTrack(*map(np.array, row["track"])),
        values={key: float(values[key]) for key in (*MEASURED, *(each.key for each in inputs))},
        slips=row["slips"],
    )


def _apart(row: Row, place: Sequence[Sequence[float]]) -> float:
    """Distance (m) of a row's last place from the last of x and y."""
    return float(np.hypot(*(column[-1] - other[-1] for column, other in zip(row["track"][1:], place, strict=True))))
