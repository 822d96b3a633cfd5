"""CSV: read back by another reader, it gives the same values with all their digits."""

from __future__ import annotations

import csv
import io
from dataclasses import replace

from skisnow.report.campaign.data import ReportData
from skisnow.report.campaign.tables import campaign_tables
from skisnow.report.table import Column, Table, table_csv

from .conftest import Reported

TABLE = Table(
    "test",
    "A table.",
    (
        Column("site", "Site", "text"),
        Column("n", "n", "count"),
        Column("used", "used", "yes"),
        Column("flags", "flags", "codes"),
        Column("H_V_N_per_mm3", "H_V", "estimate", "N/mm³"),
        Column("range_mm", "range", "interval", "mm"),
        Column("p", "p", "p"),
    ),
    [
        ('a, "b"\nc', 3, True, ["x", "y"], (0.1 + 0.2, (1e-17, 1e300)), None, 1 / 3),
        ("ünïcode ;", 0, False, [], (None, None), (0.0, -2.5), None),
    ],
)


def test_no_text_is_a_formula_and_every_number_stays() -> None:
    rows = [("=1+1", 1, True, ["@x"], (-1.5, (-2.0, -1.0)), None, 0.5)]
    (row,) = csv.DictReader(io.StringIO(table_csv(replace(TABLE, rows=rows)), newline=""))
    assert (row["site"], row["flags"]) == ("'=1+1", "'@x")
    assert (row["H_V_N_per_mm3"], row["H_V_N_per_mm3_low"]) == ("-1.5", "-2.0")


def test_values_come_back_with_all_digits() -> None:
    rows = list(csv.DictReader(io.StringIO(table_csv(TABLE), newline="")))
    first, second = rows
    assert first["site"] == 'a, "b"\nc'
    assert (first["n"], first["used"], first["flags"]) == ("3", "true", "x; y")
    assert float(first["H_V_N_per_mm3"]) == 0.1 + 0.2
    assert (float(first["H_V_N_per_mm3_low"]), float(first["H_V_N_per_mm3_high"])) == (1e-17, 1e300)
    assert float(first["p"]) == 1 / 3
    assert (first["range_mm_low"], first["range_mm_high"]) == ("", "")
    assert (second["H_V_N_per_mm3"], second["p"], second["flags"]) == ("", "", "")
    assert (float(second["range_mm_low"]), float(second["range_mm_high"])) == (0.0, -2.5)


def test_lines_end_as_rfc_4180_has_it() -> None:
    text = table_csv(TABLE)
    assert text.endswith("\r\n")
    assert text.count("\r\n") == 3
    assert text.split("\r\n")[0].split(",")[:5] == ["site", "n", "used", "flags", "H_V_N_per_mm3"]


def test_the_report_s_experiments_equal_the_results(reference: Reported) -> None:
    path = reference.folder / "tables" / "penetration_experiments_synthetic.csv"
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    experiments = reference.results["penetration"]["experiments"]
    for key in ("H_e_N_per_mm", "H_A_N_per_mm2", "H_V_N_per_mm3", "edge_angle_deg"):
        assert [float(row[key]) for row in rows] == [row[key] for row in experiments]
    low, high = zip(*(row["H_V_interval_N_per_mm3"] for row in experiments), strict=True)
    assert [float(row["H_V_N_per_mm3_low"]) for row in rows] == list(low)
    assert [float(row["H_V_N_per_mm3_high"]) for row in rows] == list(high)


HEADS = {
    "sites": "site penetration_n penetration_used H_V_N_per_mm3 H_V_range_N_per_mm3 shear_n shear_used S_f_N_per_mm2 "
    "S_f_range_N_per_mm2",
    "corrections": "file row experiment column old new who when why",
    "warnings": "severity code file row column experiment value allowed action",
    "models": "row selected a0 a1 b0 b1 at_bound n_parameters rmse_N rmse_dof_N rmse_free_N printed_rmse_N",
    "model_tests": "full reduced F df1 df2 p rmse_change_percent valid_classically",
    "errors_in_depth": "row procedure a0 a1 b0 b1 at_bound rmse_N rmse_free_N",
    "hardness_by_procedure": "experiment site used H_V_N_per_mm3 H_V_fitted_N_per_mm3 relative_scatter",
    "seating_distribution": "quantile depth_offset_mm H_V_change_percent",
    "seating_largest": "experiment site edge_angle_deg H_V_N_per_mm3 depth_offset_mm H_V_change_percent",
    "seating": "experiment site used depth_offset_mm H_V_change_percent",
    "hardness_growth_sites": "site n growth_percent",
    "hardness_growth": "experiment site used H_V_N_per_mm3 H_0_N_per_mm3 growth_percent",
    "unloading_sites": "site n unloading_ratio rebound_ratio_interval k_u_N_per_mm3",
    "unloading": "experiment site edge_angle_deg n_unloading used unloading_ratio rebound_ratio_interval k_u_N_per_mm3",
    "shear_displacement_sites": "site n shear_displacement_mm",
    "shear_displacement": "experiment site edge_angle_deg n_turning used shear_displacement_mm",
    "regressions": "response predictor group n intercept slope slope_by_site rmse rmse_dof r2 F p",
    "group_comparisons": "quantity by group_a n_a group_b n_b ratio p p_holm n_needed",
    "comparisons": "source quantity value range own own_range own_over_published",
    "marks": "code sentence excludes penetration_n penetration_experiments shear_n shear_experiments",
    "penetration_experiments": "experiment site tool edge_angle_deg n_loads used flags H_e_N_per_mm H_A_N_per_mm2 "
    "H_V_N_per_mm3",
    "shear_experiments": "experiment site plate edge_angle_deg depth_mm F_t_N S_f_N_per_mm2 used flags",
    "files": "file sha256",
}
"""Settings with which other programs read the tables."""


def test_columns_of_every_table_have_their_names(reference: Reported) -> None:
    tables = campaign_tables(ReportData(reference.analysis))
    assert {name: " ".join(column.key for column in table.columns) for name, table in tables.items()} == HEADS
