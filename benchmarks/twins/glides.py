"""One twin of photo-cell times: the closed form v²(s) with noise, and standard errors beside its Fisher information."""

import math
from typing import Final

import numpy as np
from tests.identification import glide_in_closed_form as exact

from skisnow.identification import Identification, PhotoCellRun, PhotoCells, identify
from skisnow.scenario import scenario_file

from .kept import Row, interval_row, number

SCENARIO: Final = "carved-46m"
STATION: Final = np.arange(10.0, 401.0, 15.0)
ANGLE_DEG: Final = 14.0
SD: Final = 0.004
"""s, of each time."""
KEYS: Final = {"mu": "friction.mu_0", "drag_area": "drag.drag_area_m2", "speed": "start.speed_m_per_s"}
CASES: Final = {"photo cells, two free": 2, "photo cells, three free": 3}
"""How many of the keys are unknown."""


def one_glide(case: str, seed: int) -> list[tuple[str, Row]]:
    """Start below the terminal speed; the identification begins at μ 0.03, C_dA 0.3 m², 4 m/s."""
    rng = np.random.default_rng([seed, 11])
    own = {"mu": rng.uniform(0.03, 0.08), "drag_area": rng.uniform(0.3, 0.6), "speed": rng.uniform(2.0, 6.0)}
    time = exact.passage_times(STATION, mass=mass(), angle=math.radians(ANGLE_DEG), **own)
    time = time + SD * rng.standard_normal(len(STATION))
    cells = PhotoCells("twin", (PhotoCellRun("1", STATION, time, np.full(len(STATION), SD)),))
    count = CASES[case]
    changes: dict[str, object] = {
        "slope.angle_deg": ANGLE_DEG,
        "friction.mu_0": 0.03,
        "drag.drag_area_m2": 0.3,
        "start.speed_m_per_s": 4.0 if count == len(KEYS) else float(own["speed"]),
        "start.heading_deg": 0.0,
    }
    found = identify(SCENARIO, cells, list(KEYS.values())[:count], changes=changes)
    return [(case, {"outcome": found.outcome, **_compared(found, own, count)})]


def mass() -> float:
    """Mass of the sledge with both skis (kg)."""
    scenario = scenario_file(SCENARIO).scenario
    return scenario.sledge.mass + 2.0 * scenario.ski.mass


def fisher_errors(values: dict[str, float], count: int) -> np.ndarray:
    """Square roots of the diagonal of (DᵀD/σ²)⁻¹, D the first columns of the closed form's derivatives."""
    every = exact.derivatives(STATION, mass=mass(), angle=math.radians(ANGLE_DEG), **values)
    design = every[:, :count] / SD
    return np.asarray(np.sqrt(np.diag(np.linalg.inv(design.T @ design))))


def _compared(found: Identification, own: dict[str, float], count: int) -> dict[str, str]:
    names = list(KEYS)[:count]
    best = own | {name: value for name in names if (value := found[KEYS[name]].value) is not None}
    at_best, at_truth = fisher_errors(best, count), fisher_errors(own, count)
    row: dict[str, str] = {}
    for i, name in enumerate(names):
        each = found[KEYS[name]]
        assert each.standard_error is not None
        row |= interval_row(each, own[name])
        row |= {
            f"{KEYS[name]} error over Fisher": number(each.standard_error / at_best[i]),
            f"{KEYS[name]} error over Fisher at the truth": number(each.standard_error / at_truth[i]),
        }
    return row
