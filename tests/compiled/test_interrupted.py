"""A long call of compiled code hears signals."""

from __future__ import annotations

import math
import signal
from types import FrameType

import pytest

from skisnow import carve
from skisnow.ski import read_ski
from skisnow.snow import published_snow

EVERY = 0.01
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


@pytest.mark.skipif(not hasattr(signal, "ITIMER_PROF"), reason="this system has no timer of the processor's time")
def test_a_steady_carve_is_left_at_a_signal() -> None:
    """Python runs a handler at most once in a call that does not listen, after its end."""
    ski, snow = read_ski("giant-slalom"), published_snow("race-piste")
    former = signal.signal(signal.SIGPROF, Beats())
    try:
        signal.setitimer(signal.ITIMER_PROF, EVERY, EVERY)
        with pytest.raises(LeftError):
            carve(ski, snow, edge_angle=math.radians(60), load=800.0, unloading_ratio=math.inf, elements=12_800)
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, former)
