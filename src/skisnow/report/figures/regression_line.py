"""A regression line with the 95 % band of the mean."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...constants import CONFIDENCE
from ...statistics.combined_uncertainty import expanded_factor

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..report_data import FloatArray, Json


@dataclass(frozen=True)
class RegressionLine:
    """ŷ and its band over the range of the predictor; the band is NaN where two points leave no scatter."""

    x: FloatArray
    y: FloatArray
    low: FloatArray
    high: FloatArray


def regression_line(row: Json, predictor: FloatArray) -> RegressionLine:
    """The line of a regression's entry: b₀ + b₁ x ± t rmse_dof √(1/n + (x - x̄)²/Σ(x - x̄)²).

    ``predictor`` are the n values that the regression was made over, in its unit.
    """
    x = np.linspace(float(predictor.min()), float(predictor.max()), 61)
    y = row["b"][0] + row["b"][1] * x
    mean, n = float(predictor.mean()), len(predictor)
    spread = float(np.sum((predictor - mean) ** 2))
    if n < 3 or row["rmse_dof"] is None:
        nothing = np.full_like(x, np.nan)
        return RegressionLine(x, y, nothing, nothing)
    factor = float(expanded_factor(n - 2.0, CONFIDENCE))
    half = factor * row["rmse_dof"] * np.sqrt(1.0 / n + (x - mean) ** 2 / spread)
    return RegressionLine(x, y, y - half, y + half)


def draw_line(axes: Axes, line: RegressionLine, *, colour: str, x_unit: float = 1.0, dashed: bool = False) -> None:
    """The line over its pale band; ``x_unit`` converts the predictor to the axis' unit by division."""
    axes.fill_between(line.x / x_unit, line.low, line.high, color=colour, alpha=0.15, linewidth=0.0, zorder=1)
    axes.plot(line.x / x_unit, line.y, color=colour, linewidth=1.1, linestyle="--" if dashed else "-", zorder=2)
