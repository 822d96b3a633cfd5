"""All experiments, used or not."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...units import MM
from ..table import Column, Table

if TYPE_CHECKING:
    from ..report_data import ReportData


def penetration_table(data: ReportData) -> Table:
    """Every penetration experiment with its three hardnesses."""
    rows = [
        (
            row["experiment"],
            row["site"],
            row["tool"],
            row["edge_angle_deg"],
            row["n_loads"],
            row["used"],
            row["flags"],
            (row["H_e_N_per_mm"], row["H_e_interval_N_per_mm"]),
            (row["H_A_N_per_mm2"], row["H_A_interval_N_per_mm2"]),
            (row["H_V_N_per_mm3"], row["H_V_interval_N_per_mm3"]),
        )
        for row in data.penetration
    ]
    return Table(
        "penetration_experiments",
        "Penetration experiments: hardness from the largest load (Eqn 1) with 95 % interval.",
        (
            Column("experiment", "Experiment", "text"),
            Column("site", "Site", "text"),
            Column("tool", "Tool", "text"),
            Column("edge_angle_deg", "ϑ", "angle", "°"),
            Column("n_loads", "loads", "count"),
            Column("used", "used", "yes"),
            Column("flags", "flags", "codes"),
            Column("H_e_N_per_mm", "H_e", "estimate", "N/mm"),
            Column("H_A_N_per_mm2", "H_A", "estimate", "N/mm²"),
            Column("H_V_N_per_mm3", "H_V", "estimate", "N/mm³"),
        ),
        rows,
    )


def shear_table(data: ReportData) -> Table:
    """Every shear experiment."""
    tests = data.campaign.shear
    depths = [] if tests is None else (tests.penetration_depth / MM).tolist()
    rows = [
        (
            row["experiment"],
            row["site"],
            row["plate"],
            row["edge_angle_deg"],
            depth,
            row["F_t_N"],
            (row["S_f_N_per_mm2"], row["S_f_interval_N_per_mm2"]),
            row["used"],
            row["flags"],
        )
        for row, depth in zip(data.shear, depths, strict=True)
    ]
    return Table(
        "shear_experiments",
        "Shear experiments: force and failure shear stress (Eqns 7 to 9) with the 95 % interval that the instruments "
        "allow.",
        (
            Column("experiment", "Experiment", "text"),
            Column("site", "Site", "text"),
            Column("plate", "Plate", "text"),
            Column("edge_angle_deg", "ϑ", "angle", "°"),
            Column("depth_mm", "e", unit="mm"),
            Column("F_t_N", "F_t", unit="N"),
            Column("S_f_N_per_mm2", "S_f", "estimate", "N/mm²"),
            Column("used", "used", "yes"),
            Column("flags", "flags", "codes"),
        ),
        rows,
    )
