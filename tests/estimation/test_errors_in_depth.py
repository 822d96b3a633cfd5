"""Errors in depth against exact series, against odrpack, and where the offset cannot be fitted."""

import math
from typing import Any

import numpy as np
import odrpack
import pytest

from skisnow.estimation.campaign_model import fit_campaign
from skisnow.estimation.errors_in_depth import FittedHardness, _weights, fit_models_with_depth_errors, fitted_hardness
from skisnow.estimation.hardness import DEFINITIONS, hardness_at_largest_load
from skisnow.estimation.readings import Readings, ReadingUncertainty
from skisnow.geometry import SkiPiece

TOOL = SkiPiece(0.2, 0.062)
LOADS = np.linspace(12.0, 492.0, 7)


def series(depth: np.ndarray, angle: np.ndarray, load: np.ndarray) -> Readings:
    m, k = depth.shape
    return Readings(
        load=np.broadcast_to(load, depth.shape).ravel().astype(float),
        penetration_depth=depth.ravel(),
        edge_angle=angle,
        first=np.arange(m + 1) * k,
        largest=np.arange(m) * k + k - 1,
        tool=np.zeros(m, dtype=np.int64),
        tools=(TOOL,),
    )


def fitted(readings: Readings, uncertainty: ReadingUncertainty) -> FittedHardness:
    H = hardness_at_largest_load(readings, DEFINITIONS["H_V"])
    return fitted_hardness(readings, fit_campaign(readings, H, uncertainty))


def test_exact_series_with_an_offset_give_back_the_hardness_and_b_one() -> None:
    rng = np.random.default_rng(1)
    angle = np.radians(rng.choice([15.0, 30.0, 60.0], 12))
    H = 1e9 * np.exp(rng.normal(0, 0.5, 12))
    offset = rng.uniform(-1e-4, 2e-4, 12)
    depth = TOOL.depth_at_volume(LOADS / H[:, None], angle[:, None]) + offset[:, None]
    found = fitted(series(np.maximum(depth, 0), angle, LOADS), ReadingUncertainty(1e-6))
    touching = depth.min(axis=1) > 0
    assert touching.sum() >= 9
    # the weak priors of the model take a little: a hundredth of H_V, and of a typical offset
    np.testing.assert_allclose(found.value["H_V"][touching], H[touching], rtol=0.01)
    np.testing.assert_allclose(found.offset[touching], offset[touching], atol=2e-6)
    rows = fit_models_with_depth_errors(found.of(touching), ReadingUncertainty(1e-6))
    constant = next(row for row in rows if row.model.id == "H_V:a=none,b=constant")
    assert constant.b0 == pytest.approx(1.0, abs=1e-3)
    assert constant.rmse < 1e-2 * LOADS.max()


def test_one_reading_in_contact_leaves_the_depths_and_has_no_interval() -> None:
    depth = np.array([0.0, 0.0, float(TOOL.depth_at_volume(LOADS[6] / 1e9, math.radians(45)))])
    found = fitted(series(depth[None, :], np.array([math.radians(45)]), LOADS[4:]), ReadingUncertainty(1e-6))
    assert found.offset.tolist() == [0.0]
    np.testing.assert_array_equal(found.readings.penetration_depth, depth)
    assert found.value["H_V"][0] == pytest.approx(1e9)
    assert np.isnan(found.interval).all()


def test_effective_variance_agrees_with_orthogonal_distance_regression() -> None:
    """odrpack adjusts every depth; with errors small against the depths both minimise the same to first order.

    The law is a A + b V at one angle with hardness known; the difference must be a small part of the standard error.
    """
    rng = np.random.default_rng(3)
    angle, u_e, u_F, H = math.radians(40.0), 2e-5, 3.0, 0.2e9
    depth = np.tile(np.linspace(2e-3, 8e-3, 7), 30)
    A, V = TOOL.contact_area(depth, angle), TOOL.displaced_volume(depth, angle)
    load = H * (8e-4 * A + 0.7 * V) + rng.normal(0, u_F, depth.size)
    seen = depth + rng.normal(0, u_e, depth.size)
    readings = series(seen.reshape(30, 7), np.full(30, angle), load.reshape(30, 7))
    known = FittedHardness(
        readings, np.zeros(30), dict.fromkeys(DEFINITIONS, np.full(30, H)), np.zeros((30, 2)), np.zeros(30)
    )
    rows = fit_models_with_depth_errors(known, ReadingUncertainty(u_e, u_F))
    ours = next(row for row in rows if row.model.id == "H_V:a=constant,b=constant")

    def law(x: np.ndarray, beta: np.ndarray) -> np.ndarray:
        return H * (beta[0] * 1e-4 * TOOL.contact_area(x, angle) + beta[1] * TOOL.displaced_volume(x, angle))

    theirs = odrpack.odr_fit(law, seen, load, np.array([5.0, 1.0]), weight_x=u_e**-2, weight_y=u_F**-2)
    assert ours.a0 * 1e4 == pytest.approx(theirs.beta[0], abs=0.1 * theirs.sd_beta[0])
    assert ours.b0 == pytest.approx(theirs.beta[1], abs=0.1 * theirs.sd_beta[1])
    assert theirs.sd_beta[1] < 0.02


def test_weights_of_small_uncertainties_are_one_over_their_squares() -> None:
    """(0.1 · 2 N)² + (0.3 N)² + (400 N/m · 0.001 m)² = 0.29 N²; of a force of 0: 0.09 N²."""
    readings: Any = None  # asked for their number alone, where all is exact
    uncertainty = ReadingUncertainty(load=0.3, depth=0.001)
    found = _weights(readings, np.array([2.0, 0.0]), np.array([400.0, 0.0]), uncertainty, 0.1)
    assert found == pytest.approx([1.0 / 0.29, 1.0 / 0.09])
