"""Hardness of series: with an exponent, with errors in the depth, of several tests."""

import math
from typing import Any

import numpy as np
import odrpack
import pytest
from benchmarks.growing_hardness import ANGLE, growing
from scipy import optimize, stats

import skisnow
from skisnow._support.units import N_PER_MM, N_PER_MM2, N_PER_MM3
from skisnow.campaign import reference_campaign
from skisnow.estimation.campaign_model import CampaignModel, fit_campaign
from skisnow.estimation.errors_in_depth import (
    FittedHardness,
    _effective_weights,
    fit_models_with_depth_errors,
    fitted_hardness,
)
from skisnow.estimation.hardness import (
    DEFINITIONS,
    Hardness,
    hardness,
    hardness_at_largest_load,
    hardness_of_all_readings,
)
from skisnow.estimation.layering import growing_hardness, second_moment, site_growth
from skisnow.estimation.parts import seating_change
from skisnow.estimation.readings import Readings, ReadingUncertainty
from skisnow.estimation.spread_groups import bartlett
from skisnow.geometry import Disc, LyingCylinder, SkiPiece, Tool

from .conftest import MakeCampaign

LOADS = np.linspace(12.0, 492.0, 7)


def pressed(tool: Tool, angle: float | np.ndarray, depth: np.ndarray, load: np.ndarray) -> Readings:
    """Readings of series of equal length, built without any file: depth and load are (m, k)."""
    m, k = depth.shape
    flat = depth.ravel()
    return Readings(
        load=np.broadcast_to(load, depth.shape).ravel().astype(float),
        penetration_depth=flat,
        edge_angle=np.broadcast_to(angle, (m,)).astype(float),
        first=np.arange(m + 1) * k,
        largest=np.arange(m) * k + k - 1,
        tool=np.zeros(m, dtype=np.int64),
        tools=(tool,),
    )


def modelled(readings: Readings, uncertainty: ReadingUncertainty) -> CampaignModel:
    return fit_campaign(readings, hardness_at_largest_load(readings, DEFINITIONS["H_V"]), uncertainty)


def by_definition(readings: Readings, uncertainty: ReadingUncertainty | None = None) -> dict[str, Hardness]:
    model = modelled(readings, uncertainty or ReadingUncertainty())
    return {symbol: hardness(readings, definition, model) for symbol, definition in DEFINITIONS.items()}


def test_eqn_1_by_hand_for_the_edged_ski_piece() -> None:
    """45°, 10 mm, 500 N: e = 10 mm, A = 2000 mm², V = 10000 mm³."""
    found = by_definition(
        pressed(SkiPiece(0.2, 0.062), math.pi / 4, np.array([[0.005, 0.010]]), np.array([125.0, 500.0]))
    )
    assert found["H_e"].value[0] / N_PER_MM == pytest.approx(50.0, rel=1e-12)
    assert found["H_A"].value[0] / N_PER_MM2 == pytest.approx(0.25, rel=1e-12)
    assert found["H_V"].value[0] / N_PER_MM3 == pytest.approx(0.05, rel=1e-12)


@pytest.mark.parametrize(
    ("tool", "volume_mm3"),
    [
        (Disc(0.1), math.pi * 2500 * 4),
        (SkiPiece(0.2, 0.062), 200 * 62 * 4),
        (LyingCylinder(0.05, 0.1), 100 * (2500 * math.acos(46 / 50) - 46 * math.sqrt(400 - 16))),
    ],
)
def test_eqn_1_by_hand_for_the_flat_tools_at_4_mm(tool: Tool, volume_mm3: float) -> None:
    found = by_definition(pressed(tool, 0.0, np.array([[0.002, 0.004]]), np.array([100.0, 300.0])))
    assert found["H_V"].value[0] / N_PER_MM3 == pytest.approx(300.0 / volume_mm3, rel=1e-9)
    assert found["H_e"].value[0] / N_PER_MM == pytest.approx(75.0, rel=1e-12)


def test_at_zero_depth_there_is_no_hardness() -> None:
    found = by_definition(pressed(SkiPiece(0.2, 0.062), math.pi / 4, np.zeros((1, 3)), np.array([1.0, 2.0, 3.0])))
    for measured in found.values():
        assert np.isnan(measured.value).all()
        assert np.isnan(measured.interval).all()


