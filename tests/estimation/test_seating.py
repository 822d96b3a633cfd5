"""Seating against depth zeros that are known."""

import math

import numpy as np
import pytest

from skisnow.estimation.hardness import ReadingUncertainty
from skisnow.estimation.readings import Readings
from skisnow.estimation.seating import seating
from skisnow.geometry import Disc, SkiPiece, Tool

LOADS = np.linspace(12.0, 492.0, 7)


def seated(tool: Tool, angle: float, depth: np.ndarray) -> Readings:
    m, k = depth.shape
    flat = depth.ravel()
    return Readings(
        load=np.tile(LOADS[:k], m),
        penetration_depth=flat,
        edge_angle=np.full(m, angle),
        first=np.arange(m + 1) * k,
        largest=np.arange(m) * k + k - 1,
        tool=np.zeros(m, dtype=np.int64),
        tools=(tool,),
    )


@pytest.mark.parametrize(
    ("tool", "angle_deg", "offset"),
    [(SkiPiece(0.2, 0.062), 45.0, 2e-4), (SkiPiece(0.2, 0.062), 30.0, -1e-4), (Disc(0.1), 0.0, 1.5e-4)],
)
def test_an_exact_series_gives_back_offset_and_hardness(tool: Tool, angle_deg: float, offset: float) -> None:
    angle, H = math.radians(angle_deg), 1e9
    depth = tool.depth_at_volume(LOADS / H, angle) + offset
    readings = seated(tool, angle, depth[None, :])
    wrong = readings.load[-1:] / readings.displaced_volume[-1:]
    found = seating(readings, wrong, ReadingUncertainty(1e-6))
    assert found.offset[0] == pytest.approx(offset, rel=1e-6)
    assert found.hardness[0] == pytest.approx(H, rel=1e-6)
    # taking the offset off the last depth gives the true hardness back
    assert wrong[0] * (1 + found.hardness_change[0]) == pytest.approx(H, rel=1e-6)
    assert np.sign(found.hardness_change[0]) == np.sign(offset)


def test_a_flat_tool_is_the_straight_line_of_ordinary_least_squares() -> None:
    """With a constant depth uncertainty alone the fit is a line e = F/(H A) + δ, whose intercept NumPy knows."""
    rng = np.random.default_rng(4)
    tool, H = Disc(0.1), 2e7
    depth = tool.depth_at_volume(LOADS / H, 0.0) + 3e-4 + rng.normal(0, 1e-7, 7)
    readings = seated(tool, 0.0, depth[None, :])
    found = seating(readings, np.array([H]), ReadingUncertainty(1e-3))  # so large that no scatter is needed
    assert found.offset[0] == pytest.approx(np.polyfit(LOADS, depth, 1)[1], rel=1e-6)


def test_intervals_of_the_offset_cover_it() -> None:
    """2,000 series, 2 % scatter in depth and the gauge's rounding: 95 % within 3 binomial deviations and 1.5 %."""
    rng = np.random.default_rng(8)
    m, tool, angle = 2000, SkiPiece(0.2, 0.062), math.radians(45)
    H = 1e9 * np.exp(rng.normal(0, 0.2, (m, 1)))
    offset = rng.normal(0, 5e-5, m)
    depth = tool.depth_at_volume(LOADS / H, angle) * np.exp(rng.normal(0, 0.02, (m, 7))) + offset[:, None]
    readings = seated(tool, angle, np.round(depth, 5))
    found = seating(readings, readings.load[6::7] / readings.displaced_volume[6::7], ReadingUncertainty(1e-5 / 12**0.5))
    known = np.isfinite(found.offset)
    assert known.mean() > 0.99
    inside = (found.interval[known, 0] <= offset[known]) & (offset[known] <= found.interval[known, 1])
    assert abs(inside.mean() - 0.95) < 3 * math.sqrt(0.95 * 0.05 / m) + 0.015
    assert abs(np.median(found.offset[known] - offset[known])) < 5e-6


def test_two_readings_cannot_tell() -> None:
    tool = Disc(0.1)
    found = seating(seated(tool, 0.0, np.array([[1e-3, 2e-3]])), np.array([1e8]), ReadingUncertainty(1e-6))
    assert np.isnan(found.offset).all()
    assert np.isnan(found.interval).all()
    assert np.isnan(found.hardness_change).all()
