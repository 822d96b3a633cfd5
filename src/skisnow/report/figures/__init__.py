"""The figures of a report, one file each: the paper's Figs 5 to 11 and three of the fit itself."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...language import ENGLISH
from ..symbols import figure_text
from .drawing import Drawing, LeftOut, Picture, pictured
from .force_depth import force_depth
from .hardness_density import hardness_density
from .hardness_mean_force import hardness_mean_force
from .machining import machining
from .model_rmse import model_rmse
from .residuals import residuals
from .seating_offsets import seating_offsets
from .shear_force_depth import shear_force_depth
from .stress_angle import stress_angle
from .stress_density import stress_density
from .stress_hardness import stress_hardness
from .style import journal_style, site_styles
from .translated import translate_figure
from .unloading_ratios import unloading_ratios

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..report_data import ReportData

__all__ = ["DRAWERS", "LeftOut", "Picture", "figures_of"]

DRAWERS = (
    force_depth,
    model_rmse,
    residuals,
    seating_offsets,
    unloading_ratios,
    hardness_density,
    shear_force_depth,
    stress_angle,
    machining,
    stress_density,
    stress_hardness,
)
"""In the order of the report. A further figure is one more file and its function here."""
RECORDING_DRAWERS = (hardness_mean_force,)
"""Where the campaign has recordings of a SnowMicroPen."""


def figures_of(
    data: ReportData, *, language: str = ENGLISH, progress: Callable[[str], None] | None = None
) -> tuple[list[Picture], list[LeftOut]]:
    """All figures that the campaign has data for, and why the others are left out."""
    pictures: list[Picture] = []
    missing: list[LeftOut] = []
    names = frozenset(map(figure_text, data.names))
    with journal_style():
        styles = site_styles(data)
        for draw in (*DRAWERS, *RECORDING_DRAWERS) if data.campaign.snow_micro_pen else DRAWERS:
            drawn = draw(data, styles)
            if isinstance(drawn, Drawing):
                if progress:
                    progress(f"figure {drawn.name}")
                translate_figure(drawn.figure, language, names=names)
                pictures.append(pictured(drawn))
            else:
                missing.append(drawn)
    return pictures, missing
