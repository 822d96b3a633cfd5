"""A ski in snow under a load: flat or edged, at rest or carving steadily.

The ski is held at the boot with a given edge angle. A load along the snow normal presses it, and in a balanced turn the
snow's side force is load × tan ϑ, so that the whole reaction is normal to the base under the boot. The edge is held:
whether the snow can hold it is a result (`Equilibrium.holds`), not part of the balance.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any, Final, Literal, TypeAlias, get_args

import numpy as np

from .._support.errors import ParameterError, require_choice
from .._support.messages import Message, template
from ..ski.beam import CLAMP_LENGTH, ClampedSki, clamped
from ..ski.ski import Ski
from ..snow.properties import SnowProperties
from .edge_line import EdgeLine
from .laws import equivalent_snow, snow_laws
from .outputs import CarveRequest
from .result import Equilibrium, equilibrium_of, radius_at_boot
from .sensitivity import CarveDerivatives
from .solve import RIGID_PLASTIC, Conditions, Solution, solved

if TYPE_CHECKING:
    from ..forces.penetration import PointLaw
    from ..forces.shear import ShearLaw

GrooveForm: TypeAlias = Literal["edge", "path"]
MomentBalance: TypeAlias = Literal["boot", "free"]
SideForceSpread: TypeAlias = Literal["depth", "base-reaction"]

GREATEST_EDGE_ANGLE: Final = math.radians(85.0)
ELEMENTS: Final = 160
"""Elements over the whole ski: 1 cm each, half of 1/λ on the hardest snow (assumption: see the convergence tests)."""
GENTLER_RATIOS: Final = (500.0, 300.0, 200.0)
"""Unloading ratios to fall back on, with a warning, where steeper unloading has no numerical end (modelling
assumption): against 1000 the
greatest depth is 0.6, 1.1 and 1.7 % smaller, the radius less than 0.2 %."""
_MOST_PATHS: Final = 80
_PATH_TOLERANCE: Final = 1e-5  # m, of the edge from the path that was assumed


def carve(
    ski: Ski,
    snow: SnowProperties,
    *,
    edge_angle: float,
    load: float,
    unloading_ratio: float | None = None,
    shear: ShearLaw | None = None,
    penetration: PointLaw | None = None,
    moment: float = 0.0,
    clamp_length: float = CLAMP_LENGTH,
    footprint_stiffness: float | None = None,
    side_force_bending: bool = True,
    side_force_spread: SideForceSpread = "depth",
    groove: GrooveForm = "edge",
    moment_balance: MomentBalance = "boot",
    twist: bool = True,
    elements: int = ELEMENTS,
) -> Equilibrium:
    """Equilibrium of a ski that carves steadily: every place on the snow meets its stations from tip to tail.

    Parameters
    ----------
    ski, snow
        The ski, and the snow with H_V and S_f.
    edge_angle
        ϑ of the base under the boot to the snow surface (rad), 0 to 85°.
    load
        Force on this ski along the snow normal, at the boot (N), > 0.
    unloading_ratio
        k_u/H_V ≥ 1: 1 is elastic snow, `math.inf` rigid-plastic snow (computed as 1000). Where such steep unloading
        does not converge, 500, 300 or 200 is used, with a warning (default: that of the snow).
    shear
        A law of `skisnow.forces.shear`, or one of yours, instead of S_f; a law with a thrust is rejected.
    penetration
        A `PointLaw` of `skisnow.forces.penetration`, or your own, instead of H_V and k_u. A law that acts along the
        base's normal carries the side force by its pressure's part across; it excludes S_f and a shear law.
    moment
        Moment at the boot, positive if it presses the tip down (N m), about the axis that `moment_balance` states.
    clamp_length, footprint_stiffness
        Length of ski that boot and binding clamp (m), and the stiffness between the boot and each metre of it (N/m²);
        None: rigid, the ski stays straight there.
    side_force_bending
        Whether the side force, too, bends and twists the ski (it does: the part sin ϑ of it is normal to the base).
    side_force_spread
        Distribution of the side force along the edge: "depth", in proportion to the edge's depth, or "base-reaction",
        in proportion to the snow's force on the base. With "base-reaction" the whole reaction is normal to the base
        everywhere.
    groove
        "edge": the groove of the forebody is under the edge of the afterbody. "path": the groove follows the circle
        through the edge line at the boot and 0.4 m before and behind; each edge is beside it by the distance of its
        edge line from the circle.
    moment_balance
        "boot": `moment` is about the horizontal cross axis and balances the load without the side force, whose moment
        boot and skier carry in addition: `Equilibrium.boot_pitch_moment`. "free": `moment` is about the ski's own cross
        axis and is the whole moment of boot and skier there.
    twist
        Whether the ski twists (GJ) or keeps its edge angle everywhere.
    elements
        Number of beam elements of the whole ski.

    Returns
    -------
    Equilibrium
        Whatever the outcome; numbers that do not exist are None.

    Raises
    ------
    ParameterError
        An argument is outside its range, or the snow has no S_f; neither argument nor snow state k_u/H_V; an
        object is not a law, or a law gives no finite answer.

    See Also
    --------
    skisnow.rest : a ski that is set down and does not turn.
    skisnow.simulate : a whole turn instead of a steady one.
    skisnow.study : many such answers in one table.

    Notes
    -----
    The balance is linear in the ski's deflection (small slopes) and exact in edge angle and twist. The ski's own weight
    is neglected. With ``side_force_spread`` "depth" the side force uses the same share of the shear strength everywhere
    along the edge (modelling assumption): τ e per length. No measurement of its distribution is known.

    References
    ----------
    * Mössner and others (2013), "Modeling the ski-snow contact in skiing turns using a hypoplastic vs an elastic
      force-penetration relation", Scand. J. Med. Sci. Sports, doi 10.1111/sms.12035.
    * Federolf, Roos, Lüthi and Dual (2010), "Finite element simulation of the ski-snow interaction of an alpine ski in
      a carved turn", Sports Eng. 12, 123-133, doi 10.1007/s12283-010-0038-z.
    * The page docs/methods/carved-turn.md.
    """
    _require_kinds(ski, snow)
    ratio = _unloading_ratio(snow, unloading_ratio, penetration)
    _require_ranges(edge_angle, load, ratio, moment)
    _require_within(ski, load, moment)
    require_choice("groove", groove, get_args(GrooveForm))
    require_choice("moment_balance", moment_balance, get_args(MomentBalance))
    require_choice("side_force_spread", side_force_spread, get_args(SideForceSpread))
    laws = snow_laws(shear, penetration, edge_angle)
    if laws is None or not (laws.shear is not None or laws.along_base_normal):
        _require_strength(snow)
    model = clamped(ski, clamp_length, elements, footprint_stiffness)
    conditions = _conditions(
        ski, snow, edge_angle, load, moment, ratio, side_force_bending=side_force_bending, twist=twist,
        side_force_spread=side_force_spread, moment_balance=moment_balance,
    )  # fmt: skip
    conditions = conditions._replace(laws=laws)
    if laws is not None and laws.penetration is not None:  # the search begins at linear snow
        hardness, first_ratio = equivalent_snow(laws.penetration, ski, edge_angle, load)
        conditions = conditions._replace(hardness=hardness, excess=hardness * (first_ratio - 1.0))
    find = solved if groove == "edge" else _solve_with_path
    solution = find(model, conditions)
    note: tuple[Message, ...] = ()
    for gentler in (smaller for smaller in GENTLER_RATIOS if smaller < ratio):
        if solution.converged:
            break
        conditions = conditions._replace(excess=snow.snow_hardness * (gentler - 1.0))
        solution = find(model, conditions)
        words = template("computed with k_u/H_V = {ratio:g}: the steeper unloading that was asked did not converge")
        note = (Message(words, ratio=gentler),)
    if laws is not None and not solution.converged:
        laws.require_finite()
    exact = laws is None and groove == "edge" and footprint_stiffness is None
    other = partial(_other_radius, find, model, conditions, solution)
    return equilibrium_of(model, conditions, snow, solution, note, elements=elements if exact else None, other=other)


def differentiable_carve(
    ski: Ski,
    snow: SnowProperties,
    *,
    edge_angle: float,
    load: float,
    unloading_ratio: float | None = None,
    moment: float = 0.0,
    clamp_length: float = CLAMP_LENGTH,
    elements: int = ELEMENTS,
    near: Solution | None = None,
    **forms: Any,
) -> CarveDerivatives | None:
    """Refined equilibrium of `carve` with its derivatives, without the answer's other numbers; None: not converged.

    Arguments as in `carve`, `forms` being those of `_conditions`; `near`: a solution of nearly the same question, which
    is tried first.
    """
    ratio = _unloading_ratio(snow, unloading_ratio, None)
    _require_ranges(edge_angle, load, ratio, moment)
    _require_strength(snow)
    model = clamped(ski, clamp_length, elements)
    conditions = _conditions(ski, snow, edge_angle, load, moment, ratio, **forms)
    solution = solved(model, conditions, near=near if near is not None and len(near.u) == model.size else None)
    if not solution.converged:
        return None
    return CarveDerivatives(CarveRequest(model, conditions, snow.failure_shear_stress, solution, elements))


def _other_radius(
    find: Callable[..., Solution], model: ClampedSki, conditions: Conditions, solution: Solution
) -> float | None:
    """Turn radius (m) with the other spread of the side force, searched by `find` from this solution; None: none."""
    drawn = conditions.load
    if conditions.by_reaction:
        drawn = float(model.stations.weight @ np.maximum(solution.edge_depth, 0.0))
    near = replace(solution, shear_stress=conditions.side_force / drawn)
    return radius_at_boot(
        model, conditions, find(model, conditions._replace(by_reaction=not conditions.by_reaction), near=near)
    )


def rest(
    ski: Ski,
    snow: SnowProperties,
    *,
    edge_angle: float,
    load: float,
    moment: float = 0.0,
    clamp_length: float = CLAMP_LENGTH,
    footprint_stiffness: float | None = None,
    twist: bool = True,
    elements: int = ELEMENTS,
) -> Equilibrium:
    """Equilibrium of a ski set down on virgin snow, without side force; arguments (SI) as in `carve`.

    Parameters
    ----------
    ski, snow, edge_angle, load, moment, clamp_length, footprint_stiffness, twist, elements
        As in `carve`; the snow needs no S_f.

    Returns
    -------
    Equilibrium
        Without side force and turn radius.

    See Also
    --------
    skisnow.carve : a ski that turns.

    References
    ----------
    * Hetényi (1946), Beams on Elastic Foundation, University of Michigan Press: the solution that a flat ski of one
      stiffness is compared with.
    * The page docs/methods/carved-turn.md.
    """
    _require_kinds(ski, snow)
    _require_ranges(edge_angle, load, 1.0, moment)
    _require_within(ski, load, moment)
    model = clamped(ski, clamp_length, elements, footprint_stiffness)
    conditions = _conditions(ski, snow, edge_angle, load, moment, 1.0, side_force_bending=False, twist=twist)
    conditions = conditions._replace(side_force=0.0)
    return equilibrium_of(model, conditions, snow, solved(model, conditions))


def _unloading_ratio(snow: SnowProperties, stated: float | None, penetration: object) -> float:
    """Ratio k_u/H_V, stated or of the snow; 1 with a penetration law, which contradicts a stated one."""
    if penetration is not None and stated is not None:
        raise ParameterError(
            "unloading_ratio is {given}, but a penetration law defines the unloading itself: remove unloading_ratio"
        ).tag("contradiction", given=stated)
    ratio = 1.0 if penetration is not None else snow.unloading_ratio if stated is None else stated
    if ratio is None:
        raise ParameterError(
            "unloading_ratio is missing, and the snow ({source}) has none: k_u/H_V has no default. Give it here, or "
            "to the snow: 1 is elastic snow, math.inf rigid-plastic snow"
        ).tag("missing", source=snow.source)
    return ratio


def _conditions(
    ski: Ski,
    snow: SnowProperties,
    edge_angle: float,
    load: float,
    moment: float,
    unloading_ratio: float,
    *,
    side_force_bending: bool = True,
    twist: bool = True,
    side_force_spread: SideForceSpread = "depth",
    moment_balance: MomentBalance = "boot",
) -> Conditions:
    """Conditions of the equations from snow, edge angle (rad), load (N), moment (N m) and unloading ratio k_u/H_V."""
    free = moment_balance == "free"
    return Conditions(
        edge_angle=edge_angle,
        hardness=snow.snow_hardness,
        excess=snow.snow_hardness * (min(unloading_ratio, RIGID_PLASTIC) - 1.0),
        load=load,
        moment=moment,
        side_force=load * math.tan(edge_angle),
        side_force_bending=side_force_bending,
        twists=twist and edge_angle > 0.0,
        bevel=ski.base_bevel,
        bevel_width=ski.edge_width,
        side=ski.side_edge,
        radius=ski.edge_radius,
        pitch_of_force=math.cos(edge_angle) if free else 1.0,
        pitch_of_shear=math.sin(edge_angle) if free else 0.0,
        by_reaction=side_force_spread == "base-reaction",
    )


def _solve_with_path(model: ClampedSki, conditions: Conditions, *, near: Solution | None = None) -> Solution:
    """Equilibrium with the groove along the path: repeat with the edge's offset from it until both agree."""
    solution = solved(model, conditions, near=near)
    offset = np.zeros(len(model.stations.station))
    share, before = 0.5, math.inf
    for _ in range(_MOST_PATHS):
        if not solution.converged:
            return solution
        line = EdgeLine(model, conditions.edge_angle, solution)
        if line.radius_at_boot() is None:
            return solution
        change = line.offset_from_circle() - offset
        size = float(np.max(np.abs(change[solution.edge_depth > 0.0])))
        if size <= _PATH_TOLERANCE:
            return solution
        if size > 0.9 * before:
            share *= 0.7
        before = size
        offset = offset + share * change
        solution = solved(model, conditions, offset=offset, near=solution)
    return Solution(False, *(getattr(solution, name) for name in Solution.__slots__[1:]))


