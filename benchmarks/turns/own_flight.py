"""Our own sledge in free flight: what its skis cost without snow."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from skisnow.simulate.run_record import Record
from skisnow.simulate.run_setup import set_up
from skisnow.simulate.scenario import read_scenario

from .cases import SCENARIO, fixed

FloatArray: TypeAlias = npt.NDArray[np.float64]

LIFTED_M = 100.0
"""Height above the slope; a second's fall is 5 m."""


def released(step_ms: float) -> Record:
    """The sledge with skis bent as they rest in the snow, lifted off it."""
    setup = set_up(read_scenario(SCENARIO, changes=fixed(step_ms)))
    setup.memory.state.place[2] += LIFTED_M
    record = Record(setup)
    record.add()
    return record


def flown(record: Record, duration_s: float) -> None:
    """Fly on, without output on the way."""
    trouble = record.advance(np.array([record.setup.time + duration_s]))
    if trouble is not None or record.setup.touches:
        raise AssertionError(f"our sledge did not fly: {trouble or 'it touches snow'}")


def tips(record: Record) -> FloatArray:
    """Places of both skis' tips, as if the skis had no shovel (2, 3) (m)."""
    model, state = record.setup.model, record.setup.memory.state
    bent = state.bend[:, int(model.at[0, 0])]
    here = model.middle + model.node[0] * np.array([1.0, 0.0, 0.0]) + np.outer(bent, model.normal)
    return np.asarray(state.place + here @ state.turn.T)
