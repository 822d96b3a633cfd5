"""A sledge that crosses an older track at an angle: energies close, and the groove is not paid for again."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import pytest

from skisnow.simulate.motion.advance import OF_DAMPING, OF_RELEASED, OF_SHEAR, OF_SIDEWAYS, mechanical_energy
from skisnow.simulate.motion.archive import Archive, grown, leave_line
from skisnow.simulate.motion.forces import HELD, SPRINGY
from skisnow.simulate.motion.path import energy_in_snow
from skisnow.simulate.run_record import Record
from skisnow.simulate.run_setup import Setup, set_up

from ..equilibrium.synthetic import shovel
from .sledges import rigid_ski, scenario

FloatArray = npt.NDArray[np.float64]
MIDDLE = np.array([1.9, 0.0, 0.0])
"""Where the second sledge crosses the track of the first (m)."""
SECONDS = 1.3


def sledge() -> Setup:
    """On flat rigid skis, without friction, on a level."""
    ski = rigid_ski(base_height=shovel(1.2, 0.03, 1.6), running_length=1.2)
    return set_up(scenario(ski=ski, hardness=0.001, unloading_ratio=10.0, speed=3.0, duration=SECONDS))


def turned(setup: Setup, angle: float) -> Setup:
    """Sledge and lines turned about the middle, before it moves."""
    c, s = math.cos(angle), math.sin(angle)
    R = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    state, frame = setup.memory.state, setup.lines.frame
    state.place[:] = MIDDLE + R @ (state.place - MIDDLE)
    state.turn[:] = R @ state.turn
    frame[:, :3] = MIDDLE + (frame[:, :3] - MIDDLE) @ R.T
    for a in (3, 6, 9):
        frame[:, a : a + 3] = frame[:, a : a + 3] @ R.T
    return setup


def gone_over(setup: Setup) -> tuple[float, float]:
    """Energy (J) lost to the snow on the way, and what is open in the balance."""

    def stored() -> float:
        power = setup.memory.start.power
        moving = float(np.sum(mechanical_energy(setup.model, setup.world, setup.memory.state)))
        return moving + float(power[SPRINGY] + power[HELD])

    def in_snow() -> float:
        return float(energy_in_snow(setup.snow, setup.lines, setup.archive))

    before, snow_before, work_before = stored(), in_snow(), setup.memory.clock.work.copy()
    record = Record(setup)
    for moment in np.arange(1, round(100 * SECONDS) + 1):
        assert record.advance(np.array([0.01 * float(moment)])) is None
    work, lost = setup.memory.clock.work - work_before, in_snow() - snow_before
    taken = lost - work[OF_SIDEWAYS] + work[OF_RELEASED] + work[OF_SHEAR] + work[OF_DAMPING]
    return lost, stored() - before + taken


@pytest.fixture(scope="module")
def first() -> tuple[float, Archive]:
    """What the first sledge loses, and its whole track."""
    setup = sledge()
    lost, still_open = gone_over(setup)
    assert abs(still_open) < 1e-3 * lost
    room = len(setup.lines.flag) // 2
    for k in range(2):
        for c in range(int(setup.lines.count[k])):
            row = k * room + (int(setup.lines.first[k]) + c) % room
            leave_line(setup.archive, setup.lines, row, setup.snow.hardness, setup.snow.excess)
    return lost, setup.archive


def test_on_virgin_snow_the_direction_does_not_matter(first: tuple[float, Archive]) -> None:
    lost, _ = gone_over(turned(sledge(), 0.7))
    assert lost == pytest.approx(first[0], rel=1e-9)


@pytest.mark.parametrize("angle_deg", [90.0, 60.0, 30.0, 15.0])
def test_a_groove_that_is_crossed(first: tuple[float, Archive], angle_deg: float) -> None:
    """Both skis cross both grooves. The shovels drop into them and press deeper behind: half of what they save.

    The energy is open by 0.15 %: a line every 24 mm meets a groove of 65 mm, and its edges fall between lines.
    """
    setup = turned(sledge(), math.radians(angle_deg))
    setup.archive = grown(first[1], 4000, 100_000)
    lost, still_open = gone_over(setup)
    assert abs(still_open) < 2e-3 * lost
    width = float(setup.scenario.ski.width.max())
    per_area = first[0] / (2.0 * width * 3.88)  # of the first sledge, on its 3.88 m
    crossed = 4.0 * width**2 / math.sin(math.radians(angle_deg))
    assert 0.25 < (first[0] - lost) / (per_area * crossed) < 0.75
