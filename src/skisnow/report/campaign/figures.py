"""All figures of a campaign's report in order."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from ..._support.language import ENGLISH
from ..figures.drawing import Drawing, LeftOut, Picture, pictured
from ..figures.style import journal_style, site_styles
from ..figures.translated import translate_figure
from ..symbols import figure_text
from .model_figures import model_rmse, residuals
from .penetration_figures import force_depth, hardness_density, hardness_mean_force, seating_offsets, unloading_ratios
from .shear_figures import machining, shear_force_depth, stress_angle, stress_density, stress_hardness

if TYPE_CHECKING:
    from collections.abc import Callable

    from .data import ReportData

DRAWERS: Final = (
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
"""Functions that draw one figure each, in the order of the report."""
RECORDING_DRAWERS: Final = (hardness_mean_force,)
"""Figures of a campaign with recordings of a SnowMicroPen."""


def campaign_figures(
    data: ReportData, *, language: str = ENGLISH, progress: Callable[[str], None] | None = None
) -> tuple[list[Picture], list[LeftOut]]:
    """Figures for which the campaign has data, and the reasons for the missing ones."""
    pictures: list[Picture] = []
    missing: list[LeftOut] = []
    names = frozenset(map(figure_text, data.names))
    with journal_style():
        styles = site_styles(data)
        for draw in (*DRAWERS, *RECORDING_DRAWERS) if data.campaign.snow_micro_pen else DRAWERS:
            drawing = draw(data, styles)
            if isinstance(drawing, Drawing):
                if progress:
                    progress(f"figure {drawing.name}")
                translate_figure(drawing.figure, language, names=names)
                pictures.append(pictured(drawing))
            else:
                missing.append(drawing)
    return pictures, missing
