"""Edges as they are ground, and the edge of a bent ski, against closed forms and quadrature."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from skisnow import carve
from skisnow._support.arrays import FloatArray
from skisnow.contact import Runner, SnowContact, SnowField
from skisnow.forces.penetration import HypoplasticPoint
from skisnow.forces.shear import MachiningShear
from skisnow.forces.shear.law import SHEAR_DISPLACEMENT
from skisnow.ski.layout import EdgeShape

from ..carving.synthetic import rigid_ski, snow
from .conftest import edged, straight

Placed = tuple[FloatArray, FloatArray]
H, S, LENGTH, WIDTH = 2e8, 5e5, 1.6, 0.06
SHARP = EdgeShape(0.0, 2e-3, 0.5 * math.pi, 0.0)
GROUND = [
    EdgeShape(math.radians(1.0), 2e-3, math.radians(88.0), 0.0),
    EdgeShape(0.0, 2e-3, math.radians(88.0), 2e-4),
    EdgeShape(math.radians(0.7), 2.2e-3, math.radians(87.0), 1e-4),
]


def hinges(edge: EdgeShape, angle: float) -> list[tuple[float, float]]:
    """Way of each hinge from the edge (m), and what is lost of the depth for each metre of it: from the drawing.

    The strip is turned by β about its inner end. The circle of radius r touches strip and side; its lowest point lies
    r (cos(ϑ' + γ/2 - 90°)/sin(γ/2) - 1) above the corner, γ the angle there, and its chord begins at r cot(γ/2).
    """
    beta, width, side, radius = edge
    corner, strip = side + beta, angle - beta
    touches = radius / math.tan(0.5 * corner)
    loss = max(radius * (math.sin(strip + 0.5 * corner) / math.sin(0.5 * corner) - 1.0), 0.0) if strip > 0.0 else 0.0
    return [(width, math.sin(angle) - math.sin(strip)), (touches, loss / touches if touches else 0.0)]


def lost(edge: EdgeShape, angle: float) -> float:
    return sum(way * rise for way, rise in hinges(edge, angle))


def depth_at(edge: EdgeShape, angle: float, plane: float, x: FloatArray) -> FloatArray:
    """Of the base at distances x (m) from the left edge in the surface, that edge's corner unground `plane` deep."""
    across = x / math.cos(angle)
    out = plane - x * math.tan(angle)
    for sense, way in ((1.0, across), (-1.0, WIDTH - across)):
        for far, rise in hinges(edge, sense * angle):
            out -= np.maximum(far - way, 0.0) * rise
    return out


def placed(angle: float, plane: float, *, y: float = 0.0) -> Placed:
    return np.array([[0.0, y, 0.5 * WIDTH * math.sin(angle) - plane]]), edged(angle)[None]


def contact_of(edge: EdgeShape, snow: SnowField, *path: Placed) -> SnowContact:
    contact = SnowContact(snow, [replace(straight(length=LENGTH, width=WIDTH), edge_shape=edge)])
    for pose in path:
        contact.update(*pose, 5e-4)
    return contact


def wrench(contact: SnowContact, pose: Placed) -> FloatArray:
    return contact.force(*pose, np.zeros((1, 6)), 5e-4).wrench[0]


def integral(depths: FloatArray, reach: float) -> float:
    return float(np.trapezoid(depths, dx=reach / (len(depths) - 1)))


@pytest.mark.parametrize("edge", GROUND)
@pytest.mark.parametrize("degrees", [3.0, 20.0, 50.0, 75.0])
def test_force_depth_and_shear_of_a_ground_edge(edge: EdgeShape, degrees: float) -> None:
    """F = H L (E²/(2 tan ϑ) - Σ b² rise cos ϑ/2) with E the depth of the corner; the edge holds S L (E - lost)."""
    angle, plane = math.radians(degrees), 6e-3
    missing = sum(0.5 * far**2 * rise * math.cos(angle) for far, rise in hinges(edge, angle))
    contact = contact_of(edge, SnowField(H, S, 10.0), placed(angle, plane))
    if plane / math.sin(angle) < WIDTH:
        expected = H * LENGTH * (plane**2 / (2.0 * math.tan(angle)) - missing)
        assert wrench(contact, placed(angle, plane))[2] == pytest.approx(expected, rel=1e-9)
    depth = plane - lost(edge, angle)
    sections = contact.sections(0)
    assert sections.depth == pytest.approx(np.full(len(sections.depth), depth), rel=1e-9)
    aside = wrench(contact, placed(angle, plane, y=1.01 * SHEAR_DISPLACEMENT))
    other = max(plane - WIDTH * math.sin(angle) - lost(edge, -angle), 0.0)
    assert aside[1] == pytest.approx(-S * LENGTH * max(depth, other), rel=1e-9)


@pytest.mark.parametrize("edge", [SHARP, *GROUND])
@pytest.mark.parametrize("degrees", [0.0, 0.5, 4.0, 30.0])
@pytest.mark.parametrize("ratio", [1.0, 10.0])
def test_loading_and_unloading_are_those_of_each_place(edge: EdgeShape, degrees: float, ratio: float) -> None:
    """Against quadrature of max(0, H ε - (k_u - H)(ε_m - ε)) over the base, its force and its moment."""
    angle, plane = math.radians(degrees), 2e-3
    reach = WIDTH * math.cos(angle)
    x = np.linspace(0.0, reach, 100_001)
    deepest = np.maximum(depth_at(edge, angle, plane, x), 0.0)
    contact = contact_of(edge, SnowField(H, 0.0, ratio), placed(angle, plane))
    for rise in (0.0, 5e-5, 3e-4):
        depth = np.maximum(depth_at(edge, angle, plane - rise, x), 0.0)
        pressure = np.maximum(H * depth - (ratio - 1.0) * H * (deepest - depth), 0.0)
        pose = placed(angle, plane - rise)
        found = wrench(contact, pose)
        assert found[2] == pytest.approx(LENGTH * integral(pressure, reach), rel=1e-6, abs=1e-6)
        arm = 0.5 * reach - x
        assert found[3] == pytest.approx(LENGTH * integral(pressure * arm, reach), rel=1e-5, abs=1e-5)


@pytest.mark.parametrize("edge", GROUND)
def test_laws_from_outside_and_in_time_press_the_same_base(edge: EdgeShape) -> None:
    angle = math.radians(12.0)
    path = [placed(angle, plane) for plane in (1e-3, 2e-3)]
    look = placed(angle, 1.95e-3)
    known = wrench(contact_of(edge, SnowField(H, S, 10.0), *path), look)
    outside = SnowField(H, S, 10.0, penetration=HypoplasticPoint(H, 10.0))
    assert wrench(contact_of(edge, outside, *path), look) == pytest.approx(known, rel=1e-9, abs=1e-9)
    damped = SnowField(H, S, 10.0, damping=1e-9)
    assert wrench(contact_of(edge, damped, *path), look) == pytest.approx(known, rel=1e-9, abs=1e-9)


def test_the_machining_angle_is_that_of_the_strip() -> None:
    """2 cot((ϑ - β_bevel - β)/2) S over the depth of the edge."""
    edge, angle, plane = GROUND[0], math.radians(30.0), 2e-3
    law = MachiningShear(0.3 * S, math.radians(10.0))
    contact = contact_of(edge, SnowField(H, S, 1.0, shear=law), placed(angle, plane))
    aside = wrench(contact, placed(angle, plane, y=1.01 * SHEAR_DISPLACEMENT))[1]
    strength = law.failure_stress(plane, angle - edge.base_bevel)
    assert aside == pytest.approx(-float(strength) * LENGTH * (plane - lost(edge, angle)), rel=1e-9)


@pytest.mark.parametrize("edge", GROUND)
def test_left_and_right_have_the_same_bits(edge: EdgeShape) -> None:
    angles = np.linspace(0.0, 0.3, 20)

    def walk(sense: float) -> FloatArray:
        steps = [(0.5 * WIDTH * math.sin(a) - 1e-3 + 2e-4 * math.sin(7.0 * a), edged(sense * a)[None]) for a in angles]
        path = [(np.array([[0.0, sense * 1e-3 * a, z]]), turned) for a, (z, turned) in zip(angles, steps, strict=True)]
        return wrench(contact_of(edge, SnowField(H, S, 10.0), *path[:-1]), path[-1])

    assert walk(-1.0).tolist() == (walk(1.0) * np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])).tolist()


@pytest.mark.parametrize("edge", GROUND)
@pytest.mark.parametrize("degrees", [20.0, 50.0])
def test_a_rigid_ski_carves_as_deep_as_in_closed_form(edge: EdgeShape, degrees: float) -> None:
    """F(E) as above, solved for the depth of the corner: the edge lies E - lost deep."""
    angle, load = math.radians(degrees), 800.0
    missing = sum(0.5 * far**2 * rise * math.cos(angle) for far, rise in hinges(edge, angle))
    plane = math.sqrt(2.0 * math.tan(angle) * (load / (0.02e9 * LENGTH) + missing))
    ski = replace(rigid_ski(), **edge._asdict())
    found = carve(ski, snow(0.02), edge_angle=angle, load=load, unloading_ratio=1.0)
    assert found.edge_depth == pytest.approx(np.full(320, plane - lost(edge, angle)), rel=1e-6)


# The edge of a bent ski that is pitched against the snow: its groove lies on the curve of the edge in space


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
