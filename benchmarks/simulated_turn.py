"""Numbers of docs/validation/simulated-turn.md; `python -m benchmarks.simulated_turn` writes them (7 minutes)."""

import math
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from typing import Any, Final

import numpy as np
from tests.dynamics.test_free_flight import DURATION, tumbling_drift
from tests.simulation.runs import test_static_start, test_steady_circle, test_symmetries
from tests.simulation.runs.sledges import load, rigid_ski, scenario

from skisnow import Run
from skisnow.scenario import Solver, load_scenario
from skisnow.simulation.simulated_run import simulate
from skisnow.simulation.verification import refine

from .page_tables import write_tables

SNOWS: Final = (
    (0.04, 0.2), (0.04, 0.04), (0.2, 0.5), (0.2, 0.1), (1.0, 1.0), (1.0, 0.25), (1.0, 0.3), (90.0, 10.0), (90.0, 0.3),
)  # fmt: skip
"""H_V and S_f (N/mm³, N/mm²): for each hardness one that carves and others that skid."""
RATIOS: Final = (1.0, 2.0, 5.0, 10.0, 50.0)
LAST_BIT: Final = (("start.speed_m_per_s", 7.0), ("snow.H_V_N_per_mm3", 0.2), ("sledge.mass_kg", 80.0))


def table(head: Sequence[str], rows: Iterable[Sequence[str]], *, words: int) -> str:
    """Markdown; the first `words` columns are words, the others numbers."""
    lines = ["| " + " | ".join(head) + " |"]
    lines.append("| " + " | ".join(["---"] * words + ["---:"] * (len(head) - words)) + " |")
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def carved(**changes: Any) -> Run:
    return simulate(load_scenario("carved-46m", changes=changes))


def per_cent(share: float | None) -> str:
    return "" if share is None else f"{100.0 * share:.2g}"


def _refined(snow: tuple[float, float]) -> list[str]:
    run = carved(**{"snow.H_V_N_per_mm3": snow[0], "snow.S_f_N_per_mm2": snow[1]})
    moved = [refinement.end_moves for refinement in refine(run, simulate)]
    return [
        f"{snow[0]:g}", f"{snow[1]:g}", run.outcome, f"{run.run_length:.2f}", f"{run.energies['shear'][-1]:.0f}",
        per_cent(run.energy_balance_error), *("" if m is None else f"{100.0 * m:.2f}" for m in moved),
    ]  # fmt: skip


def convergence() -> str:
    """How far the end moves with each choice made twice as fine."""
    head = (
        "H_V (N/mm³)", "S_f (N/mm²)", "outcome", "path (m)", "lost to shear (J)", "energy residual (%)",
        "tolerance/2 (cm)", "elements × 2 (cm)", "lines/2 (cm)", "groove tolerance/2 (cm)",
    )  # fmt: skip
    with ProcessPoolExecutor(2) as pool:
        return table(head, pool.map(_refined, SNOWS), words=3)


def energies() -> str:
    """The balance of carved-46m over k_u/H_V."""
    rows = []
    for ratio in RATIOS:
        run = carved(**{"snow.unloading_ratio": ratio})
        lost = (f"{run.energies[name][-1]:.0f}" for name in ("penetration", "shear", "friction", "drag", "damping"))
        rows.append((f"{ratio:g}", f"{run.energy_exchanged:.0f}", *lost, per_cent(run.energy_balance_error)))
    names = (f"{name} (J)" for name in ("groove", "shear", "friction", "drag", "damping"))
    return table(("k_u/H_V", "exchanged (J)", *names, "residual (%)"), rows, words=0)


def exact() -> str:
    """Cases with an answer, and the results."""
    rows = [*flying(), *resting(), *straight(), *across(), *circling(), *symmetric()]
    return table(("case", "answer", "found", "test"), rows, words=4)


Row = tuple[str, str, str, str]


def flying() -> Iterable[Row]:
    """Free flight, tumbling."""
    for name, coarse, fine in zip(
        ("angular momentum", "energy"), tumbling_drift(1e-3), tumbling_drift(0.5e-3), strict=True
    ):
        found = f"{fine:.1e} of it lost after {DURATION:g} s in steps of 0.5 ms, {coarse:.1e} in 1 ms"
        yield f"free flight, tumbling: {name}", "conserved", found, "dynamics/test_free_flight"


def resting() -> Iterable[Row]:
    """Static start."""
    flat = scenario(ski=rigid_ski(), hardness=0.02)
    depth = test_static_start.at_start(flat).skis.edge_depth[0]
    known = load(flat) / 2.0 / (0.02e9 * 1.6 * 0.065)
    yield "at rest, rigid flat skis", "F/(H_V L W)", _off(depth, known), "runs/test_static_start"
    edged = scenario(ski=rigid_ski(), hardness=0.2, edge_deg=30.0, centre_height=0.1)
    found = test_static_start.at_start(edged).skis.edge_depth[0]
    sides = np.array(test_static_start.wedges(edged, math.radians(30.0)))[:, None]
    answer = "balance of two wedges, F = H_V L e²/(2 tan)"
    yield "at rest, rigid skis at 30°, the sledge leaning", answer, _off(found, sides), "runs/test_static_start"


