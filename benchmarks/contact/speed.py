"""What a look at the contact costs: one flexible ski that carves, on each instruction set of the compiled core."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Final

import numpy as np
import numpy.typing as npt

from skisnow import read_ski
from skisnow.compiled import core
from skisnow.contact import Runner, SnowContact, SnowField

FloatArray = npt.NDArray[np.float64]

NODES: Final = 41
STEP_S: Final = 5e-4
RADIUS_M: Final = 12.0
SPEED_M_PER_S: Final = 8.0
STEPS: Final = 400
CALLS: Final = 500


def carving(step: int) -> tuple[FloatArray, FloatArray]:
    """Pose of a ski edged by 35° on a circle."""
    turn, angle = SPEED_M_PER_S * STEP_S * step / RADIUS_M, math.radians(35.0)
    c, s, ca, sa = math.cos(turn), math.sin(turn), math.cos(angle), math.sin(angle)
    rotation = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) @ [[1, 0, 0], [0, ca, sa], [0, -sa, ca]]
    return np.array([[RADIUS_M * s, RADIUS_M * (1.0 - c), 0.016]]), rotation[None]


def _microseconds(call: Callable[[], object], repeats: int) -> float:
    """The shortest of some batches, for each call."""
    shortest = math.inf
    for _ in range(repeats):
        begin = time.perf_counter()
        for _ in range(CALLS):
            call()
        shortest = min(shortest, time.perf_counter() - begin)
    return 1e6 * shortest / CALLS


def times(name: str, repeats: int) -> tuple[float, float, float]:
    """Microseconds of a force, of a step that is accepted, and of the lines that lie in the snow (their number)."""
    ski = read_ski("giant-slalom")
    nodes = np.linspace(ski.station[0], ski.station[-1], NODES)
    snow = SnowField(2e8, 5e5, 10.0, friction=0.02)
    contact = SnowContact(snow, [Runner.of(ski, nodes=nodes)], instruction_set=name)
    beam = [np.zeros((NODES, 3))]
    for step in range(STEPS):
        contact.update(*carving(step), STEP_S, beam_dofs=beam)
    pose, moving = carving(STEPS), np.array([[SPEED_M_PER_S, 0, 0, 0, 0, SPEED_M_PER_S / RADIUS_M]])
    force = _microseconds(lambda: contact.force(*pose, moving, STEP_S, beam_dofs=beam, beam_rates=beam), repeats)
    loaded = float((contact.sections().depth > 0.0).sum())
    places = iter(range(STEPS, STEPS + repeats * CALLS + 1))
    update = _microseconds(lambda: contact.update(*carving(next(places)), STEP_S, beam_dofs=beam), repeats)
    return force, update, loaded


def print_table(repeats: int) -> None:
    """One row for each instruction set, as Markdown; ratios to the plainest, measured in the same run."""
    print("| instruction set | force (µs) | accepted step (µs) | force, over baseline | lines in the snow |")
    print("| --- | --- | --- | --- | --- |")
    plain = 0.0
    for name in core.instruction_sets():
        force, update, loaded = times(name, repeats)
        plain = plain or force
        print(f"| {name} | {force:.1f} | {update:.1f} | {force / plain:.2f} | {loaded:.0f} |", flush=True)
