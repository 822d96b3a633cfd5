"""Snow over a slope: its strength, its laws, its surface, and the tracks that are left in it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Final, get_args

import numpy as np

from .._support.errors import ParameterError
from .._support.messages import template
from .._support.units import N_PER_MM2, N_PER_MM3, Facts, Shown, amount
from ..compiled import core
from ..forces.friction import ConstantFriction, FrictionLaw, LinearFriction, QuadraticFriction, WaterFilmFriction
from ..forces.friction.law import ActsOn, Direction
from ..forces.penetration import PointLaw
from ..forces.penetration.law import DAMPING, DELAYED_SHARE, DELAYED_SPACING, RETARDATION_TIME
from ..forces.shear import AngleShear, ConstantShear, DensityShear, MachiningShear, NaturalDensityShear, ShearLaw
from ..forces.shear.law import RESIDUAL_RATIO, SHEAR_DISPLACEMENT, SLIP_WEAKENING, Bearing
from ..geometry.surfaces import Grid, Plane

STICK_DISPLACEMENT: Final = 0.02e-3
"""Way of the base (m) to full friction, until which it sticks (modelling assumption): Coulomb's law, regularised."""
KNOT_AREA: Final = 1e-4
"""Share of a contact's depth times width below which a knot of the groove is dropped (modelling assumption)."""
PART_ALONG: Final = 0.006
"""Longest path (m) of tip or tail along the ski over which the history advances at once (modelling assumption)."""
PART_ACROSS: Final = 2e-3
"""The same across the ski (m): what an edge cuts depends on where it was in between (modelling assumption)."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class SnowField(Shown):
    """One snow, shared by any number of contacts: each meets the grooves of the others.

    Attributes
    ----------
    snow_hardness
        H_V (N/m³), a number > 0 or a `Grid` over the place; not used where ``penetration`` is given.
    failure_shear_stress
        S_f (N/m²), a number ≥ 0 or a `Grid` over the place; not used where ``shear`` is given.
    unloading_ratio
        k_u/H_V ≥ 1; 1 is elastic snow, which keeps nothing. Not used where ``penetration`` is given.
    friction
        A law for μ(v), or a constant μ ≥ 0.
    shear
        A law for the strength over depth and edge angle, with the thrust that comes with it; ``None``: S_f.
    strength_share
        Factor that multiplies the strength (S_f or the law): a number > 0 or a `Grid` over the place.
    friction_share
        Factor that multiplies μ: a number > 0 or a `Grid` over the place.
    friction_acts_on
        Load that μ acts on: the pressure along the snow's normal, or the pressure on the base with the side force.
    friction_direction
        ``vector``: against the sliding velocity, in the surface, or where μ acts on what presses on the base, in the
        base's plane; ``along-ski``: μ times the load along the ski, at any slip angle. `MachiningShear` contains
        the friction across the ski: with it the vector's part across the ski is left out.
    residual_ratio, slip_weakening
        Share of the strength that is left where an edge has slipped, 0 to 1, and the slip (m) over which it is reached.
    shear_bearing
        Height by which an edge resists an inward motion: of the whole edge, or of the bearing part of the base
        (``loaded-height``), not with ``penetration``.
    penetration
        A law for the stress over depth and maximum depth, evaluated at three Gauss points of each straight piece;
        ``None``: H_V and k_u, in closed form.
    damping
        c ≥ 0 of p = H_V ε + c ε̇ (N s/m³); only without ``penetration``.
    delayed_share, retardation_time
        H_V/H₂ ≥ 0 and c₂/H₂ > 0 (s) of a Kelvin element in series with H_V: delayed over immediate depth under a
        constant load, and the time constant of the delay; only without ``penetration``.
    surface
        ``Plane()`` or heights as a `Grid` (m).
    compaction_resistance
        True if the snow that is pressed down resists the motion along the edge.
    shear_displacement
        Displacement (m) > 0 of an edge, across, at which it reaches its full strength: a penalty stiffness before
        Coulomb-like slip.
    stick_displacement, knot_area, part_along, part_across, delayed_spacing
        Constants of the method; the constants of this module describe the effect of each.

    Raises
    ------
    ParameterError
        A number is outside its range.

    See Also
    --------
    skisnow.SnowContact
    """

    snow_hardness: float | Grid
    failure_shear_stress: float | Grid
    unloading_ratio: float
    friction: FrictionLaw | float = 0.0
    friction_acts_on: ActsOn = "snow-normal"
    friction_direction: Direction = "vector"
    shear: ShearLaw | None = None
    strength_share: float | Grid = 1.0
    friction_share: float | Grid = 1.0
    residual_ratio: float = RESIDUAL_RATIO
    slip_weakening: float = SLIP_WEAKENING
    shear_bearing: Bearing = "whole-edge"
    penetration: PointLaw | None = None
    damping: float = DAMPING
    delayed_share: float = DELAYED_SHARE
    retardation_time: float = RETARDATION_TIME
    surface: Plane | Grid = field(default_factory=Plane)
    compaction_resistance: bool = True
    shear_displacement: float = SHEAR_DISPLACEMENT
    stick_displacement: float = STICK_DISPLACEMENT
    knot_area: float = KNOT_AREA
    part_along: float = PART_ALONG
    part_across: float = PART_ACROSS
    delayed_spacing: float = DELAYED_SPACING
    compiled: core.Snow = field(init=False, repr=False)

    def _repr_facts(self) -> Facts:
        """Title with hardness, stress, unloading ratio and laws."""

        def in_words(value: float | Grid, size: float, unit: str) -> str:
            return "over the place" if isinstance(value, Grid) else amount(value / size, unit)

        hardness = in_words(self.snow_hardness, N_PER_MM3, "N/mm³")
        stress = in_words(self.failure_shear_stress, N_PER_MM2, "N/mm²")
        friction = self.friction if isinstance(self.friction, int | float) else type(self.friction).__name__
        laws = f"friction {friction}, shear {'S_f' if self.shear is None else type(self.shear).__name__}"
        if self.penetration is not None:
            laws += f", penetration {type(self.penetration).__name__}"
        return Facts(f"H_V {hardness}, S_f {stress}, k_u/H_V {amount(self.unloading_ratio)}, {laws}")

    def __post_init__(self) -> None:
        _require("snow_hardness", _minimum(self.snow_hardness), 0.0, above=True)
        _require("failure_shear_stress", _minimum(self.failure_shear_stress), 0.0)
        _require("unloading_ratio", self.unloading_ratio, 1.0)
        law, stress = self.penetration, self.failure_shear_stress
        greatest = stress.values.max() if isinstance(stress, Grid) else stress
        if law is not None and law.along_base_normal and (self.shear is not None or greatest > 0.0):
            raise ParameterError(
                "SnowField: {kind} acts along the base's normal and so carries the side force itself; set "
                "failure_shear_stress to 0 and remove the shear law"
            ).tag("contradiction", kind=type(law).__name__)
        self._require_valid_shares()
        _require("residual_ratio", self.residual_ratio, 0.0)
        if self.residual_ratio > 1.0:
            raise ParameterError("SnowField: residual_ratio is {residual_ratio!r}; it must be at most 1").tag(
                "out_of_range", residual_ratio=self.residual_ratio
            )
        for name, choices in (("friction_acts_on", get_args(ActsOn)), ("friction_direction", get_args(Direction))):
            if getattr(self, name) not in choices:
                raise ParameterError("SnowField: {name} is {value!r}; it must be one of {choices}").tag(
                    "unknown_name", name=name, value=getattr(self, name), choices=list(choices)
                )
        for name in (
            "slip_weakening",
            "shear_displacement",
            "stick_displacement",
            "part_along",
            "part_across",
            "retardation_time",
            "delayed_spacing",
        ):
            _require(name, getattr(self, name), 0.0, above=True)
        for name in ("knot_area", "damping", "delayed_share"):
            _require(name, getattr(self, name), 0.0)
        self._require_own_law_for_rate()
        object.__setattr__(self, "compiled", self._core_snow())

    def _require_valid_shares(self) -> None:
        """Reject shares that are not above 0, and a strength share next to an S_f or law that it cannot multiply."""
        _require("strength_share", _minimum(self.strength_share), 0.0, above=True)
        _require("friction_share", _minimum(self.friction_share), 0.0, above=True)
        shared = isinstance(self.strength_share, Grid) or self.strength_share != 1.0
        if shared and isinstance(self.failure_shear_stress, Grid) and self.shear is None:
            raise ParameterError(
                "SnowField: failure_shear_stress varies over the place itself; leave strength_share 1"
            ).tag("contradiction")
        if shared and self.shear_in_python is not None:
            raise ParameterError(
                "SnowField: strength_share has no effect on {kind}, a law of your own; keep it at 1"
            ).tag("contradiction", kind=type(self.shear).__name__)

    def _require_own_law_for_rate(self) -> None:
        """Reject damping, delayed depth and a bearing height with a penetration law: they act with H_V and k_u only."""
        if self.penetration is not None and self.shear_bearing != "whole-edge":
            raise ParameterError(
                "SnowField: shear_bearing compares with H_V and k_u, not with {kind}; remove it, or the penetration law"
            ).tag("contradiction", kind=type(self.penetration).__name__)
        if self.penetration is not None and (self.damping > 0.0 or self.delayed_share > 0.0):
            raise ParameterError(
                "SnowField: damping and delayed_share act with H_V and k_u, not with {kind}; keep them at 0, or "
                "remove the penetration law"
            ).tag("contradiction", kind=type(self.penetration).__name__)

    def _core_snow(self) -> core.Snow:
        """Snow for the compiled core, with its grids and laws."""
        snow = core.Snow()
        snow.hardness, snow.strength = _core_grid(self.snow_hardness), _core_grid(self._strength())
        snow.friction_share = _core_grid(self.friction_share)
        snow.surface = _core_grid(0.0 if isinstance(self.surface, Plane) else self.surface, goes_on=True)
        snow.unloading_ratio, snow.shear_displacement = self.unloading_ratio, self.shear_displacement
        snow.compaction_resistance, snow.friction = self.compaction_resistance, self._friction()
        snow.friction_on_base, snow.shear = self.friction_acts_on == "base-normal", self._core_shear_law()
        rate = core.RateLaw()
        rate.damping, rate.delayed_share = self.damping, self.delayed_share
        rate.retardation, rate.spacing = self.retardation_time, self.delayed_spacing
        snow.rate = rate
        snow.knot_area, snow.part_along, snow.part_across = self.knot_area, self.part_along, self.part_across
        return snow

    def _friction(self) -> core.FrictionLaw:
        """The friction law as coefficients of μ = c₀ + c₁ v + c₂ v² + a/(1 + v/v₀) for the core."""
        law, out = self.friction, core.FrictionLaw()
        out.stick = self.stick_displacement
        out.is_vector = self.friction_direction == "vector"
        out.acts_across = not isinstance(self.shear, MachiningShear)
        if isinstance(law, ConstantFriction):
            out.constant = law.friction_coefficient
        elif isinstance(law, LinearFriction):
            out.constant, out.linear = law.friction_at_rest, law.friction_slope
        elif isinstance(law, QuadraticFriction):
            out.constant, out.linear, out.square = law.friction_at_rest, law.friction_slope, law.friction_curvature
        elif isinstance(law, WaterFilmFriction):
            out.constant, out.linear = law.lubricated_friction, law.viscous_slope
            out.film, out.film_speed = law.dry_friction, law.film_speed
        elif not isinstance(law, FrictionLaw):
            _require("friction", law, 0.0)
            out.constant = law
        return out

    def _strength(self) -> float | Grid:
        """S_f or the law's strength (N/m²) times `strength_share`; the core applies its change with the edge angle."""
        law, share = self.shear, self.strength_share
        strength = self.failure_shear_stress
        if isinstance(law, ConstantShear | DensityShear | NaturalDensityShear):
            strength = law.failure_shear_stress
        elif isinstance(law, AngleShear):
            strength = law.flat_shear_stress
        elif isinstance(law, MachiningShear):
            strength = law.dynamic_shear_strength
        if isinstance(share, Grid) and not isinstance(strength, Grid):
            return Grid(share.x, share.y, strength * share.values)
        if isinstance(share, Grid) or isinstance(strength, Grid):
            return strength
        return strength * share

    def _core_shear_law(self) -> core.ShearLaw:
        """Parameters of the shear law for the compiled core."""
        law, out = self.shear, core.ShearLaw()
        out.residual_ratio, out.weakening = self.residual_ratio, self.slip_weakening
        out.loaded_only = self.shear_bearing == "loaded-height"
        if isinstance(law, AngleShear):
            out.decrease = law.relative_decrease
        elif isinstance(law, MachiningShear):
            out.cuts, out.least_plane = law.least_shear_plane > 0.0, law.least_shear_plane
            out.friction_angle = math.atan(law.transverse_friction)
        return out

    @property
    def shear_in_python(self) -> ShearLaw | None:
        """The shear law if it is evaluated in Python; None if the compiled core has it."""
        known = (AngleShear, ConstantShear, DensityShear, NaturalDensityShear)
        if isinstance(self.shear, known) or (isinstance(self.shear, MachiningShear) and self._core_shear_law().cuts):
            return None
        return self.shear

    @property
    def friction_in_python(self) -> FrictionLaw | None:
        """The friction law if it is evaluated in Python; None for a number or a law that the core has."""
        known = (ConstantFriction, LinearFriction, QuadraticFriction, WaterFilmFriction)
        return (
            self.friction if isinstance(self.friction, FrictionLaw) and not isinstance(self.friction, known) else None
        )


def _minimum(value: float | Grid) -> float:
    """Smallest value of a grid, or the number itself."""
    return float(value.values.min()) if isinstance(value, Grid) else value


_LIMITS: Final = {
    True: template("SnowField: {name} is {value!r}; it must be finite and above {limit:g}"),
    False: template("SnowField: {name} is {value!r}; it must be finite and at least {limit:g}"),
}


def _require(name: str, value: float, limit: float, *, above: bool = False) -> None:
    """Reject a number that is below a limit, or with `above` not above it."""
    if not (math.isfinite(value) and (value > limit if above else value >= limit)):
        raise ParameterError(_LIMITS[above]).tag("out_of_range", name=name, value=value, limit=limit)


def _core_grid(value: float | Grid, *, goes_on: bool = False) -> core.Grid:
    """The number or grid as the core's type; `goes_on`: True if the slope at the border continues beyond it."""
    if not isinstance(value, Grid):
        return core.Grid(float(value))
    steps = [float(np.ptp(places)) / (len(places) - 1) if len(places) > 1 else 1.0 for places in (value.x, value.y)]
    heights = np.ascontiguousarray(value.values)
    return core.grid(float(value.x[0]), steps[0], float(value.y[0]), steps[1], heights, goes_on)
