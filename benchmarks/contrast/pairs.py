"""A pair of runs: the same turn on elastic and on hypoplastic snow, and how far apart the tracks come."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from skisnow._support.errors import SkisnowError
from skisnow._support.user_files.json_text import json_number
from skisnow.comparison.nearest_place import distance_from_path
from skisnow.parameters import Quantity
from skisnow.report.turn.chain import afterbody_depth_ratio, median_radius, used_grip
from skisnow.scenario import Scenario, load_scenario
from skisnow.simulation.run import Run
from skisnow.simulation.run_setup import laid_out
from skisnow.simulation.simulated_run import simulate
from skisnow.ski import Ski
from skisnow.studies.subjects import StudyModel

from .unknowns import UNKNOWNS

FloatArray = npt.NDArray[np.float64]
Point = dict[str, Any]

SCENARIOS: Final = ("carver-42m", "giant-slalom-67m")
LONGEST: Final = 20.0
"""Time (s) after which a run that has not covered its length is no such run."""
PARTED: Final = 0.01
"""Share of the run's length from which on tracks count as parted."""
LATE: Final = 2.0 / 3.0
"""Share of the time after which a run is in its last part."""
SPARSER: Final = 2.0
"""Times the usual spacing of the snow's lines, which halves the time of a skid."""
OUTPUT: Final = 0.04
"""Time (s) between the rows that are kept: half a metre at most."""
CONTACTS: Final = ("elastic", "plastic")
OF_A_RUN: Final = (
    "complete", "time_s", "end_x_m", "end_y_m", "turned_deg", "radius_m", "depth_mm", "grip", "grip_before", "slips",
    "slips_late", "afterbody_ratio", "energy_error",
)  # fmt: skip
OF_A_PAIR: Final = ("outcome", "apart_m", "ends_apart_m", "parted_m", "outside_m", "reason")


@dataclass(frozen=True, slots=True)
class Pairs(StudyModel):
    """A study's subject: pairs of runs of a published length; `fast`: quickly, with some centimetres of error."""

    keys = {  # noqa: RUF012 - as in the base
        "scenario": Quantity("scenario", "a built-in one, for its ski and its length", kind="text"),
        **{each.name: each.key for each in UNKNOWNS},
    }
    results = (*OF_A_PAIR, *(f"{contact}_{name}" for contact in CONTACTS for name in OF_A_RUN))
    fast: bool = True

    def require_sound(self, points: Sequence[Point], fixed: Point) -> None:
        """The design is sound."""

    def files(self, points: Sequence[Point]) -> list[Path]:  # noqa: ARG002 - a point names none
        """No file."""
        return []

    def __call__(self, point: Point) -> dict[str, Any]:
        """One row; what does not reach the length says so in `outcome`."""
        nothing = dict.fromkeys(self.results)
        try:
            plastic = simulate(turn(point, fast=self.fast))
            if plastic.outcome not in (
                "distance_reached",
                "interrupted",
            ):  # no run of that length: nothing to hold against
                return {**point, **nothing, "outcome": plastic.outcome, "reason": "hypoplastic"}
            elastic = simulate(turn(point | {"snow.unloading_ratio": 1.0}, fast=self.fast))
        except SkisnowError as error:
            return {**point, **nothing, "outcome": "error", "reason": str(error)}
        if "interrupted" in (plastic.outcome, elastic.outcome):
            raise KeyboardInterrupt
        return {**point, **nothing, **pair(elastic, plastic)}


def turn(point: Point, *, fast: bool) -> Scenario:
    """The scenario of a point."""
    base = load_scenario(point["scenario"])
    values = {name: value for name, value in point.items() if "." in name}
    inertia = tuple(each * point["inertia_factor"] for each in base.sledge.inertia)
    made = base.with_(
        ski=varied_ski(base.ski, stiffness=point["stiffness_factor"], sidecut=point["sidecut_factor"]),
        **{"sledge.inertia_kg_m2": inertia, "run.duration_s": LONGEST, **values},
    )
    if not fast:
        return made
    spacing = SPARSER * laid_out(made).numbers["line_spacing_m"]
    return made.with_(solver=replace(made.solver, method="fast", line_spacing=spacing, output_interval=OUTPUT))