def test_the_change_of_hardness_by_the_seating_by_hand() -> None:
    """Flat, V ~ e: 2 mm less 0.5 mm are 4/3 of the hardness; of a seating as deep as the reading nothing is left."""
    readings = pressed(SkiPiece(0.2, 0.062), 0.0, np.array([[0.001, 0.002]] * 3), np.array([100.0, 200.0]))
    found = seating_change(readings, np.array([0.0, 0.5e-3, 2e-3]))
    assert found == pytest.approx([0.0, 1.0 / 3.0, math.nan], nan_ok=True)


def test_the_interval_of_eqn_1_by_hand() -> None:
    """On edge V grows as e², A and e as e: H_V has twice the errors of the depth, H_A and H_e once.

    The scatter s is one of the force at the volume V: on edge H_A and H_e have half of it.
    """
    tool, angle = SkiPiece(0.2, 0.062), math.pi / 4
    depth = tool.depth_at_volume(LOADS / 9e9, angle)[None, :] * (1.0 + 0.02 * np.sin(np.arange(28.0))).reshape(4, 7)
    readings, uncertainty = pressed(tool, angle, depth, LOADS), ReadingUncertainty(1e-5 / math.sqrt(12), 4.92)
    model = modelled(readings, uncertainty)
    (tau2,), (s2,), (nu,) = model.spreads.seating2, model.spreads.scatter2, model.freedom.scatter
    for symbol, power in (("H_V", 2.0), ("H_A", 1.0), ("H_e", 1.0)):
        own = (power / 2.0) ** 2 * s2
        variance = own + 0.01**2 + (power / depth[:, -1]) ** 2 * (uncertainty.depth**2 + tau2)
        half = stats.t.ppf(0.975, variance**2 / (own**2 / nu)) * np.sqrt(variance)
        found = hardness(readings, DEFINITIONS[symbol], model)
        np.testing.assert_allclose(found.interval / found.value[:, None], np.exp(half[:, None] * [-1, 1]), rtol=1e-9)


def test_scatter_of_all_readings_is_their_standard_deviation() -> None:
    """Without stated uncertainties s is the sample deviation of ln(F/V), and the hardness their geometric mean."""
    rng = np.random.default_rng(5)
    tool = SkiPiece(0.2, 0.062)
    load = LOADS * np.exp(rng.normal(0, 0.1, 7))
    readings = pressed(tool, 0.0, tool.depth_at_volume(LOADS / 1e9, 0.0)[None, :], load)
    logs = np.log(load / readings.displaced_volume)
    value, scatter = hardness_of_all_readings(readings, DEFINITIONS["H_V"], ReadingUncertainty())
    assert scatter[0] == pytest.approx(logs.std(ddof=1), rel=1e-9)
    assert value[0] == pytest.approx(math.exp(logs.mean()), rel=1e-12)


def test_scatter_solves_the_equation_of_paule_and_mandel() -> None:
    """Q(s²) = n - 1, solved here by a bracketing root finder for each of 40 series."""
    rng = np.random.default_rng(6)
    tool, angle = SkiPiece(0.2, 0.062), math.radians(30)
    truth = tool.depth_at_volume(LOADS / 5e9, angle)
    depth = truth * np.exp(rng.normal(0, 0.03, (40, 7))) + rng.normal(0, 1e-5, (40, 7))
    readings = pressed(tool, angle, depth, LOADS)
    uncertainty = ReadingUncertainty(1e-5, 0.5)
    value, found = hardness_of_all_readings(readings, DEFINITIONS["H_V"], uncertainty)
    logs = np.log(readings.load / readings.displaced_volume).reshape(40, 7)
    known = (0.5 / LOADS) ** 2 + ((readings.contact_area / readings.displaced_volume).reshape(40, 7) * 1e-5) ** 2
    weights = 1.0 / (found[:, None] ** 2 + known)
    np.testing.assert_allclose(value, np.exp(np.average(logs, axis=1, weights=weights)), rtol=1e-9)

    def excess(s2: float, x: np.ndarray, v: np.ndarray) -> float:
        w = 1 / (s2 + v)
        return float(np.sum(w * (x - np.average(x, weights=w)) ** 2) - 6)

    n_scattered = 0
    for x, v, s in zip(logs, known, found, strict=True):
        if excess(0.0, x, v) <= 0:
            assert s == 0.0
        else:
            n_scattered += 1
            assert s**2 == pytest.approx(optimize.brentq(excess, 0.0, 1.0, args=(x, v), xtol=1e-15), rel=1e-6)
    assert n_scattered > 20


