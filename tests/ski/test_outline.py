from __future__ import annotations

import numpy as np
import pytest

from skisnow.ski.layout import layout_of_lengths
from skisnow.ski.outline import ArcOutline

LAYOUT = layout_of_lengths(length=1.593, running_length=1.396, sidecut_length=1.458, boot_position=0.03)
SLALOM = ArcOutline(layout=LAYOUT, tip_width=0.116, waist_width=0.068, tail_width=0.101)


def test_the_three_widths_are_where_they_belong() -> None:
    at = np.array([1.458 / 2 - 0.03, -0.03, -1.458 / 2 - 0.03])
    assert SLALOM.width_at(at) == pytest.approx([0.116, 0.068, 0.101], abs=1e-15)


def test_narrowest_place_is_behind_the_middle() -> None:
    """Vertex of the parabola by hand: s = -(15·1458)/(4·81) = -67.5 mm, 15²/(8·81) = 0.347 mm narrower."""
    station = np.linspace(-0.3, 0.3, 60001)
    width = SLALOM.width_at(station)
    assert station[np.argmin(width)] - LAYOUT.middle == pytest.approx(-0.0675, abs=2e-5)
    assert 0.068 - width.min() == pytest.approx(0.347e-3, abs=1e-6)
    assert SLALOM.narrowing == pytest.approx(0.068 - width.min(), abs=1e-9)


def test_curvature_of_the_side_line_is_constant() -> None:
    step = 1e-3
    station = LAYOUT.middle + np.linspace(-0.7, 0.7, 1401)
    second = np.diff(SLALOM.width_at(station) / 2.0, 2) / step**2
    assert second == pytest.approx(8.0 * 0.02025 / 1.458**2, rel=1e-6)  # 8 δ / L²


def test_tip_closes_as_an_ellipse_to_a_fifth_and_the_tail_is_straight() -> None:
    front, rear = LAYOUT.widest_points
    assert SLALOM.width_at(np.array([LAYOUT.tip]))[0] == pytest.approx(0.2 * 0.116, rel=1e-12)
    # half way: sqrt(1 - 0.96/4)
    assert SLALOM.width_at(np.array([(front + LAYOUT.tip) / 2.0]))[0] == pytest.approx(0.116 * 0.76**0.5, rel=1e-12)
    assert SLALOM.width_at(np.array([rear - 0.01, LAYOUT.tail])) == pytest.approx([0.101, 0.101], rel=1e-12)


def test_straight_piece_without_tip() -> None:
    piece = layout_of_lengths(length=0.2, running_length=0.2, sidecut_length=0.2, tail_overhang=0.0)
    outline = ArcOutline(layout=piece, tip_width=0.062, waist_width=0.062, tail_width=0.062)
    assert np.all(outline.width_at(np.linspace(0.1, -0.1, 9)) == 0.062)
    assert outline.narrowing == 0.0


def test_the_tip_ends_as_wide_as_said() -> None:
    outline = ArcOutline(layout=LAYOUT, tip_width=0.116, waist_width=0.068, tail_width=0.101, end_width=0.058)
    front = LAYOUT.widest_points[0]
    middle, end = outline.width_at(np.array([(front + LAYOUT.tip) / 2.0, LAYOUT.tip]))
    assert end == pytest.approx(0.058, rel=1e-12)
    assert middle == pytest.approx(0.116 * (1.0 - 0.75 / 4.0) ** 0.5, rel=1e-12)
