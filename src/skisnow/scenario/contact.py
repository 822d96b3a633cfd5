"""Contact of skis and snow in a scenario."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Final, Literal, TypeAlias, get_args

from .._support.errors import ParameterError
from .._support.messages import Message
from ..forces.friction import FrictionFile, FrictionLaw, LinearFriction
from ..forces.friction.law import ActsOn, Direction
from ..forces.penetration import LayeredPoint, PointLaw, ProfilePoint
from ..forces.penetration.law import DAMPING, DELAYED_SHARE, RETARDATION_TIME
from ..forces.shear.law import SHEAR_DISPLACEMENT
from ..parameters import (
    APART,
    Allowed,
    Condition,
    Declared,
    Label,
    Quantity,
    Search,
    Section,
    Word,
    require_declared,
)
from ..snow import SnowProperties
from ..snow.measured_range import without_range_warnings
from .snow_map import SnowLayers, SnowMap

Penetration: TypeAlias = Literal["hypoplastic", "elastic"]

ELASTIC: Final = 1.0
"""k_u/H_V of snow that springs back."""


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Contact(Declared):
    """Contact of skis and snow.

    snow: With H_V and S_f; where these vary over the place, with their means.
    snow_map: H_V, S_f and friction where they vary over the place; None: they do not.
    unloading_ratio: k_u/H_V ≥ 1; 1: elastic.
    compaction_resistance: Whether the base's slope along the ski counts as resistance.
    shear_displacement: u_y > 0 (m).
    hardness_growth, layer_depth, lower_hardness: γ' ≥ 0 (1/m); depth (m) at which a lower layer begins, and its H_V
        (N/m³); None: one layer.
    layers: Hardness of several layers over H_V instead.
    damping, delayed_share, retardation_time: c ≥ 0 (N s/m³) of the snow's answer to the rate of depth; H_V/H₂ ≥ 0 and
        c₂/H₂ > 0 (s) of its delayed depth.
    friction, friction_by_speed, friction_acts_on, friction_direction: μ = μ_0 + μ_1 v: μ_0 ≥ 0, and μ_1 (s/m); the load
        that it multiplies, and the direction of the force.
    friction_law, temperature, liquid_water: μ over speed and snow instead of μ_0 and μ_1, which are 0 then; temperature
        of the snow's surface (°C), None: not known; liquid water (% of the volume), None: dry.
    """

    snow: Annotated[SnowProperties, Section("snow", otherwise=True)]
    unloading_ratio: Annotated[
        float,
        Quantity(
            "snow.unloading_ratio",
            'k_u/H_V: 1 is elastic snow, 1000 nearly rigid-plastic; omit it, or use 1, with penetration = "elastic", '
            "and omit it if the results contain it",
        ),
        Label(Message("unloading ratio"), symbol="$k_u/H_V$"),
        Allowed(1.0, 1000.0, origin="not published: a parameter"),
        Search(3.0, 1.0, 1000.0, logarithmic=True),
        Word(
            "snow.penetration",
            "whether the snow is plastic (history-dependent), or elastic",
            label=Message("law of penetration"),
            choices=get_args(Penetration),
            default="hypoplastic",
            origin="snow keeps its tracks",
            word_of=lambda ratio: "elastic" if ratio == ELASTIC else "hypoplastic",
        ),
    ]
    compaction_resistance: Annotated[
        bool,
        Quantity(
            "snow.compaction_resistance",
            "whether pushing the groove brakes the ski",
            origin="exact: else a gliding ski would cut its groove for nothing",
        ),
        Label(Message("pushing the groove brakes")),
    ] = True
    shear_displacement: Annotated[
        float,
        Quantity(
            "snow.shear_displacement_mm",
            "u_y, the sideways displacement of an edge at which the snow reaches S_f; omit it if the results contain "
            "it",
        ),
        Label(Message("shear displacement"), symbol="$u_y$"),
        # below 0.01 mm, a step's corrections are as large
        Allowed(0.01, 10.0, origin="not measured: a choice near the law of the paper, which is its limit 0"),
        Search(3.0, 0.01, 5.0, logarithmic=True),
    ] = SHEAR_DISPLACEMENT
    hardness_growth: Annotated[
        float,
        Quantity(
            "snow.hardness_growth_per_mm",
            "γ' of p = H_V ε (1 + γ' ε), snow that is harder below; 0: alike at every depth",
        ),
        Label(Message("growth of the hardness"), symbol="$γ'$"),
        Allowed(0.0, 10.0, origin="choice: none; a campaign gives γ/e₇"),
    ] = 0.0
    layer_depth: Annotated[
        float | None,
        Quantity("snow.layer_depth_mm", "depth at which a lower layer begins, or the ground"),
        Label(Message("depth of the upper layer"), symbol="d"),
        Allowed(0.01, 10000.0, origin="none: one layer"),
    ] = None
    lower_hardness: Annotated[
        float | None,
        Quantity("snow.lower_H_V_N_per_mm3", "H_V of that layer: growth of the pressure with depth there"),
        Label(Message("hardness of the lower layer"), symbol="$H_2$"),
        Allowed(0.0001, 10000.0, origin="none; goes with snow.layer_depth_mm"),
    ] = None
    layers: Annotated[
        SnowLayers | None,
        APART,
        Word(
            "snow.layers_file",
            "CSV file of layers: depth_mm of each top, hardness_share of H_V or force_N of a SnowMicroPen",
            word_of=lambda layers: layers and layers.source,
            names_file=True,
            label=Message("file of the snow over the depth"),
        ),
    ] = None
    damping: Annotated[
        float,
        Quantity(
            "snow.damping_N_s_per_mm3", "c of p = H_V ε + c dε/dt, snow that answers to how fast it is pressed; 0: none"
        ),
        Label(Message("damping of the snow"), symbol="c"),
        Allowed(0.0, 10.0, origin="choice: none, as the paper; steady penetration of snow hardly depends on speed"),
        Search(0.002, 0.0, 0.1),
    ] = DAMPING
    delayed_share: Annotated[
        float,
        Quantity(
            "snow.delayed_share", "delayed elastic depth under a load that stays, over the depth at once; 0: none"
        ),
        Label(Message("delayed share"), symbol="$H_V/H_2$"),
        Allowed(0.0, 10.0, origin="choice: none; not measured for groomed snow"),
        Search(0.1, 0.0, 2.0),
    ] = DELAYED_SHARE
    retardation_time: Annotated[
        float,
        Quantity(
            "snow.retardation_time_ms",
            "time in which 63 % of the delayed depth is reached; without effect if there is no delayed depth",
        ),
        Label(Message("retardation time"), symbol="$c_2/H_2$"),
        Allowed(1.0, 1e7, origin="choice: what a ski takes to pass; not measured"),
        Condition("snow.delayed_share", 0.0, differs=True),
        Search(1.0, 1.0, 1e4, logarithmic=True),
    ] = RETARDATION_TIME
    friction: Annotated[
        float,
        Quantity("friction.mu_0", "μ_0 of the glide friction μ = μ_0 + μ_1 v"),
        Label(Message("friction"), symbol="$μ_0$"),
        Allowed(0.0, 1.0, origin="measured μ 0.023 to 0.139; a warning beyond"),
        Search(0.1, 0.0, 0.5),
    ]
    friction_by_speed: Annotated[
        float,
        Quantity("friction.mu_1_s_per_m", "μ_1 of it, with the speed v"),
        Label(Message("friction that grows with speed"), symbol="$μ_1$"),
        Allowed(-0.1, 0.1, origin="choice: friction that does not depend on speed"),
        Search(0.01, -0.05, 0.05),
    ] = 0.0
    friction_acts_on: Annotated[
        ActsOn,
        Quantity(
            "friction.acts_on",
            "load that μ is multiplied with: along the snow's normal, or square on the base, side force included",
            origin="choice: it does not hang on how the side force spreads along the edge, which was not measured",
        ),
        Label(Message("friction acts on")),
    ] = "snow-normal"
    friction_direction: Annotated[
        Direction,
        Quantity(
            "friction.direction",
            "against the sliding velocity, or along the ski at any slip angle",
            origin="Coulomb's law; the paper's turns had friction along the ski",
        ),
        Label(Message("direction of friction")),
    ] = "vector"
    friction_law: Annotated[
        FrictionFile | None,
        APART,
        Word(
            "friction.law_file",
            "TOML file of μ over speed, temperature and liquid water, instead of μ_0 and μ_1",
            word_of=lambda law: law and law.path,
            names_file=True,
            label=Message("file of the friction over the snow's state"),
        ),
    ] = None
    temperature: Annotated[
        float | None,
        Quantity("friction.temperature_C", "temperature of the snow's surface, for friction.law_file"),
        Label(Message("snow temperature")),
        Allowed(-60.0, 0.0, origin="none; a law file with temperatures needs it"),
    ] = None
    liquid_water: Annotated[
        float | None,
        Quantity("friction.liquid_water_percent", "liquid water in the volume of wet snow, for friction.law_file"),
        Label(Message("liquid water of the snow (%)")),
        Allowed(0.0, 50.0, origin="none: dry snow; goes with friction.law_file and 0 °C"),
    ] = None
    snow_map: Annotated[
        SnowMap | None,
        Word(
            "snow.map_file",
            "CSV file of H_V, S_f and friction over the place: x_m, y_m or not, H_V_N_per_mm3 and S_f_N_per_mm2 "
            "instead of these, mu_share times μ",
            word_of=lambda snow_map: snow_map and snow_map.source,
            names_file=True,
            label=Message("file of the snow over the place"),
        ),
    ] = None

    @property
    def greatest_hardness(self) -> float:
        """The largest H_V (N/m³) over the place."""
        over_place = None if self.snow_map is None else self.snow_map.hardness
        return self.snow.snow_hardness if over_place is None else float(over_place.values.max())

    def hardness_at(self, x: float, y: float) -> float:
        """H_V (N/m³) at a place (m)."""
        over_place = None if self.snow_map is None else self.snow_map.hardness
        return self.snow.snow_hardness if over_place is None else float(over_place.values_at(x, y))

    def __post_init__(self) -> None:
        require_declared(self)
        if (self.layer_depth is None) != (self.lower_hardness is None):
            raise ParameterError(
                "snow.layer_depth_mm and snow.lower_H_V_N_per_mm3 go together: give both, or none"
            ).tag("contradiction")
        if self.friction_law is None:
            if self.temperature is not None or self.liquid_water is not None:
                raise ParameterError(
                    "friction.temperature_C and friction.liquid_water_percent go with friction.law_file. Add it, or "
                    "remove them"
                ).tag("contradiction")
        elif self.friction != 0.0 or self.friction_by_speed != 0.0:
            raise ParameterError("friction.law_file gives μ. Set friction.mu_0 and friction.mu_1_s_per_m to 0").tag(
                "contradiction"
            )
        else:
            self.friction_law.at(self.temperature, self.liquid_water or 0.0)
        if self.layers is not None and (self.layer_depth is not None or self.hardness_growth > 0.0):
            raise ParameterError(
                "snow.layers_file gives the hardness over the depth. Remove it, or snow.layer_depth_mm and "
                "snow.hardness_growth_per_mm"
            ).tag("contradiction")
        if not self.is_layered:
            return
        if self.snow_map is not None and self.snow_map.hardness is not None:
            raise ParameterError(
                "snow.map_file gives H_V as a map, and layers need one value of H_V. Remove the layers, or the map's "
                "column H_V_N_per_mm3"
            ).tag("contradiction")
        if self.damping > 0.0 or self.delayed_share > 0.0:
            raise ParameterError(
                "layers of snow cannot be combined with snow.damping_N_s_per_mm3 or snow.delayed_share. Remove one"
            ).tag("contradiction")

    @property
    def glide_friction(self) -> FrictionLaw:
        """Friction law along the ski: μ as a function of the speed."""
        with without_range_warnings():  # a scenario has its own words for friction that is unlikely
            if self.friction_law is not None:
                return self.friction_law.at(self.temperature, self.liquid_water or 0.0)
            return LinearFriction(friction_at_rest=self.friction, friction_slope=self.friction_by_speed)

    def friction_at(self, speed: float) -> float:
        """μ at a speed (m/s)."""
        if self.friction_law is not None:
            return float(self.glide_friction.coefficient(speed))
        return self.friction + self.friction_by_speed * speed  # may be below 0

    def require_linear_friction(self) -> None:
        """Reject a friction law file where only μ_0 and μ_1 are used.

        Raises ParameterError: the scenario has a law file.
        """
        if self.friction_law is not None:
            raise ParameterError(
                "this computation has μ = μ_0 + μ_1 v. Give friction.mu_0 and friction.mu_1_s_per_m instead of "
                "friction.law_file"
            ).tag("not_supported")

    @property
    def is_layered(self) -> bool:
        """True if the pressure is not proportional to the depth."""
        return self.layers is not None or self.layer_depth is not None or self.hardness_growth > 0.0

    @property
    def penetration(self) -> PointLaw | None:
        """Penetration law of layered snow; None for snow with only H_V and k_u."""
        if not self.is_layered:
            return None
        if self.layers is not None:
            return ProfilePoint(self.snow.snow_hardness, self.unloading_ratio, self.layers.tops, self.layers.shares)
        depth, hardness = self.layer_depth or 1e3, self.lower_hardness or self.snow.snow_hardness
        return LayeredPoint(self.snow.snow_hardness, self.unloading_ratio, depth, hardness, self.hardness_growth)
