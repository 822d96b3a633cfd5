"""Tables that compare: sites, published values, regressions, weather, recordings of a SnowMicroPen."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Final

import numpy as np

from ..._support.messages import Message
from ...campaign import QUALITY_FLAGS
from ...estimation.comparisons import own_mean
from ...snow.published import hand_hardness
from ...snow.published.moessner_2013 import SNOW_DENSITY_RANGE
from ..table import Column, Table, record_table
from . import model_tables, series_tables
from .data import Json, ReportData, UsedTests

QUANTITY: Final = {
    "S_f_N_per_mm2": ("S_f", "N/mm²"),
    "H_V_N_per_mm3": ("H_V", "N/mm³"),
    "edge_angle_rad": (Message("edge angle ϑ"), "rad"),
    "snow_density_kg_per_m3": (Message("snow density ρ"), "kg/m³"),
    "drop_cone_depth_mm": (Message("drop-cone depth H_p"), "mm"),
    "smp_mean_force_N": (Message("SnowMicroPen mean force"), "N"),
    "smp_snow_density_kg_per_m3": (Message("SnowMicroPen density"), "kg/m³"),
}
"""Symbol and unit of each response and predictor of a regression."""

_PUBLISHED: Final = {
    "H_V_N_per_mm3": "H_V in N/mm³",
    "S_f_N_per_mm2": "S_f in N/mm²",
    "b0": Message("b_0 of Eqn 11"),
    "b1_per_rad": Message("b_1 of Eqn 11, per rad"),
}


def sites_table(data: ReportData) -> Table:
    """Mean and range of H_V and S_f for each site, and for all if there are several."""
    groups: dict[str, tuple[str, ...]] = {site: (site,) for site in data.sites}
    if len(data.sites) > 1:
        groups[Message("all sites")] = data.sites
    rows = []
    for name, sites in groups.items():
        pressed, sheared = (sum(row["site"] in sites for row in tests) for tests in (data.penetration, data.shear))
        hardness = _mean_and_range(data.pressed, sites, geometric=True)
        rows.append((name, pressed, *hardness, sheared, *_mean_and_range(data.sheared, sites, geometric=False)))
    return Table(
        "sites",
        Message("Snow hardness and failure shear stress by site, with 95 % intervals of the means."),
        (
            Column("site", Message("Site"), "text"),
            Column("penetration_n", Message("penetration tests"), "count"),
            Column("penetration_used", Message("used"), "count"),
            Column("H_V_N_per_mm3", Message("H_V, geometric mean"), "estimate", "N/mm³"),
            Column("H_V_range_N_per_mm3", Message("H_V, range"), "range", "N/mm³"),
            Column("shear_n", Message("shear tests"), "count"),
            Column("shear_used", Message("used"), "count"),
            Column("S_f_N_per_mm2", Message("S_f, mean"), "estimate", "N/mm²"),
            Column("S_f_range_N_per_mm2", Message("S_f, range"), "range", "N/mm²"),
        ),
        rows,
        note=Message(
            "The interval of a site comes from the scatter between its experiments; that of all sites from the scatter "
            "between sites, and is withheld for fewer than four. H_V spans decades, so its mean is the geometric one. "
            "All intervals are computed on logarithms: no bound is negative."
        ),
    )


def _mean_and_range(tests: UsedTests, sites: tuple[str, ...], *, geometric: bool) -> tuple[Any, ...]:
    """Cells of a table for some sites together: number of values, mean with interval, minimum and maximum."""
    chosen = np.isin(tests.site, sites)
    values = tests.value[chosen]
    if len(values) == 0:
        return 0, (None, None), None
    mean = own_mean(values, tests.site[chosen].tolist(), geometric=geometric)
    interval = (mean.low, mean.high) if np.isfinite(mean.low) and np.isfinite(mean.high) else None
    value = mean.value if np.isfinite(mean.value) else None
    return len(values), (value, interval), (mean.minimum, mean.maximum) if np.isfinite(mean.minimum) else None


_GROUPS: Final = {
    "site": Message("site"), "tool": Message("tool"), "observer": Message("observer"), "day": Message("day")
}  # fmt: skip


def group_comparison_table(data: ReportData) -> Table:
    """Ratio of the means of every pair of sites, tools, observers and days."""
    columns = (
        Column("quantity", Message("Quantity"), "words"),
        Column("by", Message("Groups"), "words"),
        Column("group_a", "A", "text"),
        Column("n_a", Message("n of A"), "count"),
        Column("group_b", "B", "text"),
        Column("n_b", Message("n of B"), "count"),
        Column("ratio", "A / B", "estimate", interval="interval"),
        Column("p", "p", "p"),
        Column("p_holm", Message("p, corrected"), "p"),
        Column("n_needed", Message("tests needed in each group"), "count"),
    )
    return record_table(
        "group_comparisons",
        Message("Ratios of the geometric means of group A over group B, with 95 % intervals."),
        columns,
        [row | {"by": _GROUPS[row["by"]]} for row in data.results["group_comparisons"]],
        note=Message(
            "Intervals and p are those of a single pair. The corrected p accounts for the number of pairs of the "
            "same kind (Holm). Tools, observers and days are compared at their common sites. Last column: tests in "
            "each group that would find a difference of {difference_percent:.3g} % with a power of 80 %.",
            difference_percent=data.results["provenance"]["options"]["difference_percent"],
        ),
    )


def published_table(data: ReportData) -> Table:
    """Table of published values with those of this campaign and their ratio."""
    records = [
        row
        | {
            "quantity": _PUBLISHED.get(row["quantity"], row["quantity"]),
            "own_over_published": row["own"] / row["value"] if row["own"] is not None and row.get("value") else None,
        }
        for row in data.results["comparisons"]
    ]
    columns = (
        Column("source", Message("Source"), "text"),
        Column("quantity", Message("Quantity"), "words"),
        Column("value", Message("published")),
        Column("range", Message("published range"), "range"),
        Column("own", Message("this campaign"), "estimate", interval="own_interval"),
        Column("own_range", Message("its range"), "range"),
        Column("own_over_published", Message("own / published")),
    )
    caption = Message(
        "Published values next to this campaign's own: mean (H_V: geometric) with 95 % interval, and range over the "
        "used experiments."
    )
    return record_table("comparisons", caption, columns, records)


def regressions_table(data: ReportData) -> Table:
    """Coefficients, intervals and F test of every regression."""
    return Table(
        "regressions",
        Message(
            "Linear regressions with intercept: coefficients with 95 % intervals, goodness of fit and F test of the "
            "slope."
        ),
        (
            Column("response", Message("Response"), "words"),
            Column("predictor", Message("on"), "words"),
            Column("group", Message("group"), "text"),
            Column("n", "n", "count"),
            Column("intercept", Message("intercept"), "estimate"),
            Column("slope", Message("slope"), "estimate"),
            Column("slope_by_site", Message("sites as clusters"), "interval"),
            Column("rmse", Message("RMSE with 1/n")),
            Column("rmse_dof", Message("RMSE with 1/(n − 2)")),
            Column("r2", "R²"),
            Column("F", "F"),
            Column("p", "p", "p"),
        ),
        list(map(_regression_row, data.results["regressions"])),
        note=Message(
            "Intercept and rmse are in the unit of the response, slopes in that per unit of the predictor. Sites as "
            "clusters: the interval of the slope that knows that experiments of one site belong together; it is absent "
            "for a single site and where the sites do not tell. F and p are withheld where the predictor takes fewer "
            "than four different values: whatever else differs between them would show as well."
        ),
    )


def _regression_row(row: Json) -> tuple[Any, ...]:
    """Cells of a regression: names, group, count, estimates with intervals, interval by site, fit."""
    coefficients, intervals = row["b"] or (None, None), row["interval"] or (None, None)
    by_site = row["interval_by_site"][1] if row["interval_by_site"] else None
    group = Message("all") if row["group"] == "all" else row["group"]
    quantities = (QUANTITY[key] for key in (row["response"], row["terms"][1]))
    names = (Message("{name} ({unit})", name=name, unit=unit) for name, unit in quantities)
    estimates = zip(coefficients, intervals, strict=True)
    fit = (row[key] for key in ("rmse", "rmse_dof", "r2", "F", "p"))
    return (*names, group, row["n"], *estimates, by_site, *fit)


def weather_table(data: ReportData) -> Table:
    """Means of the weather at the experiments, by site."""
    weather = data.results["weather"]
    columns = (
        series_tables.SITE,
        Column("n", Message("experiments"), "count"),
        Column("air_temperature_C", Message("air"), unit="°C"),
        Column("relative_humidity_percent", Message("humidity"), unit="%"),
        Column("snow_surface_temperature_C", Message("snow surface"), unit="°C"),
        Column("wind_speed_m_per_s", Message("wind"), unit="m/s"),
        Column("incoming_short_wave_W_per_m2", Message("short-wave radiation"), unit="W/m²"),
    )
    caption = Message(
        "Weather at the times of the experiments, by the station {station}: means by site.", station=weather["station"]
    )
    note = Message("Linear between the station's readings; experiments whose time of day is not noted are not counted.")
    return record_table("weather", caption, columns, [row for row in weather["sites"] if row["n"]], note=note)


def snow_micro_pen_table(data: ReportData) -> Table:
    """Table with one row per recording of a SnowMicroPen: mean force, resistance and structure."""
    recordings = data.results["snow_micro_pen"]
    columns = (
        Column("recording", Message("Recording"), "text"),
        Column("site", Message("Site"), "text"),
        Column("spot", "spot", "text"),
        Column("surface_mm", Message("surface at"), unit="mm", digits=4),
        Column("air_force_N", Message("force in air"), unit="N"),
        Column("mean_force_N", Message("mean force"), unit="N"),
        Column("penetration_resistance_kPa", Message("penetration resistance"), unit="kPa"),
        Column("rupture_force_N", "f₀", unit="N"),
        Column("deflection_mm", "δ", unit="mm"),
        Column("element_size_mm", "L", unit="mm"),
        Column("snow_density_kg_per_m3", "ρ", unit="kg/m³"),
        Column("specific_surface_area_m2_per_kg", "SSA", unit="m²/kg"),
        Column("used", Message("used"), "yes"),
        Column("flags", Message("flags"), "codes"),
    )
    depths = Message(
        "{from_depth_mm:g} to {to_depth_mm:g} mm below the surface",
        from_depth_mm=recordings["from_depth_mm"],
        to_depth_mm=recordings["to_depth_mm"],
    )
    return record_table(
        "snow_micro_pen",
        Message(
            "Recordings of the SnowMicroPen, {depths}, density and surface area by {relation}.",
            depths=depths,
            relation=recordings["relation"],
        ),
        columns,
        recordings["recordings"],
        note="The penetration resistance is the mean force over the cross-section of the tip, the hardness of the "
        "international classification (Fierz and others 2009); it is not H_V. f₀ is the force at which an element of "
        "the snow ruptures, δ its deflection, L the elements' size: medians over windows. The relations for density "
        "and specific surface area were fitted to ungroomed snow; the other published ones are in results.json.",
    )


def published_relations_table(data: ReportData) -> Table:
    """Density, hardness and S_f of each site by published relations, for a campaign without plate tests."""
    columns = (
        Column("site", Message("Site"), "text"),
        Column("source", Message("density by"), "text"),
        Column("n", "n", "count"),
        Column("snow_density_kg_per_m3", "ρ", unit="kg/m³"),
        Column("penetration_resistance_kPa", Message("penetration resistance"), unit="kPa"),
        Column("hand_hardness_index", Message("hand hardness index")),
        Column("hand_hardness", Message("hand hardness"), "text"),
        Column("hardness_relation", Message("hardness by"), "text"),
        Column("S_f_N_per_mm2", Message("S_f by the published relation"), unit="N/mm²"),
    )
    low, high = SNOW_DENSITY_RANGE
    softest, hardest = (end / 1e3 for end in hand_hardness.RESISTANCE_RANGE)
    note = Message(
        "By relations, not by plate tests. No published relation gives H_V: from the density it was sought and not "
        "found (p = 0.99, Mössner and others 2013). Hand hardness is that of the international classification (Fierz "
        "and others 2009): from the penetration resistance of {softest:.3g} to {hardest:.3g} kPa, otherwise from the "
        "density of rounded grains, F- to K+; neither was fitted to groomed snow. S_f = −0.047 + 0.00031 ρ (Mössner "
        "and others 2013, Eqn 14; rmse 0.059 N/mm²) is given for {low:g} to {high:g} kg/m³.",
        softest=softest,
        hardest=hardest,
        low=low,
        high=high,
    )
    caption = Message("Density of each site, hardness and shear strength by published relations.")
    return record_table("published_relations", caption, columns, data.results["published_relations"], note=note)


def files_table(data: ReportData) -> Table:
    """Table of the files that were read, each with its SHA-256."""
    return Table(
        "files",
        Message("Files read, with the SHA-256 of their bytes."),
        (Column("file", Message("File"), "text"), Column("sha256", "SHA-256", "text")),
        list(data.results["provenance"]["files"].items()),
    )


_CELL_HEADERS: Final = {
    name: Column(name, header, "count" if name == "row" else "text")
    for name, header in {
        "file": Message("file"), "row": Message("row"), "experiment": Message("experiment"),
        "column": Message("column"), "old": Message("old"), "new": Message("new"), "who": Message("who"),
        "when": Message("when"), "why": Message("why"), "severity": Message("severity"), "code": Message("code"),
        "value": Message("value"), "allowed": Message("allowed"), "action": Message("action"),
    }.items()
}  # fmt: skip
"""Columns of tables about single cells of the campaign's files."""


