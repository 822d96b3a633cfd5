"""Hardness by Eqn 1 against numbers worked out by hand, and its interval against simulation."""

import math

import numpy as np
import pytest
from scipy import optimize, stats

from skisnow._support.units import N_PER_MM, N_PER_MM2, N_PER_MM3
from skisnow.estimation.hardness import (
    DEFINITIONS,
    Hardness,
    ReadingUncertainty,
    hardness,
    hardness_of_all_readings,
)
from skisnow.estimation.readings import Readings
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


def by_definition(readings: Readings, uncertainty: ReadingUncertainty | None = None) -> dict[str, Hardness]:
    chosen = uncertainty or ReadingUncertainty()
    return {symbol: hardness(readings, definition, chosen) for symbol, definition in DEFINITIONS.items()}


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


def test_gauge_alone_at_90_newton_per_cubic_millimetre() -> None:
    """H_V = 90 at 45°: 0.23 mm deep; half a gauge step of 0.01 mm is 2.2 % in depth, 4.3 % in V (V grows as e²).

    With u_e = step/√12 alone the interval is exp(± t · 2 · u_e/e), t = 2.5706 for the 5 degrees of freedom of s.
    """
    tool, angle = SkiPiece(0.2, 0.062), math.pi / 4
    depth = tool.depth_at_volume(LOADS / 90e9, angle)[None, :]
    found = hardness(pressed(tool, angle, depth, LOADS), DEFINITIONS["H_V"], ReadingUncertainty(1e-5 / math.sqrt(12)))
    assert depth[0, -1] * 1e3 == pytest.approx(0.2338, abs=5e-4)
    half = 2.570582 * 2.0 * (1e-5 / math.sqrt(12)) / depth[0, -1]
    np.testing.assert_allclose(found.interval[0] / 90e9, np.exp([-half, half]), rtol=1e-6)
    assert found.scatter[0] == 0.0


def test_load_uncertainty_enters_in_proportion() -> None:
    tool = SkiPiece(0.2, 0.062)
    depth = tool.depth_at_volume(LOADS / 1e9, 0.0)[None, :]
    found = hardness(pressed(tool, 0.0, depth, LOADS), DEFINITIONS["H_V"], ReadingUncertainty(load=4.92))
    np.testing.assert_allclose(found.interval[0] / 1e9, np.exp([-2.570582e-2, 2.570582e-2]), rtol=1e-6)


def test_scatter_alone_is_the_classical_interval_of_one_more_reading() -> None:
    """Without stated uncertainties s is the sample deviation of ln(F/V), of the six others for the seventh reading."""
    rng = np.random.default_rng(5)
    tool = SkiPiece(0.2, 0.062)
    load = LOADS * np.exp(rng.normal(0, 0.1, 7))
    depth = tool.depth_at_volume(LOADS / 1e9, 0.0)[None, :]
    readings = pressed(tool, 0.0, depth, load)
    found = hardness(readings, DEFINITIONS["H_V"], ReadingUncertainty())
    logs = np.log(load / readings.displaced_volume)
    s = logs.std(ddof=1)
    every = hardness_of_all_readings(readings, DEFINITIONS["H_V"], ReadingUncertainty())
    assert every.scatter[0] == pytest.approx(s, rel=1e-9)
    np.testing.assert_allclose(
        np.log(found.interval[0]),
        logs[-1] + np.array([-1, 1]) * stats.t.ppf(0.975, 5) * logs[:-1].std(ddof=1),
        rtol=1e-9,
    )
    np.testing.assert_allclose(
        np.log(every.interval[0]),
        stats.t.interval(0.95, 6, logs.mean(), s / math.sqrt(7)),
        rtol=1e-9,
    )


def test_scatter_solves_the_equation_of_paule_and_mandel() -> None:
    """Q(s²) = n - 1, solved here by a bracketing root finder for each of 40 series."""
    rng = np.random.default_rng(6)
    tool, angle = SkiPiece(0.2, 0.062), math.radians(30)
    truth = tool.depth_at_volume(LOADS / 5e9, angle)
    depth = truth * np.exp(rng.normal(0, 0.03, (40, 7))) + rng.normal(0, 1e-5, (40, 7))
    readings = pressed(tool, angle, depth, LOADS)
    uncertainty = ReadingUncertainty(1e-5, 0.5)
    found = hardness_of_all_readings(readings, DEFINITIONS["H_V"], uncertainty)
    logs = np.log(readings.load / readings.displaced_volume).reshape(40, 7)
    known = (0.5 / LOADS) ** 2 + ((readings.contact_area / readings.displaced_volume).reshape(40, 7) * 1e-5) ** 2

    def excess(s2: float, x: np.ndarray, v: np.ndarray) -> float:
        w = 1 / (s2 + v)
        return float(np.sum(w * (x - np.average(x, weights=w)) ** 2) - 6)

    n_scattered = 0
    for x, v, s in zip(logs, known, found.scatter, strict=True):
        if excess(0.0, x, v) <= 0:
            assert s == 0.0
        else:
            n_scattered += 1
            assert s**2 == pytest.approx(optimize.brentq(excess, 0.0, 1.0, args=(x, v), xtol=1e-15), rel=1e-6)
    assert n_scattered > 20


@pytest.mark.parametrize(("scatter", "gauge"), [(0.05, 1e-7), (0.0, 1e-5), (0.03, 1e-5)])
def test_intervals_cover_the_truth_as_often_as_they_claim(scatter: float, gauge: float) -> None:
    """4,000 series whose error is the stated one: coverage of both intervals is 95 %, within 3 binomial deviations.

    Where scatter and gauge are of one size, s is estimated as 0 for some series and the interval is approximate: the
    documented 92 % are held. Where the gauge alone limits, the intervals may be wide but never narrow.
    """
    rng = np.random.default_rng(7)
    m, tool, angle = 4000, SkiPiece(0.2, 0.062), math.radians(45)
    H = 20e9 * np.exp(rng.normal(0, 0.2, (m, 1)))  # so that rounding falls differently in each series
    force = LOADS * np.exp(rng.normal(0, scatter, (m, 7)))
    depth = np.round(tool.depth_at_volume(force / H, angle) / gauge) * gauge
    readings, uncertainty = pressed(tool, angle, depth, LOADS), ReadingUncertainty(gauge / math.sqrt(12))
    last = hardness(readings, DEFINITIONS["H_V"], uncertainty)
    every = hardness_of_all_readings(readings, DEFINITIONS["H_V"], uncertainty)
    deviation = 3 * math.sqrt(0.95 * 0.05 / m)
    for interval in (last.interval, every.interval):
        covered = float(np.mean((interval[:, 0] <= H[:, 0]) & (interval[:, 1] >= H[:, 0])))
        assert covered > (0.92 if scatter > 0 and gauge > 1e-6 else 0.95) - deviation
        if scatter > 0:
            assert covered < 0.96 + deviation
    # the mean of 4,000 series with 1.2-3 % each
    assert abs(float(np.mean(np.log(every.value / H[:, 0])))) < 0.005
