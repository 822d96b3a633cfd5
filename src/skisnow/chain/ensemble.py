"""One turn on many snows."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from ..parallel.batch import run_batch
from ..report.figures.track_band import TimedTrack
from ..report.turn_chain import EnsembleRun
from ..simulate.simulated_run import simulate

if TYPE_CHECKING:
    from ..scenario import Scenario
    from ..simulate.run import Run
    from ..snow import SnowProperties

STEP: Final = 1e-3
"""Of the ensemble's fixed steps (s) (modelling assumption: a fifth of the time; the report says what that costs)."""
EVERY: Final = 5
"""Of a track's rows the band draws one in so many."""


@dataclass(frozen=True, slots=True)
class TurnOn:
    """The same turn on any snow, computed quickly; it is pickled for each worker."""

    scenario: Scenario

    def __call__(self, snow: SnowProperties) -> dict[str, Any]:
        """Outcome and track as JSON values: they may come back from another process."""
        quickly = replace(self.scenario.solver, fixed=True, step=STEP)
        run = simulate(self.scenario.with_(snow=snow, solver=quickly))
        time, x, y = (column[::EVERY].tolist() for column in (run.time, run.place[:, 0], run.place[:, 1]))
        return {"outcome": run.outcome, "track": [time, x, y]}


def ensemble_of(
    nominal: Run, snows: Sequence[SnowProperties], *, workers: int | None, progress: Callable[[str], None]
) -> tuple[list[EnsembleRun], float]:
    """The nominal run's scenario on each snow, and how far (m) computing it quickly moves the nominal run's end."""

    def tell(done: int, count: int) -> None:
        progress(f"run {done} of {count}")

    own = nominal.scenario.contact.snow
    first, *rows = run_batch([own, *snows], TurnOn(nominal.scenario), workers=workers, progress=tell)
    moved = float(np.hypot(*(nominal.place[-1, :2] - [column[-1] for column in first["track"][1:]])))
    tracks = [TimedTrack(*map(np.array, row["track"])) for row in rows]
    return [EnsembleRun(*of) for of in zip(snows, [row["outcome"] for row in rows], tracks, strict=True)], moved
