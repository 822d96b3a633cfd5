"""Studies of simulated runs: one scenario, some of its keys varied, one row for each run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import numpy as np

from .._support.display import ShownFields
from .._support.errors import ParameterError, SkisnowError
from .._support.json_number import json_number
from .._support.processes.kept_rows import Row
from .._support.units import MM
from ..parameters import Quantity
from ..scenario import ScenarioFile
from ..scenario.built_in import scenario_names, scenario_place
from ..scenario.keys import PATH_KEYS, SCENARIO_KEYS, SECTIONS, full_name
from ..scenario.reading import build_input, input_files, load_input
from ..scenario.resolution import ScenarioInput
from ..simulation.run import Run
from ..simulation.run_summary import end_dict, energies_dict, least_turn_radius, radii_dict, run_warnings
from ..ski.sources import Sources
from .points import Point, Points

RESULTS: Final = (
    "outcome",
    "run_length_m",
    "simulated_s",
    "end_x_m",
    "end_y_m",
    "end_z_m",
    "end_speed_m_per_s",
    "end_heading_deg",
    "greatest_speed_m_per_s",
    "least_turn_radius_m",
    "turn_radius_median_m",
    "turn_radius_p5_m",
    "greatest_edge_depth_mm",
    "kinetic_start_J",
    "kinetic_J",
    "potential_start_J",
    "potential_J",
    "lost_penetration_J",
    "lost_shear_J",
    "lost_friction_J",
    "lost_drag_J",
    "lost_damping_J",
    "lost_snow_damping_J",
    "energy_balance_error",
    "steps",
    "rejected_steps",
    "ski_name",
    "warnings",
    "reason",
)
"""Columns behind the keys; `outcome` is "error" where a run could not be asked for, and `reason` says why."""

MOST_TRIED: Final = 100
"""Points that are tried, before anything is computed, for one that can be asked (assumption: milliseconds each)."""


@dataclass(slots=True, repr=False)
class ScenarioModel(ShownFields):
    """Runs a scenario with the values of each point. Relative paths start at `folder`.

    Attributes
    ----------
    folder
        Of the study.
    scenario
        A built-in name, or the path of a file.
    """

    folder: Path
    scenario: str
    _base: ScenarioInput = field(init=False)
    _sources: Sources = field(init=False, default_factory=Sources)

    def __post_init__(self) -> None:
        built_in = self.scenario in scenario_names()
        self._base = load_input(self.scenario if built_in else self.folder / self.scenario)

    @property
    def keys(self) -> Mapping[str, Quantity]:
        """The scenario's keys by full name."""
        return SCENARIO_KEYS

    @property
    def results(self) -> tuple[str, ...]:
        """The columns of results."""
        return RESULTS

    def named(self, table: Mapping[str, Any]) -> dict[str, Any]:
        """Values of a table of the study under full names: sections, dotted names, and names without their section."""
        found: dict[str, Any] = {}
        for name, value in table.items():
            in_section = name in SECTIONS and isinstance(value, dict)
            parts = {f"{name}.{key}": each for key, each in value.items()} if in_section else {name: value}
            for part, each in parts.items():
                full = full_name(part)
                if full in found:
                    raise ParameterError(f"{full} is given twice. Remove one of them")
                found[full] = each
        return found

    def require_sound(self, points: Points, fixed: Point) -> None:  # noqa: ARG002 - points hold what is fixed
        """Refuse a study of which none of the first points can be asked, with what is wrong with the first."""
        first: SkisnowError | None = None
        for point in points[:MOST_TRIED]:
            try:
                self._asked(point)
            except SkisnowError as error:
                first = first or error
            else:
                return
        if first is not None:
            raise first

    def files(self, points: Points) -> list[Path]:
        """The scenario's file, and every file that it or a point names."""
        own = input_files(self._base) if self._base.file else (scenario_place(self.scenario), *input_files(self._base))
        named = {word for name in PATH_KEYS for word in points.distinct(name)}
        return [*own, *(self.folder / word for word in sorted(named))]

    def __call__(self, point: Point) -> Row:
        """One row; whatever is wrong with a point stands in it."""
        from ..simulation.simulated_run import simulate

        try:
            asked = self._asked(point)
            run = simulate(asked.scenario)
        except SkisnowError as error:
            return self._failure(point, str(error))
        except Exception as error:  # a study never stops for one point
            return self._failure(point, f"unexpected {type(error).__name__}: {error}")
        if run.outcome == "interrupted":  # half a run is no row: the study is what was interrupted
            raise KeyboardInterrupt
        return _row(asked, run)

    def _asked(self, point: Point) -> ScenarioFile:
        return build_input(self._base.changed(point, folder=self.folder), sources=self._sources)

    def _failure(self, point: Point, reason: str) -> Row:
        given = {name: self._base.values.get(name, key.default) for name, key in SCENARIO_KEYS.items()} | point
        return {**given, **dict.fromkeys(RESULTS), "outcome": "error", "warnings": "", "reason": reason}


def _row(asked: ScenarioFile, run: Run) -> Row:
    known = run.speed[np.isfinite(run.speed)]
    depth = run.skis.edge_depth[np.isfinite(run.skis.edge_depth)]
    energies = {name: value for name, value in energies_dict(run).items() if name in RESULTS}
    return {
        **asked.values,
        "outcome": run.outcome,
        "run_length_m": json_number(run.run_length),
        **{f"end_{name}": value for name, value in end_dict(run).items() if name != "time_s"},
        "simulated_s": json_number(run.simulated_s),
        "greatest_speed_m_per_s": float(known.max()) if known.size else None,
        "least_turn_radius_m": least_turn_radius(run),
        **radii_dict(run),
        "greatest_edge_depth_mm": float(depth.max()) / MM if depth.size else None,
        **energies,
        "energy_balance_error": json_number(run.energy_balance_error),
        "steps": int(run.steps),
        "rejected_steps": int(run.rejected_steps),
        "ski_name": run.scenario.ski.name,
        "warnings": "; ".join((*asked.warnings, *run_warnings(run))),
        "reason": run.remedy,
    }
