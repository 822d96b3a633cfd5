"""A nearly level base holds with both edges: shear of a roll and of a slide, limits of the force, mirror image."""

import math

import numpy as np
import pytest

from skisnow._support.arrays import FloatArray
from skisnow.contact import Runner, SnowContact, SnowField
from skisnow.forces.shear.law import SHEAR_DISPLACEMENT

from .conftest import edged, straight

Placed = tuple[FloatArray, FloatArray]
H, S, LENGTH, WIDTH, LOAD = 2e8, 5e5, 1.4, 0.07, 400.0
HALF = 0.5 * WIDTH
MIRROR = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
"""Of a wrench in the mirror at y = 0."""


def depths(angle: float, hardness: float = H) -> tuple[float, float]:
    """Of the deeper edge and the other one under LOAD (m): force H_V L w cos ϑ m, or H_V L e²/(2 tan ϑ) of a wedge."""
    steep = abs(angle)
    if math.sin(2.0 * steep) <= 4.0 * LOAD / (hardness * LENGTH * WIDTH**2):
        middle = LOAD / (hardness * LENGTH * WIDTH * math.cos(steep))
        return middle + HALF * math.sin(steep), middle - HALF * math.sin(steep)
    edge = math.sqrt(2.0 * LOAD * math.tan(steep) / (hardness * LENGTH))
    return edge, edge - WIDTH * math.sin(steep)


def lies(angle: float, *, y: float = 0.0, hardness: float = H, z: float = 0.0) -> Placed:
    """The runner with LOAD on it at an edge angle, its middle at y (m) across, raised by z."""
    height = HALF * math.sin(abs(angle)) - depths(angle, hardness)[0]
    return np.array([[0.0, y, height + z]]), edged(angle)[None]


def contact_after(*path: Placed, hardness: float = H, ratio: float = 10.0) -> SnowContact:
    contact = SnowContact(SnowField(hardness, S, ratio), [straight(length=LENGTH, width=WIDTH)])
    for pose in path:
        contact.update(*pose, 5e-4)
    return contact


def wrench(contact: SnowContact, pose: Placed) -> FloatArray:
    return contact.force(*pose, np.zeros((1, 6)), 5e-4).wrench[0]


@pytest.mark.parametrize("degrees", [0.05, 0.2, 0.5, 0.8, 1.0, 1.5])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_roll_shears_what_the_geometry_gives(degrees: float, sense: float) -> None:
    """The base rolls about its middle from level: its edge comes inwards by W/2 (1 - cos ϑ), and holds S_f e L by that.

    At 1° that is 5.3 µm of 20 µm: 0.267. On elastic snow, so that no groove of the start counts.
    """
    steps = [lies(sense * math.radians(degrees) * n / 400) for n in range(401)]
    contact = contact_after(*steps, ratio=1.0)
    found = wrench(contact, steps[-1])[1]
    share = HALF * (1.0 - math.cos(math.radians(degrees))) / SHEAR_DISPLACEMENT
    assert share == pytest.approx(0.2665, abs=1e-4) or degrees != 1.0
    held = S * depths(math.radians(degrees))[0] * LENGTH
    assert found / held == pytest.approx(sense * share, rel=0.01, abs=1e-4)


@pytest.mark.parametrize("hardness", [2e8, 1e7])
@pytest.mark.parametrize("degrees", [0.0, 0.01, 0.02, 0.1, 0.5, 1.0, 2.0, 5.0])
def test_force_and_moment_of_the_pressure(degrees: float, hardness: float) -> None:
    """Of both cases, 400 N with its centre at w² sin ϑ/(12 m) from the middle, or W - e/(3 sin ϑ) with one edge."""
    angle = math.radians(degrees)
    deeper, other = depths(angle, hardness)
    if other > 0.0:
        centre = WIDTH**2 * math.sin(angle) / (6.0 * (deeper + other))
    else:
        centre = HALF - deeper / (3.0 * math.sin(angle))
    for sense in (1.0, -1.0):
        pose = lies(sense * angle, hardness=hardness)
        found = wrench(contact_after(hardness=hardness), pose)
        # the base's point at the centre lies lower by its share of the tilt
        moment = sense * LOAD * centre * math.cos(angle)
        assert found == pytest.approx([0.0, 0.0, LOAD, moment, 0.0, 0.0], abs=1e-9)


