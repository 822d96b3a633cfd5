"""The curve beside the entry form: a flat disc by hand."""

from pathlib import Path

import numpy as np
import pytest

from skisnow.campaign import read_campaign
from skisnow.estimation.result_rows import experiment_hardness, experiment_results
from skisnow.report.charts import series_curves


def test_a_disc_by_hand(tmp_path: Path) -> None:
    """A disc of 10 cm² 4 mm deep under 80 N: V = 4000 mm³, H_V = 0.02 N/mm³, and half the load at half the depth."""
    diameter = float(2.0 * np.sqrt(1000.0 / np.pi))
    (tmp_path / "campaign.toml").write_text(f'[[tool]]\nname = "d"\nshape = "disc"\ndiameter_mm = {diameter!r}\n')
    rows = ["experiment,site,tool,edge_angle_deg,load_N,depth_mm", "1,A,d,0,20,1", "1,A,d,0,40,2", "1,A,d,0,80,4"]
    (tmp_path / "penetration.csv").write_text("\n".join(rows) + "\n")
    campaign = read_campaign(tmp_path)
    found = experiment_results(campaign)["penetration"]["experiments"]
    assert found[0]["H_V_N_per_mm3"] == pytest.approx(0.02, rel=1e-12)
    (curve,) = series_curves(campaign, experiment_hardness(campaign))
    assert curve.load_N == (20.0, 40.0, 80.0)
    assert curve.depth_mm == pytest.approx((1.0, 2.0, 4.0), rel=1e-12)
    assert (curve.law_depth_mm[-1], curve.law_load_N[-1]) == pytest.approx((4.0, 80.0), rel=1e-12)
    assert np.interp(2.0, curve.law_depth_mm, curve.law_load_N) == pytest.approx(40.0, rel=1e-12)


def test_each_series_has_the_law_of_its_own_tool_and_angle(tmp_path: Path) -> None:
    """A wedge of 200 mm: V = L e² / (2 tan ϑ), and a disc of 10 cm²: V = A e; without a depth there is no law."""
    diameter = float(2.0 * np.sqrt(1000.0 / np.pi))
    (tmp_path / "campaign.toml").write_text(
        f'[[tool]]\nname = "d"\nshape = "disc"\ndiameter_mm = {diameter!r}\n'
        '[[tool]]\nname = "s"\nshape = "ski"\nlength_mm = 200\nwidth_mm = 62\n'
    )
    rows = ["experiment,site,tool,edge_angle_deg,load_N,depth_mm", "1,A,s,45,20,1", "1,A,s,45,80,2", "2,A,d,0,20,0"]
    rows += ["3,A,d,0,20,1", "3,A,d,0,40,2", "4,A,s,30,30,1", "4,A,s,30,120,2"]
    (tmp_path / "penetration.csv").write_text("\n".join(rows) + "\n")
    campaign = read_campaign(tmp_path)
    first, none, disc, last = series_curves(campaign, experiment_hardness(campaign))
    assert (none.experiment, none.law_depth_mm, none.law_load_N) == ("2", (), ())
    # each is on its law: the loads of the wedges go with the square of the depth, that of the disc with the depth
    for curve, loads in ((first, (20.0, 80.0)), (disc, (20.0, 40.0)), (last, (30.0, 120.0))):
        middle = len(curve.law_depth_mm) // 2
        assert (curve.law_depth_mm[middle], curve.law_depth_mm[-1]) == pytest.approx((1.0, 2.0), rel=1e-12)
        assert (curve.law_load_N[middle], curve.law_load_N[-1]) == pytest.approx(loads, rel=1e-12)
