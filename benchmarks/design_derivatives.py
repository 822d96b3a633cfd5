"""python -m benchmarks.design_derivatives [search|settings|cost|kinks|places]: exact derivatives of carves, and search.

``search``: a robust design with exact derivatives and with finite differences: five variables, three snows, the worst
deviation from 12 m, a limit of the grip. Solver, starts and tolerances are the same. Six sets of eight starts; all ways
run in turn, twice, and the shorter time counts; of the differences that step of three which takes the least time.
``settings``: each setting of the search (design/descent.py) times ½ and 2, with the first set of starts.
``cost``: results and new skis, in Newton iterations of the same equilibrium and in equilibria.
``kinks``: how near 1,000 everyday questions are to a change of state.
``places``: answers with the usual places across of the groove against those with 75.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable
from functools import partial
from typing import Any, Final

import numpy as np
import scipy.optimize  # noqa: F401 - its import does not count

from skisnow._support.arrays import FloatArray
from skisnow.carving.equilibrium import carve
from skisnow.carving.outputs import OUTPUTS
from skisnow.carving.result import radius_at_boot
from skisnow.carving.sensitivity import CONDITIONS, CarveDerivatives
from skisnow.carving.solve import Solution, _core_ski, refined, solved
from skisnow.design import descent
from skisnow.design.evaluation import Evaluator, Search
from skisnow.design.search import begins_of, searched_starts
from skisnow.design.task import Goal, design_task
from skisnow.ski import read_ski
from skisnow.ski.beam import clamped
from skisnow.ski.editing import shape_parameters, table_growth
from skisnow.ski.ski_file import ski_of_keys
from skisnow.snow import SnowProperties

STEPS: Final = (1e-4, 1e-5, 1e-6)
TRIES: Final = 200
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
    "starts": 8,
}
SEEDS: Final = range(58, 64)
"""Seeds of the random starts; each set contains the ski itself, too."""


class Differences(Evaluator):
    """The same outputs, with forward differences instead of exact derivatives."""

    step = 0.0

    def goal_growth(self, goal: Goal, z: FloatArray) -> FloatArray:
        """Growth of the goal's values with each variable."""
        here = self.goal_values(goal, z)
        return np.array([(self.goal_values(goal, z + self.step * one) - here) / self.step for one in np.eye(len(z))]).T


def searched(evaluator: Evaluator) -> tuple[float, float, float]:
    """Processor time (s), equilibria and objective of a search from the starts of its task."""
    began = time.process_time()
    best = searched_starts(Search(evaluator), begins_of(evaluator))[0]
    return time.process_time() - began, evaluator.equilibria, best.result


def compare_searches(repetitions: int = 2) -> None:
    """Print one row for each way, all seeds together, and the ratios of each seed to the quickest differences."""
    found: dict[float, list[tuple[float, float, float]]] = {step: [] for step in (0.0, *STEPS)}
    for seed in SEEDS:
        tries: list[dict[float, tuple[float, float, float]]] = []
        for _ in range(repetitions):
            tries.append({})
            for step in found:
                task = design_task(TASK | {"seed": seed})
                evaluator = Differences(task) if step else Evaluator(task)
                if isinstance(evaluator, Differences):
                    evaluator.step = step
                tries[-1][step] = searched(evaluator)
        for step, rows in found.items():
            rows.append(min(each[step] for each in tries))
    columns = {step: np.array(rows).T for step, rows in found.items()}
    print(f"{'derivatives':12} {'processor s':>12} {'equilibria':>11} {'objective':>14}")
    for step, (seconds, equilibria, objectives) in columns.items():
        name = f"step {step:g}" if step else "exact"
        print(f"{name:12} {seconds.sum():12.3f} {equilibria.sum():11.0f} {objectives.min():14.8g}")
    step = min(STEPS, key=lambda each: float(columns[each][0].sum()))
    print(f"step {step:g} over exact, all seeds and each:")
    for name, exact, differences in zip(("time", "equilibria", "objective"), columns[0.0], columns[step], strict=True):
        total = np.min if name == "objective" else np.sum
        ratios = [total(differences) / total(exact), *(differences / exact)]
        print(f"{name:12}", *(f"{ratio:9.5g}" for ratio in ratios))


def vary_settings() -> None:
    """Print equilibria and objective with each setting of the search halved and doubled."""
    settings = [name for name, value in vars(descent).items() if isinstance(value, int | float) and name.isupper()]

    def row(name: str) -> str:
        _, equilibria, objective = searched(Evaluator(design_task(TASK | {"seed": SEEDS[0]})))
        return f"{name:28} {equilibria:6.0f} {objective:.9g}"

    print(row("as they are"), flush=True)
    for name in settings:
        value = getattr(descent, name)
        for factor in (0.5, 2):
            setattr(descent, name, type(value)(factor * value))
            print(row(f"{name} x {factor}"), flush=True)
        setattr(descent, name, value)


def _least_ms(call: Callable[[], object]) -> float:
    times = []
    for _ in range(TRIES):
        began = time.perf_counter()
        call()
        times.append(time.perf_counter() - began)
    return 1e3 * min(times)


