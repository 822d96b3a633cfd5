"""Flexible skis without snow, in MuJoCo, in Exudyn and here: speed with the error of the step beside it.

The peers' skis must have the frequencies of ours.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Final

import numpy as np

from skisnow.ski import Ski, read_ski

from ..timing import timed
from . import own_flight
from .cases import SCENARIO
from .clamped_modes import first_frequencies

SKI: Final = "giant-slalom"
FINER: Final = 10.0
"""By how much the reference's step is smaller."""
FREQUENCY_AGREES: Final = 0.03
"""Share of our clamped frequency within which a peer's must lie (Choice: 20 segments are within 0.5 %)."""
SWING_S: Final = 0.2
"""Time after which ends are compared: three swings of the ski."""
OWN_STEP_MS: Final = 0.5
MUJOCO_STEPS_MS: Final = (0.2, 0.5)
EXUDYN_STEP_MS: Final = 1.0


@dataclass(frozen=True, slots=True)
class Peer:
    """A peer's time.

    Attributes
    ----------
    what
        Program, model and step.
    us_per_step
        Wall time of a step (µs).
    times_real_time
        Simulated over wall time.
    tip_off_m
        How far a tip is from where a tenth of the step puts it after `SWING_S` (m).
    frequencies
        First clamped ones over ours; of our own none.
    absent
        Why it was not run; empty: it was.
    """

    what: str
    us_per_step: float = np.nan
    times_real_time: float = np.nan
    tip_off_m: float = np.nan
    frequencies: tuple[float, ...] = ()
    absent: str = ""


def peers(*, duration_s: float = 1.0, repeats: int = 5) -> Iterator[Peer]:
    """Our own sledge in flight, and every peer that is installed; the others with the reason why they are left out."""
    yield own(duration_s=duration_s, repeats=repeats)
    for program, measured in (("mujoco", mujoco_flight), ("exudyn", exudyn_swing)):
        if find_spec(program) is None:
            yield Peer(program, absent=f"{program} is not installed: pip install 'skisnow[peers]'")
        else:
            yield from measured(read_ski(SKI), duration_s=duration_s, repeats=repeats)


def own(*, duration_s: float, repeats: int) -> Peer:
    """Our sledge, which no snow bears."""
    ends = []
    for step_ms in (OWN_STEP_MS, OWN_STEP_MS / FINER):
        record = own_flight.released(step_ms)
        own_flight.flown(record, SWING_S)
        ends.append(own_flight.tips(record))
    starts = [own_flight.released(OWN_STEP_MS) for _ in range(repeats)]
    seconds = min(timed(partial(own_flight.flown, record, duration_s)) for record in starts)
    off = float(np.linalg.norm(ends[0] - ends[1], axis=1).max())
    what = f"skisnow, the sledge of {SCENARIO} in free flight, steps of {OWN_STEP_MS:g} ms"
    return Peer(what, 1e3 * OWN_STEP_MS * seconds / duration_s, duration_s / seconds, off)


def mujoco_flight(ski: Ski, *, duration_s: float, repeats: int) -> Iterator[Peer]:
    """Two skis of 20 segments each on a free sledge, no snow."""
    with _own_folder():
        from . import mujoco_skis as theirs

        for step_ms in MUJOCO_STEPS_MS:
            step = 1e-3 * step_ms
            model, reference = theirs.flight(ski, step=step), theirs.flight(ski, step=step / FINER)
            frequencies = agreeing("MuJoCo", theirs.clamped_frequencies(model), first_frequencies(ski))
            ends = []
            for each in (model, reference):
                data = theirs.released(each)
                theirs.flown(each, data, round(SWING_S / each.opt.timestep))
                ends.append(theirs.tips(data))
            steps = round(duration_s / step)
            starts = [theirs.released(model) for _ in range(repeats)]
            seconds = min(timed(partial(theirs.flown, model, data, steps)) for data in starts)
            off = float(np.linalg.norm(ends[0] - ends[1], axis=1).max())
            what = f"MuJoCo, two skis of 20 segments on a sledge in free flight, {step_ms:g} ms"
            yield Peer(what, 1e6 * seconds / steps, steps * step / seconds, off, frequencies)


def exudyn_swing(ski: Ski, *, duration_s: float, repeats: int) -> Iterator[Peer]:
    """One clamped ski of 40 cables, swinging in its plane."""
    from . import exudyn_ski as theirs

    step = 1e-3 * EXUDYN_STEP_MS
    ours = first_frequencies(ski)[:1]
    model = theirs.swinging(ski, frequency=ours[0])
    frequencies = agreeing("Exudyn", (model.frequency(),), ours)
    off = abs(model.tip(SWING_S, step=step)[-1, 1] - model.tip(SWING_S, step=step / FINER)[-1, 1])
    seconds = min(timed(lambda: model.tip(duration_s, step=step)) for _ in range(repeats))
    what = f"Exudyn, one clamped ski of 40 geometrically exact cables in its plane, {EXUDYN_STEP_MS:g} ms"
    yield Peer(what, 1e6 * seconds * step / duration_s, duration_s / seconds, off, frequencies)


def agreeing(program: str, theirs: tuple[float, ...], ours: tuple[float, ...]) -> tuple[float, ...]:
    """Their frequencies over ours, refused where they are of another ski."""
    ratios = tuple(a / b for a, b in zip(theirs, ours, strict=True))
    if max(abs(ratio - 1.0) for ratio in ratios) > FREQUENCY_AGREES:
        raise AssertionError(f"{program}'s clamped ski is another ski: its first frequencies over ours are {ratios}")
    return ratios


@contextmanager
def _own_folder() -> Iterator[None]:
    """MuJoCo writes its log to the current folder: let that be one that goes away."""
    before = Path.cwd()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            yield
        finally:
            os.chdir(before)
