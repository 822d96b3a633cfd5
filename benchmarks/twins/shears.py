"""One twin for the snow's shear: S_f and u_y of a run that holds or slips, identified from its track."""

from typing import Final

import numpy as np

from skisnow.identification import identify
from skisnow.report.turn.chain import used_grip
from skisnow.scenario import load_scenario
from skisnow.simulation.simulated_run import simulate

from .kept import Row, interval_row, number
from .truth import Truth, finer, track_of

CASE: Final = "carved-46m, shear"
STRENGTH, DISPLACEMENT = "snow.S_f_N_per_mm2", "snow.shear_displacement_mm"
FREE: Final = (STRENGTH, DISPLACEMENT)
START: Final = {"run.duration_s": 3.0, STRENGTH: 0.2, DISPLACEMENT: 0.15}
"""Three seconds, and the middle of what is drawn: where the search begins."""
SLIPS: Final = 0.05
"""Share of the time from which on the more heavily loaded ski counts as slipping."""


def truth_of_shear(seed: int) -> dict[str, float]:
    """S_f from 0.08 to 0.5 N/mm² and u_y from 0.05 to 0.5 mm, even in their logarithms."""
    low, high = np.log([[0.08, 0.05], [0.5, 0.5]])
    return dict(zip(FREE, np.exp(np.random.default_rng([seed, 11]).uniform(low, high)).tolist(), strict=True))


def one_shear(case: str, seed: int) -> list[tuple[str, Row]]:
    """Result beside the truth."""
    values = truth_of_shear(seed)
    run = simulate(finer(load_scenario("carved-46m", changes={**START, **values})))
    found = identify("carved-46m", track_of(run, Truth(values, ""), seed), FREE, changes=START, workers=1)
    if found.outcome == "interrupted":
        raise KeyboardInterrupt
    row = {
        "outcome": found.outcome,
        "slips": "1" if (used_grip(run)[1] or 0.0) > SLIPS else "0",
        "correlation": number(float(found.correlation[0, 1])),
        "near the limit": "1" if any("near the limit of grip" in text for text in found.warnings) else "0",
        "simulations": str(found.effort.simulations),
        "wall_s": f"{found.effort.wall_s:.0f}",
    }
    for key in FREE:
        row |= interval_row(found[key], values[key])
    return [(case, row)]
