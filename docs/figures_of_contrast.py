"""Compute the gallery's contrast of hypoplastic and elastic snow by kind of snow: python docs/figures_of_contrast.py.

Draws its figures and writes its tables into docs/gallery/turn-contrast-snows.md, between the marks there. Some 80 runs,
in as many processes as a number behind it says.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from fewer_colours import write_fewer_colours
from matplotlib.lines import Line2D

from skisnow import load_scenario, simulate
from skisnow.comparison.nearest_place import distance_from_path
from skisnow.report.figures.figure_files import write_figure
from skisnow.report.figures.style import COLOURS, DOUBLE_MM, GREY, legend_below, new_figure
from skisnow.report.turn.figures import LINE_STYLES, runs_compared

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from skisnow.simulation.run import Run

FloatArray = npt.NDArray[np.float64]
Runs = Mapping[tuple[str, str, float], "Run"]

DOCS = Path(__file__).resolve().parent
GALLERY = DOCS / "_static" / "gallery"
PAGE = DOCS / "gallery" / "turn-contrast-snows.md"
SCENARIOS = ("carver-42m", "giant-slalom-67m")
SNOWS: dict[str, dict[str, Any]] = {
    "race piste": {"snow.published": "race-piste"},
    "spring snow": {"snow.published": "spring-snow"},
    "recreational piste": {"snow.published": "recreational-piste"},
    "soft": {"snow.H_V_N_per_mm3": 0.04, "snow.S_f_N_per_mm2": 0.52},
    "hard": {"snow.H_V_N_per_mm3": 1.0, "snow.S_f_N_per_mm2": 0.52},
    "very hard": {"snow.H_V_N_per_mm3": 10.0, "snow.S_f_N_per_mm2": 0.52},
}
RATIOS = (10.0, 1.0, 2.0, 5.0, 50.0)
"""k_u/H_V; the first is the one that the others are held against, 1 is elastic."""
STRENGTHS = (0.06, 0.09, 0.12, 0.15, 0.2, 0.25, 0.3, 0.4, 0.52)
"""S_f (N/mm²) of the sweep at the race piste's H_V."""
MOMENT = 4.0
"""Time (s) at which the figures of tracks show the skis."""
STEADY = (0.3, 0.9)
"""Part of the simulated time over which means are taken: neither start nor end."""


@dataclass(frozen=True, slots=True)
class Held:
    """What the skis did in the steady part of a run; both skis together but for the depths."""

    profile: FloatArray  # of the loaded ski's edge depth along the stations, in parts of its greatest; mean over time
    greatest: float  # depth (m), mean over time
    behind: float  # share of the side force taken behind the boot
    grip_behind: float  # S_f ∫ e ds behind the boot, both skis (N)
    used: float  # side force in parts of the grip at hand
    radius: float  # median (m)


def held(run: Run) -> Held:
    """Look at the skis of a run."""
    steady = (run.time > STEADY[0] * run.time[-1]) & (run.time < STEADY[1] * run.time[-1])
    station = run.skis.station
    depth = np.maximum(run.skis.edge_depth[steady], 0.0)
    side, load = np.abs(run.skis.shear_per_length[steady]), run.skis.force_per_length[steady]
    loaded = np.argmax(np.trapezoid(load, -station, axis=2), axis=1)
    of_loaded = depth[np.arange(len(depth)), loaded]
    greatest = of_loaded.max(axis=1)
    strength = run.scenario.contact.snow.failure_shear_stress
    assert strength is not None  # a scenario has it
    grip, grip_behind = (strength * _over(depth, station, station < limit) for limit in (np.inf, 0.0))
    force, force_behind = (_over(side, station, station < limit) for limit in (np.inf, 0.0))
    return Held(
        profile=(of_loaded / greatest[:, None]).mean(axis=0),
        greatest=float(greatest.mean()),
        behind=force_behind / force,
        grip_behind=grip_behind / len(depth),
        used=force / grip,
        radius=float(np.median(np.abs(run.turn_radius[steady]))),
    )


def _over(values: FloatArray, station: FloatArray, where: npt.NDArray[np.bool_]) -> float:
    """Integral along both skis where asked, summed over time."""
    return float(np.trapezoid(np.where(where, values, 0.0), -station, axis=2).sum())


def apart(run: Run, other: Run) -> float:
    """Largest distance (m) of a run from the other's path, which goes on straight at its end."""
    onwards = other.place[-1] + other.velocity[-1] / np.linalg.norm(other.velocity[-1])
    return float(np.nanmax(distance_from_path(run.place, np.vstack([other.place, onwards]))))


def _computed(asked: tuple[str, dict[str, Any]]) -> Run:
    return simulate(load_scenario(asked[0], changes=asked[1]))


def all_runs() -> dict[tuple[str, str, float], Run]:
    """By scenario, snow (a name, or S_f as a number) and k_u/H_V."""
    asked = {
        (name, snow, ratio): (name, keys | {"snow.unloading_ratio": ratio})
        for snow, keys in SNOWS.items()
        for name in SCENARIOS
        for ratio in RATIOS
    }
    hardness = load_scenario(SCENARIOS[0]).contact.snow.snow_hardness / 1e9
    for strength in STRENGTHS:
        keys = {"snow.H_V_N_per_mm3": hardness, "snow.S_f_N_per_mm2": strength}
        for name in SCENARIOS:
            for ratio in RATIOS[:2]:
                asked[name, f"{strength:g}", ratio] = (name, keys | {"snow.unloading_ratio": ratio})
    with ProcessPoolExecutor(int(sys.argv[1]) if len(sys.argv) > 1 else None) as pool:
        return dict(zip(asked, pool.map(_computed, asked.values()), strict=True))


