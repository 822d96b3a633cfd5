"""python -m benchmarks.design_derivatives: a robust design with exact derivatives, and with finite differences.

Five variables, three snows, the worst deviation from 12 m, a limit of the grip. Solver, starts and tolerances are the
same; of the differences the best of three steps counts. Prints equilibria, processor time and the best objective.
"""

from __future__ import annotations

import time
from typing import Any, Final

import numpy as np
import scipy.optimize  # noqa: F401 - its import does not count

from skisnow._support.arrays import FloatArray
from skisnow.design.evaluation import Evaluator
from skisnow.design.problem import Search
from skisnow.design.task import Goal, design_task

STEPS: Final = (1e-4, 1e-5, 1e-6)
TASK: Final[dict[str, Any]] = {
    "ski": "slalom",
    "variables": {
        "sidecut_mm": [-10, 10],
        "waist_width_mm": [64, 74],
        "EI_factor": [0.7, 1.6],
        "EI_N_m2[2]": [180, 330],
        "EI_N_m2[4]": [180, 330],
    },
    "conditions": [
        {"H_V_N_per_mm3": hardness, "S_f_N_per_mm2": 0.52, "unloading_ratio": 10, "edge_angle_deg": 45, "load_N": 800}
        for hardness in (0.08, 0.21, 0.55)
    ],
    "goals": [
        {"output": "turn_radius_boot_m", "target": 12.0, "over": "worst"},
        {"output": "grip_utilisation", "at_most": 0.58},
    ],
}


class Differences(Evaluator):
    """The same outputs, with forward differences instead of exact derivatives."""

    step = 0.0

    def goal_growth(self, goal: Goal, z: FloatArray) -> FloatArray:
        """Growth of the goal's values with each variable."""
        here = self.goal_values(goal, z)
        return np.array([(self.goal_values(goal, z + self.step * one) - here) / self.step for one in np.eye(len(z))]).T


def searched(evaluator: Evaluator, starts: int) -> tuple[float, int, float]:
    """Best objective, equilibria and processor time (s) of a search from some starts."""
    search = Search(evaluator)
    random = np.random.default_rng(1)
    begins = [evaluator.start, *random.uniform(0.2, 0.8, (starts - 1, search.count))]
    began = time.process_time()
    best = min(search.result(search.run(begin)) for begin in begins)
    return best, evaluator.equilibria, time.process_time() - began


def main(starts: int = 2) -> None:
    """Print one row for each way."""
    print(f"{'derivatives':12} {'objective':>14} {'equilibria':>11} {'processor s':>12}")
    for step in (0.0, *STEPS):
        evaluator = Differences(design_task(TASK)) if step else Evaluator(design_task(TASK))
        if isinstance(evaluator, Differences):
            evaluator.step = step
        objective, equilibria, seconds = searched(evaluator, starts)
        name = f"step {step:g}" if step else "exact"
        print(f"{name:12} {objective:14.8g} {equilibria:11d} {seconds:12.2f}", flush=True)


if __name__ == "__main__":
    main()
