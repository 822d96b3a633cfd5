"""Hardness by Eqn 1 against numbers worked out by hand, and its interval against simulation."""

import math

import numpy as np
import pytest
from scipy import optimize, stats

from skisnow._support.units import N_PER_MM, N_PER_MM2, N_PER_MM3
from skisnow.estimation.campaign_model import CampaignModel, fit_campaign
from skisnow.estimation.hardness import (
    DEFINITIONS,
    Hardness,
    hardness,
    hardness_at_largest_load,
    hardness_of_all_readings,
)
from skisnow.estimation.readings import Readings, ReadingUncertainty
from skisnow.geometry import Disc, LyingCylinder, SkiPiece, Tool

LOADS = np.linspace(12.0, 492.0, 7)


def pressed(tool: Tool, angle: float, depth: np.ndarray, load: np.ndarray) -> Readings:
    """Readings of series of equal length, built without any file: depth and load are (m, k)."""
    m, k = depth.shape
    flat = depth.ravel()
    return Readings(
        load=np.broadcast_to(load, depth.shape).ravel().astype(float),
        penetration_depth=flat,
        edge_angle=np.full(m, angle),
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
    _, found = hardness_of_all_readings(readings, DEFINITIONS["H_V"], uncertainty)
    logs = np.log(readings.load / readings.displaced_volume).reshape(40, 7)
    known = (0.5 / LOADS) ** 2 + ((readings.contact_area / readings.displaced_volume).reshape(40, 7) * 1e-5) ** 2

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
