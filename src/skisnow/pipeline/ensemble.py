"""Ensemble of simulated turns over the uncertain inputs of a turn: priors, sampling, and the runs."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.processes.batch import run_batch
from ..parameters import values_of
from ..report.turn.chain import EnsembleRun
from ..report.turn.figures import TimedTrack
from ..report.turn.numbers import used_grip
from ..scenario.identify_section import Measured, Prior, measured_of
from ..simulation.simulated_run import simulate
from ..simulation.verification import NUDGED, limit_sentences, nudged_scenarios
from ..snow.mean_snow import drawn_snows

if TYPE_CHECKING:
    from .._support.processes.kept_rows import Row
    from ..scenario import Scenario
    from ..simulation.run import Run

CAMBER_ROUNDING: Final = "ski.camber_rounding_mm"
PRIORS: Final = (
    Prior(
        key="snow.unloading_ratio",
        low=2.0,
        high=50.0,
        origin="not measured here, not published; from 2 on the snow keeps half of a groove, at 50 all but all of it",
    ),
    Prior(
        key="snow.shear_displacement_mm",
        low=0.02,
        high=0.5,
        origin="not measured here; from the default, near the limit 0 of the paper's law, to half a millimetre",
    ),
    Prior(
        key="friction.mu_0",
        low=0.4,
        high=2.5,
        about=True,
        origin="as far about the scenario's own as 0.023 and 0.139, the ends of over 200 runs (Wolfsperger and others "
        "2021), are about their geometric middle",
    ),
    Prior(
        key="ski.stiffness_factor",
        low=0.77,
        high=1.3,
        origin="EI and GJ of the catalogue are inferred from an index: natural frequencies to 15 %, stiffness to 30 %",
    ),
    Prior(
        key=CAMBER_ROUNDING,
        low=50.0,
        high=200.0,
        origin="no source: half and twice the 100 mm of a ski whose camber is known as one number",
    ),
)
"""By default."""
MEASURED: Final = ("snow.H_V_N_per_mm3", "snow.S_f_N_per_mm2")
"""Keys whose uncertainty the campaign tells in any case."""
OUTPUT: Final = 0.05
"""Time (s) between the rows of a track that the band draws."""


def inputs_with(priors: Iterable[Prior], turn: Scenario) -> tuple[Measured | Prior, ...]:
    """Inputs of the band next to H_V and S_f, in the order of its columns.

    A prior that is given comes first, then what the snow has measured with an interval, then the usual prior. The
    camber's rounding is one only where the ski has a camber, as one number.

    Raises
    ------
    ParameterError
        One is of what the campaign measures.
    """
    measured = {uncertain.key: uncertain for uncertain in measured_of(turn.contact.snow)}
    inputs = {prior.key: measured.get(prior.key, prior) for prior in PRIORS}
    if turn.ski.base is None or turn.ski.base.camber == 0.0:
        del inputs[CAMBER_ROUNDING]
    for prior in priors:
        if prior.key in MEASURED:
            raise ParameterError(
                Message("{key} has no prior here: its interval comes from the campaign", key=prior.key), code="no_data"
            )
        inputs[prior.key] = prior
    return tuple(inputs.values())


def simulate_fast(scenario: Scenario) -> dict[str, Any]:
    """Outcome, track and side-slip of a scenario, as JSON values: they may come back from another process."""
    run = simulate(scenario.with_(solver=replace(scenario.solver, method="fast", fixed=False, output_interval=OUTPUT)))
    time, x, y = (column.tolist() for column in (run.time, run.place[:, 0], run.place[:, 1]))
    return {"outcome": run.outcome, "track": [time, x, y], "slips": used_grip(run)[1]}


def drawn_scenarios(nominal: Scenario, inputs: Sequence[Measured | Prior], count: int, seed: int) -> list[Scenario]:
    """Scenarios drawn from the intervals of H_V and S_f and from further inputs: a Latin hypercube over all of them."""
    shares = latin_hypercube(count, 2 + len(inputs), np.random.default_rng(seed))
    snows = drawn_snows(nominal.contact.snow, shares[:, :2])
    own = values_of(nominal)
    columns = {source.key: source.at(shares[:, 2 + j], own[source.key]) for j, source in enumerate(inputs)}
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
    """The runs of an ensemble; how far (m) the fast solver moves the nominal run's end; warnings of that run."""
    nudged = {key: pair for key, pair in nudged_scenarios(nominal).items() if key in NUDGED}
    points = [nominal.scenario, *scenarios, *(scenario for nudges in nudged.values() for scenario in nudges)]

    def tell(done: int, count: int) -> None:
        progress(f"run {done} of {count}")

    first, *rows = run_batch(points, simulate_fast, workers=workers, progress=tell)
    moved = _apart(first, [[column[-1]] for column in nominal.place[:, :2].T])
    runs = [_ensemble_run(scenario, row, inputs) for scenario, row in zip(scenarios, rows, strict=False)]
    beside = iter(rows[len(scenarios) :])
    moves = {key: max(_apart(next(beside), first["track"][1:]) for _ in nudges) for key, nudges in nudged.items()}
    return runs, moved, limit_sentences(moves, nominal.run_length)


def _ensemble_run(scenario: Scenario, row: Row, inputs: Sequence[Measured | Prior]) -> EnsembleRun:
    values = values_of(scenario)
    return EnsembleRun(
        snow=scenario.contact.snow,
        outcome=row["outcome"],
        track=TimedTrack(*map(np.array, row["track"])),
        values={key: float(values[key]) for key in (*MEASURED, *(source.key for source in inputs))},
        slips=row["slips"],
    )


def _apart(row: Row, place: Sequence[Sequence[float]]) -> float:
    """Distance (m) of a row's last place from the last of x and y."""
    return float(np.hypot(*(column[-1] - other[-1] for column, other in zip(row["track"][1:], place, strict=True))))