def _require_kinds(ski: object, snow: object) -> None:
    """Reject arguments of another type than a ski and snow."""
    if not isinstance(ski, Ski):
        raise ParameterError("ski is {ski!r}; it must be a Ski, as read_ski returns it for a name or a file").tag(
            "wrong_kind", ski=ski
        )
    if not isinstance(snow, SnowProperties):
        raise ParameterError(
            "snow is {snow!r}; it must be SnowProperties: from published_snow, from snow_from_results, or from numbers"
        ).tag("wrong_kind", snow=snow)


def _require_ranges(edge_angle: float, load: float, unloading_ratio: float, moment: float) -> None:
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


def _require_within(ski: Ski, load: float, moment: float) -> None:
    """Refuse a moment that puts the resultant beyond the ski's ends."""
    ahead = moment / load
    if not ski.station[-1] < ahead < ski.station[0]:
        raise ParameterError(
            "a moment of {moment} N m under a load of {load} N puts the resultant {ahead:.2f} m ahead of the boot: "
            "off the ski, which reaches from {tail:.2f} to {tip:.2f} m: no snow can balance that"
        ).tag("out_of_range", moment=moment, load=load, ahead=ahead, tail=ski.station[-1], tip=ski.station[0])


def _require_strength(snow: SnowProperties) -> None:
    """Reject snow without S_f if no law carries the side force."""
    if snow.failure_shear_stress is None:
        raise ParameterError(
            "the snow ({source}) has no failure shear stress S_f; a carved turn needs it: give one, or a shear law"
        ).tag("no_data", source=snow.source)
