"""Where the energy of a run is and went, over time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt
from matplotlib.lines import Line2D

from ...simulation.run import LOST, STORED
from ..number_formatting import significant
from .style import (
    BLACK,
    BLUE,
    BROWN,
    DOUBLE_MM,
    GREEN,
    GREY,
    ORANGE,
    PALE,
    PURPLE,
    SAND,
    SKY,
    VERMILLION,
    legend_below,
    new_figure,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ...simulation.run import Run

FloatArray = npt.NDArray[np.float64]

_STYLES: Final = {
    "kinetic": (BLUE, "kinetic"),
    "potential": (SKY, "potential, above its minimum"),
    "elastic_ski": (GREY, "in the bent skis"),
    "elastic_snow": (PALE, "in the pressed snow"),
    "delayed_snow": (SAND, "in the delayed depth"),
    "penetration": (GREEN, "lost: groove"),
    "shear": (VERMILLION, "lost: side-slip"),
    "friction": (ORANGE, "lost: friction"),
    "drag": (PURPLE, "lost: air"),
    "damping": (BLACK, "lost: damping"),
    "snow_damping": (BROWN, "lost: damping of the snow"),
}
_RATE: Final = ("delayed_snow", "snow_damping")


def run_energies(run: Run) -> Figure:
    """Draw what is stored and lost on top of each other: a level upper rim is a zero residual. Right: losses alone."""
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=80.0)
    every, losses = figure.subplots(1, 2, width_ratios=(1.25, 1.0))
    shares = stacked_energies(run)
    _stack(every, run, shares, (*STORED, *LOST))
    total = sum(shares[name][0] for name in STORED)
    every.axhline(float(total), color=BLACK, linewidth=0.8, linestyle=(0, (4, 2)))
    every.set_title(_closing(run), loc="left", fontsize=7.5)
    _stack(losses, run, shares, LOST)
    losses.set_title("losses alone", loc="left", fontsize=7.5)
    drawn = [style for name, style in _STYLES.items() if name not in _RATE or shares[name].any()]
    legend_below(figure, [Line2D([], [], color=colour, linewidth=5.0, label=label) for colour, label in drawn])
    return figure


def stacked_energies(run: Run) -> dict[str, FloatArray]:
    """Each energy and each loss over time (J); the potential one from its minimum."""
    found = {name: run.energies[name] for name in (*STORED, *LOST)}
    found["potential"] = found["potential"] - np.nanmin(found["potential"])
    return found


def _stack(axes: Axes, run: Run, shares: dict[str, FloatArray], names: tuple[str, ...]) -> None:
    axes.stackplot(
        run.time, [shares[name] for name in names], colors=[_STYLES[name][0] for name in names], linewidth=0.0
    )
    axes.set_xlim(float(run.time[0]), float(run.time[-1]))
    axes.set_xlabel("time (s)")
    axes.set_ylabel("energy (J)")


def _closing(run: Run) -> str:
    error = run.energy_balance_error
    if error is None or not np.isfinite(error):
        return "no energy was exchanged" if error is None else "not finite at the end"
    over = significant(run.energy_exchanged)
    return f"residual {significant(100.0 * error, 2)} % of {over} J exchanged; dashed: the start"
