"""The tables of the pages on shear and friction in turns, computed again: python docs/tables_of_turns.py [PAGE ...].

Some 70 turns: a minute or two of one core. A page is such as ``methods/side-force``.
"""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

sys.path.append(str(Path(__file__).parents[1]))
from benchmarks.page_tables import write_tables

from skisnow import Run, load_scenario, simulate
from skisnow._support.errors import RangeWarning
from skisnow.forces.shear import AngleShear, ConstantShear, MachiningShear, ShearLaw
from skisnow.report.run.time_figures import grip_utilisation, gross_grip_utilisation, slip_of_a_place

LAWS: dict[str, dict[str, object]] = {
    "S_f": {},
    "S_f (1 − 0.266 ϑ)": {"shear.law": "by-angle", "shear.relative_decrease_per_rad": 0.266},
    "cutting, μ_t = 0": {"shear.law": "machining", "shear.transverse_friction": 0.0},
    "cutting, μ_t = 0.2": {"shear.law": "machining", "shear.transverse_friction": 0.2},
    "r = 0.7, d = 1 mm": {"shear.residual_ratio": 0.7, "shear.slip_weakening_mm": 1.0},
    "r = 0.4, d = 1 mm": {"shear.residual_ratio": 0.4, "shear.slip_weakening_mm": 1.0},
    "r = 0.4, d = 10 mm": {"shear.residual_ratio": 0.4, "shear.slip_weakening_mm": 10.0},
}
SNOWS = {"0.2, 0.5": tuple(LAWS), "0.2, 0.1": tuple(LAWS), "1, 0.3": tuple(LAWS)[:5]}
TURNS = ("carved-46m", "carver-42m", "giant-slalom-67m")
SKIDS = {"skid: H_V 0.2, S_f 0.1": (0.2, 0.1), "skid: 1, 0.25": (1.0, 0.25), "ice: 90, S_f 10": (90.0, 10.0)}
SKID_LENGTH = 1.45
"""Edge (m) of a ski that slides across."""
SKID_LAWS: dict[str, tuple[Callable[[float], ShearLaw], float]] = {
    "S_f": (ConstantShear, 1.0),
    "S_f (1 − 0.266 ϑ)": (lambda stress: AngleShear(stress, 0.266), 1.0),
    "r = 0.7": (ConstantShear, 0.7),
    "r = 0.5": (ConstantShear, 0.5),
    "r = 0.3": (ConstantShear, 0.3),
    "cutting, μ_t = 0": (lambda stress: MachiningShear(0.5 * stress, 0.0), 1.0),
    "cutting, μ_t = 0.2": (lambda stress: MachiningShear(0.5 * stress, 0.2), 1.0),
}
"""Law of an S_f (N/m²), and the share of its strength that is left after slip."""
SKID_SNOWS = ((0.21, 0.52), (0.16, 0.086), (0.2, 0.1), (1.0, 0.52), (1.0, 0.3), (5.0, 0.52))
POSE = ("x_m", "y_m", "z_m", "edge_angle_deg", "pitch_deg", "heading_deg")
HEIGHTS = {5.0: 2.9e-3, 20.0: 11.3e-3, 30.0: 16.4e-3}
"""Height of the boot (m) by edge angle (degrees)."""
MOVED: dict[str, object] = {
    "ski.name": "slalom",
    "slope.angle_deg": 0.0,
    "snow.published": "race-piste",
    "sledge.edge_angle_deg": 0.0,
    "start.heading_deg": 0.0,
    "start.speed_m_per_s": 8.0,
    "run.duration_s": 0.5,
    "friction.mu_0": 0.0,
}
SLIPS = (0.5, 1.0, 2.0, 3.0, 5.0, 20.0)
"""Angles (degrees) between the heading of a ski and its course."""
DISPLACEMENTS = (1.0, 0.5, 0.25, 0.1, 0.05, 0.02, 0.01)


@cache
def turn(name: str, *changes: tuple[str, object]) -> Run:
    """A run of a built-in scenario with changes."""
    print(name, *changes, file=sys.stderr)
    return simulate(load_scenario(name, changes=dict(changes)))


def on_snow(hardness: float, strength: float) -> tuple[tuple[str, object], ...]:
    """Changes of H_V and S_f (N/mm³, N/mm²)."""
    return ("snow.H_V_N_per_mm3", hardness), ("snow.S_f_N_per_mm2", strength)


def end(run: Run, digits: int = 2) -> str:
    """Of the run: x and y (m)."""
    return f"{run.place[-1, 0]:.{digits}f}, {run.place[-1, 1]:.{digits}f}".replace("-", "−")