def corrections_table(data: ReportData) -> Table:
    """Every cell whose value a correction replaces."""
    names = ("file", "row", "experiment", "column", "old", "new", "who", "when", "why")
    caption = Message("Corrections applied when the files were read; the raw files keep the old values.")
    columns = tuple(_CELL_HEADERS[name] for name in names)
    return record_table("corrections", caption, columns, data.results["campaign"]["corrections"])


def warnings_table(data: ReportData) -> Table:
    """Table with one row per warning that reading the campaign gave."""
    names = ("severity", "code", "file", "row", "column", "experiment", "value", "allowed", "action")
    caption = Message("Warnings of reading the campaign's files.")
    columns = tuple(_CELL_HEADERS[name] for name in names)
    return record_table("warnings", caption, columns, data.results["campaign"]["warnings"], rows_in_html=50)


def quality_flags_table(data: ReportData) -> Table:
    """Table with one row per quality flag: meaning, whether it excludes, and its experiments."""
    excluding, rows = data.results["campaign"]["excluding"], []
    for code, flag in QUALITY_FLAGS.items():
        penetration, shear = (
            [row["experiment"] for row in tests if code in row["flags"]] for tests in (data.penetration, data.shear)
        )
        rows.append((code, flag.sentence, code in excluding, len(penetration), penetration, len(shear), shear))
    return Table(
        "marks",
        Message(
            "Quality flags of the screening. A flag deletes nothing; one that excludes keeps its experiments out of "
            "the estimates."
        ),
        (
            Column("code", Message("Code"), "text"),
            Column("sentence", Message("Statement"), "words"),
            Column("excludes", Message("excludes"), "yes"),
            Column("penetration_n", Message("penetration"), "count"),
            Column("penetration_experiments", Message("penetration experiments"), "codes"),
            Column("shear_n", Message("shear"), "count"),
            Column("shear_experiments", Message("shear experiments"), "codes"),
        ),
        rows,
    )


