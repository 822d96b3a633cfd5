"""Weather at the experiments, by site."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..table import Column, Table

if TYPE_CHECKING:
    from ..report_data import ReportData

_COLUMNS = (
    Column("site", "Site", "text"),
    Column("n", "experiments", "count"),
    Column("air_temperature_C", "air", unit="°C"),
    Column("relative_humidity_percent", "humidity", unit="%"),
    Column("snow_surface_temperature_C", "snow surface", unit="°C"),
    Column("wind_speed_m_per_s", "wind", unit="m/s"),
    Column("incoming_short_wave_W_per_m2", "short-wave radiation", unit="W/m²"),
)


def weather_table(data: ReportData) -> Table:
    """A row for each site with an experiment whose weather is known."""
    found = data.results["weather"]
    rows = [tuple(row[column.key] for column in _COLUMNS) for row in found["sites"] if row["n"]]
    caption = f"Weather at the times of the experiments, by the station {found['station']}: means by site."
    note = "Linear between the station's readings; experiments whose time of day is not noted are not counted."
    return Table("weather", caption, _COLUMNS, rows, note=note)
