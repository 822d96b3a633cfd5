"""Checks of `carve` and `rest` before any computation."""

from __future__ import annotations

import math
from typing import Final

from .._support.errors import ParameterError, require_choice
from ..ski import Ski
from ..snow.properties import SnowProperties

GREATEST_EDGE_ANGLE: Final = math.radians(85.0)
GROOVES: Final = ("edge", "path")
MOMENT_BALANCES: Final = ("boot", "free")
SIDE_FORCE_SPREADS: Final = ("depth", "base-reaction")


def require_kinds(ski: object, snow: object) -> None:
    """Reject arguments of another type than a ski and snow."""
    if not isinstance(ski, Ski):
        raise ParameterError("ski is {ski!r}; it must be a Ski, as read_ski returns it for a name or a file").tag(
            "wrong_kind", ski=ski
        )
    if not isinstance(snow, SnowProperties):
        raise ParameterError(
            "snow is {snow!r}; it must be SnowProperties: from published_snow, from snow_from_results, or from numbers"
        ).tag("wrong_kind", snow=snow)


def require_ranges(edge_angle: float, load: float, unloading_ratio: float, moment: float) -> None:
    """Reject an edge angle, load, unloading ratio or moment outside its range."""
    if not 0.0 <= edge_angle <= GREATEST_EDGE_ANGLE:
        raise ParameterError(
            "edge_angle is {edge_angle} rad; it must be from 0 to {greatest_edge_angle:.3f} rad (85 degrees)"
        ).tag("out_of_range", edge_angle=edge_angle, greatest_edge_angle=GREATEST_EDGE_ANGLE)
    if not (math.isfinite(load) and load > 0.0):
        raise ParameterError("load is {load} N; it must be a finite force above 0").tag("out_of_range", load=load)
    if not unloading_ratio >= 1.0:
        raise ParameterError("unloading_ratio is {unloading_ratio}; k_u/H_V must be 1 (elastic) or more").tag(
            "out_of_range", unloading_ratio=unloading_ratio
        )
    if not math.isfinite(moment):
        raise ParameterError("moment is {moment} N m; it must be finite").tag("not_a_number", moment=moment)


def require_within(ski: Ski, load: float, moment: float) -> None:
    """Refuse a moment that puts the resultant beyond the ski's ends."""
    ahead = moment / load
    if not ski.station[-1] < ahead < ski.station[0]:
        raise ParameterError(
            "a moment of {moment} N m under a load of {load} N puts the resultant {ahead:.2f} m ahead of the boot: "
            "off the ski, which reaches from {tail:.2f} to {tip:.2f} m: no snow can balance that"
        ).tag("out_of_range", moment=moment, load=load, ahead=ahead, tail=ski.station[-1], tip=ski.station[0])


def require_choices(groove: str, moment_balance: str, side_force_spread: str) -> None:
    """Reject a groove, moment balance or spread of the side force that is not among the choices."""
    require_choice("groove", groove, GROOVES)
    require_choice("moment_balance", moment_balance, MOMENT_BALANCES)
    require_choice("side_force_spread", side_force_spread, SIDE_FORCE_SPREADS)


def require_strength(snow: SnowProperties) -> None:
    """Reject snow without S_f if no law carries the side force."""
    if snow.failure_shear_stress is None:
        raise ParameterError(
            "the snow ({source}) has no failure shear stress S_f; a carved turn needs it: give one, or a shear law"
        ).tag("no_data", source=snow.source)


def unloading_ratio_of(snow: SnowProperties, stated: float | None) -> float:
    """The stated k_u/H_V, else that of the snow; ParameterError if both are missing."""
    ratio = snow.unloading_ratio if stated is None else stated
    if ratio is None:
        raise ParameterError(
            "unloading_ratio is missing, and the snow ({source}) has none: k_u/H_V has no default. Give it here, or "
            "to the snow: 1 is elastic snow, math.inf rigid-plastic snow"
        ).tag("missing", source=snow.source)
    return ratio
