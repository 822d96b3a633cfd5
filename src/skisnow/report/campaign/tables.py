"""All tables of a campaign's report in order, with those of its sources: files, corrections, warnings, flags."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Final

from ...campaign import QUALITY_FLAGS
from ..tables.table import Column, Table, record_table
from .model_tables import errors_in_depth_table, fitted_hardness_table, models_table, nested_table
from .series_tables import (
    displacement_sites_table,
    displacement_table,
    growth_sites_table,
    growth_table,
    penetration_table,
    seating_largest_table,
    seating_quantiles_table,
    seating_table,
    shear_table,
    unloading_sites_table,
    unloading_table,
)
from .site_tables import (
    published_table,
    regressions_table,
    site_comparison_table,
    sites_table,
    snow_micro_pen_table,
    weather_table,
)

if TYPE_CHECKING:
    from .data import Json, ReportData


def files_table(data: ReportData) -> Table:
    """Every campaign file with its checksum."""
    return Table(
        "files",
        "Files read, with the SHA-256 of their bytes.",
        (Column("file", "File", "text"), Column("sha256", "SHA-256", "text")),
        list(data.results["provenance"]["files"].items()),
    )


def corrections_table(data: ReportData) -> Table:
    """Every cell whose value a correction replaces."""
    keys = ("file", "row", "experiment", "column", "old", "new", "who", "when", "why")
    caption = "Corrections applied when the files were read; the raw files keep the old values."
    return record_table("corrections", caption, _key_columns(keys), data.results["campaign"]["corrections"])


def warnings_table(data: ReportData) -> Table:
    """Every warning of the campaign reader."""
    keys = ("severity", "code", "file", "row", "column", "experiment", "value", "allowed", "action")
    caption = "Warnings of reading the campaign's files."
    return record_table("warnings", caption, _key_columns(keys), data.results["campaign"]["warnings"], rows_in_html=50)


def _key_columns(keys: tuple[str, ...]) -> tuple[Column, ...]:
    return tuple(Column(key, key, "count" if key == "row" else "text") for key in keys)


def quality_flags_table(data: ReportData) -> Table:
    """Every quality flag with the experiments that have it."""
    penetration, shear = _experiments_by_flag(data.penetration), _experiments_by_flag(data.shear)
    excluding = data.results["campaign"]["excluding"]
    rows = [
        (
            code,
            flag.sentence,
            code in excluding,
            len(penetration.get(code, ())),
            penetration.get(code, []),
            len(shear.get(code, ())),
            shear.get(code, []),
        )
        for code, flag in QUALITY_FLAGS.items()
    ]
    return Table(
        "marks",
        "Quality flags of the screening. A flag deletes nothing; one that excludes keeps its experiments out of the "
        "estimates.",
        (
            Column("code", "Code", "text"),
            Column("sentence", "What it says", "words"),
            Column("excludes", "excludes", "yes"),
            Column("penetration_n", "penetration", "count"),
            Column("penetration_experiments", "penetration experiments", "codes"),
            Column("shear_n", "shear", "count"),
            Column("shear_experiments", "shear experiments", "codes"),
        ),
        rows,
    )


def _experiments_by_flag(rows: list[Json]) -> dict[str, list[str]]:
    experiments: dict[str, list[str]] = {}
    for row in rows:
        for code in row["flags"]:
            experiments.setdefault(code, []).append(row["experiment"])
    return experiments


BUILDERS: Final = (
    sites_table,
    corrections_table,
    warnings_table,
    models_table,
    nested_table,
    errors_in_depth_table,
    fitted_hardness_table,
    growth_sites_table,
    growth_table,
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
"""Functions that build one table each, in the order of the report. Add a table by adding its function."""


def campaign_tables(data: ReportData) -> dict[str, Table]:
    """All tables by name, including empty ones.

    The tables of recordings and of the weather are absent if the campaign has no such data.
    """
    absent = {
        snow_micro_pen_table: data.campaign.snow_micro_pen is None,
        weather_table: data.campaign.weather is None,
    }
    builders = (build for build in BUILDERS if not absent.get(build, False))
    tables = (replace(build(data), synthetic=data.synthetic) for build in builders)
    return {table.name: table for table in tables}
