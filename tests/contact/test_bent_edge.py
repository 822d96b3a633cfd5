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


def farthest(station: float, rotation: FloatArray) -> float:
    """Error (m) of an edge's place where the section of its line is up to half a width away from it.

    Both edges in the snow share a section; each then runs straight to the line, over m at most: ½ κ m², with the
    curvature 1.6 1/m of the outline.
    """
    twist = TWIST * station
    across = rotation @ [0.0, np.cos(twist), -np.sin(twist)]
    return float(0.5 * 1.6 * (half_width(station) * across[0] / rotation[0, 0]) ** 2)


ALONE = 0.4
"""Roll (rad) at which the left edge is alone in the snow."""


@pytest.mark.parametrize(
    ("pitch", "roll"), [(20.0, 0.2), (30.0, 0.2), (40.0, 0.2), (3.0, ALONE), (30.0, ALONE), (40.0, ALONE)]
)
def test_the_groove_of_a_ploughing_shovel_lies_on_its_edge(pitch: float, roll: float) -> None:
    """Stations of the straight ski would leave an error of several millimetres across, at 3° of 0.07 mm in depth."""
    rotation, position = edged(roll, lean=-np.radians(pitch)), np.zeros(3)
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
        error = 3e-6 if roll == ALONE else 3e-6 + farthest(station, rotation)
        assert y == pytest.approx(exact[1], abs=error)
        assert depth == pytest.approx(-exact[2], abs=error)
        count += 1
    assert count >= 3
