"""The edge of a bent ski that is pitched against the snow: its groove lies on the curve of the edge in space."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

from skisnow.contact import Runner, SnowContact, SnowField

from .conftest import FloatArray, edged

TIP, TAIL, WIDEST, TWIST = 0.9, -0.7, 0.7, 0.2
STATIONS = np.linspace(TIP, TAIL, 1601)
NODES = np.linspace(TIP, TAIL, 17)


def half_width(station: FloatArray | float) -> FloatArray:
    """Of a shovel that narrows from its widest place to the tip (m)."""
    return 0.05 - 0.8 * np.maximum(np.asarray(station) - WIDEST, 0.0) ** 2


def deflection(station: FloatArray | float) -> FloatArray:
    """A parabola in front of the boot, 8 cm at the tip (m)."""
    return 0.08 * np.maximum(np.asarray(station) / TIP, 0.0) ** 2


def edge(station: float, position: FloatArray, rotation: FloatArray) -> FloatArray:
    """Place in space of the left edge (m)."""
    twist, half = TWIST * station, float(half_width(station))
    return position + rotation @ [station, half * np.cos(twist), float(deflection(station)) - half * np.sin(twist)]


@pytest.mark.parametrize("pitch", [np.radians(20.0), np.radians(30.0), np.radians(40.0)])
def test_the_groove_of_a_ploughing_shovel_lies_on_its_edge(pitch: float) -> None:
    """Stations of the straight ski would leave an error of several millimetres across."""
    rotation, position = edged(0.2, lean=-pitch), np.zeros(3)
    position[2] = -0.03 - min(edge(s, position, rotation)[2] for s in STATIONS)
    slope_to_tail = -0.16 * np.maximum(NODES, 0.0) / TIP**2
    beam = np.column_stack([deflection(NODES), slope_to_tail, TWIST * NODES])
    runner = Runner(STATIONS, half_width(STATIONS), np.zeros(len(STATIONS)), nodes=NODES)
    contact = SnowContact(SnowField(2e8, 3e5, 10.0), [runner])
    contact.update([position], [rotation], 0.0, beam_dofs=[beam])
    tracks = contact.tracks()
    count = 0
    for number in np.unique(tracks[:, 1]):
        line = tracks[tracks[:, 1] == number]
        x, y, _, depth = line[np.argmax(line[:, 5]), 2:]
        if not (edge(WIDEST - 0.1, position, rotation)[0] < x < edge(TIP, position, rotation)[0]):
            continue
        station = brentq(lambda s, x=x: edge(s, position, rotation)[0] - x, WIDEST - 0.1, TIP, xtol=1e-13)
        exact = edge(station, position, rotation)
        assert y == pytest.approx(exact[1], abs=3e-6)
        assert depth == pytest.approx(-exact[2], abs=3e-6)
        count += 1
    assert count >= 3
