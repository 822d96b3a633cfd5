"""Our own sledge in free flight: what its skis cost without snow."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from skisnow.scenario import load_scenario
from skisnow.simulation.run_record import Record
from skisnow.simulation.run_setup import laid_out

from .cases import SCENARIO, fixed

FloatArray: TypeAlias = npt.NDArray[np.float64]

LIFTED_M = 100.0
"""Height above the slope; a second's fall is 5 m."""


def released(step_ms: float, lifted_m: float = LIFTED_M) -> Record:
    """The sledge with skis bent as they rest in the snow, lifted off it."""
    setup = laid_out(load_scenario(SCENARIO, changes=fixed(step_ms)))
    dynamics = setup.dynamics
    dynamics.find_equilibrium()
    dynamics.move_to(dynamics.position + np.array([0.0, 0.0, lifted_m]), dynamics.rotation)
    dynamics.begin(np.array([setup.scenario.start.speed, 0.0, 0.0, 0.0, 0.0, 0.0]))
    return Record(setup)


def flown(record: Record, duration_s: float) -> None:
    """Fly on, without output on the way."""
    trouble = record.advance(record.setup.dynamics.time + duration_s)
    if trouble is not None or record.setup.dynamics.touches:
        raise AssertionError(f"our sledge did not fly: {trouble or 'it touches snow'}")


def tips(record: Record) -> FloatArray:
    """Places of both skis' tips, as if the skis had no shovel (2, 3) (m)."""
    dynamics, tip = record.setup.dynamics, record.setup.node[0]
    bent = dynamics.part("beam_dofs")[:, 0]  # the first unknown: the deflection of the node at the tip
    here = [ski.boot + tip * ski.axes[0] + w * ski.axes[2] for ski, w in zip(dynamics.body.skis, bent, strict=True)]
    return np.asarray(dynamics.position + np.array(here) @ dynamics.rotation.T)
