"""Models of a study: carved turns (`skisnow carve`) or simulated runs of a scenario."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar, Final

import numpy as np

from .._support.errors import ParameterError, SkisnowError
from .._support.processes.kept_rows import Row
from .._support.units import MM, ShownFields
from .._support.user_files.json_text import json_number
from ..carving.answer import answer_question, inputs_dict, scalars_dict
from ..carving.question import CARVE_KEYS, carve_question, require_clamp, require_complete
from ..parameters import Quantity
from ..scenario import ScenarioFile
from ..scenario.keys import PATH_KEYS, SCENARIO_KEYS, SECTIONS, full_name
from ..scenario.reading import build_input, input_files, load_input, scenario_names, scenario_place
from ..scenario.resolution import ScenarioInput
from ..simulation.run_summary import end_dict, energies_dict, least_turn_radius, radii_dict, run_warnings
from ..ski.beam import CLAMP_LENGTH
from ..ski.ski_file import Sources
from ..snow.properties import require_stress
from .points import Point
from .table import FAILED

CARVE_RESULTS: Final = (
    "outcome", "holds", "side_force_N", "side_force_limit_N", "total_force_N", "turn_radius_boot_m",
    "turn_radius_boot_other_spread_m", "turn_radius_chord_m", "turn_radius_median_m", "contact_length_m",
    "afterbody_depth_ratio", "greatest_edge_depth_mm", "greatest_force_per_length_N_per_m", "boot_pitch_moment_Nm",
    "residual_force_N", "residual_moment_Nm", "sidecut_radius_of_three_widths_m", "ski_name", "warnings", "reason",
)  # fmt: skip
"""Columns behind the inputs; `outcome` is "error" where a point could not be asked, and `reason` says why."""
RUN_RESULTS: Final = (
    "outcome", "run_length_m", "simulated_s", "end_x_m", "end_y_m", "end_z_m", "end_speed_m_per_s", "end_heading_deg",
    "greatest_speed_m_per_s", "least_turn_radius_m", "turn_radius_median_m", "turn_radius_p5_m",
    "greatest_edge_depth_mm", "kinetic_start_J", "kinetic_J", "potential_start_J", "potential_J", "lost_penetration_J",
    "lost_shear_J", "lost_friction_J", "lost_drag_J", "lost_damping_J", "lost_snow_damping_J", "energy_balance_error",
    "steps", "rejected_steps", "ski_name", "warnings", "reason",
)  # fmt: skip
"""Columns behind the keys; `outcome` is "error" where a run could not be asked for, and `reason` says why."""
MOST_TRIED: Final = 100
"""Points that are tried, before anything is computed, for one that can be asked (assumption: milliseconds each)."""


def _distinct_values(points: Sequence[Point], name: str) -> list[Any]:
    """Distinct values of an input, in the order of the points."""
    return list(dict.fromkeys(point[name] for point in points if name in point))


class StudyModel(ShownFields):
    """Base of the models whose points a study computes; pickled for each worker.

    keys: inputs by name, in the order of the table's columns.
    results: names of the columns of results.
    """

    __slots__ = ()
    keys: ClassVar[Mapping[str, Quantity]]
    results: ClassVar[tuple[str, ...]]

    def named(self, table: Mapping[str, Any]) -> dict[str, Any]:
        """Values of a table of the study file under the names of `keys`; unknown names are kept."""
        return dict(table)

    def require_sound(self, points: Sequence[Point], fixed: Point) -> None:
        """Raise an error if the study cannot run: an input is missing, given twice, or names an unreadable file."""
        raise NotImplementedError

    def files(self, points: Sequence[Point]) -> list[Path]:
        """Files that the points name; a change of one of them makes another study."""
        raise NotImplementedError

    def __call__(self, point: Point) -> Row:
        """Row of a point; if the point fails, the outcome is "error" and the reason is in the row."""
        try:
            return self._compute_row(point)
        except SkisnowError as error:
            reason = str(error)
        except Exception as error:  # a study never stops for one point
            reason = f"unexpected {type(error).__name__}: {error}"
        own = {**self._defaults(), **point, **dict.fromkeys(self.results)}
        return {**own, "outcome": FAILED, "warnings": "", "reason": reason}

    def _compute_row(self, point: Point) -> Row:
        """Results at a point, by column; it may raise an error."""
        raise NotImplementedError

    def _defaults(self) -> dict[str, Any]:
        """Values of the inputs that a point does not have."""
        return {name: key.default for name, key in self.keys.items()}


@dataclass(slots=True, repr=False)
class CarveModel(StudyModel):
    """Computes the carve of each point of a study, one row each. Relative paths start at `folder`."""

    keys = CARVE_KEYS
    results = CARVE_RESULTS
    folder: Path
    _sources: Sources = field(init=False)

    def __post_init__(self) -> None:
        self._sources = Sources(self.folder)

    def require_sound(self, points: Sequence[Point], fixed: Point) -> None:
        """Raise an error if an input is missing, the snow is named twice, or a fixed ski or snow cannot be read."""
        carves = _distinct_values(points, "at_rest") != [True]
        point = next(point for point in points if not (carves and point.get("at_rest") is True))
        require_complete(point)
        # the snow that all points share must be there, with S_f from one side and not from both
        named = {"published", "results", "site"} & set(point)
        if named and named <= set(fixed):
            require_stress(self._sources.named_snow(fixed), point.get("S_f_N_per_mm2"), carves=carves)
        if "ski" in fixed:
            ski, _ = self._sources.ski(fixed["ski"])
            if "clamp_length_m" in fixed or "clamp_length_m" not in points[0]:
                require_clamp(ski, fixed.get("clamp_length_m", CLAMP_LENGTH))

    def files(self, points: Sequence[Point]) -> list[Path]:
        """Ski files and results files."""
        skis = (self._sources.ski_file(word) for word in _distinct_values(points, "ski"))
        return [path for path in skis if path] + [
            self._sources.path(word) for word in _distinct_values(points, "results")
        ]

    def _compute_row(self, point: Point) -> Row:
        """Carve at a point: inputs, results, largest depth (mm) and force, and warnings."""
        answer = answer_question(carve_question(point), sources=self._sources)
        equilibrium = answer.equilibrium
        scalars = scalars_dict(equilibrium)
        depth, force = equilibrium.edge_depth, equilibrium.force_per_length
        return {
            **inputs_dict(answer),
            **{name: scalars[name] for name in CARVE_RESULTS if name in scalars},
            "greatest_edge_depth_mm": None if depth is None else float(np.max(depth)) / MM,
            "greatest_force_per_length_N_per_m": None if force is None else float(np.max(force)),
            "sidecut_radius_of_three_widths_m": json_number(answer.ski.sidecut_radius_of_three_widths),
            "ski_name": answer.ski.name,
            "warnings": "; ".join(answer.warnings),
            "reason": equilibrium.remedy,
        }


@dataclass(slots=True, repr=False)
class ScenarioModel(StudyModel):
    """Runs a scenario, a built-in one or a file with a path relative to `folder`, with the values of each point."""

    keys = SCENARIO_KEYS
    results = RUN_RESULTS
    folder: Path
    scenario: str
    _base: ScenarioInput = field(init=False)
    _sources: Sources = field(init=False, default_factory=Sources)

    def __post_init__(self) -> None:
        built_in = self.scenario in scenario_names()
        self._base = load_input(self.scenario if built_in else self.folder / self.scenario)

    def named(self, table: Mapping[str, Any]) -> dict[str, Any]:
        """Values of a table of the study under full names: sections, dotted names, and names without their section."""
        values: dict[str, Any] = {}
        for name, value in table.items():
            in_section = name in SECTIONS and isinstance(value, dict)
            parts = {f"{name}.{key}": part_value for key, part_value in value.items()} if in_section else {name: value}
            for part, part_value in parts.items():
                full = full_name(part)
                if full in values:
                    raise ParameterError("{full} is given twice. Remove one of them").tag("repeated", full=full)
                values[full] = part_value
        return values

    def require_sound(self, points: Sequence[Point], fixed: Point) -> None:  # noqa: ARG002 - points hold what is fixed
        """Raise the error of the first point if none of the first points can be computed."""
        first: SkisnowError | None = None
        for point in points[:MOST_TRIED]:
            try:
                self._scenario_of_point(point)
            except SkisnowError as error:
                first = first or error
            else:
                return
        if first is not None:
            raise first

    def files(self, points: Sequence[Point]) -> list[Path]:
        """The scenario's file, and every file that it or a point names."""
        own = input_files(self._base) if self._base.file else (scenario_place(self.scenario), *input_files(self._base))
        named = {word for name in PATH_KEYS for word in _distinct_values(points, name)}
        return [*own, *(self.folder / word for word in sorted(named))]

    def _compute_row(self, point: Point) -> Row:
        """Run at a point; KeyboardInterrupt if the run was interrupted."""
        from ..simulation.simulated_run import simulate

        scenario_file = self._scenario_of_point(point)
        run = simulate(scenario_file.scenario)
        if run.outcome == "interrupted":  # half a run does not count: the study is what was interrupted
            raise KeyboardInterrupt
        finite = run.speed[np.isfinite(run.speed)]
        depth = run.skis.edge_depth[np.isfinite(run.skis.edge_depth)]
        energies = {name: value for name, value in energies_dict(run).items() if name in RUN_RESULTS}
        return {
            **scenario_file.values,
            "outcome": run.outcome,
            "run_length_m": json_number(run.run_length),
            **{f"end_{name}": value for name, value in end_dict(run).items() if name != "time_s"},
            "simulated_s": json_number(run.simulated_s),
            "greatest_speed_m_per_s": float(finite.max()) if finite.size else None,
            "least_turn_radius_m": least_turn_radius(run),
            **radii_dict(run),
            "greatest_edge_depth_mm": float(depth.max()) / MM if depth.size else None,
            **energies,
            "energy_balance_error": json_number(run.energy_balance_error),
            "steps": int(run.steps),
            "rejected_steps": int(run.rejected_steps),
            "ski_name": run.scenario.ski.name,
            "warnings": "; ".join((*scenario_file.warnings, *run_warnings(run))),
            "reason": run.remedy,
        }

    def _scenario_of_point(self, point: Point) -> ScenarioFile:
        """Scenario with the values of a point."""
        return build_input(self._base.changed(point, folder=self.folder), sources=self._sources)

    def _defaults(self) -> dict[str, Any]:
        """Values of the inputs that a point does not have: the scenario's own, otherwise the key's default."""
        return {name: self._base.values.get(name, key.default) for name, key in SCENARIO_KEYS.items()}