@pytest.mark.parametrize("degrees", [0.0, 0.01, 0.03, 0.3, 1.0])
@pytest.mark.parametrize("hardness", [2e8, 1e7])
def test_together_both_edges_hold_the_deeper_one(degrees: float, hardness: float) -> None:
    """Pushed across by more than u_y to either side: S_f e L of the deeper edge, divided between both."""
    angle = math.radians(degrees)
    deeper, other = (max(each, 0.0) for each in depths(angle, hardness))
    for way in (1.0, -1.0):
        contact = contact_after(lies(angle, hardness=hardness), hardness=hardness)
        pose = lies(angle, hardness=hardness, y=way * 1.01 * SHEAR_DISPLACEMENT)
        assert wrench(contact, pose)[1] == pytest.approx(-way * S * deeper * LENGTH, rel=1e-9)
        found = contact.sections(0)
        # outwards an edge's wall holds, inwards the slope of the base down to it
        on_left, on_right = (deeper, 0.0) if way > 0.0 else (deeper - other, other)
        assert float(found.left_shear.sum()) == pytest.approx(-way * S * LENGTH * on_left, rel=1e-9, abs=1e-9)
        assert float(found.right_shear.sum()) == pytest.approx(-way * S * LENGTH * on_right, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("hardness", [2e8, 1e7])
def test_forces_are_continuous_in_the_edge_angle(hardness: float) -> None:
    """Through level, and through the angles at which the other edge leaves the snow and touches it again.

    Steps ten times finer move the wrench by a tenth at most; a jump would stay.
    """
    one_edge = 0.5 * math.asin(4.0 * LOAD / (hardness * LENGTH * WIDTH**2))
    skewed = np.array([[0.0, 0.6 * SHEAR_DISPLACEMENT, 0.0]])

    def largest(around: float, spacing: float) -> float:
        contact = contact_after(lies(0.4 * one_edge, hardness=hardness), hardness=hardness)
        poses = [lies(around + n * spacing, hardness=hardness) for n in range(-20, 21)]
        turn = edged(0.0, turn=0.02)
        found = [wrench(contact, (place + skewed, turn @ rotation)) for place, rotation in poses]
        return float(np.abs(np.diff(found, axis=0)).max())

    for around in (0.0, one_edge, -one_edge):
        coarse, fine = (largest(around, one_edge * 10.0**-each) for each in (3, 4))
        assert 0.0 < fine < 0.15 * coarse


@pytest.mark.parametrize("degrees", [0.0, 0.02, 0.3, 1.0, 20.0])
def test_mirrored_motions_have_the_same_bits(degrees: float) -> None:
    """A ski with a sidecut and a shovel that rolls, turns, slides across and heaves."""
    stations = np.linspace(0.85, -0.8, 34)
    shovel = np.maximum(stations - 0.65, 0.0) ** 2
    ski = Runner(stations, HALF + 0.025 * stations**2, shovel)
    found = []
    for sense in (1.0, -1.0):
        contact = SnowContact(SnowField(H, S, 10.0, 0.03), [ski])
        rows = []
        for n in range(60):
            roll, turn = math.radians(degrees) + 2e-4 * math.sin(0.5 * n), 0.01 * math.sin(0.1 * n)
            place = np.array([[0.005 * n, sense * 2e-5 * n * math.sin(0.3 * n), -2e-5 * (2.0 + math.sin(0.7 * n))]])
            place[0, 2] += HALF * math.sin(roll)
            pose = place, edged(sense * roll, lean=1e-4 * math.sin(0.4 * n), turn=sense * turn)[None]
            moving = np.array([[10.0, sense * 0.1, 0.0, 0.0, 0.0, sense * 0.2]])
            rows.append(contact.force(*pose, moving, 5e-4).wrench[0])
            contact.update(*pose, 5e-4)
        found.append(np.array(rows))
    size = np.abs(found[0]).max()
    assert found[1] * MIRROR == pytest.approx(found[0], abs=1e-10 * size)


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_loaded_height_holds_inwards_alone(sense: float) -> None:
    """A wedge that rises by d bears (1 - κ d/e)² of its force: it then holds by that root inwards, by all outwards.

    e is the depth that it was pressed to; virgin snow at the depth e - d bears ((e - d)/e)².
    """
    angle, deep, risen, ratio = math.radians(30.0), 2e-3, 5e-5, 10.0
    snow = SnowField(H, S, ratio, shear_bearing="loaded-height")

    def placed(depth: float, y: float) -> Placed:
        return np.array([[0.0, y, HALF * math.sin(angle) - depth]]), edged(sense * angle)[None]

    contact = SnowContact(snow, [straight(length=LENGTH, width=WIDTH)])
    contact.update(*placed(deep, 0.0), 5e-4)
    contact.update(*placed(deep - risen, 0.0), 5e-4)
    tiny = 1e-3 * SHEAR_DISPLACEMENT  # the ground hardly moves under the base
    share = (1.0 - ratio * risen / deep) / (1.0 - risen / deep)
    for way, held in ((-sense, share), (sense, 1.0)):
        found = wrench(contact, placed(deep - risen, way * tiny))[1]
        assert found == pytest.approx(-way * 1e-3 * S * (deep - risen) * LENGTH * held, rel=1e-3)
