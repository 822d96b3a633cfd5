"""Figures of a run over time: motion, energies, balance, boots, grip, and loads along the skis."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ..._support.arrays import FloatArray
from ..._support.messages import Message
from ..._support.units import DEGREE, MM
from ...simulation.run import LOST, STORED, Run
from ...track.turns import STRAIGHT
from ..figures import style
from ..figures.course import edge_angles_of_skis
from ..formatting import significant
from .track_figure import SKI_COLOURS, SKIS

_TIMES_MEDIAN: Final = 3.0  # ratio of a radius to the median above which it is not drawn


def run_motion(run: Run) -> Figure:
    """Draw speed, heading and turn radius over time."""
    figure = style.new_figure(width_mm=style.DOUBLE_MM, height_mm=118.0)
    speed, heading, radius = figure.subplots(3, 1, sharex=True)
    speed.plot(run.time, run.speed, color=style.BLUE)
    speed.set_ylabel(Message("speed (m/s)"))
    speed.set_ylim(0.0, 1.12 * max(float(np.nanmax(run.speed)), 0.1))
    heading.plot(run.time, run.heading / DEGREE, color=style.BLUE)
    heading.axhline(0.0, color=style.PALE, linewidth=0.6, zorder=0)
    heading.set_ylabel(Message("heading (°)\nleft of the fall line +"))
    _draw_radius(radius, run)
    style.label_time(radius, run.time)
    figure.align_ylabels()
    return figure


def _draw_radius(axes: Axes, run: Run) -> None:
    """Draw the turn radius over time, and sidecut radius × cos ϑ as a line if the edge angle is fixed."""
    values = drawn_radius(run.turn_radius)
    axes.plot(run.time, values, color=style.BLUE)
    axes.axhline(0.0, color=style.PALE, linewidth=0.6, zorder=0)
    angle = run.scenario.sledge.edge_angle
    if angle != 0.0 and run.boots_by is None:
        carved = math.copysign(run.scenario.ski.sidecut_radius_of_three_widths * math.cos(angle), angle)
        axes.axhline(carved, color=style.GREY, linestyle=(0, (1, 1.2)), linewidth=0.9)
        axes.annotate(
            Message("sidecut radius × cos ϑ"), (1.0, carved), (0, 6), xycoords=("axes fraction", "data"),
            textcoords="offset points", ha="right", va="bottom", fontsize=6.5, color=style.GREY,
        )  # fmt: skip
    axes.set_ylabel(Message("turn radius (m)\nto the left +"))


def drawn_radius(radius: FloatArray) -> FloatArray:
    """Turn radii, NaN where the path is nearly straight: above `STRAIGHT` or three times the median."""
    size = np.abs(radius[np.isfinite(radius)])
    if not size.size:
        return np.full_like(radius, np.nan)
    return np.where(np.abs(radius) <= min(_TIMES_MEDIAN * float(np.median(size)), STRAIGHT), radius, np.nan)


ENERGY_STYLES: Final = {
    "kinetic": (style.BLUE, Message("kinetic")),
    "potential": (style.SKY, Message("potential")),
    "elastic_ski": (style.GREY, Message("in the bent skis")),
    "elastic_snow": (style.PALE, Message("in the pressed snow")),
    "delayed_snow": (style.SAND, Message("in the delayed depth")),
    "penetration": (style.GREEN, Message("lost: groove")),
    "shear": (style.VERMILLION, Message("lost: side-slip")),
    "friction": (style.ORANGE, Message("lost: friction")),
    "drag": (style.PURPLE, Message("lost: air")),
    "damping": (style.BLACK, Message("lost: damping")),
    "snow_damping": (style.BROWN, Message("lost: damping of the snow")),
}
"""Colour and name of each energy."""
_RATE: Final = ("delayed_snow", "snow_damping")


def run_energies(run: Run) -> Figure:
    """Draw energies and losses stacked, whose sum is constant if the residual is zero; beside it only the losses."""
    figure = style.new_figure(width_mm=style.DOUBLE_MM, height_mm=80.0)
    total_axes, losses = figure.subplots(1, 2, width_ratios=(1.25, 1.0))
    shares = stacked_energies(run)
    _draw_stack(total_axes, run, shares, (*STORED, *LOST))
    total = sum(shares[name][0] for name in STORED)
    total_axes.axhline(float(total), color=style.BLACK, linewidth=0.8, linestyle=(0, (4, 2)))
    total_axes.set_title(_residual_in_words(run), loc="left", fontsize=7.5)
    _draw_stack(losses, run, shares, LOST)
    losses.set_title(Message("losses alone"), loc="left", fontsize=7.5)
    drawn = [entry for name, entry in ENERGY_STYLES.items() if name not in _RATE or shares[name].any()]
    style.legend_below(figure, [Line2D([], [], color=colour, linewidth=5.0, label=label) for colour, label in drawn])
    return figure


def stacked_energies(run: Run) -> dict[str, FloatArray]:
    """Stored energies and losses over time (J); the potential energy is counted from its minimum."""
    energies = {name: run.energies[name] for name in (*STORED, *LOST)}
    energies["potential"] = energies["potential"] - np.nanmin(energies["potential"])
    return energies


def _draw_stack(axes: Axes, run: Run, shares: dict[str, FloatArray], names: tuple[str, ...]) -> None:
    """Draw the energies (J) with these names over time, on top of each other."""
    axes.stackplot(
        run.time, [shares[name] for name in names], colors=[ENERGY_STYLES[name][0] for name in names], linewidth=0.0
    )
    style.label_time(axes, run.time)
    axes.set_ylabel(Message("energy (J)"))


def _residual_in_words(run: Run) -> str:
    """Text with the residual of the energy balance in percent of the energy exchanged."""
    error = run.energy_balance_error
    if error is None or not np.isfinite(error):
        return Message("no energy was exchanged") if error is None else Message("not finite at the end")
    over = significant(run.energy_exchanged)
    return Message(
        "residual {value} % of {over} J exchanged; dashed: the start", value=significant(100.0 * error, 2), over=over
    )


def run_balance(run: Run) -> Figure:
    """Draw leans, and total, normal and side force of the snow on each ski, over time."""
    figure = style.new_figure(width_mm=style.DOUBLE_MM, height_mm=156.0)
    leans, totals, normals, sides = figure.subplots(4, 1, sharex=True)
    balance, boots = run.balance, run.boots
    assert boots is not None
    edge = balance.lean + balance.angulation
    leans.plot(run.time, edge / DEGREE, color=style.ORANGE, label=Message("edge angle"))
    leans.plot(run.time, balance.lean / DEGREE, color=style.BLUE, label=Message("lean"))
    leans.plot(run.time, balance.balanced_lean / DEGREE, color=style.GREY, linewidth=0.8, linestyle=(0, (2, 1)),
               label=Message("lean in balance"))  # fmt: skip
    most = 1.15 * float(np.nanmax(np.abs(np.concatenate([edge, balance.lean])))) / DEGREE
    leans.set_ylim(-max(most, 1.0), max(most, 1.0))
    leans.set_ylabel(Message("lean, edge angle (°)\nto the left +"))
    left = np.cross(np.array([0.0, 0.0, 1.0]), boots.axes[:, :, 0])
    side_force = np.einsum("nka,nka->nk", run.skis.force, left)
    draw_both(totals, run, run.skis.total_force, Message("total\nforce (N)"))
    draw_both(normals, run, run.skis.normal_force, Message("normal\nforce (N)"))
    draw_both(sides, run, side_force, Message("side force (N)\nto the left +"))
    leans.axhline(0.0, color=style.PALE, linewidth=0.6, zorder=0)
    for axes in (leans, totals):
        axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=3, borderaxespad=0.2, frameon=False)
    style.label_time(sides, run.time)
    figure.align_ylabels()
    return figure


def draw_both(axes: Axes, run: Run, values: FloatArray, label: str) -> None:
    """Draw a quantity of both skis, shape (n, 2), with a line at 0; the axis omits 1 % of peaks."""
    for ski, (name, colour) in enumerate(zip(SKIS, (style.BLUE, style.ORANGE), strict=True)):
        hidden = ski == 0 and np.allclose(values[:, 0], values[:, 1])
        axes.plot(run.time, values[:, ski], color=colour, linewidth=2.4 if hidden else 0.8, label=name)
    low, high = np.quantile(values, [0.005, 0.995])
    room = 0.25 * max(high - low, 1.0)
    axes.set_ylim(low - 0.3 * room, high + room)
    axes.axhline(0.0, color=style.PALE, linewidth=0.6, zorder=0)
    axes.set_ylabel(label)


def run_boots(run: Run) -> Figure:
    """Draw edge angles, forces and edging moment of moving boots over time."""
    figure = style.new_figure(width_mm=style.DOUBLE_MM, height_mm=150.0)
    panels = figure.subplots(4, 1, sharex=True)
    boots = run.boots
    assert boots is not None
    (_, across, off_base), (edging, _, _) = boots.own_force.T, boots.own_moment.T
    draw_both(panels[0], run, edge_angles_of_skis(run) / DEGREE, Message("edge angle (°)\nto the left +"))
    draw_both(panels[1], run, off_base.T, Message("force off\nthe base (N)"))
    draw_both(panels[2], run, across.T, Message("force across (N)\nto the left +"))
    draw_both(panels[3], run, edging.T, Message("edging moment\n(N m)"))
    panels[0].legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, borderaxespad=0.2, frameon=False)
    style.label_time(panels[-1], run.time)
    figure.align_ylabels()
    return figure


def run_grip(run: Run) -> Figure:
    """Draw the net and gross grip utilisation of each ski over time, and its capacity."""
    figure = style.new_figure(width_mm=style.DOUBLE_MM, height_mm=62.0)
    axes = figure.subplots()
    net, gross = grip_utilisation(run), gross_grip_utilisation(run)
    dotted, dashed = (0, (1, 1)), (0, (4, 2))
    handles = []
    for ski, colour in enumerate(SKI_COLOURS):
        handles += axes.plot(run.time, net[:, ski], color=colour, label=SKIS[ski])
        axes.plot(run.time, gross[:, ski], color=colour, linewidth=0.7, linestyle=dotted)
    axes.axhline(1.0, color=style.GREY, linewidth=0.8, linestyle=dashed)
    style.label_time(axes, run.time)
    axes.set_ylim(-0.02, max(1.12, 1.05 * float(np.nanmax(gross, initial=1.0))))
    axes.set_ylabel(Message("grip utilisation of\nthe ski (1: side-slip)"))
    handles += [
        Line2D([], [], color=style.BLACK, label=Message("net")),
        Line2D([], [], color=style.BLACK, linewidth=0.7, linestyle=dotted, label=Message("gross")),
        Line2D([], [], color=style.GREY, linewidth=0.8, linestyle=dashed, label=Message("capacity of the snow")),
    ]
    style.legend_below(figure, handles)
    return figure


def grip_utilisation(run: Run) -> FloatArray:
    """Grip utilisation |∫ shear ds| / (S_f ∫ e ds) of each ski, shape (n, 2); NaN if a ski is off the snow."""
    return _over_capacity(run, np.abs(np.trapezoid(run.skis.shear_per_length, -run.skis.station, axis=2)))


def gross_grip_utilisation(run: Run) -> FloatArray:
    """∫ |shear| ds / (S_f ∫ e ds) of each ski, shape (n, 2): more than the net one where parts pull against another."""
    return _over_capacity(run, np.trapezoid(np.abs(run.skis.shear_per_length), -run.skis.station, axis=2))


def slip_of_a_place(run: Run) -> float:
    """Distance u (m) by which a ski slips sideways over a place of snow while it passes; NaN without grip.

    From the work W of shear over the way s: W/s = u ∫ S_f e ds/l for both skis, with the length l of ski in the snow.
    """
    capacity = _shear_capacity(run)
    per_length = float(capacity[capacity > 0.0].mean()) if np.any(capacity > 0.0) else 0.0
    work = float(run.energies["shear"][-1] - run.energies["shear"][0])
    holding = 2.0 * run.run_length * per_length
    return work / holding if holding > 0.0 else math.nan


def _over_capacity(run: Run, force: FloatArray) -> FloatArray:
    """Side force divided by the shear capacity of the whole ski; NaN without capacity."""
    limit = np.trapezoid(_shear_capacity(run), -run.skis.station, axis=2)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(limit > 0.0, force / limit, np.nan)


def _shear_capacity(run: Run) -> FloatArray:
    """Shear capacity S_f e per length (N/m), 0 above the snow."""
    strength = run.scenario.contact.snow.failure_shear_stress
    assert strength is not None  # a scenario has it
    return np.asarray(strength * np.maximum(run.skis.edge_depth, 0.0))


_SHARE_SHOWN: Final = 99.5
"""Percentile of the forces at the end of the colour scale: single peaks would leave the rest dark."""


def run_along_ski(run: Run) -> Figure:
    """Draw maps of edge depth and normal force of both skis, with the tip at the top; white: no contact."""
    depth, force = run.skis.edge_depth / MM, run.skis.force_per_length
    figure = style.new_figure(width_mm=style.DOUBLE_MM, height_mm=112.0)
    grid = figure.subplots(2, 2, sharex=True, sharey=True)
    labels = Message("edge depth (mm)"), Message("normal force per length (N/m)")
    for row, values, label in zip(grid, (depth, force), labels, strict=True):
        top = highest(values)
        for ski, axes in enumerate(row):
            mesh = along_ski_map(axes, run, np.where(values[:, ski] > 0.0, values[:, ski], np.nan), top)
            axes.set(xlabel=Message("time (s)"), ylabel=Message("position along the ski (m);\nboot = 0, tip up"))
            axes.label_outer()
        extend = "max" if top < values.max() else "neither"
        figure.colorbar(mesh, ax=list(row), label=label, pad=0.01, aspect=20, extend=extend)
    for name, axes in zip(SKIS, grid[0], strict=True):
        axes.set_title(name, loc="left", fontsize=8.0)
    return figure


def highest(values: FloatArray) -> float:
    """Upper end of the colour scale of a map: a high quantile of the positive values; 1 without one."""
    positive = values[values > 0.0]
    return float(np.percentile(positive, _SHARE_SHOWN)) if positive.size else 1.0


def along_ski_map(axes: Axes, run: Run, values: FloatArray, top: float) -> QuadMesh:
    """Draw one map of values (n, m) over time and station, with the tip at the top."""
    mesh = axes.pcolormesh(
        run.time, run.skis.station, np.ma.masked_invalid(values.T), shading="nearest", cmap="cividis", vmin=0.0,
        vmax=top, rasterized=True,
    )  # fmt: skip
    axes.axhline(0.0, color=style.BLACK, linewidth=0.5, linestyle=(0, (4, 3)))
    axes.set_ylim(float(run.skis.station.min()), float(run.skis.station.max()))
    return mesh
