"""Friction of a law file: the water-film law for states of the snow from cold to wet."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Annotated

import numpy as np

from ..._support.errors import ParameterError
from ..._support.user_files.text_files import read_toml
from ...parameters import Allowed, Quantity, build_declared, checked_table, require_declared
from ...snow import MeasuredRange
from .speed_laws import WaterFilmFriction


@dataclass(frozen=True, slots=True, kw_only=True)
class SnowState:
    """Friction on snow of one temperature and wetness.

    lubricated_friction, dry_friction, viscous_slope: μ_∞, a and c (s/m) of `WaterFilmFriction`.
    temperature: Temperature of the snow's surface (°C), at most 0; None if unknown.
    liquid_water: Share of liquid water in the volume (%); above 0 at 0 °C only.
    """

    lubricated_friction: Annotated[float, Quantity("mu", "μ_∞, friction at high speed"), Allowed(0.0, 1.0)]
    dry_friction: Annotated[
        float, Quantity("dry_mu", "a, the part that falls as the film forms"), Allowed(0.0, 1.0)
    ] = 0.0
    viscous_slope: Annotated[float, Quantity("viscous_s_per_m", "c, growth with the speed"), Allowed(0.0, 0.1)] = 0.0
    temperature: Annotated[
        float | None, Quantity("temperature_C", "temperature of the snow's surface"), Allowed(-60.0, 0.0)
    ] = None
    liquid_water: Annotated[
        float, Quantity("liquid_water_percent", "liquid water in the volume"), Allowed(0.0, 50.0)
    ] = 0.0

    def __post_init__(self) -> None:
        require_declared(self)
        if self.liquid_water > 0.0 and self.temperature != 0.0:
            raise ParameterError(
                "liquid_water_percent is {water:g} at a temperature_C of {temperature}; wet snow has 0 °C. Change one"
            ).tag("contradiction", water=self.liquid_water, temperature=self.temperature)

    @property
    def wetness(self) -> float:
        """Place from cold to wet: the temperature (°C) of dry snow, the liquid water (%) of wet snow."""
        return self.liquid_water or self.temperature or 0.0


@dataclass(frozen=True, slots=True)
class FrictionFile:
    """Friction over temperature, liquid water and speed, between states on a straight line.

    source: Who measured it.
    speeds: Measured speeds (m/s).
    film_speed: v_0 (m/s) of `WaterFilmFriction`, of all states.
    states: From cold to wet; a single one may have no temperature and then holds for any snow.
    path: The file, for messages.
    """

    source: Annotated[str, Quantity("source", "who measured it")]
    speeds: Annotated[tuple[float, ...], Quantity("speed_m_per_s", "slowest and fastest measured speed"), Allowed(0.0)]
    film_speed: Annotated[float, Quantity("film_speed_m_per_s", "v_0"), Allowed(0.0, above=True)]
    states: tuple[SnowState, ...]
    path: str

    def __post_init__(self) -> None:
        if len(self.speeds) != 2 or self.speeds[0] >= self.speeds[1]:
            raise ParameterError("speed_m_per_s is {speeds}; allowed are two numbers, the slower one first").tag(
                "out_of_range", speeds=list(self.speeds)
            )
        places = [state.wetness for state in self.states]
        unknown = len(places) > 1 and any(state.temperature is None for state in self.states)
        if not places or unknown or any(second <= first for first, second in pairwise(places)):
            raise ParameterError(
                "the states are at {places} from cold to wet (°C, then % of water); write one or more, each with a "
                "temperature_C and warmer or wetter than the one before"
            ).tag("out_of_order", places=places)

    def at(self, temperature: float | None, liquid_water: float = 0.0) -> WaterFilmFriction:
        """Friction law on snow of this state, interpolated; beyond the states that of the nearest one.

        temperature: Temperature of the snow's surface (°C); None: not known, which only a law without temperature
            accepts.
        liquid_water: In the volume (%).
        Raises ParameterError: the law has temperatures and none is given, or wet snow is not at 0 °C.
        """
        first = self.states[0]
        if first.temperature is None:
            place = 0.0
        elif temperature is None:
            raise ParameterError("{path} has states of the snow by temperature; give friction.temperature_C").tag(
                "missing", path=self.path
            )
        else:
            place = SnowState(lubricated_friction=0.0, temperature=temperature, liquid_water=liquid_water).wetness
        places = [state.wetness for state in self.states]
        numbers = (
            np.interp(place, places, [getattr(state, name) for state in self.states])
            for name in ("lubricated_friction", "dry_friction", "viscous_slope")
        )
        lubricated, dry, slope = map(float, numbers)
        return WaterFilmFriction(lubricated, dry, self.film_speed, slope)

    def warn_outside(self, temperature: float | None, liquid_water: float, speeds: tuple[float, float]) -> None:
        """Issue a `RangeWarning` for a snow or speeds (m/s) that the source did not measure."""
        MeasuredRange("speed", self.speeds[0], self.speeds[1], "m/s", 1.0, self.source).warn_outside(speeds, self.path)
        measured = [state for state in self.states if state.temperature is not None]
        if temperature is None or not measured:
            return
        ends = min(state.temperature or 0.0 for state in measured), max(state.temperature or 0.0 for state in measured)
        MeasuredRange("snow temperature", *ends, "°C", 1.0, self.source).warn_outside(temperature, self.path)
        wettest = max(state.liquid_water for state in measured)
        MeasuredRange("liquid water", 0.0, wettest, "%", 1.0, self.source).warn_outside(liquid_water, self.path)


def read_friction_file(path: str | Path) -> FrictionFile:
    """Read friction over temperature, liquid water and speed.

    path: TOML with ``source``, ``speed_m_per_s = [slowest, fastest]``, ``film_speed_m_per_s``, and a table
        ``[[state]]`` for each state of the snow: ``mu``, ``dry_mu``, ``viscous_s_per_m``, ``temperature_C``,
        ``liquid_water_percent``.
    Raises ParameterError: the file cannot be read, or a key is unknown, missing or out of range; file, state, key and
        value are named.
    """
    values = read_toml(path)
    tables = values.get("state", [])
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        raise ParameterError("{path}: state is not a list of tables. Write [[state]] above the keys of each state").tag(
            "wrong_kind", path=path
        )
    head = checked_table(FrictionFile, values, str(path), further=("state",))
    try:
        states = tuple(
            build_declared(SnowState, checked_table(SnowState, table, f"state {number}"))
            for number, table in enumerate(tables, start=1)
        )
        return build_declared(FrictionFile, head, states=states, path=str(path))
    except ParameterError as error:
        raise error.at(path) from error
