"""Layered snow: exact series give their exponent back, noise alone is seldom marked, and intervals hold the truth."""

from __future__ import annotations

import math

import numpy as np
import pytest

import skisnow
from skisnow.estimation.campaign_model import fit_campaign
from skisnow.estimation.hardness import DEFINITIONS, hardness_at_largest_load
from skisnow.estimation.layering import layered, layering
from skisnow.estimation.readings import Readings, ReadingUncertainty
from skisnow.geometry import SkiPiece

from .conftest import MakeCampaign
from .test_errors_in_depth import series

TOOL = SkiPiece(0.2, 0.062)
LOADS = np.linspace(12.0, 492.0, 7)
ANGLE = math.radians(30.0)
FIFTY_PERCENT = 2.0 * math.log(1.5) / (math.log(LOADS[-1] / LOADS[0]) - math.log(1.5))
"""κ for which F/V grows by half from the first load to the last: (F/F₁)^((κ/2)/(1 + κ/2)) = 1.5."""


def layered_series(hardness: np.ndarray, kappa: float, scatter: float, offset: float, seed: int = 1) -> Readings:
    """The reference campaign's law, solved for the depth with scatter and an offset."""
    rng = np.random.default_rng(seed)
    volume = LOADS[-1] / hardness[:, None] * (LOADS / LOADS[-1]) ** (1.0 / (1.0 + kappa / 2.0))
    depth = TOOL.depth_at_volume(volume, ANGLE) * (1.0 + scatter * rng.standard_normal(volume.shape)) + offset
    return series(np.maximum(depth, 0.0), np.full(len(hardness), ANGLE), LOADS)


def test_f_over_v_grows_by_half() -> None:
    readings = layered_series(np.array([1e9]), FIFTY_PERCENT, 0.0, 0.0)
    ratio = readings.load / readings.displaced_volume
    assert ratio[-1] / ratio[0] == pytest.approx(1.5)
    assert ratio[-1] == pytest.approx(1e9)


@pytest.mark.parametrize("kappa", [-0.2, 0.0, 0.3])
def test_an_exact_series_with_an_offset_gives_back_its_exponent(kappa: float) -> None:
    hardness = np.array([2e7, 1e9, 3e10])
    readings = layered_series(hardness, kappa, 0.0, 3e-5)
    found = layering(readings, 1.2 * hardness, ReadingUncertainty(1e-7))
    np.testing.assert_allclose(2.0 / found.load_exponent - 2.0, kappa, atol=1e-4)


def test_even_snow_is_seldom_marked_and_layered_snow_is() -> None:
    """One in a hundred of 2000 even series is 20 ± 4.4; gauge and offset as in the reference campaign."""
    uncertainty = ReadingUncertainty(0.01e-3 / math.sqrt(12))
    hardness = np.full(2000, 0.1e9)
    H = DEFINITIONS["H_V"]
    even = layered_series(hardness, 0.0, 0.02, 2e-5)
    assert 4 <= layered(even, hardness_at_largest_load(even, H), uncertainty).sum() <= 36
    for kappa in (FIFTY_PERCENT, -FIFTY_PERCENT):
        clear = layered_series(hardness, kappa, 0.005, 2e-5)
        assert layered(clear, hardness_at_largest_load(clear, H), uncertainty).mean() > 0.9


@pytest.mark.parametrize("kappa", [0.0, FIFTY_PERCENT])
def test_the_interval_of_all_readings_holds_the_truth_in_layered_snow(kappa: float) -> None:
    uncertainty, hardness = ReadingUncertainty(0.01e-3 / math.sqrt(12)), np.full(1000, 0.1e9)
    readings = layered_series(hardness, kappa, 0.01, 2e-5)
    model = fit_campaign(readings, hardness_at_largest_load(readings, DEFINITIONS["H_V"]), uncertainty)
    low, high = model.hardness_interval.T
    assert 0.93 < ((low <= hardness) & (hardness <= high)).mean() < 0.985
    assert abs(model.log_hardness.mean() - math.log(0.1e9)) < 0.005


def test_a_layered_series_is_flagged_and_takes_part_and_b_has_no_interval_with_errors_in_depth(
    make_campaign: MakeCampaign,
) -> None:
    layers = layered_series(np.full(3, 0.05e9), 0.35, 0.0, 0.0).penetration_depth.reshape(3, 7) * 1e3
    even = layered_series(np.full(3, 0.05e9), 0.0, 0.002, 0.0).penetration_depth.reshape(3, 7) * 1e3
    rows = [
        (f"{name}{i}", "A", "ski", 30, load, f"{depth:.2f}")
        for name, depths in (("layered", layers), ("even", even))
        for i, each in enumerate(depths)
        for load, depth in zip(LOADS, each, strict=True)
    ]
    results = skisnow.results_dict(skisnow.analyse(make_campaign(rows), n_resamples=100))
    flags = {row["experiment"]: row["flags"] for row in results["penetration"]["experiments"]}
    assert all(flags[f"layered{i}"] == ["layered"] and flags[f"even{i}"] == [] for i in range(3))
    assert all(row["used"] for row in results["penetration"]["experiments"])
    fitted = results["penetration"]["errors_in_depth"]["models"]
    assert all(row["intervals"] == dict.fromkeys(("a0", "a1", "b0", "b1")) for row in fitted)
    assert results["penetration"]["models"][-2]["intervals"]["b0"] is not None