def apart(one: Run, other: Run) -> float:
    """Distance of the ends (m)."""
    return math.dist(one.place[-1], other.place[-1])


def deepest(run: Run) -> float:
    """Depth (mm) of the deepest place of an edge, median over the second half of the run."""
    late = run.time >= run.time[-1] / 2.0
    return 1e3 * float(np.median(run.skis.edge_depth[late].max(axis=(1, 2))))


def shear_laws() -> Iterator[str]:
    """Three snows with each law: where the run ends, how fast, how deep, what shear takes."""
    yield "| H_V, S_f | law | end (m) | from the first (m) | speed (m/s) | depth (mm) | lost to shear (J) |"
    yield "| --- | --- | --- | ---: | ---: | ---: | ---: |"
    for snow, laws in SNOWS.items():
        changes = on_snow(*map(float, snow.split(", ")))
        first = turn("carved-46m", *changes)
        for law in laws:
            run = turn("carved-46m", *changes, *LAWS[law].items())
            head = f"| {f'{snow} ' if law == laws[0] else ''}| {law} | {end(run)} | {apart(run, first):.1f} |"
            yield f"{head} {run.speed[-1]:.2f} | {deepest(run):.2f} | {run.energies['shear'][-1]:.0f} |"


def skid_force(angle: float, load: float, *, hardness: float, law: ShearLaw, left: float = 1.0) -> float:
    """Side force (N) of a straight ski that slides across new snow at an edge angle (rad) under a load (N).

    The edge lies as deep as H_V L e²/(2 tan ϑ) and the law's thrust carry the load; the shear keeps the share `left`.
    """
    stress, thrust = (left * float(each) for each in law.stress_and_thrust(np.array([1e-3]), np.array([angle])).ravel())
    spring = hardness * SKID_LENGTH / (2.0 * math.tan(angle))
    pressed = thrust * SKID_LENGTH
    depth = (math.sqrt(pressed**2 + 4.0 * spring * load) - pressed) / (2.0 * spring)
    return stress * depth * SKID_LENGTH


def holding_angle(load: float, **snow: Any) -> float:
    """Smallest edge angle (degrees) whose side force is the load, 1 g sideways; infinite above 85°."""
    angles = np.radians(np.arange(0.1, 85.0, 0.1))
    holds = [skid_force(float(angle), load, **snow) >= load for angle in angles]
    return float(np.degrees(angles[holds.index(True)])) if True in holds else math.inf


def skid_angles() -> Iterator[str]:
    """Rows of the smallest edge angles that hold 1 g in a skid, by snow and law."""
    yield "| H_V, S_f | " + " | ".join(SKID_LAWS) + " |"
    yield "| --- |" + " ---: |" * len(SKID_LAWS)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        for hardness, strength in SKID_SNOWS:
            found = []
            for law, left in SKID_LAWS.values():
                snow = {"hardness": hardness * 1e9, "law": law(strength * 1e6), "left": left}
                found.append(", ".join(degrees(holding_angle(load, **snow)) for load in (400.0, 800.0)))
            yield f"| {hardness:g}, {strength:g} | " + " | ".join(found) + " |"


def degrees(angle: float) -> str:
    """An angle in whole degrees; none if it is infinite."""
    return f"{angle:.0f}°" if math.isfinite(angle) else "none"


def pulled(edge: float, slip: float, height: float) -> tuple[float, float, float]:
    """Load (N), side force over the formula of a straight edge, and yaw moment about the boot (N m) of a slalom ski.

    It is moved at 8 m/s at a height (m) over the race piste, with angles in degrees; the other ski is in the air.
    """
    names = [f"{side}_{name}" for side in ("left", "right") for name in POSE]
    rows = [(t, 8 * t, 0.25, height, edge, 0, slip, 8 * t, -0.25, 0.3, 0, 0, slip) for t in np.linspace(0.0, 0.5, 26)]
    with TemporaryDirectory() as folder:
        path = Path(folder) / "boots.csv"
        lines = [",".join(("time_s", *names)), *(",".join(map(str, row)) for row in rows)]
        path.write_text("\n".join(lines), encoding="utf-8")
        run = turn("carved-46m", *MOVED.items(), ("boots.file", str(path)))
    assert run.boots is not None
    late = len(run.time) // 2
    force, moment = (values[late:, 0].mean(axis=0) for values in (run.boots.force, run.boots.moment))
    angle, snow = math.radians(slip), run.scenario.contact.snow
    length = run.scenario.ski.running_length
    wedge = math.sqrt(2.0 * length * force[2] * math.tan(math.radians(edge)) / snow.snow_hardness)
    across = force[1] * math.cos(angle) - force[0] * math.sin(angle)
    return float(force[2]), across / (wedge * (snow.failure_shear_stress or 0.0)), float(moment[2])


