"""The compiled core: sources, interruption, the contact of a strip."""

import importlib
import math
import shutil
import signal
import subprocess
import sys
from dataclasses import astuple, dataclass, replace
from pathlib import Path
from types import FrameType

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

import skisnow.compiled
from skisnow import carve
from skisnow.compiled import core, require_current
from skisnow.compiled.sources import fingerprint
from skisnow.forces.penetration import HypoplasticPoint
from skisnow.ski import read_ski
from skisnow.snow import published_snow

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


@settings(max_examples=120, deadline=None)
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


@settings(max_examples=120, deadline=None)
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


def test_forces_of_strips_add_up() -> None:
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


SOURCES = Path(skisnow.compiled.__file__).parents[2] / "core"


@pytest.mark.skipif(not SOURCES.is_dir(), reason="no C++ sources")
def test_an_edited_source_is_rejected(tmp_path: Path) -> None:
    copied = Path(shutil.copytree(SOURCES, tmp_path / "core"))
    require_current(core.SOURCE_HASH, copied)
    edited = copied / "contact" / "pressure_kernels.hpp"
    edited.write_text(edited.read_text(encoding="utf-8").replace("0.5 * width", "1.5 * width", 1), encoding="utf-8")
    with pytest.raises(ImportError, match=r"older than .*core"):
        require_current(core.SOURCE_HASH, copied)
    edited.unlink()
    assert fingerprint(copied) != core.SOURCE_HASH


@pytest.mark.skipif(not SOURCES.is_dir(), reason="no C++ sources")
def test_the_package_looks_when_it_is_imported(monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as edited:
        edited.setattr("skisnow.compiled.sources.fingerprint", lambda _: "another")
        with pytest.raises(ImportError, match="older than"):
            importlib.reload(skisnow.compiled)
    assert importlib.reload(skisnow.compiled).core is core


def test_the_build_asks_for_the_fingerprint_by_a_program(tmp_path: Path) -> None:
    """It needs nothing of the package, which is not built yet; line ends of Windows are those of Unix."""
    program = Path(skisnow.compiled.__file__).with_name("sources.py")
    told = []
    for name, text in (("a", b"one\ntwo\n"), ("b", b"one\r\ntwo\r\n"), ("c", b"one\n")):
        (tmp_path / name).mkdir()
        (tmp_path / name / "core.cpp").write_bytes(text)
        asked = [sys.executable, "-I", str(program), str(tmp_path / name)]
        told.append(subprocess.run(asked, check=True, capture_output=True, text=True).stdout)
        assert told[-1] == f"{fingerprint(tmp_path / name)}\n"
    assert told[0] == told[1] != told[2]


def test_without_sources_there_is_nothing_to_compare(tmp_path: Path) -> None:
    require_current("anything", tmp_path)
    (tmp_path / "a.cpp").touch()
    with pytest.raises(ImportError, match="older than"):
        require_current("anything", tmp_path)


EVERY = 0.005
"""Processor time (s) between two signals."""
BEATS = 3


class LeftError(Exception):
    """What the signal raises."""


class Beats:
    """A handler that raises after three signals in a row at one place of a Python program, that is in one call."""

    def __init__(self) -> None:
        self.place: tuple[FrameType | None, int] = (None, 0)
        self.count = 0

    def __call__(self, signum: int, frame: FrameType | None) -> None:  # noqa: ARG002
        place = (frame, -1 if frame is None else frame.f_lasti)
        self.count = self.count + 1 if place == self.place else 1
        self.place = place
        if self.count == BEATS:
            raise LeftError


@pytest.mark.skipif(not hasattr(signal, "ITIMER_PROF"), reason="no profiling timer")
def test_a_steady_carve_is_left_at_a_signal() -> None:
    """Python runs a handler at most once in a call that does not listen, after its end."""
    ski, snow = read_ski("giant-slalom"), published_snow("race-piste")
    former = signal.signal(signal.SIGPROF, Beats())
    try:
        signal.setitimer(signal.ITIMER_PROF, EVERY, EVERY)
        with pytest.raises(LeftError):
            carve(ski, snow, edge_angle=math.radians(60), load=800.0, unloading_ratio=math.inf, elements=2_400)
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, former)
