"""Recordings of a SnowMicroPen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..table import Column, Table

if TYPE_CHECKING:
    from ..report_data import ReportData

_COLUMNS = (
    Column("recording", "Recording", "text"),
    Column("site", "Site", "text"),
    Column("spot", "spot", "text"),
    Column("surface_mm", "surface at", unit="mm", digits=4),
    Column("air_force_N", "force in air", unit="N"),
    Column("mean_force_N", "mean force", unit="N"),
    Column("rupture_force_N", "f₀", unit="N"),
    Column("deflection_mm", "δ", unit="mm"),
    Column("element_size_mm", "L", unit="mm"),
    Column("snow_density_kg_per_m3", "ρ", unit="kg/m³"),
    Column("specific_surface_area_m2_per_kg", "SSA", unit="m²/kg"),
    Column("used", "used", "yes"),
    Column("flags", "flags", "codes"),
)


def snow_micro_pen_table(data: ReportData) -> Table:
    """A row for each recording."""
    found = data.results["snow_micro_pen"]
    rows = [tuple(row[column.key] for column in _COLUMNS) for row in found["recordings"]]
    depths = f"{found['from_depth_mm']:g} to {found['to_depth_mm']:g} mm below the surface"
    caption = f"Recordings of the SnowMicroPen, {depths}, density and surface area by {found['relation']}."
    return Table("snow_micro_pen", caption, _COLUMNS, rows, note=_NOTE)


_NOTE = (
    "f₀ is the force at which an element of the snow ruptures, δ its deflection, L the elements' size: medians over "
    "windows. The relations for density and specific surface area were fitted to snow that nobody had groomed; the "
    "other published ones stand in results.json."
)
