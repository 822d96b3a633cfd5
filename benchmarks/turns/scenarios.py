"""Random scenarios: how each run ends, ``python -m benchmarks scenarios --seed 0 --count 2000 --out FILE``.

They are physical, or with ``--any-values`` have any values that the keys allow (`allowed_keys`).

A scenario is its seed. FILE takes a line of JSON for each; what stands in it already is not computed again.
"""

from __future__ import annotations

import json
import multiprocessing
import queue
import time
import warnings
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

import numpy as np

from skisnow._support.errors import SkisnowError
from skisnow.scenario import Scenario, load_scenario
from skisnow.simulation.run import LOST, OPEN_SHARE, Run
from skisnow.simulation.simulated_run import simulate

from . import allowed_keys

DURATION: Final = 2.0
"""Simulated (s)."""
SAYING: Final = ("energy_open", "not_finite", "step_too_small")
"""Outcomes that say that the numbers are not to be relied on."""
ROUNDING: Final = 1e-9
"""Fall of a loss (J) that is rounding."""
LIMIT: Final = 60.0
"""Time (s) after which a run counts as one that hangs."""
UNIFORM: Final = {
    "sledge.edge_angle_deg": (-75.0, 75.0),
    "slope.angle_deg": (0.0, 50.0),
    "start.speed_m_per_s": (0.0, 40.0),
    "start.heading_deg": (-45.0, 45.0),
    "sledge.stance_width_m": (0.15, 0.5),
}
LOGARITHMIC: Final = {
    "snow.H_V_N_per_mm3": (0.02, 90.0),
    "snow.S_f_N_per_mm2": (0.04, 20.0),
    "snow.unloading_ratio": (1.0, 50.0),
}
CONTACTS: Final = ("hypoplastic", "elastic")


def changes(seed: int) -> dict[str, Any]:
    """Keys and values of a scenario over those of ``carved-46m``."""
    rng = np.random.default_rng(seed)
    out: dict[str, Any] = {key: float(rng.uniform(*ends)) for key, ends in UNIFORM.items()}
    out |= {key: float(np.exp(rng.uniform(*np.log(ends)))) for key, ends in LOGARITHMIC.items()}
    out["snow.penetration"] = CONTACTS[int(rng.integers(len(CONTACTS)))]
    if out["snow.penetration"] == "elastic":
        del out["snow.unloading_ratio"]
    return out | {"run.duration_s": DURATION}


def scenario(seed: int, *, any_values: bool = False) -> Scenario:
    return load_scenario("carved-46m", changes=allowed_keys.changes(seed) if any_values else changes(seed))


def greatest_fall(run: Run) -> float:
    """By how much (J) a loss is below a loss before it: 0, as energy that is lost does not come back."""
    return max(float((np.maximum.accumulate(run.energies[name]) - run.energies[name]).max()) for name in LOST)


def row(seed: int, *, any_values: bool = False) -> dict[str, Any]:
    """How a scenario ends."""
    begin = time.perf_counter()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            run = simulate(scenario(seed, any_values=any_values))
            found: dict[str, Any] = {"outcome": run.outcome, "simulated_s": float(run.time[-1]), "steps": run.steps}
            found |= {"open": run.has_residual_above(OPEN_SHARE), "fall_J": greatest_fall(run)}
            found |= {"open_J": run.energy_residual, "open_share": run.energy_balance_error}
        except SkisnowError as error:
            found = {"outcome": type(error).__name__, "words": str(error)}
    return {"seed": seed, **found, "seconds": round(time.perf_counter() - begin, 3)}


def rows(seeds: list[int], *, limit: float = LIMIT, any_values: bool = False) -> Iterator[dict[str, Any]]:
    """Of each seed; computed in a process of their own, which is ended where one takes longer than the limit."""
    left = list(seeds)
    while left:
        answers: multiprocessing.Queue[dict[str, Any]] = multiprocessing.Queue()
        worker = multiprocessing.Process(target=_work, args=(left, answers, any_values), daemon=True)
        worker.start()
        while left:
            try:
                found = answers.get(timeout=limit)
            except queue.Empty:
                worker.kill()
                found = {"seed": left[0], "outcome": "hangs" if worker.is_alive() else "died", "seconds": limit}
                yield found
                left.pop(0)
                break
            left.pop(0)
            yield found
        worker.join(timeout=1.0)


def _work(seeds: list[int], answers: multiprocessing.Queue[dict[str, Any]], any_values: bool) -> None:
    for seed in seeds:
        answers.put(row(seed, any_values=any_values))


def kept(path: Path | None) -> list[dict[str, Any]]:
    if path is None or not path.exists():
        return []
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]


def print_table(seed: int, count: int, path: Path | None, *, any_values: bool = False) -> None:
    """Compute what is not in the file yet, and print how many ended how."""
    found = {each["seed"]: each for each in kept(path)}
    for each in rows([s for s in range(seed, seed + count) if s not in found], any_values=any_values):
        found[each["seed"]] = each
        if path is not None:
            with path.open("a", encoding="utf-8") as file:
                file.write(json.dumps(each) + "\n")
    of = [each for s, each in sorted(found.items()) if seed <= s < seed + count]
    print("| ended | scenarios |\n| --- | --- |")
    for outcome, number in Counter(_words(each) for each in of).most_common():
        print(f"| {outcome} | {number} |")
    opened = [each["seed"] for each in of if each.get("open")]
    unsaid = [each["seed"] for each in of if each.get("open") and each["outcome"] not in SAYING]
    falls = [each["seed"] for each in of if each.get("fall_J", 0.0) > ROUNDING]
    slowest = max(of, key=lambda each: float(each["seconds"]))
    print(
        f"\nenergy open by more than 0.5 %: {opened or 'none'}; where the outcome does not say so: {unsaid or 'none'}"
    )
    print(f"losses that fall: {falls or 'none'}")
    print(f"{sum(each['seconds'] for each in of):.0f} s; the slowest, seed {slowest['seed']}: {slowest['seconds']} s")


def _words(each: dict[str, Any]) -> str:
    told = str(each.get("words", ""))
    beginning = told.split(":", maxsplit=1)[0].split(",", maxsplit=1)[0]
    return f"{each['outcome']}: {beginning}" if told else str(each["outcome"])
