"""Data of the lab's charts: readings of series with their fitted law, and tables along a ski."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.messages import Message
from .._support.units import MM
from ..campaign.records import Campaign, PenetrationTests
from ..geometry import Tool, in_form
from ..ski import Ski
from .formatting import significant

_NOTHING: Final = (np.zeros(0), np.zeros(0))
POINTS: Final = 31  # points of a curve: the chords of a parabola deviate by 1/3600 of its height, less than a pixel


@dataclass(frozen=True, slots=True)
class SeriesCurve:
    """Readings of a series, e (mm) and F (N), and points of its fitted law; no law without H_V.

    Readings of the unloading follow those of the loading.
    """

    experiment: str
    depth_mm: tuple[float, ...]
    load_N: tuple[float, ...]
    law_depth_mm: tuple[float, ...]
    law_load_N: tuple[float, ...]


def law_of_series(
    tool: Tool,
    edge_angle: FloatArray | float,
    snow_hardness: FloatArray | float,
    penetration_depth: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Depths in mm, and loads F = H_V V (N), of a tool at edge angles (rad) and depths (m) in snow of H_V (N/m³)."""
    volume = tool.displaced_volume(penetration_depth, edge_angle)
    return penetration_depth / MM, snow_hardness * volume


def series_curves(campaign: Campaign, snow_hardness: FloatArray) -> tuple[SeriesCurve, ...]:
    """Curve of each series of a campaign; ``snow_hardness`` is H_V of each series (N/m³), NaN without one."""
    tests = campaign.penetration
    if tests is None:
        return ()
    laws = _laws(campaign, tests, snow_hardness)
    curves = []
    for index in range(len(tests)):
        series = tests.series(index)
        depth, load = series.penetration_depth, series.load
        if tests.unloading is not None:
            rows = slice(*tests.unloading.first[index : index + 2].tolist())
            depth = np.append(depth, tests.unloading.penetration_depth[rows])
            load = np.append(load, tests.unloading.load[rows])
        columns = (depth / MM, load, *laws.get(index, _NOTHING))
        curves.append(SeriesCurve(series.experiment, *(tuple(column.tolist()) for column in columns)))
    return tuple(curves)


def _laws(
    campaign: Campaign, tests: PenetrationTests, snow_hardness: FloatArray
) -> dict[int, tuple[FloatArray, FloatArray]]:
    """Points of the law, depths (mm) and loads (N), by the index of each series that has H_V."""
    by_tool: dict[str, list[int]] = {}
    for index in np.flatnonzero(np.isfinite(snow_hardness)).tolist():
        by_tool.setdefault(tests.tool[index], []).append(index)
    laws: dict[int, tuple[FloatArray, FloatArray]] = {}
    for name, chosen in by_tool.items():
        angle, hardness = tests.edge_angle[chosen][:, None], snow_hardness[chosen][:, None]
        deepest = np.array([tests.series(index).penetration_depth.max() for index in chosen])[:, None]
        depths = deepest * np.linspace(0.0, 1.0, POINTS)
        points = law_of_series(in_form(campaign.tools[name], "extended"), angle, hardness, depths)
        laws.update(zip(chosen, zip(*points, strict=True), strict=True))
    return laws


def ski_columns(ski: Ski) -> dict[str, list[float]]:
    """Tables along a ski for a chart, with every second point (5 mm apart), from tip to tail.

    station_m: distance from the boot, positive forward.
    half_width_mm, base_height_mm, EI_N_m2, GJ_N_m2: half of the width from edge to edge, height of the unloaded base,
        bending and torsional stiffness.
    """
    columns = {
        "station_m": ski.station,
        "half_width_mm": ski.width / (2.0 * MM),
        "base_height_mm": ski.base_height / MM,
        "EI_N_m2": ski.bending_stiffness,
        "GJ_N_m2": ski.torsional_stiffness,
    }
    return {name: [*table[:-1:2].tolist(), float(table[-1])] for name, table in columns.items()}


def ski_facts(ski: Ski) -> dict[str, str]:
    """Key data of a ski as texts with units, by name."""
    tip, waist, tail = (significant(width / MM) for width in ski.sidecut_widths)
    middle = int(np.argmin(np.abs(ski.station)))
    return {
        Message("Length"): f"{significant(ski.length, 4)} m",
        Message("Running length"): f"{significant(ski.running_length, 4)} m",
        Message("Sidecut, tip – waist – tail"): f"{tip} – {waist} – {tail} mm",
        Message("Sidecut radius"): f"{significant(ski.sidecut_radius_of_edge_line)} m",
        Message("EI at the boot"): f"{significant(float(ski.bending_stiffness[middle]))} N m²",
        Message("GJ at the boot"): f"{significant(float(ski.torsional_stiffness[middle]))} N m²",
        Message("Mass"): f"{significant(ski.mass)} kg",
    }