BUILDERS: Final = (
    sites_table,
    corrections_table,
    warnings_table,
    model_tables.models_table,
    model_tables.nested_table,
    model_tables.errors_in_depth_table,
    model_tables.fitted_hardness_table,
    series_tables.growth_sites_table,
    series_tables.growth_table,
    series_tables.seating_table,
    series_tables.unloading_sites_table,
    series_tables.unloading_table,
    series_tables.displacement_sites_table,
    series_tables.displacement_table,
    published_relations_table,
    snow_micro_pen_table,
    regressions_table,
    weather_table,
    group_comparison_table,
    published_table,
    quality_flags_table,
    series_tables.penetration_table,
    series_tables.shear_table,
    files_table,
)
"""Functions that build one table each, in the order of the report. Add a table by adding its function."""


def campaign_tables(data: ReportData) -> dict[str, Table]:
    """All tables by name, including empty ones.

    The tables of recordings, of the weather and of regressions are absent if the campaign has no such data.
    """
    absent = {
        snow_micro_pen_table: data.campaign.snow_micro_pen is None,
        published_relations_table: not data.results.get("published_relations"),
        weather_table: data.campaign.weather is None,
        regressions_table: not data.has_tests,
    }
    builders = (build for build in BUILDERS if not absent.get(build, False))
    tables = (replace(build(data), synthetic=data.synthetic) for build in builders)
    return {table.name: table for table in tables}