@pytest.mark.parametrize(("scatter", "gauge"), [(0.05, 1e-7), (0.0, 1e-5), (0.03, 1e-5)])
def test_intervals_cover_the_truth(scatter: float, gauge: float) -> None:
    """4,000 series with scatter and gauge alone: at least 93 %, and at most 98.5 % where snow scatters."""
    rng = np.random.default_rng(7)
    m, tool, angle = 4000, SkiPiece(0.2, 0.062), math.radians(45)
    H = 20e9 * np.exp(rng.normal(0, 0.2, (m, 1)))  # so that rounding falls differently in each series
    force = LOADS * np.exp(rng.normal(0, scatter, (m, 7)))
    depth = np.round(tool.depth_at_volume(force / H, angle) / gauge) * gauge
    readings, uncertainty = pressed(tool, angle, depth, LOADS), ReadingUncertainty(gauge / math.sqrt(12))
    model = modelled(readings, uncertainty)
    last = hardness(readings, DEFINITIONS["H_V"], model)
    deviation = 3 * math.sqrt(0.95 * 0.05 / m)
    for interval in (last.interval, model.hardness_interval):
        covered = float(np.mean((interval[:, 0] <= H[:, 0]) & (interval[:, 1] >= H[:, 0])))
        assert covered > 0.93 - deviation
        if scatter > 0:
            assert covered < 0.985 + deviation
    # the mean of 4,000 series with 1.2-3 % each
    assert abs(float(np.mean(model.log_hardness - np.log(H[:, 0])))) < 0.005


TOOL = SkiPiece(0.2, 0.062)


def fitted(readings: Readings, uncertainty: ReadingUncertainty) -> FittedHardness:
    H = hardness_at_largest_load(readings, DEFINITIONS["H_V"])
    return fitted_hardness(readings, fit_campaign(readings, H, uncertainty))


def test_exact_series_with_an_offset_give_back_the_hardness_and_b_one() -> None:
    rng = np.random.default_rng(1)
    angle = np.radians(rng.choice([15.0, 30.0, 60.0], 12))
    H = 1e9 * np.exp(rng.normal(0, 0.5, 12))
    offset = rng.uniform(-1e-4, 2e-4, 12)
    depth = TOOL.depth_at_volume(LOADS / H[:, None], angle[:, None]) + offset[:, None]
    found = fitted(pressed(TOOL, angle, np.maximum(depth, 0), LOADS), ReadingUncertainty(1e-6))
    touching = depth.min(axis=1) > 0
    assert touching.sum() >= 9
    # the weak priors of the model take a little: a hundredth of H_V, and of a typical offset
    np.testing.assert_allclose(found.value["H_V"][touching], H[touching], rtol=0.01)
    rows = fit_models_with_depth_errors(found.of(touching), ReadingUncertainty(1e-6))
    constant = next(row for row in rows if row.model.id == "H_V:a=none,b=constant")
    assert constant.b0 == pytest.approx(1.0, abs=1e-3)
    assert constant.rmse < 1e-2 * LOADS.max()


def test_one_reading_in_contact_leaves_the_depths_and_has_no_interval() -> None:
    depth = np.array([0.0, 0.0, float(TOOL.depth_at_volume(LOADS[6] / 1e9, math.radians(45)))])
    found = fitted(pressed(TOOL, math.radians(45), depth[None, :], LOADS[4:]), ReadingUncertainty(1e-6))
    np.testing.assert_array_equal(found.readings.penetration_depth, depth)
    assert found.value["H_V"][0] == pytest.approx(1e9)


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
    readings = pressed(TOOL, angle, seen.reshape(30, 7), load.reshape(30, 7))
    known = FittedHardness(readings, dict.fromkeys(DEFINITIONS, np.full(30, H)), np.zeros(30))
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
    found = _effective_weights(readings, np.array([2.0, 0.0]), np.array([400.0, 0.0]), uncertainty, 0.1)
    assert found == pytest.approx([1.0 / 0.29, 1.0 / 0.09])


GAUGE = 1e-5
UNCERTAINTY = ReadingUncertainty(GAUGE / math.sqrt(12.0))


