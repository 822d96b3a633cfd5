"""The compiled contact against the plain implementation of the same equations."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest

from skisnow import read_ski
from skisnow._support.errors import RangeWarning
from skisnow.contact import Runner, SnowContact, SnowField
from skisnow.forces.friction import WaterFilmFriction
from skisnow.forces.shear import AngleShear, MachiningShear, ShearLaw

from .conftest import edged
from .reference_contact import Pose, ReferenceRunner

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
        assert near.beam is not None
        beam = near.beam + rng.normal(size=near.beam.shape) * [1e-4, 3e-4, 1e-3]
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
    """Of wrench and beam loads over the largest force, along a short random walk."""
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
        assert pose.beam is not None
        assert pose.rate is not None
        placed = [pose.position], [pose.rotation]
        found = contact.force(
            *placed, [pose.velocity], 1e-3 * (step > 0), beam_dofs=[pose.beam], beam_rates=[pose.rate]
        )
        wrench, loads = reference.force(pose, 1e-3 * (step > 0))
        size = max(float(np.abs(wrench).max()), 1e-3)
        out.append(float(np.abs(found.wrench[0] - wrench).max()) / size)
        out.append(float(np.abs(found.beam_loads[0] - loads).max()) / size)
        contact.update(*placed, 1e-3 * (step > 0), beam_dofs=[pose.beam])
        reference.update(pose)
        pose = a_pose(rng, pose)
    return out


@pytest.mark.parametrize("seed", range(12))
def test_forces_are_those_of_the_plain_implementation(seed: int) -> None:
    assert max(differences(seed, steps=3)) < 1e-11


@pytest.mark.slow
def test_forces_of_a_thousand_walks() -> None:
    worst = {seed: max(differences(seed, steps=3)) for seed in range(100, 1100)}
    assert {seed: value for seed, value in worst.items() if not value < 1e-11} == {}
