"""A ski in snow under a load: flat or edged, at rest or carving steadily.

The ski is held at the boot with a given edge angle. A load along the snow normal presses it, and in a balanced turn the
snow's side force is load × tan ϑ, so that the whole reaction is normal to the base under the boot. The edge is held:
whether the snow can hold it is a result (`Equilibrium.holds`), not part of the balance.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Final, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from ..errors import ParameterError
from ..shown import Facts, Shown, amount
from ..ski.beam.clamped import CLAMP_LENGTH, ClampedSki, clamped
from ..ski.ski import Ski
from ..snow.properties import SnowProperties
from ..units import MM
from .edge_line import EdgeLine
from .solve import RIGID_PLASTIC, Conditions, Solution, solved

FloatArray: TypeAlias = npt.NDArray[np.float64]
Outcome: TypeAlias = Literal["equilibrium", "slips", "sinks", "bridges", "not_converged"]
GrooveForm: TypeAlias = Literal["edge", "path"]
MomentBalance: TypeAlias = Literal["boot", "free"]
SideForceSpread: TypeAlias = Literal["depth", "base-reaction"]

ELEMENTS: Final = 160
"""Elements over the whole ski: 1 cm each, half of 1/λ on the hardest snow (assumption: see the convergence tests)."""
SINKING_DEPTH: Final = 0.30
"""Edge depth (m) beyond which a ski counts as swallowed: no balance above it (modelling assumption)."""
GREATEST_EDGE_ANGLE: Final = math.radians(85.0)
LARGE_SLOPE: Final = 0.35
"""Slope of the bent ski, and twist (rad), beyond which beams of small deflection fail (modelling assumption: 6 % in
the cosine)."""
GENTLER_RATIOS: Final = (500.0, 300.0, 200.0)
"""Unloading ratios to fall back on, with a warning, where steeper unloading has no numerical end (modelling
assumption): against 1000
the greatest depth is 0.6, 1.1 and 1.7 % smaller, the radius less than 0.2 %."""
_MOST_PATHS: Final = 80
_PATH_TOLERANCE: Final = 1e-5  # m, of the edge from the path that was assumed

REMEDIES: Final[dict[Outcome, str]] = {
    "equilibrium": "",
    "slips": "the snow cannot hold the side force: less edge angle or load, or stronger snow; the numbers are those of "
    "an edge held by something else",
    "sinks": f"no balance above {SINKING_DEPTH * 1e2:.0f} cm: the snow is too soft for this load",
    "bridges": "the ski stands on separate pieces, or not under the boot: softer snow, a softer ski, less camber or a "
    "shorter clamp closes the gap",
    "not_converged": "no equilibrium was found: try a smaller unloading ratio, more elements or a lower edge angle",
}
"""What to do about an outcome, in words."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Equilibrium(Shown):
    """A ski in equilibrium with the snow. SI, radians; None where a number does not exist.

    Attributes
    ----------
    outcome
        "equilibrium"; "slips": the side force is beyond the shear strength, all numbers are those of the held edge;
        "bridges": the contact is not one piece or misses the boot; "sinks" and "not_converged" have no numbers.
        Where several apply: not_converged, sinks, slips, bridges, equilibrium.
    remedy
        What to do about it, in words.
    side_force, side_force_limit
        Load × tan ϑ, and S_f ∫ e ds over the edge that is below the surface (N).
    holds
        Whether the limit is not exceeded.
    turn_radius_boot
        Radius of the circle through the edge line at the boot and 0.4 m before and behind it (m); None for a ski that
        is flat or at rest.
    turn_radius_boot_other_spread
        The same with the side force spread the other way along the edge, all else alike (m): how much hangs on that
        choice; None also where that has no equilibrium.
    turn_radius_chord
        Radius of the circle through the edge line at the boot and at both ends of the contact (m).
    contact_length
        Between the first and the last place at which the edge is below the undisturbed surface (m): there it meets
        snow or its groove, and can hold side force.
    bearing_length
        Of the places that carry force (m): in a groove that does not spring back, parts of the contact carry none.
    afterbody_depth_ratio
        Mean edge depth of the contact behind the boot over that before it.
    boot_pitch_moment
        What boot and skier hold about the ski's cross axis, positive where they press the tip down (N m):
        ∫ s (f cos ϑ + τ e sin ϑ) ds.
    station
        Places along the ski, from the boot, positive forward, tip to tail (m), shape (n,), as all that follow.
    edge_depth
        Of the edge below the undisturbed surface (m); negative: above it.
    force_per_length
        Of the snow, along the snow normal (N/m).
    bending
        Deflection of the base against the ski held straight at the boot, away from the snow (m).
    twist
        Growth of the edge angle against that at the boot (rad).
    edge_line
        Position of the edge in the snow surface, towards the inside of the turn (m).
    residual_force, residual_moment
        What the snow's force and its moment about the boot differ by from load and moment (N, N m); the moment is that
        which was balanced.
    warnings
        Where the answer is outside what the model can say, in words.
    iterations
        Of Newton's method.

    See Also
    --------
    skisnow.carve
    skisnow.rest
    """

    outcome: Outcome
    remedy: str
    holds: bool | None
    side_force: float | None
    side_force_limit: float | None
    turn_radius_boot: float | None
    turn_radius_boot_other_spread: float | None
    turn_radius_chord: float | None
    contact_length: float | None
    bearing_length: float | None
    afterbody_depth_ratio: float | None
    boot_pitch_moment: float | None
    station: FloatArray
    edge_depth: FloatArray | None
    force_per_length: FloatArray | None
    bending: FloatArray | None
    twist: FloatArray | None
    edge_line: FloatArray | None
    residual_force: float | None
    residual_moment: float | None
    warnings: tuple[str, ...]
    iterations: int

    def _facts(self) -> Facts:
        deepest = None if self.edge_depth is None else float(np.max(self.edge_depth)) / MM
        holds = {True: "holds", False: "does not hold", None: "unknown"}[self.holds]
        limit = f"of {amount(self.side_force_limit, 'N')}: {holds}"
        rows = (
            ("side force", f"{amount(self.side_force, 'N')} {limit}"),
            ("turn radius", amount(self.turn_radius_boot, "m")),
            ("side force spread otherwise", amount(self.turn_radius_boot_other_spread, "m")),
            ("contact", amount(self.contact_length, "m")),
            ("edge depth", f"at most {amount(deepest, 'mm')}"),
            ("afterbody", f"{amount(self.afterbody_depth_ratio)} of the forebody's depth"),
            ("warnings", str(len(self.warnings))),
        )
        return Facts(self.outcome.replace("_", " "), rows)