def varied_ski(ski: Ski, *, stiffness: float, sidecut: float) -> Ski:
    """The ski with another stiffness, and another depth of its sidecut about the same waist."""
    return replace(
        ski,
        bending_stiffness=ski.bending_stiffness * stiffness,
        torsional_stiffness=ski.torsional_stiffness * stiffness,
        width=ski.waist_width + (ski.width - ski.waist_width) * sidecut,
    )


def pair(elastic: Run, plastic: Run) -> dict[str, Any]:
    """What both runs did, and how far they are apart."""
    runs = dict(zip(CONTACTS, (elastic, plastic), strict=True))
    beside = distance_from(elastic, plastic)
    length = plastic.scenario.stop.length
    assert length is not None  # both scenarios have one
    far = np.flatnonzero(beside > PARTED * length)
    way = _way(elastic)
    parted = float(way[far[0]]) if far.size else float(way[-1])
    found = {
        "outcome": "complete" if elastic.outcome == "distance_reached" else elastic.outcome,
        "apart_m": json_number(float(np.nanmax(beside))),
        "ends_apart_m": json_number(float(np.linalg.norm(elastic.place[-1] - plastic.place[-1]))),
        "parted_m": parted if far.size else None,
        "outside_m": json_number(_outside(elastic, plastic)),
        "reason": "" if elastic.outcome == "distance_reached" else "elastic",
    }
    for contact, run in runs.items():
        found |= {f"{contact}_{name}": value for name, value in of_run(run, parted).items()}
    return found


def distance_from(run: Run, other: Run) -> FloatArray:
    """Distance (m) of each place of a run from the other's path, which goes on straight at its end."""
    onwards = other.place[-1] + other.velocity[-1] / max(float(np.linalg.norm(other.velocity[-1])), 1e-9)
    return distance_from_path(run.place, np.vstack([other.place, onwards]))


def _outside(elastic: Run, plastic: Run) -> float:
    """How far (m) the elastic run's end lies to the outer side of the hypoplastic one's left turn, at its right."""
    apart = elastic.place[-1, :2] - plastic.place[-1, :2]
    ahead = plastic.velocity[-1, :2] / max(float(np.linalg.norm(plastic.velocity[-1, :2])), 1e-9)
    return float(apart @ np.array([ahead[1], -ahead[0]]))


def of_run(run: Run, parted: float) -> dict[str, Any]:
    """What one run did; `grip_before`: median grip utilisation on the way on which both tracks are one."""
    grip, slips = used_grip(run)
    before, _ = used_grip(_cut(run, slice(0, max(2, int(np.searchsorted(_way(run), parted, side="right"))))))
    _, late = used_grip(_cut(run, slice(int(LATE * len(run.time)), None)))
    heading = np.unwrap(run.heading)
    return {
        "complete": run.outcome == "distance_reached",
        "time_s": float(run.time[-1]),
        "end_x_m": json_number(float(run.place[-1, 0])),
        "end_y_m": json_number(float(run.place[-1, 1])),
        "turned_deg": json_number(float(np.degrees(heading[-1] - heading[0]))),
        "radius_m": median_radius(run),
        "depth_mm": json_number(float(np.median(np.nanmax(run.skis.edge_depth, axis=(1, 2)))) * 1e3),
        "grip": grip,
        "grip_before": before,
        "slips": slips,
        "slips_late": late,
        "afterbody_ratio": afterbody_depth_ratio(run),
        "energy_error": json_number(run.energy_balance_error),
    }


def _way(run: Run) -> FloatArray:
    """Length of the path up to each row (m)."""
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(run.place, axis=0), axis=1))])


def _cut(run: Run, rows: slice) -> Run:
    """The part of a run that its grip is asked of."""
    names = ("edge_depth", "force_per_length", "shear_per_length", "force")
    skis = replace(run.skis, **{name: getattr(run.skis, name)[rows] for name in names})
    return replace(run, time=run.time[rows], skis=skis)
