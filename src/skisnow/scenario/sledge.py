"""The sledge of a run, the air around it, and the law of the shear strength of the snow under it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Final, Literal, TypeAlias

from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.units import DEGREE
from ..forces.shear import AngleShear, DensityShear, MachiningShear, ShearLaw
from ..forces.shear.law import RESIDUAL_RATIO, SLIP_WEAKENING, Bearing
from ..parameters import Allowed, Condition, Declared, Label, Quantity, Search, require_declared
from ..snow.measured_range import without_range_warnings
from ..snow.published.moessner_2013 import STRESS_BY_ANGLE


@dataclass(frozen=True, slots=True, repr=False)
class RigidSledge(Declared):
    """The sledge without its skis, SI.

    Attributes
    ----------
    mass
        (kg), > 0.
    inertia
        Roll, pitch and yaw moments of inertia at its centre of mass (kg m²), each > 0, none above the sum of the
        others.
    centre_of_mass
        Forward of the boots, and above the bases (m).
    stance_width
        Between the middles of the skis (m), > 0.
    edge_angle
        Of both skis' bases, positive: left edges down (rad).

    See Also
    --------
    skisnow.Scenario
    """

    mass: Annotated[
        float,
        Quantity("sledge.mass_kg", "mass without the skis"),
        Label(Message("mass of the sledge"), symbol="m"),
        Allowed(0.0, 1000.0, above=True),
    ]
    inertia: Annotated[
        tuple[float, float, float],
        Quantity(
            "sledge.inertia_kg_m2", "roll, pitch and yaw moments of inertia at the centre of mass, without the skis"
        ),
        Label(Message("moments of inertia"), symbol="I"),
        Allowed(0.0, above=True, origin="none is more than the sum of the others"),
    ]
    centre_of_mass: Annotated[
        tuple[float, float],
        Quantity(
            "sledge.centre_of_mass_height_m",
            "height of the centre of mass above the bases",
            label=Message("height of the centre of mass"),
            lowest=0.0,
            highest=3.0,
            search=Search(0.5, 0.0, 3.0),
            index=1,
        ),
        Quantity(
            "sledge.centre_of_mass_forward_m",
            "distance of the centre of mass before the boots",
            label=Message("centre of mass ahead of the boots"),
            lowest=-1.0,
            highest=1.0,
            default=0.0,
            origin="choice: over the boots",
            search=Search(0.5, -1.0, 1.0),
            index=0,
        ),
    ]
    stance_width: Annotated[
        float,
        Quantity("sledge.stance_width_m", "between the middles of the skis; at least a ski's maximum width"),
        Label(Message("stance width")),
        Allowed(0.0, 3.0, above=True),
        Search(0.5, 0.0, 3.0),
    ]
    edge_angle: Annotated[
        float,
        Quantity(
            "sledge.edge_angle_deg",
            "angle of both skis' bases to the sledge; positive: left edges down, a turn to the left",
        ),
        Label(Message("edge angle"), symbol="ϑ"),
        Allowed(-85.0, 85.0, origin="at 90° an edge bears nothing"),
        Search(30.0, -30.0, 30.0, about=True),
    ]

    def __post_init__(self) -> None:
        require_declared(self)
        roll, pitch, yaw = self.inertia
        if 2.0 * max(self.inertia) > roll + pitch + yaw:
            raise ParameterError(
                "inertia is {inertia} kg m²; each moment must be above 0 and none more than the sum of the others"
            ).tag("out_of_range", inertia=self.inertia)


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Air(Declared):
    """Air drag: drag area C_dA (m²), density (kg/m³), height of the centre of pressure above the bases (m)."""

    drag_area: Annotated[
        float,
        Quantity("drag.drag_area_m2", "drag area C_dA; 0: no drag"),
        Label(Message("drag area"), symbol="$C_d A$"),
        Allowed(0.0, 10.0, origin="skiers 0.23 to 0.66; a warning beyond"),
        Search(1.0, 0.0, 3.0),
    ]
    density: Annotated[
        float,
        Quantity("drag.air_density_kg_per_m3", "density of the air"),
        Label(Message("density of the air"), symbol="ρ"),
        Allowed(0.0, 2.0, above=True, origin="choice: 0 °C at 700 m above the sea"),
        Search(1.0, 0.5, 2.0),
    ] = 1.2
    centre_of_pressure_height: Annotated[
        float,
        Quantity(
            "drag.centre_of_pressure_height_m",
            "height of the centre of pressure above the bases; default: that of the centre of mass",
            needed=False,
        ),
        Label(Message("height of the centre of pressure")),
        Allowed(0.0, 3.0),
        Search(0.5, 0.0, 3.0),
    ]


Law: TypeAlias = Literal["constant", "by-angle", "by-density", "machining"]
UPRIGHT: Final = 2.0
"""F_t/(L e) of an upright edge without transverse friction, over the S of machining."""


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Shear(Declared):
    """The law of the shear strength, in SI; a value of None is derived from the snow.

    law: S_f as it is; S_f (1 - k ϑ); S_f of a density; or cutting with its thrust.
    relative_decrease: k (1/rad) of ``by-angle``.
    snow_density: ρ (kg/m³) of ``by-density``.
    dynamic_shear_strength, transverse_friction, least_shear_plane: S (N/m²), μ_t and the lower limit of (ϑ - β)/2 (rad)
        of ``machining``.
    residual_ratio, slip_weakening: share of the strength that slip leaves, and the slip (m) over which it is reached.
    bearing: height by which an edge resists an inward motion.
    """

    law: Annotated[
        Law,
        Quantity(
            "shear.law",
            "law of the shear strength: S_f, S_f (1 - k ϑ), S_f of a density, or cutting with its thrust",
            origin="choice: the paper's own, Eqn 9",
        ),
        Label(Message("law of shear")),
    ] = "constant"
    relative_decrease: Annotated[
        float,
        Quantity("shear.relative_decrease_per_rad", 'k of law = "by-angle"; S_f is then that of a flat edge'),
        Label(Message("relative decrease with the edge angle")),
        Allowed(0.0, 0.6366, origin="Eqn 13, one soft snow"),  # 2/π: beyond, an upright edge would have none
        Condition("shear.law", "by-angle"),
    ] = STRESS_BY_ANGLE[1]
    snow_density: Annotated[
        float | None,
        Quantity(
            "shear.snow_density_kg_per_m3", 'density for law = "by-density", whose S_f (Eqn 14) replaces the snow\'s'
        ),
        Label(Message("density of the snow"), symbol="ρ"),
        Allowed(151.7, 917.0),  # below, Eqn 14 gives none
        Condition("shear.law", "by-density"),
    ] = None
    dynamic_shear_strength: Annotated[
        float | None,
        Quantity(
            "shear.dynamic_shear_strength_N_per_mm2",
            'S of law = "machining"; default: half of S_f, with which an upright edge without μ_t fails at S_f',
        ),
        Label(Message("dynamic shear strength")),
        Allowed(0.0, above=True),
        Condition("shear.law", "machining"),
    ] = None
    transverse_friction: Annotated[
        float,
        Quantity("shear.transverse_friction", 'μ_t = tan β of law = "machining", across the ski'),
        Label(Message("friction across the ski")),
        Allowed(0.0, 2.0, origin="choice: as the paper compares it; not measured"),
        Condition("shear.law", "machining"),
    ] = 0.0
    least_shear_plane: Annotated[
        float,
        Quantity(
            "shear.least_shear_plane_deg",
            'angle that (ϑ - β)/2 of law = "machining" does not fall below where an edge comes to lie flat',
        ),
        Label(Message("least shear plane")),
        Allowed(1.0, 45.0, origin="choice: strength and thrust grow without bound as it falls to 0"),
        Condition("shear.law", "machining"),
    ] = 5.0 * DEGREE
    residual_ratio: Annotated[
        float,
        Quantity(
            "shear.residual_ratio",
            "share of the strength that is left once an edge has slipped, with any law; 1: all of it",
        ),
        Label(Message("residual ratio")),
        Allowed(0.0, 1.0, origin="choice: the strength in slip was not measured"),
    ] = RESIDUAL_RATIO
    slip_weakening: Annotated[
        float,
        Quantity("shear.slip_weakening_mm", "slip over which that share is reached, in proportion to it"),
        Label(Message("slip weakening length")),
        Allowed(0.001, 1000.0, origin="choice: not measured"),
        Condition("shear.residual_ratio", 1.0, differs=True),
    ] = SLIP_WEAKENING
    bearing: Annotated[
        Bearing,
        Quantity(
            "shear.bearing",
            "an edge that moves inwards holds with its whole height, or with the height of the bearing base",
            origin="choice: the paper's depth of the edge; no measurement decides",
        ),
        Label(Message("height that resists")),
    ] = "whole-edge"

    def __post_init__(self) -> None:
        require_declared(self)
        if self.law == "by-density" and self.snow_density is None:
            raise ParameterError('shear.law = "by-density" needs the density: give shear.snow_density_kg_per_m3').tag(
                "missing"
            )

    def of(self, failure_shear_stress: float) -> ShearLaw | None:
        """Shear law by angle, density or machining in snow with this S_f (N/m²); None for a constant S_f."""
        with without_range_warnings():  # a scenario has separate warnings about unmeasured ranges
            if self.law == "by-angle":
                return AngleShear(flat_shear_stress=failure_shear_stress, relative_decrease=self.relative_decrease)
            if self.law == "by-density" and self.snow_density is not None:
                return DensityShear(snow_density=self.snow_density)
            if self.law == "machining":
                return MachiningShear(
                    self.dynamic_shear_strength or failure_shear_stress / UPRIGHT,
                    self.transverse_friction,
                    least_shear_plane=self.least_shear_plane,
                )
        return None

    @property
    def smallest_cutting_angle(self) -> float:
        """Edge angle (rad) below which the shear plane of the machining law is at its limit; 0 for other laws."""
        if self.law != "machining":
            return 0.0
        return math.atan(self.transverse_friction) + 2.0 * self.least_shear_plane
