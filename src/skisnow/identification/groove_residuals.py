"""Residuals of measured grooves: depth, width and turn radius of a ski that carves or slides.

The ski is computed by `skisnow.carve` at the given edge angle, with half of the normal component of the weight on each
ski. The remaining depth is e_max (1 - H_V/k_u), the width e_max/tan ϑ at the deepest place, the radius that of the
circle through the edge line at the boot and both ends of the contact. S_f has no effect while the edge holds. If the
edge slides, the snow gives its full resistance 2 S_f ∫ e ds, and the radius follows from the balance across the path:

    m v²/R = 2 S_f ∫ e ds - m g sin α sin χ (turn to the left; χ heading from the fall line)
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from .._support.arrays import BoolArray, FloatArray
from .._support.errors import ParameterError, SkisnowError
from .._support.units import DEGREE, MM, N_PER_MM2, N_PER_MM3
from ..carving.equilibrium import carve
from ..scenario import Plane, ScenarioFile
from ..scenario.terrain import normals_of
from ..snow import SnowProperties
from .data_tables import MeasuredGrooves
from .problem import Fit, Kind, Values

HARDNESS_KEY, STRENGTH_KEY = "snow.H_V_N_per_mm3", "snow.S_f_N_per_mm2"
USED_KEYS: Final = (
    HARDNESS_KEY,
    STRENGTH_KEY,
    "snow.unloading_ratio",
    "sledge.edge_angle_deg",
    "sledge.mass_kg",
    "start.speed_m_per_s",
    "start.heading_deg",
    "slope.angle_deg",
    "slope.gravity_m_per_s2",
)
"""Keys that the grooves depend on; on speed and heading only where the edge slides."""
STRAIGHTEST: Final = 1e6
"""Radius (m) of a practically straight path, used if the grip is too small for a turn."""


@dataclass(frozen=True, slots=True)
class Groove:
    """Groove of one ski: remaining depth, width and turn radius (m), grip area ∫ e ds (m²)."""

    depth: float
    width: float
    turn_radius: float
    grip_area: float


@dataclass(slots=True)
class GrooveResiduals:
    """Measured grooves, and the ski that is assumed to have made them.

    scenario: the scenario: ski, mass, slope, speed, heading, edge angle, and the values of the fixed inputs.
    slides: True if the edge is assumed to slide: then the radius follows from S_f, and the width is not used.
    """

    measured: MeasuredGrooves
    scenario: ScenarioFile
    slides: bool = False
    kind: Kind = field(default="marks", init=False)
    used_keys: tuple[str, ...] | None = field(default=USED_KEYS, init=False)
    points: int = field(init=False)
    nuisances: int = field(default=0, init=False)
    accuracy_is_stated: bool = field(init=False)
    series: tuple[int, ...] = field(init=False)
    _cache: dict[tuple[float, ...], Groove | None] = field(init=False, default_factory=dict)

    def __post_init__(self) -> None:
        self.series = tuple(int(np.sum(use)) for _, _, use in self._columns())
        self.points = sum(self.series)
        self.accuracy_is_stated = self.measured.stated

    def residuals(self, many: Sequence[Values], *, final: bool = False) -> list[FloatArray | None]:  # noqa: ARG002
        """(Computed - measured)/sd of depths, widths, radii."""
        return [self._residuals_of(values) for values in many]

    def fits(self, values: Values) -> tuple[Fit, ...]:
        """Measured and computed depths, widths and radii, place by place."""
        groove = self.groove(values)
        if groove is None:
            return ()
        computed = np.tile(
            [groove.depth / MM, groove.width / MM, self._turn_radius(values, groove)], (len(self.measured), 1)
        )
        measured = np.column_stack([self.measured.depth / MM, self.measured.width / MM, self.measured.turn_radius])
        sd = np.column_stack([self.measured.depth_sd / MM, self.measured.width_sd / MM, self.measured.turn_radius_sd])
        labels = ("depth (mm)", "width (mm)", "turn radius (m)")
        return (
            Fit(
                name=self.measured.name, kind="marks", along=np.arange(1.0, len(self.measured) + 1.0), labels=labels,
                measured=measured, fitted=computed, sd=sd,
            ),
        )  # fmt: skip

    def warnings(self, values: Values) -> tuple[str, ...]:
        """Warning if the ski has no equilibrium with these values."""
        if self.groove(values) is None:
            return ("no ski carves with these values: start elsewhere",)
        return ()

    def groove(self, values: Values) -> Groove | None:
        """Groove of the ski with these values; None without an equilibrium."""
        of = {**self.scenario.values, **values}
        number = tuple(float(of[key]) for key in USED_KEYS if key not in (STRENGTH_KEY, "start.speed_m_per_s"))
        if number not in self._cache:
            self._cache[number] = _compute_groove(self.scenario, of)
        return self._cache[number]

    def demand(self, values: Values, turn_radius: float) -> float:
        """Side force (N) that both skis together need from the snow on that radius."""
        of = {**self.scenario.values, **values}
        side = math.copysign(1.0, float(of["sledge.edge_angle_deg"]))
        pull = float(of["slope.gravity_m_per_s2"]) * math.sin(_inclination(self.scenario, of))
        pull = pull * math.sin(float(of["start.heading_deg"]) * DEGREE) * side
        return _total_mass(self.scenario, of) * (float(of["start.speed_m_per_s"]) ** 2 / turn_radius + pull)

    def required_strength(self, values: Values, turn_radius: float) -> float | None:
        """Smallest S_f (N/mm²) that holds the skis on that radius; None without an equilibrium."""
        groove = self.groove(values)
        if groove is None or groove.grip_area <= 0.0:
            return None
        return max(self.demand(values, turn_radius), 0.0) / (2.0 * groove.grip_area) / N_PER_MM2

    @property
    def mean_radius(self) -> tuple[float, float]:
        """Weighted mean of the measured radii, and its standard deviation (m); NaN without any."""
        use = np.isfinite(self.measured.turn_radius)
        if not use.any():
            return math.nan, math.nan
        weight = self.measured.turn_radius_sd[use] ** -2.0
        mean = float(np.sum(weight * self.measured.turn_radius[use]) / np.sum(weight))
        return mean, float(np.sum(weight) ** -0.5)

    def _columns(self) -> list[tuple[FloatArray, FloatArray, BoolArray]]:
        """Measured values, standard deviations and mask of used ones for depth, width and turn radius."""
        grooves = self.measured
        return [
            (grooves.depth, grooves.depth_sd, np.isfinite(grooves.depth)),
            (grooves.width, grooves.width_sd, np.isfinite(grooves.width) & (not self.slides)),
            (grooves.turn_radius, grooves.turn_radius_sd, np.isfinite(grooves.turn_radius)),
        ]

    def _residuals_of(self, values: Values) -> FloatArray | None:
        groove = self.groove(values)
        if groove is None:
            return None
        computed = (groove.depth, groove.width, self._turn_radius(values, groove))
        parts = [
            (one - measured[use]) / sd[use] for one, (measured, sd, use) in zip(computed, self._columns(), strict=True)
        ]
        return np.concatenate(parts)

    def _turn_radius(self, values: Values, groove: Groove) -> float:
        """Turn radius (m): of the groove, or of a sliding edge from the side force that S_f allows."""
        if not self.slides:
            return groove.turn_radius
        of = {**self.scenario.values, **values}
        grip = 2.0 * float(of[STRENGTH_KEY]) * N_PER_MM2 * groove.grip_area
        left = grip - self.demand(values, math.inf)
        mass, speed = _total_mass(self.scenario, of), float(of["start.speed_m_per_s"])
        return min(mass * speed**2 / left, STRAIGHTEST) if left > 0.0 else STRAIGHTEST


def require_groove_stays(scenario: ScenarioFile) -> None:
    """Reject scenarios whose ski leaves no groove, or whose edge angle is 0."""
    if scenario.scenario.contact.unloading_ratio <= 1.0:
        raise ParameterError(
            "snow.unloading_ratio is 1: elastic snow keeps no groove. Give the measured unloading ratio of the snow"
        ).tag("elastic_snow")
    if scenario.scenario.sledge.edge_angle == 0.0:
        raise ParameterError(
            "sledge.edge_angle_deg is 0: a flat ski leaves no groove of an edge. Give the edge angle"
        ).tag("flat_ski")


def _total_mass(scenario: ScenarioFile, values: Mapping[str, Any]) -> float:
    return float(values["sledge.mass_kg"]) + 2.0 * scenario.scenario.ski.mass


def _inclination(scenario: ScenarioFile, values: Mapping[str, Any]) -> float:
    slope = scenario.scenario.slope
    if isinstance(slope, Plane):
        return float(values["slope.angle_deg"]) * DEGREE
    start = scenario.scenario.start
    normal = normals_of(slope, start.x, start.y)
    return math.atan2(float(normal[0]), float(normal[2]))


def _compute_groove(scenario: ScenarioFile, values: Mapping[str, Any]) -> Groove | None:
    gravity = float(values["slope.gravity_m_per_s2"])
    load = 0.5 * _total_mass(scenario, values) * gravity * math.cos(_inclination(scenario, values))
    angle = abs(float(values["sledge.edge_angle_deg"])) * DEGREE
    ratio = float(values["snow.unloading_ratio"])
    snow = SnowProperties(float(values[HARDNESS_KEY]) * N_PER_MM3, 1.0 * N_PER_MM2, source="looked for")
    try:
        equilibrium = carve(
            scenario.scenario.flexing_ski, snow, edge_angle=angle, load=load, unloading_ratio=ratio,
            clamp_length=scenario.scenario.clamp_length, footprint_stiffness=scenario.scenario.footprint_stiffness,
        )  # fmt: skip
    except SkisnowError:
        return None
    depth, twist, radius, limit = (
        equilibrium.edge_depth,
        equilibrium.twist,
        equilibrium.turn_radius_chord,
        equilibrium.side_force_limit,
    )
    if depth is None or twist is None or radius is None or limit is None:
        return None
    deepest = int(np.argmax(depth))
    local = angle + float(twist[deepest])
    reach = float(scenario.scenario.ski.at(float(equilibrium.station[deepest])).width) * math.cos(local)
    width = min(float(depth[deepest]) / math.tan(local), reach)
    return Groove(float(depth[deepest]) * (1.0 - 1.0 / ratio), width, radius, limit / N_PER_MM2)
