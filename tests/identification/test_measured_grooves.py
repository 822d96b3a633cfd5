"""H_V and S_f from marks: a rigid-plastic balance by hand, twins of the carved turn, bounds, and files."""

import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.identification import MeasuredGrooves, identification_dict, identify, read_measured_grooves
from skisnow.identification.groove_residuals import GrooveResiduals
from skisnow.scenario import scenario_file
from tests.coded import raises
from tests.present import present

CHANGES: dict[str, object] = {"snow.H_V_N_per_mm3": 0.1, "start.heading_deg": 0.0}


def residuals_of(measured: MeasuredGrooves | None = None) -> GrooveResiduals:
    none = np.zeros(0)
    return GrooveResiduals(
        measured or MeasuredGrooves("none", none, none, none, none, none, none),
        scenario_file("carved-46m", changes=CHANGES),
    )


def mass_of(own: GrooveResiduals) -> float:
    scenario = own.scenario.scenario
    return scenario.sledge.mass + 2.0 * scenario.ski.mass


def measured(
    depth: float, width: float, radius: float, *, share: float = 0.02, seed: int | None = None
) -> MeasuredGrooves:
    rng = None if seed is None else np.random.default_rng(seed)
    values = []
    for value in (depth, width, radius):
        noise = np.zeros(4) if rng is None else share * value * rng.standard_normal(4)
        values.append(value + noise)
    d, w, r = values
    spread = [np.full(4, share * value) for value in (depth, width, radius)]
    return MeasuredGrooves("marks.csv", d, w, r, spread[0], spread[1], spread[2])


def test_a_groove_is_what_carve_leaves_and_hardness_scales_as_in_the_wedge() -> None:
    """Depth of the wedge 2 % of its width tan 30°, and e (1 - 1/10) of the deepest edge stays."""
    groove = present(residuals_of().groove({"snow.H_V_N_per_mm3": 0.2}))
    assert groove.depth / 0.9 / groove.width == pytest.approx(math.tan(math.radians(30.0)), rel=0.1)  # twist
    assert groove.turn_radius == pytest.approx(16.2, abs=0.5)  # the simulated turn's median radius
    # e = √(2 F tan ϑ/(H_V L)) for a rigid ski: a quarter of the hardness doubles the depth; skis bend, so 20 %.
    soft, hard = (residuals_of().groove({"snow.H_V_N_per_mm3": value}) for value in (0.1, 0.4))
    assert present(soft).depth / present(hard).depth == pytest.approx(2.0, rel=0.2)


def test_hardness_and_edge_angle_of_a_twin_are_found() -> None:
    truth = {"snow.H_V_N_per_mm3": 0.25, "sledge.edge_angle_deg": 35.0}
    groove = present(residuals_of().groove(truth))
    data = measured(groove.depth, groove.width, groove.turn_radius)
    found = identify("carved-46m", data, "H_V,edge_angle", changes=CHANGES)
    assert found.outcome == "converged"
    assert found["H_V"].value == pytest.approx(0.25, rel=0.01)
    assert found["edge_angle"].value == pytest.approx(35.0, abs=0.1)


def test_an_edge_that_holds_bounds_the_strength_from_below() -> None:
    """At heading 0 the turn needs m v²/R of both skis, S_f ∫ e ds holds it: the bound by hand from the groove."""
    own = residuals_of()
    groove = present(own.groove({"snow.H_V_N_per_mm3": 0.25}))
    data = measured(groove.depth, groove.width, groove.turn_radius)
    found = identify("carved-46m", data, "H_V,S_f", changes=CHANGES)
    assert found.outcome == "not_identifiable"
    assert found["S_f"].value is None
    needed = mass_of(own) * 7.0**2 / groove.turn_radius / (2.0 * groove.grip_area) / 1e6
    low, high = found["S_f"].interval or (None, None)
    assert high is None
    assert 0.7 * needed < present(low) < needed
    assert "bounded from below" in found.warnings[0]
    assert found["H_V"].value == pytest.approx(0.25, rel=0.01)


def test_profile_and_bootstrap_of_what_a_holding_edge_tells() -> None:
    """Depth goes with 1/√H_V, which is linear in logarithms nearly: both intervals go with that by curvature."""
    groove = present(residuals_of().groove({"snow.H_V_N_per_mm3": 0.25}))
    data = measured(groove.depth, groove.width, groove.turn_radius, seed=2)
    found = identify("carved-46m", data, "H_V,S_f", changes=CHANGES, profile=True, bootstrap=60)
    hardness = found["H_V"]
    assert hardness.profile_interval == pytest.approx(present(hardness.interval), rel=0.02)
    assert np.isnan(present(found.bootstrap)[:, 1]).all()
    low, high = present(hardness.bootstrap_interval)
    assert present(low) < 0.25 < present(high)


def test_an_edge_that_slides_gives_the_strength() -> None:
    """The radius that S_f = 0.03 N/mm² holds at 7 m/s, wider than the ski carves."""
    own = residuals_of()
    groove = present(own.groove({"snow.H_V_N_per_mm3": 0.25}))
    radius = mass_of(own) * 7.0**2 / (2.0 * 0.03e6 * groove.grip_area)
    assert radius > 1.2 * groove.turn_radius
    found = identify("carved-46m", measured(groove.depth, 3.0 * groove.width, radius), "H_V,S_f", changes=CHANGES)
    assert found.outcome == "converged"
    assert found["S_f"].value == pytest.approx(0.03, rel=0.01)
    assert found["H_V"].value == pytest.approx(0.25, rel=0.01)
    assert any("the edge slid" in text for text in found.methods)


