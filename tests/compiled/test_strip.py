"""The closed form across the ski against the point law and adaptive quadrature."""

from __future__ import annotations

from dataclasses import astuple, dataclass, replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from skisnow.compiled import core
from skisnow.forces.penetration import HypoplasticPoint

FloatArray = np.ndarray[tuple[int, ...], np.dtype[np.float64]]


@dataclass(frozen=True)
class Interval:
    """Lengths in mm, stiffnesses in N/mm³: numbers near 1."""

    start: float
    length: float
    depth0: float
    depth1: float
    groove0: float
    groove1: float
    hardness: float
    excess: float

    def sums(self) -> FloatArray:
        return sums(self)

    def pressure(self, xi: float) -> float:
        """The point law with its branches written out: virgin loading, or the steep branch down from H_V g."""
        share = (xi - self.start) / self.length
        depth = self.depth0 + share * (self.depth1 - self.depth0)
        groove = self.groove0 + share * (self.groove1 - self.groove0)
        if depth >= groove:
            return max(0.0, self.hardness * depth)
        unloading = self.hardness + self.excess
        return max(0.0, self.hardness * groove - unloading * (groove - depth))

    def lines(self) -> list[tuple[float, float]]:
        """Ends of the straight lines whose signs choose the branch: base over groove, base, pressure when unloading."""
        d0, d1, g0, g1 = self.depth0, self.depth1, self.groove0, self.groove1
        p0, p1 = (self.hardness * d - self.excess * (g - d) for d, g in ((d0, g0), (d1, g1)))
        return [(d0 - g0, d1 - g1), (d0, d1), (p0, p1)]

    def kinks(self) -> list[float]:
        """Places where a branch may change."""
        return [self.start + self.length * a / (a - b) for a, b in self.lines() if a * b < 0.0]


def sums(*intervals: Interval) -> FloatArray:
    return core.strip_sums(np.array([astuple(each) for each in intervals]))


depths = st.floats(-3.0, 6.0)
intervals = st.builds(
    Interval,
    start=st.floats(0.0, 20.0),
    length=st.floats(0.1, 30.0),
    depth0=depths,
    depth1=depths,
    groove0=depths,
    groove1=depths,
    hardness=st.floats(0.1, 5.0),
    excess=st.one_of(st.just(0.0), st.floats(0.0, 50.0)),
)


@settings(max_examples=300, deadline=None)
@given(intervals)
def test_force_and_moment_are_the_integrals_of_the_point_law(interval: Interval) -> None:
    end = interval.start + interval.length
    points = sorted(interval.kinks()) or None
    force = quad(interval.pressure, interval.start, end, points=points, epsabs=1e-9, epsrel=1e-11)[0]
    moment = quad(lambda xi: xi * interval.pressure(xi), interval.start, end, points=points, epsabs=1e-9, epsrel=1e-11)[
        0
    ]
    found = interval.sums()
    assert found[0] == pytest.approx(force, rel=1e-8, abs=1e-7)  # what quadrature asks of itself, with room
    assert found[1] == pytest.approx(moment, rel=1e-8, abs=1e-6)


@settings(max_examples=300, deadline=None)
@given(intervals)
def test_derivatives_are_differences(interval: Interval) -> None:
    """By a shift of depth or groove, and by a tilt of both about ξ = 0: the sums with ξ⁰, ξ¹, ξ²."""
    step = 1e-7
    start, end = interval.start, interval.start + interval.length
    lines = interval.lines()
    # a kink that sits at an end, or a line that lies on a kink, has one-sided derivatives
    assume(min(abs(value) for line in lines for value in line) > 1e-3)
    # the kink moves by step ξ/(slope of the line that crosses it) and takes its jump in pressure's slope along
    slope = min([abs(b - a) / interval.length for a, b in lines if a * b < 0.0], default=1.0)
    room = step * (interval.hardness + interval.excess) * max(end, 1.0) ** 3 / min(slope, 1.0)
    found = interval.sums()
    for power, (at0, at1) in enumerate(((1.0, 1.0), (start, end))):
        for name, first in (("depth", 2), ("groove", 5)):
            ends = []
            for side in (step, -step):
                changed = {f"{name}0": side * at0, f"{name}1": side * at1}
                ends.append(replace(interval, **{k: getattr(interval, k) + v for k, v in changed.items()}).sums())
            difference = (ends[0][:2] - ends[1][:2]) / (2.0 * step)
            expected = found[first + power : first + power + 2]
            assert difference == pytest.approx(expected, rel=1e-5, abs=1e-3 + room)


def test_by_hand() -> None:
    """Depth 2 → 0 mm on virgin snow, H_V 3, over 4 mm from ξ = 1: a triangle of 3 · 2 · 4/2 = 12 at 1 + 4/3."""
    found = Interval(1.0, 4.0, 2.0, 0.0, -9.0, -9.0, 3.0, 20.0).sums()
    assert found[:2] == pytest.approx([12.0, 12.0 * (1.0 + 4.0 / 3.0)])
    assert found[2:5] == pytest.approx([3.0 * 4.0, 3.0 * (5.0**2 - 1.0) / 2.0, 3.0 * (5.0**3 - 1.0) / 3.0])
    assert np.all(found[5:] == 0.0)


def test_a_groove_unloads_by_hand() -> None:
    """k_u = 4 H_V, groove 2 mm, base 1.8 mm: p = H_V (2 - 4 · 0.2) = 1.2 H_V; at 1.5 mm it carries nothing."""
    assert Interval(0.0, 5.0, 1.8, 1.8, 2.0, 2.0, 1.0, 3.0).sums()[0] == pytest.approx(1.2 * 5.0)
    assert Interval(0.0, 5.0, 1.5, 1.5, 2.0, 2.0, 1.0, 3.0).sums()[0] == pytest.approx(0.0, abs=1e-14)
    assert Interval(0.0, 5.0, 1.4, 1.4, 2.0, 2.0, 1.0, 3.0).sums()[0] == 0.0


def test_it_adds() -> None:
    """Two halves are the whole."""
    whole = Interval(0.5, 4.0, 3.0, -1.0, 2.0, 1.0, 1.0, 4.0)
    halves = Interval(0.5, 2.0, 3.0, 1.0, 2.0, 1.5, 1.0, 4.0), Interval(2.5, 2.0, 1.0, -1.0, 1.5, 1.0, 1.0, 4.0)
    assert sums(*halves) == pytest.approx(whole.sums(), rel=1e-12)


@pytest.mark.parametrize("ratio", [1.0, 2.0, 10.0, 1000.0])
def test_its_law_is_the_one_of_forces(ratio: float) -> None:
    """A level base in a level groove bears everywhere what the law of a point says."""
    hardness = 0.2e9
    law = HypoplasticPoint(snow_hardness=hardness, unloading_ratio=ratio)
    for depth in np.linspace(-1e-3, 8e-3, 31):
        for deepest in (0.0, 2e-3, 5e-3, 5e-3 * (1.0 + 1e-4)):
            level = Interval(0.0, 0.02, depth, depth, deepest, deepest, hardness, hardness * (ratio - 1.0))
            assert level.sums()[0] == pytest.approx(0.02 * law.stress(depth, deepest), rel=1e-12, abs=1e-9)