def contact_name(ratio: float) -> str:
    """Words for a legend."""
    return "elastic" if ratio == 1.0 else f"hypoplastic, k_u / H_V = {ratio:g}"


def table(runs: Runs, name: str) -> str:
    """Markdown: a row for each snow and contact."""
    lines = [
        "| snow | k_u/H_V | outcome | apart (m) | of the run (%) | radius (m) | depth (mm) | left at −0.4 m (%) | "
        "left at −0.6 m (%) | grip behind (N) | used (%) | force behind (%) |",
        "| --- | ---: | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |",
    ]
    for snow in SNOWS:
        reference = runs[name, snow, RATIOS[0]]
        for ratio in sorted(RATIOS):
            run = runs[name, snow, ratio]
            seen, away = held(run), apart(run, reference)
            left = np.interp((-0.4, -0.6), run.skis.station[::-1], seen.profile[::-1])
            first = f"{snow}" if ratio == 1.0 else ""
            lines.append(
                f"| {first} | {ratio:g} | {run.outcome} | {away:.2f} | {100 * away / run.run_length:.1f} | "
                f"{seen.radius:.1f} | {1e3 * seen.greatest:.2f} | {100 * left[0]:.0f} | {100 * left[1]:.0f} | "
                f"{seen.grip_behind:.0f} | {100 * seen.used:.0f} | {100 * seen.behind:.0f} |"
            )
    return "\n".join(lines)


def write_tables(runs: Runs) -> None:
    """Put the tables between their marks on the page."""
    text = PAGE.read_text(encoding="utf-8")
    for name in SCENARIOS:
        begin, end = f"<!-- {name} -->", f"<!-- end of {name} -->"
        before, rest = text.split(begin)
        text = f"{before}{begin}\n\n{table(runs, name)}\n\n{end}{rest.split(end)[1]}"
    PAGE.write_text(text, encoding="utf-8")


def depths(runs: Runs) -> Figure:
    """Depth along the loaded ski in parts of its greatest, mean over the steady part: scenarios over snows."""
    snows = ("race piste", "recreational piste", "hard")
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=105.0)
    grid = figure.subplots(2, 3, sharex=True, sharey=True)
    for row, name in zip(grid, SCENARIOS, strict=True):
        for axes, snow in zip(row, snows, strict=True):
            for place, ratio in enumerate(RATIOS):
                run = runs[name, snow, ratio]
                axes.plot(run.skis.station, 100.0 * held(run).profile, **_look(place))
            axes.axvline(0.0, color=GREY, linewidth=0.5)
            axes.set_title(f"{name}, {snow}", loc="left", fontsize=7.5)
    grid[0, 0].set_ylim(105.0, 0.0)
    for axes in grid[:, 0]:
        axes.set_ylabel("edge depth\n(% of the greatest)")
    for axes in grid[1]:
        axes.set_xlabel("position along the ski (m);\nboot = 0, tail left, tip right")
    legend_below(figure, _handles())
    return figure


def strengths(runs: Runs) -> Figure:
    """Distance of the elastic run from the hypoplastic one, and the grip that both use, over S_f."""
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=72.0)
    left, right = figure.subplots(1, 2)
    for place, name in enumerate(SCENARIOS):
        pairs = [[runs[name, f"{s:g}", ratio] for ratio in RATIOS[:2]] for s in STRENGTHS]
        share = [100.0 * apart(elastic, keeps) / keeps.run_length for keeps, elastic in pairs]
        left.plot(STRENGTHS, share, marker="o", color=COLOURS[place])
        for which, style in enumerate(LINE_STYLES[:2]):
            used = [100.0 * held(pair[which]).used for pair in pairs]
            right.plot(STRENGTHS, used, marker="o", color=COLOURS[place], linestyle=style)
    left.set_ylim(bottom=0.0)
    left.set_ylabel("tracks apart (% of the run)")
    right.set_ylim(0.0, 105.0)
    right.set_ylabel("grip used (%)")
    _label_strengths(left, right)
    handles = [Line2D([], [], marker="o", color=COLOURS[place], label=name) for place, name in enumerate(SCENARIOS)]
    handles += [
        Line2D([], [], color=GREY, linestyle=style, label=label)
        for style, label in zip(LINE_STYLES[:2], ("$k_u$ / $H_V$ = 10", "elastic"), strict=True)
    ]
    legend_below(figure, handles)
    return figure


def _label_strengths(*both: Axes) -> None:
    for axes in both:
        axes.set_xlim(left=0.0)
        axes.set_xlabel("failure shear stress $S_f$ (N/mm²)")


def _look(place: int) -> dict[str, Any]:
    return {"color": COLOURS[place], "linestyle": LINE_STYLES[place]}


def _handles() -> list[Line2D]:
    names = ["$k_u$ / $H_V$ = 10", "elastic", *(f"$k_u$ / $H_V$ = {ratio:g}" for ratio in RATIOS[2:])]
    return [Line2D([], [], label=name, **_look(place)) for place, name in enumerate(names)]


def _draw(name: str, draw: Any) -> None:
    path = GALLERY / f"{name}.png"
    write_figure(path, draw)
    write_fewer_colours(path, colours=128)


def main() -> None:
    """Compute, draw, write."""
    runs = all_runs()
    for snow in ("race piste", "recreational piste"):
        compared = {contact_name(ratio): runs["giant-slalom-67m", snow, ratio] for ratio in RATIOS}
        _draw(f"turn-contrast-tracks-{snow.replace(' ', '-')}", lambda: runs_compared(compared, at=MOMENT))  # noqa: B023
    _draw("turn-contrast-depth", lambda: depths(runs))
    _draw("turn-contrast-strength", lambda: strengths(runs))
    write_tables(runs)


if __name__ == "__main__":
    main()