def straight() -> Iterable[Row]:
    """Down the fall line on rigid flat skis."""
    run = test_steady_circle.straight(compaction=False)
    known = test_steady_circle.squared_speed(run.scenario, run.place[:, 0], 0.0, test_steady_circle.STRAIGHT_SPEED**2)
    yield (
        "straight run, friction and drag: v²(s)",
        "v∞² + (v₀² − v∞²) exp(−s/ℓ)",
        _off(run.speed**2, known),
        "runs/test_steady_circle",
    )
    elastic = test_steady_circle.straight(compaction=True, unloading_ratio=1.0)
    share = abs(elastic.energies["penetration"][-1]) / elastic.energies["friction"][-1]
    yield "the same on elastic snow: lost to the groove", "0", f"{share:.1e} of the friction", "runs/test_steady_circle"


def across() -> Iterable[Row]:
    """A cross slope."""
    enough = test_symmetries.sufficient_strength()
    for share in (0.97, 1.03):
        run = test_symmetries.across(strength=enough / share, duration=3.0)
        way = 1e3 * float(np.ptp(run.place[10:, 0]))
        answer = "grips" if share < 1.0 else "slips"
        asked = f"cross slope, m g sin α = {share:g} S_f ∫ e ds"
        yield asked, answer, f"moves {way:.2g} mm from 1 s to 3 s", "runs/test_symmetries"
    minute = test_symmetries.across(strength=0.5, duration=60.0)
    crept = 1e3 * float(np.linalg.norm(minute.place[-1] - minute.place[100]))
    yield "cross slope, from 10 s to 60 s", "no creep", f"{crept:.2g} mm", "runs/test_symmetries"


def circling() -> Iterable[Row]:
    """Rigid pre-bent skis."""
    fine = Solver(line_spacing=6e-3, fixed=True, step=0.5e-3)
    arc = test_steady_circle.RADIUS
    for words, solver in (("lines of 6 mm", fine), ("as default", None)):
        off = test_steady_circle.radius(test_steady_circle.circle(strength=5.0, solver=solver)) / arc - 1.0
        yield (
            f"steady circle on strong snow, {words}",
            f"R_sc cos ϑ = {arc:.2f} m",
            f"{100.0 * off:+.2f} %",
            "runs/test_steady_circle",
        )
    enough = test_steady_circle.sufficient_strength()
    for share in (0.8, 1.25, 2.0):
        found = test_steady_circle.radius(test_steady_circle.circle(strength=enough / share)) / arc
        answer = "grips: 1" if share < 1.0 else f"slips: {share:g}"
        yield f"steady circle, m v²/R = {share:g} S_f ∫ e ds: radius", answer, f"{found:.3f}", "runs/test_steady_circle"


def symmetric() -> Iterable[Row]:
    """Changes that must not matter."""
    run = carved()
    mirror = carved(**{"sledge.edge_angle_deg": -30.0, "start.heading_deg": 30.0})
    off = float(np.linalg.norm(mirror.place[-1] - run.place[-1] * [1.0, -1.0, 1.0]))
    yield "carved-46m mirrored: its end", "mirrored", f"off by {off:.1e} m", "runs/test_symmetries"
    worst = max(_moved(run, carved(**{key: value * (1.0 + 1e-12)})) for key, value in LAST_BIT)
    yield "carved-46m, one input by 10⁻¹² off: its end", "there", f"off by {worst:.1e} m", "runs/test_symmetries"
    fixed = replace(run.scenario, solver=replace(run.scenario.solver, fixed=True))
    nudged = replace(fixed, start=replace(fixed.start, speed=fixed.start.speed * (1.0 + 1e-12)))
    yield (
        "the same with fixed steps of 0.5 ms",
        "there",
        f"off by {_moved(simulate(fixed), simulate(nudged)):.1e} m",
        "runs/test_symmetries",
    )
    same = np.array_equal(run.place, carved().place)
    yield "carved-46m again", "the same bits", "the same" if same else "others", "runs/test_symmetries"


def _moved(one: Run, other: Run) -> float:
    return float(np.linalg.norm(one.place[-1] - other.place[-1]))


def _off(found: Any, known: Any) -> str:
    return f"off by {float(np.max(np.abs(np.asarray(found) / known - 1.0))):.1e} of it"


def main() -> None:
    """Write the tables of the page."""
    tables: dict[str, Callable[[], str]] = {"exact": exact, "energies": energies, "convergence": convergence}
    for name, filled in tables.items():
        write_tables("validation/simulated-turn", {name: filled()})


if __name__ == "__main__":
    main()
