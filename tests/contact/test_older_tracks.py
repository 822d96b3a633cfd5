"""Lines that learn of older tracks as the ski comes to them, and that stand for the ski halfway to their neighbours."""

from __future__ import annotations

import math

import numpy as np
import pytest

from skisnow.contact import Runner, SnowContact, SnowField

from .conftest import FloatArray, edged, straight

H, S = 0.2e9, 0.3e6
LEVEL = np.eye(3)
AWAY = [0.0, 5.0, 1.0]


def turning_skid(spacing: float, slip: float = math.radians(18.0)) -> tuple[SnowContact, FloatArray]:
    """A ski on an arc of 20 m at 15 m/s, turned 18° inwards of its way: its lines fan out under it. The force after
    0.25 s, in its own axes."""
    place = np.linspace(0.8, -0.8, 81)
    ski = Runner(place, 0.033 + 0.02 * (place / 0.8) ** 2, 0.02 * np.maximum(np.abs(place) - 0.65, 0.0) / 0.15)
    contact = SnowContact(SnowField(H, S, 10.0), [ski], spacing=spacing)
    speed, radius, dt = 15.0, 20.0, 1e-3
    for step in range(251):
        heading = speed / radius * step * dt
        pose = [[radius * math.sin(heading), radius * (1.0 - math.cos(heading)), 0.012]]
        rotation = edged(math.radians(25.0), lean=0.0026, turn=heading + slip)
        contact.update(pose, [rotation], dt if step else 0.0)
    motion = [[speed * math.cos(heading), speed * math.sin(heading), 0.0, 0.0, 0.0, speed / radius]]
    force = contact.force(pose, [rotation], motion, 0.0).wrench[0][:3]
    return contact, rotation.T @ np.asarray(force)


def test_the_lines_stand_for_the_whole_ski_however_they_fan_out() -> None:
    """By one spacing each they stood for 1.6 % more or less."""
    contact, force = turning_skid(0.02)
    assert np.sum(contact.sections(0).length) == pytest.approx(1.6, rel=1e-12)
    _, finer = turning_skid(0.005)
    assert np.linalg.norm(force - finer) < 0.005 * np.linalg.norm(finer)


@pytest.mark.parametrize("gap", [0.0, 0.7])
def test_a_ski_meets_the_groove_in_which_another_still_stands(gap: float) -> None:
    """It slips sideways to where the other ski was pressed and lifted; nobody has left a track by going on."""
    deep, height = -2e-3, -1e-3
    contact = SnowContact(SnowField(H, S, 10.0), [straight(length=1.0), straight(length=1.0)])
    for z in (1e-3, deep, 0.5):
        contact.update([[gap, 0.0, z], AWAY], [LEVEL, LEVEL], 0.0)
    aside = np.arange(0.5, -0.001, -0.02)
    for y in aside:
        contact.update([[gap, 0.0, 0.5], [0.0, y, 0.002]], [LEVEL, LEVEL], 5e-3)
    found = contact.force([[gap, 0.0, 0.5], [0.0, 0.0, height]], [LEVEL, LEVEL], np.zeros((2, 6)), 0.0).wrench
    virgin = SnowContact(SnowField(H, S, 10.0), [straight(length=1.0)])
    whole = virgin.force([[0.0, 0.0, height]], [LEVEL], np.zeros((1, 6)), 0.0).wrench[0][2]
    assert found[1][2] == pytest.approx(gap * whole, rel=0.02, abs=1e-9)


@pytest.mark.parametrize("x", [-0.25, 0.25])
@pytest.mark.parametrize("y", [-0.25, 0.25])
def test_a_track_is_found_wherever_it_lies(x: float, y: float) -> None:
    """To the right of the origin and behind it none was found by lines that begin there."""
    snow = SnowField(H, S, 10.0)
    first = SnowContact(snow, [straight(length=0.1)])
    for step in np.arange(-1.0, 1.0, 0.02):
        first.update([[x + step, y, -2e-3]], [LEVEL], 5e-4)
    over = SnowContact(snow, [straight(length=0.3)])
    force = over.force([[x, y, -1e-3]], [LEVEL], np.zeros((1, 6)), 0.0).wrench[0]
    assert abs(force[2]) < 1e-9


@pytest.mark.parametrize("shift", np.arange(0.0, 0.02, 0.0025))
@pytest.mark.parametrize("turn", [0.5 * math.pi, 0.49 * math.pi, 0.3 * math.pi])
def test_a_thin_track_is_met_or_its_width_is_told(shift: float, turn: float) -> None:
    """An edge of 4 mm crosses the way of a ski: wherever its lines lie, they meet the track, or its width is told."""
    snow, ahead = SnowField(H, S, 10.0), np.array([math.cos(turn), math.sin(turn), 0.0])
    thin = SnowContact(snow, [straight(length=0.05, width=0.004)])
    for step in np.arange(-0.3, 0.3, 0.02):
        thin.update([ahead * step + [shift, 0.0, -2e-3]], [edged(0.0, turn=turn)], 5e-4)
    over = SnowContact(snow, [straight(length=1.0, width=0.06)])
    force = over.force([[0.0, 0.0, -1e-3]], [LEVEL], np.zeros((1, 6)), 0.0).wrench[0][2]
    per_length = H * 1e-3 * 0.06
    missing, told = per_length * 1.0 - force, over.unseen_track_width
    assert told > 0.0 or missing > 0.5 * 0.004 * per_length / math.sin(turn)
    if turn == 0.5 * math.pi:
        assert (told, missing) in (
            (pytest.approx(0.004), pytest.approx(0.0, abs=1e-9)),
            (0.0, pytest.approx(0.02 * per_length)),
        )
    if turn == 0.3 * math.pi:
        assert told == 0.0
    assert thin.unseen_track_width == 0.0
