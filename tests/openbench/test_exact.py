"""Each exact answer again, another way than its formula in openbench: by adding up, or by stepping."""

import math

import numpy as np
import pytest
from openbench.reading import read_answer, read_case


def told(name: str, key: str) -> list[float]:
    values: list[float] = read_answer(name)["values"][key]
    return values


def test_plate_by_hand() -> None:
    """H A = 2.4 N/µm. Down 3 mm: 7.2 kN; back 0.2 mm ten times as steep: - 4.8 kN; half of it again: 4.8 kN."""
    assert told("01-plate", "force_N")[9:] == pytest.approx([7200.0, 2400.0, 4800.0], rel=1e-11)
    # from 2 mm: 0.1 mm back halves it, another 0.05 mm again, 0.2 mm frees it; pressed again it is as it was
    again = [4800, 2400, 1200, 0, 0, 2400, 4800]
    assert told("01-plate", "force_N")[2:9] == pytest.approx(again, rel=1e-9, abs=1e-8)
    assert told("01-plate", "depth_m")[:4] == pytest.approx(
        [500 / 2.4e6, 2000 / 2.4e6, 2000 / 2.4e6 - 1000 / 2.4e7, 2000 / 2.4e6 - 1900 / 2.4e7], rel=1e-11
    )


@pytest.mark.parametrize("place", range(3))
def test_edge_by_adding_up_strips(place: int) -> None:
    """Strips of a micrometre across the wedge, each with its own largest depth, carry each load at the depth told."""
    case = read_case("02-edge")
    hard, ratio, length = 4e7, 10.0, 0.4
    slope = math.tan(math.radians(case["body"]["edge_angle_deg"][place]))
    x = (np.arange(20000) + 0.5) * 1e-6
    deepest = np.zeros_like(x)
    depths = np.reshape(told("02-edge", "depth_m"), (3, 4))[place]
    for depth, load in zip(depths, case["loads"]["load_N"], strict=True):
        now = depth - slope * x
        deepest = np.maximum(deepest, now)
        force = (
            length * 1e-6 * hard * np.sum(np.maximum(0.0, np.where(now > 0, deepest - ratio * (deepest - now), 0.0)))
        )
        assert force == pytest.approx(load, rel=1e-5)
    fresh = length * 1e-6 * hard * np.sum(np.maximum(0.0, 0.005 - slope * x))
    assert np.reshape(told("02-edge", "force_by_heading_N"), (3, 7))[place] == pytest.approx([fresh] * 7, rel=1e-5)


def test_energy_of_a_cycle_by_work_and_energy_of_a_shear_cycle_by_return_mapping() -> None:
    """A wedge at 45°: the force down ½ H L e², up (1 - κ (e_m - e)/e_m)² of the largest, integrated over the way."""
    hard, length, ratio, deepest = 1e8, 0.4, 8.0, 0.0
    lost = []
    for peak in read_case("03-cycles")["motion"]["peak_depth_m"]:
        e = np.linspace(0.0, peak, 200_001)
        old = np.maximum(e, deepest)
        down = 0.5 * hard * length * old**2 * np.maximum(0.0, 1 - ratio * (1 - e / np.maximum(old, 1e-12))) ** 2
        deepest = max(deepest, peak)
        up = 0.5 * hard * length * deepest**2 * np.maximum(0.0, 1 - ratio * (1 - e / deepest)) ** 2
        lost.append(float(np.trapezoid(down - up, e)))
    assert told("03-cycles", "energy_lost_per_cycle_J") == pytest.approx(lost, rel=1e-6, abs=1e-9)
    grip, reach, lost = 3e5 * 0.002 * 0.4, 5e-4, []
    for amplitude in read_case("03-cycles")["motion"]["shear_amplitude_m"]:
        anchor, work, before = 0.0, 0.0, 0.0
        turn = amplitude * np.cos(np.linspace(0, 2 * math.pi, 20001))
        way = np.concatenate([np.linspace(0, amplitude, 2001), turn])
        for number, y in enumerate(way):
            anchor = min(max(anchor, y - reach), y + reach)
            force = grip * (anchor - y) / reach
            if number > 2001:
                work -= 0.5 * (force + before) * (y - way[number - 1])
            before = force
        lost.append(work)
    assert told("03-cycles", "energy_lost_per_shear_cycle_J") == pytest.approx(lost, rel=1e-4, abs=1e-6)


def test_glide_by_stepping() -> None:
    """Newton's law step by step; the depth by halving on the side view's area; compaction by adding up the bend."""
    low, high, weight = 0.0, 0.04, 40.0 * 9.81
    s = np.linspace(0.0, 0.2, 200_001)
    for _ in range(50):
        e = 0.5 * (low + high)
        bend = np.maximum(0.0, e - 0.2 * s)
        carries = 4e5 * 0.06 * (1.4 * e + float(np.trapezoid(bend, s)))
        low, high = (low, e) if carries > weight * math.cos(math.radians(12)) else (e, high)
    back = float(np.trapezoid(4e5 * 0.06 * bend * 0.2, s))
    assert told("04-glide", "groove_depth_m")[0] == pytest.approx(e, rel=1e-6)
    assert told("04-glide", "groove_residual_depth_m")[0] == pytest.approx(0.9 * e, rel=1e-6)
    assert told("04-glide", "groove_energy_J_per_m")[0] == pytest.approx(0.9 * back, rel=1e-5)
    drive = weight * (math.sin(math.radians(12)) - 0.04 * math.cos(math.radians(12))) - back
    square, found, h = 16.0, [], 1e-4
    for number in range(1, 100_001):  # d(v²)/ds = 2 (drive - c v²)/m, midpoint rule
        half = square + 0.5 * h * 2.0 * (drive - 0.36 * square) / 40.0
        square += h * 2.0 * (drive - 0.36 * half) / 40.0
        if number % 20_000 == 0:
            found.append(square)
    assert told("04-glide", "speed_squared_m2_per_s2") == pytest.approx(found, rel=1e-6)


@pytest.mark.parametrize("place", range(4))
def test_crossing_by_counting_squares(place: int) -> None:
    """Squares of 0.5 mm: which lie under the runner, which on the older track."""
    angle = math.radians([90.0, 60.0, 30.0, 15.0][place])
    cell, hard = 5e-4, 1e7
    x, y = np.meshgrid((np.arange(1600) + 0.5) * cell - 0.4, (np.arange(120) + 0.5) * cell - 0.03, indexing="ij")
    on_track = np.abs(math.sin(angle) * x + math.cos(angle) * y) < 0.03
    shared, whole = on_track.sum() * cell**2, 0.8 * 0.06
    swept = 2.0 * 0.06
    lost = 0.45 * hard * (0.008**2 * swept - 0.006**2 * shared)
    assert told("08-crossing", "energy_lost_J")[place] == pytest.approx(lost, rel=1e-3)
    depth = told("08-crossing", "depth_m")[place]
    carried = hard * depth * (whole - shared) + shared * max(0.0, hard * (0.006 - 10.0 * (0.006 - depth)))
    assert carried == pytest.approx(2000.0, rel=2e-3)
