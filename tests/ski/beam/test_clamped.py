"""A ski clamped at the boot against plain beams, and the frequencies of the catalogue's skis."""

import math

import numpy as np
import pytest
from tests.coded import raises

from skisnow._support.arrays import FloatArray
from skisnow._support.errors import ParameterError
from skisnow.ski import Ski, read_ski
from skisnow.ski.beam import clamped

from .conftest import Chain, banded_solution, frequencies, observed_order
from .dense import beam_at, dense

EI, GJ = 240.0, 110.0
BENDING_HZ, TORSION_HZ = (20.0, 48.0, 92.0), (96.0, 126.0)


def plain_ski(front: float = 0.9, rear: float = -0.7, width: float = 0.07) -> Ski:
    station = np.linspace(front, rear, 801)
    same = np.ones_like(station)
    return Ski(
        name="plain", source="test", station=station, width=width * same, base_height=0.0 * same,
        bending_stiffness=EI * same, torsional_stiffness=GJ * same, mass_per_length=1.4 * same,
        running_length=front - rear, sidecut_length=front - rear, sidecut_middle=(front + rear) / 2.0,
    )  # fmt: skip


@pytest.mark.parametrize(("clamp", "front", "rear"), [(0.0, 0.9, -0.7), (0.3, 0.9, -0.7), (0.25, 0.5, -1.1)])
def test_both_ends_are_clamped_beams(clamp: float, front: float, rear: float) -> None:
    """F a³/(3 EI) and M a/GJ with a from the end of the clamp to tip and tail, each end for itself."""
    model = clamped(plain_ski(front, rear), clamp, 80)
    ahead, behind = front - clamp / 2.0, -rear - clamp / 2.0
    load = np.zeros(model.size)
    load[model.dof[0, 0]], load[model.dof[0, 2]] = 30.0, 5.0
    load[model.dof[-1, 3]], load[model.dof[-1, 5]] = 20.0, -4.0
    deflection, twist = beam_at(model, banded_solution(model.stiffness, load), [front, rear])
    assert deflection == pytest.approx(
        [30.0 * ahead**3 / (3.0 * EI), 20.0 * behind**3 / (3.0 * EI)], rel=1e-9
    )  # rounding
    assert twist == pytest.approx([5.0 * ahead / GJ, -4.0 * behind / GJ], rel=1e-9)


@pytest.mark.parametrize("elements", [24, 36, 60])
def test_elements_near_the_ends_of_the_sidecut_are_three_times_as_short(elements: int) -> None:
    """1.8 m of ski with a sidecut of 1.667 m: within 0.267 m of either end of it, not under the clamp."""
    node = clamped(read_ski("giant-slalom"), 0.3, elements, finer_ends=True).node
    middle, length = np.abs(node[:-1] + node[1:]) / 2.0, node[:-1] - node[1:]
    finer = np.where(middle > 0.8335 - 0.16 * 1.667, 3.0, 1.0)
    inside = middle < 0.8335
    assert (finer * length)[inside] == pytest.approx(1.8 / elements, rel=0.08)  # whole numbers of them
    for place in (0.8335, 0.15, -0.15, -0.8335):
        assert np.min(np.abs(node - place)) < 1e-12


def test_nothing_moves_under_the_clamp() -> None:
    model = clamped(plain_ski(), 0.3, 80)
    u = np.random.default_rng(1).normal(size=model.size)
    deflection, twist = beam_at(model, u, np.linspace(0.15, -0.15, 31))
    assert np.all(deflection == 0.0)
    assert np.all(twist == 0.0)
    assert beam_at(model, u, 0.16)[0][0] != 0.0
    assert beam_at(model, u, -0.16)[0][0] != 0.0


def test_smooth_load_at_the_stations() -> None:
    """EI w⁗ = q sin kx, k = π/l, before the boot; w = w′ = 0 at the clamp, w″ = w‴ = 0 at the tip.

    w = (q/EI) (sin(kx)/k⁴ - x/k³ + l x²/(2k) - x³/(6k)). Order 4 of the two Gauss points at which the snow is felt.
    """
    length, q = 0.9, 500.0
    x = np.array([0.3, 0.55, 0.9])
    k = math.pi / length
    exact = q / EI * (np.sin(k * x) / k**4 - x / k**3 + length * x**2 / (2.0 * k) - x**3 / (6.0 * k))
    error = []
    for elements in (16, 32, 64):
        model = clamped(plain_ski(), 0.0, elements)
        at = model.stations
        load = np.zeros(model.size)
        pressure = np.where(at.station > 0.0, q * np.sin(k * at.station), 0.0) * at.weight
        for a in range(6):
            held = at.dof[:, a] < 0
            np.add.at(load, at.dof[~held, a], (pressure * at.deflection[:, a])[~held])
        error.append(float(np.max(np.abs(beam_at(model, banded_solution(model.stiffness, load), x)[0] / exact - 1.0))))
    assert np.all(observed_order(error) > 3.7)
    assert error[-1] < 1e-6