def blade_and_slider() -> Iterator[str]:
    """Load, side force and yaw moment over the slip, at heights that load the slider with about 400 N."""
    yield "| slip | " + " | ".join(f"edge angle {edge:g}°" for edge in HEIGHTS) + " |"
    yield "| ---: |" + " --- |" * len(HEIGHTS)
    for slip in SLIPS:
        cells = (pulled(edge, slip, height) for edge, height in HEIGHTS.items())
        yield (
            f"| {slip:g}° | "
            + " | ".join(f"{load:.0f} N, {share:.2f}, {turn:.0f} N m" for load, share, turn in cells)
            + " |"
        )


def friction_loads() -> Iterator[str]:
    """The built-in turns with friction on both loads."""
    heads = ("run", "friction (J): snow-normal, base-normal", "their ratio", "1/cos ϑ", "speed at the end (m/s)")
    yield f"| {' | '.join(heads)} | ends apart (m) |"
    yield "| --- | --- | ---: | ---: | --- | ---: |"
    for name in TURNS:
        runs = [turn(name, ("friction.acts_on", each)) for each in ("snow-normal", "base-normal")]
        lost = [float(run.energies["friction"][-1]) for run in runs]
        lean = 1.0 / math.cos(runs[0].scenario.sledge.edge_angle)
        yield (
            f"| `{name}` | {lost[0]:.0f}, {lost[1]:.0f} | {lost[1] / lost[0]:.2f} | {lean:.3f} | "
            f"{runs[0].speed[-1]:.2f}, {runs[1].speed[-1]:.2f} | {apart(*runs):.2f} |"
        )


def displacements() -> Iterator[str]:
    """Ends over u_y, of carves and of skids."""
    yield f"| u_y (mm) | {' | '.join((*TURNS, *SKIDS))} |"
    yield f"| ---: |{' --- |' * (len(TURNS) + len(SKIDS))}"
    for value in DISPLACEMENTS:
        runs = [turn(name, ("snow.shear_displacement_mm", value)) for name in TURNS]
        runs += [turn("carved-46m", *on_snow(*snow), ("snow.shear_displacement_mm", value)) for snow in SKIDS.values()]
        yield f"| {value:g} | {' | '.join(map(end, runs))} |"


def friction_directions() -> Iterator[str]:
    """Motion of the end and change of its speed from friction along the ski to friction against the sliding."""
    yield "| run | μ 0.01 | μ 0.05 | μ 0.1 |"
    yield "| --- | ---: | ---: | ---: |"
    snows = {
        "`carved-46m`": (),
        "skid, S_f 0.1 N/mm²": on_snow(0.2, 0.1),
        "skid, H_V 1 N/mm³, S_f 0.25 N/mm²": on_snow(1.0, 0.25),
    }
    for name, changes in snows.items():
        cells = []
        for friction in (0.01, 0.05, 0.1):
            along, vector = (
                turn("carved-46m", *changes, ("friction.mu_0", friction), ("friction.direction", direction))
                for direction in ("along-ski", "vector")
            )
            faster = round(vector.speed[-1] - along.speed[-1], 2) + 0.0  # no -0.00
            cells.append(f"{apart(along, vector):.2f} m, {faster:.2f} m/s".replace("-", "−"))
        yield f"| {name} | {' | '.join(cells)} |"


GROUND: dict[str, dict[str, Any]] = {
    "flat and sharp": {},
    "β = 0.5°": {"base_bevel": math.radians(0.5)},
    "β = 1°": {"base_bevel": math.radians(1.0)},
    "r = 0.02 mm": {"edge_radius": 2e-5},
    "r = 0.1 mm": {"edge_radius": 1e-4},
    "r = 0.1 mm, σ = 87°": {"edge_radius": 1e-4, "side_edge": math.radians(87.0)},
}


def ground_edges() -> Iterator[str]:
    """Ends (m) over grinding, on three snows."""
    yield "| edges | the scenario's snow | H_V 5 N/mm³ | skid, S_f 0.1 N/mm² |"
    yield "| --- | --- | --- | --- |"
    snows: tuple[dict[str, float], ...] = ({}, {"snow.H_V_N_per_mm3": 5.0}, {"snow.S_f_N_per_mm2": 0.1})
    for name, edges in GROUND.items():
        scenarios = [load_scenario("carved-46m", changes=dict(changes)) for changes in snows]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            runs = [simulate(each.with_(ski=replace(each.ski, **edges))) for each in scenarios]
        yield f"| {name} | {' | '.join(end(run, 3) for run in runs)} |"


