"""The tables of a report, one subject per file."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from .comparisons import published_table, site_comparison_table
from .experiments import penetration_table, shear_table
from .growing_hardness import hardness_growth_sites_table, hardness_growth_table
from .models import errors_in_depth_table, fitted_hardness_table, models_table, nested_table
from .provenance import corrections_table, files_table, warnings_table
from .quality_flags import quality_flags_table
from .regressions import regressions_table
from .seating import seating_largest_table, seating_quantiles_table, seating_table
from .shear_displacement import displacement_sites_table, displacement_table
from .sites import sites_table
from .snow_micro_pen import snow_micro_pen_table
from .unloading import unloading_sites_table, unloading_table
from .weather import weather_table

if TYPE_CHECKING:
    from ..report_data import ReportData
    from ..table import Table

BUILDERS = (
    sites_table,
    corrections_table,
    warnings_table,
    models_table,
    nested_table,
    errors_in_depth_table,
    fitted_hardness_table,
    hardness_growth_sites_table,
    hardness_growth_table,
    seating_quantiles_table,
    seating_largest_table,
    seating_table,
    unloading_sites_table,
    unloading_table,
    displacement_sites_table,
    displacement_table,
    snow_micro_pen_table,
    regressions_table,
    weather_table,
    site_comparison_table,
    published_table,
    quality_flags_table,
    penetration_table,
    shear_table,
    files_table,
)
"""In the order of the report. A further table is one more function here."""


def tables_of(data: ReportData) -> dict[str, Table]:
    """All tables by name, those without a row too; of recordings and weather where the campaign has some."""
    absent = {
        snow_micro_pen_table: data.campaign.snow_micro_pen is None,
        weather_table: data.campaign.weather is None,
    }
    builders = (build for build in BUILDERS if not absent.get(build, False))
    built = (replace(build(data), synthetic=data.synthetic) for build in builders)
    return {table.name: table for table in built}
