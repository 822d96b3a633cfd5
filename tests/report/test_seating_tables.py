"""Tables of the offsets of the depth zero, against quantiles and an order worked out from the results."""

from __future__ import annotations

import pytest

from skisnow.report.campaign.data import ReportData
from skisnow.report.campaign.series_tables import (
    count_resolved_offsets,
    seating_largest_table,
    seating_quantiles_table,
)

from .conftest import Reported, altered

OFFSETS = [0.5, -1.0, 2.0, None, 0.1]
ENDS = [[0.1, 0.9], [-1.5, -0.5], [-0.5, 4.5], None, [0.0, 0.2]]
CHANGES = [-10.0, 25.0, 100.0, None, -60.0]


@pytest.fixture
def data(reference: Reported) -> ReportData:
    """The first five series of the campaign, the last of them not used; its sites and angles stay."""
    whole = reference.results["penetration"]
    own = [row | {"used": place != 4} for place, row in enumerate(whole["experiments"][:5])]
    seating = [
        row | {"depth_offset_mm": offset, "interval_mm": ends, "H_V_change_percent": change}
        for row, offset, ends, change in zip(whole["seating"], OFFSETS, ENDS, CHANGES, strict=False)
    ]
    results = reference.results | {"penetration": whole | {"experiments": own, "seating": seating}}
    return ReportData(altered(reference.analysis, results))


def test_quantiles_are_over_the_used_series_that_have_an_offset(data: ReportData) -> None:
    """Of −1, 0.5, 2 mm the quartiles are −0.25 and 1.25 mm, linear between neighbours."""
    table = seating_quantiles_table(data)
    assert [row[0] for row in table.rows] == ["minimum", "5 %", "25 %", "median", "75 %", "95 %", "maximum"]
    assert [row[1] for row in table.rows] == pytest.approx([-1.0, -0.85, -0.25, 0.5, 1.25, 1.85, 2.0])
    assert [row[2] for row in table.rows] == pytest.approx([-10.0, -6.5, 7.5, 25.0, 62.5, 92.5, 100.0])
    assert [column.key for column in table.columns] == ["quantile", "depth_offset_mm", "H_V_change_percent"]
    assert [column.unit for column in table.columns] == ["", "mm", "%"]
    silent = ReportData(altered(data.analysis, data.results | {"penetration": {"experiments": [], "seating": []}}))
    assert seating_quantiles_table(silent).rows == []


def test_the_largest_are_in_the_order_of_their_factor(data: ReportData) -> None:
    """Twice as hard, a quarter more, a tenth less: |ln| is 0.69, 0.22, 0.11."""
    table = seating_largest_table(data)
    names = [row["experiment"] for row in data.penetration]
    assert [row[0] for row in table.rows] == [names[2], names[1], names[0]]
    assert [row[5] for row in table.rows] == [100.0, 25.0, -10.0]
    assert table.rows[0][1:5] == (
        data.penetration[2]["site"],
        data.penetration[2]["edge_angle_deg"],
        data.penetration[2]["H_V_N_per_mm3"],
        (2.0, [-0.5, 4.5]),
    )
    assert [(column.key, column.kind) for column in table.columns[4:]] == [
        ("depth_offset_mm", "estimate"),
        ("H_V_change_percent", "number"),
    ]


def test_an_offset_shows_where_its_interval_leaves_zero_out() -> None:
    assert count_resolved_offsets([{"interval_mm": ends} for ends in ENDS]) == 2