def shear_bearing() -> Iterator[str]:
    """Both options of the bearing over u_y: end, energy of shear, and medians of the grip of both skis."""
    heads = ("end (m)", "shear takes (J)", "net", "gross", "slip of a place (mm)")
    yield f"| `shear.bearing` | u_y (mm) | {' | '.join(heads)} |"
    yield "| --- | ---: | --- | ---: | --- | --- | ---: |"
    for bearing in ("whole-edge", "loaded-height"):
        for value in (0.02, 0.1, 0.5, 1.0):
            run = turn("carved-46m", ("shear.bearing", bearing), ("snow.shear_displacement_mm", value))
            late = run.time >= run.time[-1] / 2.0
            net, gross = (
                ", ".join(f"{share:.2f}" for share in np.nanmedian(shares(run)[late], axis=0))
                for shares in (grip_utilisation, gross_grip_utilisation)
            )
            lost = f"{run.energies['shear'][-1]:.0f} | {net} | {gross} | {1e3 * slip_of_a_place(run):.2f}"
            yield f"| `{bearing}` | {value:g} | {end(run, 3)} | {lost} |"


PAGES = {
    "methods/side-force": {
        "shear laws": shear_laws,
        "skid angles": skid_angles,
        "displacements": displacements,
        "blade": blade_and_slider,
    },
    "methods/snow-options": {"friction loads": friction_loads, "friction direction": friction_directions},
    "methods/ski": {"ground": ground_edges, "shear bearing": shear_bearing},
}


def spoken() -> Iterator[str]:
    """Numbers of the sentences on these pages."""
    carve, displacement = "carved-46m", "snow.shear_displacement_mm"
    for name in TURNS:
        loose, usual, tight = (turn(name, (displacement, value)) for value in (0.5, 0.02, 0.01))
        yield f"{name}: 0.02 to 0.01 mm {apart(usual, tight):.3f} m, 0.5 to 0.02 mm {apart(loose, usual):.2f} m"
        yield f"{name}: steps at 0.5, 0.02 and 0.01 mm {loose.steps}, {usual.steps}, {tight.steps}"
    usual, tight = turn(carve), turn(carve, (displacement, 0.01))
    elements, spacing = usual.numbers["elements"], 1e3 * usual.numbers["line_spacing_m"]
    finer = (
        ("solver.tolerance_mm", 1e-4),
        ("solver.line_spacing_mm", spacing / 4.0),
        ("solver.elements", int(2 * elements)),
    )
    for change in finer:
        yield f"{carve}, {change[0]} {change[1]:g}: {1e3 * apart(usual, turn(carve, change)):.1f} mm"
    yield f"at 0.01 mm, {finer[0][0]}: {1e3 * apart(tight, turn(carve, (displacement, 0.01), finer[0])):.1f} mm"
    skid = turn(carve, *on_snow(0.2, 0.1))
    fixed = [turn(carve, *on_snow(0.2, 0.1), ("solver.fixed", True), ("solver.step_ms", h)) for h in (0.25, 0.125)]
    yield f"skid, fixed steps of 0.125 ms {apart(skid, fixed[1]):.2f} m, from 0.25 to 0.125 ms {apart(*fixed):.2f} m"
    for share in (1.004, 0.996, 0.7):
        yield f"skid, S_f times {share}: {apart(skid, turn(carve, *on_snow(0.2, 0.1 * share))):.2f} m"
    for value in (0.05, 0.02):
        run = turn(carve, *on_snow(1.0, 0.3), (displacement, value))
        yield f"(1, 0.3) at {value} mm: slip angle {slip_angle(run):.0f}°, {run.energies['shear'][-1]:.0f} J to shear"
    loads = [turn(carve, ("friction.acts_on", each), (displacement, 0.5)) for each in ("snow-normal", "base-normal")]
    lost = [run.energies["friction"][-1] for run in loads]
    yield f"friction base-normal over snow-normal at 0.5 mm: {lost[1] / lost[0]:.2f}"


def slip_angle(run: Run) -> float:
    """The largest angle (degrees) between skis and path."""
    path = np.unwrap(np.arctan2(run.velocity[:, 1], run.velocity[:, 0]))
    return float(np.degrees(np.abs(run.heading - path)).max())


def main() -> None:
    """Write the tables of the pages that are named, or of all; with --spoken print the numbers of their sentences."""
    if sys.argv[1:] == ["--spoken"]:
        print(*spoken(), sep="\n")
        return
    for page in sys.argv[1:] or PAGES:
        write_tables(page, {name: rows() for name, rows in PAGES[page].items()})


if __name__ == "__main__":
    main()
