"""Which density, drop-cone depth and spot an experiment has."""

import math

import numpy as np
import pytest

import skisnow
from skisnow.estimation.regressions import (
    DENSITY_KEY,
    DROP_CONE_KEY,
    HARDNESS_KEY,
    STRESS_KEY,
    penetration_observations,
    shear_observations,
    spot_observations,
)

from .conftest import MakeCampaign

SNOW = {
    "density.csv": "sample,site,snow_density_kg_per_m3\n1,A,400\n2,A,440\n3,B,500\n",
    "drop_cone.csv": "test,site,repeat,drop_cone_depth_mm\nt1,A,1,10\nt1,A,2,12\nt2,A,1,21\n",
}


def series(name: str, site: str, depth: float, *more: object) -> list[tuple[object, ...]]:
    return [(name, site, "ski", 0, load, depth * load / 300, *more) for load in (100, 200, 300)]


def test_own_value_wins_else_the_site_s_mean_else_none(make_campaign: MakeCampaign) -> None:
    """Density: mean of samples. Drop cone: mean of the tests' means, (11 + 21)/2, not of the three repeats."""
    rows = [*series("p1", "A", 1, ""), *series("p2", "A", 1, 480), *series("p3", "C", 1, "")]
    campaign = make_campaign(rows, columns=",snow_density_kg_per_m3", further=SNOW)
    found = penetration_observations(campaign, np.ones(3), np.ones(3, dtype=bool))
    np.testing.assert_allclose(found.columns[DENSITY_KEY], [420, 480, math.nan])
    np.testing.assert_allclose(found.columns[DROP_CONE_KEY], [16, 16, math.nan])


def test_a_spot_pairs_geometric_mean_hardness_with_mean_stress(make_campaign: MakeCampaign) -> None:
    """The same spot name at another site is another spot; experiments not used take no part."""
    rows = [
        *series("p1", "A", 1, "x"),
        *series("p2", "A", 1, "x"),
        *series("p3", "B", 1, "x"),
        *series("p4", "A", 1, ""),
    ]
    shear = [
        (f"s{i}", site, "blade", 90, 6, 250, 30, spot)
        for i, (site, spot) in enumerate([("A", "x"), ("A", "x"), ("C", "x")])
    ]
    campaign = make_campaign(rows, shear, columns=",spot", shear_columns=",spot")
    hardness = penetration_observations(campaign, np.array([1e9, 4e9, 7e9, 9e9]), np.ones(4, dtype=bool))
    stress = shear_observations(campaign, np.array([1e5, 3e5, 9e5]), np.ones(3, dtype=bool))
    found = spot_observations(hardness, stress)
    assert (found.site, found.spot) == (("A",), ("x",))
    assert found.columns[HARDNESS_KEY].tolist() == pytest.approx([2.0])
    assert found.columns[STRESS_KEY].tolist() == pytest.approx([0.2])
    only_first = spot_observations(
        penetration_observations(campaign, np.array([1e9, 4e9, 7e9, 9e9]), np.array([True, False, True, True])), stress
    )
    assert only_first.columns[HARDNESS_KEY].tolist() == pytest.approx([1.0])


def test_regression_on_density_equals_a_line_by_numpy(make_campaign: MakeCampaign) -> None:
    density = [400, 450, 480, 520, 560, 600]
    moment = [10, 14, 13, 18, 22, 21]
    shear = [
        (f"s{i}", "AB"[i % 2], "blade", 90, 6, 250, m, d) for i, (m, d) in enumerate(zip(moment, density, strict=True))
    ]
    campaign = make_campaign(shear=shear, shear_columns=",snow_density_kg_per_m3")
    results = skisnow.results_dict(skisnow.analyse(campaign))
    row = next(r for r in results["regressions"] if r["terms"][1] == DENSITY_KEY and r["response"] == STRESS_KEY)
    slope, intercept = np.polyfit(density, np.array(moment) / 0.25 / 600, 1)
    assert row["b"] == pytest.approx([intercept, slope], rel=1e-9)
    assert row["n"] == 6
    assert row["rmse"] == pytest.approx(row["rmse_dof"] * math.sqrt(4 / 6))
    assert row["interval_by_site"] is not None


@pytest.mark.parametrize(
    ("density", "judged"), [([400, 450], False), ([400, 450, 520], False), ([400, 450, 520, 600], True)]
)
def test_a_predictor_of_fewer_than_four_values_is_not_judged(
    make_campaign: MakeCampaign, density: list[int], judged: bool
) -> None:
    """The slope stands; F and p are withheld with the reason, however clear the relation looks."""
    values = [density[i % len(density)] for i in range(12)]
    shear = [(f"s{i}", "AB"[i % 2], "blade", 90, 6, 250, d / 20 + 0.1 * i, d) for i, d in enumerate(values)]
    campaign = make_campaign(shear=shear, shear_columns=",snow_density_kg_per_m3")
    results = skisnow.results_dict(skisnow.analyse(campaign, n_resamples=100))
    row = next(r for r in results["regressions"] if r["terms"][1] == DENSITY_KEY and r["response"] == STRESS_KEY)
    assert row["predictor_values"] == len(density)
    assert row["b"][1] > 0
    if judged:
        assert row["p"] < 1e-6
        assert row["withheld"] is None
    else:
        assert (row["F"], row["p"]) == (None, None)
        assert f"{len(density)} different values" in row["withheld"]