def test_the_second_moment_by_hand() -> None:
    """Wedge: ∫ ε² dA = L e³/(3 tan ϑ); flat: L W e²."""
    load = np.array([100.0, 200.0])
    readings = pressed(TOOL, np.array([ANGLE, 0.0]), np.array([[1e-3, 3e-3], [1e-3, 3e-3]]), load)
    found = second_moment(readings, readings.penetration_depth)
    depth = np.array([1e-3, 3e-3])
    expected = [*(TOOL.length * depth**3 / (3.0 * math.tan(ANGLE))), *(TOOL.length * 0.062 * depth**2)]
    np.testing.assert_allclose(found, expected, rtol=1e-12)


@pytest.mark.parametrize("growth", [-0.3, 0.0, 0.2, 0.5, 2.0])
def test_an_exact_series_gives_its_growth_back(growth: float) -> None:
    hardness = np.array([1e8, 1e9, 1e10])
    readings = growing(hardness, growth)
    H = hardness_at_largest_load(readings, DEFINITIONS["H_V"])
    np.testing.assert_allclose(H, hardness, rtol=1e-9)
    found = growing_hardness(readings, H, ReadingUncertainty(1e-9))
    np.testing.assert_allclose(found.growth, growth, atol=1e-4)
    np.testing.assert_allclose(found.surface_hardness, hardness / (1.0 + 2.0 * growth / 3.0), rtol=1e-4)


@pytest.mark.parametrize("growth", [0.0, 0.2, 0.5])
def test_intervals_hold_it(growth: float) -> None:
    """1500 series of 2 % scatter, a gauge of 0.01 mm and offsets of 0.02 mm: 95 ± 2 % of the intervals; sites of 15."""
    readings = growing(np.full(1500, 1e8), growth, 0.02, 2e-5, step=GAUGE)
    found = growing_hardness(readings, hardness_at_largest_load(readings, DEFINITIONS["H_V"]), UNCERTAINTY)
    low, high = found.growth_interval.T
    assert np.isfinite(found.growth).mean() > 0.99
    assert np.mean((low <= growth) & (high >= growth)) == pytest.approx(0.95, abs=0.02)
    sites = [f"{index % 100}" for index in range(1500)]
    *means, _ = site_growth(found, np.ones(1500, dtype=bool), sites)
    assert np.mean([row.value for row in means]) == pytest.approx(growth, abs=0.02)
    assert np.mean([each.low <= growth <= each.high for each in means]) >= 0.88


def test_a_few_readings_leave_it_open(make_campaign: MakeCampaign) -> None:
    rows = [("P1", "A", "ski", 30, load, load / 100) for load in (100, 200, 300, 400)]
    found = skisnow.analyse(make_campaign(rows), n_resamples=100).results["penetration"]["growing_hardness"]
    assert found["sites"] == []
    assert found["experiments"][0]["growth_percent"] is None


def test_the_results_have_it_for_every_site() -> None:
    """Mean layering of the reference campaign is 0, of ± 0.15 from series to series."""
    found = skisnow.analyse(reference_campaign(1).campaign(), n_resamples=100)
    growth = found.results["penetration"]["growing_hardness"]
    assert len(growth["experiments"]) == 236
    assert [row["site"] for row in growth["sites"]] == [*(f"site {letter}" for letter in "ABCDEFGH"), None]
    low, high = growth["sites"][-1]["growth_interval_percent"]
    assert low < 0.0 < high


def test_spreads_are_compared_by_bartletts_test() -> None:
    rng = np.random.default_rng(3)
    samples = [rng.normal(0.0, scale, size) for scale, size in ((1.0, 8), (2.0, 12), (1.5, 5), (9.0, 3))]
    squares, degrees = np.array([(((x - x.mean()) ** 2).sum(), len(x) - 1.0) for x in samples]).T
    test = bartlett(squares, degrees, fewest=3.0)  # the last one has too few
    assert test.p == pytest.approx(stats.bartlett(*samples[:3]).pvalue, rel=1e-12)
    spreads = [x.std(ddof=1) for x in samples[:3]]
    assert test.factor == pytest.approx(max(spreads) / min(spreads), rel=1e-12)
    assert bartlett(squares[:1], degrees[:1], fewest=3.0).p == 1.0
