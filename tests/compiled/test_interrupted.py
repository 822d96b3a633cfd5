"""A long call of compiled code hears a signal within 0.2 s of the processor's time: the machine may be busy."""

from __future__ import annotations

import math
import signal
import time
from types import FrameType

import pytest

from skisnow import carve
from skisnow.ski import read_ski
from skisnow.snow import published_snow

WITHIN = 0.2  # s


class LeftError(Exception):
    """What the signal raises."""


def interrupt(signum: int, frame: FrameType | None) -> None:  # noqa: ARG001
    raise LeftError


@pytest.mark.skipif(not hasattr(signal, "ITIMER_PROF"), reason="this system has no timer of the processor's time")
def test_a_steady_carve_is_left_at_a_signal() -> None:
    """Ten times as fine as usual: all but the first hundredth of a second is one call of the core."""
    ski, snow = read_ski("giant-slalom"), published_snow("race-piste")
    former = signal.signal(signal.SIGPROF, interrupt)
    try:
        for wait in (0.05, 0.1, 0.15):
            begin = time.process_time()
            signal.setitimer(signal.ITIMER_PROF, wait)
            with pytest.raises(LeftError):
                while True:
                    carve(ski, snow, edge_angle=math.radians(60), load=800.0, unloading_ratio=math.inf, elements=1_600)
            assert time.process_time() - begin < wait + WITHIN
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, former)
