"""Stages of the contact against differences, and the whole against a plain implementation."""

import platform
import warnings
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from skisnow import read_ski
from skisnow._support.arrays import FloatArray
from skisnow._support.errors import RangeWarning
from skisnow.compiled import core
from skisnow.contact import ContactForces, Runner, Sections, SnowContact, SnowField
from skisnow.forces.friction import WaterFilmFriction
from skisnow.forces.shear import AngleShear, MachiningShear, ShearLaw
from tests.present import present

from .conftest import edged, straight
from .reference_contact import Pose, ReferenceRunner

H, S = 2e8, 5e5
DT = 5e-4
DEPTH = 2e-3
"""Of the edge (m)."""


def in_snow(set_of_instructions: str | None, *, angle: float, sunk: float) -> tuple[SnowContact, FloatArray]:
    """A ski that has gone 3 cm ahead, lies a little deeper, and is displaced across by a tenth of u_y; its pose."""
    contact = SnowContact(SnowField(H, S, 10.0), [straight()], instruction_set=set_of_instructions)
    rotation, height = edged(angle), 0.03 * abs(np.sin(angle)) - DEPTH
    for step in range(7):
        contact.update([[0.005 * step, 0.0, height]], rotation[None], DT)
    place = np.array([0.03, 2e-6, height - sunk])
    return contact, np.concatenate([place, rotation.ravel()])


@pytest.mark.parametrize("angle", [0.5, -0.5, 1.0, 0.2])
@pytest.mark.parametrize("sunk", [2e-5, -3e-6])
def test_tangent_against_differences(angle: float, sunk: float) -> None:
    """Closed form and the public central differences, brought to the ski's moving axes.

    -d(Rᵀ f) = -Rᵀ df + φ × Rᵀ f. The tangent takes one step of h = 1e-8 m, so its error is below h over the depth. It
    leaves out the force along the ski by rotations, and a way ahead, which takes tip and tail over the lines. A
    rotation moves the edge, at r = half the width, ahead by r: tip and tail then exchange r of the load per length.
    """
    contact, pose = in_snow(None, angle=angle, sunk=sunk)
    at = pose[None, :3], pose[3:].reshape(1, 3, 3), np.zeros((1, 6)), 0.0
    tangent, wrench = core.runner_tangent(contact.compiled, *at, 1.0, 0.0)
    stiffness, _ = contact.tangent(*at)
    axes = np.kron(np.eye(2), at[1][0])
    expected = axes.T @ stiffness[0] @ axes
    for c in range(3):
        expected[:3, 3 + c] += np.cross(np.eye(3)[c], wrench[:3])
        expected[3:, 3 + c] += np.cross(np.eye(3)[c], wrench[3:])
    size = np.sqrt(np.abs(np.diag(expected)) + 1.0)
    assert np.linalg.norm(wrench[:3]) > 100.0
    (runner,) = contact.runners
    length, load = float(np.ptp(runner.position)), float(np.linalg.norm(wrench[:3]))
    ends = load / length * runner.half_width[0] * np.outer([1.0] * 3 + [length] * 3, [0.0] * 3 + [1.0] * 3)
    bound = 1e-8 / DEPTH * np.outer(size, size) + ends
    assert (np.abs(tangent - expected)[1:, 1:] <= bound[1:, 1:]).all()


@pytest.mark.parametrize("width", core.instruction_sets())
def test_tangent_has_the_same_bits_in_all_lane_widths(width: str) -> None:
    found = []
    for chosen in (core.instruction_sets()[0], width):
        contact, pose = in_snow(chosen, angle=0.5, sunk=2e-5)
        args = pose[None, :3], pose[3:].reshape(1, 3, 3), np.array([[8.0, 0.1, 0.0, 0.0, 0.2, 0.0]])
        found.append(core.runner_tangent(contact.compiled, *args, DT, 1.0, 0.3))
    assert np.array_equal(found[0][0], found[1][0])
    assert np.array_equal(found[0][1], found[1][1])


def depths(knots: FloatArray, at: FloatArray) -> FloatArray:
    """Depth of a ground between its knots, zero beyond."""
    return np.interp(at, knots[:, 0], knots[:, 1], left=0.0, right=0.0) if len(knots) else 0.0 * at


def random_polyline(random: np.random.Generator, knots: int) -> FloatArray:
    place = np.sort(random.uniform(-0.03, 0.03, knots))
    return np.column_stack([place, random.uniform(1e-3, 5e-3, knots)])