def test_stations_measure_the_ski_and_mass_and_inertia_of_the_free_parts() -> None:
    """Their weights add up to the length and to its moments, falling from tip to tail; the slope is along the ski."""
    model = clamped(plain_ski(), 0.3, 160)
    at = model.stations
    assert at.weight.sum() == pytest.approx(1.6, rel=1e-12)
    assert at.weight @ at.station == pytest.approx((0.9**2 - 0.7**2) / 2.0, rel=1e-12)
    assert at.weight @ at.station**2 == pytest.approx((0.9**3 + 0.7**3) / 3.0, rel=1e-12)
    assert np.all(np.diff(at.station) < 0.0)
    u = np.random.default_rng(2).normal(size=model.size) * 1e-3
    step = 1e-6
    value = np.where(at.dof >= 0, u[at.dof], 0.0)
    ahead, behind = (beam_at(model, u, at.station + side * step)[0] for side in (1.0, -1.0))
    assert np.sum(at.deflection * value, axis=1) == pytest.approx(beam_at(model, u, at.station)[0], abs=1e-14)
    assert np.sum(at.slope * value, axis=1) == pytest.approx((ahead - behind) / (2.0 * step), abs=1e-7)
    # Both free parts lifted by x - clamp: m' ∫ (x - a)² dx of each. Twisted so: m' W²/12 of it, as thin strips.
    model = clamped(plain_ski(width=0.08), 0.3, 80)
    lifted, twisted = np.zeros((2, model.size))
    number = np.vstack([model.dof[:, :3], model.dof[-1:, 3:]])
    free = number[:, 0] >= 0
    lifted[number[free, 0]] = twisted[number[free, 2]] = np.abs(model.node[free]) - 0.15
    lifted[number[free, 1]] = -np.sign(model.node[free])  # per length of the element's own direction, tip to tail
    parts, mass = 1.4 * (0.75**3 + 0.55**3) / 3.0, dense(model.mass)
    # the clamped node itself cannot turn: the element beside it bends, so only its neighbours count in full
    assert lifted @ mass @ lifted == pytest.approx(parts, rel=1e-4)
    assert twisted @ mass @ twisted == pytest.approx(0.08**2 / 12.0 * parts, rel=1e-10)


def free_frequencies(ski: Ski, elements: int) -> tuple[FloatArray, FloatArray]:
    """First bending and torsion frequencies of the ski in the air (Hz)."""
    beam = Chain(np.linspace(float(ski.station[-1]), float(ski.station[0]), elements + 1), held=False)
    at = ski.at(beam.gauss)
    stiffness = beam.stiffness(at.bending_stiffness, at.torsional_stiffness)
    mass = beam.mass(at.mass_per_length, at.mass_per_length * at.width**2 / 12.0)
    bending, torsion = (frequencies(stiffness, mass, which) / (2.0 * math.pi) for which in ((0, 1), (2,)))
    return bending[2:5], torsion[1:2]


@pytest.mark.parametrize("name", ["slalom", "giant-slalom", "carver"])
def test_frequencies_of_the_catalogue(name: str) -> None:
    """Alpine skis: bending near 20, 48 and 92 Hz, torsion between 96 and 126 Hz, ± 15 %."""
    bending, torsion = free_frequencies(read_ski(name), 160)
    assert bending == pytest.approx(np.array(BENDING_HZ), rel=0.15)
    assert TORSION_HZ[0] * 0.85 < torsion[0] < TORSION_HZ[1] * 1.15


def test_frequencies_do_not_depend_on_the_mesh() -> None:
    coarse, fine = (np.concatenate(free_frequencies(read_ski("slalom"), elements)) for elements in (80, 320))
    assert coarse == pytest.approx(fine, rel=1e-3)


@pytest.mark.parametrize(("clamp", "elements"), [(-0.1, 80), (1.5, 80), (0.3, 3)])
def test_what_cannot_be_clamped(clamp: float, elements: int) -> None:
    with pytest.raises(ParameterError):
        clamped(plain_ski(), clamp, elements)


def test_a_footprint_is_a_bed_of_springs() -> None:
    """Its part of the stiffness does k w² + k W²/12 φ² for each metre: with w = s² and φ = s from -a to a."""
    ski, half, stiffness, width = plain_ski(), 0.15, 2e6, 0.07
    once, twice = (dense(clamped(ski, 2.0 * half, 160, each).stiffness) for each in (stiffness, 2.0 * stiffness))
    model = clamped(ski, 2.0 * half, 160, stiffness)
    first = np.append(model.dof[:, 0], model.dof[-1, 3])
    u, free = np.zeros(model.size), first >= 0
    u[first[free]], u[first[free] + 1], u[first[free] + 2] = (
        model.node[free] ** 2,
        -2.0 * model.node[free],
        model.node[free],
    )
    done = stiffness * (2.0 * half**5 / 5.0 + width**2 / 12.0 * 2.0 * half**3 / 3.0)
    assert u @ (twice - once) @ u == pytest.approx(done, rel=1e-9)


def test_a_footprint_is_between_a_rigid_clamp_and_one_section() -> None:
    """A load at the tip bends a ski on a stiff footprint as a clamped one, on a soft one as held at a section."""
    ski = read_ski("slalom")

    def tip(clamp: float, stiffness: float | None) -> float:
        model = clamped(ski, clamp, 160, stiffness)
        load = np.zeros(model.size)
        load[model.dof[0, 0]] = 10.0
        return float(np.linalg.solve(dense(model.stiffness), load)[model.dof[0, 0]])

    rigid, section = tip(0.3, None), tip(0.0, None)
    deflections = [tip(0.3, stiffness) for stiffness in (1e13, 1e8, 1e6, 1.0)]
    assert sorted(deflections) == deflections
    assert deflections[0] == pytest.approx(rigid, rel=1e-2)
    assert deflections[-1] == pytest.approx(section, rel=1e-3)
    assert section > 1.2 * rigid


def test_a_footprint_without_stiffness_is_rejected() -> None:
    with raises(ParameterError, "out_of_range", name="footprint_stiffness", value=0.0):
        clamped(plain_ski(), 0.3, 40, 0.0)