def test_side_of_the_slope_counts() -> None:
    """A turn to the left that heads left of the fall line is pulled outwards by g sin α sin χ."""
    own = residuals_of()
    across = own.demand({"start.heading_deg": 90.0}, math.inf)
    assert across == pytest.approx(mass_of(own) * 9.81 * math.sin(math.radians(10.0)), rel=1e-9)
    assert own.demand({"start.heading_deg": -90.0}, math.inf) == pytest.approx(-across, rel=1e-9)
    right = {"start.heading_deg": 90.0, "sledge.edge_angle_deg": -30.0}
    assert own.demand(right, math.inf) == pytest.approx(-across, rel=1e-9)


def test_a_mean_radius_weighs_each_by_its_variance() -> None:
    """10 m ± 1 m and 16 m ± 2 m: (10 + 16/4)/(1 + 1/4) = 11.2 m ± 1/√1.25 m; one without a number counts nothing."""
    radius, sd = np.array([10.0, 16.0, np.nan]), np.array([1.0, 2.0, 1.0])
    ones = np.ones(3)
    found = residuals_of(MeasuredGrooves("three", ones, ones, radius, ones, ones, sd))
    assert found.mean_radius == pytest.approx((11.2, 1.25**-0.5))
    assert np.isnan(residuals_of().mean_radius).all()


def test_a_profile_is_as_steep_as_where_the_run_starts() -> None:
    """It falls by tan 12° at x = 7 m: the pull of the slope on a turn across it is that of 12°."""
    own = residuals_of()
    scenario = own.scenario.scenario
    slope = SimpleNamespace(gradients=lambda x: -math.tan(math.radians(12.0)) if x == 7.0 else 0.0, gravity=9.81)
    start = replace(scenario.start, x=7.0)
    asked = SimpleNamespace(
        scenario=SimpleNamespace(slope=slope, start=start, ski=scenario.ski), values=own.scenario.values
    )
    pulled = GrooveResiduals(own.measured, cast("Any", asked)).demand({"start.heading_deg": 90.0}, math.inf)
    assert pulled == pytest.approx(mass_of(own) * 9.81 * math.sin(math.radians(12.0)), rel=1e-9)


def test_elastic_snow_keeps_no_groove() -> None:
    with raises(ParameterError, "elastic_snow"):
        identify("carved-46m", measured(2e-3, 4e-3, 16.0), "H_V", changes={"snow.unloading_ratio": 1.0})


class TestFile:
    def test_units_and_missing_cells(self, tmp_path: Path) -> None:
        path = tmp_path / "marks.csv"
        header = "depth_mm,width_mm,turn_radius_m,depth_sd_mm,width_sd_mm,turn_radius_sd_m"
        path.write_text(f"{header}\n2.5,5,16,0.1,0.5,0.3\n2.6,,-17,0.1,,0.3\n", encoding="utf-8")
        read = read_measured_grooves(path)
        assert read.stated
        assert read.depth.tolist() == pytest.approx([2.5e-3, 2.6e-3])
        assert math.isnan(read.width[1])
        assert read.turn_radius.tolist() == [16.0, 17.0]
        assert read.width_sd[0] == pytest.approx(0.5e-3)

    def test_scatter_takes_the_part_of_missing_deviations(self, tmp_path: Path) -> None:
        path = tmp_path / "marks.csv"
        path.write_text("depth_mm\n2\n3\n4\n", encoding="utf-8")
        read = read_measured_grooves(path)
        assert not read.stated
        assert read.depth_sd.tolist() == pytest.approx([1e-3] * 3)
        path.write_text("depth_mm\n2\n3\n", encoding="utf-8")
        with pytest.raises(ParameterError, match="depth_sd_mm"):
            read_measured_grooves(path)

    def test_a_depth_of_nothing_is_rejected(self, tmp_path: Path) -> None:
        path = tmp_path / "marks.csv"
        path.write_text("depth_mm,depth_sd_mm\n0,0.1\n", encoding="utf-8")
        with pytest.raises(ParameterError, match="above 0"):
            read_measured_grooves(path)


@pytest.mark.parametrize("stated", [True, False])
def test_the_strength_alone_from_marks_of_an_edge_that_held(stated: bool) -> None:
    """Nothing else is identified: the bound is that of the own snow, with the scatter of the radius."""
    own = residuals_of()
    groove = present(own.groove({}))
    data = replace(measured(groove.depth, groove.width, groove.turn_radius, share=0.02, seed=1), stated=stated)
    found = identify("carved-46m", data, "S_f", changes=CHANGES)
    assert found.outcome == "not_identifiable"
    assert found["S_f"].value is None
    assert found.correlation.shape == found.covariance.shape == (1, 1)
    low, high = found["S_f"].interval or (None, None)
    assert high is None
    radius = float(np.mean(data.turn_radius))
    needed = mass_of(own) * 7.0**2 / radius / (2.0 * groove.grip_area) / 1e6
    assert low == pytest.approx(needed * (1.0 - 1.645 * 0.02 / 2.0), rel=1e-3)  # four places, 1/R, one-sided
    assert f"the turn needed {needed:.3g} N/mm² (95 %: at least {present(low):.3g})" in found.warnings[0]
    assert len(found.fits) == 1
    assert found.data == (("marks.csv", "measured grooves (places: 4)"),)
    assert identification_dict(found)["parameters"]["snow.S_f_N_per_mm2"]["interval"] == [present(low), None]