def carve(
    ski: Ski,
    snow: SnowProperties,
    *,
    edge_angle: float,
    load: float,
    unloading_ratio: float,
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
        does not converge, 500, 300 or 200 is taken and a warning says so.
    moment
        At the boot, positive where it presses the tip down (N m); about which axis, `moment_balance` says.
    clamp_length, footprint_stiffness
        Length of ski that boot and binding hold (m), and how stiff they are between the boot and each metre of it
        (N/m²); None: rigid, the ski stays straight there.
    side_force_bending
        Whether the side force, too, bends and twists the ski (it does: the part sin ϑ of it is normal to the base).
    side_force_spread
        How the side force goes along the edge: "depth", in proportion to the edge's depth, or "base-reaction", in
        proportion to the snow's force on the base, whose whole reaction is then normal to the base everywhere.
    groove
        "edge": the groove of the forebody lies under the edge of the afterbody. "path": it lies on the circle through
        the edge line at the boot and 0.4 m before and behind, and each edge beside it by what its edge line differs.
    moment_balance
        "boot": `moment` is about the horizontal cross axis and balances the load alone; what the side force does about
        the ski's cross axis, boot and skier hold besides: `Equilibrium.boot_pitch_moment` tells how much. "free":
        `moment` is about the ski's own cross axis, and all that boot and skier hold there.
    twist
        Whether the ski twists (GJ) or keeps its edge angle everywhere.
    elements
        Of the whole ski.

    Returns
    -------
    Equilibrium
        Whatever the outcome; numbers that do not exist are None.

    Raises
    ------
    ParameterError
        An argument is outside its range, or the snow has no S_f.

    See Also
    --------
    skisnow.rest : a ski that is set down and does not turn.
    skisnow.simulate : a whole turn in place of a steady one.
    skisnow.study : many such answers in one table.

    Notes
    -----
    The balance is linear in the ski's deflection (small slopes) and exact in edge angle and twist. The ski's own weight
    is left out. With ``side_force_spread`` "depth" the side force draws the same share of the shear strength
    everywhere along the edge (modelling assumption): τ e per length. Nobody has measured how it goes.

    References
    ----------
    * Mössner and others (2013), "Modeling the ski-snow contact in skiing turns using a hypoplastic vs an elastic
      force-penetration relation", Scand. J. Med. Sci. Sports, doi 10.1111/sms.12035.
    * Federolf, Roos, Lüthi and Dual (2010), "Finite element simulation of the ski-snow interaction of an alpine ski in
      a carved turn", Sports Eng. 12, 123-133, doi 10.1007/s12283-010-0038-z.
    * The page docs/methods/carved-turn.md.
    """
    _require_kinds(ski, snow)
    _require(edge_angle, load, unloading_ratio, moment)
    _require_within(ski, load, moment)
    if snow.failure_shear_stress is None:
        raise ParameterError(
            f"the snow ({snow.source}) has no failure shear stress S_f; a carved turn needs it: give one"
        )
    model = clamped(ski, clamp_length, elements, footprint_stiffness)
    conditions = _conditions(
        ski, snow, edge_angle, load, moment, min(unloading_ratio, RIGID_PLASTIC), side_force_bending, twist
    )
    if side_force_spread not in ("depth", "base-reaction"):
        raise ParameterError(f"side_force_spread is {side_force_spread!r}; it must be 'depth' or 'base-reaction'")
    conditions = conditions._replace(by_reaction=side_force_spread == "base-reaction")
    if groove not in ("edge", "path"):
        raise ParameterError(f"groove is {groove!r}; it must be 'edge' or 'path'")
    if moment_balance not in ("boot", "free"):
        raise ParameterError(f"moment_balance is {moment_balance!r}; it must be 'boot' or 'free'")
    if moment_balance == "free":
        conditions = conditions._replace(pitch_of_force=math.cos(edge_angle), pitch_of_shear=math.sin(edge_angle))
    find = solved if groove == "edge" else _following_path
    solution = find(model, conditions)
    note: tuple[str, ...] = ()
    for gentler in (ratio for ratio in GENTLER_RATIOS if ratio < unloading_ratio):
        if solution.converged:
            break
        conditions = conditions._replace(excess=snow.snow_hardness * (gentler - 1.0))
        solution = find(model, conditions)
        note = (f"computed with k_u/H_V = {gentler:g}: the steeper unloading that was asked did not converge",)
    found = _described(model, conditions, snow, solution, note)
    if found.turn_radius_boot is None:
        return found
    other = find(model, conditions._replace(by_reaction=not conditions.by_reaction))
    return replace(found, turn_radius_boot_other_spread=_radius_at_boot(model, conditions, other))


def _radius_at_boot(model: ClampedSki, conditions: Conditions, solution: Solution) -> float | None:
    if not solution.converged or float(np.max(solution.edge_depth)) > SINKING_DEPTH:
        return None
    return EdgeLine(model, conditions.edge_angle, solution).radius_at_boot()


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
    """Equilibrium of a ski set down on snow: virgin snow everywhere, no side force. Arguments as in `carve`.

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
    * Hetényi (1946), Beams on Elastic Foundation, University of Michigan Press: what a flat ski of one stiffness is
      held to.
    * The page docs/methods/carved-turn.md.
    """
    _require_kinds(ski, snow)
    _require(edge_angle, load, 1.0, moment)
    _require_within(ski, load, moment)
    model = clamped(ski, clamp_length, elements, footprint_stiffness)
    conditions = _conditions(ski, snow, edge_angle, load, moment, 1.0, False, twist)._replace(side_force=0.0)
    return _described(model, conditions, snow, solved(model, conditions))


def _require_kinds(ski: object, snow: object) -> None:
    if not isinstance(ski, Ski):
        raise ParameterError(f"ski is {ski!r}; it must be a Ski: read_ski gives one, from a name or a file")
    if not isinstance(snow, SnowProperties):
        raise ParameterError(
            f"snow is {snow!r}; it must be SnowProperties: from published_snow, from snow_from_results, or from numbers"
        )


def _require(edge_angle: float, load: float, unloading_ratio: float, moment: float) -> None:
    if not 0.0 <= edge_angle <= GREATEST_EDGE_ANGLE:
        raise ParameterError(
            f"edge_angle is {edge_angle} rad; it must be from 0 to {GREATEST_EDGE_ANGLE:.3f} rad (85 degrees)"
        )
    if not (math.isfinite(load) and load > 0.0):
        raise ParameterError(f"load is {load} N; it must be a finite force above 0")
    if not unloading_ratio >= 1.0:
        raise ParameterError(f"unloading_ratio is {unloading_ratio}; k_u/H_V must be 1 (elastic) or more")
    if not math.isfinite(moment):
        raise ParameterError(f"moment is {moment} N m; it must be finite")


def _require_within(ski: Ski, load: float, moment: float) -> None:
    ahead = moment / load
    if not ski.station[-1] < ahead < ski.station[0]:
        raise ParameterError(
            f"a moment of {moment} N m under a load of {load} N puts the resultant {ahead:.2f} m ahead of the boot: "
            f"off the ski, which reaches from {ski.station[-1]:.2f} to {ski.station[0]:.2f} m: no snow can balance that"
        )


def _conditions(
    ski: Ski,
    snow: SnowProperties,
    edge_angle: float,
    load: float,
    moment: float,
    unloading_ratio: float,
    side_force_bending: bool,
    twist: bool,
) -> Conditions:
    return Conditions(
        edge_angle=edge_angle,
        hardness=snow.snow_hardness,
        excess=snow.snow_hardness * (unloading_ratio - 1.0),
        load=load,
        moment=moment,
        side_force=load * math.tan(edge_angle),
        side_force_bending=side_force_bending,
        twists=twist and edge_angle > 0.0,
        bevel=ski.base_bevel,
        bevel_width=ski.edge_width,
        pitch_of_force=1.0,
        pitch_of_shear=0.0,
        by_reaction=False,
    )


def _following_path(model: ClampedSki, conditions: Conditions) -> Solution:
    """Repeat with the edge's offset from the path until path and edge line agree."""
    solution = solved(model, conditions)
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


def _too_soft(model: ClampedSki, conditions: Conditions) -> bool:
    """Whether the load is beyond what the snow bears with the whole base pushed to the sinking depth."""
    area = float(model.stations.weight @ model.stations.width) * math.cos(conditions.edge_angle)
    return conditions.load > conditions.hardness * SINKING_DEPTH * area


def _described(
    model: ClampedSki, conditions: Conditions, snow: SnowProperties, solution: Solution, note: tuple[str, ...] = ()
) -> Equilibrium:
    station = model.stations.station
    deepest = float(np.max(solution.edge_depth))
    sinks = deepest > SINKING_DEPTH if solution.converged else _too_soft(model, conditions)
    if not solution.converged or sinks:
        outcome: Outcome = "sinks" if sinks else "not_converged"
        nothing = (None,) * 10
        return Equilibrium(outcome, REMEDIES[outcome], *nothing, station, *(None,) * 7, (), solution.iterations)
    line = EdgeLine(model, conditions.edge_angle, solution)
    weight, depth, force = model.stations.weight, solution.edge_depth, solution.force_per_length
    below = depth > 0.0
    limit = (
        None
        if snow.failure_shear_stress is None
        else snow.failure_shear_stress * float(weight @ np.maximum(depth, 0.0))
    )
    holds = True if conditions.side_force == 0.0 else limit is not None and conditions.side_force <= limit
    outcome = "slips" if not holds else "bridges" if _bridges(station, below) else "equilibrium"
    ends = line.contact_ends(depth)
    of_force = float(weight @ (force * station))
    drawn_from = force if conditions.by_reaction else np.maximum(depth, 0.0)
    of_shear = solution.shear_stress * float(weight @ (drawn_from * station))
    turns = conditions.side_force > 0.0
    return Equilibrium(
        outcome=outcome,
        remedy=REMEDIES[outcome],
        holds=holds,
        side_force=conditions.side_force,
        side_force_limit=limit,
        turn_radius_boot=line.radius_at_boot() if turns else None,
        turn_radius_boot_other_spread=None,
        turn_radius_chord=line.radius_over(*ends) if turns else None,
        contact_length=ends[0] - ends[1],
        bearing_length=float(weight[force > 0.0].sum()),
        afterbody_depth_ratio=_depth_ratio(station, weight, depth),
        boot_pitch_moment=math.cos(conditions.edge_angle) * of_force + math.sin(conditions.edge_angle) * of_shear,
        station=station,
        edge_depth=depth,
        force_per_length=force,
        bending=line.deflection,
        twist=line.twist,
        edge_line=line.position,
        residual_force=float(weight @ force) - conditions.load,
        residual_moment=conditions.pitch_of_force * of_force + conditions.pitch_of_shear * of_shear - conditions.moment,
        warnings=(*note, *_warnings(line)),
        iterations=solution.iterations,
    )


def _bridges(station: FloatArray, below: npt.NDArray[np.bool_]) -> bool:
    pieces = int(below[0]) + int(np.count_nonzero(np.diff(below.astype(int)) == 1))
    contact = station[below]
    return pieces != 1 or not contact[-1] <= 0.0 <= contact[0]


def _depth_ratio(station: FloatArray, weight: FloatArray, depth: FloatArray) -> float | None:
    before, behind = (depth > 0.0) & (station > 0.0), (depth > 0.0) & (station < 0.0)
    if not (before.any() and behind.any()):
        return None
    mean_before, mean_behind = (float(weight[part] @ depth[part] / weight[part].sum()) for part in (before, behind))
    return mean_behind / mean_before


def _warnings(line: EdgeLine) -> tuple[str, ...]:
    found = []
    slope, twist = line.greatest_slope(), float(np.max(np.abs(line.twist)))
    if slope > LARGE_SLOPE:
        found.append(
            f"the ski bends to a slope of {slope:.2f}: beyond {LARGE_SLOPE} beams of small deflection are inexact"
        )
    if twist > LARGE_SLOPE:
        found.append(f"the ski twists by {math.degrees(twist):.0f} degrees: more than a linear torsion bar can tell")
    return tuple(found)
