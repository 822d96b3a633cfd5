"""python -m benchmarks.constants.line_phase: how much the place of the lines below a ski changes the sums over them.

The motion of a run with fine lines and short steps is repeated with other spacings. Shear and its moment about the boot
differ from those with the closest lines: the standard deviation over the time is the error by the place of the lines.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final
from unittest.mock import patch

import numpy as np
import numpy.typing as npt

from skisnow.contact import SnowContact
from skisnow.dynamics import Dynamics
from skisnow.scenario import Scenario, load_scenario
from skisnow.simulation import run_setup
from skisnow.simulation.run_setup import laid_out, set_up

from .varying import CASES

STEP: Final = 2.5e-4
"""Steps (s) of the motion."""
LEAD: Final = 0.26
"""Time (s) before the measurement, in which the skis pass their length: the first lines lie below them untouched."""
SPACINGS: Final = (0.02, 0.01, 0.005, 0.0025)
"""Spacings of lines (m)."""
CLOSEST: Final = 0.00125
"""Spacing (m) that the others are compared with."""
FINE: Final = {
    "solver.fixed": True,
    "solver.step_ms": 1e3 * STEP,
    "solver.line_spacing_mm": 5.0,
    "solver.groove_tolerance": 1e-6,
}
PART_ALONG: Final = 2.5e-3
"""Way (m) over which the history advances at once."""


@dataclass(frozen=True, slots=True)
class Moment:
    """Places (skis, 3), rotations (skis, 3, 3) and velocities (skis, 6) of the boots, and each bent ski (nodes, 3)."""

    position: npt.NDArray[np.float64]
    rotation: npt.NDArray[np.float64]
    velocity: npt.NDArray[np.float64]
    beams: list[npt.NDArray[np.float64]]

    @classmethod
    def of(cls, dynamics: Dynamics) -> Moment:
        """The present moment of a body."""
        axes, speed, skis = dynamics.rotation, dynamics.velocity, dynamics.body.skis
        turning = axes @ speed[3:]
        arms = [axes @ ski.boot for ski in skis]
        velocity = [np.concatenate([axes @ speed[:3] + np.cross(turning, arm), turning]) for arm in arms]
        beams = [np.zeros((len(ski.unknown), 3)) for ski in skis]
        for ski, beam, bend in zip(skis, beams, dynamics.part("beam_dofs"), strict=True):
            free = ski.unknown >= 0
            beam[free] = bend[ski.unknown[free, None].astype(int) + np.arange(3)]
        rotation = np.array([axes @ ski.axes.T for ski in skis])
        return cls(dynamics.position + np.array(arms), rotation, np.array(velocity), beams)


def scenario_of(case: str, changes: Mapping[str, object]) -> Scenario:
    """A case with fixed short steps, fine lines and grooves, and more changes."""
    name, own = CASES[case]
    return load_scenario(name, changes={**own, **FINE, **changes})


def record(scenario: Scenario, begin: float) -> list[Moment]:
    """Motion of a run for `LEAD` and 0.05 s from a time (s) on."""
    dynamics, motion = set_up(scenario).dynamics, list[Moment]()
    for n in range(round((LEAD + 0.05) / STEP) + 1):
        dynamics.advance(begin + n * STEP)
        motion.append(Moment.of(dynamics))
    return motion


def sums(scenario: Scenario, motion: Sequence[Moment], spacing: float) -> npt.NDArray[np.float64]:
    """Shear (N) and its moment about the boot (N m) of both skis after `LEAD`, in fresh snow, (moments, 4)."""
    fresh = laid_out(scenario)
    contact, rows = SnowContact(fresh.snow, fresh.dynamics.contact.runners, spacing=spacing), []
    for n, at in enumerate(motion):
        dt = STEP if n else 0.0
        if n * STEP > LEAD:
            contact.force(at.position, at.rotation, at.velocity, dt, beam_dofs=at.beams)
            skis = [contact.sections(k) for k in range(2)]
            rows.append([sum_ for each in skis for sum_ in (each.shear.sum(), each.shear @ each.position_along_ski)])
        contact.update(at.position, at.rotation, dt, beam_dofs=at.beams)
    return np.array(rows)


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.constants.line_phase")
    parser.add_argument("--case", choices=CASES, default="skid")
    parser.add_argument("--begin", type=float, default=1.2, help="time of the run at which the motion begins (s)")
    parser.add_argument("--displacement", type=float, help="u_y (mm) of the snow, in the same motion")
    options = parser.parse_args()
    motion = record(scenario_of(options.case, {}), options.begin)
    changes = {} if options.displacement is None else {"snow.shear_displacement_mm": options.displacement}
    scenario = scenario_of(options.case, changes)
    closest = sums(scenario, motion, CLOSEST)
    print("| lines (mm) | shear, left (N) | its moment (N m) | shear, right (N) | its moment (N m) |")
    for spacing in SPACINGS:
        errors = sums(scenario, motion, spacing) - closest
        print(f"| {1e3 * spacing:g} | {' | '.join(f'{each:.2f}' for each in errors.std(axis=0))} |", flush=True)


if __name__ == "__main__":
    with patch.object(run_setup, "PART_ALONG", PART_ALONG):
        main()