@pytest.mark.parametrize("seed", range(3))
def test_the_deeper_of_both_is_kept(seed: int) -> None:
    """Of 67 pairs each, at places between all knots; the mirror image has the same depths."""
    random = np.random.default_rng(seed)
    for _ in range(67):
        ground, pressed = random_polyline(random, int(random.integers(2, 9))), random_polyline(random, 3)
        if seed == 0:
            pressed[:, 1] += 5e-3  # deeper everywhere
        if seed == 1:
            pressed[:, 1] *= 0.1  # mostly less deep
        require_deeper_ground(ground, pressed)


def require_deeper_ground(ground: FloatArray, pressed: FloatArray) -> None:
    found, changed = core.pressed_ground(ground, pressed)
    at = np.linspace(-0.031, 0.031, 4001)
    at = at[np.abs(at[:, None] - np.append(ground[:, 0], pressed[:, 0])).min(axis=1) > 1e-6]
    expected = np.maximum(depths(ground, at), depths(pressed, at))
    assert np.abs(depths(found, at) - expected).max() < 1e-12  # approx takes a third of a second for so many
    assert changed == bool((depths(pressed, at) > depths(ground, at) + 1e-12).any())
    mirror = np.array([-1.0, 1.0])
    other, _ = core.pressed_ground((ground * mirror)[::-1].copy(), (pressed * mirror)[::-1].copy())
    assert np.array_equal(other, (found * mirror)[::-1])


def test_ground_of_nothing() -> None:
    """Virgin snow takes what is pressed; two grooves that lie apart have no depth between them."""
    none, wedge = np.empty((0, 2)), np.array([[0.0, 1e-3], [0.01, 3e-3]])
    found, changed = core.pressed_ground(none, wedge)
    assert changed
    assert np.array_equal(found, wedge)
    both, _ = core.pressed_ground(wedge, wedge + np.array([0.02, 0.0]))
    assert depths(both, np.array([0.005, 0.015, 0.025])) == pytest.approx([2e-3, 0.0, 2e-3])
    again, changed = core.pressed_ground(wedge, wedge)
    assert not changed
    assert np.array_equal(again, wedge)


# The compiled contact against the plain implementation of the same equations


SPACING = 0.05
SKI = read_ski("giant-slalom")
NODES = np.linspace(SKI.station[0], SKI.station[-1], 9)
FILM = WaterFilmFriction(lubricated_friction=0.01, dry_friction=0.05, film_speed=3.0, viscous_slope=0.001)


def a_pose(rng: np.random.Generator, near: Pose | None = None) -> Pose:
    """Anywhere from flat to steep on either edge, a few millimetres deep; or a small step on from a pose."""
    if near is None:
        angle = float(rng.uniform(-1.3, 1.3))
        rotation = edged(angle, lean=float(rng.normal(0.0, 2e-3)), turn=float(rng.uniform(-3.0, 3.0)))
        depth = float(rng.uniform(0.0, 6e-3))
        position = np.array([*rng.normal(size=2), 0.034 * abs(np.sin(angle)) - depth])
        beam = rng.normal(size=(len(NODES), 3)) * [1e-3, 3e-3, 1e-2]
    else:
        rotation = near.rotation @ edged(*(float(rng.normal(0.0, 3e-3)) for _ in range(3)))
        position = near.position + near.rotation @ (rng.normal(size=3) * [4e-3, 3e-4, 3e-4])
        beam = present(near.beam) + rng.normal(size=present(near.beam).shape) * [1e-4, 3e-4, 1e-3]
    return Pose(position, rotation, rng.normal(size=6) * [8, 1, 0.3, 1, 1, 1], beam, rng.normal(size=beam.shape) * 0.1)


def _laws(seed: int, strength: float) -> dict[str, Any]:
    """In turn every shear law of the core, both strengths over slip, both loads and directions of friction."""
    with warnings.catch_warnings():  # of strengths that were never measured
        warnings.simplefilter("ignore", RangeWarning)
        cut = MachiningShear(strength / 2.0, 0.2, least_shear_plane=0.1)
        shear: tuple[ShearLaw | None, ...] = (None, AngleShear(strength, 0.266), cut)
    acts_on = "snow-normal" if seed % 4 == 3 else "base-normal"
    direction = "along-ski" if seed % 5 == 4 else "vector"
    weakens = {"residual_ratio": 0.3, "slip_weakening": 0.4e-3} if seed % 2 else {}
    # over half a millimetre a walk of small steps both holds and slips
    rubs = {"friction_acts_on": acts_on, "friction_direction": direction}
    return {"shear": shear[seed % 3], "shear_displacement": 0.5e-3, **rubs, **weakens}


