"""Formatted values and tables."""

import csv
import io
import re
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import matplotlib
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from skisnow.report.campaign.data import ReportData
from skisnow.report.campaign.tables import campaign_tables
from skisnow.report.formatting import figure_text, html, p_equals, prose, significant, whole
from skisnow.report.sheet import CITED, bibtex
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


def test_no_text_is_a_formula_and_every_number_stays_and_values_come_back_with_all_digits() -> None:
    rows = [("=1+1", 1, True, ["@x"], (-1.5, (-2.0, -1.0)), None, 0.5)]
    (row,) = csv.DictReader(io.StringIO(table_csv(replace(TABLE, rows=rows)), newline=""))
    assert (row["site"], row["flags"]) == ("'=1+1", "'@x")
    assert (row["H_V_N_per_mm3"], row["H_V_N_per_mm3_low"]) == ("-1.5", "-2.0")
    # Lines end as RFC 4180 has it.
    text = table_csv(TABLE)
    assert text.endswith("\r\n")
    assert text.count("\r\n") == 3
    first, second = csv.DictReader(io.StringIO(text, newline=""))
    assert list(first)[:5] == ["site", "n", "used", "flags", "H_V_N_per_mm3"]
    assert first["site"] == 'a, "b"\nc'
    assert (first["n"], first["used"], first["flags"]) == ("3", "true", "x; y")
    assert float(first["H_V_N_per_mm3"]) == 0.1 + 0.2
    assert (float(first["H_V_N_per_mm3_low"]), float(first["H_V_N_per_mm3_high"])) == (1e-17, 1e300)
    assert float(first["p"]) == 1 / 3
    assert (first["range_mm_low"], first["range_mm_high"]) == ("", "")
    assert (second["H_V_N_per_mm3"], second["p"], second["flags"]) == ("", "", "")
    assert (float(second["range_mm_low"]), float(second["range_mm_high"])) == (0.0, -2.5)


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


@pytest.mark.parametrize(
    ("value", "digits", "expected"),
    [
        (0.21, 3, "0.210"),
        (56.14, 3, "56.1"),
        (56.14, 4, "56.14"),
        (1652.0, 3, "1652"),
        (999.96, 4, "1000"),
        (0.0009996, 3, "0.00100"),
        (-0.0123, 3, "−0.0123"),
        (0.0, 3, "0"),
        (1.234e-5, 3, "1.23×10⁻⁵"),
        (-1.5e9, 2, "−1.5×10⁹"),
        (None, 3, "–"),
    ],
)
def test_significant(value: float | None, digits: int, expected: str) -> None:
    assert significant(value, digits) == expected


@given(value=st.floats(-1e12, 1e12, allow_nan=False), digits=st.integers(2, 6))
def test_printed_is_the_value_to_its_digits(value: float, digits: int) -> None:
    """Half a unit of the last digit, for any magnitude."""
    printed = float(significant(value, digits, style="plain"))
    assert abs(printed - value) <= 0.5000001 * 10.0 ** (1 - digits) * abs(value) * 10.0


def test_p_values() -> None:
    assert p_equals(0.00012) == "p\u00a0<\u00a00.001"
    assert p_equals(0.0503) == "p\u00a0=\u00a00.050"
    assert p_equals(0.52) == "p\u00a0=\u00a00.52"


def test_counts_are_grouped_from_five_digits() -> None:
    assert (whole(1652), whole(143000)) == ("1652", "143\u202f000")


CITATION = (Path(__file__).resolve().parents[2] / "CITATION.cff").read_text(encoding="utf-8")


def test_program_and_papers_are_those_of_the_citation_file() -> None:
    plain = " ".join(CITATION.split())
    for name in re.findall(r"family-names: ([^,]+),", CITATION):
        assert name in CITED
    for title in re.findall(r"title: (?:>- )?(.+?) authors:", plain)[1:]:
        assert title in CITED
    for journal in re.findall(r"journal: (.+)", CITATION):
        assert journal in CITED
    assert "doi 10.1111/sms.12035" in CITED
    assert "doi: 10.1111/sms.12035" in CITATION
    assert "skisnow developers" in CITATION


def test_bibtex_has_the_same_and_the_campaign_with_its_files() -> None:
    text = bibtex({"name": "Slope & {a_b", "place": "", "observers": ["Ada", "Bo"], "files": {"shear.csv": "ab12"}})
    for name in re.findall(r"family-names: ([^,]+),", CITATION):
        assert name in text
    assert "10.1111/sms.12035" in text
    assert r"title = {Slope \& \textbraceleft{}a\_b}" in text
    assert "{{Ada} and {Bo}}" in text
    assert "SHA-256 ab12" in text
    assert text.count("{") == text.count("}")
    assert bibtex().count("@") == 3


def test_symbols_of_a_template_are_set_and_values_escaped() -> None:
    text = prose("S_f at {site}: 5 %", site="S_f <b> 5 %")
    assert text == "<i>S</i><sub>f</sub> at S_f &lt;b&gt; 5 %: 5\u00a0%"
    assert html("beyond_tool, a_bc") == "beyond_tool, a_bc"


@pytest.mark.parametrize("name", ["$x$", "a$b", "_hidden", "50 % \\alpha", "a & b", "$$"])
def test_a_name_is_drawn_as_it_is(name: str) -> None:
    """No mathtext, and a leading underscore does not hide the entry of a legend."""
    figure = Figure()
    handle = Line2D([], [], label=figure_text(name))
    with matplotlib.rc_context({"svg.fonttype": "none"}):
        figure.legend(handles=[handle])
        drawn = io.StringIO()
        figure.savefig(drawn, format="svg")
    texts = ElementTree.fromstring(drawn.getvalue()).iter("{http://www.w3.org/2000/svg}text")
    assert [(element.text or "").strip() for element in texts] == [name]


def test_long_and_broken_names_are_one_short_line() -> None:
    assert figure_text("a\n b\x00c") == "a b c"
    assert len(figure_text("x" * 100)) == 28
    assert figure_text("  ") == "(no name)"


def test_long_names_that_differ_at_their_end_differ_in_a_figure() -> None:
    stiff, soft = (figure_text(f"Giant slalom 193 cm, 2026 prototype, {word}") for word in ("stiff", "soft"))
    assert stiff != soft
    assert (stiff[-5:], soft[-4:]) == ("stiff", "soft")
    assert figure_text("abcdefgh", longest=8) == "abcdefgh"
    assert figure_text("abcdefghi", longest=8) == "abcd…ghi"