def print_costs() -> None:
    """Shortest times for the slalom ski at 45° and 800 N on a race piste."""
    snow = SnowProperties(0.21e9, 0.52e6, source="race piste")
    keys: dict[str, Any] = dict(read_ski("slalom").keys or {})
    ski = ski_of_keys(keys)
    request = carve(ski, snow, edge_angle=math.pi / 4.0, load=800.0, unloading_ratio=10.0).request
    assert request is not None
    model, conditions = request.model, request.conditions
    equilibrium = _least_ms(lambda: solved(model, conditions))
    iteration = equilibrium / solved(model, conditions).iterations
    print(f"equilibrium {equilibrium:.3f} ms, Newton iteration {iteration:.4f} ms")
    seeds = [output_seed(CarveDerivatives(request), name) for name in list(OUTPUTS)[:5]]

    times: dict[int, list[float]] = {1: [], 5: []}
    for _ in range(TRIES):
        for count, seconds in times.items():
            point = refined(model, conditions, request.solution)
            began = time.perf_counter()
            for seed in seeds[:count]:
                point.gradient(*seed)
            seconds.append(time.perf_counter() - began)
    first, five = (1e3 * min(times[count]) / iteration for count in (1, 5))
    refinement = _least_ms(lambda: refined(model, conditions, request.solution)) / iteration
    print(f"in iterations: refinement {refinement:.1f}, first result {first:.2f}, five {five:.2f}")

    def changed() -> dict[str, Any]:
        return keys | {"waist_width_mm": 66.0 + float(np.random.default_rng().uniform(0.0, 4.0))}

    def new_ski(names: tuple[str, ...]) -> None:
        new = ski_of_keys(changed())
        _core_ski(clamped(new, model.clamp_length, request.elements))
        for name in names:
            table_growth(new, name)

    all_names = shape_parameters(ski)
    of_search = ("ski.tip_width_mm", "ski.waist_width_mm", "ski.tail_width_mm", "edit.EI_N_m2", "ski.EI_N_m2[2]")
    for text, names in (("no shape", ()), ("shapes of five parameters", of_search), ("of all", all_names)):
        print(f"new ski, {text}: {_least_ms(partial(new_ski, names)) / equilibrium:.1f} equilibria")


def output_seed(derivatives: CarveDerivatives, name: str) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Growth of a result with the unknowns of the beam, depth and force."""
    growth = derivatives._output(name)
    assert growth is not None
    none = np.zeros(len(derivatives.at.solution.edge_depth))
    depth, force = (none if part is None else part for part in (growth.depth, growth.force))
    return growth.by_unknowns(derivatives.request.model), depth, force


def count_kinks(count: int = 1000) -> None:
    """Questions in steps of 5° and 100 N, skis of the catalogue, six snows, k_u/H_V from 2 to 50, 12 parameters."""
    random = np.random.default_rng(58)
    skis = [read_ski(name) for name in ("slalom", "giant-slalom", "carver")]
    names = (
        *(name for name in CONDITIONS if not name.startswith("snow.S_f")),
        "ski.tip_width_mm", "ski.waist_width_mm", "ski.tail_width_mm", "ski.camber_mm",
        "edit.sidecut_depth", "edit.EI_N_m2", "edit.GJ_N_m2",
    )  # fmt: skip
    nearest: list[float] = []
    while len(nearest) < count:
        snow = SnowProperties(1e9 * float(random.choice([0.04, 0.08, 0.21, 0.55, 1.0, 2.0])), 0.5e6, source="everyday")
        turn: dict[str, Any] = {
            "edge_angle": math.radians(5.0 * random.integers(2, 15)),
            "load": 100.0 * random.integers(3, 26),
            "unloading_ratio": float(random.choice([2.0, 5.0, 10.0, 20.0, 50.0])),
        }
        request = carve(skis[random.integers(3)], snow, **turn).request
        if request is None:
            continue
        found = CarveDerivatives(request).sensitivity("edge_depth_mm", names)
        nearest.append(min(each.kink for each in found if each.parameter_value))
    for limit in (1e-4, 1e-5, 1e-6):
        print(f"nearer than {limit:g} to a kink: {np.sum(np.array(nearest) < limit)} of {count} questions")


def compare_places(count: int = 60) -> None:
    """Random carves: deviation of radius and largest force from those with 75 places, denser towards the edge."""
    random = np.random.default_rng(60)
    skis = [read_ski(name) for name in ("slalom", "giant-slalom", "carver")]
    deviations: list[list[float]] = []
    while len(deviations) < count:
        hardness, ratio = np.exp(random.uniform(np.log([0.05e9, 1.0]), np.log([1e9, 100.0])))
        snow = SnowProperties(hardness, 0.5e6, source="random")
        turn: dict[str, Any] = {
            "edge_angle": math.radians(random.uniform(15.0, 65.0)),
            "load": random.uniform(300.0, 2500.0),
        }
        found = carve(skis[random.integers(3)], snow, unloading_ratio=ratio, **turn)
        if found.request is None or found.turn_radius_boot is None or found.force_per_length is None:
            continue
        request = found.request
        reach = 1.05 * request.model.stations.width.max() * math.cos(turn["edge_angle"])
        many = refined(
            request.model, request.conditions, request.solution, places=reach * np.linspace(0.0, 1.0, 75) ** 2
        )
        _, u, (depth, slope, stress), edge_depth, force = many.state()
        solution = Solution(True, 0, u, depth, slope, stress, edge_depth, force)
        radius = radius_at_boot(request.model, request.conditions, solution) or math.nan
        deviations.append([found.turn_radius_boot / radius - 1.0, found.force_per_length.max() / force.max() - 1.0])
    for name, column in zip(("radius", "largest force per length"), np.abs(deviations).T, strict=True):
        print(f"{name}: median {np.median(column):.1e}, largest {column.max():.1e}")


if __name__ == "__main__":
    commands = {"search": compare_searches, "settings": vary_settings, "cost": print_costs, "kinks": count_kinks}
    commands["places"] = compare_places
    commands[(sys.argv[1:] or ["search"])[0]]()
