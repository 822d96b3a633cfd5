"""A sledge that crosses an older track at an angle: energies close, and the groove is not paid for again."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from skisnow._support.errors import ModelLimitWarning
from skisnow.contact import SnowContact, SnowField
from skisnow.simulation.run_record import Record
from skisnow.simulation.run_setup import Setup, set_up
from skisnow.simulation.simulated_run import _warn_of_unseen_tracks

from ...carving.synthetic import shovel
from ...contact.conftest import edged, straight
from .sledges import rigid_ski, scenario

MIDDLE = np.array([1.9, 0.0, 0.0])
"""Where the second sledge crosses the track of the first (m)."""
SECONDS = 1.3


def sledge(angle: float = 0.0, snow: SnowField | None = None) -> Setup:
    """On flat rigid skis, without friction, on a level; turned by an angle (rad) about the middle.

    Its hold gives way by half a millimetre: a stiffer one carries more of the rounding into the groove.
    """
    ski = rigid_ski(base_height=shovel(1.2, 0.03, 1.6), running_length=1.2)
    given = scenario(ski=ski, hardness=0.001, unloading_ratio=10.0, speed=3.0, duration=SECONDS)
    x, y = MIDDLE[:2] - MIDDLE[0] * np.array([math.cos(angle), math.sin(angle)])
    loose = replace(given.contact, shear_displacement=0.5e-3)
    start = replace(given.start, x=float(x), y=float(y), heading=angle)
    return set_up(replace(given, contact=loose, start=start), snow)


def gone_over(setup: Setup) -> tuple[float, float]:
    """Energy (J) lost to the snow on the way, and the rest of the balance."""
    record = Record(setup)
    for moment in np.arange(1, round(100 * SECONDS) + 1):
        assert record.advance(0.01 * float(moment)) is None
    energies = record.histories()["energies"]
    still_open = sum(each[-1] - each[0] for each in energies.values())
    return float(energies["penetration"][-1]), float(still_open)


@pytest.fixture(scope="module")
def first() -> tuple[float, Setup]:
    """Losses of the first sledge, and the snow with its track."""
    setup = sledge()
    lost, still_open = gone_over(setup)
    assert abs(still_open) < 1e-3 * lost
    return lost, setup


@pytest.mark.parametrize("heading", [0.7, 1.0])
def test_on_virgin_snow_the_direction_does_not_matter(first: tuple[float, Setup], heading: float) -> None:
    """But for rounding: it decides which of two knots that are alike a groove gives up."""
    lost, _ = gone_over(sledge(heading))
    assert lost == pytest.approx(first[0], rel=2e-4)


@pytest.mark.parametrize("angle_deg", [90.0, 60.0, 30.0, 15.0])
def test_a_groove_that_is_crossed(first: tuple[float, Setup], angle_deg: float) -> None:
    """Both skis cross both grooves. The shovels drop into them and press deeper behind: they save a part, never more.

    The energy is open by 0.02 %.
    """
    before = first[1].dynamics.contact.state()
    setup = sledge(math.radians(angle_deg), first[1].snow)
    lost, still_open = gone_over(setup)
    first[1].dynamics.contact.restore(before)
    assert abs(still_open) < 2e-3 * lost
    width = float(setup.scenario.ski.width.max())
    per_area = first[0] / (2.0 * width * 3.88)  # of the first sledge, on its 3.88 m
    crossed = 4.0 * width**2 / math.sin(math.radians(angle_deg))
    assert 0.25 < (first[0] - lost) / (per_area * crossed) < 1.0


def test_thin_tracks_between_the_lines_are_warned_of() -> None:
    """Tracks of 4 mm at right angles, placed apart by a quarter of the spacing of 20 mm: one is between lines."""
    snow = sledge().snow
    thin = SnowContact(snow, [straight(length=0.05, width=0.004)])
    for x in (1.2, 1.305, 1.41, 1.515):
        for y in np.arange(-0.5, 0.5, 0.02):
            thin.update([[x, y, -5e-3]], [edged(0.0, turn=0.5 * math.pi)], 5e-4)
        thin.update([[x, 5.0, 1.0]], [edged(0.0)], 0.0)
    setup = sledge(snow=snow)
    record = Record(setup)
    for moment in range(1, 31):
        assert record.advance(0.01 * moment) is None
    with pytest.warns(ModelLimitWarning) as caught:
        _warn_of_unseen_tracks(setup)
    warning = caught[0].message
    assert isinstance(warning, ModelLimitWarning)
    assert warning.code == "tracks_between_lines"
    assert warning.fields["width"] == pytest.approx(4.0, rel=1e-6)
    mean = 0.5 * setup.scenario.sledge.mass * setup.scenario.gravity / 1.6  # N/m, but for the skis
    assert mean * 4e-3 < warning.fields["force"] < 10.0 * mean * 4e-3
