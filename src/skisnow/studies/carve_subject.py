"""Studies of carved turns: the inputs and results of `skisnow carve`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import numpy as np

from .._support.display import ShownFields
from .._support.errors import SkisnowError
from .._support.json_number import json_number
from .._support.processes.kept_rows import Row
from .._support.units import MM
from ..carving.answer import CarveAnswer, answered
from ..carving.answer_dict import inputs_dict, scalars_dict
from ..carving.keys import CARVE_KEYS
from ..carving.limits import require_clamp
from ..carving.question import carve_question, require_complete
from ..parameters import Quantity
from ..ski.beam.clamped import CLAMP_LENGTH
from ..ski.sources import Sources
from ..snow.properties import require_stress
from .points import Point, Points

RESULTS: Final = (
    "outcome",
    "holds",
    "side_force_N",
    "side_force_limit_N",
    "total_force_N",
    "turn_radius_boot_m",
    "turn_radius_boot_other_spread_m",
    "turn_radius_chord_m",
    "contact_length_m",
    "afterbody_depth_ratio",
    "greatest_edge_depth_mm",
    "greatest_force_per_length_N_per_m",
    "boot_pitch_moment_Nm",
    "residual_force_N",
    "residual_moment_Nm",
    "sidecut_radius_of_three_widths_m",
    "ski_name",
    "warnings",
    "reason",
)
"""Columns behind the inputs; `outcome` is "error" where a point could not be asked, and `reason` says why."""


@dataclass(slots=True, repr=False)
class CarveModel(ShownFields):
    """Answers points with one row each. Relative paths start at `folder`."""

    folder: Path
    _sources: Sources = field(init=False)

    def __post_init__(self) -> None:
        self._sources = Sources(self.folder)

    @property
    def keys(self) -> Mapping[str, Quantity]:
        """The inputs by name."""
        return CARVE_KEYS

    @property
    def results(self) -> tuple[str, ...]:
        """The columns of results."""
        return RESULTS

    def named(self, table: Mapping[str, Any]) -> dict[str, Any]:
        """The values of a table of the study by their names, which they have already."""
        return dict(table)

    def require_sound(self, points: Points, fixed: Point) -> None:
        """Refuse a study that lacks an input, names the snow in two ways, or whose fixed ski or snow cannot be had."""
        carves = points.distinct("at_rest") != [True]
        point = next(point for point in points if not (carves and point.get("at_rest") is True))
        require_complete(point)
        self._require_snow(point, fixed, carves=carves)
        if "ski" in fixed:
            ski, _ = self._sources.ski(fixed["ski"])
            if "clamp_length_m" in fixed or "clamp_length_m" not in points[0]:
                require_clamp(ski, fixed.get("clamp_length_m", CLAMP_LENGTH))

    def _require_snow(self, point: Point, fixed: Point, *, carves: bool) -> None:
        """The snow that all points share must be there, with S_f from one side and not from both."""
        named = {"published", "results", "site"} & set(point)
        if named and named <= set(fixed):
            require_stress(self._sources.named_snow(fixed), point.get("S_f_N_per_mm2"), carves=carves)

    def files(self, points: Points) -> list[Path]:
        """Ski files and results files."""
        skis = (self._sources.ski_file(word) for word in points.distinct("ski"))
        return [path for path in skis if path] + [self._sources.path(word) for word in points.distinct("results")]

    def __call__(self, point: Point) -> Row:
        """One row; whatever is wrong with a point stands in it."""
        try:
            return _row(answered(carve_question(point), sources=self._sources))
        except SkisnowError as error:
            return _failure(point, str(error))
        except Exception as error:  # a study never stops for one point
            return _failure(point, f"unexpected {type(error).__name__}: {error}")


def _row(answer: CarveAnswer) -> Row:
    equilibrium = answer.equilibrium
    scalars = scalars_dict(equilibrium)
    depth, force = equilibrium.edge_depth, equilibrium.force_per_length
    return {
        **inputs_dict(answer),
        **{name: scalars[name] for name in RESULTS if name in scalars},
        "greatest_edge_depth_mm": None if depth is None else float(np.max(depth)) / MM,
        "greatest_force_per_length_N_per_m": None if force is None else float(np.max(force)),
        "sidecut_radius_of_three_widths_m": json_number(answer.ski.sidecut_radius_of_three_widths),
        "ski_name": answer.ski.name,
        "warnings": "; ".join(answer.warnings),
        "reason": equilibrium.remedy,
    }


def _failure(point: Point, reason: str) -> Row:
    given: dict[str, Any] = {name: key.default for name, key in CARVE_KEYS.items()} | point
    return {**given, **dict.fromkeys(RESULTS), "outcome": "error", "warnings": "", "reason": reason}
