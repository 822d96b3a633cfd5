"""Loads and depths of single series with the law F = H_V V, in the units of the paper: what a picture is drawn from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from ..geometry import in_form
from ..units import DEGREE, MM, N_PER_MM3

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy.typing as npt

    from ..field.records import Campaign
    from ..geometry import GeometryForm, Tool

    FloatArray = npt.NDArray[np.float64]

POINTS: Final = 31
"""Points of a curve: the chords of a parabola then stray by 1/3600 of its height, less than a screen shows."""


@dataclass(frozen=True, slots=True)
class SeriesCurve:
    """The readings of a series, e (mm) and F (N), and its law as points; no law where H_V does not exist."""

    experiment: str
    depth_mm: tuple[float, ...]
    load_N: tuple[float, ...]
    law_depth_mm: tuple[float, ...]
    law_load_N: tuple[float, ...]


def law_of_series(
    tool: Tool, edge_angle: float, snow_hardness_N_per_mm3: float, penetration_depth: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Depth (mm) and load F = H_V V (N) of a tool at an edge angle (rad) and depths (m)."""
    volume = tool.displaced_volume(penetration_depth, edge_angle)
    return penetration_depth / MM, snow_hardness_N_per_mm3 * N_PER_MM3 * volume


def series_curves(
    campaign: Campaign, rows: Sequence[dict[str, Any]], *, geometry: GeometryForm = "extended"
) -> tuple[SeriesCurve, ...]:
    """The curve of each series of a campaign; ``rows``: its ``penetration.experiments`` of results.json."""
    tests = campaign.penetration
    if tests is None:
        return ()
    curves = []
    for index, row in enumerate(rows):
        series, hardness = tests.series(index), row["H_V_N_per_mm3"]
        law: tuple[FloatArray, FloatArray] = (np.zeros(0), np.zeros(0))
        if hardness is not None:
            e = np.linspace(0.0, float(series.penetration_depth.max()), POINTS)
            tool = in_form(campaign.tools[series.tool], geometry)
            law = law_of_series(tool, row["edge_angle_deg"] * DEGREE, hardness, e)
        numbers = (series.penetration_depth / MM, series.load, *law)
        curves.append(SeriesCurve(series.experiment, *(tuple(np.asarray(each).tolist()) for each in numbers)))
    return tuple(curves)