def differences(seed: int, *, steps: int) -> list[float]:
    """Of wrench and beam loads over what is allowed, along a short random walk.

    Allowed are 10⁻¹¹ of the largest force, and what 1 pm of depth bears on a base of 1.9 m by 0.07 m: the core takes
    places nearer than that for one.
    """
    rng = np.random.default_rng(seed)
    hardness, strength = (float(10.0 ** rng.uniform(*ends)) for ends in ((7.3, 11.0), (4.5, 6.5)))
    ratio = float(rng.uniform(1.0, 50.0))
    snow = SnowField(
        hardness, strength, ratio, FILM, knot_area=0.0, part_along=1.0, part_across=1.0, **_laws(seed, strength)
    )
    runner = Runner.of(SKI, nodes=NODES)
    contact = SnowContact(snow, [runner], spacing=SPACING)
    pose = a_pose(rng)
    reference = ReferenceRunner(runner, snow, pose, SPACING)
    out = []
    for step in range(steps):
        placed = [pose.position], [pose.rotation]
        found = contact.force(
            *placed, [pose.velocity], 1e-3 * (step > 0), beam_dofs=[present(pose.beam)], beam_rates=[present(pose.rate)]
        )
        wrench, loads = reference.force(pose, 1e-3 * (step > 0))
        allowed = 1e-11 * max(float(np.abs(wrench).max()), 1e-3) + 1e-12 * ratio * hardness * 1.9 * 0.07
        out.append(float(np.abs(found.wrench[0] - wrench).max()) / allowed)
        out.append(float(np.abs(found.beam_loads[0] - loads).max()) / allowed)
        contact.update(*placed, 1e-3 * (step > 0), beam_dofs=[present(pose.beam)])
        reference.update(pose)
        pose = a_pose(rng, pose)
    return out


@pytest.mark.parametrize("seed", [0, 1, 2, 3, 4, 11])
def test_forces_are_those_of_the_plain_implementation(seed: int) -> None:
    assert max(differences(seed, steps=2)) < 1.0


@pytest.mark.slow
def test_forces_of_a_thousand_walks() -> None:
    worst = {seed: max(differences(seed, steps=3)) for seed in range(100, 1100)}
    assert {seed: value for seed, value in worst.items() if not value < 1.0} == {}


# What a contact says of itself; the widest instruction set of this processor is used, whatever compiler built it


CPUINFO = Path("/proc/cpuinfo")


@pytest.mark.skipif(
    platform.machine() != "x86_64" or not CPUINFO.exists(),
    reason="the processor's flags are read where Linux lists them",
)
def test_every_instruction_set_of_this_processor_is_found() -> None:
    flags = next(line for line in CPUINFO.read_text().splitlines() if line.startswith("flags")).split()
    expected = ["baseline"]
    expected += ["avx2"] if "avx2" in flags else []
    expected += ["avx512"] if {"avx512f", "avx512dq", "avx512vl"} <= set(flags) else []
    assert core.instruction_sets() == expected


def test_a_contact_tells_which_it_uses() -> None:
    """The one that is asked for; the last, widest one where none is."""
    found = core.instruction_sets()
    for asked in (None, *found):
        contact = SnowContact(SnowField(2e8, 5e5, 10.0), [straight()], instruction_set=asked)
        assert contact.instruction_set == (asked or found[-1])


def test_forces_and_moments_of_each_runner() -> None:
    assert repr(ContactForces(np.arange(1.0, 13.0).reshape(2, 6), ())).splitlines() == [
        "<ContactForces on 2 runners",
        "  runner 0  force (1, 2, 3) N, moment (4, 5, 6) N m",
        "  runner 1  force (7, 8, 9) N, moment (10, 11, 12) N m>",
    ]


def test_units_of_sections() -> None:
    """In the order of the fields, as their docstring has them; a sine, μ and a share have none."""
    units = (*"mmm", "", *"mmmm", *"NNNNNNN", "m/s", "m/s", "", "", "", "N", "N/m²", "", "")
    found = Sections(**{each.name: np.array([0.5, 2.0]) for each in fields(Sections)})._repr_facts()
    assert [words for _, words in found.rows] == [f"2: 0.5 to 2 {unit}".rstrip() for unit in units]
